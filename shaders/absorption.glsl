// What bodies absorb along a ray: Beer's law, from one crossing of a boundary to the next (twins: src/reference/absorption.rs).

// What is not absorbed over a length inside.
vec3 absorbed(vec3 absorption, float length) { return mix(vec3(1.0), exp(-absorption * length), greaterThan(absorption, vec3(0.0))); }

// What is absorbed in a unit of length behind the surfaces of a material.
vec3 body_absorption(uint material) {
    Material m = load_material(material);
    if (!is_physical(m)) return vec3(0.0);
    Physical p = load_physical(m.kind >> 1u);
    return p.body != 0u ? p.absorption : vec3(0.0);
}

// Whether a ray comes to the outward side of what it hits.
bool is_front(Hit hit, vec3 direction) {
    Triangle triangle = load_triangle(hit.triangle);
    vec3 outward = triangle_normal(triangle.a, triangle.b, triangle.c);
    outward /= largest(abs(outward));
    if (VERTEX_NORMALS) {
        int base = int(hit.triangle) * TRIANGLE_TEXELS;
        vec3 a = uintBitsToFloat(texelFetch(normals, base).xyz);
        vec3 b = uintBitsToFloat(texelFetch(normals, base + 1).xyz);
        vec3 c = uintBitsToFloat(texelFetch(normals, base + 2).xyz);
        if (a != vec3(0.0) && b != vec3(0.0) && c != vec3(0.0) && dot(a + b + c, outward) < 0.0) outward = -outward;
    }
    if (INSTANCES) {
        vec4 to_object[3];
        world_to_object(hit.object, to_object);
        outward = normal_to_world(to_object, outward);
    }
    return dot(outward, direction) <= 0.0;
}

// What is left of light along a ray behind the last hole that it passes before `t_max`, where nothing stops it; `size` is the length of its direction. Holes in bodies are crossings of their boundaries:
// `from` is absorbed where the ray begins, and becomes what is absorbed behind the last of them, `t` where that is.
vec3 through_holes(vec3 origin, vec3 direction, float size, float t_max, uint salt, inout vec3 from, out float t) {
    vec3 left = vec3(1.0);
    t = 0.0;
    float t_min = 0.0;
    Hit hit;
    while (next_passed(origin, direction, t_min, t_max, salt, hit)) {
        t_min = hit.t;
        vec3 inside = body_absorption(material_of(hit.object, hit.triangle));
        if (inside == vec3(0.0)) continue;
        bool front = is_front(hit, direction);
        left *= absorbed(front ? from : inside, size * (hit.t - t));
        from = front ? inside : vec3(0.0);
        t = hit.t;
    }
    return left;
}
