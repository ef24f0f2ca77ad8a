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

// MonteCarloHemisphereVector: density cos / pi about the shading normal.
vec3 cosine_direction(Surfel s, vec2 u) { return from_frame(s.shading_normal, cosine_hemisphere(u)); }
