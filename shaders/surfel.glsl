// The surface element at a hit: where it is, how sure we are of that, and what it is made of (slide "Surface Element Class").

struct Surfel {
    vec3 position;
    vec3 position_error;      // bound on the rounding of `position`, by coordinate; its part across the surface counts
    vec3 geometric_normal;    // unit, on the side of wo
    vec3 shading_normal;      // unit, on the side of wo
    vec3 unbent_normal;       // where NORMAL_MAPS: the same before maps bent it
    uint material;
    bool front;               // wo is on the outward side
    vec2 uv;                  // where TEXTURES
    vec3 colour;              // of the vertices, where VERTEX_COLOURS
    vec4 tangent;             // where TANGENTS: where u grows, beside the shading normal, and the handedness; zero where there is none
    vec3 horizon;             // where SMOOTH_TERMINATOR: the normal of the plane that parts above from below
    vec3 lift;                // where SMOOTH_TERMINATOR: by how much `position` was moved off the triangle
    Lobes lobes;              // towards wo, where PHYSICAL and the material is such a surface
};

// Bounds on the error of a position; src/gpu/pack/luminaire.rs takes them over a whole triangle.
const float UNIT_ROUNDOFF = 5.9604645e-8;       // half a unit in the last place of 1
const float POINT_ROUNDINGS = 7.0;              // of a point from its weights and the corners
const float PLANE_ROUNDINGS = 4.0;              // of a point's distance to the triangle's plane in the intersection tests
const float MOST_NARROW = 256.0;                // by how much the latter grows at most for a narrow triangle
const float TO_OBJECT_ROUNDINGS = 5.0;          // of the transform of a ray's origin into the object's space
const float TO_WORLD_ROUNDINGS = 4.0;           // of the transform of a point into world space

// Bound on the relative error of n roundings (Higham).
float gamma(float n) { return n * UNIT_ROUNDOFF / (1.0 - n * UNIT_ROUNDOFF); }

vec3 row_abs_dot(vec4 m[3], vec3 v) { return vec3(dot(abs(m[0].xyz), v), dot(abs(m[1].xyz), v), dot(abs(m[2].xyz), v)); }

// Normals go by the inverse transpose.
vec3 normal_to_world(vec4 to_object[3], vec3 n) {
    return to_object[0].xyz * n.x + to_object[1].xyz * n.y + to_object[2].xyz * n.z;
}

// The colour of the vertices at a point of a triangle (twin: src/reference/hit.rs).
vec3 vertex_colour(uint triangle, vec2 barycentric) {
    int base = int(triangle) * TRIANGLE_TEXELS;
    vec3 a = uintBitsToFloat(texelFetch(colours, base).xyz);
    vec3 b = uintBitsToFloat(texelFetch(colours, base + 1).xyz);
    vec3 c = uintBitsToFloat(texelFetch(colours, base + 2).xyz);
    return (1.0 - barycentric.x - barycentric.y) * a + barycentric.x * b + barycentric.y * c;
}

