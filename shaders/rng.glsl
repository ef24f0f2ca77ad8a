// Random numbers as a pure function of (pixel, sample, block, seed): the twin of src/sampling, bit for bit.

const uint SENSOR_BLOCK = 0u;

uint light_block(uint bounce) { return 1u + 2u * bounce; }
uint scatter_block(uint bounce) { return 2u + 2u * bounce; }

// Four independent numbers. pcg4d: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
uvec4 random4(uint pixel, uint sample_index, uint block, uint seed) {
    uvec4 v = uvec4(pixel, sample_index, block, seed) * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Nested uniform scrambling of numbers whose first binary digit is in bit 0: Vegdahl, "Building a Better LK Hash", 2021.
uvec2 owen_scramble(uvec2 x, uvec2 seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16u | 1u;
    x ^= x * 0x05526c56u;
    return x ^ x * 0x53a22864u;
}

uvec4 owen_scramble(uvec4 x, uvec4 seed) {
    return uvec4(owen_scramble(x.xy, seed.xy), owen_scramble(x.zw, seed.zw));
}

// Two independent, Owen-scrambled (0, 2)-sequences in `index`, xy and zw: src/sampling/sobol.rs says how.
uvec4 sobol4(uint pixel, uint index, uint block, uint seed) {
    uvec4 seeds = random4(pixel, ~0u, block, seed);
    uvec2 x = bitfieldReverse(owen_scramble(uvec2(bitfieldReverse(index)), seeds.zx ^ seeds.wy));
    uvec2 y = x ^ (x >> 1u & 0x55555555u);
    y ^= y >> 2u & 0x33333333u;
    y ^= y >> 4u & 0x0f0f0f0fu;
    y ^= y >> 8u & 0x00ff00ffu;
    y ^= y >> 16u;
    return bitfieldReverse(owen_scramble(uvec4(x, y).xzyw, seeds));
}

// The four numbers of a block, from the scene's sampler.
uvec4 numbers(uint pixel, uint sample_index, uint block, uint seed) {
    return SOBOL ? sobol4(pixel, sample_index, block, seed) : random4(pixel, sample_index, block, seed);
}

// What makes a ray's decisions about transparent surfaces independent of other rays'. `ray` is 2 b for the ray to bounce b,
// 2 b + 1 for the shadow ray from there.
uint ray_salt(uint pixel, uint sample_index, uint ray, uint seed) {
    return random4(pixel, sample_index, 0x80000000u | ray, seed).x;
}

// A ray is stopped by a surface if uniform1 of this number is below its opacity; the scene's indices.
uint coverage(uint salt, uint object, uint triangle) { return random4(salt, object, triangle, 0u).x; }

// In (0, 1), exact: the middle of one of 2^23 intervals. An end of the range would put a direction on the rim of its hemisphere, where its
// path ends.
float uniform1(uint random) { return (float(random >> 9u) + 0.5) * (1.0 / 8388608.0); }
vec2 uniform2(uvec2 random) { return (vec2(random >> 9u) + 0.5) * (1.0 / 8388608.0); }
