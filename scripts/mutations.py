#!/usr/bin/env python3
"""Do the tests notice wrong physics? Applies deliberate bugs one by one to a copy, and runs the tests there until one fails.

    python3 scripts/mutations.py            all of them: an hour on two cores
    python3 scripts/mutations.py eta half   those whose names contain one of the words
    python3 scripts/mutations.py --list
    python3 scripts/mutations.py --fit      only whether each of them still fits the source; runs nothing

The copy is what git has of the working tree (tracked files as they are now), in target/mutations. Wants what `make test` wants. Exit code
0 if every bug is caught, 1 if one is not, 2 if a bug does not fit the source any more or the tests cannot be run.
"""

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COPY = ROOT / "target/mutations/copy"

# The tests, fast and general ones first.
CLOSED_FORMS = ["--test", "closed_forms"]
ERROR_BAR = ["--test", "error_bar"]
REFERENCE = ["--test", "reference"]
LIBRARY = ["--lib"]
KERNEL = ["--test", "gpu", "--", "--skip", "fallback"]


def kernel(test):
    """The tests of the kernel of this name, first: all of them take minutes."""
    return ["--test", "gpu", "--", test]


# Name, file, what stands there (once), what the bug makes of it, and which tests are to notice.
MUTATIONS = [
    ("missing cosine", "shaders/luminaire.glsl",
     "vec3 scattered = f.rgb * cosine_at(s, wi);", "vec3 scattered = f.rgb;", [CLOSED_FORMS, KERNEL]),
    ("missing 1/pi", "shaders/bsdf.glsl",
     "vec3 f = material.lambert * (1.0 / PI);", "vec3 f = material.lambert;", [CLOSED_FORMS, KERNEL]),
    ("eta of the wrong side", "shaders/impulse.glsl",
     "s.front || opaque ? material.eta : 1.0 / material.eta;",
     "s.front ? 1.0 / material.eta : material.eta;", [CLOSED_FORMS, KERNEL]),
    ("a coat of which nothing comes back below", "shaders/bsdf.glsl",
     "lambert = outward * inward / average;", "lambert = outward * inward;", [KERNEL]),
    ("a base beside its coat", "shaders/bsdf.glsl",
     "        f *= lambert_coat;\n", "", [KERNEL]),
    ("a map that is moved before it is scaled", "src/scene/load/map_file.rs",
     "Affine2::from_scale_angle_translation(scale, 0.0, offset)",
     "Affine2::from_scale_angle_translation(scale, 0.0, offset * scale)", [["--test", "scene_loading"]]),
    ("numbers of a map that are decoded as colours are", "src/scene/load/texture.rs",
     "let numbers = |texel| image.stored(texel).map(range);", "let numbers = |texel| image.linear(texel).map(range);",
     [["--test", "scene_loading"]]),
    ("Blender's exponent as if it were the square of the roughness", "src/scene/load/mtl/blender.rs",
     "1.0 - (ns / most).sqrt().min(1.0)", "1.0 - (ns / most).min(1.0)", [["--test", "scene_loading"], LIBRARY]),
    ("maps where their coordinates are", "shaders/texture.glsl",
     "if (MAP_TRANSFORMS) uv =", "if (false) uv =", [KERNEL]),
    ("distant rays from the eye point's side", "shaders/sensor.glsl",
     "if (frame.start > 0.0) origin += frame.start * offset;", "", [KERNEL]),
    ("lamps of which none is chosen", "src/scene/luminaire_table.rs",
     "*power = power.max(least)", "*power = power.max(0.0 * least)", [REFERENCE]),
    ("cones that are narrower in the tree", "src/scene/light_tree/node.rs",
     "Some(widest.max(aside + source.cone?.to_radians()))", "Some(widest.max(0.5 * aside + 0.5 * source.cone?.to_radians()))", [REFERENCE]),
    ("a spot's edge that falls evenly", "shaders/luminaire.glsl",
     "    return inside * inside;\n}", "    return inside;\n}", [CLOSED_FORMS, KERNEL]),
    ("light sampling to which a glowing body is clear", "shaders/luminaire.glsl",
     "vec3 absorption = area && dot(light.normal, wi) > 0.0 ? body_absorption(light.material) : vec3(0.0);",
     "vec3 absorption = vec3(0.0);", [kernel("bodies"), KERNEL]),
    ("reference: light sampling to which a glowing body is clear", "src/reference/luminaire.rs",
     "SampledLuminaire::Area(triangle) if triangle.normal.dot(light.wi) > 0.0 => {",
     "SampledLuminaire::Area(triangle) if triangle.normal.dot(light.wi) > 2.0 => {", [REFERENCE]),
    ("holes that are no crossings", "shaders/absorption.glsl",
     "        t = hit.t;\n", "", [kernel("bodies"), KERNEL]),
    ("a horizon that lies in front of the sheet", "shaders/surfel.glsl",
     "if (dot(lift, s.geometric_normal) > 2.0 * dot(abs(s.geometric_normal), s.position_error)) {", "if (true) {", [kernel("relief"), KERNEL]),
    ("suns that are counted twice", "shaders/luminaire.glsl",
     "if (LIGHT_SAMPLING == LIGHT_MIS && (area || surroundings || sun)) {", "if (LIGHT_SAMPLING == LIGHT_MIS && (area || surroundings)) {",
     [CLOSED_FORMS, KERNEL]),
    ("a sun's density without its choice", "shaders/luminaire.glsl",
     "density = sun_probability(i, sun) * sun_density(sun);", "density = sun_density(sun);", [CLOSED_FORMS, KERNEL]),
    ("a sun of the solid angle for its irradiance", "src/scene/sun_disc.rs",
     "        self.extent * (2.0 - self.extent)", "        2.0 * self.extent", [CLOSED_FORMS, REFERENCE]),
    ("a profile that turns the other way", "src/scene/luminaire.rs",
     "[zero, zero.cross(direction)]", "[zero, direction.cross(zero)]", [CLOSED_FORMS]),
    ("profiles mirrored at the wrong plane", "src/scene/load/ies.rs",
     "let half: Vec<(f32, usize)> = own().chain(back(180.0)).collect();",
     "let half: Vec<(f32, usize)> = own().chain(own().map(|(angle, row)| (angle + 90.0, row))).collect();", [["--test", "scene_loading"]]),
    ("a light tree that forgets what was cut", "shaders/light_tree.glsl",
     "probability *= float(width) / whole;", "probability *= float(width) / 4294967296.0;", [KERNEL]),
    ("a light tree's path from the wrong end", "shaders/light_tree.glsl",
     "path = uvec2(path.x >> 2 | path.y << 30, path.y >> 2);", "path = path.yx;", [KERNEL]),
    ("a light tree that asks where the light is", "shaders/path.glsl",
     "path.normal = receiver(s, material);", "path.normal = -receiver(s, material);", [KERNEL]),
    ("lamps without their margin", "src/scene/light_tree/node.rs",
     "from_center)).fold(0.0, f64::max).sqrt();", "from_center)).fold(0.0, f64::max).sqrt() * 0.5;", [REFERENCE]),
    ("two-sided lamps with one side", "src/scene/light_tree/node.rs",
     "let two_sided = group.iter().any(Source::turns);", "let two_sided = false;", [REFERENCE]),
    ("reference: children in the wrong order", "src/reference/light_tree.rs",
     "let begin = if child == 0 { 0 } else { cuts[child - 1] };", "let begin = 0 * cuts[0];", [REFERENCE]),
    ("an ordinal that counts the dark", "src/scene/light_tree/mod.rs",
     "before += u32::from(emits(scene, triangle.material));", "before += 1;", [REFERENCE]),
    ("closed lamps inside out", "src/scene/lamp_shapes.rs",
     "outward) < 0.0 { -1.0 } else { 1.0 }", "outward) < 0.0 { 1.0 } else { -1.0 }", [LIBRARY]),
    ("a density by what the table does", "src/reference/luminaire.rs",
     "pdf: Some(ideal * density),", "pdf: Some(probability * density),", [REFERENCE]),
    ("emission counted twice", "shaders/luminaire.glsl",
     "    return power_heuristic(pdf, density);\n}", "    return 1.0;\n}", [CLOSED_FORMS, KERNEL]),
    ("a column by the number of the row", "shaders/environment.glsl",
     "search(columns, width, random.y >> 1u, u)", "search(columns, width, random.x >> 1u, u)", [KERNEL]),
    ("a search that stops before the number", "shaders/environment.glsl",
     "lessThanEqual(starts.yzw, uvec3(number))", "lessThan(starts.yzw, uvec3(number))", [KERNEL]),
    ("a sky's density without its choice", "shaders/path.glsl",
     "density = environment_probability() * environment_density(path.direction);",
     "density = environment_density(path.direction);", [CLOSED_FORMS, KERNEL]),
    ("texels that no number chooses", "src/sampling/cdf.rs",
     "            start += u32::from(*weight > 0.0);\n", "", [LIBRARY]),
    ("a sky whose mean is sampled, too", "src/scene/environment.rs",
     "(*weight - left_to_them * mean).max(0.0)", "*weight", [REFERENCE]),
    ("a sky that is sampled as for the integrator before", "src/gpu/scene.rs",
     "            if !same {", "            if !same && false {", [KERNEL]),
    ("biased directions", "shaders/warp.glsl",
     "return vec3(d, sqrt(max(0.0, 1.0 - dot(d, d))));", "return normalize(vec3(d, 1.0 - dot(d, d)));", [CLOSED_FORMS, KERNEL]),
    ("half vector not normalised", "shaders/bsdf.glsl",
     "vec3 h = normalize(wi + wo);", "vec3 h = 0.5 * (wi + wo);", [CLOSED_FORMS, KERNEL]),
    ("one over the distance", "shaders/luminaire.glsl",
     "incident /= distance2;", "incident /= sqrt(distance2);", [CLOSED_FORMS, KERNEL]),
    ("survivors not re-weighted", "shaders/path.glsl",
     "        reweighted = alive;\n        path.throughput /= alive;", "        reweighted = alive;", [CLOSED_FORMS, KERNEL]),
    ("radiance not over eta^2", "shaders/path.glsl",
     "path.throughput *= next.weight / next.eta2;", "path.throughput *= next.weight;", [CLOSED_FORMS, KERNEL]),
    ("blockers behind the lamp", "shaders/luminaire.glsl",
     "if (occluded(origin, direction, t_max, salt))", "if (occluded(origin, direction, INFINITY, salt))", [CLOSED_FORMS, KERNEL]),
    ("mirror as on the slide", "shaders/fresnel.glsl",
     "return 2.0 * dot(wo, n) * n - wo;", "return normalize(2.0 * n - wo);", [CLOSED_FORMS, KERNEL]),
    ("weights that do not add up", "shaders/luminaire.glsl",
     "return 1.0 / (1.0 + ratio * ratio);", "return 1.0 / (1.0 + ratio * ratio * ratio * ratio * 0.5);", [CLOSED_FORMS, KERNEL]),
    ("roulette in one of the two weights", "shaders/luminaire.glsl",
     "power_heuristic(density, path_pdf(f.w * rest, throughput * scattered, s, material));",
     "power_heuristic(density, f.w * rest);", [CLOSED_FORMS, KERNEL]),
    ("roulette at the first surface", "shaders/path.glsl",
     "path.scattered || path.bounce >= SURE_IMPULSES : path.bounce > 0u;", "true : true;", [KERNEL]),
    ("reference: roulette at the first surface", "src/reference/scatter.rs",
     "if scattered || bounce >= SURE_IMPULSES {", "if true {", [REFERENCE]),
    ("reference: roulette never begins", "src/reference/scatter.rs",
     "if scattered || bounce >= SURE_IMPULSES {", "if bounce == u32::MAX && scattered {", [REFERENCE]),
    ("reference: roulette begins behind a mirror", "src/reference/path.rs",
     "scattered_before |= scattered.pdf.is_some();", "scattered_before = true;", [REFERENCE]),
    ("density of a lamp without its cosine", "shaders/luminaire.glsl",
     "hit.t * hit.t * double_area / abs(dot(normal, wi));", "hit.t * hit.t;", [CLOSED_FORMS, KERNEL]),
    ("reference: missing 1/pi", "src/reference/bsdf.rs",
     "self.lambert / PI", "self.lambert", [CLOSED_FORMS, REFERENCE]),
    ("another order in the kernel", "shaders/rng.glsl",
     "seeds.zx ^ seeds.wy", "seeds.xz ^ seeds.yw", [kernel("sensor::numbers"), KERNEL]),
    ("groups that begin with the batch", "shaders/path_trace.comp",
     "uint start = (batch.first_sample / batch.group + id.z * GROUPS_IN_TURN) * batch.group;",
     "uint start = batch.first_sample + id.z * GROUPS_IN_TURN * batch.group;", [kernel("pictures::the_partition"), KERNEL]),
    ("samples of two groups in one", "shaders/path_trace.comp",
     "uint group_end = min(batch.group - (first - start), count);", "uint group_end = min(batch.group, count);", [kernel("pictures::the_partition"), KERNEL]),
    ("samples left out still count", "src/film/mod.rs",
     "taken - self.dropped.get(&(pixel, place)).unwrap_or(&0)", "taken", [["--lib", "film"]]),
    ("blocks that begin with the film", "src/film/blocks.rs",
     "((sample >> self.log) - (self.first >> self.log)) as usize", "((sample - self.first) >> self.log) as usize", [["--lib", "film"]]),
    ("blocks that are not merged", "src/film/mod.rs",
     "                    if before.length() < blocks.length() {", "                    if false {", [["--lib", "film"]]),
    ("merged blocks that keep what was left out apart", "src/film/mod.rs",
     "if let Some(count) = self.dropped.remove(&(pixel, place)) {",
     "if let Some(count) = self.dropped.remove(&(pixel, target)) {", [["--lib", "film"]]),
    ("blocks as if they were independent", "src/film/convergence.rs",
     "_ => Some([x, y]),", "_ => Some([alone(0), 0.0]),", [["--lib", "film"]]),
    ("halves that have nothing in common", "src/film/convergence.rs",
     "2.0 * self.of_run(log) - self.of_run(log - 1)", "0.0 * self.of_run(log)", [["--lib", "film"]]),
    ("an error of single samples", "src/film/convergence.rs",
     "*log > 1 && left.len()", "*log > 0 && left.len()", [["--lib", "film"]]),
    ("relMSE with a unit", "src/film/brightness.rs",
     "off * off / (radiance * radiance + (DARK * self.0).powi(2))", "off * off / (radiance * radiance + 0.01)", [LIBRARY]),
    ("fireflies beside a lamp are the lamp's", "src/film/pixel_error.rs",
     "(stands_out(*expected) || median(others().collect()).is_some_and(stands_out))", "stands_out(*expected)", [LIBRARY]),
    ("fireflies with a unit", "src/film/pixel_error.rs",
     "(usual + FIREFLY_FLOOR * half_power_mean)", "(usual + FIREFLY_FLOOR)", [LIBRARY]),
    ("a black picture without an error", "src/film/error.rs",
     "let total = (!brightness.is_black()).then(||", "let total = Some(()).map(|()|", [LIBRARY]),
    ("light through glass counts as found", "src/reference/lost_light.rs",
     "(&mut seen.impulses[at], surfaces > 0)", "(&mut seen.impulses[at], false)", [REFERENCE]),
    ("light by mirrors counts as found", "src/reference/lost_light.rs",
     "*(if surfaces == 0 { &mut sent.landed.found } else { &mut sent.landed.lost }) += landed;", "sent.landed.found += landed;", [REFERENCE]),
    ("lamps in one place count each", "src/scene/overlap/lamps.rs",
     "self.dropped[other] = true;\n        if back_to_back {", "if back_to_back {", [REFERENCE]),
    ("lamps in a ceiling stay there", "src/scene/overlap/lamps.rs",
     "self.lift[lamp] = self.lift[lamp].max(by);", "let _ = (lamp, by);", [REFERENCE]),
    ("vertex colours without the ambient albedo", "shaders/surfel.glsl",
     "if (SIMPLE) material.ambient *= s.colour;", "", [KERNEL]),
    ("vertex colours of the first corner", "src/reference/hit.rs",
     "    interpolate(weights, triangle.vertices.map(|v| mesh.colours[v as usize].as_dvec3()))",
     "    mesh.colours[triangle.vertices[0] as usize].as_dvec3()", [REFERENCE]),
    ("tiles that decide on their own samples", "src/render/shares.rs",
     "if other != tile {", "if other == tile {", [LIBRARY]),
    ("shares by the square of what they should be", "src/render/shares.rs",
     "(0.5 * error.log2() + scale)", "(error.log2() + scale)", [LIBRARY]),
    ("a checkpoint that forgets its shares", "src/part/file.rs",
     "    rendered.shares = shares;\n", "", [["--test", "adaptive"]]),
    ("a promise by the estimate as it is", "src/render/rendered.rs",
     "map_or(f64::INFINITY, |error| error.careful());", "map_or(f64::INFINITY, |error| error.relative());", [LIBRARY]),
    ("microfacets without the Jacobian of the half vector", "shaders/microfacet.glsl",
     "float d = normal_density(a, h) / (4.0 * wo.z);",
     "float d = normal_density(a, h) / wo.z;", [kernel("physical::"), KERNEL]),
    ("masking of one side only", "shaders/microfacet.glsl",
     "d / (wi.z * (1.0 + lambda + smith_lambda(a, wi)))",
     "d / (wi.z * (1.0 + lambda))", [kernel("physical::"), KERNEL]),
    ("refraction without the square of the index in its Jacobian", "shaders/microfacet.glsl",
     "float jacobian = -cos_i * eta * eta / length2;",
     "float jacobian = -cos_i / length2;", [kernel("physical::"), KERNEL]),
    ("roughness in place of its square", "shaders/physical.glsl",
     "float width = p.roughness * p.roughness;",
     "float width = p.roughness;", [kernel("physical::"), KERNEL]),
    ("a body's index inverted", "shaders/physical.glsl",
     "l.eta = l.inside ? 1.0 / index : index;",
     "l.eta = l.inside ? index : 1.0 / index;", [kernel("physical::"), KERNEL]),
    ("brushed across", "shaders/physical.glsl",
     "l.widths = vec2(w.x, max(w.y, LEAST_ALPHA));",
     "l.widths = vec2(max(w.y, LEAST_ALPHA), w.x);", [kernel("physical::"), KERNEL]),
    ("what brushed lobes miss alike all around", "shaders/physical.glsl",
     "flat_part > 0.0 ? p.y / flat_part : 0.0, tilt);", "0.0, tilt);", [kernel("physical::"), KERNEL]),
    ("brushed dielectrics seen along and across the same", "src/scene/brushed_table.rs",
     "let (x, y) = (along * w.x, across * w.y);", "let (x, y) = (across * w.x, along * w.y);", [REFERENCE]),
    ("a coat that takes nothing from what is below", "shaders/physical.glsl",
     "l.passed = 1.0 - coat;",
     "l.passed = 1.0;", [kernel("physical::"), KERNEL]),
    ("bodies that absorb outside", "shaders/surfel.glsl",
     "(dot(s.geometric_normal, direction) < 0.0) == s.front;",
     "(dot(s.geometric_normal, direction) < 0.0) != s.front;", [kernel("physical::"), KERNEL]),
    ("rough refraction that does not dilute", "shaders/scatter.glsl",
     "return Scattering(wi, weight, f.w, dilution(s, material, wi));",
     "return Scattering(wi, weight, f.w, 1.0);", [kernel("physical::"), KERNEL]),
    ("numbers of a map's red", "shaders/physical.glsl",
     "texture_at(map >> 2u, uv)[map & 3u]",
     "texture_at(map >> 2u, uv).x", [kernel("physical::"), KERNEL]),
    ("rough glass that sees no lamp behind it", "src/reference/surfel.rs",
     "if both { 2.0 * self.shading_normal } else { self.shading_normal }",
     "self.shading_normal", [REFERENCE]),
    ("tangents that point back", "shaders/normal_map.glsl",
     "t = beside(n, normalize(t / size));", "t = -beside(n, normalize(t / size));", [kernel("relief::"), KERNEL]),
    ("bitangents without their sign", "shaders/normal_map.glsl",
     "vec3 bitangent = tangent.w * cross(n, tangent.xyz);", "vec3 bitangent = cross(n, tangent.xyz);", [kernel("relief::"), KERNEL]),
    ("mirrored instances with the hand of their mesh", "shaders/normal_map.glsl",
     "< 0.0) handedness = -handedness;", "< 0.0) handedness = handedness;", [kernel("relief::"), KERNEL]),
    ("normals that a turned picture does not turn", "shaders/normal_map.glsl",
     "if (!MAP_TRANSFORMS) return v;", "if (true) return v;", [kernel("relief::"), KERNEL]),
    ("hills that are hollows", "src/reference/normal_map.rs",
     "bent = (bent - (gradient - bent", "bent = (bent + (gradient - bent", [kernel("relief::"), KERNEL]),
    ("bent normals without their guard", "src/reference/normal_map.rs",
     "if cosine > 0.0 && height >= least {", "if cosine > -2.0 {", [REFERENCE]),
    ("bent normals without their guard, in the kernel", "shaders/normal_map.glsl",
     "if (cosine > 0.0 && height >= least) return n;", "if (cosine > -2.0) return n;", [kernel("relief::"), KERNEL]),
    ("normals that are decoded as colours are", "src/scene/load/texture.rs",
     "image.stored(texel).map(|value| half(range(value)))", "image.linear(texel).map(|value| half(range(value)))", [["--test", "scene_loading"]]),
    ("heights that are decoded as colours are", "src/scene/load/texture.rs",
     "range(scalar_of(image.stored(texel), channel)))", "range(scalar_of(image.linear(texel), channel)))", [["--test", "scene_loading"]]),
    ("smoothed terminators without their lift", "shaders/surfel.glsl",
     "s.position += lift;", "s.position += 0.0 * lift;", [kernel("relief::"), KERNEL]),
    ("later reflections lost", "src/reference/physical.rs",
     "again: (1.0 - wide) * multiple / (1.0 - missing),",
     "again: DVec3::ZERO,", [REFERENCE]),
    ("a body that gets what its boundary reflects", "src/reference/physical.rs",
     "let entered = DVec3::ONE - reflects;",
     "let entered = DVec3::ONE;", [REFERENCE]),
    ("microfacets that let through what they reflect", "src/reference/physical.rs",
     "let passes = if p.body { 1.0 - fresnel(self.dielectric.eta, cosine.min(1.0)) } else { 1.0 };",
     "let passes = 1.0;", [REFERENCE]),
    ("coats that dim only what leaves", "shaders/physical.glsl",
     "if (!CLEARCOATS || l.clearcoat == 0.0) return 1.0;", "return 1.0;", [kernel("physical::"), KERNEL]),
    ("reference: coats that dim only what leaves", "src/reference/physical.rs",
     "1.0 - self.albedo(self.cosine(wi))", "1.0 - 0.0 * self.albedo(self.cosine(wi))", [REFERENCE]),
    ("coats that are bent with what is below", "shaders/impulse.glsl",
     "if (CLEARCOATS && NORMAL_MAPS && !clear && !is_smooth(l.p)) i.normal = s.unbent_normal;", "", [kernel("relief::"), KERNEL]),
    ("rough coats that are bent with what is below", "shaders/surfel.glsl",
     "NORMAL_MAPS ? s.unbent_normal : s.shading_normal", "s.shading_normal", [kernel("relief::"), KERNEL]),
    ("hardly bent glass whose parts go by different angles", "src/reference/physical.rs",
     "let of_dielectric = if self.flat { self.wo.z } else { cosine };", "let of_dielectric = cosine;", [REFERENCE]),
    ("less than nothing of great indices", "src/reference/physical.rs",
     "if edge < 0.0 {", "if edge < -9.0 {", [REFERENCE]),
]


