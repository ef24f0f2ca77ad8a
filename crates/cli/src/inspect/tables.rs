//! The tables of `luminaire inspect`.

use super::physical;
use luminaire::glam::{Affine2, DVec3, Vec2, Vec3};
use luminaire::scene::{Environment, LightTree, Luminaire, LuminaireTable, Material, Mesh, SampledLuminaire, Scene};

/// Meshes and what they have.
pub(super) fn meshes(scene: &Scene) -> Vec<Vec<String>> {
    let head = ["name", "triangles", "vertices", "normals", "texture coordinates", "vertex colours", "tangents"]
        .map(String::from)
        .to_vec();
    let mesh = |m: &Mesh| {
        let yes = |empty: bool| if empty { "no" } else { "yes" }.to_owned();
        vec![
            m.name.clone(),
            m.triangles.len().to_string(),
            m.positions.len().to_string(),
            yes(m.normals.is_empty()),
            yes(m.uvs.is_empty()),
            yes(m.colours.is_empty()),
            yes(m.tangents.is_empty()),
        ]
    };
    std::iter::once(head).chain(scene.meshes.iter().map(|m| mesh(m))).collect()
}

/// Objects after so many are only counted.
const MOST_OBJECTS: usize = 20;

/// Objects and how they are placed.
pub(super) fn objects(scene: &Scene) -> Vec<Vec<String>> {
    let mut rows = vec![["name", "mesh", "material", "transform"].map(String::from).to_vec()];
    for object in scene.objects.iter().take(MOST_OBJECTS) {
        let determinant = object.object_to_world.matrix3.determinant();
        let kind = match determinant {
            _ if object.object_to_world == luminaire::glam::Affine3A::IDENTITY => "none".into(),
            d if d < 0.0 => format!("mirrored, volume times {:.4}", -d),
            d => format!("volume times {d:.4}"),
        };
        rows.push(vec![
            object.name.clone(),
            scene.meshes[object.mesh as usize].name.clone(),
            object.material.map_or("of the mesh".into(), |m| scene.materials[m as usize].name.clone()),
            kind,
        ]);
    }
    if let Some(more) = scene.objects.len().checked_sub(MOST_OBJECTS + 1) {
        rows.push(vec![format!("... and {} more", more + 1)]);
    }
    rows
}

/// Materials and how many triangles show them. The first one of a loaded scene is the built-in `default`, which nobody asked for:
/// it is left out where nothing shows it, and marked as built in where a file has one of that name, too.
pub(super) fn materials(scene: &Scene) -> Vec<Vec<String>> {
    let mut used = vec![0u64; scene.materials.len()];
    for object in &scene.objects {
        for triangle in &scene.meshes[object.mesh as usize].triangles {
            used[object.material.unwrap_or(triangle.material) as usize] += 1;
        }
    }
    let head = ["name", "triangles", "lambert", "glossy", "exponent", "emission", "besides"].map(String::from).to_vec();
    let built_in = scene.materials.first().filter(|first| first.name == "default");
    let hidden = usize::from(built_in.is_some() && used[0] == 0);
    let twice = scene.materials.iter().filter(|m| m.name == "default").count() > 1;
    let rows = scene.materials.iter().zip(used).enumerate().skip(hidden).map(|(index, (m, used))| {
        let name = if index == 0 && built_in.is_some() && twice { "default (built in)".into() } else { m.name.clone() };
        let exponent = if m.glossy == Vec3::ZERO { "-".into() } else { m.exponent.to_string() };
        // A dash where it has no such albedo at all.
        let albedo = |albedo: Vec3| if m.physical.is_some() { "-".into() } else { rgb(albedo) };
        let (lambert, glossy, emission) = (albedo(m.lambert), albedo(m.glossy), rgb(m.emission));
        vec![name, used.to_string(), lambert, glossy, exponent, emission, besides(scene, m)]
    });
    std::iter::once(head).chain(rows).collect()
}

