// closest_hit and occluded on Vulkan ray queries. Include it through intersect.glsl.

layout(set = 0, binding = 1) uniform accelerationStructureEXT top_level;

// Instances with holes are not opaque; their triangles come back as candidates.
const uint RAY_FLAGS = HOLES ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT;

// Index into `triangles` and `objects` of a candidate or of the committed hit.
#define OBJECT_OF(query, committed) (INSTANCES ? uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, committed)) : 0u)
#define TRIANGLE_OF(query, committed) \
    (uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, committed)) \
     + (INSTANCES ? object_place(uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, committed))).triangle_offset : 0u))

// Traverses to the end; stops at a candidate by the rule of `covers`.
#define PROCEED(query, salt) \
    while (rayQueryProceedEXT(query)) { \
        if (HOLES && rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionTriangleEXT \
            && covers(salt, OBJECT_OF(query, false), TRIANGLE_OF(query, false), \
                      rayQueryGetIntersectionBarycentricsEXT(query, false))) { \
            rayQueryConfirmIntersectionEXT(query); \
        } \
    }

// Ends the function: whether something is committed, with the hit. (A query cannot be given to a function.)
#define RETURN_COMMITTED(query, hit) \
    if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionTriangleEXT) return false; \
    hit.t = rayQueryGetIntersectionTEXT(query, true); \
    hit.object = OBJECT_OF(query, true); \
    hit.triangle = TRIANGLE_OF(query, true); \
    hit.barycentric = rayQueryGetIntersectionBarycentricsEXT(query, true); \
    return true;

// A query with numbers that are not numbers is undefined.
bool is_ray(vec3 origin, vec3 direction) {
    float size = dot(abs(direction), vec3(1.0));
    return size > 0.0 && size < 1e38 && dot(abs(origin), vec3(1.0)) < 1e38;
}

bool closest_hit(vec3 origin, vec3 direction, float t_max, uint salt, out Hit hit) {
    if (!is_ray(origin, direction)) return false;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, top_level, RAY_FLAGS, 0xffu, origin, 0.0, direction, t_max);
    PROCEED(query, salt)
    RETURN_COMMITTED(query, hit)
}

bool next_passed(vec3 origin, vec3 direction, float t_min, float t_max, uint salt, out Hit hit) {
    if (!is_ray(origin, direction)) return false;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, top_level, gl_RayFlagsCullOpaqueEXT, 0xffu, origin, 0.0, direction, t_max);
    while (rayQueryProceedEXT(query)) {
        if (rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionTriangleEXT
            && rayQueryGetIntersectionTEXT(query, false) > t_min
            && is_passed(salt, OBJECT_OF(query, false), TRIANGLE_OF(query, false), rayQueryGetIntersectionBarycentricsEXT(query, false))) {
            rayQueryConfirmIntersectionEXT(query);
        }
    }
    RETURN_COMMITTED(query, hit)
}

bool occluded(vec3 origin, vec3 direction, float t_max, uint salt) {
    if (!is_ray(origin, direction)) return false;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, top_level, RAY_FLAGS | gl_RayFlagsTerminateOnFirstHitEXT, 0xffu, origin, 0.0, direction, t_max);
    PROCEED(query, salt)
    return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}
