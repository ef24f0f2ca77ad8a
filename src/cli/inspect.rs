//! `luminaire inspect`.

use super::{print, table};
use glam::Vec3;
use luminaire::Result;
use luminaire::gpu::model::KernelModel;
use luminaire::scene::{self, Integrator, Luminaire, LuminaireTable, Mesh, SampledLuminaire, Scene};
use std::path::Path;
use std::process::ExitCode;

/// Loads a scene and prints what is in it.
pub fn run(path: &Path) -> Result<ExitCode> {
    print(&describe(&scene::load(path)?))?;
    Ok(ExitCode::SUCCESS)
}

/// Everything that was loaded.
fn describe(scene: &Scene) -> String {
    let (low, high) = scene.world_bounds();
    let stored: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let mut text = format!("{}\n\n", scene.path.display());
    text += &table(
        0,
        &[
            row(
                "triangles",
                format!(
                    "{} in {} {}; {stored} stored in {} {}",
                    scene.triangle_count(),
                    scene.objects.len(),
                    if scene.objects.len() == 1 { "object" } else { "objects" },
                    scene.meshes.len(),
                    if scene.meshes.len() == 1 { "mesh" } else { "meshes" }
                ),
            ),
            row("bounds", format!("{low:.4} to {high:.4}")),
            row("sensor", sensor(scene)),
            row(
                "film",
                format!("{} x {} pixels, {:?} filter", scene.film.width, scene.film.height, scene.film.filter)
                    .to_lowercase(),
            ),
            row("integrator", integrator(&scene.integrator)),
            row(
                "render",
                format!(
                    "{} samples a pixel, seed {}, exposure {}",
                    scene.settings.spp, scene.settings.seed, scene.settings.exposure
                ),
            ),
            row("kernel", KernelModel::of(scene).to_string()),
            row("memory", memory(scene)),
        ],
    );
    text += &format!("\nmeshes\n{}", table(2, &meshes(scene)));
    text += &format!("\nobjects\n{}", table(2, &objects(scene)));
    text += &format!("\nmaterials\n{}", table(2, &materials(scene)));
    text += &format!("\nluminaires\n{}", table(2, &luminaires(scene)));
    text += "\nwarnings\n";
    if scene.warnings.is_empty() {
        text += "  none\n";
    }
    for warning in &scene.warnings {
        text += &format!("  {warning}\n");
    }
    text
}

fn row(name: &str, value: String) -> Vec<String> {
    vec![name.into(), value]
}

fn sensor(scene: &Scene) -> String {
    let s = &scene.sensor;
    format!(
        "at {}, looking at {}, up {}, {} degrees high",
        rgb(s.position),
        rgb(s.target),
        rgb(s.up),
        match s.projection {
            luminaire::scene::Projection::Perspective { fov } => fov,
            luminaire::scene::Projection::Orthographic { height } => height,
        }
    )
}

fn integrator(integrator: &Integrator) -> String {
    match integrator {
        Integrator::Path(estimator) => format!("path: {estimator:?}"),
        Integrator::Simple { ambient } => format!("simple: direct light and ambient radiance {}", rgb(*ambient)),
    }
}

/// Bytes of the data itself; the acceleration structures depend on the backend.
fn memory(scene: &Scene) -> String {
    let mesh = |m: &Mesh| size_of_val(&m.positions[..]) + size_of_val(&m.normals[..]) + size_of_val(&m.triangles[..]);
    let geometry: usize = scene.meshes.iter().map(mesh).sum();
    let film = u64::from(scene.film.width) * u64::from(scene.film.height) * 28;
    let size = |bytes: f64| match bytes {
        b if b < f64::from(1 << 20) => format!("{:.1} KiB", b / f64::from(1 << 10)),
        b => format!("{:.1} MiB", b / f64::from(1 << 20)),
    };
    format!(
        "{} of geometry and {} of film, besides about 100 bytes a stored triangle for the BVH",
        size(geometry as f64),
        size(film as f64)
    )
}

fn meshes(scene: &Scene) -> Vec<Vec<String>> {
    let head = ["name", "triangles", "vertices", "normals"].map(String::from).to_vec();
    let mesh = |m: &Mesh| {
        let normals = if m.normals.is_empty() { "no" } else { "yes" };
        vec![m.name.clone(), m.triangles.len().to_string(), m.positions.len().to_string(), normals.into()]
    };
    std::iter::once(head).chain(scene.meshes.iter().map(mesh)).collect()
}

/// More rows than anyone reads are left out.
const MOST_OBJECTS: usize = 20;

