//! Scenes in which glass touches other surfaces exactly, or by a gap.

use glam::{Affine3A, Vec3};
use luminaire::scene::build::{add, add_instance, cube, empty, icosphere, lamp, matte, mesh, pinhole, quad};
use luminaire::scene::{Environment, LightSampling, Material, Mesh, Scene, Triangle};
use std::f32::consts::TAU;

/// Clear glass or water.
pub fn clear(eta: f32) -> Material {
    Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(eta), ..matte(Vec3::ZERO) }
}

/// The cube from -1 to 1 in steps of `1 / n`, flat squares.
fn fine_cube(n: i32) -> Mesh {
    let mut positions = vec![];
    let mut triangles = vec![];
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            for (i, j) in (-n..n).flat_map(|i| (-n..n).map(move |j| (i, j))) {
                let first = positions.len() as u32;
                for (di, dj) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                    let mut p = [side; 3];
                    p[(axis + 1) % 3] = (i + di) as f32 / n as f32;
                    p[(axis + 2) % 3] = (j + dj) as f32 / n as f32;
                    positions.push(Vec3::from(p));
                }
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| first + k);
                let corners = if side > 0.0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                triangles.extend(corners);
            }
        }
    }
    mesh(positions, &triangles)
}

/// A closed surface of revolution of a line of radii and heights, from the lower end of the axis to the upper.
fn lathe(line: &[(f32, f32)], segments: u32) -> Mesh {
    let at = |(r, y): (f32, f32), s: u32| {
        let (sine, cosine) = ((s % segments) as f32 / segments as f32 * TAU).sin_cos();
        Vec3::new(r * sine, y, r * cosine)
    };
    let mut positions = vec![];
    for pair in line.windows(2) {
        for s in 0..segments {
            let [a, b, c, d] = [at(pair[0], s), at(pair[0], s + 1), at(pair[1], s + 1), at(pair[1], s)];
            if pair[0].0 != 0.0 {
                positions.extend([a, b, c]);
            }
            if pair[1].0 != 0.0 {
                positions.extend([a, c, d]);
            }
        }
    }
    let triangles: Vec<_> = (0..positions.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    mesh(positions, &triangles)
}

/// Two meshes as one whose triangles have the materials 0 and 1, with one vertex for each place.
fn welded(a: &Mesh, b: &Mesh) -> Mesh {
    let mut whole = Mesh { name: "welded".into(), ..Mesh::default() };
    for (material, part) in [a, b].into_iter().enumerate() {
        for triangle in &part.triangles {
            let vertices = triangle.vertices.map(|v| {
                let p = part.positions[v as usize];
                let known = whole.positions.iter().position(|q| *q == p);
                known.unwrap_or_else(|| {
                    whole.positions.push(p);
                    whole.positions.len() - 1
                }) as u32
            });
            whole.triangles.push(Triangle { vertices, material: material as u32 });
        }
    }
    whole
}

/// Adds one object of a mesh with these materials for 0 and 1.
fn add_welded(scene: &mut Scene, mesh: Mesh, materials: [Material; 2], place: Affine3A) {
    let first = scene.materials.len() as u32;
    add(scene, mesh, materials[0].clone(), place);
    scene.materials.push(materials[1].clone());
    let object = scene.objects.last_mut().expect("the one that was added");
    object.material = None;
    let mesh = std::sync::Arc::make_mut(scene.meshes.last_mut().expect("its mesh"));
    mesh.triangles.iter_mut().for_each(|triangle| triangle.material += first);
}

fn moved(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z))
}

fn floor() -> Mesh {
    quad(Vec3::new(-4.0, -1.0, -4.0), Vec3::Z * 8.0, Vec3::X * 8.0)
}

/// A label before the cube's front face, counter-clockwise from the front.
fn label(half: f32) -> Mesh {
    quad(Vec3::new(-half, -half, 1.0), Vec3::X * 2.0 * half, Vec3::Y * 2.0 * half)
}

