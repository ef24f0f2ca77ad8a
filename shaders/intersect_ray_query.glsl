// closest_hit and occluded on Vulkan ray queries. Include it through intersect.glsl.

layout(set = 0, binding = 1) uniform accelerationStructureEXT top_level;

bool closest_hit(vec3 origin, vec3 direction, float t_max, out Hit hit) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, top_level, gl_RayFlagsOpaqueEXT, 0xffu, origin, 0.0, direction, t_max);
    while (rayQueryProceedEXT(query)) {}
    if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionTriangleEXT) return false;
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    hit.object = INSTANCES ? uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true)) : 0u;
    hit.triangle = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    if (INSTANCES) hit.triangle += objects[hit.object].triangle_offset;
    hit.barycentric = rayQueryGetIntersectionBarycentricsEXT(query, true);
    return true;
}

bool occluded(vec3 origin, vec3 direction, float t_max) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, top_level, gl_RayFlagsOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT, 0xffu, origin, 0.0,
                          direction, t_max);
    while (rayQueryProceedEXT(query)) {}
    return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}
