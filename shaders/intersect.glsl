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
//
// The first surface that the ray passes through a hole (`is_passed`), in (t_min, t_max), up to where nothing stops it:
//
// bool next_passed(vec3 origin, vec3 direction, float t_min, float t_max, uint salt, out Hit hit);

#define INFINITY uintBitsToFloat(INFINITY_BITS)

// Beyond all that is hit. Not an infinity, of which a compiler may assume that there is none.
const float FAR_AWAY = 1e30;

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// The cross product of the two shorter edges, towards where the corners are counter-clockwise: it rounds by their lengths, and that of a
// narrow triangle's two long edges would be their small difference.
vec3 triangle_normal(vec3 a, vec3 b, vec3 c) {
    vec3 ab = b - a;
    vec3 bc = c - b;
    vec3 ca = a - c;
    float length_ab = largest(abs(ab));
    float length_bc = largest(abs(bc));
    float length_ca = largest(abs(ca));
    if (length_ab >= max(length_bc, length_ca)) return cross(bc, ca);
    return length_bc >= length_ca ? cross(ca, ab) : cross(ab, bc);
}

// The product of their lengths, each by its largest coordinate.
float shorter_edges(vec3 a, vec3 b, vec3 c) {
    float ab = largest(abs(b - a));
    float bc = largest(abs(c - b));
    float ca = largest(abs(a - c));
    float longest = max(ab, max(bc, ca));
    return longest == ab ? bc * ca : (longest == bc ? ab * ca : ab * bc);
}

#ifdef RAY_QUERY
#include "intersect_ray_query.glsl"
#else
#include "intersect_bvh.glsl"
#endif
