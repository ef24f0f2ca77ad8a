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
const uint BSDF = 6u;                 // in: wo, material; wi (normal +z); out: f, pdf
const uint LEAVE = 7u;                // as CLOSEST_HIT, then a ray leaves the hit mirrored; out: t of its closest hit, that hit
const uint UNIFORM_HEMISPHERE = 8u;   // in: u; out: direction
const uint GLOSSY_HALF_VECTOR = 9u;   // in: u, m; out: direction
const uint SCATTER = 10u;             // in: wo, material; random (normal +z, outside); out: wi, pdf (-1: impulse); weight, eta^2
const uint SPHERICAL_TRIANGLE = 11u;  // in: point, luminaire; u; out: direction, solid angle (0: too far)
const uint SAMPLE_ENVIRONMENT = 12u;  // in: two numbers; out: direction, density
const uint ENVIRONMENT_AT = 13u;      // in: direction; out: radiance, density
const uint TEXTURE_AT = 14u;          // in: map, uv; out: color and alpha
const uint REFRACT = 15u;             // in: wo, eta (normal +z); out: direction, Fresnel's reflectance
const uint SENSOR_RAY = 16u;          // in: pixel x, y, index, sample; out: origin; direction
const uint NUMBERS = 17u;             // in: pixel, sample, block, seed; out: the sampler's numbers
const uint COVERAGE = 18u;            // in: pixel, sample, ray, seed; object, triangle; out: salt, number
const uint CHOOSE_BY_TREE = 20u;      // in: point, random; normal, further bits; out: index (NONE: none), probability
const uint TREE_PROBABILITY = 21u;    // in: point, place among the paths; normal; out: probability
const uint SAMPLE_SUN = 22u;          // in: u, luminaire; out: direction, density
const uint INTENSITY = 23u;           // in: direction, luminaire (spot or photometric); out: what its intensity is multiplied by
const uint SIN_COS = 19u;             // in: turns; y, x; out: sin and cos; angle(y, x)

layout(set = 0, binding = 7, std430) writeonly buffer Out { uvec4 results[]; };
layout(set = 0, binding = 8, std430) readonly buffer In { uvec4 arguments[]; };

void write_hit(uint id, bool found, Hit hit) {
    if (!found) {
        results[2u * id] = uvec4(INFINITY_BITS, NONE, NONE, 0u);
        return;
    }
    uint index_in_mesh = load_triangle(hit.triangle).index_in_mesh;
    results[2u * id] = uvec4(floatBitsToUint(hit.t), object_place(hit.object).scene_index, index_in_mesh, 0u);
    results[2u * id + 1u] = uvec4(floatBitsToUint(hit.barycentric), 0u, 0u);
}

// The bit of a material that says that its surface is seen from inside.
const uint INSIDE = 0x80000000u;

