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
