// Direct light (slides "Lighting Functions", "Shadows & Attenuation", "Area Luminaires"), with the densities that they leave out, and
// the weights of light that is found twice.

// A triangle is near where its area over the squared distance to its centroid is above this (twins: src/reference/luminaire.rs).
const float NEAR = 0.05;
// Triangles that look smaller, in steradian, are sampled by area: solid angles cancel.
const float LEAST_SOLID_ANGLE = 1e-3;

// One luminaire, in proportion to its power, by an alias table.
uint choose_luminaire(uint random) {
    uint slot, fraction;
    umulExtended(random, frame.luminaire_count, slot, fraction);
    AliasSlot entry = luminaire_slot(slot);
    return fraction < entry.threshold ? slot : entry.alias;
}

// The power heuristic's weight of a density next to another one (Veach and Guibas 1995).
float power_heuristic(float own, float other) {
    float ratio = other / own;
    return 1.0 / (1.0 + ratio * ratio);
}

// Whether a triangle is so near to `p` that it is sampled by solid angle; if so, its corners' directions and that angle.
bool is_near(vec3 p, vec3 a, vec3 b, vec3 c, float area, out vec3 v[3], out float omega) {
    omega = 0.0;
    if (!SOLID_ANGLE) return false;
    vec3 d = (a + b + c) * (1.0 / 3.0) - p;
    if (area <= NEAR * dot(d, d)) return false;
    v[0] = normalize(a - p);
    v[1] = normalize(b - p);
    v[2] = normalize(c - p);
    omega = solid_angle(v);
    return omega > LEAST_SOLID_ANGLE;
}

// The density per steradian with which direct_light at `p`, where the shading normal is `n`, gives the direction in which a ray from there met an emissive triangle.
float triangle_density(vec3 p, vec3 n, vec3 wi, Hit hit, float area_density) {
    Triangle triangle = load_triangle(hit.triangle);
    vec3 a = triangle.a;
    vec3 b = triangle.b;
    vec3 c = triangle.c;
    if (INSTANCES) {
        vec4 to_world[3];
        object_to_world(hit.object, to_world);
        a = row_dot(to_world, a) + translation(to_world);
        b = row_dot(to_world, b) + translation(to_world);
        c = row_dot(to_world, c) + translation(to_world);
    }
    vec3 normal = cross(b - a, c - a);
    // Scaled first, so that the squares of a tiny or huge triangle's normal neither vanish nor overflow.
    float scale = largest(abs(normal));
    float double_area = scale * length(normal / scale);
    float area = 0.5 * double_area;
    if (by_light_tree()) {
        float chosen = tree_probability(p, n, light_path(hit));
        // One that is never chosen may be seen from the edge, where the density would be infinite.
        if (chosen == 0.0) return 0.0;
        area_density = chosen / area;
    } else {
        area_density = max(area_density, frame.least_probability / area);
    }
    vec3 v[3];
    float omega;
    if (is_near(p, a, b, c, area, v, omega)) return area_density * area / omega;
    // Choosing the triangle is in proportion to its area, and the point on it to one over its area.
    return area_density * hit.t * hit.t * double_area / abs(dot(normal, wi));
}

// The weight of emission that a ray with the density `pdf` (see `surviving`) found, where `density` is that of direct light.
float emission_weight(float pdf, float density) {
    if (LIGHT_SAMPLING == LIGHT_NONE || pdf == IMPULSE) return 1.0;
    if (LIGHT_SAMPLING == LIGHT_DIRECT) return 0.0;
    return power_heuristic(pdf, density);
}

// What a path that escapes with the density `pdf` finds of the discs at infinity, each with its weight.
vec3 sunlight(vec3 direction, float pdf) {
    vec3 radiance = vec3(0.0);
    for (uint i = 0u; i < frame.sun_count; i++) {
        Luminaire sun = load_luminaire(frame.first_sun + i);
        if (one_minus_cosine(direction, sun.a) > sun.area) continue;
        float density = 0.0;
        if (LIGHT_SAMPLING == LIGHT_MIS && pdf != IMPULSE) density = sun_probability(i, sun) * sun_density(sun);
        radiance += sun.radiance * emission_weight(pdf, density);
    }
    return radiance;
}

// The share of a spot's intensity that it sends along `direction`, a unit vector.
float spot_falloff(Luminaire light, vec3 direction) {
    float inside = clamp((light.area - one_minus_cosine(direction, light.b)) * light.position_error, 0.0, 1.0);
    return inside * inside;
}

