// Lines from visible points to a light, and the walls of one layer of its map that they cross.

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Places { vec4 places[]; };      // mm
layout(std430, binding = 1) readonly buffer Outwards { vec4 outwards[]; };  // geometric normals
// Of each line, mm where floats, as bits: distance to the way out that counts; material so far; ways out so far;
// triangle of the one that counts + 1.
layout(std430, binding = 2) buffer Ways { uvec4 ways[]; };
layout(std430, binding = 3) readonly buffer Corners { uint corners[]; };  // three vertices a triangle
layout(std430, binding = 4) readonly buffer Vertices { float vertices[]; };
layout(std430, binding = 5) buffer Going { uint going; };  // 1: a line may cross more walls

layout(binding = 0) uniform usampler2D walls;
layout(binding = 1) uniform sampler2D depths;

uniform vec3 origin, axis_s, axis_t, axis_depth;  // as the map was drawn
uniform float scale, depth_factor, depth_term;
uniform bool from_point;
uniform vec3 towards;      // the light's direction, unit; of a point: its place, mm
uniform int first, end;    // lines
uniform int most;          // ways out that a line needs to know
uniform bool nearest;      // the nearest way out counts; else the farthest

vec3 vertexOf(uint corner) {
    uint vertex = corners[corner];
    return vec3(vertices[3u * vertex], vertices[3u * vertex + 1u], vertices[3u * vertex + 2u]);
}

void main() {
    int line = first + int(gl_GlobalInvocationID.x);
    if (line >= end) return;
    uvec4 way = ways[line];
    if (way.z >= uint(most)) return;
    vec3 place = places[line].xyz, to_light = from_point ? towards - place : towards;
    float distance = length(to_light);
    if (distance == 0.0) return;
    vec3 wi = to_light / distance;
    if (dot(outwards[line].xyz, wi) >= 0.0) return;

    vec3 seen = vec3(dot(axis_s, place - origin), dot(axis_t, place - origin), dot(axis_depth, place - origin));
    if (from_point && seen.z <= 0.0) return;
    vec2 at = scale * seen.xy / (from_point ? seen.z : 1.0);
    if (max(abs(at.x), abs(at.y)) > 1.0) return;  // on another face of the cube
    int side = textureSize(walls, 0).x;
    ivec2 texel = min(ivec2(0.5 * float(side) * (at + 1.0)), ivec2(side - 1));
    uint wall = texelFetch(walls, texel, 0).r;
    if (wall == 0u) return;
    float depth = texelFetch(depths, texel, 0).r;
    float z = from_point ? depth_term / (depth - depth_factor) : (depth - depth_term) / depth_factor;
    // Along the line, at the texel's middle: depth falls evenly to 0 at the point.
    float ahead = from_point ? distance * (1.0 - z / seen.z) : seen.z - z;
    // The line itself meets the wall's plane a little beside it. Of a plane that is seen from its edge the middle has
    // to do.
    const float texels = 4.0;
    float near = texels * 2.0 / (scale * float(side)) * (from_point ? z : 1.0);
    if (ahead < -near) return;  // so are all walls that follow
    vec3 a = vertexOf(3u * wall - 3u), b = vertexOf(3u * wall - 2u), c = vertexOf(3u * wall - 1u);
    vec3 normal = cross(b - a, c - a);
    float slope = dot(normal, wi), met = dot(normal, a - place) / slope;
    if (abs(met - ahead) <= near) ahead = met;
    if (ahead > 0.0) {
        bool out_of = slope > 0.0;
        // What lies before the ways in is no material: gaps take themselves out of the sum.
        way.y = floatBitsToUint(uintBitsToFloat(way.y) + (out_of ? ahead : -ahead));
        if (out_of) {
            float known = uintBitsToFloat(way.x);
            if (way.z == 0u || (nearest ? ahead < known : ahead > known)) {
                way.x = floatBitsToUint(ahead);
                way.w = wall;
            }
            ++way.z;
        }
        ways[line] = way;
    }
    if (way.z < uint(most)) going = 1u;
}
