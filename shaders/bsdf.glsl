// The BSDF without its impulses: normalised Blinn-Phong (slide "Surface Element Class"; what its lines get wrong is put right here), and
// how directions are chosen (slides "Inefficient Integration", "More Efficient Integration").

// The probability that the glossy lobe chooses a direction that no impulse chose.
float glossy_share(Material material) {
    if (!GLOSSY) return 0.0;
    float glossy = mean(material.glossy);
    return glossy > 0.0 ? glossy / (glossy + mean(material.lambert)) : 0.0;
}

// What a coat makes of the base's lobes (Surfel::coat in src/reference/bsdf.rs): a factor to Lambert's, and one to the glossy one.
void coat(Surfel s, Material material, vec3 wo, vec3 wi, out vec3 lambert, out vec3 glossy) {
    vec3 outward = 1.0 - material.reflection * fresnel(material.eta, min(dot(s.shading_normal, wo), 1.0));
    vec3 inward = 1.0 - material.reflection * fresnel(material.eta, min(dot(s.shading_normal, wi), 1.0));
    // Written so that it does not cancel where nearly all is reflected.
    vec3 average = (1.0 - material.reflection) + material.reflection * material.coat_transmittance;
    lambert = outward * inward / average;
    glossy = min(outward, inward);
}

// f(wo, wi), without the cosine, in rgb; w: the density per steradian with which bsdf_direction gives wi. All zero where the two
// normals disagree about the side of wi: light would leak through walls.
//
// Of a metallic-roughness surface without the factor 1 / eta^2 of what is refracted (`dilution`).
vec4 bsdf_and_pdf(Surfel s, Material material, vec3 wo, vec3 wi) {
    float cosine = dot(s.shading_normal, wi);
    float height = dot(SMOOTH_TERMINATOR ? s.horizon : s.geometric_normal, wi);
    if (is_physical(material)) {
        bool both = scatters_through(s.lobes);
        if (height * cosine <= 0.0 || (!both && cosine < 0.0)) return vec4(0.0);
        vec4 f = physical_value_and_pdf(s.lobes, vec3(dot(s.lobes.x, wi), dot(s.lobes.y, wi), cosine));
        float sides = both ? 0.5 : 1.0;
        if (DIRECTIONS == DIRECTIONS_UNIFORM) f.w = sides * (0.5 / PI);
        if (DIRECTIONS == DIRECTIONS_COSINE) f.w = sides * abs(cosine) * (1.0 / PI);
        return f;
    }
    if (height <= 0.0 || cosine <= 0.0) return vec4(0.0);
    vec3 f = material.lambert * (1.0 / PI);
    vec3 glossy = material.glossy;
    if (is_coated(material)) {
        vec3 lambert_coat, glossy_coat;
        coat(s, material, wo, wi, lambert_coat, glossy_coat);
        f *= lambert_coat;
        glossy *= glossy_coat;
    }
    float pdf = DIRECTIONS == DIRECTIONS_UNIFORM ? 0.5 / PI : cosine * (1.0 / PI);
    if (GLOSSY && material.glossy != vec3(0.0)) {
        vec3 h = normalize(wi + wo);
        // cos^m: near the normal by the sine, because rounding a cosine of nearly 1 shows m times.
        vec3 sine = cross(s.shading_normal, h);
        float sine2 = dot(sine, sine);
        float log_cosine = sine2 < 0.5 ? 0.5 * log_one_minus(sine2) : log(max(dot(s.shading_normal, h), 1e-18));
        float m = material.exponent;
        float lobe = exp(m * log_cosine);
        f += glossy * (material.normalisation * lobe);
        if (DIRECTIONS == DIRECTIONS_BSDF) {
            float half_vector = (m + 1.0) * (0.5 / PI) * lobe / (4.0 * abs(dot(wo, h)));
            pdf = mix(pdf, half_vector, glossy_share(material));
        }
    }
    return vec4(f, pdf);
}

// A direction for indirect light; `choice` in [0, 1) picks the lobe.
vec3 bsdf_direction(Surfel s, Material material, vec3 wo, vec2 u, float choice) {
    if (is_physical(material)) {
        if (DIRECTIONS == DIRECTIONS_BSDF) {
            vec3 wi = physical_direction(s.lobes, u, choice);
            return wi.x * s.lobes.x + wi.y * s.lobes.y + wi.z * s.shading_normal;
        }
        // Half of them from below, if light from there is scattered.
        bool below = scatters_through(s.lobes) && choice < 0.5;
        vec3 wi = DIRECTIONS == DIRECTIONS_UNIFORM ? uniform_hemisphere(u) : cosine_hemisphere(u);
        return from_frame(below ? -s.shading_normal : s.shading_normal, wi);
    }
    if (DIRECTIONS == DIRECTIONS_UNIFORM) return from_frame(s.shading_normal, uniform_hemisphere(u));
    if (GLOSSY && DIRECTIONS == DIRECTIONS_BSDF && choice < glossy_share(material)) {
        vec3 h = from_frame(s.shading_normal, glossy_half_vector(material.exponent, u));
        return reflect_direction(wo, h);
    }
    return from_frame(s.shading_normal, cosine_hemisphere(u));
}