/// Impulses, opacity and maps; a dash where there are none.
fn besides(scene: &Scene, m: &Material) -> String {
    let mut parts: Vec<String> =
        m.physical.iter().flat_map(|surface| physical::words(scene, surface, m.thin)).collect();
    match m.eta {
        Some(eta) if m.transmission != Vec3::ZERO => parts.push(format!(
            "{}glass of index {eta}, reflection {}, transmission {}",
            if m.thin { "a thin sheet of " } else { "" },
            rgb(m.reflection),
            rgb(m.transmission)
        )),
        Some(eta) if m.reflection != Vec3::ZERO => {
            let place = if m.is_coated() { " over the rest" } else { "" };
            let reflection = rgb(m.reflection);
            parts.push(format!("mirror{place} with Fresnel's reflectance for index {eta}, reflection {reflection}"));
        }
        _ if m.reflection != Vec3::ZERO => parts.push(format!("mirror, reflection {}", rgb(m.reflection))),
        _ => {}
    }
    if let Some(probability) = m.impulse_probability {
        parts.push(format!("impulses taken with probability {probability}"));
    }
    if m.opacity < 1.0 {
        parts.push(format!("opacity {}", m.opacity));
    }
    // What nobody said otherwise is the colour with its map.
    let own = m.physical.as_ref().map_or((m.lambert, m.maps.lambert), |p| (p.base_color, p.maps.base_color));
    let ambient = m.maps.ambient.filter(|_| (m.ambient, m.maps.ambient) != own);
    for (map, name) in [
        (m.maps.lambert, "diffuse"),
        (m.maps.glossy, "glossy"),
        (m.maps.emission, "emission"),
        (ambient, "ambient"),
        (m.maps.opacity, "opacity"),
    ] {
        if let Some(map) = map {
            parts.push(format!("{name} map {}", scene.textures[map as usize].name));
        }
    }
    let scaled = |scale: f32| if scale == 1.0 { String::new() } else { format!(" times {scale}") };
    if let Some(map) = m.normal_map {
        parts.push(format!("normal map {}{}", scene.textures[map.texture as usize].name, scaled(map.scale)));
    }
    if let Some(map) = m.bump_map {
        parts.push(format!("bump map {}{}", scene.textures[map.texture as usize].name, scaled(map.scale)));
    }
    if parts.is_empty() { "-".into() } else { parts.join("; ") }
}

/// Textures.
pub(super) fn textures(scene: &Scene) -> Vec<Vec<String>> {
    let mut rows = vec![["name", "texels", "outside", "alpha"].map(String::from).to_vec()];
    for texture in &scene.textures {
        let alpha = match texture.alpha_range() {
            (1.0, _) => "opaque".into(),
            (least, most) => format!("{least} to {most}"),
        };
        let outside = if texture.clamp { "clamped" } else { "repeated" };
        let Affine2 { matrix2, translation } = texture.transform;
        let placed = if texture.transform == Affine2::IDENTITY {
            String::new()
        } else {
            format!(", scaled by {}, moved by {translation}", Vec2::new(matrix2.x_axis.x, matrix2.y_axis.y))
        };
        rows.push(vec![
            texture.name.clone(),
            format!("{} x {}", texture.width, texture.height),
            format!("{outside}{placed}"),
            alpha,
        ]);
    }
    rows
}

