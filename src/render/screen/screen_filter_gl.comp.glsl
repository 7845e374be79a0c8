// A pass of a separable kernel over the visible samples: screen_filter.cpp says the same on lanes.

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Positions { vec4 positions[]; };  // mm, in camera coordinates; strength
layout(std430, binding = 1) readonly buffer Normals { vec4 normals[]; };  // and by what the axes turn
layout(std430, binding = 2) readonly buffer Cells { int cells[]; };  // of the first `standing` samples
layout(std430, binding = 3) readonly buffer Grid { vec4 grid[]; };   // light of who stands for the pixel, and its depth
layout(std430, binding = 4) readonly buffer Light { vec4 light[]; };
layout(std430, binding = 5) readonly buffer Taps { vec4 taps[]; };  // weight, offset in mm: of both sides
layout(std430, binding = 6) buffer Result { vec4 result[]; };
layout(std430, binding = 7) buffer GridOut { vec4 grid_out[]; };

uniform int first_sample, end_sample, standing, first_tap, end_tap;
uniform int width, height, margin;
uniform float focal;
uniform bool surface_axes, turned;
uniform int trust;   // FilterTrust
uniform int course;  // FilterLine::Course
uniform float cosine, sine;
uniform vec3 middle, scale;
uniform float kernel_width, per_reach, fallback;
uniform float edge_on, nearest;
uniform bool last;  // adds scale times the pass to the result; else the result is what the second pass reads

vec3 axisOf(vec3 position, vec3 normal, float turn) {
    if (!surface_axes) return vec3(cosine, sine, 0.0);
    vec3 u = cross(vec3(0.0, -position.z, position.y), normal);
    float square = dot(u, u), limit = edge_on * dot(position, position);
    u = square < limit ? vec3(1.0, 0.0, 0.0) : u / sqrt(square);
    vec3 v = cross(u, normal);
    if (turned) return cos(turn) * (cosine * u + sine * v) + sin(turn) * (cosine * v - sine * u);
    return sine == 0.0 ? u : cosine * u + sine * v;
}

float trustOf(float offset, float height_over) {
    if (trust == 0) return 1.0;
    if (trust == 1) return max(0.0, 1.0 - abs(height_over) * per_reach);
    float far = abs(height_over) + 2.0 * abs(offset) + 1e-30;
    float root = far / (far + 0.25 * per_reach * height_over * height_over);
    return root * root * root * root;
}

// The sample of this invocation, in camera coordinates.
struct Sample {
    vec3 position, normal, axis;
    float plane;
    vec2 cell, from;
};

vec4 texel(Sample here, vec2 at, float share, vec2 middle_of, float offset) {
    vec4 found = grid[margin + int(at.y) * (width + 2) + int(at.x)];
    if (found.w <= 0.0) return vec4(0.0);
    vec3 seen = found.w * vec3((at - middle_of) / focal, 1.0);
    float weight = share * trustOf(offset, dot(here.normal, seen) - here.plane);
    return weight * vec4(found.rgb, 1.0);
}

// The light at an offset, as far as it is trusted, and how far that is.
vec4 lightAt(Sample here, float offset, vec2 middle_of, vec2 end) {
    float per_z = focal / max(nearest * here.position.z, here.position.z + offset * here.axis.z);
    vec2 place = clamp(per_z * (here.position.xy + offset * here.axis.xy) + here.from, vec2(0.0), end);
    if (course == 0) place.y = here.cell.y;
    if (course == 1) place.x = here.cell.x;
    vec2 corner = floor(place), f = place - corner;
    vec4 found = texel(here, corner, (1.0 - f.x) * (1.0 - f.y), middle_of, offset);
    if (course != 1) found += texel(here, corner + vec2(1, 0), f.x * (1.0 - f.y), middle_of, offset);
    if (course != 0) found += texel(here, corner + vec2(0, 1), (1.0 - f.x) * f.y, middle_of, offset);
    if (course == 2) found += texel(here, corner + vec2(1, 1), f.x * f.y, middle_of, offset);
    return found;
}

void main() {
    int i = first_sample + int(gl_GlobalInvocationID.x);
    if (i >= end_sample) return;
    Sample here;
    here.position = positions[i].xyz;
    here.normal = surface_axes ? normals[i].xyz : vec3(0.0, 0.0, 1.0);
    here.axis = axisOf(here.position, here.normal, normals[i].w);
    here.plane = dot(here.normal, here.position);
    float wide = kernel_width * positions[i].w;
    vec2 middle_of = 0.5 * vec2(width, height) + 0.5, end = vec2(width, height) + 0.5;
    vec2 own = focal / here.position.z * here.position.xy + middle_of;
    here.cell = clamp(floor(own + 0.5), vec2(0.0), floor(end));
    here.from = middle_of + (here.cell - own);
    vec3 sum = vec3(0.0), rest = middle;
    for (int k = first_tap; k < end_tap; ++k) {
        float offset = wide * taps[k].w;
        vec4 ahead = lightAt(here, offset, middle_of, end), behind = lightAt(here, -offset, middle_of, end);
        sum += taps[k].rgb * (ahead.rgb + behind.rgb);
        rest += taps[k].rgb * (fallback * (2.0 - ahead.w - behind.w));
    }
    vec3 filtered = sum + rest * light[i].rgb;
    if (last) {
        result[i].rgb += scale * filtered;
        return;
    }
    result[i] = vec4(filtered, 0.0);
    if (i < standing) grid_out[cells[i]] = vec4(filtered, here.position.z);
}
