// The path tracer: every invocation adds up some groups of samples of one pixel, one after the other.
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
#include "normal_map.glsl"
#include "fresnel.glsl"
#include "microfacet.glsl"
#include "physical.glsl"
#include "surfel.glsl"
#include "absorption.glsl"
#include "impulse.glsl"
#include "bsdf.glsl"
#include "scatter.glsl"
#include "environment.glsl"
#include "light_tree.glsl"
#include "sun.glsl"
#include "profile.glsl"
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
const uint GROUPS_IN_TURN = 4u;     // that an invocation takes

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= batch.tile_width || id.y >= batch.tile_height) return;
    uvec2 pixel = uvec2(batch.tile_x, batch.tile_y) + id.xy;
    uint pixel_index = pixel.y * frame.width + pixel.x;
    // Groups begin at multiples of their length, but for the first of all, which may lack its head; the last may lack its tail.
    uint start = (batch.first_sample / batch.group + id.z * GROUPS_IN_TURN) * batch.group;
    uint first = max(batch.first_sample, start);
    // From `first` on, so that the last numbers of all do not overflow.
    uint count = min(batch.group * GROUPS_IN_TURN - (first - start), batch.end_sample - first);
    uint group_end = min(batch.group - (first - start), count);
    uint pixels = batch.tile_width * batch.tile_height;
    uint slot = id.z * GROUPS_IN_TURN * pixels + id.y * batch.tile_width + id.x;

    // A driver that ends a long loop (Mesa before 23 does, after 65 535 rounds) leaves these: groups of which all samples are lost.
    for (uint s = slot, from = 0u, to = group_end; from < count; s += pixels, from = to, to = min(to + batch.group, count)) {
        sums[s] = PixelSum(float[3](0.0, 0.0, 0.0), 0u, 0u, to - from);
    }

    // One loop over the bounces of all samples: a lane whose path ends starts its next one while the others go on.
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
            offset++;
            if (offset == group_end) {
                sums[slot] = PixelSum(float[3](sum.x, sum.y, sum.z), rays.x, rays.y, not_finite);
                if (offset == count) break;
                slot += pixels;
                group_end = min(group_end + batch.group, count);
                sum = vec3(0.0);
                rays = uvec2(0u);
                not_finite = 0u;
            }
            sample_index = first + offset;
            path = camera_path(pixel, pixel_index, sample_index);
        }
    }
}
