// The analogue walk: through plane layers, or in a ball (#define BALL). An invocation is a lane: it walks a bounded
// number of steps, keeps what it has not finished for the next dispatch, and takes the next walk whenever one ends.
// Which lane walks a walk is left to chance, but not what becomes of it: its random numbers are those of its chunk, its
// place there and the step. fresnelReflectance(), henyeyGreensteinVersine() and turnedDirection() of physics/ and
// philox() stand above.
//
// Lengths are float, as on the CPU; random variates too are made as in lane_math-inl.h, as the precision of a driver's
// log and cos is its own affair.

layout(local_size_x = 64) in;

struct Lane {
    vec4 position;  // and the layer
    vec4 direction;
    uvec4 walk;     // number of the walk, step, collisions, collisions that it survives
    uvec4 phase;
};
// Per slot of the ring: walks in the chunk there, and its number, low and high.
struct Slot {
    uint walks, chunk_low, chunk_high, unused;
};
// mfp, thickness, g, eta up, eta down; absorbed: 1 - albedo in 2^-32.
struct Layer {
    float mfp, thickness, g, eta_up, eta_down;
    uint absorbed;
    float unused_0, unused_1;
};

layout(std430, binding = 0) buffer Lanes { Lane lanes[]; };
layout(std430, binding = 1) readonly buffer Slots { Slot slots[]; };
layout(std430, binding = 2) buffer Counters {
    uint next_walk;
    uint ended[];  // per slot
};
layout(std430, binding = 3) writeonly buffer Ends { uint ends[]; };  // per slot five runs: x, y, z or cosine, collisions, fate
layout(std430, binding = 4) readonly buffer Layers { Layer layers[]; };
#ifdef BALL
layout(std430, binding = 5) readonly buffer Starts { vec4 starts[]; };  // per walk of a slot: position, direction
uniform float radius;
#endif

uniform int lane_count, steps;
uniform int limit;                      // the first walk that may not begin yet
uniform int chunk_bits, slot_mask;      // walks per slot: 2^chunk_bits; slots - 1
uniform int seed_low, seed_high;
uniform int layer_count, first_layer;
uniform float sin_beam, cos_beam;
uniform int long_walk, endless_walk;    // collisions, as in long_walk.h

// Phases of a lane.
const uint phase_free = 0u, phase_waiting = 1u, phase_walking = 2u;
// Fates of a walk; the layer stands above them.
const uint left_above = 0u, left_below = 1u, absorbed = 2u, killed = 3u;

// [0, 1) in steps of 2^-24.
float uniform01(uint bits) { return float(bits >> 8) * exp2(-24.0); }

// -log((k + 1/2) 2^-31): an exponential variate of mean 1.
float exponential(uint bits) {
    int x = floatBitsToInt(float(int(bits & 0x7FFFFFFFu)) + 0.5);
    int shifted = x + (0x3F800000 - 0x3F3504F3);
    float exponent = float((shifted >> 23) - (127 + 31));
    float y = intBitsToFloat((shifted & 0x007FFFFF) + 0x3F3504F3) - 1.0;
    float q = 0.089803467;
    q = q * y - 0.144263872;
    q = q * y + 0.148831928;
    q = q * y - 0.165518558;
    q = q * y + 0.199635335;
    q = q * y - 0.250025804;
    q = q * y + 0.333339316;
    q = q * y - 0.499999832;
    return -(exponent * 0.693147181) - (y * y * q + y);
}

// Cosine and sine of a uniform angle: the top 24 bits choose it in [-pi/2, pi/2), a low bit the sign of the cosine.
vec2 azimuthOf(uint bits) {
    float a = uniform01(bits) - 0.5, t = a * a;
    float s = ((((0.0772406352 * t - 0.598057495) * t + 2.55003391) * t - 5.16770708) * t + 3.14159259) * a;
    float c = (((0.219696798 * t - 1.33188016) * t + 4.05841191) * t - 4.93479286) * t + 0.999999953;
    return vec2((bits & 0x80u) != 0u ? -c : c, s);
}

uvec4 randomBits(uvec4 walk, uint purpose) {
    Slot slot = slots[(walk.x >> chunk_bits) & uint(slot_mask)];
    uint place = walk.x & ((1u << chunk_bits) - 1u);
    return philox(uvec4(walk.y, place, slot.chunk_low, slot.chunk_high ^ (purpose << 31)),
                  uvec2(uint(seed_low), uint(seed_high)));
}

// How many collisions a long walk survives: longWalkSurvives() of long_walk.h.
uint longWalkSurvives(uvec4 walk) {
    uvec4 bits = randomBits(walk, 1u);
    float n = float(long_walk) / ((float(bits.x >> 8) + 0.5) * exp2(-24.0));
    if (n < float(endless_walk)) return uint(n);
    return uint(endless_walk) + uint(exponential(bits.y) / log(10.0));
}

void finish(inout Lane lane, uint fate, vec3 place) {
    uint slot = (lane.walk.x >> chunk_bits) & uint(slot_mask), run = 1u << chunk_bits;
    uint at = 5u * slot * run + (lane.walk.x & (run - 1u));
    ends[at] = floatBitsToUint(place.x);
    ends[at + run] = floatBitsToUint(place.y);
    ends[at + 2u * run] = floatBitsToUint(place.z);
    ends[at + 3u * run] = lane.walk.z;
#ifdef BALL
    ends[at + 4u * run] = fate | lane.walk.y << 2;
#else
    ends[at + 4u * run] = fate | floatBitsToUint(lane.position.w) << 2;
#endif
    atomicAdd(ended[slot], 1u);
    lane.phase.x = phase_free;
}

