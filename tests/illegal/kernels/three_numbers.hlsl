static const float4 kernel[3] = {
    float4(0.5, 0.5, 0.5, 0),
    float4(0.25, 0.25, -1),
    float4(0.25, 0.25, 0.25, 1)
};