/// Luminaires and how often each is chosen.
pub(super) fn luminaires(scene: &Scene) -> Vec<Vec<String>> {
    let table = LuminaireTable::new(scene);
    let mut rows = Vec::new();
    let (mut triangles, mut area, mut chance) = (0u64, 0.0, 0.0);
    let percent = |p: f64| format!("chosen {:.1} %", p * 100.0);
    let by_tree = |entry| table.tree.as_ref().map(|tree| outer_probability(tree, entry));
    for (index, (entry, pdf)) in (0..).zip(table.entries.iter().zip(&table.choice.pdf)) {
        // By place: nothing that holds for the scene.
        let chosen = match by_tree(index) {
            None => percent(*pdf),
            Some(None) => "chosen by place".into(),
            Some(Some(pdf)) => percent(pdf),
        };
        match entry {
            SampledLuminaire::Impulse(Luminaire::Point { position, intensity }) => rows.push(vec![
                "point".into(),
                format!("at {}", point(scene, *position)),
                format!("intensity {}", rgb(*intensity)),
                chosen,
            ]),
            SampledLuminaire::Impulse(Luminaire::Spot { position, direction, intensity, inner, outer }) => {
                rows.push(vec![
                    "spot".into(),
                    format!("at {} towards {}, {inner} to {outer} degrees", point(scene, *position), rgb(*direction)),
                    format!("intensity {}", rgb(*intensity)),
                    chosen,
                ]);
            }
            SampledLuminaire::Impulse(Luminaire::Photometric { position, direction, intensity, profile, .. }) => {
                let (flux, most) = (profile.flux(), profile.largest());
                rows.push(vec![
                    "photometric".into(),
                    format!("at {} towards {}", point(scene, *position), rgb(*direction)),
                    format!("{} times {}: {flux:.0} lm, at most {most:.0} cd", rgb(*intensity), profile.name),
                    chosen,
                ]);
            }
            SampledLuminaire::Sun(sun) => rows.push(vec![
                "sun disc".into(),
                format!("towards {}, {:.4} degrees", rgb(-sun.towards), sun.angle()),
                format!("irradiance {}", rgb(sun.irradiance().as_vec3())),
                chosen,
            ]),
            SampledLuminaire::Impulse(
                Luminaire::Infinite { direction, irradiance } | Luminaire::Sun { direction, irradiance, .. },
            ) => rows.push(vec![
                "infinite".into(),
                format!("towards {}", rgb(*direction)),
                format!("irradiance {}", rgb(*irradiance)),
                chosen,
            ]),
            SampledLuminaire::Environment => {
                rows.push(vec!["environment".into(), String::new(), String::new(), chosen]);
            }
            SampledLuminaire::Area(triangle) => {
                triangles += 1;
                area += triangle.area();
                chance += pdf;
            }
        }
    }
    if triangles > 0 {
        let what = format!("{triangles} emissive triangles");
        rows.push(vec![
            "area".into(),
            what,
            format!("total area {area:.4}"),
            if table.tree.is_some() { "chosen by place".into() } else { percent(chance) },
        ]);
    }
    if let Some(tree) = &table.tree {
        let size = format!("{} in {}", counted(tree.nodes.len(), "node"), counted(tree.levels as usize, "level"));
        rows.push(vec![
            "light tree".into(),
            size,
            format!("{:.1} KiB", tree.bytes() as f64 / 1024.0),
            percent(tree.probability),
        ]);
    }
    if table.environment.is_none() && scene.environment.as_ref().is_some_and(Environment::emits) {
        let why = "even: not chosen, paths that escape find it".into();
        rows.push(vec!["environment".into(), String::new(), String::new(), why]);
    }
    if rows.is_empty() {
        rows.push(vec!["none: nothing in this scene emits".into()]);
    }
    rows
}

/// How often what stands beside a light tree is chosen; none: it is in the tree.
fn outer_probability(tree: &LightTree, entry: u32) -> Option<f64> {
    let outer = tree.outer.iter().position(|outer| *outer == Some(entry))?;
    Some(tree.outer_choice.pdf[outer])
}

/// A number of things.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A point of the scene in the coordinates of its files.
pub(super) fn point(scene: &Scene, p: Vec3) -> String {
    if scene.origin == DVec3::ZERO {
        return rgb(p);
    }
    let DVec3 { x, y, z } = p.as_dvec3() + scene.origin;
    format!("({x:.6} {y:.6} {z:.6})")
}

/// Three numbers.
pub(super) fn rgb(v: Vec3) -> String {
    format!("({} {} {})", v.x, v.y, v.z)
}
