//! Surfaces with a map of normals, seen at ever smaller angles: whether light is lost that the bent normal would send into the surface.

use crate::Workbench;
use crate::chart::{Axis, Point, Series};
use crate::stability::judge::{everywhere, light};
use crate::stability::light::{Spot, Tally, chart, looking_from, noise_axis, off, series, within, without_roulette};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Verdict, Worse, stretch};
use glam::{Affine3A, DVec3, Vec2, Vec3};
use half::f16;
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::reference::normal_map::guarded_normal;
use luminaire::scene::build::{add, matte, quad};
use luminaire::scene::{Environment, LightSampling, Material, NormalMap, Physical, Scene, Texture};

/// The sweep over the angle.
pub const DEFINITION: Definition = Definition {
    name: "grazing",
    family: Family::Light,
    title: "a plate with a map of normals, seen at 45 degrees to 1e-4 degrees above it, under an even sky",
    run,
};

/// By how much the map bends the normal, in degrees, and which way, seen from the camera.
const BENT: f64 = 30.0;
const WAYS: [(&str, f64); 3] = [("towards the camera", 0.0), ("across", 90.0), ("away", 180.0)];
/// How light is found.
const METHODS: [(&str, LightSampling); 2] =
    [("both (MIS)", LightSampling::Mis), ("BSDF sampling", LightSampling::None)];

fn run(bench: &Workbench) -> Result<Sweep> {
    let decades = [45.0, 10.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4];
    let more = decades.iter().skip(1).flat_map(|x| [3.0 * x, *x]);
    let angles: Vec<f64> = if bench.long { decades[..1].iter().copied().chain(more).collect() } else { decades.into() };
    sweep(bench, &angles, if bench.long { 1 << 17 } else { 1 << 14 })
}

/// A plate with such a map, seen so many degrees above it, and the normal that the map says.
fn plate(degrees: f64, way: f64, material: Material) -> (Scene, DVec3) {
    let (height, along) = degrees.to_radians().sin_cos();
    let mut scene = looking_from(Vec3::new(along as f32, height as f32, 0.0));
    let mut mesh = quad(Vec3::new(-2.0, 0.0, -2.0), Vec3::Z * 4.0, Vec3::X * 4.0);
    mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(p.x, -p.z)).collect();
    let ((sin, cos), (aside, ahead)) = (BENT.to_radians().sin_cos(), way.to_radians().sin_cos());
    let texel = [sin * ahead, sin * aside, cos].map(|x| f16::from_f64(0.5 + 0.5 * x));
    let [x, y, z] = texel.map(|x| 2.0 * x.to_f64() - 1.0);
    let texels = vec![[texel[0], texel[1], texel[2], f16::ONE]].into();
    scene.textures.push(Texture { name: "bent".into(), width: 1, height: 1, texels, ..Texture::default() }.into());
    let material = Material { normal_map: Some(NormalMap { texture: 0, scale: 1.0 }), ..material };
    add(&mut scene, mesh, material, Affine3A::IDENTITY);
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    (scene, DVec3::new(x, z, -y).normalize())
}

