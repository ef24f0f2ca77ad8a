// The sensor (slide "Sensor Modelling"): a pinhole, and a box filter over the pixel.

// The direction of the camera ray of a pixel; `u` is the place inside the pixel.
vec3 sensor_direction(uvec2 pixel, vec2 u) {
    vec2 film = (vec2(pixel) + u) / vec2(frame.width, frame.height);
    vec2 p = vec2(2.0 * film.x - 1.0, 1.0 - 2.0 * film.y);
    return normalize(frame.forward.xyz + p.x * frame.right.xyz + p.y * frame.up.xyz);
}
