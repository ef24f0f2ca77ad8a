// What the camera sees first, added up over samples of every pixel: albedo, normal, depth. For denoisers and compositing.
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
#include "impulse.glsl"
#include "sensor.glsl"
#include "batch.glsl"

struct AovSum {
    float albedo[3];
    float depth;
    float normal[3];
    uint hits;
};
layout(set = 0, binding = 7, std430) writeonly buffer Aovs { AovSum aovs[]; };

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= batch.tile_width || id.y >= batch.tile_height) return;
    uvec2 pixel = uvec2(batch.tile_x, batch.tile_y) + id.xy;
    uint pixel_index = pixel.y * frame.width + pixel.x;
    vec3 albedo = vec3(0.0);
    vec3 normal = vec3(0.0);
    float depth = 0.0;
    uint hits = 0u;
    for (uint sample_index = batch.first_sample; sample_index < batch.end_sample; sample_index++) {
        vec3 origin, direction;
        sensor_ray(pixel, pixel_index, sample_index, origin, direction);
        Hit hit;
        uint salt = HOLES ? ray_salt(pixel_index, sample_index, 0u, frame.seed) : 0u;
        if (!closest_hit(origin, direction, INFINITY, salt, hit)) continue;
        Surfel s = surfel(hit, -direction);
        Material material = material_at(s);
        if (PHYSICAL) find_lobes(s, material, -direction);
        vec3 base = material.lambert;
        if (GLOSSY) base += material.glossy;
        if (is_physical(material)) {
            albedo += normal_albedo(s.lobes.p);
        } else if (DIELECTRICS && material.eta != MIRROR && material.transmission == vec3(0.0)) {
            // As from straight above; on a black base too, which a map may have in places.
            albedo += base + material.reflection * fresnel(material.eta, 1.0) * (1.0 - base);
        } else {
            albedo += base;
            // Of glass either the one or the other.
            if (IMPULSES) albedo += max(material.reflection, DIELECTRICS ? material.transmission : vec3(0.0));
        }
        normal += s.shading_normal;
        depth += dot((SMOOTH_TERMINATOR ? s.position - s.lift : s.position) - frame.position.xyz, frame.axis.xyz) + frame.start;
        hits++;
    }
    aovs[id.y * batch.tile_width + id.x] =
        AovSum(float[3](albedo.x, albedo.y, albedo.z), depth, float[3](normal.x, normal.y, normal.z), hits);
}
