// From the unit square to directions and triangles; the twins are in src/reference/warp.rs.

const float PI = 3.14159265358979;
const float QUARTER_PI = 0.785398163397448;

// sin and cos for |x| <= pi/4, to one unit in the last place (Cephes' polynomials). GLSL's own may be off by 2^-11, and
// differ from driver to driver.
vec2 sin_cos_quarter(float x) {
    float x2 = x * x;
    float s = x + x * x2 * (-1.6666654611e-1 + x2 * (8.3321608736e-3 + x2 * -1.9515295891e-4));
    float c = 1.0 - 0.5 * x2 + x2 * x2 * (4.166664568298827e-2 + x2 * (-1.388731625493765e-3 + x2 * 2.443315711809948e-5));
    return vec2(s, c);
}

// sin and cos of 2 pi `turns`, to two units in the last place of 1.
vec2 sin_cos_turns(float turns) {
    float quarter = round(4.0 * turns);
    vec2 sc = sin_cos_quarter((turns - 0.25 * quarter) * (2.0 * PI));
    int q = int(quarter) & 3;
    if ((q & 1) == 1) sc = vec2(sc.y, -sc.x);
    return q >= 2 ? -sc : sc;
}

// The angle of (x, y) in (-pi, pi], to three units in the last place (Cephes' polynomial); 0 for (0, 0).
float angle(float y, float x) {
    float ax = abs(x);
    float ay = abs(y);
    float small = min(ax, ay);
    float large = max(ax, ay);
    if (large == 0.0) return 0.0;
    // Above tan(pi / 8) the angle is measured from the diagonal.
    bool upper = small > 0.4142135623730950 * large;
    float t = upper ? (small - large) / (small + large) : small / large;
    float z = t * t;
    float a = t + t * z * (-3.33329491539e-1 + z * (1.99777106478e-1 + z * (-1.38776856032e-1 + z * 8.05374449538e-2)));
    if (upper) a += QUARTER_PI;
    if (ay > ax) a = 2.0 * QUARTER_PI - a;
    if (x < 0.0) a = PI - a;
    return y < 0.0 ? -a : a;
}

// Shirley and Chiu's concentric map to the unit disk.
vec2 concentric_disk(vec2 u) {
    vec2 p = 2.0 * u - 1.0;
    if (p.x == 0.0 && p.y == 0.0) return vec2(0.0);
    if (abs(p.x) > abs(p.y)) {
        vec2 sc = sin_cos_quarter(QUARTER_PI * (p.y / p.x));
        return p.x * sc.yx;
    }
    vec2 sc = sin_cos_quarter(QUARTER_PI * (p.x / p.y));
    return p.y * sc;
}

// Density cos / pi about +z.
vec3 cosine_hemisphere(vec2 u) {
    vec2 d = concentric_disk(u);
    return vec3(d, sqrt(max(0.0, 1.0 - dot(d, d))));
}

// Density 1 / 2 pi about +z.
vec3 uniform_hemisphere(vec2 u) {
    float z = 1.0 - u.x;
    vec2 sc = sin_cos_turns(u.y);
    return vec3(sqrt(max(0.0, u.x * (1.0 + z))) * sc.yx, z);
}

// 1 - exp(x) for x <= 0, without cancellation near 0.
float one_minus_exp(float x) {
    if (x < -0.125) return 1.0 - exp(x);
    return -x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0)))));
}

// ln(1 - x) for 0 <= x <= 1, without cancellation near 0.
float log_one_minus(float x) {
    if (x > 0.0625) return log(1.0 - x);
    return -x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0 + x * (1.0 / 5.0 + x * (1.0 / 6.0))))));
}

// A half vector about +z with density (m + 1) / 2 pi cos^m. The sine is computed first: for large m the cosine is nearly 1.
vec3 glossy_half_vector(float m, vec2 u) {
    float sine2 = one_minus_exp(2.0 / (m + 1.0) * log_one_minus(u.x));
    vec2 sc = sin_cos_turns(u.y);
    return vec3(sqrt(sine2) * sc.yx, sqrt(max(0.0, 1.0 - sine2)));
}

// From the frame in which `n` is +z to the world: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
vec3 from_frame(vec3 n, vec3 v) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    vec3 tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    vec3 bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    return v.x * tangent + v.y * bitangent + v.z * n;
}

// Barycentric coordinates, uniform over a triangle: Heitz, "A Low-Distortion Map Between Triangle and Square", 2019.
vec3 uniform_triangle(vec2 u) {
    float b0, b1;
    if (u.x < u.y) {
        b0 = 0.5 * u.x;
        b1 = u.y - b0;
    } else {
        b1 = 0.5 * u.y;
        b0 = u.x - b1;
    }
    return vec3(b0, b1, 1.0 - b0 - b1);
}

// Solid angle of the triangle whose corners lie in the directions `v` (unit vectors): Van Oosterom and Strackee 1983.
float solid_angle(vec3 v[3]) {
    float volume = abs(dot(v[0], cross(v[1], v[2])));
    return 2.0 * angle(volume, 1.0 + dot(v[0], v[1]) + dot(v[0], v[2]) + dot(v[1], v[2]));
}

// A direction in that triangle, evenly over its solid angle: Peters, "BRDF Importance Sampling for Polygonal Lights", SIGGRAPH 2021.
vec3 spherical_triangle(vec3 v[3], float omega, vec2 u) {
    float g0 = abs(dot(v[0], cross(v[1], v[2])));
    float g1 = dot(v[0], v[2]) + dot(v[1], v[2]);
    float g2 = 1.0 + dot(v[0], v[1]);
    // The part of the triangle between the first two corners and a new one on the opposite edge has u.x of the solid angle.
    vec2 sc = sin_cos_turns(omega * u.x * (0.25 / PI));
    vec3 offset = v[0] * (g0 * sc.y - g1 * sc.x) + v[2] * (g2 * sc.x);
    vec3 corner = offset * (2.0 * dot(v[0], offset) / dot(offset, offset)) - v[0];
    // Then a point between the second corner and the new one, by 1 - cosine, which does not cancel where they are close.
    vec3 chord = corner - v[1];
    float whole = 0.5 * dot(chord, chord);
    float part = u.y * whole;
    vec3 tangent = chord + whole * v[1];
    float sine = sqrt(max(0.0, part * (2.0 - part)));
    return normalize((1.0 - part) * v[1] + sine * inversesqrt(max(1e-20, dot(tangent, tangent))) * tangent);
}