// How far a point of a triangle is below the surface that its vertex normals mean, on the side of `side` (src/reference/surfel.rs).
vec3 terminator_lift(Hit hit, vec3 p, vec3 side) {
    Triangle triangle = load_triangle(hit.triangle);
    vec3 corners[3] = vec3[3](triangle.a, triangle.b, triangle.c);
    vec3 weights = vec3(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    vec3 lift = vec3(0.0);
    for (int i = 0; i < 3; i++) {
        vec3 n = uintBitsToFloat(texelFetch(normals, int(hit.triangle) * TRIANGLE_TEXELS + i).xyz);
        vec3 corner = corners[i];
        if (INSTANCES) {
            vec4 to_world[3], to_object[3];
            object_to_world(hit.object, to_world);
            world_to_object(hit.object, to_object);
            corner = row_dot(to_world, corner) + translation(to_world);
            n = normal_to_world(to_object, n);
        }
        n = normalize(n / largest(abs(n)));
        if (dot(n, side) < 0.0) n = -n;
        lift += weights[i] * max(dot(corner - p, n), 0.0) * n;
    }
    return lift;
}

Surfel surfel(Hit hit, vec3 wo) {
    Surfel s;
    Triangle triangle = load_triangle(hit.triangle);
    vec3 a = triangle.a;
    vec3 b = triangle.b;
    vec3 c = triangle.c;
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
    float narrow = min(edges / largest(abs(s.geometric_normal)), MOST_NARROW);
    s.position_error = gamma(POINT_ROUNDINGS) * (abs(pa) + abs(pb) + abs(pc)) + gamma(PLANE_ROUNDINGS) * size * narrow;
    s.material = triangle.material;
    if (TEXTURES) s.uv = texture_coordinates(hit.triangle, w);
    if (VERTEX_COLOURS) s.colour = vertex_colour(hit.triangle, w);

    vec3 n = vec3(0.0);
    if (VERTEX_NORMALS) {
        int base = int(hit.triangle) * TRIANGLE_TEXELS;
        vec3 na = uintBitsToFloat(texelFetch(normals, base).xyz);
        vec3 nb = uintBitsToFloat(texelFetch(normals, base + 1).xyz);
        vec3 nc = uintBitsToFloat(texelFetch(normals, base + 2).xyz);
        // A corner without a normal makes the triangle flat.
        if (na != vec3(0.0) && nb != vec3(0.0) && nc != vec3(0.0)) {
            n = (1.0 - w.x - w.y) * na + w.x * nb + w.y * nc;
            // Outward is where the winding is counter-clockwise, unless the vertex normals know better: for the whole triangle, so that light
            // is inside behind all of it or behind none.
            if (dot(na + nb + nc, s.geometric_normal) < 0.0) s.geometric_normal = -s.geometric_normal;
        }
    }

    if (INSTANCES) {
        vec4 to_world[3], to_object[3];
        object_to_world(hit.object, to_world);
        world_to_object(hit.object, to_object);
        vec3 p = s.position;
        s.position = row_dot(to_world, p) + translation(to_world);
        // Rounding of the transform back into the object's space, when a ray leaves from here.
#ifdef RAY_QUERY
        vec3 back = gamma(TO_OBJECT_ROUNDINGS) * (row_abs_dot(to_object, abs(s.position)) + abs(translation(to_object)));
#else
        vec3 back = gamma(TO_OBJECT_ROUNDINGS) * row_abs_dot(to_object, abs(s.position - translation(to_world)));
#endif
        // Only what is across the surface matters. A transform takes distances across a surface to such by one factor, the length that it
        // gives to the normal; the bounds of the single coordinates would grow with its anisotropy.
        vec3 object_normal = s.geometric_normal / largest(abs(s.geometric_normal));
        s.geometric_normal = normal_to_world(to_object, object_normal);
        float across = dot(abs(object_normal), s.position_error + back) / largest(abs(s.geometric_normal));
        vec3 scaled = s.geometric_normal / largest(abs(s.geometric_normal));
        s.position_error = across / dot(scaled, scaled) * abs(scaled)
            + gamma(TO_WORLD_ROUNDINGS) * (row_abs_dot(to_world, abs(p)) + abs(translation(to_world)));
        if (VERTEX_NORMALS) n = normal_to_world(to_object, n);
        uint material = object_place(hit.object).material;
        if (material != NONE) s.material = material;
    }

    // Divided first, so that the squares of a small triangle's normal do not vanish.
    s.geometric_normal = normalize(s.geometric_normal / largest(abs(s.geometric_normal)));
    s.front = dot(s.geometric_normal, wo) >= 0.0;
    if (!s.front) s.geometric_normal = -s.geometric_normal;
    s.shading_normal = s.geometric_normal;
    if (VERTEX_NORMALS && n != vec3(0.0)) {
        n = normalize(n);
        if (dot(n, s.geometric_normal) < 0.0) n = -n;
        // A shading normal that faces away from the viewer says nothing useful.
        if (dot(n, wo) > 0.0) s.shading_normal = n;
    }
    if (SMOOTH_TERMINATOR) {
        s.horizon = s.geometric_normal;
        s.lift = vec3(0.0);
        // What lets light through has no side from which alone it is lit.
        if (s.shading_normal != s.geometric_normal && !lets_light_through(load_material(s.material))) {
            vec3 lift = terminator_lift(hit, s.position, s.shading_normal);
            // From no higher than rounding, as where the normals lean inwards, rays below the triangle's plane would start behind it.
            if (dot(lift, s.geometric_normal) > 2.0 * dot(abs(s.geometric_normal), s.position_error)) {
                s.horizon = s.shading_normal;
                s.lift = lift;
                s.position += lift;
            }
        }
    }
    if (NORMAL_MAPS) s.unbent_normal = s.shading_normal;
    if (TANGENTS || NORMAL_MAPS) {
        vec3 outward_normal = s.front ? s.shading_normal : -s.shading_normal;
        s.tangent = TANGENTS ? tangent_at(hit, outward_normal) : vec4(0.0);
        Material material;
        if (NORMAL_MAPS) material = load_material(s.material);
        if (NORMAL_MAPS && (material.normal_map != NONE || material.bump_map != NONE)) {
            vec3 ab = b - a;
            vec3 ac = c - a;
            if (INSTANCES) {
                vec4 to_world[3];
                object_to_world(hit.object, to_world);
                ab = row_dot(to_world, ab);
                ac = row_dot(to_world, ac);
            }
            vec3 bent = mapped_normal(material, hit.triangle, ab, ac, s.uv, outward_normal, s.tangent);
            s.shading_normal = guarded_normal(s.geometric_normal, wo, s.front ? bent : -bent);
            if (TANGENTS) {
                s.tangent.xyz = beside(s.shading_normal, s.tangent.xyz);
                if (s.tangent.xyz == vec3(0.0)) s.tangent.w = 0.0;
            }
        }
    }
    return s;
}

// The lobes of a metallic-roughness surface towards wo.
void find_lobes(inout Surfel s, Material material, vec3 wo) {
    if (!is_physical(material)) return;
    Physical p = physical_at(material, s.uv, s.colour);
    if (ANISOTROPY) {
        vec3 outward = s.front ? s.shading_normal : -s.shading_normal;
        vec2 sc = sin_cos_turns(p.anisotropy_rotation);
        s.tangent.xyz = sc.y * s.tangent.xyz + sc.x * s.tangent.w * cross(outward, s.tangent.xyz);
    }
    s.lobes = physical_lobes(p, s.shading_normal, NORMAL_MAPS ? s.unbent_normal : s.shading_normal, s.tangent.xyz, s.front, wo);
}

// What a choice of luminaires has to know of the receiver: the shading normal, of length 2 if light from both of its sides is scattered.
vec3 receiver(Surfel s, Material material) {
    bool both = ROUGH_TRANSMISSION && is_physical(material) && scatters_through(s.lobes.p);
    return both ? 2.0 * s.shading_normal : s.shading_normal;
}

// What the body absorbs into which a ray leaves in this direction.
vec3 inner_absorption(Surfel s, Material material, vec3 direction) {
    bool inwards = VOLUMES && is_physical(material) && (dot(s.geometric_normal, direction) < 0.0) == s.front;
    return inwards && s.lobes.p.body != 0u ? s.lobes.p.absorption : vec3(0.0);
}

// The cosine by which light from a direction counts.
float cosine_at(Surfel s, vec3 wi) {
    float cosine = dot(s.shading_normal, wi);
    return ROUGH_TRANSMISSION ? abs(cosine) : cosine;
}

// By how much more what comes from wi is diluted than shares of energy are: eta^2 of what is refracted.
float dilution(Surfel s, Material material, vec3 wi) {
    if (!ROUGH_TRANSMISSION || !is_physical(material) || dot(s.shading_normal, wi) > 0.0) return 1.0;
    float eta = bend(s.lobes);
    return eta * eta;
}

// The material with its textures, and with the colours of the vertices.
Material material_at(Surfel s) {
    Material material = load_material(s.material);
    if (TEXTURES) {
        if (SIMPLE && material.ambient_map != NONE) material.ambient *= texture_at(material.ambient_map, s.uv).rgb;
        if (material.lambert_map != NONE) material.lambert *= texture_at(material.lambert_map, s.uv).rgb;
        if (GLOSSY && material.glossy_map != NONE) material.glossy *= texture_at(material.glossy_map, s.uv).rgb;
        if (AREA_LUMINAIRES && material.emission_map != NONE) material.emission *= texture_at(material.emission_map, s.uv).rgb;
    }
    if (VERTEX_COLOURS) {
        material.lambert *= s.colour;
        if (SIMPLE) material.ambient *= s.colour;
    }
    if (AREA_LUMINAIRES && material.one_sided != 0u && !s.front) material.emission = vec3(0.0);
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
