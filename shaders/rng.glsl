// Random numbers as a pure function of (pixel, sample, block, seed): the twin of src/sampling/mod.rs, bit for bit.
// pcg4d: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.

const uint SENSOR_BLOCK = 0u;

uint light_block(uint bounce) { return 1u + 2u * bounce; }
uint scatter_block(uint bounce) { return 2u + 2u * bounce; }

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

// In [0, 1), exact: the upper 24 bits.
float uniform1(uint random) { return float(random >> 8u) * (1.0 / 16777216.0); }
vec2 uniform2(uvec2 random) { return vec2(random >> 8u) * (1.0 / 16777216.0); }

uvec4 numbers(uint pixel, uint sample_index, uint block, uint seed) { return random4(pixel, sample_index, block, seed); }
uint ray_salt(uint pixel, uint sample_index, uint ray, uint seed) { return random4(pixel, sample_index, 0x80000000u | ray, seed).x; }
uint coverage(uint salt, uint object, uint triangle) { return random4(salt, object, triangle, 0u).x; }
