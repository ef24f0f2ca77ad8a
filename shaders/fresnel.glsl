// Smooth surfaces between two media: where light goes, and how much of it; twins in src/reference/fresnel.rs.

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

vec3 over_sum(vec3 less, vec3 sum) { return mix(vec3(1.0), less / max(sum, 1e-30), greaterThan(sum, vec3(0.0))); }

// Reflectance of a smooth metal with an index of refraction and an extinction coefficient for each channel, for unpolarised light.
vec3 fresnel_conductor(vec3 eta, vec3 k, float cos_i) {
    float c2 = cos_i * cos_i;
    float s2 = 1.0 - c2;
    // eta^2 - k^2 - s2, without its cancellation.
    vec3 t0 = (eta - 1.0) * (eta + 1.0) - k * k + c2;
    vec3 ab = sqrt(t0 * t0 + 4.0 * eta * eta * k * k);
    vec3 a = sqrt(max(0.5 * (ab + t0), 0.0));
    // No index at all, and grazing light on an index of 1, are limits.
    vec3 s = over_sum(ab + c2 - 2.0 * cos_i * a, ab + c2 + 2.0 * cos_i * a);
    vec3 p = s * over_sum(c2 * ab + s2 * s2 - 2.0 * cos_i * s2 * a, c2 * ab + s2 * s2 + 2.0 * cos_i * s2 * a);
    return 0.5 * (s + p);
}

float mean(vec3 v) { return (v.x + v.y + v.z) * (1.0 / 3.0); }
