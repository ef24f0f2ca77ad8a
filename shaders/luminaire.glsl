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
    // With one kind of luminaire in the scene these are constants.
    bool infinite = INFINITE_LUMINAIRES && (!(POINT_LUMINAIRES || AREA_LUMINAIRES) || light.kind == INFINITE);
    bool area = AREA_LUMINAIRES && (!(POINT_LUMINAIRES || INFINITE_LUMINAIRES) || light.kind == AREA);
    float t_max = infinite ? INFINITY : 1.0;
    if (!infinite) {
        if (area) {
            vec3 w = uniform_triangle(uniform2(random.yz));
            target = w.x * light.a.xyz + w.y * light.b.xyz + w.z * light.c.xyz;
        }
        vec3 d = target - s.position;
        float distance2 = dot(d, d);
        if (distance2 == 0.0) return vec3(0.0);
        wi = d * inversesqrt(distance2);
        incident /= distance2;
        if (area) incident *= light.b.w * abs(dot(light.normal.xyz, wi));
    }
    vec3 radiance = bsdf(s, material, wo, wi) * dot(s.shading_normal, wi) * incident;
    if (radiance == vec3(0.0)) return vec3(0.0);

    vec3 origin = offset_ray_origin(s.position, s.position_error, s.geometric_normal, wi);
    vec3 direction = wi;
    if (!infinite) {
        if (area) {
            target = offset_ray_origin(target, vec3(light.c.w), light.normal.xyz, -wi);
            // The end of the segment rounds by its length: stop eight units in the last place before it.
            t_max = 1.0 - 9.5367432e-7;
        }
        direction = target - origin;
    }
    rays++;
    return occluded(origin, direction, t_max) ? vec3(0.0) : radiance;
}
