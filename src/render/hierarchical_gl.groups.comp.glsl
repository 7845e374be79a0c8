// One level of the receivers' tree: each group takes over its parent's expansion and the nodes that its parent could
// not expand, and expands those that it can. Nodes that are larger than the group are opened until they are not.

layout(std430, binding = 0) readonly buffer ParentExpansions { vec4 parent_expansions[]; };  // 10 a group
layout(std430, binding = 1) readonly buffer ParentLists { int parent_lists[]; };  // a group: count, then nodes
layout(std430, binding = 2) writeonly buffer Expansions { vec4 expansions[]; };
layout(std430, binding = 3) writeonly buffer Lists { int lists[]; };
layout(std430, binding = 4) buffer Counters { uint failed, expanded, summed; };

uniform int group_count;   // in this slice
uniform int parent_level;  // -1: none, all start at the root
uniform int list_size;     // room for the count and the nodes
uniform int leaf_begin;    // first leaf of the points
uniform int two;

Expansion parentExpansion(int group, vec3 t) {
    int at = 10 * group;
    vec3 value = parent_expansions[at].xyz;
    vec3 x = parent_expansions[at + 1].xyz, y = parent_expansions[at + 2].xyz, z = parent_expansions[at + 3].xyz;
    vec3 xx = parent_expansions[at + 4].xyz, xy = parent_expansions[at + 5].xyz, xz = parent_expansions[at + 6].xyz;
    vec3 yy = parent_expansions[at + 7].xyz, yz = parent_expansions[at + 8].xyz, zz = parent_expansions[at + 9].xyz;
    vec3 dx = t.x * xx + t.y * xy + t.z * xz, dy = t.x * xy + t.y * yy + t.z * yz, dz = t.x * xz + t.y * yz + t.z * zz;
    value += t.x * (x + 0.5 * dx) + t.y * (y + 0.5 * dy) + t.z * (z + 0.5 * dz);
    return Expansion(value, x + dx, y + dy, z + dz, xx, xy, xz, yy, yz, zz);
}

void addNode(inout Expansion sum, int node, vec3 at, float w) {
    Expansion m = momentsOf(node);
    sum.value += exitanceOf(m, at, w);
    Place place = placeOf(w);
    vec3 R2 = texelFetch(radial_table, place.entry + 2).rgb;
    vec3 R1 = 2.0 * (texelFetch(radial_table, place.entry + 1).rgb + place.delta * R2);
    R2 *= 4.0;
    vec3 along = R2 * (at.x * m.x + at.y * m.y + at.z * m.z);
    sum.x += R1 * (at.x * m.value - m.x) - at.x * along;
    sum.y += R1 * (at.y * m.value - m.y) - at.y * along;
    sum.z += R1 * (at.z * m.value - m.z) - at.z * along;
    R1 *= m.value;
    R2 *= m.value;
    sum.xx += R1 + at.x * at.x * R2;
    sum.xy += at.x * at.y * R2;
    sum.xz += at.x * at.z * R2;
    sum.yy += R1 + at.y * at.y * R2;
    sum.yz += at.y * at.z * R2;
    sum.zz += R1 + at.z * at.z * R2;
}

void main() {
    int group = int(gl_GlobalInvocationID.x);
    if (group >= group_count) return;
    int group_node = groupNode(group);
    vec4 sphere = texelFetch(group_spheres, group_node);

    int starts = 1;
    int parent = 0;
    Expansion sum = Expansion(vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0));
    if (parent_level >= 0) {
        parent = group >> (max(level, chain_level) - max(parent_level, chain_level));
        starts = parent_lists[parent * list_size];
        vec3 centre = texelFetch(group_spheres, group_node >> (level - parent_level)).xyz;
        sum = parentExpansion(parent, sphere.xyz - centre);
    }
    int listed = 0;
    uint expanded_here = 0u;
    for (int k = 0; k < starts; ++k) {
        int node = parent_level >= 0 ? parent_lists[parent * list_size + 1 + k] : 1;
        int end = nodeAfter(node);
        do {
            vec4 source = texelFetch(point_spheres, node);
            vec3 at = sphere.xyz - source.xyz;
            float square = dot(at, at);
            if (mayExpand(square + table_offset, sqrt(square), sphere.w + source.w)) {
                addNode(sum, node, at, square + table_offset);
                ++expanded_here;
                node = nodeAfter(node);
            } else if (node >= leaf_begin || source.w <= sphere.w) {
                ++listed;
                if (listed < list_size) lists[group * list_size + listed] = node;
                node = nodeAfter(node);
            } else {
                node *= 2;
            }
        } while (node != end);
    }
    lists[group * list_size] = min(listed, list_size - 1);
    if (listed >= list_size) atomicMax(failed, failed_list);
    // A driver that has run out of iterations ends this loop, too.
    int passes = 0;
    for (int i = 0; i < two; ++i) ++passes;
    if (passes < two) atomicMax(failed, failed_loop);
    atomicAdd(expanded, expanded_here);

    int at = 10 * group;
    expansions[at] = vec4(sum.value, 0);
    expansions[at + 1] = vec4(sum.x, 0);
    expansions[at + 2] = vec4(sum.y, 0);
    expansions[at + 3] = vec4(sum.z, 0);
    expansions[at + 4] = vec4(sum.xx, 0);
    expansions[at + 5] = vec4(sum.xy, 0);
    expansions[at + 6] = vec4(sum.xz, 0);
    expansions[at + 7] = vec4(sum.yy, 0);
    expansions[at + 8] = vec4(sum.yz, 0);
    expansions[at + 9] = vec4(sum.zz, 0);
}
