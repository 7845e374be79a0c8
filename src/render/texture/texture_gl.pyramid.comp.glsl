// A level of the mip chain from the one below it.

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Sums { float sums[]; };  // level k begins at (4^k - 1) / 3, the whole is level 0

uniform int first, below, count;  // where the level and the one below begin; nodes of the level

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= count) return;
    int child = below + 4 * i;
    sums[first + i] = (sums[child] + sums[child + 1]) + (sums[child + 2] + sums[child + 3]);
}
