// The last step: each receiver evaluates its group's expansion, and opens what the group could not expand down to single
// points.

layout(std430, binding = 0) readonly buffer Expansions { vec4 expansions[]; };  // 10 a group
layout(std430, binding = 1) readonly buffer Lists { int lists[]; };             // a group: count, then nodes
layout(std430, binding = 2) readonly buffer Receivers { vec4 receivers[]; };    // group after group: position
layout(std430, binding = 3) buffer Exitance { float exitance[]; };              // 3 a receiver
layout(std430, binding = 4) buffer Counters { uint failed, expanded, summed; };
layout(std430, binding = 5) readonly buffer GroupBegins { int group_begins[]; };  // of all groups, and the end
layout(std430, binding = 6) readonly buffer LeafBegins { int leaf_begins[]; };    // of the points' leaves, and the end

uniform int receiver_count;  // in this slice: groups times `slots`
uniform int slots;           // receivers of the largest group
uniform int list_size;
uniform int list_from, list_to;  // the part of the lists that this dispatch walks
uniform int leaf_begin;
uniform int two;

vec3 expansionAt(int group, vec3 t) {
    int at = 10 * group;
    return expansions[at].xyz +
           t.x * (expansions[at + 1].xyz + 0.5 * t.x * expansions[at + 4].xyz + t.y * expansions[at + 5].xyz +
                  t.z * expansions[at + 6].xyz) +
           t.y * (expansions[at + 2].xyz + 0.5 * t.y * expansions[at + 7].xyz + t.z * expansions[at + 8].xyz) +
           t.z * (expansions[at + 3].xyz + 0.5 * t.z * expansions[at + 9].xyz);
}

void main() {
    int invocation = int(gl_GlobalInvocationID.x);
    if (invocation >= receiver_count) return;
    int group = invocation / slots;
    int group_node = groupNode(group), group_of_all = group_node - (1 << level);
    int receiver = group_begins[group_of_all] + invocation % slots;
    if (receiver >= group_begins[group_of_all + 1]) return;
    vec3 position = receivers[receiver].xyz;

    vec3 sum = vec3(0);
    if (list_from == 0) sum = expansionAt(group, position - texelFetch(group_spheres, group_node).xyz);
    uint expanded_here = 0u, summed_here = 0u;
    int list_end = min(list_to, lists[group * list_size]);
    for (int k = list_from; k < list_end; ++k) {
        int node = lists[group * list_size + 1 + k];
        int end = nodeAfter(node);
        do {
            vec4 source = texelFetch(point_spheres, node);
            vec3 at = position - source.xyz;
            float square = dot(at, at);
            if (mayExpand(square + table_offset, sqrt(square), source.w)) {
                sum += exitanceOf(momentsOf(node), at, square + table_offset);
                ++expanded_here;
                node = nodeAfter(node);
            } else if (node < leaf_begin) {
                node *= 2;
            } else {
                int last = leaf_begins[node - leaf_begin + 1];
                for (int i = leaf_begins[node - leaf_begin]; i < last; ++i) {
                    vec3 r = position - texelFetch(points, 2 * i).xyz;
                    sum += texelFetch(points, 2 * i + 1).rgb * radialValue(dot(r, r) + table_offset);
                    ++summed_here;
                }
                node = nodeAfter(node);
            }
        } while (node != end);
    }
    // A driver that has run out of iterations ends this loop, too.
    int passes = 0;
    for (int i = 0; i < two; ++i) ++passes;
    if (passes < two) atomicMax(failed, failed_loop);
    atomicAdd(expanded, expanded_here);
    atomicAdd(summed, summed_here);

    if (list_from > 0) sum += vec3(exitance[3 * receiver], exitance[3 * receiver + 1], exitance[3 * receiver + 2]);
    exitance[3 * receiver] = sum.x;
    exitance[3 * receiver + 1] = sum.y;
    exitance[3 * receiver + 2] = sum.z;
}
