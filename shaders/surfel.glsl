// The surface element at a hit: where it is, how sure we are of that, and what it is made of (slide "Surface Element Class").

struct Surfel {
    vec3 position;
    vec3 position_error;      // bound on the rounding of `position`, by coordinate; its part across the surface counts
    vec3 geometric_normal;    // unit, on the side of wo
    vec3 shading_normal;      // unit, on the side of wo
    uint material;
    bool front;               // wo is on the outward side
    vec2 uv;                  // where TEXTURES
};

// Bound on the relative error of n roundings (Higham).
float gamma(float n) { return n * 5.9604645e-8 / (1.0 - n * 5.9604645e-8); }

vec3 row_abs_dot(vec4 m[3], vec3 v) { return vec3(dot(abs(m[0].xyz), v), dot(abs(m[1].xyz), v), dot(abs(m[2].xyz), v)); }

// Normals go by the inverse transpose.
vec3 normal_to_world(vec4 to_object[3], vec3 n) {
    return to_object[0].xyz * n.x + to_object[1].xyz * n.y + to_object[2].xyz * n.z;
}

Surfel surfel(Hit hit, vec3 wo) {
    Surfel s;
    int base = int(hit.triangle) * 3;
    uvec4 t0 = texelFetch(triangles, base);
    vec3 a = uintBitsToFloat(t0.xyz);
    vec3 b = uintBitsToFloat(texelFetch(triangles, base + 1).xyz);
    vec3 c = uintBitsToFloat(texelFetch(triangles, base + 2).xyz);
    vec2 w = hit.barycentric;
    vec3 pa = (1.0 - w.x - w.y) * a;
    vec3 pb = w.x * b;
    vec3 pc = w.y * c;
    s.position = pa + pb + pc;
    s.geometric_normal = triangle_normal(a, b, c);
    // Interpolation rounds by the corners' coordinates, in each axis by itself. The intersection tests mix the axes, so that their distance
    // to the triangle's plane rounds by its size, and the more, the less certain its normal is.
    vec3 extent = abs(b - a) + abs(c - a);
    float size = largest(extent);
#ifdef RAY_QUERY
    // How a driver computes distances is not known: as if from the triangle's area alone, which is least certain.
    float edges = size * size;
#else
    float edges = shorter_edges(a, b, c);
#endif
    float narrow = min(edges / largest(abs(s.geometric_normal)), 256.0);
    s.position_error = gamma(7.0) * (abs(pa) + abs(pb) + abs(pc)) + gamma(4.0) * size * narrow;
    s.material = t0.w;
    if (TEXTURES) s.uv = uv_at(hit.triangle, w);

    vec3 n = vec3(0.0);
    if (VERTEX_NORMALS) {
        vec3 na = uintBitsToFloat(texelFetch(normals, base).xyz);
        vec3 nb = uintBitsToFloat(texelFetch(normals, base + 1).xyz);
        vec3 nc = uintBitsToFloat(texelFetch(normals, base + 2).xyz);
        // A corner without a normal makes the triangle flat.
        if (na != vec3(0.0) && nb != vec3(0.0) && nc != vec3(0.0)) n = (1.0 - w.x - w.y) * na + w.x * nb + w.y * nc;
    }

    if (INSTANCES) {
        vec4 to_world[3], to_object[3];
        object_to_world(hit.object, to_world);
        world_to_object(hit.object, to_object);
        vec3 p = s.position;
        s.position = row_dot(to_world, p) + translation(to_world);
        // Rounding of the transform back into the object's space, when a ray leaves from here.
#ifdef RAY_QUERY
        vec3 back = gamma(5.0) * (row_abs_dot(to_object, abs(s.position)) + abs(translation(to_object)));
#else
        vec3 back = gamma(5.0) * row_abs_dot(to_object, abs(s.position - translation(to_world)));
#endif
        // Only what is across the surface matters. A transform takes distances across a surface to such by one factor, the length that it
        // gives to the normal; the bounds of the single coordinates would grow with its anisotropy.
        vec3 object_normal = s.geometric_normal / largest(abs(s.geometric_normal));
        s.geometric_normal = normal_to_world(to_object, object_normal);
        float across = dot(abs(object_normal), s.position_error + back) / largest(abs(s.geometric_normal));
        vec3 scaled = s.geometric_normal / largest(abs(s.geometric_normal));
        s.position_error = across / dot(scaled, scaled) * abs(scaled)
            + gamma(4.0) * (row_abs_dot(to_world, abs(p)) + abs(translation(to_world)));
        if (VERTEX_NORMALS) n = normal_to_world(to_object, n);
        uint material = object_place(hit.object).material;
        if (material != NONE) s.material = material;
    }

    // Divided first, so that the squares of a small triangle's normal do not vanish.
    s.geometric_normal = normalize(s.geometric_normal / largest(abs(s.geometric_normal)));
    // Outward is where the winding is counter-clockwise, unless the vertex normals know better.
    if (VERTEX_NORMALS && dot(n, s.geometric_normal) < 0.0) s.geometric_normal = -s.geometric_normal;
    s.front = dot(s.geometric_normal, wo) >= 0.0;
    if (!s.front) s.geometric_normal = -s.geometric_normal;
    s.shading_normal = s.geometric_normal;
    if (VERTEX_NORMALS && n != vec3(0.0)) {
        n = normalize(n);
        if (dot(n, s.geometric_normal) < 0.0) n = -n;
        // A shading normal that faces away from the viewer says nothing useful.
        if (dot(n, wo) > 0.0) s.shading_normal = n;
    }
    return s;
}

// The material with its textures.
Material material_at(Surfel s) {
    Material material = load_material(s.material);
    if (TEXTURES) {
        if (SIMPLE && material.maps.x != NONE) material.ambient.rgb *= texture_at(material.maps.x, s.uv).rgb;
        if (material.maps.y != NONE) material.lambert.rgb *= texture_at(material.maps.y, s.uv).rgb;
        if (GLOSSY && material.maps.z != NONE) material.glossy.rgb *= texture_at(material.maps.z, s.uv).rgb;
        if (AREA_LUMINAIRES && material.maps.w != NONE) material.emission.rgb *= texture_at(material.maps.w, s.uv).rgb;
    }
    if (AREA_LUMINAIRES && material.one_sided != 0u && !s.front) material.emission.rgb = vec3(0.0);
    return material;
}

float next_away(float x, float towards) {
    if (towards == 0.0) return x;
    if (x == 0.0) return uintBitsToFloat(towards > 0.0 ? 0x00800000u : 0x80800000u);
    int bits = floatBitsToInt(x);
    return intBitsToFloat(bits + ((x > 0.0) == (towards > 0.0) ? 1 : -1));
}

// `p` moved off its surface to the side of `direction`, by no more than its own error bound asks (Pharr, Jakob and
// Humphreys, "Physically Based Rendering", "Robust Spawned Ray Origins").
vec3 offset_ray_origin(vec3 p, vec3 error, vec3 normal, vec3 direction) {
    float distance = dot(abs(normal), error);
    vec3 offset = distance * (dot(direction, normal) < 0.0 ? -normal : normal);
    vec3 q = p + offset;
    return vec3(next_away(q.x, offset.x), next_away(q.y, offset.y), next_away(q.z, offset.z));
}
