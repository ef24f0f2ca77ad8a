// Discs at infinity: where they are, and directions to them; the twins are in src/reference/sun.rs.

// One minus the cosine of the angle between two unit vectors: half the square of the chord, which does not cancel where they are close.
float one_minus_cosine(vec3 a, vec3 b) {
    vec3 chord = a - b;
    return 0.5 * dot(chord, chord);
}

// Density of an even choice of a disc's directions, per steradian.
float sun_density(Luminaire sun) { return 0.5 / (PI * sun.area); }

// A direction to a disc, evenly over its solid angle: 1 - cosine goes as the square of the radius in the unit disk.
vec3 sample_sun(Luminaire sun, vec2 u) {
    vec2 disk = concentric_disk(u);
    float below = sun.area * dot(disk, disk);
    return from_frame(sun.a, vec3(disk * sqrt(sun.area * (2.0 - below)), 1.0 - below));
}
