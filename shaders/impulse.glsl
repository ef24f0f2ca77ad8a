// Impulses (slides "Impulse Reflection", "Adding Transmission"): mirrors and smooth dielectrics; twins in src/reference/impulse.rs.

// The square of the refracted direction's cosine; not above zero where all is reflected. As 1 - sin^2 / eta^2 it would lose all its digits
// near the critical angle, and at grazing where the index is nearly 1.
float transmitted_cosine2(float eta, float cos_i) { return ((eta - 1.0) * (eta + 1.0) + cos_i * cos_i) / (eta * eta); }

// Reflectance of a smooth dielectric for unpolarised light; `eta` is the index behind the surface over that in front of it.
float fresnel(float eta, float cos_i) {
    float cosine2 = transmitted_cosine2(eta, cos_i);
    if (cosine2 <= 0.0) return 1.0;
    float cos_t = sqrt(cosine2);
    float s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    float p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return 0.5 * (s * s + p * p);
}

// The direction on the other side of a smooth surface; zero where all is reflected.
vec3 refract_direction(vec3 wo, vec3 n, float eta) {
    float cos_i = dot(wo, n);
    float cosine2 = transmitted_cosine2(eta, cos_i);
    if (cosine2 <= 0.0) return vec3(0.0);
    return normalize((cos_i / eta - sqrt(cosine2)) * n - wo / eta);
}

// Reflectance of a sheet between two parallel surfaces of this reflectance, with all that goes to and fro between them.
float thin_reflectance(float fresnel) { return 2.0 * fresnel / (1.0 + fresnel); }

vec3 reflect_direction(vec3 wo, vec3 n) { return 2.0 * dot(wo, n) * n - wo; }

// What the impulses at a surfel do with light from one side.
struct Impulses {
    vec3 reflected;       // albedo
    vec3 transmitted;     // albedo
    vec3 normal;          // the one that both directions go by; of glass, the reflectance too
    float eta;            // index on the other side over that on the side of wo; 0 for a mirror
    float probability;    // with which a path takes an impulse
};

float mean(vec3 v) { return (v.x + v.y + v.z) * (1.0 / 3.0); }

// Whether what scatters lies under a smooth dielectric, not beside it.
bool is_coated(Material material) {
    if (!COATS || material.eta == MIRROR || material.reflection == vec3(0.0) || material.transmission != vec3(0.0)) return false;
    return material.lambert != vec3(0.0) || (GLOSSY && material.glossy != vec3(0.0));
}

Impulses impulses(Surfel s, Material material, vec3 wo) {
    Impulses i = Impulses(vec3(0.0), vec3(0.0), s.shading_normal, 0.0, 0.0);
    if (!IMPULSES) return i;
    vec3 rest = material.lambert;
    if (GLOSSY) rest += material.glossy;
    i.reflected = material.reflection;
    bool thin = THIN && material.thin != 0u;
    bool opaque = material.transmission == vec3(0.0);
    if (DIELECTRICS && material.eta != MIRROR) {
        // A sheet lets light through as if it were not there, and nobody is inside of what transmits nothing.
        i.eta = thin ? 1.0 : s.front || opaque ? material.eta : 1.0 / material.eta;
    }
    // A direction on the wrong side of the triangle, or all reflected by glass: the triangle's own normal instead. Total reflection about
    // interpolated normals would keep paths for ever (src/reference/impulse.rs).
    if (VERTEX_NORMALS) {
        bool wrong = dot(reflect_direction(wo, i.normal), s.geometric_normal) <= 0.0;
        if (DIELECTRICS && !opaque) wrong = wrong || dot(refract_direction(wo, i.normal, i.eta), s.geometric_normal) >= 0.0;
        if (wrong) i.normal = s.geometric_normal;
    }
    if (DIELECTRICS && i.eta > 0.0) {
        float f = fresnel(thin ? material.eta : i.eta, min(dot(wo, opaque ? s.shading_normal : i.normal), 1.0));
        if (thin) f = thin_reflectance(f);
        i.reflected *= f;
        i.transmitted = material.transmission * (1.0 - f);
    }
    if (is_coated(material)) rest *= 1.0 - i.reflected;
    float impulse = mean(i.reflected + i.transmitted);
    float other = mean(rest);
    if (impulse > 0.0) {
        if (other == 0.0) i.probability = 1.0;
        else i.probability = material.impulse_probability != BY_ALBEDOS ? material.impulse_probability : impulse / (impulse + other);
    }
    return i;
}
