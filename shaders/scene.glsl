// What the host binds. The structs' twins are in src/gpu/layout.rs; a test compares every member's offset.

// What the scene uses: computed by src/gpu/model.rs. A `false` removes the code.
layout(constant_id = 0) const bool GLOSSY = true;              // some material has a glossy lobe
layout(constant_id = 1) const bool VERTEX_NORMALS = true;      // some mesh has vertex normals
layout(constant_id = 2) const bool INSTANCES = true;           // more than one object, or a transform
layout(constant_id = 3) const bool POINT_LUMINAIRES = true;
layout(constant_id = 4) const bool INFINITE_LUMINAIRES = true;
layout(constant_id = 5) const bool AREA_LUMINAIRES = true;     // some material emits
layout(constant_id = 6) const bool ENVIRONMENT = true;         // light comes from where rays escape to
layout(constant_id = 7) const bool IMPULSES = true;            // some material is a mirror or a dielectric
layout(constant_id = 8) const bool DIELECTRICS = true;         // some material has an index of refraction
layout(constant_id = 9) const bool TEXTURES = true;            // some material has a map
layout(constant_id = 10) const bool HOLES = true;              // some material is not opaque everywhere
layout(constant_id = 11) const bool ORTHOGRAPHIC = false;
layout(constant_id = 12) const bool SOBOL = false;

// The integrator's choices (src/scene/estimator.rs).
layout(constant_id = 13) const bool SIMPLE = false;            // the simple ray tracer instead of the path tracer
layout(constant_id = 14) const uint LIGHT_SAMPLING = 2u;
layout(constant_id = 15) const bool SOLID_ANGLE = true;        // near triangles are sampled by solid angle
layout(constant_id = 16) const uint DIRECTIONS = 2u;
layout(constant_id = 17) const uint EXTINCTION = 3u;
layout(constant_id = 18) const bool THRESHOLD = false;         // paths of small albedo end

const uint LIGHT_NONE = 0u;
const uint LIGHT_DIRECT = 1u;
const uint LIGHT_MIS = 2u;
const uint DIRECTIONS_UNIFORM = 0u;
const uint DIRECTIONS_COSINE = 1u;
const uint DIRECTIONS_BSDF = 2u;
const uint EXTINCTION_OFF = 0u;
const uint EXTINCTION_LITERAL = 1u;
const uint EXTINCTION_SURFACE = 2u;
const uint EXTINCTION_THROUGHPUT = 3u;

layout(set = 0, binding = 0, std140) uniform Frame {
    vec4 position;     // eye point
    vec4 forward;      // unit line of sight
    vec4 right;        // to the right edge of the picture: at distance 1, or of the parallel rays
    vec4 up;           // to the upper edge
    vec4 lens;         // radius of the aperture, focus distance, blades, rotation in turns
    vec4 ambient;      // ambient radiance of the simple ray tracer
    vec4 environment;  // radiance of the environment, or a factor to its image; w: probability of choosing it
    uint width;        // film size in pixels
    uint height;
    uint seed;
    uint luminaire_count;
    uint max_bounces;
    float albedo_threshold;
    uint environment_width;      // in texels
    uint environment_height;
    float environment_rotation;  // in turns
    vec4 filter_table[65];       // inverse cumulative distribution of the pixel filter: 257 knots, in pixels
} frame;

// Triangles in object space, three texels each: corners in xyz; w holds the material, the index in the scene's mesh, 0.
layout(set = 0, binding = 2) uniform usamplerBuffer triangles;
// Vertex normals, three texels a triangle, where VERTEX_NORMALS.
layout(set = 0, binding = 3) uniform usamplerBuffer normals;

// Objects, seven texels each: three rows to world space, three rows back, and `ObjectPlace`. Texels, because lavapipe reads them
// several times faster than storage buffers.
layout(set = 0, binding = 4) uniform usamplerBuffer objects;

struct Material {
    vec4 ambient;         // rgb; w: N(m), the normalisation of the glossy lobe
    vec4 lambert;         // rgb; w: probability of an impulse, or -1: by the albedos
    vec4 glossy;          // rgb; w: exponent m
    vec4 emission;        // rgb; w: probability of choosing a triangle of this material for each unit of its area
    vec4 reflection;      // rgb of the impulse; w: eta, or 0: a mirror
    vec4 transmission;    // rgb of the impulse; w: opacity
    uvec4 maps;           // textures that multiply ambient, lambert, glossy and emission, or NONE
    uint opacity_map;     // its alpha multiplies the opacity
    uint one_sided;       // 1 if only the outward side emits
};
// Eight texels each.
layout(set = 0, binding = 5) uniform usamplerBuffer materials;

