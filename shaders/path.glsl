// The estimator (slides "Path Trace Function" to "Adding Transmission"): the recursion as a loop with a throughput.

struct Path {
    vec3 origin;        // of the ray to trace next
    vec3 from;          // the point of the surface that it leaves
    vec3 normal;        // the shading normal there, where LIGHT_TREE
    vec3 direction;
    vec3 throughput;    // what a unit of radiance along that ray adds to the pixel
    vec3 radiance;      // what was found so far
    uint bounce;        // surfaces met so far; NONE at the end of one that met nothing, where TRANSPARENT
    float pdf;          // density per steradian with which the path went there (`surviving`); or IMPULSE, also for the camera's
    float eta_scale;    // product of the squared relative indices that were passed, by which refraction diluted the throughput
    bool scattered;     // by a lobe, at some surface before; unless there are no impulses
    vec3 albedo;        // product of the albedos (combinedAlbedo)
    vec3 absorption;    // of the body into which the path left the last surface, where VOLUMES
};

Path camera_path(uvec2 pixel, uint pixel_index, uint sample_index) {
    vec3 origin, direction;
    sensor_ray(pixel, pixel_index, sample_index, origin, direction);
    return Path(origin, origin, vec3(0.0), direction, vec3(1.0), vec3(0.0), 0u, IMPULSE, 1.0, false, vec3(1.0), vec3(0.0));
}

// What roulette is told of the throughput at the surface that the path has met.
vec3 roulette_throughput(Path path) {
    bool begun = IMPULSES ? path.scattered || path.bounce >= SURE_IMPULSES : path.bounce > 0u;
    return begun ? path.throughput * (DIELECTRICS ? path.eta_scale : 1.0) : vec3(AMPLE_THROUGHPUT);
}

// A path that would be longer is lost (src/reference/path.rs).
const uint LONGEST_PATH = 32768u;

bool is_finite(vec3 v) {
    // By the bits: a compiler may assume that no float is infinite.
    uvec3 exponent = floatBitsToUint(v) & INFINITY_BITS;
    return all(notEqual(exponent, uvec3(INFINITY_BITS)));
}

