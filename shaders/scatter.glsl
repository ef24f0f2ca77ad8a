// The BRDF: normalised Blinn-Phong (slide "Surface Element Class"; what its lines get wrong is put right in bsdf()).

// f(wo, wi), without the cosine. Zero where the two normals disagree about the side of wi: light would leak through walls.
vec3 bsdf(Surfel s, Material material, vec3 wo, vec3 wi) {
    if (dot(s.geometric_normal, wi) <= 0.0 || dot(s.shading_normal, wi) <= 0.0) return vec3(0.0);
    vec3 f = material.lambert.rgb * (1.0 / PI);
    if (GLOSSY && material.glossy.rgb != vec3(0.0)) {
        vec3 h = normalize(wi + wo);
        f += material.glossy.rgb * (material.ambient.w * pow(max(0.0, dot(s.shading_normal, h)), material.glossy.w));
    }
    return f;
}

// The probability that a path goes on: one minus the extinction coefficient, for the channel that loses least.
float survival(Material material) { return material.lambert.w; }

// A direction with density cos / pi about the shading normal (MonteCarloHemisphereVector), and its weight f cos / pdf.
vec3 scatter(Surfel s, Material material, vec3 wo, vec2 u, out vec3 wi) {
    wi = from_frame(s.shading_normal, cosine_hemisphere(u));
    return PI * bsdf(s, material, wo, wi);
}