def copy():
    """The tracked files as they are, without touching those that have not changed."""
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout.decode().split("\0")
    for name in filter(None, files):
        source, target = ROOT / name, COPY / name
        if not source.is_file():
            continue
        content = source.read_bytes()
        if name == "Cargo.toml":
            # In many pieces, most of which a bug leaves as they are.
            content = content.replace(b"luminaire = { codegen-units = 1 }", b"luminaire = { codegen-units = 64 }")
        if target.is_file() and target.read_bytes() == content:
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
        target.chmod(source.stat().st_mode)


def run(arguments):
    """Whether the tests pass, and the first that does not."""
    environment = {
        **os.environ,
        "CARGO_TARGET_DIR": str(COPY.parent / "target"),
        # A bug changes little: what it leaves alone is not compiled again.
        "CARGO_INCREMENTAL": "1",
        "LUMINAIRE_REQUIRE_GPU": "1",
        "RUST_BACKTRACE": "0",
    }
    cargo = subprocess.Popen(
        ["cargo", "test", "--release", *arguments], cwd=COPY, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, start_new_session=True)
    # What cargo says is kept beside, lest a full pipe holds it up.
    said = []
    reader = threading.Thread(target=lambda: said.extend(cargo.stderr), daemon=True)
    reader.start()
    for line in cargo.stdout:
        if line.startswith("test ") and line.rstrip().endswith("FAILED"):
            # One is enough.
            os.killpg(cargo.pid, signal.SIGKILL)
            cargo.wait()
            return f"{arguments[1] if len(arguments) > 1 else arguments[0]}: {line.split()[1]}"
    if cargo.wait() == 0:
        return None
    reader.join()
    print(f"the copy does not build, or the tests do not run:\n{''.join(said)[-3000:]}", file=sys.stderr)
    sys.exit(2)


