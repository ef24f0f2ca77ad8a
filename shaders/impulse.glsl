// Impulses (slides "Impulse Reflection", "Adding Transmission"): mirrors and smooth dielectrics; twins in src/reference/impulse.rs.

// What the impulses at a surfel do with light from one side.
struct Impulses {
    vec3 reflected;       // albedo
    vec3 transmitted;     // albedo
    vec3 normal;          // the one that both directions go by; of glass, the reflectance too
    float eta;            // index on the other side over that on the side of wo; 0 for a mirror
    float probability;    // with which a path takes an impulse
};

// Whether what scatters lies under a smooth dielectric, not beside it.
bool is_coated(Material material) {
    if (!COATS || material.eta == MIRROR || material.reflection == vec3(0.0) || material.transmission != vec3(0.0)) return false;
    return material.lambert != vec3(0.0) || (GLOSSY && material.glossy != vec3(0.0));
}

// With which a path goes on by an impulse, of this albedo beside what is scattered.
float impulse_probability(Material material, float impulse, float scattered) {
    if (impulse == 0.0) return 0.0;
    if (scattered == 0.0) return 1.0;
    return material.impulse_probability != BY_ALBEDOS ? material.impulse_probability : impulse / (impulse + scattered);
}

Impulses impulses(Surfel s, Material material, vec3 wo) {
    Impulses i = Impulses(vec3(0.0), vec3(0.0), s.shading_normal, 0.0, 0.0);
    if (!IMPULSES) return i;
    if (is_physical(material)) {
        Lobes l = s.lobes;
        bool clear = is_clear(l);
        i.eta = bend(l);
        // One of a coat alone goes by the coat's normal.
        if (CLEARCOATS && NORMAL_MAPS && !clear && !is_smooth(l.p)) i.normal = s.unbent_normal;
        vec3 transmitted = clear ? refract_direction(wo, i.normal, i.eta) : vec3(0.0);
        bool wrong = dot(reflect_direction(wo, i.normal), s.geometric_normal) <= 0.0;
        if (clear) wrong = wrong || dot(transmitted, s.geometric_normal) >= 0.0;
        if ((VERTEX_NORMALS || NORMAL_MAPS) && wrong) {
            i.normal = s.geometric_normal;
            if (clear) {
                l = physical_lobes(l.p, i.normal, i.normal, s.tangent.xyz, s.front, wo);
                transmitted = refract_direction(wo, i.normal, i.eta);
            }
        }
        i.reflected = l.impulse_reflection;
        // Microfacets may let through what the surface as a whole would not.
        i.transmitted = transmitted == vec3(0.0) ? vec3(0.0) : l.impulse_transmission;
        i.probability = impulse_probability(material, mean(i.reflected + i.transmitted), scattered_albedo(s.lobes));
        return i;
    }
    vec3 rest = material.lambert;
    if (GLOSSY) rest += material.glossy;
    i.reflected = material.reflection;
    bool thin = THIN && is_thin(material);
    bool opaque = material.transmission == vec3(0.0);
    if (DIELECTRICS && material.eta != MIRROR) {
        // A sheet lets light through as if it were not there, and nobody is inside of what transmits nothing.
        i.eta = thin ? 1.0 : s.front || opaque ? material.eta : 1.0 / material.eta;
    }
    // A direction on the wrong side of the triangle, or all reflected by glass: the triangle's own normal instead. Total reflection about
    // interpolated normals would keep paths for ever (src/reference/impulse.rs).
    if (VERTEX_NORMALS || NORMAL_MAPS) {
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
    i.probability = impulse_probability(material, mean(i.reflected + i.transmitted), mean(rest));
    return i;
}