const uint POINT = 0u;
const uint INFINITE = 1u;
const uint AREA = 2u;
const uint SURROUNDINGS = 3u;

struct Luminaire {
    vec4 a;            // point: position; infinite: unit vector towards the light; area: first corner
    vec4 b;            // area: second corner; w: area
    vec4 c;            // area: third corner; w: bound on the error of a point on the triangle, in each coordinate
    vec4 normal;       // area: unit outward normal; w: 1 if only that side emits
    vec4 radiance;     // intensity, irradiance or radiance (without its texture); w: probability of being chosen
    uint kind;
    uint triangle;     // area: index into `triangles`
    uint material;     // area
};
// Seven texels each.
layout(set = 0, binding = 6) uniform usamplerBuffer luminaires;

// Texture coordinates, two texels a triangle: those of the first two corners, then the third's.
layout(set = 0, binding = 9) uniform usamplerBuffer uvs;
// One texel a texture: its first texel in `texels`, width, height, whether it is clamped.
layout(set = 0, binding = 10) uniform usamplerBuffer textures;
// Two texels of a texture in one: four half floats each.
layout(set = 0, binding = 11) uniform usamplerBuffer texels;
// One texel a texel of the environment: radiance without its factor, density of its directions per steradian.
layout(set = 0, binding = 12) uniform usamplerBuffer environment_texels;
// Two slots of the environment's alias table in one: threshold and alias each.
layout(set = 0, binding = 13) uniform usamplerBuffer environment_slots;

const uint NONE = 0xffffffffu;

// Sizes of the structures that are read as texels.
const int OBJECT_TEXELS = 7;
const int MATERIAL_TEXELS = 8;
const int LUMINAIRE_TEXELS = 7;

vec3 row_dot(vec4 m[3], vec3 v) { return vec3(dot(m[0].xyz, v), dot(m[1].xyz, v), dot(m[2].xyz, v)); }
vec3 translation(vec4 m[3]) { return vec3(m[0].w, m[1].w, m[2].w); }

// The rest of an object.
struct ObjectPlace {
    uint root_node;            // of the mesh's BVH
    uint triangle_offset;      // of the mesh's first triangle
    uint material;             // replaces the triangles' own, unless NONE
    uint scene_index;          // in Scene::objects
};

ObjectPlace object_place(uint object) {
    uvec4 t = texelFetch(objects, int(object) * OBJECT_TEXELS + 6);
    return ObjectPlace(t.x, t.y, t.z, t.w);
}

// Rows of the map to world space, and of its inverse.
void object_to_world(uint object, out vec4 rows[3]) {
    for (int i = 0; i < 3; i++) rows[i] = uintBitsToFloat(texelFetch(objects, int(object) * OBJECT_TEXELS + i));
}
void world_to_object(uint object, out vec4 rows[3]) {
    for (int i = 0; i < 3; i++) rows[i] = uintBitsToFloat(texelFetch(objects, int(object) * OBJECT_TEXELS + 3 + i));
}

Material load_material(uint index) {
    int base = int(index) * MATERIAL_TEXELS;
    uvec4 last = texelFetch(materials, base + 7);
    return Material(
        uintBitsToFloat(texelFetch(materials, base)), uintBitsToFloat(texelFetch(materials, base + 1)),
        uintBitsToFloat(texelFetch(materials, base + 2)), uintBitsToFloat(texelFetch(materials, base + 3)),
        uintBitsToFloat(texelFetch(materials, base + 4)), uintBitsToFloat(texelFetch(materials, base + 5)),
        texelFetch(materials, base + 6), last.x, last.y);
}

Luminaire load_luminaire(uint index) {
    int base = int(index) * LUMINAIRE_TEXELS;
    uvec4 choice = texelFetch(luminaires, base + 5);
    return Luminaire(
        uintBitsToFloat(texelFetch(luminaires, base)), uintBitsToFloat(texelFetch(luminaires, base + 1)),
        uintBitsToFloat(texelFetch(luminaires, base + 2)), uintBitsToFloat(texelFetch(luminaires, base + 3)),
        uintBitsToFloat(texelFetch(luminaires, base + 4)), choice.x, choice.w, texelFetch(luminaires, base + 6).x);
}
