// Light from one direction, or from one point, on every surface point: what its shadow map lets through, times T12 cos.
// fresnelReflectance() of physics/ stands above.

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Normals { vec4 normals[]; };
layout(std430, binding = 1) readonly buffer Origins { vec4 origins[]; };      // of shadow rays, mm
layout(std430, binding = 2) readonly buffer Positions { vec4 positions[]; };  // mm
layout(std430, binding = 3) buffer Sums { vec4 sums[]; };

#ifdef CUBE_MAP
layout(binding = 0) uniform samplerCubeShadow shadow_map;
#else
layout(binding = 0) uniform sampler2DShadow shadow_map;
uniform vec3 axis_s, axis_t, axis_depth;
uniform float scale;
#endif
uniform float depth_factor, depth_term;
uniform int point_count;
uniform vec3 towards;  // the light's direction, unit; from a point: its place, mm
uniform vec3 weight;   // irradiance on a surface that faces the light; from a point: at unit_mm
uniform float unit_mm;
uniform float texel;  // side in mm; from a point: at distance 1
uniform float inverse_eta;
uniform bool shadows;

// Percentage closer, [Reeves1987]: four bilinear comparisons on a turned grid within the neighbouring texels.
const vec2 taps[4] = vec2[4](vec2(0.125, 0.375), vec2(-0.375, 0.125), vec2(-0.125, -0.375), vec2(0.375, -0.125));

// What the taps cover is 1.3 texels wide to each side, up to 1.6 in the corner of a cube: along a slanted surface the
// origin has to stand so far above it. The slant is that against the axis along which depth is measured.
vec3 lifted(vec3 origin, vec3 normal, float along, float size) {
#ifdef CUBE_MAP
    const float reach = 1.6;
#else
    const float reach = 1.3;
#endif
    return origin + (reach * size * sqrt(max(0.0, 1.0 - along * along)) + 0.1 * size) * normal;
}

// The fraction of the light that arrives at `origin`.
float visibility(vec3 origin, vec3 normal) {
    float lit = 0.0;
#ifdef CUBE_MAP
    vec3 far = abs(origin - towards);
    float z = max(max(far.x, far.y), far.z), size = texel * z;
    float along = z == far.x ? normal.x : z == far.y ? normal.y : normal.z;
    vec3 at = lifted(origin, normal, along, size) - towards;
    // Two directions across the line of sight.
    vec3 across = normalize(cross(at, abs(at.y) > abs(at.x) ? vec3(1, 0, 0) : vec3(0, 1, 0)));
    vec3 other = normalize(cross(across, at));
    z = max(max(abs(at.x), abs(at.y)), abs(at.z));
    for (int i = 0; i < 4; ++i)
        lit += texture(shadow_map, vec4(at + size * (taps[i].x * across + taps[i].y * other),
                                        depth_factor + depth_term / z));
#else
#ifdef FROM_POINT
    float size = texel * dot(axis_depth, origin - towards);
    vec3 at = lifted(origin, normal, dot(axis_depth, normal), size) - towards;
    float z = dot(axis_depth, at), depth = depth_factor + depth_term / z;
    vec2 place = 0.5 + 0.5 * scale * vec2(dot(axis_s, at), dot(axis_t, at)) / z;
#else
    vec3 at = lifted(origin, normal, dot(axis_depth, normal), texel);
    float depth = depth_factor * dot(axis_depth, at) + depth_term;
    vec2 place = 0.5 + 0.5 * scale * vec2(dot(axis_s, at), dot(axis_t, at));
#endif
    for (int i = 0; i < 4; ++i)
        lit += textureLod(shadow_map, vec3(place + 0.5 * scale * texel * taps[i], depth), 0.0);
#endif
    return 0.25 * lit;
}

void main() {
    int point = int(gl_GlobalInvocationID.x);
    if (point >= point_count) return;
    vec3 normal = normals[point].xyz;
#ifdef FROM_POINT
    vec3 to_light = towards - positions[point].xyz;
    float distance = length(to_light);
    if (distance == 0.0) return;
    vec3 wi = to_light / distance;
    float falloff = (unit_mm / distance) * (unit_mm / distance);
#else
    vec3 wi = towards;
    float falloff = 1.0;
#endif
    float mu = dot(normal, wi);
    if (mu <= 0.0) return;
    float crossed = falloff * mu * (1.0 - fresnelReflectance(min(mu, 1.0), inverse_eta));
    if (shadows) crossed *= visibility(origins[point].xyz, normal);
    sums[point] += vec4(crossed * weight, 0);
}
