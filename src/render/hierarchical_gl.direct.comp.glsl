// What the error is measured against: some receivers, all points. An invocation sums one part of the points for one
// receiver; parts are added up elsewhere.

layout(std430, binding = 0) readonly buffer Receivers { vec4 receivers[]; };
layout(std430, binding = 1) writeonly buffer Sums { vec4 sums[]; };  // receiver after receiver, `parts` each

uniform int receiver_count, point_count;
uniform int parts, part_size;

void main() {
    int invocation = int(gl_GlobalInvocationID.x);
    if (invocation >= receiver_count * parts) return;
    // Neighbours in a vector of invocations have the same points: what they fetch is the same.
    int receiver = invocation % receiver_count, part = invocation / receiver_count;
    vec3 position = receivers[receiver].xyz, sum = vec3(0);
    int end = min((part + 1) * part_size, point_count);
    for (int i = part * part_size; i < end; ++i) {
        vec3 r = position - texelFetch(points, 2 * i).xyz;
        sum += texelFetch(points, 2 * i + 1).rgb * radialValue(dot(r, r) + table_offset);
    }
    sums[receiver * parts + part] = vec4(sum, 0);
}
