// Which triangle is seen; 0 is none.

layout(location = 0) out uint triangle;

void main() { triangle = uint(gl_PrimitiveID) + 1u; }
