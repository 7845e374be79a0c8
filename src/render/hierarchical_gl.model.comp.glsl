// The model itself, summed over lists of nodes and points. It stands above, and so do its uniforms; names that start
// with sl_ are not its own.

layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer sl_Lists { int sl_lists[]; };          // a group: count, which, entries
layout(std430, binding = 3) readonly buffer sl_Receivers { vec4 sl_receivers[]; }; // 2 a receiver: position, normal
layout(std430, binding = 4) readonly buffer sl_GroupBegins { int sl_group_begins[]; };
layout(std430, binding = 5) readonly buffer sl_LeafBegins { int sl_leaf_begins[]; };
layout(binding = 0) uniform samplerBuffer sl_nodes;   // 8 texels a node
layout(binding = 1) uniform samplerBuffer sl_points;  // 4 texels a point: position and least distance, normal, wi, flux

uniform int sl_count;             // of invocations
uniform int sl_slots;             // receivers of the largest group
uniform int sl_list_size;
uniform int sl_from, sl_to;       // the part of the lists that this dispatch walks
uniform int sl_direct;            // 0: lists; n: no lists, n receivers, each invocation a part of the leaves
uniform int sl_leaves;            // of the points
uniform bool sl_first;            // the sum starts here
uniform vec3 sl_eye;              // mm
uniform vec3 sl_scatters;         // 1 or 0 by channel: what the model says of one that does not is nothing

vec3 sl_xo, sl_no, sl_wo;

vec3 sl_exitance(vec3 xi, vec3 ni, vec3 wi, vec3 flux) {
    sl_iterations = 0;
    SL_SET_NORMALS(ni, sl_no)
    vec3 value = Bssrdf(xi, wi, sl_xo, sl_wo);
    return flux * mix(vec3(0), value, greaterThan(sl_scatters, vec3(0)));
}

// A point never stands nearer than half the radius of its cell: there 1/r has its mean over the cell, and what is smooth
// on the cell hardly changes.
vec3 sl_pointExitance(int point) {
    vec4 place = texelFetch(sl_points, 4 * point);
    vec3 normal = texelFetch(sl_points, 4 * point + 1).xyz;
    vec3 offset = place.xyz - sl_xo;
    float r = length(offset);
    if (r < place.w) {
        vec3 axis = abs(normal.x) < 0.7 ? vec3(1, 0, 0) : vec3(0, 1, 0);
        offset = r > 1e-3 * place.w ? (place.w / r) * offset : place.w * normalize(cross(normal, axis));
    }
    return sl_exitance(sl_xo + offset, normal, texelFetch(sl_points, 4 * point + 2).xyz,
                       texelFetch(sl_points, 4 * point + 3).rgb);
}

// Four points with the node's mean and second moments in the tangent plane, and with the slope of its normals and
// directions: exact for what is quadratic in the position.
vec3 sl_nodeExitance(int node) {
    vec4 a = texelFetch(sl_nodes, 8 * node), b = texelFetch(sl_nodes, 8 * node + 1);
    vec4 c = texelFetch(sl_nodes, 8 * node + 2), d = texelFetch(sl_nodes, 8 * node + 3);
    vec4 e = texelFetch(sl_nodes, 8 * node + 4), f = texelFetch(sl_nodes, 8 * node + 5);
    vec4 g = texelFetch(sl_nodes, 8 * node + 6), h = texelFetch(sl_nodes, 8 * node + 7);
    vec3 flux = 0.25 * d.xyz, sum = vec3(0);
    if (flux == vec3(0)) return sum;
    for (int k = 0; k < 4; ++k) {
        float first = k == 0 ? 1.0 : k == 1 ? -1.0 : 0.0, second = k == 2 ? 1.0 : k == 3 ? -1.0 : 0.0;
        vec3 xi = a.xyz + first * vec3(a.w, b.xy) + second * vec3(b.zw, c.x);
        vec3 ni = c.yzw + first * e.xyz + second * vec3(e.w, f.xy);
        vec3 wi = vec3(f.zw, g.x) + first * g.yzw + second * h.xyz;
        sum += sl_exitance(xi, normalize(ni), normalize(wi), flux);
    }
    return sum;
}

vec3 sl_leafExitance(int leaf) {
    vec3 sum = vec3(0);
    for (int i = sl_leaf_begins[leaf]; i < sl_leaf_begins[leaf + 1]; ++i) sum += sl_pointExitance(i);
    return sum;
}

void main() {
    int invocation = int(gl_GlobalInvocationID.x);
    if (invocation >= sl_count) return;
    int group = 0, receiver = 0;
    if (sl_direct > 0) {
        receiver = invocation % sl_direct;
    } else {
        group = sl_list_size * (invocation / sl_slots);
        receiver = sl_group_begins[sl_lists[group + 1]] + invocation % sl_slots;
        if (receiver >= sl_group_begins[sl_lists[group + 1] + 1]) return;
    }
    sl_xo = sl_receivers[2 * receiver].xyz;
    sl_no = sl_receivers[2 * receiver + 1].xyz;
    sl_wo = normalize(sl_eye - sl_xo);
    vec3 sum = vec3(0);
    if (sl_direct > 0) {
        int first = sl_to * (invocation / sl_direct), last = min(first + sl_to, sl_leaves);
        for (int leaf = first; leaf < last; ++leaf) sum += sl_leafExitance(leaf);
    } else {
        int last = min(sl_to, sl_lists[group]);
        for (int k = sl_from; k < last; ++k) {
            int entry = sl_lists[group + 2 + k];
            sum += entry < 0 ? sl_leafExitance(~entry) : sl_nodeExitance(entry);
        }
    }
    int at = 3 * (sl_direct > 0 ? invocation : receiver);
    if (!sl_first) sum += vec3(sl_values[at], sl_values[at + 1], sl_values[at + 2]);
    sl_values[at] = sum.x;
    sl_values[at + 1] = sum.y;
    sl_values[at + 2] = sum.z;
    sl_findCut();
}
