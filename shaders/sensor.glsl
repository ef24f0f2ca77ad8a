// The sensor (slide "Sensor Modelling"): a pinhole, and a box filter over the pixel.

// The unit direction of the camera ray for a sample of a pixel, evenly over the pixel's square; its origin is the eye point.
void sensor_ray(uvec2 pixel, uint pixel_index, uint sample_index, out vec3 origin, out vec3 direction) {
    origin = frame.position.xyz;
    vec2 u = uniform2(random4(pixel_index, sample_index, SENSOR_BLOCK, frame.seed).xy);
    vec2 film = (vec2(pixel) + u) / vec2(frame.width, frame.height);
    vec2 p = vec2(2.0 * film.x - 1.0, 1.0 - 2.0 * film.y);
    direction = normalize(frame.forward.xyz + p.x * frame.right.xyz + p.y * frame.up.xyz);
}