/// Every kind by its name, how glass touches: with what is opaque of this albedo, in white light, `gap` apart.
pub fn scenes(albedo: f32, gap: f32) -> Vec<(&'static str, Scene)> {
    let white = || matte(Vec3::splat(albedo));
    let glass = || clear(1.5);
    let turned = Affine3A::from_rotation_y(0.4) * Affine3A::from_rotation_x(0.2);
    let scene = |build: &dyn Fn(&mut Scene)| {
        let mut scene = empty(16, 16);
        scene.sensor = pinhole(Vec3::new(1.4, 1.5, 5.0), Vec3::ZERO, Vec3::Y, 40.0);
        scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
        build(&mut scene);
        scene
    };
    let standing = |body: Mesh, place: Affine3A| {
        scene(&|scene| {
            add(scene, body.clone(), glass(), place * moved(0.0, gap, 0.0));
            add(scene, floor(), white(), place);
        })
    };
    vec![
        ("a cube on a floor", standing(cube(), Affine3A::IDENTITY)),
        ("far from the origin", {
            let far = Vec3::new(300.0, 20.0, -200.0);
            let mut scene = standing(cube(), Affine3A::from_translation(far));
            scene.sensor = pinhole(far + Vec3::new(1.4, 1.5, 5.0), far, Vec3::Y, 40.0);
            scene
        }),
        ("a cube on a turned floor", standing(cube(), turned)),
        ("mirrored and stretched", standing(cube(), turned * Affine3A::from_scale(Vec3::new(-0.5, 1.0, 0.7)))),
        ("a finely cut cube on a floor", standing(fine_cube(6), Affine3A::IDENTITY)),
        ("a cube on a floor, in one mesh, with the same vertices", {
            let body = if gap == 0.0 { cube() } else { standing_off(cube(), gap) };
            let floor = quad(Vec3::new(-1.0, -1.0, -1.0), Vec3::Z * 2.0, Vec3::X * 2.0);
            scene(&|scene| add_welded(scene, welded(&body, &floor), [glass(), white()], turned))
        }),
        ("in a corner of three walls", {
            scene(&|scene| {
                add(scene, cube(), glass(), moved(gap, gap, gap));
                for (u, v) in [(Vec3::Z, Vec3::X), (Vec3::X, Vec3::Y), (Vec3::Y, Vec3::Z)] {
                    add(scene, quad(Vec3::splat(-1.0), u * 3.0, v * 3.0), white(), Affine3A::IDENTITY);
                }
            })
        }),
        ("a label", {
            scene(&|scene| {
                add(scene, label(0.6), white(), turned * moved(0.0, 0.0, gap));
                add(scene, cube(), glass(), turned);
            })
        }),
        ("a label of the face's size", {
            scene(&|scene| {
                add(scene, label(1.0), white(), turned * moved(0.0, 0.0, gap));
                add(scene, cube(), glass(), turned);
            })
        }),
        ("a partly transparent label", {
            scene(&|scene| {
                let veil = Material { opacity: 0.5, ..white() };
                add(scene, label(0.6), veil, turned * moved(0.0, 0.0, gap));
                add(scene, cube(), glass(), turned);
            })
        }),
        ("a pane on a cube", {
            scene(&|scene| {
                let pane = Material { thin: true, ..glass() };
                add(scene, label(0.6), pane, turned * moved(0.0, 0.0, gap));
                add(scene, cube(), glass(), turned);
            })
        }),
        ("a pane on a wall", {
            scene(&|scene| {
                add(scene, label(1.0), Material { thin: true, ..glass() }, turned * moved(0.0, 0.0, gap));
                add(scene, label(0.6), white(), turned);
            })
        }),
        ("side by side", {
            scene(&|scene| {
                for x in [-1.0, 1.0] {
                    let half = Affine3A::from_scale(Vec3::splat(0.6));
                    add(scene, cube(), glass(), turned * half * moved(x * (1.0 + gap), 0.0, 0.0));
                }
            })
        }),
        ("side by side, in one mesh, with the same vertices", {
            let other = |side: f32| {
                let mut body = cube();
                body.positions.iter_mut().for_each(|p| p.x += side * (1.0 + gap));
                body
            };
            let body = welded(&other(-1.0), &other(1.0));
            scene(&|scene| {
                let place = turned * Affine3A::from_scale(Vec3::splat(0.6));
                add_welded(scene, body.clone(), [glass(), glass()], place);
            })
        }),
        ("a small one on a large one, of another glass", {
            scene(&|scene| {
                let small = Affine3A::from_scale_rotation_translation(
                    Vec3::splat(0.4),
                    glam::Quat::from_rotation_y(0.5),
                    Vec3::new(0.3, 1.4 + gap, 0.0),
                );
                add(scene, cube(), glass(), turned);
                add(scene, cube(), clear(1.33), turned * small);
            })
        }),
        ("water in a tumbler", {
            let tumbler = [(0.0, -1.0), (0.9, -1.0), (1.0, 0.9), (0.9, 0.9), (0.8, -0.8), (0.0, -0.8)];
            let water = [(0.0, -0.8 + gap), (0.8 - gap, -0.8 + gap), (0.85 - gap, 0.05), (0.0, 0.05)];
            scene(&|scene| {
                add(scene, lathe(&tumbler, 12), glass(), turned);
                add(scene, lathe(&water, 12), clear(1.33), turned);
            })
        }),
        ("ice that is flush with water", {
            scene(&|scene| {
                let half = Affine3A::from_scale(Vec3::splat(0.5));
                add(scene, cube(), clear(1.33), turned);
                add(scene, cube(), clear(1.31 / 1.33), turned * moved(0.0, 0.5 - gap, 0.0) * half);
            })
        }),
        ("a row on a floor", {
            scene(&|scene| {
                let third = Affine3A::from_scale(Vec3::splat(0.5));
                let place = |k: f32| turned * moved(k * (1.0 + gap), gap - 0.5, 0.0) * third;
                let mesh = add(scene, cube(), glass(), place(-1.0));
                add_instance(scene, mesh, glass(), place(0.0));
                add_instance(scene, mesh, glass(), place(1.0));
                add(scene, floor(), white(), turned);
            })
        }),
        ("a body that does not bend light, on a floor", {
            scene(&|scene| {
                add(scene, cube(), clear(1.0), moved(0.0, gap, 0.0));
                add(scene, floor(), white(), Affine3A::IDENTITY);
            })
        }),
        ("water in glass, with a common face", {
            scene(&|scene| {
                add(scene, icosphere(2), glass(), turned);
                let inner = turned * Affine3A::from_scale(Vec3::splat(1.0 - gap));
                add(scene, icosphere(2), clear(1.33 / 1.5), inner);
            })
        }),
        ("a glowing cube on a floor", {
            scene(&|scene| {
                let glow = Material { emission: Vec3::splat(0.5), ..glass() };
                add(scene, cube(), glow, moved(0.0, gap, 0.0));
                add(scene, floor(), white(), Affine3A::IDENTITY);
            })
        }),
        ("a glowing label", {
            scene(&|scene| {
                add(scene, label(0.6), lamp(Vec3::splat(2.0)), turned * moved(0.0, 0.0, gap));
                add(scene, cube(), glass(), turned);
            })
        }),
    ]
}

/// The cube with its lower face a gap above -1.
fn standing_off(mut body: Mesh, gap: f32) -> Mesh {
    body.positions.iter_mut().filter(|p| p.y == -1.0).for_each(|p| p.y += gap);
    body
}

/// The same, where chance alone finds light: a path that loses nothing brings exactly 1 from white light.
pub fn furnaces() -> Vec<(&'static str, Scene)> {
    let mut scenes = scenes(1.0, 0.0);
    scenes.retain(|(name, _)| !name.contains("glowing"));
    for (_, scene) in &mut scenes {
        luminaire::scene::build::estimator(scene).light_sampling = LightSampling::None;
    }
    scenes
}
