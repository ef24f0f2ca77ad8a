// What bends shading normals: maps of normals and of heights, and what keeps their mirror directions above the surface; twins in src/reference/normal_map.rs.

const float LEAST_SQUARE = 1e-12;
const float LEAST_REFLECTED = 0.01;

// Made perpendicular to the unit vector n, of unit length; zero if it is along n.
vec3 beside(vec3 n, vec3 t) {
    vec3 across = t - n * dot(n, t);
    float square = dot(across, across);
    return square > LEAST_SQUARE ? across * inversesqrt(square) : vec3(0.0);
}

// The tangent at a hit, beside the outward shading normal n, with the handedness in w; all zero where the mesh has none.
vec4 tangent_at(Hit hit, vec3 n) {
    int base = int(hit.triangle) * TRIANGLE_TEXELS;
    vec4 a = uintBitsToFloat(texelFetch(tangents, base));
    vec4 b = uintBitsToFloat(texelFetch(tangents, base + 1));
    vec4 c = uintBitsToFloat(texelFetch(tangents, base + 2));
    vec2 w = hit.barycentric;
    vec3 t = (1.0 - w.x - w.y) * a.xyz + w.x * b.xyz + w.y * c.xyz;
    float handedness = a.w;
    if (INSTANCES) {
        // Tangents lie in the surface and go by the map itself, normals by its inverse transpose.
        vec4 to_world[3];
        object_to_world(hit.object, to_world);
        t = row_dot(to_world, t);
        vec3 x = to_world[0].xyz / largest(abs(to_world[0].xyz));
        vec3 y = to_world[1].xyz / largest(abs(to_world[1].xyz));
        if (dot(cross(x, y), to_world[2].xyz) < 0.0) handedness = -handedness;
    }
    float size = largest(abs(t));
    if (handedness == 0.0 || size == 0.0) return vec4(0.0);
    t = beside(n, normalize(t / size));
    return vec4(t, t == vec3(0.0) ? 0.0 : handedness);
}

// The gradient, within the plane of a triangle with these edges, of what grows by so much along them.
vec3 surface_gradient(vec3 ab, vec3 ac, float to_b, float to_c) {
    float size = largest(max(abs(ab), abs(ac)));
    ab /= size;
    ac /= size;
    vec3 n = cross(ab, ac);
    vec3 gradient = (to_b * cross(ac, n) + to_c * cross(n, ab)) / (dot(n, n) * size);
    // By the bits: a compiler may assume that no float is infinite. So steep that only its direction is left.
    bool none = any(equal(floatBitsToUint(gradient) & INFINITY_BITS, uvec3(INFINITY_BITS)));
    return none ? vec3(0.0) : gradient / max(1e-15 * largest(abs(gradient)), 1.0);
}

// What lies along the axes of an image, along tangent and bitangent: a transform of the texture coordinates may turn the image and mirror it.
vec2 on_surface(uint map, vec2 v) {
    if (!MAP_TRANSFORMS) return v;
    Texture image = load_texture(map);
    float side = image.u.x * image.v.y < image.u.y * image.v.x ? -1.0 : 1.0;
    // The first column of the inverse, but for its length.
    vec2 x = side * vec2(image.v.y, -image.v.x);
    float size = largest(abs(vec3(x, 0.0)));
    x = size > 0.0 ? normalize(x / size) : vec2(1.0, 0.0);
    return v.x * x + v.y * side * vec2(-x.y, x.x);
}

// The outward shading normal n as the material's maps bend it, on a triangle with these edges.
vec3 mapped_normal(Material material, uint triangle, vec3 ab, vec3 ac, vec2 uv, vec3 n, vec4 tangent) {
    vec3 bent = n;
    if (TANGENTS && material.normal_map != NONE && tangent.w != 0.0) {
        vec3 texel = 2.0 * texture_at(material.normal_map, uv).rgb - 1.0;
        vec3 bitangent = tangent.w * cross(n, tangent.xyz);
        vec2 along = material.normal_scale * on_surface(material.normal_map, texel.xy);
        vec3 sum = along.x * tangent.xyz + along.y * bitangent + texel.z * n;
        sum /= max(largest(abs(sum)) * 1e-15, 1.0);
        if (dot(sum, sum) > LEAST_SQUARE) bent = normalize(sum);
    }
    if (material.bump_map != NONE) {
        vec2 slope = material.bump_scale * height_gradient(material.bump_map, uv);
        vec4 uv_ab = uintBitsToFloat(texelFetch(uvs, int(2u * triangle)));
        vec2 uv_c = uintBitsToFloat(texelFetch(uvs, int(2u * triangle + 1u)).xy);
        vec3 gradient = surface_gradient(ab, ac, dot(slope, uv_ab.zw - uv_ab.xy), dot(slope, uv_c - uv_ab.xy));
        bent = normalize(bent - (gradient - bent * dot(bent, gradient)));
    }
    return bent;
}

// `n`, or the normal that lifts the mirror direction about it above the triangle.
vec3 guarded_normal(vec3 geometric_normal, vec3 wo, vec3 n) {
    float cosine = dot(n, wo);
    // A normal that faces away counts as one across the line of sight.
    vec3 mirrored = 2.0 * max(cosine, 0.0) * n - wo;
    float least = min(0.9 * dot(geometric_normal, wo), LEAST_REFLECTED);
    float height = dot(geometric_normal, mirrored);
    if (cosine > 0.0 && height >= least) return n;
    vec3 along = mirrored - height * geometric_normal;
    float square = dot(along, along);
    if (square <= LEAST_SQUARE) return geometric_normal;
    vec3 lifted = along * (inversesqrt(square) * sqrt(1.0 - least * least)) + least * geometric_normal;
    vec3 halfway = wo + lifted;
    return dot(halfway, halfway) <= LEAST_SQUARE ? geometric_normal : normalize(halfway);
}
