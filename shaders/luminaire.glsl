// Direct light (slides "Lighting Functions", "Shadows & Attenuation", "Area Luminaires"), with the density that they leave out.

// One luminaire, in proportion to its power, by an alias table (twin: src/sampling/alias.rs).
uint choose_luminaire(uint random) {
    uint slot, fraction;
    umulExtended(random, frame.luminaire_count, slot, fraction);
    return fraction < luminaires[slot].threshold ? slot : luminaires[slot].alias_index;
}

// Light from one luminaire that `s` sends towards `wo`; adds the shadow ray to `rays`.
vec3 direct_light(Surfel s, Material material, vec3 wo, uvec4 random, inout uint rays) {
    if (frame.luminaire_count == 0u) return vec3(0.0);
    Luminaire light = luminaires[choose_luminaire(random.x)];
    // Unshadowed radiance, and the shadow ray that must reach (0, t_max) unhindered.
    vec3 target = light.a.xyz;
    vec3 wi = target;
    vec3 incident = light.radiance.rgb / light.radiance.w;
    bool infinite = INFINITE_LUMINAIRES && light.kind == INFINITE;
    float t_max = infinite ? INFINITY : 1.0;
    vec3 light_normal = vec3(0.0);
    if (!infinite) {
        if (AREA_LUMINAIRES && light.kind == AREA) {
            vec3 w = uniform_triangle(uniform2(random.yz));
            target = w.x * light.a.xyz + w.y * light.b.xyz + w.z * light.c.xyz;
            light_normal = normalize(cross(light.b.xyz - light.a.xyz, light.c.xyz - light.a.xyz));
        }
        vec3 d = target - s.position;
        float distance2 = dot(d, d);
        if (distance2 == 0.0) return vec3(0.0);
        wi = d * inversesqrt(distance2);
        incident /= distance2;
        if (AREA_LUMINAIRES && light.kind == AREA) incident *= light.b.w * abs(dot(light_normal, wi));
    }
    vec3 radiance = bsdf(s, material, wo, wi) * dot(s.shading_normal, wi) * incident;
    if (radiance == vec3(0.0)) return vec3(0.0);

    vec3 origin = offset_ray_origin(s.position, s.position_error, s.geometric_normal, wi);
    vec3 direction = wi;
    if (!infinite) {
        if (AREA_LUMINAIRES && light.kind == AREA) {
            target = offset_ray_origin(target, vec3(light.c.w), light_normal, -wi);
            // The end of the segment rounds by its length: stop eight units in the last place before it.
            t_max = 1.0 - 9.5367432e-7;
        }
        direction = target - origin;
    }
    rays++;
    return occluded(origin, direction, t_max) ? vec3(0.0) : radiance;
}