// A surface at the origin whose normal is +z; the first texture coordinate grows along +x.
Surfel upward(uint material) {
    Surfel s;
    s.position = vec3(0.0);
    s.position_error = vec3(0.0);
    s.geometric_normal = vec3(0.0, 0.0, 1.0);
    s.shading_normal = vec3(0.0, 0.0, 1.0);
    s.material = material & ~INSIDE;
    s.front = (material & INSIDE) == 0u;
    s.uv = vec2(0.0);
    s.colour = vec3(1.0);
    s.tangent = vec4(1.0, 0.0, 0.0, 1.0);
    s.horizon = vec3(0.0, 0.0, 1.0);
    return s;
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
        bool found = closest_hit(uintBitsToFloat(x.xyz), uintBitsToFloat(y.xyz), uintBitsToFloat(x.w), 0u, hit);
        write_hit(id, found, hit);
        return;
    }
    case OCCLUDED:
        result.x = occluded(uintBitsToFloat(x.xyz), uintBitsToFloat(y.xyz), uintBitsToFloat(x.w), 0u) ? 1u : 0u;
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
        Surfel s = upward(x.w);
        vec3 wo = uintBitsToFloat(x.xyz);
        Material material = load_material(s.material);
        if (PHYSICAL) find_lobes(s, material, wo);
        vec4 f = bsdf_and_pdf(s, material, wo, uintBitsToFloat(y.xyz));
        f.w *= 1.0 - impulses(s, material, wo).probability;
        result = floatBitsToUint(f);
        break;
    }
    case UNIFORM_HEMISPHERE:
        result.xyz = floatBitsToUint(uniform_hemisphere(uintBitsToFloat(x.xy)));
        break;
    case GLOSSY_HALF_VECTOR:
        result.xyz = floatBitsToUint(glossy_half_vector(uintBitsToFloat(x.z), uintBitsToFloat(x.xy)));
        break;
    case SCATTER: {
        Surfel s = upward(x.w);
        vec3 wo = uintBitsToFloat(x.xyz);
        Material material = load_material(s.material);
        if (PHYSICAL) find_lobes(s, material, wo);
        Scattering next = scatter(s, material, impulses(s, material, wo), wo, y);
        results[2u * id] = floatBitsToUint(vec4(next.wi, next.pdf));
        results[2u * id + 1u] = floatBitsToUint(vec4(next.weight, next.eta2));
        return;
    }
    case SPHERICAL_TRIANGLE: {
        Luminaire light = load_luminaire(x.w);
        vec3 v[3];
        float omega;
        if (is_near(uintBitsToFloat(x.xyz), light.a, light.b, light.c, light.area, v, omega)) {
            result = floatBitsToUint(vec4(spherical_triangle(v, omega, uintBitsToFloat(y.xy)), omega));
        }
        break;
    }
    case SAMPLE_ENVIRONMENT: {
        float density;
        vec3 wi = sample_environment(x.xy, density);
        result = floatBitsToUint(vec4(wi, density));
        break;
    }
    case SAMPLE_SUN: {
        Luminaire sun = load_luminaire(x.z);
        result = floatBitsToUint(vec4(sample_sun(sun, uintBitsToFloat(x.xy)), sun_density(sun)));
        break;
    }
    case INTENSITY: {
        Luminaire light = load_luminaire(x.w);
        vec3 direction = uintBitsToFloat(x.xyz);
        result.x = floatBitsToUint(light.kind == SPOT ? spot_falloff(light, direction) : photometric_intensity(light, direction));
        break;
    }
    case ENVIRONMENT_AT: {
        vec3 wi = uintBitsToFloat(x.xyz);
        result = floatBitsToUint(vec4(environment_radiance(wi), environment_density(wi)));
        break;
    }
    case TEXTURE_AT:
        result = floatBitsToUint(texture_at(x.x, uintBitsToFloat(x.yz)));
        break;
    case REFRACT: {
        vec3 wo = uintBitsToFloat(x.xyz);
        float eta = uintBitsToFloat(x.w);
        result = floatBitsToUint(vec4(refract_direction(wo, vec3(0.0, 0.0, 1.0), eta), fresnel(eta, wo.z)));
        break;
    }
    case SENSOR_RAY: {
        vec3 origin, direction;
        sensor_ray(x.xy, x.z, x.w, origin, direction);
        results[2u * id] = floatBitsToUint(vec4(origin, 0.0));
        results[2u * id + 1u] = floatBitsToUint(vec4(direction, 0.0));
        return;
    }
    case NUMBERS:
        result = numbers(x.x, x.y, x.z, x.w);
        break;
    case COVERAGE:
        result.x = ray_salt(x.x, x.y, x.z, x.w);
        result.y = coverage(result.x, y.x, y.y);
        break;
    case SIN_COS:
        result = floatBitsToUint(vec4(sin_cos_turns(uintBitsToFloat(x.x)), angle(uintBitsToFloat(y.x), uintBitsToFloat(y.y)), 0.0));
        break;
    case CHOOSE_BY_TREE: {
        float probability = 0.0;
        bool found = choose_by_tree(uintBitsToFloat(x.xyz), uintBitsToFloat(y.xyz), x.w, y.w, result.x, probability);
        result.xy = found ? uvec2(result.x, floatBitsToUint(probability)) : uvec2(NONE, 0u);
        break;
    }
    case TREE_PROBABILITY:
        result.x = floatBitsToUint(tree_probability(uintBitsToFloat(x.xyz), uintBitsToFloat(y.xyz), light_path(x.w)));
        break;
    case LEAVE: {
        Hit hit;
        vec3 direction = normalize(uintBitsToFloat(y.xyz));
        bool found = closest_hit(uintBitsToFloat(x.xyz), direction, INFINITY, 0u, hit);
        if (found) {
            Surfel s = surfel(hit, -direction);
            vec3 wi = reflect(direction, s.geometric_normal);
            found = closest_hit(offset_ray_origin(s.position, s.position_error, s.geometric_normal, wi), wi, INFINITY, 0u, hit);
        }
        write_hit(id, found, hit);
        return;
    }
    }
    results[2u * id] = result;
}
