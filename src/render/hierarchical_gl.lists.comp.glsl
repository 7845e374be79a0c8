// For a model of any kind: which nodes may stand for their points, for all receivers of a group at once. What may not is
// opened down to leaves.

layout(std430, binding = 0) writeonly buffer Lists { int lists[]; };  // a group: count, the group among all, entries
layout(std430, binding = 1) buffer Counters { uint failed, longest, total; };

uniform int group_count;  // in this slice
uniform int list_size;
uniform int leaf_begin;   // first leaf of the points
uniform int two;

void main() {
    int group = int(gl_GlobalInvocationID.x);
    if (group >= group_count) return;
    int group_node = groupNode(group);
    vec4 sphere = texelFetch(group_spheres, group_node);
    int listed = 0;
    int node = 1;
    do {
        vec4 source = texelFetch(point_spheres, node);
        // To the nearest receiver that there may be: an expansion about the centre alone leaves outliers.
        float distance = max(0.0, length(sphere.xyz - source.xyz) - sphere.w);
        // A radius below 0 marks a node whose normals or directions cancel.
        bool open = source.w < 0.0 || !mayExpand(distance * distance + table_offset, distance, source.w);
        if (open && node < leaf_begin) {
            node *= 2;
            continue;
        }
        // A node that is expanded as it is, a leaf that is summed by the complement.
        if (listed + 2 < list_size) lists[group * list_size + listed + 2] = open ? ~(node - leaf_begin) : node;
        ++listed;
        node = nodeAfter(node);
    } while (node != 1);
    atomicMax(longest, uint(listed));
    atomicAdd(total, uint(listed));
    lists[group * list_size] = min(listed, list_size - 2);
    lists[group * list_size + 1] = group_node - (1 << level);
    if (listed + 2 > list_size) atomicMax(failed, failed_list);
    // A driver that has run out of iterations ends this loop, too.
    int passes = 0;
    for (int i = 0; i < two; ++i) ++passes;
    if (passes < two) atomicMax(failed, failed_loop);
}
