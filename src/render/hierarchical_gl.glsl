// What the passes of the hierarchical sum share: the radial function, the tree of the points, and its moments.

layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer radial_table;   // 3 texels an entry
layout(binding = 1) uniform samplerBuffer point_spheres;  // per node: centre, radius
layout(binding = 2) uniform samplerBuffer point_moments;  // 8 texels a node
layout(binding = 3) uniform samplerBuffer points;         // 2 texels a point: position, flux
layout(binding = 4) uniform samplerBuffer group_spheres;  // of the receivers: per node: centre, radius

// What a pass may leave behind.
const uint failed_list = 1u;  // a list was too short
const uint failed_loop = 2u;  // the driver ended a loop

uniform int table_last;        // the entry beyond the end
uniform int table_first_bits;  // of entry 0
uniform float table_offset;
uniform float opening;         // cube root of the error that a term may make

// Groups of receivers that a dispatch is about: at level chain_level every chain_stride-th node, all below it, and the
// one above it at each level.
uniform int level, chain_level, chain_first, chain_stride;

// The node of a group that is the `group`-th of its level in this dispatch.
int groupNode(int group) {
    int below = max(0, level - chain_level), above = max(0, chain_level - level);
    int chain = (1 << chain_level) + chain_first + chain_stride * (group >> below);
    return ((chain << below) + (group & ((1 << below) - 1))) >> above;
}

// Entry of w = r^2 + table_offset, and how far w is from its middle.
struct Place {
    int entry;
    float delta;
};

Place placeOf(float w) {
    uint bits = floatBitsToUint(w) >> TABLE_SHIFT;
    float middle = uintBitsToFloat((bits << TABLE_SHIFT) | (1u << (TABLE_SHIFT - 1)));
    return Place(3 * clamp(int(bits) - table_first_bits, 0, table_last), w - middle);
}

vec3 radialValue(float w) {
    Place at = placeOf(w);
    return texelFetch(radial_table, at.entry).rgb + at.delta * texelFetch(radial_table, at.entry + 1).rgb;
}

// A function of position to second order: value, gradient, and second derivatives xx, xy, xz, yy, yz, zz.
struct Expansion {
    vec3 value, x, y, z, xx, xy, xz, yy, yz, zz;
};

// Moments of a node's flux about its centre, in the same order. Ten colours are packed into eight texels.
Expansion momentsOf(int node) {
    vec4 a = texelFetch(point_moments, 8 * node), b = texelFetch(point_moments, 8 * node + 1);
    vec4 c = texelFetch(point_moments, 8 * node + 2), d = texelFetch(point_moments, 8 * node + 3);
    vec4 e = texelFetch(point_moments, 8 * node + 4), f = texelFetch(point_moments, 8 * node + 5);
    vec4 g = texelFetch(point_moments, 8 * node + 6), h = texelFetch(point_moments, 8 * node + 7);
    return Expansion(a.xyz, vec3(a.w, b.xy), vec3(b.zw, c.x), c.yzw, d.xyz,
                     e.xyz, vec3(e.w, f.xy), vec3(f.zw, g.x), g.yzw, h.xyz);
}

// The sum over a node's flux at `at` from its centre: R M0 - grad R . M1 + 1/2 grad grad R : M2, where in w = |at|^2 + c^2
// grad R = 2 R' at and grad grad R = 2 R' I + 4 R'' at at^T.
vec3 exitanceOf(Expansion m, vec3 at, float w) {
    Place place = placeOf(w);
    vec3 R2 = texelFetch(radial_table, place.entry + 2).rgb;
    vec3 R1 = texelFetch(radial_table, place.entry + 1).rgb + place.delta * R2;
    vec3 R = texelFetch(radial_table, place.entry).rgb + place.delta * (R1 - 0.5 * place.delta * R2);
    vec3 first = at.x * m.x + at.y * m.y + at.z * m.z;
    vec3 square = at.x * at.x * m.xx + at.y * at.y * m.yy + at.z * at.z * m.zz +
                  2.0 * (at.x * at.y * m.xy + at.x * at.z * m.xz + at.y * at.z * m.yz);
    return R * m.value + R1 * (m.xx + m.yy + m.zz - 2.0 * first) + 2.0 * R2 * square;
}

// Whether node and receivers within `radius` are small enough for their distance. An expansion needs distance itself,
// whatever the function is.
bool mayExpand(float w, float distance, float radius) {
    float reach = texelFetch(radial_table, placeOf(w).entry).w;
    return radius <= min(opening * reach, 0.7 * distance);
}

// The node after the whole subtree of `node`, in the order of depth first; 1 after the last.
int nodeAfter(int node) { return (node + 1) >> findLSB(node + 1); }
