// A library for the tests of the translation: constants, overloads, arrays, a prototype.
const int table_size = 4;
const float squares[table_size] = float[](0.0, 1.0, 4.0, 9.0);
const vec3 axis = vec3(0.0, 0.0, 1.0);

float lookUp(float x);

float sumOf(float values[3]) { return values[0] + values[1] + values[2]; }

vec3 lookUp(vec3 x) { return vec3(lookUp(x.x), lookUp(x.y), lookUp(x.z)); }

// Linear interpolation in squares.
float lookUp(float x) {
    int i = clamp(int(x), 0, table_size - 2);
    return mix(squares[i], squares[i + 1], x - float(i));
}