// Traces the path's ray and whatever happens at the surface it meets: once through the loop of `radiance` in the reference.
// Returns false when the path has ended. Its radiance is not finite if its numbers were not, or if it is lost.
bool extend_path(inout Path path, uint pixel_index, uint sample_index, inout uvec2 rays) {
    Hit hit;
    rays.x++;
    uint salt = HOLES ? ray_salt(pixel_index, sample_index, 2u * path.bounce, frame.seed) : 0u;
    bool met = closest_hit(path.origin, path.direction, INFINITY, salt, hit);
    float last_hole = 0.0;
    if (PIERCED_BODIES) {
        path.throughput *= through_holes(path.origin, path.direction, 1.0, met ? hit.t : FAR_AWAY, salt, path.absorption, last_hole);
    }
    if (!met) {
        if (TRANSPARENT && path.bounce == 0u) {
            path.bounce = NONE;
            return false;
        }
        if (VOLUMES) path.throughput *= vec3(equal(path.absorption, vec3(0.0)));
        // Without an environment escaping light disappears.
        if (ENVIRONMENT) {
            float density = 0.0;
            if (ENVIRONMENT_SAMPLING && LIGHT_SAMPLING == LIGHT_MIS && path.pdf != IMPULSE) {
                density = environment_probability() * environment_density(path.direction);
            }
            float weight = emission_weight(path.pdf, density);
            if (weight > 0.0) path.radiance += path.throughput * environment_radiance(path.direction) * weight;
        }
        if (SUNS) path.radiance += path.throughput * sunlight(path.direction, path.pdf);
        return false;
    }
    vec3 wo = -path.direction;
    Surfel s = surfel(hit, wo);
    Material material = material_at(s);
    if (PHYSICAL) find_lobes(s, material, wo);
    if (VOLUMES) {
        // Inside of a body, as the surface says that the ray comes to, or else the one that it left.
        vec3 absorption = inner_absorption(s, material, wo);
        if (absorption == vec3(0.0)) absorption = path.absorption;
        if (absorption != vec3(0.0)) path.throughput *= absorbed(absorption, hit.t - last_hole);
    }

    if (AREA_LUMINAIRES && material.emission != vec3(0.0)) {
        float density = 0.0;
        if (LIGHT_SAMPLING == LIGHT_MIS && path.pdf != IMPULSE) {
            density = triangle_density(path.from, path.normal, path.direction, hit, material.area_density);
        }
        path.radiance += path.throughput * material.emission * emission_weight(path.pdf, density);
    }
    if (SIMPLE) path.radiance += frame.ambient.rgb * material.ambient;
    // One bounce more than allowed: only the emission was still direct light.
    if (!SIMPLE && path.bounce > frame.max_bounces) return false;

    Impulses i = impulses(s, material, wo);
    bool glossy_or_lambert = material.lambert != vec3(0.0) || (GLOSSY && material.glossy != vec3(0.0));
    if (is_physical(material)) glossy_or_lambert = scatters(s.lobes.p);
    if (LIGHT_SAMPLING != LIGHT_NONE && (!IMPULSES || glossy_or_lambert)) {
        uvec4 random = numbers(pixel_index, sample_index, light_block(path.bounce), frame.seed);
        salt = HOLES ? ray_salt(pixel_index, sample_index, 2u * path.bounce + 1u, frame.seed) : 0u;
        vec3 seen = roulette_throughput(path);
        path.radiance += path.throughput * direct_light(s, material, wo, seen, random, 1.0 - i.probability, salt, rays);
    }
    if (SIMPLE) return false;
    bool last = path.bounce == frame.max_bounces;
    // Direct light has found all but what impulses find.
    if (last && LIGHT_SAMPLING == LIGHT_DIRECT && !IMPULSES) return false;

    uvec4 random = numbers(pixel_index, sample_index, scatter_block(path.bounce), frame.seed);
    float reweighted = 1.0;
    if (EXTINCTION == EXTINCTION_LITERAL || EXTINCTION == EXTINCTION_SURFACE) {
        float alive = survival(s, material);
        // Written so that a path whose numbers are not numbers ends too.
        if (!(uniform1(random.w) < alive)) return false;
        // The survivors stand for those that ended; the slide forgets that.
        if (EXTINCTION == EXTINCTION_SURFACE) {
            reweighted = alive;
            path.throughput /= alive;
        }
    }
    Scattering next = scatter(s, material, i, wo, random);
    if (last && LIGHT_SAMPLING == LIGHT_DIRECT && next.pdf != IMPULSE) return false;
    path.throughput *= next.weight / next.eta2;
    if (path.throughput == vec3(0.0)) return false;
    // A path that overflowed: not black but lost, and it has to be counted.
    if (!is_finite(path.throughput) || !is_finite(next.wi)) {
        path.radiance = vec3(uintBitsToFloat(0x7fc00000u));
        return false;
    }
    if (THRESHOLD) {
        path.albedo *= next.weight;
        if (largest(path.albedo) < frame.albedo_threshold) return false;
    }
    if (EXTINCTION == EXTINCTION_THROUGHPUT) {
        if (DIELECTRICS) path.eta_scale *= next.eta2;
        float alive = min(largest(roulette_throughput(path)) / SURE_THROUGHPUT, 1.0);
        if (!(uniform1(random.w) < alive)) return false;
        reweighted = alive;
        path.throughput /= alive;
    }
    if (IMPULSES && next.pdf != IMPULSE) path.scattered = true;
    path.from = s.position;
    if (LIGHT_TREE) path.normal = receiver(s, material);
    if (VOLUMES) path.absorption = inner_absorption(s, material, next.wi);
    path.origin = offset_ray_origin(s.position, s.position_error, s.geometric_normal, next.wi);
    path.direction = next.wi;
    path.pdf = next.pdf == IMPULSE ? IMPULSE : next.pdf * reweighted;
    path.bounce++;
    // Light that nothing absorbs: lost, and it has to be counted.
    if (path.bounce == LONGEST_PATH) {
        path.radiance = vec3(uintBitsToFloat(0x7fc00000u));
        return false;
    }
    return true;
}
