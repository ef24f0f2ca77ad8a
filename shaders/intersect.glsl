// The contract between the path tracer and whatever finds intersections: nothing past this file knows the backend.
//
// A ray is origin + t * direction with t in (0, t_max); the direction need not be a unit vector.

struct Hit {
    float t;
    uint object;         // index into `objects`
    uint triangle;       // index into `triangles`, in units of a triangle
    vec2 barycentric;    // weights of the second and third corner
};

// `salt` decides about surfaces that are partly transparent (`covers` in texture.glsl).
//
// bool closest_hit(vec3 origin, vec3 direction, float t_max, uint salt, out Hit hit);
// bool occluded(vec3 origin, vec3 direction, float t_max, uint salt);

#define INFINITY uintBitsToFloat(0x7f800000u)

#ifdef RAY_QUERY
#include "intersect_ray_query.glsl"
#else
#include "intersect_bvh.glsl"
#endif
