// Of the walls behind those that the layer before shows the nearest one: its triangle + 1 and its depth.

layout(binding = 0) uniform sampler2D before;  // depth; 0 where there were no more walls
uniform bool first;                            // there is no layer before
layout(location = 0) out uint wall;
layout(location = 1) out float depth;

// Of the way through the bounding sphere: what lies nearer to the wall before is that wall.
const float apart = 1e-6;

void main() {
    if (!first) {
        float known = texelFetch(before, ivec2(gl_FragCoord.xy), 0).r;
        if (known == 0.0 || gl_FragCoord.z <= known + apart) discard;
    }
    wall = uint(gl_PrimitiveID) + 1u;
    depth = gl_FragCoord.z;
}
