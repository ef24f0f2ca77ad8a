// What the host binds. The structs' twins are in src/gpu/layout.rs; a test compares every member's offset.

// What the scene needs: computed by src/gpu/model.rs. A `false` removes the code.
layout(constant_id = 0) const bool SIMPLE = false;             // the simple ray tracer instead of the path tracer
layout(constant_id = 1) const bool GLOSSY = true;              // some material has a glossy lobe
layout(constant_id = 2) const bool VERTEX_NORMALS = true;      // some mesh has vertex normals
layout(constant_id = 3) const bool INSTANCES = true;           // more than one object, or a transform
layout(constant_id = 4) const bool POINT_LUMINAIRES = true;
layout(constant_id = 5) const bool INFINITE_LUMINAIRES = true;
layout(constant_id = 6) const bool AREA_LUMINAIRES = true;     // some material emits

layout(set = 0, binding = 0, std140) uniform Frame {
    vec4 position;     // eye point
    vec4 forward;      // unit line of sight
    vec4 right;        // to the right edge of the picture, at distance 1
    vec4 up;           // to the upper edge
    vec4 ambient;      // ambient radiance of the simple ray tracer
    uint width;        // film size in pixels
    uint height;
    uint seed;
    uint luminaire_count;
    uint max_bounces;
} frame;

// Triangles in object space, three texels each: corners in xyz; w holds the material, the index in the scene's mesh, 0.
layout(set = 0, binding = 2) uniform usamplerBuffer triangles;
// Vertex normals, three texels a triangle, where VERTEX_NORMALS.
layout(set = 0, binding = 3) uniform usamplerBuffer normals;

struct Object {
    vec4 object_to_world[3];   // rows
    vec4 world_to_object[3];   // rows
    uint root_node;            // of the mesh's BVH
    uint triangle_offset;      // of the mesh's first triangle
    uint material;             // replaces the triangles' own, unless NONE
    uint scene_index;          // in Scene::objects
};
layout(set = 0, binding = 4, std430) readonly buffer Objects { Object objects[]; };

struct Material {
    vec4 ambient;    // rgb; w: N(m), the normalisation of the glossy lobe
    vec4 lambert;    // rgb; w: probability of survival (1 - extinction)
    vec4 glossy;     // rgb; w: exponent m
    vec4 emission;   // rgb
};
layout(set = 0, binding = 5, std430) readonly buffer Materials { Material materials[]; };

const uint POINT = 0u;
const uint INFINITE = 1u;
const uint AREA = 2u;

struct Luminaire {
    vec4 a;            // point: position; infinite: unit vector towards the light; area: first corner
    vec4 b;            // area: second corner; w: area
    vec4 c;            // area: third corner; w: bound on the error of a point on the triangle, in each coordinate
    vec4 normal;       // area: unit normal
    vec4 radiance;     // intensity, irradiance or radiance; w: probability of being chosen
    uint kind;
    uint threshold;    // alias table
    uint alias_index;
    uint padding;
};
layout(set = 0, binding = 6, std430) readonly buffer Luminaires { Luminaire luminaires[]; };

const uint NONE = 0xffffffffu;

vec3 row_dot(vec4 m[3], vec3 v) { return vec3(dot(m[0].xyz, v), dot(m[1].xyz, v), dot(m[2].xyz, v)); }
vec3 translation(vec4 m[3]) { return vec3(m[0].w, m[1].w, m[2].w); }
