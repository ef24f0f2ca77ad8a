// The estimator (slides "Path Trace Function" to "Recursion"): the recursion as a loop with a throughput.

struct Path {
    vec3 origin;        // of the ray to trace next
    vec3 direction;
    vec3 throughput;    // what a unit of radiance along that ray adds to the pixel
    vec3 radiance;      // what was found so far
    uint bounce;        // surfaces met so far
};

Path camera_path(uvec2 pixel, uint pixel_index, uint sample_index) {
    return Path(frame.position.xyz, sensor_ray(pixel, pixel_index, sample_index), vec3(1.0), vec3(0.0), 0u);
}

// Traces the path's ray and whatever happens at the surface it meets: once through the loop of `radiance` in the reference.
// Returns false when the path has ended.
bool extend_path(inout Path path, uint pixel_index, uint sample_index, inout uint rays) {
    Hit hit;
    rays++;
    // Escaping light disappears.
    if (!closest_hit(path.origin, path.direction, INFINITY, hit)) return false;
    vec3 wo = -path.direction;
    Surfel s = surfel(hit, wo);
    Material material = materials[s.material];

    // Light sampling has counted the emission that later bounces find.
    if (AREA_LUMINAIRES && path.bounce == 0u) path.radiance += material.emission.rgb;
    if (SIMPLE) path.radiance += frame.ambient.rgb * material.ambient.rgb;
    uvec4 random = random4(pixel_index, sample_index, light_block(path.bounce), frame.seed);
    path.radiance += path.throughput * direct_light(s, material, wo, random, rays);
    if (SIMPLE || path.bounce == frame.max_bounces) return false;

    // Extinction; the survivor carries the weight of those that did not.
    float alive = survival(material);
    if (uniform1(random.w) >= alive) return false;
    uvec4 turn = random4(pixel_index, sample_index, scatter_block(path.bounce), frame.seed);
    vec3 wi;
    path.throughput *= scatter(s, material, wo, uniform2(turn.xy), wi) / alive;
    if (path.throughput == vec3(0.0)) return false;
    path.origin = offset_ray_origin(s.position, s.position_error, s.geometric_normal, wi);
    path.direction = wi;
    path.bounce++;
    return true;
}
