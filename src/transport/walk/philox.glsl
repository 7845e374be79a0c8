// Random numbers without a state: Philox4x32-10 of [Salmon2011]. Unrolled, as some drivers count the iterations of
// loops against a budget.

uvec4 philoxRound(uvec4 counter, uvec2 key) {
    uint high_x, low_x, high_z, low_z;
    umulExtended(0xD2511F53u, counter.x, high_x, low_x);
    umulExtended(0xCD9E8D57u, counter.z, high_z, low_z);
    return uvec4(high_z ^ counter.y ^ key.x, low_z, high_x ^ counter.w ^ key.y, low_x);
}

// 128 random bits of a counter, under a key.
uvec4 philox(uvec4 counter, uvec2 key) {
    const uvec2 weyl = uvec2(0x9E3779B9u, 0xBB67AE85u);
    counter = philoxRound(counter, key);
    counter = philoxRound(counter, key + weyl);
    counter = philoxRound(counter, key + 2u * weyl);
    counter = philoxRound(counter, key + 3u * weyl);
    counter = philoxRound(counter, key + 4u * weyl);
    counter = philoxRound(counter, key + 5u * weyl);
    counter = philoxRound(counter, key + 6u * weyl);
    counter = philoxRound(counter, key + 7u * weyl);
    counter = philoxRound(counter, key + 8u * weyl);
    return philoxRound(counter, key + 9u * weyl);
}
