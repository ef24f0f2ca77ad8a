// The path tracer: every invocation adds up a group of samples of every part of one pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef RAY_QUERY
#extension GL_EXT_ray_query : require
#endif

layout(local_size_x = 8, local_size_y = 8) in;

#include "scene.glsl"
#include "rng.glsl"
#include "warp.glsl"
#include "texture.glsl"
#include "intersect.glsl"
#include "surfel.glsl"
#include "impulse.glsl"
#include "bsdf.glsl"
#include "scatter.glsl"
#include "environment.glsl"
#include "light_tree.glsl"
#include "luminaire.glsl"
#include "sensor.glsl"
#include "path.glsl"
#include "batch.glsl"

struct PixelSum {
    float radiance[3];
    uint rays;
    uint shadow_rays;
    uint dropped;
};
layout(set = 0, binding = 7, std430) writeonly buffer Sums { PixelSum sums[]; };
layout(set = 0, binding = 8, std430) buffer Dropped {
    uint count;
    uint padding;
    uvec2 samples[];
} dropped;

// What a sample adds to `dropped` that met nothing, where TRANSPARENT. The twin is in src/gpu/layout.rs.
const uint MISSED = 0x10000u;
// The twin is in src/film/batch.rs.
const float MOST_RADIANCE = 1e36;

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= batch.tile_width || id.y >= batch.tile_height) return;
    uvec2 pixel = uvec2(batch.tile_x, batch.tile_y) + id.xy;
    uint pixel_index = pixel.y * frame.width + pixel.x;
    // Each z takes `group` samples of every part, which are PARTS apart.
    uint stride = batch.group * PARTS;
    uint first = batch.first_sample + id.z * stride;
    // From `first` on, so that the last numbers of all do not overflow.
    uint count = min(stride, batch.end_sample - first);
    uint last_part = min(PARTS, count) - 1u;
    uint pixels = batch.tile_width * batch.tile_height;
    uint slot = id.z * PARTS * pixels + id.y * batch.tile_width + id.x;

    // A driver that ends a long loop (Mesa before 23 does, after 65 535 rounds) leaves these: groups of which all samples are lost.
    for (uint p = 0u; p <= last_part; p++) {
        sums[slot + p * pixels] = PixelSum(float[3](0.0, 0.0, 0.0), 0u, 0u, (count - p + PARTS - 1u) / PARTS);
    }

    // One loop over the bounces of all samples: a lane whose path ends starts its next one while the others go on.
    uint part = 0u;
    uint offset = 0u;
    uint sample_index = first;
    vec3 sum = vec3(0.0);
    uvec2 rays = uvec2(0u);     // all, shadow
    uint not_finite = 0u;
    Path path = camera_path(pixel, pixel_index, sample_index);
    while (true) {
        if (!extend_path(path, pixel_index, sample_index, rays)) {
            // What is larger would overflow when it is added up.
            if (is_finite(path.radiance) && largest(abs(path.radiance)) < MOST_RADIANCE) {
                sum += path.radiance;
            } else {
                not_finite++;
                uint named = atomicAdd(dropped.count, 1u);
                if (named < dropped.samples.length()) dropped.samples[named] = uvec2(pixel_index, sample_index);
            }
            if (TRANSPARENT && path.bounce == NONE) not_finite += MISSED;
            offset += PARTS;
            if (offset >= count) {
                sums[slot + part * pixels] = PixelSum(float[3](sum.x, sum.y, sum.z), rays.x, rays.y, not_finite);
                if (part == last_part) break;
                offset = ++part;
                sum = vec3(0.0);
                rays = uvec2(0u);
                not_finite = 0u;
            }
            sample_index = first + offset;
            path = camera_path(pixel, pixel_index, sample_index);
        }
    }
}
