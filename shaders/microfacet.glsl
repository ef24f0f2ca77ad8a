// Rough surfaces as many small smooth ones (twins: src/reference/microfacet.rs). Directions are in the surface's frame, its normal +z; wo is above it;
// `a` has the widths of the distribution along x and y.

// What microfacets that reflect or transmit all are worth at a pair of directions.
struct Microfacet {
    float value;     // per steradian, without the cosine; of refraction as shares of energy
    float pdf;       // of wi, per steradian, if the microfacet is chosen by visible_normal
    float cosine;    // between wo and the microfacet's normal
};

// Density of normals over the surface's area, per steradian: Trowbridge and Reitz.
float normal_density(vec2 a, vec3 h) {
    vec2 p = h.xy / a;
    float t = dot(p, p) + h.z * h.z;
    return 1.0 / (PI * a.x * a.y * t * t);
}

// Smith's Lambda.
float smith_lambda(vec2 a, vec3 w) {
    vec2 p = a * w.xy / w.z;
    float t = dot(p, p);
    // (sqrt(1 + t) - 1) / 2, without its cancellation.
    return 0.5 * t / (1.0 + sqrt(1.0 + t));
}

// The normal of a microfacet that is seen from wo, in proportion to how large it looks: spherical caps (Dupuy and Benyoub 2023).
vec3 visible_normal(vec2 a, vec3 wo, vec2 u) {
    vec3 stretched = normalize(vec3(wo.xy * a, wo.z));
    float below = u.y * (1.0 + stretched.z);
    vec2 sc = sin_cos_turns(u.x);
    vec3 h = vec3(sqrt(max(below * (2.0 - below), 0.0)) * sc.yx, 1.0 - below) + stretched;
    return normalize(vec3(h.xy * a, h.z));
}

// The width of a distribution that is the same all around with the same mean square.
float mean_width(vec2 a) { return a.x == a.y ? a.x : sqrt(0.5 * dot(a, a)); }

// The width of round microfacets that are most like these, seen from w: in the plane of view as wide.
float seen_width(vec2 a, vec3 w) {
    vec2 p = a * w.xy;
    return min(sqrt(dot(p, p) + 0.5 * w.z * w.z * dot(a, a)), 1.0);
}

// Microfacets that reflect wi into wo, both above.
Microfacet microfacet_reflection(vec2 a, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    float lambda = smith_lambda(a, wo);
    float d = normal_density(a, h) / (4.0 * wo.z);
    return Microfacet(d / (wi.z * (1.0 + lambda + smith_lambda(a, wi))), d / (1.0 + lambda), dot(wo, h));
}

// Microfacets that refract wi, below, into wo; `eta` is the index below over that above.
Microfacet microfacet_refraction(vec2 a, vec3 wo, vec3 wi, float eta) {
    vec3 sum = wo + eta * wi;
    if (sum.z < 0.0) sum = -sum;
    float length2 = dot(sum, sum);
    if (length2 == 0.0) return Microfacet(0.0, 0.0, 1.0);
    vec3 h = sum * inversesqrt(length2);
    float cos_o = dot(wo, h);
    float cos_i = dot(wi, h);
    if (cos_o <= 0.0 || cos_i >= 0.0) return Microfacet(0.0, 0.0, 1.0);
    float jacobian = -cos_i * eta * eta / length2;
    float pdf = normal_density(a, h) * cos_o * jacobian / (wo.z * (1.0 + smith_lambda(a, wo)));
    return Microfacet(pdf / (-wi.z * (1.0 + smith_lambda(a, wi))), pdf, cos_o);
}

// A direction from which microfacets reflect light into wo; zero if it would be below.
vec3 microfacet_reflected(vec2 a, vec3 wo, vec2 u) {
    vec3 wi = reflect_direction(wo, visible_normal(a, wo, u));
    return wi.z > 0.0 ? wi : vec3(0.0);
}
