// Traces rays and does nothing else: what an intersector costs by itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef RAY_QUERY
#extension GL_EXT_ray_query : require
#endif

layout(local_size_x = 64) in;

#include "scene.glsl"
#include "rng.glsl"
#include "texture.glsl"
#include "intersect.glsl"

layout(push_constant, std430) uniform Shots {
    uint first;    // index of the first ray
    uint count;    // how many
    uint any_hit;  // 0: closest_hit, 1: occluded
    float never;   // a number that no result is equal to
} shots;

// Bits of t, infinity for a miss; of an any-hit ray 1 where something is in its way, else 0.
layout(set = 0, binding = 7, std430) writeonly buffer Out { uint results[]; };
// Two a ray: origin and t_max, direction and nothing.
layout(set = 0, binding = 8, std430) readonly buffer In { uvec4 rays[]; };

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= shots.count) return;
    uvec4 x = rays[2u * (shots.first + id)];
    vec3 origin = uintBitsToFloat(x.xyz);
    vec3 direction = uintBitsToFloat(rays[2u * (shots.first + id) + 1u].xyz);
    float t_max = uintBitsToFloat(x.w);
    uint result = INFINITY_BITS;
    if (shots.any_hit != 0u) {
        result = floatBitsToUint(occluded(origin, direction, t_max, 0u) ? 1.0 : 0.0);
    } else {
        Hit hit;
        if (closest_hit(origin, direction, t_max, 0u, hit)) result = floatBitsToUint(hit.t);
    }
    // The same rays again along y, whose results are only looked at: that keeps the compiler from leaving them out, and no two
    // invocations write to one place.
    if (gl_GlobalInvocationID.y == 0u || result == floatBitsToUint(shots.never)) results[id] = result;
}
