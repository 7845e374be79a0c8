// A mesh seen from a light, parallel or from one point. No attributes: corners are fetched by number.

layout(std430, binding = 0) readonly buffer Corners { uint corners[]; };     // three vertices a triangle
layout(std430, binding = 1) readonly buffer Vertices { float vertices[]; };  // x, y, z

uniform vec3 origin, axis_s, axis_t, axis_depth;
uniform float scale;                     // of s and t to [-1, 1]; from a point: 1
uniform float depth_factor, depth_term;  // depth = term + factor * z; from a point: factor + term / z
uniform bool from_point;

void main() {
    uint vertex = corners[gl_VertexID];
    vec3 p = vec3(vertices[3u * vertex], vertices[3u * vertex + 1u], vertices[3u * vertex + 2u]) - origin;
    vec3 seen = vec3(dot(axis_s, p), dot(axis_t, p), dot(axis_depth, p));
    gl_Position = vec4(scale * seen.xy, depth_factor * seen.z + depth_term, from_point ? seen.z : 1.0);
}
