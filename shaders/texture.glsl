// Images on surfaces; twins in src/reference/texture.rs.

vec2 texture_coordinates(uint triangle, vec2 barycentric) {
    vec4 ab = uintBitsToFloat(texelFetch(uvs, int(2u * triangle)));
    vec2 c = uintBitsToFloat(texelFetch(uvs, int(2u * triangle + 1u)).xy);
    return (1.0 - barycentric.x - barycentric.y) * ab.xy + barycentric.x * ab.zw + barycentric.y * c;
}

vec4 texel_at(uint index) {
    uvec4 pair = texelFetch(texels, int(index >> 1u));
    uvec2 halves = (index & 1u) == 0u ? pair.xy : pair.zw;
    return vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y));
}

// An image's texel in `textures`.
struct Texture {
    uint first_texel;    // in `texels`
    uint width;
    uint height;
    bool clamped;
    vec3 u;              // scalar product with (u, v, 1): where in the image, from its left edge
    vec3 v;              // the same from its lower edge
};

Texture load_texture(uint index) {
    int base = int(index) * TEXTURE_TEXELS;
    uvec4 texel = texelFetch(textures, base);
    vec3 u = uintBitsToFloat(texelFetch(textures, base + 1).xyz);
    vec3 v = uintBitsToFloat(texelFetch(textures, base + 2).xyz);
    return Texture(texel.x, texel.y, texel.z, texel.w != 0u, u, v);
}

// A coordinate that is not finite counts as 0. By the bits: a compiler may assume that no float is infinite.
vec2 finite(vec2 uv) { return mix(uv, vec2(0.0), equal(floatBitsToUint(uv) & INFINITY_BITS, uvec2(INFINITY_BITS))); }

// Where uv is in the image.
vec2 placed(Texture image, vec2 uv) {
    uv = finite(uv);
    if (MAP_TRANSFORMS) uv = finite(vec2(dot(image.u, vec3(uv, 1.0)), dot(image.v, vec3(uv, 1.0))));
    return uv;
}

// Linear RGB and alpha, bilinear between the centres of texels; v points up.
vec4 image_at(Texture image, vec2 uv) {
    ivec2 size = ivec2(image.width, image.height);
    uv = image.clamped ? clamp(uv, vec2(0.0), vec2(1.0)) : uv - floor(uv);
    vec2 p = vec2(uv.x, 1.0 - uv.y) * vec2(size) - 0.5;
    vec2 low = floor(p);
    vec2 f = p - low;
    ivec2 p0 = ivec2(low);
    ivec2 p1 = p0 + 1;
    if (image.clamped) {
        p0 = clamp(p0, ivec2(0), size - 1);
        p1 = clamp(p1, ivec2(0), size - 1);
    } else {
        p0 = mix(p0, p0 + size, lessThan(p0, ivec2(0)));
        p1 = mix(p1, p1 - size, greaterThanEqual(p1, size));
    }
    uint row0 = image.first_texel + uint(p0.y) * image.width;
    uint row1 = image.first_texel + uint(p1.y) * image.width;
    vec4 upper = mix(texel_at(row0 + uint(p0.x)), texel_at(row0 + uint(p1.x)), f.x);
    vec4 lower = mix(texel_at(row1 + uint(p0.x)), texel_at(row1 + uint(p1.x)), f.x);
    return mix(upper, lower, f.y);
}

vec4 texture_at(uint map, vec2 uv) {
    Texture image = load_texture(map);
    return image_at(image, placed(image, uv));
}

float height_at(Texture image, vec2 uv) {
    vec4 texel = image_at(image, uv);
    return texel.r + texel.g;
}

// How the heights of a texture grow with u and v, by differences over one texel.
vec2 height_gradient(uint map, vec2 uv) {
    Texture image = load_texture(map);
    vec2 size = vec2(image.width, image.height);
    uv = placed(image, uv);
    vec2 across = vec2(0.5 / size.x, 0.0);
    vec2 upwards = vec2(0.0, 0.5 / size.y);
    vec2 slope = size * vec2(height_at(image, uv + across) - height_at(image, uv - across),
                             height_at(image, uv + upwards) - height_at(image, uv - upwards));
    return MAP_TRANSFORMS ? slope.x * image.u.xy + slope.y * image.v.xy : slope;
}

// The share of light that meets a point of a triangle at all.
float opacity_at(uint material, uint triangle, vec2 barycentric) {
    Material m = load_material(material);
    float opacity = m.opacity;
    uint map = m.opacity_map;
    if (map != NONE) opacity *= texture_at(map, texture_coordinates(triangle, barycentric)).a;
    return opacity;
}

// Of the triangle's own, or its object's.
uint material_of(uint object, uint triangle) {
    uint material = INSTANCES ? object_place(object).material : NONE;
    return material == NONE ? load_triangle(triangle).material : material;
}

// Whether a ray stops at a hit, by chance where the surface is partly transparent.
bool covers(uint salt, uint object, uint triangle, vec2 barycentric) {
    uint material = material_of(object, triangle);
    Material m = load_material(material);
    if (m.opacity >= 1.0 && m.opacity_map == NONE) return true;
    uint index_in_mesh = load_triangle(triangle).index_in_mesh;
    return uniform1(coverage(salt, object_place(object).scene_index, index_in_mesh)) < opacity_at(material, triangle, barycentric);
}

// Whether it passes a metallic-roughness surface there: one that may bound a body (absorption.glsl).
bool is_passed(uint salt, uint object, uint triangle, vec2 barycentric) {
    return load_material(material_of(object, triangle)).kind > 1u && !covers(salt, object, triangle, barycentric);
}