fn objects(scene: &Scene) -> Vec<Vec<String>> {
    let mut rows = vec![["name", "mesh", "material", "transform"].map(String::from).to_vec()];
    for object in scene.objects.iter().take(MOST_OBJECTS) {
        let determinant = object.object_to_world.matrix3.determinant();
        let kind = match determinant {
            _ if object.object_to_world == glam::Affine3A::IDENTITY => "none".into(),
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

fn materials(scene: &Scene) -> Vec<Vec<String>> {
    let mut used = vec![0u64; scene.materials.len()];
    for object in &scene.objects {
        for triangle in &scene.meshes[object.mesh as usize].triangles {
            used[object.material.unwrap_or(triangle.material) as usize] += 1;
        }
    }
    let head = ["name", "lambert", "glossy", "exponent", "emission", "triangles"].map(String::from).to_vec();
    let rows = scene.materials.iter().zip(used).map(|(m, used)| {
        let exponent = if m.glossy == Vec3::ZERO { "-".into() } else { m.exponent.to_string() };
        vec![m.name.clone(), rgb(m.lambert), rgb(m.glossy), exponent, rgb(m.emission), used.to_string()]
    });
    std::iter::once(head).chain(rows).collect()
}

fn luminaires(scene: &Scene) -> Vec<Vec<String>> {
    let table = LuminaireTable::new(scene);
    let mut rows = Vec::new();
    let (mut triangles, mut area, mut chance) = (0u64, 0.0, 0.0);
    let percent = |p: f64| format!("chosen {:.1} %", p * 100.0);
    for (entry, pdf) in table.entries.iter().zip(&table.choice.pdf) {
        match entry {
            SampledLuminaire::Impulse(Luminaire::Point { position, intensity }) => rows.push(vec![
                "point".into(),
                format!("at {}", rgb(*position)),
                format!("intensity {}", rgb(*intensity)),
                percent(*pdf),
            ]),
            SampledLuminaire::Impulse(Luminaire::Infinite { direction, irradiance }) => rows.push(vec![
                "infinite".into(),
                format!("towards {}", rgb(*direction)),
                format!("irradiance {}", rgb(*irradiance)),
                percent(*pdf),
            ]),
            SampledLuminaire::Environment => {
                rows.push(vec!["environment".into(), String::new(), String::new(), percent(*pdf)]);
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
        rows.push(vec!["area".into(), what, format!("total area {area:.4}"), percent(chance)]);
    }
    if rows.is_empty() {
        rows.push(vec!["none: nothing in this scene emits".into()]);
    }
    rows
}

/// Three numbers.
fn rgb(v: Vec3) -> String {
    format!("({} {} {})", v.x, v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::scene::{FilmSettings, Filter, Material, Object, RenderSettings, Sensor, Triangle};

    #[test]
    fn everything_is_named() {
        let emission = Vec3::new(1.0, 2.0, 3.0);
        let material = Material {
            name: "lamp".into(),
            ambient: Vec3::ZERO,
            lambert: Vec3::splat(0.5),
            glossy: Vec3::ZERO,
            exponent: 1.0,
            emission,
        };
        let scene = Scene {
            path: "test.obj".into(),
            meshes: vec![Mesh {
                name: "one.obj".into(),
                positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
                normals: Vec::new(),
                triangles: vec![Triangle { vertices: [0, 1, 2], material: 0 }],
            }],
            objects: vec![
                Object {
                    name: "thing".into(),
                    mesh: 0,
                    object_to_world: glam::Affine3A::from_scale(Vec3::new(-2.0, 1.0, 1.0)),
                    material: None,
                };
                22
            ],
            materials: vec![material],
            luminaires: vec![Luminaire::Point { position: Vec3::Z, intensity: Vec3::ONE }],
            sensor: Sensor { position: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov: 40.0 },
            film: FilmSettings { width: 64, height: 48, filter: Filter::Box },
            integrator: Integrator::Path { max_bounces: Some(4) },
            settings: RenderSettings::default(),
            warnings: vec!["one.obj:3: something odd".into()],
        };
        let text = describe(&scene);
        for part in [
            "22 in 22 objects; 1 stored in 1 mesh",
            "64 x 48 pixels, box filter",
            "at most 4 indirect bounces",
            "path tracer, Lambert, instances, point luminaires, area luminaires",
            "mirrored, volume times 2.0000",
            "... and 2 more",
            "(1 2 3)",
            "point",
            "22 emissive triangles  total area 22.0000",
            "  one.obj:3: something odd",
        ] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
    }
}
