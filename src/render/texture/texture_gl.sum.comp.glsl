// One receiver, all samples. Follows hierarchical_gl.glsl.

layout(std430, binding = 0) readonly buffer Receivers { vec4 receivers[]; };
layout(std430, binding = 1) writeonly buffer Exitance { vec4 exitance[]; };

uniform int first_receiver, receiver_count, sample_count;

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= receiver_count) return;
    vec3 position = receivers[first_receiver + i].xyz, sum = vec3(0);
    for (int k = 0; k < sample_count; ++k) {
        vec3 r = position - texelFetch(points, 2 * k).xyz;
        sum += texelFetch(points, 2 * k + 1).rgb * radialValue(dot(r, r) + table_offset);
    }
    exitance[i] = vec4(sum, 0);
}