/// Runs the sweep over some angles, in degrees, with so many samples of a point.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, angles: &[f64], samples: u32) -> Result<Sweep> {
    let mut tally = Tally::default();
    let backends = bench.backends();
    let mirror = || Material { reflection: Vec3::ONE, ..matte(Vec3::ZERO) };
    let metal = || {
        let surface = Physical { metallic: 1.0, roughness: 0.3, ..Physical::default() };
        Material { physical: Some(surface), ..Material::default() }
    };
    let named = |method: &str| {
        let each = |way: &str| backends.iter().map(move |b| format!("{way}, {b}")).collect::<Vec<_>>();
        series(WAYS.iter().flat_map(|(way, _)| each(way)).map(|name| format!("{method}, {name}")))
    };
    let mut shares = METHODS.map(|(method, _)| named(method));
    let mut noise = METHODS.map(|(method, _)| series([method]));
    let mut mirrored = named("mirror");
    let mut metals = series(WAYS.map(|(way, _)| format!("metal, {way}")));
    let mut diffuse = series(WAYS.map(|(way, _)| format!("diffuse, {way}")));
    for &degrees in angles {
        let mut spot = |scene: &Scene, backend: Backend, sampling: LightSampling| -> Result<Spot> {
            let spot = Spot::new(bench, backend, scene, without_roulette(sampling, 0), samples)?;
            tally.add(&spot);
            Ok(spot)
        };
        let mut worst = [0.0f64; METHODS.len()];
        for (index, (_, way)) in WAYS.into_iter().enumerate() {
            let (scene, n) = plate(degrees, way, matte(Vec3::ONE));
            let wo = scene.sensor.position.as_dvec3().normalize();
            // What the cosine lobe has above the surface.
            let truth = 0.5 * (1.0 + guarded_normal(DVec3::Y, wo, n).y);
            for (number, &backend) in backends.iter().enumerate() {
                let place = index * backends.len() + number;
                for (method, (_, sampling)) in METHODS.into_iter().enumerate() {
                    let seen = spot(&scene, backend, sampling)?;
                    shares[method][place].points.push(seen.share(degrees, truth));
                    worst[method] = worst[method].max(seen.noise(degrees, truth).y);
                    if method == 0 && number == 0 {
                        diffuse[index].points.push(seen.share(degrees, 1.0));
                    }
                }
                let seen = spot(&plate(degrees, way, mirror()).0, backend, LightSampling::None)?;
                mirrored[place].points.push(seen.share(degrees, 1.0));
            }
            let seen = spot(&plate(degrees, way, metal()).0, Backend::Cpu, LightSampling::Mis)?;
            metals[index].points.push(seen.share(degrees, 1.0));
        }
        for (noise, worst) in noise.iter_mut().zip(worst) {
            noise[0].points.push(Point { x: degrees, y: worst, error: None });
        }
    }
    let verdicts: Vec<Verdict> = (0..METHODS.len())
        .map(|method| {
            let found: Vec<&Series> = shares[method].iter().chain(&mirrored).collect();
            light(METHODS[method].0, &[&noise[method][0]], &found, Worse::Downwards)
        })
        .collect();
    let range = stretch(angles.iter().copied(), Worse::Downwards, "degrees above the surface");
    let summary = everywhere(&verdicts, METHODS[0].0, "Bent normals are safe at every angle of view.");
    let all: Vec<&Series> = shares.iter().flatten().chain(&mirrored).collect();
    let findings = findings(&all, [&metals, &diffuse], &tally);
    const ANGLE: &str = "degrees above the surface";
    let charts = vec![
        chart(
            "energy",
            "Light of a diffuse plate with bent normals, and of a mirror, over the truth",
            ANGLE,
            Axis::linear("share found of the energy"),
            [shares.concat(), mirrored].concat(),
        ),
        chart(
            "albedo",
            "What a white plate with bent normals sends back of an even sky",
            ANGLE,
            Axis::linear("radiance"),
            [metals, diffuse].concat(),
        ),
        chart("noise", "Noise of the diffuse plate, the worst way", ANGLE, noise_axis(), noise.concat()),
    ];
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

fn findings(all: &[&Series], [metals, diffuse]: [&[Series]; 2], tally: &Tally) -> Findings {
    let farthest = all.iter().map(|series| off(series, 0.0..=f64::INFINITY)).fold(0.0, f64::max);
    let least = |all: &[Series]| all.iter().flat_map(|s| &s.points).map(|p| p.y).fold(f64::INFINITY, f64::min);
    let most = |all: &[Series]| all.iter().flat_map(|s| &s.points).map(|p| p.y).fold(0.0, f64::max);
    Findings {
        starts: format!("With normals that are bent by {BENT} degrees towards the camera, across and away:"),
        how: "A bent normal may face away from the camera, and the direction in which it mirrors may lie in the surface: without care such places are black, the more \
              of them the flatter one looks, and the edges of what is round have black fringes."
            .into(),
        mends: format!(
            "Where the mirror direction would lie less than half a degree above the surface, the normal is turned until it does not, by no more than that: a mirror \
             shows the sky everywhere, and the light of mirror and diffuse plate, held against the truth, is {}. What a lobe about the bent normal has \
             below the surface is lost, since nothing comes from there: a white metal of roughness 0.3 sends back {:.2} to {:.2} of an even sky, a white diffuse \
             plate {:.2} to {:.2} (right is (1 + cos) / 2 of the normal's angle). {}",
            within(farthest),
            least(metals),
            most(metals),
            least(diffuse),
            most(diffuse),
            tally.sentence(),
        ),
        sees: "Surfaces that are a little darker where a map bends their normals far, and nowhere black.".into(),
    }
}
