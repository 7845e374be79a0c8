static const float kernel[3][4] = {
    {0.5f, 0.5f, 0.5f, 0.0f},
    {0.25f, 0.25f, 0.25f, -1e999f},
    {0.25f, 0.25f, 0.25f, 1.0f}
};
