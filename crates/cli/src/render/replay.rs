//! `luminaire render --pixel X,Y --sample N`: one sample again, ray by ray.

use crate::shared::printing::print;
use crate::shared::table::table;
use crate::shared::values::Pixel;
use luminaire::Result;
use luminaire::backend::{Backend, Renderer};
use luminaire::film::{Batch, Tile};
use luminaire::glam::DVec3;
use luminaire::reference::Reference;
use luminaire::reference::path::Vertex;
use luminaire::scene::Scene;
use std::process::ExitCode;

/// Prints the path of a sample in the reference, and its radiance there and on the backend.
pub fn run(scene: &Scene, renderer: &mut Renderer, Pixel { x, y }: Pixel, sample: u32) -> Result<ExitCode> {
    let (radiance, vertices) = Reference::new(scene).vertices(y * scene.film.width + x, sample);
    let mut text =
        format!("pixel {x},{y}, sample {sample}, seed {}; the path in the reference\n\n", scene.settings.seed);
    if scene.origin != DVec3::ZERO {
        let DVec3 { x, y, z } = scene.origin;
        text += &format!("  points are given from ({x} {y} {z}) of the files' coordinates\n\n");
    }
    let head = ["ray", "from", "towards", "meets", "at t", "throughput", "radiance so far"].map(String::from);
    let rows = vertices.iter().enumerate().map(|(ray, vertex)| row(scene, ray, vertex));
    text += &table(2, &std::iter::once(head.into()).chain(rows).collect::<Vec<_>>());
    let mut ends = vec![vec!["reference".into(), triple(radiance)]];
    if renderer.backend != Backend::Cpu {
        let tile = Tile { x, y, width: 1, height: 1 };
        let traced = renderer.tracer.trace(&Batch { tile, samples: sample..sample + 1, group: 1 })?;
        let found = match traced.dropped.is_empty() {
            true => triple(traced.sums[0].radiance.into()),
            false => "not finite, or lost".into(),
        };
        ends.push(vec![renderer.backend.to_string(), found]);
    }
    text += &format!("\nradiance of the sample\n{}", table(2, &ends));
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}

fn row(scene: &Scene, ray: usize, vertex: &Vertex) -> Vec<String> {
    let (meets, t) = match vertex.hit {
        None => ("nothing".into(), String::new()),
        Some(hit) => {
            let object = &scene.objects[hit.object as usize];
            let triangle = &scene.meshes[object.mesh as usize].triangles[hit.triangle as usize];
            let material = &scene.material_of(object, triangle).name;
            (format!("{} ({material}), triangle {}", object.name, hit.triangle), format!("{:.6}", hit.t))
        }
    };
    let [from, towards, throughput, radiance] =
        [vertex.origin, vertex.direction, vertex.throughput, vertex.radiance].map(triple);
    vec![ray.to_string(), from, towards, meets, t, throughput, radiance]
}

fn triple(v: DVec3) -> String {
    let number =
        |v: f64| if v == 0.0 || (1e-3..1e4).contains(&v.abs()) { format!("{v:.4}") } else { format!("{v:.3e}") };
    v.to_array().map(number).join(" ")
}
