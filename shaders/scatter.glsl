// Which way a path goes on from a surface, and whether it does: impulses, the BSDF, extinction.

// Russian roulette leaves paths of at least this throughput alone, those that no lobe has scattered yet for so many surfaces, and is told
// of the last number there (src/reference/scatter.rs).
const float SURE_THROUGHPUT = 0.25;
const uint SURE_IMPULSES = 8u;
const float AMPLE_THROUGHPUT = 1e20;

// The share of light that a surface does not extinguish, for the channel that loses least.
float survival(Surfel s, Material material) {
    if (is_physical(material)) return min(largest(hemispherical_albedo(s.lobes.p)), 1.0);
    vec3 albedo = material.lambert;
    if (GLOSSY) albedo += material.glossy;
    if (is_coated(material)) albedo = max(material.reflection, albedo);
    else if (IMPULSES) albedo += max(material.reflection, DIELECTRICS ? material.transmission : vec3(0.0));
    return min(largest(albedo), 1.0);
}

// The density with which a path goes on to a direction that it chooses with the density `pdf`: extinction has to let it live. What the
// power heuristic has to know; literal extinction is left out: its survivors do not stand for those that ended. `scattered` is the
// throughput that roulette sees (`roulette_throughput`), times f cos.
float path_pdf(float pdf, vec3 scattered, Surfel s, Material material) {
    if (EXTINCTION == EXTINCTION_SURFACE) return pdf * survival(s, material);
    if (EXTINCTION == EXTINCTION_THROUGHPUT) return min(largest(scattered) / SURE_THROUGHPUT, pdf);
    return pdf;
}

// Marks a direction that no density describes. Not an infinity, of which a compiler may assume that there is none.
const float IMPULSE = -1.0;

struct Scattering {
    vec3 wi;
    vec3 weight;      // f |cos| / pdf, without the factor by which refraction concentrates radiance
    float pdf;        // per steradian, or IMPULSE
    float eta2;       // the square of the relative index that was passed, else 1
};

// The direction in which a path goes on, with its weight; a weight of zero ends the path.
Scattering scatter(Surfel s, Material material, Impulses i, vec3 wo, uvec4 random) {
    float choice = uniform1(random.z);
    if (IMPULSES && choice < i.probability) {
        float all = mean(i.reflected + i.transmitted);
        if (!DIELECTRICS || choice < i.probability * (mean(i.reflected) / all)) {
            vec3 weight = i.reflected * (all / (i.probability * mean(i.reflected)));
            return Scattering(reflect_direction(wo, i.normal), weight, IMPULSE, 1.0);
        }
        vec3 weight = i.transmitted * (all / (i.probability * mean(i.transmitted)));
        return Scattering(refract_direction(wo, i.normal, i.eta), weight, IMPULSE, i.eta * i.eta);
    }
    float rest = IMPULSES ? 1.0 - i.probability : 1.0;
    if (IMPULSES) choice = (choice - i.probability) / rest;
    vec3 wi = bsdf_direction(s, material, wo, uniform2(random.xy), choice);
    vec4 f = bsdf_and_pdf(s, material, wo, wi);
    f.w *= rest;
    // Without a second lobe the cosine cancels exactly.
    bool lambert_only = !GLOSSY && !COATS && !PHYSICAL && DIRECTIONS != DIRECTIONS_UNIFORM;
    vec3 weight = vec3(0.0);
    if (lambert_only) weight = f.w > 0.0 ? material.lambert / rest : vec3(0.0);
    else if (f.w > 0.0) weight = f.rgb * (cosine_at(s, wi) / f.w);
    return Scattering(wi, weight, f.w, dilution(s, material, wi));
}
