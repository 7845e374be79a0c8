// From the whole down to the cell in whose part of it a number lies.

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Sums { float sums[]; };
layout(std430, binding = 1) readonly buffer Along { float along[]; };
layout(std430, binding = 2) writeonly buffer Choices { vec4 choices[]; };  // cell (its bits), inside, probability

uniform int levels, count;

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= count) return;
    float left = along[i] * sums[0];
    int node = 0, first = 0;
    for (int level = 1; level <= levels; ++level) {
        first = 4 * first + 1;
        int child = 4 * node;
        float rest = left;
        // A child of nothing is never taken, nor is rounding allowed to lead beyond the last of the others.
        for (int k = 0; k < 4; ++k) {
            float s = sums[first + 4 * node + k];
            if (s <= 0.0) continue;
            child = 4 * node + k;
            left = rest;
            if (rest < s) break;
            rest -= s;
        }
        node = child;
        left = min(left, sums[first + node]);
    }
    float weight = sums[first + node];
    choices[i] = vec4(intBitsToFloat(node), left / weight, weight / sums[0], 0);
}
