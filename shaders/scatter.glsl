// The BSDF without its impulses: normalised Blinn-Phong (slide "Surface Element Class"; what its lines get wrong is put right here), and
// how directions are chosen (slides "Inefficient Integration", "More Efficient Integration").

// No surface lets every path live, so that every path ends.
const float MAX_SURVIVAL = 0.9999;
// Russian roulette leaves paths of at least this throughput alone (src/reference/scatter.rs).
const float SURE_THROUGHPUT = 0.4;

// The probability that the glossy lobe chooses a direction that no impulse chose.
float glossy_share(Material material) {
    if (!GLOSSY) return 0.0;
    float glossy = average(material.glossy);
    return glossy > 0.0 ? glossy / (glossy + average(material.lambert)) : 0.0;
}

// f(wo, wi), without the cosine, in rgb; w: the density per steradian with which scatter_direction gives wi. All zero where the two
// normals disagree about the side of wi: light would leak through walls.
vec4 bsdf_and_pdf(Surfel s, Material material, vec3 wo, vec3 wi) {
    float cosine = dot(s.shading_normal, wi);
    if (dot(s.geometric_normal, wi) <= 0.0 || cosine <= 0.0) return vec4(0.0);
    vec3 f = material.lambert * (1.0 / PI);
    float pdf = DIRECTIONS == DIRECTIONS_UNIFORM ? 0.5 / PI : cosine * (1.0 / PI);
    if (GLOSSY && material.glossy != vec3(0.0)) {
        vec3 h = normalize(wi + wo);
        // cos^m: near the normal by the sine, because rounding a cosine of nearly 1 shows m times.
        vec3 sine = cross(s.shading_normal, h);
        float sine2 = dot(sine, sine);
        float log_cosine = sine2 < 0.5 ? 0.5 * log_one_minus(sine2) : log(max(dot(s.shading_normal, h), 1e-18));
        float m = material.exponent;
        float lobe = exp(m * log_cosine);
        f += material.glossy * (material.normalisation * lobe);
        if (DIRECTIONS == DIRECTIONS_BSDF) {
            float half_vector = (m + 1.0) * (0.5 / PI) * lobe / (4.0 * abs(dot(wo, h)));
            pdf = mix(pdf, half_vector, glossy_share(material));
        }
    }
    return vec4(f, pdf);
}

// A direction for indirect light; `choice` in [0, 1) picks the lobe.
vec3 scatter_direction(Surfel s, Material material, vec3 wo, vec2 u, float choice) {
    if (DIRECTIONS == DIRECTIONS_UNIFORM) return from_frame(s.shading_normal, uniform_hemisphere(u));
    if (GLOSSY && DIRECTIONS == DIRECTIONS_BSDF && choice < glossy_share(material)) {
        vec3 h = from_frame(s.shading_normal, glossy_half_vector(material.exponent, u));
        return reflect_direction(wo, h);
    }
    return from_frame(s.shading_normal, cosine_hemisphere(u));
}

// The share of light that a surface does not extinguish, for the channel that loses least.
float survival(Material material) {
    vec3 albedo = material.lambert;
    if (GLOSSY) albedo += material.glossy;
    if (IMPULSES) albedo += max(material.reflection, DIELECTRICS ? material.transmission : vec3(0.0));
    return min(largest(albedo), MAX_SURVIVAL);
}

// The density with which a path goes on to a direction that it chooses with the density `pdf`: extinction has to let it live. What the
// power heuristic has to know; literal extinction is left out: its survivors do not stand for those that ended. `scattered` is the
// throughput so far, without eta^2, times f cos.
float surviving(float pdf, vec3 scattered, Material material) {
    if (EXTINCTION == EXTINCTION_SURFACE) return pdf * survival(material);
    if (EXTINCTION == EXTINCTION_THROUGHPUT) return min(largest(scattered) / SURE_THROUGHPUT, MAX_SURVIVAL * pdf);
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
        float all = average(i.reflected + i.transmitted);
        if (!DIELECTRICS || choice < i.probability * (average(i.reflected) / all)) {
            vec3 weight = i.reflected * (all / (i.probability * average(i.reflected)));
            return Scattering(reflect_direction(wo, i.normal), weight, IMPULSE, 1.0);
        }
        vec3 weight = i.transmitted * (all / (i.probability * average(i.transmitted)));
        return Scattering(refract_direction(wo, i.normal, i.eta), weight, IMPULSE, i.eta * i.eta);
    }
    float rest = IMPULSES ? 1.0 - i.probability : 1.0;
    if (IMPULSES) choice = (choice - i.probability) / rest;
    vec3 wi = scatter_direction(s, material, wo, uniform2(random.xy), choice);
    vec4 f = bsdf_and_pdf(s, material, wo, wi);
    f.w *= rest;
    // Without a second lobe the cosine cancels exactly.
    bool lambert_only = !GLOSSY && DIRECTIONS != DIRECTIONS_UNIFORM;
    vec3 weight = vec3(0.0);
    if (lambert_only) weight = f.w > 0.0 ? material.lambert / rest : vec3(0.0);
    else if (f.w > 0.0) weight = f.rgb * (dot(s.shading_normal, wi) / f.w);
    return Scattering(wi, weight, f.w, 1.0);
}
