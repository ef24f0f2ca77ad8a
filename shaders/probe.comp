// Runs single functions over arrays, so that tests can check each by itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef RAY_QUERY
#extension GL_EXT_ray_query : require
#endif

layout(local_size_x = 64) in;

#include "scene.glsl"
#include "rng.glsl"
#include "warp.glsl"
#include "intersect.glsl"
#include "surfel.glsl"
#include "scatter.glsl"
#include "luminaire.glsl"

// Which function; the numbers are those of `Function` in src/gpu/probe.rs.
layout(push_constant, std430) uniform Call {
    uint function;
    uint count;
} call;

const uint RANDOM4 = 0u;              // in: pixel, sample, block, seed; out: the numbers
const uint CLOSEST_HIT = 1u;          // in: origin, t_max; direction; out: t, object, triangle, barycentrics
const uint OCCLUDED = 2u;             // in: the same; out: 0 or 1
const uint COSINE_HEMISPHERE = 3u;    // in: u; out: direction
const uint UNIFORM_TRIANGLE = 4u;     // in: u; out: barycentrics
const uint CHOOSE_LUMINAIRE = 5u;     // in: random bits; out: index
const uint BSDF = 6u;                 // in: material, wo; wi (normal +z); out: f
const uint LEAVE = 7u;                // as CLOSEST_HIT, then a ray leaves the hit mirrored; out: t of its closest hit, that hit

layout(set = 0, binding = 7, std430) writeonly buffer Out { uvec4 results[]; };
layout(set = 0, binding = 8, std430) readonly buffer In { uvec4 arguments[]; };

void write_hit(uint id, bool found, Hit hit) {
    if (!found) {
        results[2u * id] = uvec4(0x7f800000u, NONE, NONE, 0u);
        return;
    }
    uint original = texelFetch(triangles, int(hit.triangle) * 3 + 1).w;
    results[2u * id] = uvec4(floatBitsToUint(hit.t), objects[hit.object].scene_index, original, 0u);
    results[2u * id + 1u] = uvec4(floatBitsToUint(hit.barycentric), 0u, 0u);
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= call.count) return;
    uvec4 x = arguments[2u * id];
    uvec4 y = arguments[2u * id + 1u];
    uvec4 result = uvec4(0u);
    switch (call.function) {
    case RANDOM4:
        result = random4(x.x, x.y, x.z, x.w);
        break;
    case CLOSEST_HIT: {
        Hit hit;
        bool found = closest_hit(uintBitsToFloat(x.xyz), uintBitsToFloat(y.xyz), uintBitsToFloat(x.w), hit);
        write_hit(id, found, hit);
        return;
    }
    case OCCLUDED:
        result.x = occluded(uintBitsToFloat(x.xyz), uintBitsToFloat(y.xyz), uintBitsToFloat(x.w)) ? 1u : 0u;
        break;
    case COSINE_HEMISPHERE:
        result.xyz = floatBitsToUint(cosine_hemisphere(uintBitsToFloat(x.xy)));
        break;
    case UNIFORM_TRIANGLE:
        result.xyz = floatBitsToUint(uniform_triangle(uintBitsToFloat(x.xy)));
        break;
    case CHOOSE_LUMINAIRE:
        result.x = choose_luminaire(x.x);
        break;
    case BSDF: {
        Surfel s = Surfel(vec3(0.0), vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), x.w);
        result.xyz = floatBitsToUint(bsdf(s, materials[x.w], uintBitsToFloat(x.xyz), uintBitsToFloat(y.xyz)));
        break;
    }
    case LEAVE: {
        Hit hit;
        vec3 direction = normalize(uintBitsToFloat(y.xyz));
        bool found = closest_hit(uintBitsToFloat(x.xyz), direction, INFINITY, hit);
        if (found) {
            Surfel s = surfel(hit, -direction);
            vec3 wi = reflect(direction, s.geometric_normal);
            found = closest_hit(offset_ray_origin(s.position, s.position_error, s.geometric_normal, wi), wi, INFINITY, hit);
        }
        write_hit(id, found, hit);
        return;
    }
    }
    results[2u * id] = result;
}
