const vec4 kernel[3] = vec4[](
    vec4(0.5, 0.5, 0.5, 0.0),
    vec4(0.25, 0.25, 0.25, -width),
    vec4(0.25, 0.25, 0.25, 1.0)
);