// Light from one luminaire that `s` sends towards `wo`; `throughput` is the path's so far, without eta^2, and `rest` the probability that
// it takes no impulse there. Adds the shadow ray to `rays` (all, shadow).
vec3 direct_light(Surfel s, Material material, vec3 wo, vec3 throughput, uvec4 random, float rest, uint salt, inout uvec2 rays) {
    if (frame.luminaire_count == 0u) return vec3(0.0);
    bool tree = by_light_tree();
    uint chosen;
    float probability = 0.0;
    if (!tree) chosen = choose_luminaire(random.z);
    else if (!choose_by_tree(s.position, receiver(s, material), random.z, random.w, chosen, probability)) return vec3(0.0);
    Luminaire light = load_luminaire(chosen);
    if (tree) {
        light.probability = probability;
        light.ideal_probability = probability;
    }
    // With one kind of luminaire in the scene these are constants.
    bool several = int(POINT_LUMINAIRES) + int(INFINITE_LUMINAIRES) + int(AREA_LUMINAIRES) + int(ENVIRONMENT_SAMPLING) + int(SUNS) > 1;
    bool infinite = INFINITE_LUMINAIRES && (!several || light.kind == INFINITE);
    bool area = AREA_LUMINAIRES && (!several || light.kind == AREA);
    bool surroundings = ENVIRONMENT_SAMPLING && (!several || light.kind == SURROUNDINGS);
    bool sun = SUNS && (!several || light.kind == SUN);
    // Unshadowed radiance over the density of finding it, and the shadow ray that must reach (0, t_max) unhindered.
    vec3 target = light.a;
    vec3 wi = target;
    vec3 incident = light.radiance / light.probability;
    float density = 0.0;      // per steradian, for the power heuristic; 0 where no other ray can find the light
    float target_error = light.position_error;
    float t_max = INFINITY;
    if (surroundings) {
        wi = sample_environment(random.xy, density);
        incident = environment_radiance(wi) / (density * light.probability);
        density *= light.probability;
    } else if (sun) {
        wi = sample_sun(light, uniform2(random.xy));
        density = sun_density(light);
        incident /= density;
        density *= light.ideal_probability;
    } else if (!infinite) {
        t_max = 1.0;
        float double_area = 2.0 * light.area;
        vec3 v[3];
        float omega;
        float height = dot(light.normal, light.a - s.position);
        // In its own plane a point sees nothing of the triangle, but rounding would make that half of all directions.
        if (area && abs(height) <= dot(abs(light.normal), s.position_error)) return vec3(0.0);
        if (area && is_near(s.position, light.a, light.b, light.c, light.area, v, omega)) {
            wi = spherical_triangle(v, omega, uniform2(random.xy));
            float t = height / dot(light.normal, wi);
            target = s.position + t * wi;
            target_error += gamma(8.0) * (largest(abs(s.position)) + largest(abs(light.a)));
            incident *= omega;
            density = light.ideal_probability / omega;
            // The plane may be missed where the triangle is seen edge-on.
            if (!(t > 0.0 && t < 1e30)) return vec3(0.0);
        } else {
            if (area) {
                vec3 w = uniform_triangle(uniform2(random.xy));
                target = w.x * light.a + w.y * light.b + w.z * light.c;
            }
            vec3 d = target - s.position;
            float distance2 = dot(d, d);
            if (distance2 == 0.0) return vec3(0.0);
            wi = d * inversesqrt(distance2);
            incident /= distance2;
            if (SPOTS && light.kind == SPOT) incident *= spot_falloff(light, -wi);
            if (PROFILES && light.kind == PHOTOMETRIC) incident *= photometric_intensity(light, -wi);
            if (area) {
                float cosine = light.area * abs(dot(light.normal, wi));
                incident *= cosine;
                density = light.ideal_probability * distance2 / cosine;
            }
        }
    }
    if (area && light.one_sided != 0.0 && dot(light.normal, wi) > 0.0) return vec3(0.0);
    vec4 f = bsdf_and_pdf(s, material, wo, wi);
    vec3 scattered = f.rgb * cosine_at(s, wi);
    vec3 radiance = scattered * incident;
    if (ROUGH_TRANSMISSION) radiance /= dilution(s, material, wi);
    if (radiance == vec3(0.0)) return vec3(0.0);
    if (LIGHT_SAMPLING == LIGHT_MIS && (area || surroundings || sun)) {
        radiance *= power_heuristic(density, path_pdf(f.w * rest, throughput * scattered, s, material));
    }

    if (area && (TEXTURES || HOLES)) {
        Material lamp = load_material(light.material);
        uint emission_map = lamp.emission_map;
        bool partly = HOLES && (lamp.opacity < 1.0 || lamp.opacity_map != NONE);
        if (emission_map != NONE || partly) {
            // Where on the triangle the target lies, by areas.
            vec3 ab = light.b - light.a;
            vec3 ac = light.c - light.a;
            vec3 ap = target - light.a;
            vec3 n = cross(ab, ac);
            vec3 unit = normalize(n / largest(abs(n)));
            vec2 barycentric = vec2(dot(cross(ap, ac), unit), dot(cross(ab, ap), unit)) / dot(n, unit);
            if (TEXTURES && emission_map != NONE) radiance *= texture_at(emission_map, texture_coordinates(light.triangle, barycentric)).rgb;
            if (partly) radiance *= opacity_at(light.material, light.triangle, barycentric);
            if (radiance == vec3(0.0)) return vec3(0.0);
        }
    }

    vec3 origin = offset_ray_origin(s.position, s.position_error, s.geometric_normal, wi);
    vec3 direction = wi;
    if (!infinite && !surroundings && !sun) {
        if (area) {
            target = offset_ray_origin(target, vec3(target_error), light.normal, -wi);
            // The end of the segment rounds by its length: stop eight units in the last place before it.
            t_max = 1.0 - 9.5367432e-7;
        }
        direction = target - origin;
    }
    rays += uvec2(1u);
    if (occluded(origin, direction, t_max, salt)) return vec3(0.0);
    if (VOLUMES) {
        t_max = infinite || surroundings || sun ? FAR_AWAY : t_max;
        vec3 from = inner_absorption(s, material, wi);
        float last_hole = 0.0;
        if (PIERCED_BODIES) radiance *= through_holes(origin, direction, length(direction), t_max, salt, from, last_hole);
        // The inner side of a body that glows.
        vec3 absorption = area && dot(light.normal, wi) > 0.0 ? body_absorption(light.material) : vec3(0.0);
        if (absorption == vec3(0.0)) absorption = from;
        if (absorption != vec3(0.0)) radiance *= absorbed(absorption, length(direction) * (t_max - last_hole));
    }
    return radiance;
}
