// The camera (slide "Sensor Modelling"): pixel filter, perspective or parallel projection, pinhole or thin lens. The twin is
// src/reference/sensor.rs.

float filter_knot(uint i) { return frame.filter_table[i >> 2u][i & 3u]; }

// From a pixel's left (upper) edge to a film point, in pixels.
float filter_offset(uint random) {
    uint interval = random >> 24u;
    float low = filter_knot(interval);
    return 0.5 + (low + (filter_knot(interval + 1u) - low) * uniform1(random << 8u));
}

// A corner of the aperture's polygon.
vec2 lens_corner(uint k) { return sin_cos_turns(float(k) / frame.lens_blades + frame.lens_rotation).yx; }

// A point on the aperture, evenly: to the right and up, in the scene's unit.
vec2 lens_point(uvec2 random) {
    vec2 point;
    if (frame.lens_blades == 0.0) {
        point = concentric_disk(uniform2(random));
    } else {
        // The sector is the integer part of the number times the blades, and what is left of it is uniform again.
        uint sector, rest;
        umulExtended(random.x, uint(frame.lens_blades), sector, rest);
        vec3 b = uniform_triangle(uniform2(uvec2(rest, random.y)));
        point = b.x * lens_corner(sector) + b.y * lens_corner(sector + 1u);
    }
    return frame.lens_radius * point;
}

// Origin and unit direction of the camera ray for a sample of a pixel.
void sensor_ray(uvec2 pixel, uint pixel_index, uint sample_index, out vec3 origin, out vec3 direction) {
    uvec4 random = numbers(pixel_index, sample_index, SENSOR_BLOCK, frame.seed);
    vec2 film = (vec2(pixel) + vec2(filter_offset(random.x), filter_offset(random.y))) / vec2(frame.width, frame.height);
    vec2 p = vec2(2.0 * film.x - 1.0, 1.0 - 2.0 * film.y);
    vec3 offset = p.x * frame.right.xyz + p.y * frame.up.xyz;
    origin = frame.position.xyz;
    direction = frame.forward.xyz;
    if (ORTHOGRAPHIC) {
        origin += offset;
    } else {
        direction += offset;
        // Not the eye point (src/scene/sensor.rs): the ray would round by its distance.
        if (frame.start > 0.0) origin += frame.start * offset;
    }
    if (frame.lens_radius > 0.0) {
        // All rays of a film point meet in one point of the plane of focus.
        vec2 point = lens_point(random.zw);
        offset = point.x * normalize(frame.right.xyz) + point.y * normalize(frame.up.xyz);
        if (frame.start > 0.0) origin += frame.lens_at_start * offset;
        else origin += offset;
        direction = frame.focus_distance * direction - offset;
    }
    direction = normalize(direction);
}