// Starts the walk that the lane holds, unless its chunk has fewer.
void begin(inout Lane lane) {
    uint slot = (lane.walk.x >> chunk_bits) & uint(slot_mask), place = lane.walk.x & ((1u << chunk_bits) - 1u);
    if (place >= slots[slot].walks) {
        atomicAdd(ended[slot], 1u);
        lane.phase.x = phase_free;
        return;
    }
#ifdef BALL
    uint at = 2u * ((slot << chunk_bits) + place);
    lane.position = vec4(starts[at].xyz, uintBitsToFloat(0u));
    lane.direction = starts[at + 1u];
#else
    lane.position = vec4(0.0, 0.0, 0.0, uintBitsToFloat(uint(first_layer)));
    lane.direction = vec4(sin_beam, 0.0, cos_beam, 0.0);
#endif
    lane.walk = uvec4(lane.walk.x, 0u, 0u, uint(long_walk));
    lane.phase.x = phase_walking;
}

void collide(inout Lane lane, Layer layer, uvec4 bits) {
    ++lane.walk.z;
    if (bits.w < layer.absorbed) {
        finish(lane, absorbed, lane.position.xyz);
        return;
    }
    if (lane.walk.z > lane.walk.w) {
        if (lane.walk.w == uint(long_walk)) lane.walk.w = longWalkSurvives(lane.walk);
        if (lane.walk.z > lane.walk.w) {
            finish(lane, killed, lane.position.xyz);
            return;
        }
    }
    vec2 azimuth = azimuthOf(bits.z);
    float s = float(int(bits.y)) * exp2(-31.0);
    lane.direction.xyz =
        turnedDirection(lane.direction.xyz, henyeyGreensteinVersine(layer.g, s), azimuth.x, azimuth.y);
}

#ifdef BALL

void advance(inout Lane lane) {
    Layer layer = layers[0];
    uvec4 bits = randomBits(lane.walk, 0u);
    ++lane.walk.y;
    vec3 from = lane.position.xyz, direction = lane.direction.xyz;
    vec3 to = from + (exponential(bits.x) * layer.mfp) * direction;
    if (dot(to, to) <= radius * radius) {
        lane.position.xyz = to;
        collide(lane, layer, bits);
        return;
    }
    // A start that rounding has put outside crosses at once if it goes outwards. radius^2 - |from|^2 as a product:
    // near the surface the difference of squares is rounding alone.
    float distance = length(from), b = dot(from, direction);
    float t = max(0.0, sqrt(max(0.0, b * b + (radius - distance) * (radius + distance))) - b);
    vec3 normal = normalize(from + t * direction);
    float cosine = clamp(dot(direction, normal), 0.0, 1.0);
    lane.position.xyz = radius * normal;
    if (layer.eta_up != 1.0 && uniform01(bits.y) < fresnelReflectance(cosine, layer.eta_up))
        lane.direction.xyz = normalize(direction - (2.0 * cosine) * normal);
    else
        finish(lane, left_above, lane.position.xyz);
}

#else

void advance(inout Lane lane) {
    uint index = floatBitsToUint(lane.position.w);
    Layer layer = layers[index];
    uvec4 bits = randomBits(lane.walk, 0u);
    ++lane.walk.y;
    vec3 from = lane.position.xyz, direction = lane.direction.xyz;
    vec3 to = from + (exponential(bits.x) * layer.mfp) * direction;
    if (to.z >= 0.0 && to.z <= layer.thickness) {
        lane.position.xyz = to;
        collide(lane, layer, bits);
        return;
    }
    // As if there were no memory: at a surface the free path is drawn anew.
    bool up = direction.z < 0.0;
    float surface = up ? 0.0 : layer.thickness, eta = up ? layer.eta_up : layer.eta_down;
    float t = (surface - from.z) / direction.z, cosine = abs(direction.z);
    lane.position.xyz = vec3(from.xy + t * direction.xy, surface);
    if (eta != 1.0 && uniform01(bits.y) < fresnelReflectance(cosine, eta)) {
        lane.direction.z = -direction.z;
        return;
    }
    float beyond = eta == 1.0 ? cosine : sqrt(max(0.0, 1.0 - eta * eta * (1.0 - cosine) * (1.0 + cosine)));
    if (up ? index == 0u : index + 1u == uint(layer_count)) {
        finish(lane, up ? left_above : left_below, vec3(lane.position.xy, beyond));
        return;
    }
    index = up ? index - 1u : index + 1u;
    lane.position.z = up ? layers[index].thickness : 0.0;
    lane.position.w = uintBitsToFloat(index);
    lane.direction.xyz = vec3(eta * direction.xy, up ? -beyond : beyond);
}

#endif

void main() {
    uint at = gl_GlobalInvocationID.x;
    if (at >= uint(lane_count)) return;
    Lane lane = lanes[at];
    for (int i = 0; i < steps; ++i) {
        if (lane.phase.x == phase_free) {
            lane.walk.x = atomicAdd(next_walk, 1u);
            lane.phase.x = phase_waiting;
        }
        if (lane.phase.x == phase_waiting) {
            if (int(lane.walk.x) - limit >= 0) break;
            begin(lane);
        }
        if (lane.phase.x == phase_walking) advance(lane);
    }
    lanes[at] = lane;
}