def misfits():
    """The bugs whose place is not in the source exactly once."""
    for name, file, old, new, _ in MUTATIONS:
        path = ROOT / file
        found = path.read_text().count(old) if path.is_file() else 0
        if found != 1 or old == new:
            yield f"{name}: `{old}` stands {found} times in {file}, not once"


def mutate(name, file, old, new, tests):
    """The test that notices the bug; none if none does."""
    path = COPY / file
    text = path.read_text()
    if text.count(old) != 1:
        print(f"{name}: `{old}` stands {text.count(old)} times in {file}, not once", file=sys.stderr)
        sys.exit(2)
    path.write_text(text.replace(old, new))
    try:
        if file.startswith("shaders/"):
            subprocess.run(["scripts/build-shaders.sh"], cwd=COPY, check=True, capture_output=True)
        return next(filter(None, map(run, tests)), None)
    finally:
        path.write_text(text)
        if file.startswith("shaders/"):
            subprocess.run(["scripts/build-shaders.sh"], cwd=COPY, check=True, capture_output=True)


def main():
    words = sys.argv[1:]
    if words == ["--list"]:
        print("\n".join(f"{name}: {file}" for name, file, *_ in MUTATIONS))
        return
    if words == ["--fit"]:
        found = list(misfits())
        print("\n".join(found) or f"all {len(MUTATIONS)} fit", file=sys.stderr if found else sys.stdout)
        sys.exit(2 if found else 0)
    if any(word.startswith("-") for word in words):
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    chosen = [m for m in MUTATIONS if not words or any(word in m[0] for word in words)]
    copy()
    kinds = [list(test) for test in {tuple(tests[0]) for *_, tests in chosen}]
    for kind in kinds:
        failed = run(kind)
        if failed:
            print(f"without any bug {failed} fails already", file=sys.stderr)
            sys.exit(2)
    missed = 0
    for mutation in chosen:
        start = time.monotonic()
        caught = mutate(*mutation)
        missed += caught is None
        print(f"{'caught' if caught else 'MISSED'}  {mutation[0]}  ({caught or 'no test failed'}; {time.monotonic() - start:.0f} s)", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} caught")
    sys.exit(1 if missed else 0)


main()
