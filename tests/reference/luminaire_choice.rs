//! The choice of a luminaire by power: by chance and by the power heuristic.

use crate::common::scenes::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::Reference;
use luminaire::sampling::random4;
use luminaire::scene::{Estimator, Integrator, LightChoice, LuminaireTable, SampledLuminaire, Scene};

/// 2^16 lamps of very different sizes in a row: one in eight is as large as all others together are small, down to 1e-4 of the mean and to
/// what no random number stands for.
fn many_lamps() -> Scene {
    let (mut positions, mut triangles) = (vec![], vec![]);
    for i in 0..1u32 << 16 {
        let size = 10f32.powf(-0.5 * (i % 8) as f32);
        let corner = Vec3::new((i % 256) as f32 * 1.5, 4.0, (i / 256) as f32 * 1.5);
        positions.extend([corner, corner + Vec3::X * size, corner + Vec3::Z * size]);
        triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let mut scene = empty(1, 1);
    let light_choice = LightChoice::Power;
    scene.integrator = Integrator::Path(Estimator { light_choice, ..Estimator::default() });
    add(&mut scene, mesh(positions, &triangles), lamp(Vec3::ONE), Affine3A::IDENTITY);
    add(
        &mut scene,
        quad(Vec3::new(-500.0, 0.0, -500.0), Vec3::X * 1000.0, Vec3::Z * 1000.0),
        matte(Vec3::splat(0.5)),
        Affine3A::IDENTITY,
    );
    scene
}

/// Whatever the power of a luminaire, some random numbers choose it; the table's probabilities and those of the power heuristic both add up to
/// 1, and are the same up to the numbers that there are.
#[test]
fn every_luminaire_is_chosen() {
    let scene = many_lamps();
    let table = LuminaireTable::new(&scene);
    let numbers = 2f64.powi(32);
    let (mut sum, mut ideal_sum, mut smallest, mut farthest) = (0.0, 0.0, 1.0f64, 0.0f64);
    for (entry, pdf) in table.entries.iter().zip(&table.choice.pdf) {
        let SampledLuminaire::Area(triangle) = entry else { panic!("only lamps") };
        let ideal = table.area_probability(triangle.material, triangle.area());
        // An entry has a part of its own slot, and is the alias of others: of each at most one number is rounded.
        assert!(*pdf > 0.0 && (pdf - ideal).abs() * numbers <= 2.0 + ideal * 65536.0 * 2.0, "{pdf:e} {ideal:e}");
        (sum, ideal_sum, smallest) = (sum + pdf, ideal_sum + ideal, smallest.min(ideal));
        farthest = farthest.max((pdf / ideal - 1.0).abs());
    }
    assert!((sum - 1.0).abs() < 1e-12 && (ideal_sum - 1.0).abs() < 1e-9, "{sum} {ideal_sum}");
    assert!(smallest >= 1e-3 / 65536.0 / 1.1, "{smallest:e}");
    assert!(farthest > 1e-3, "the table is not exact, or this test would be none: {farthest:e}");
}

/// The density that the power heuristic is given where light is sampled is that where a ray meets the lamp by chance, so that the two weights
/// add up to 1.
#[test]
fn both_strategies_have_one_density() {
    let scene = many_lamps();
    let tracer = Reference::new(&scene);
    let mut seen = [0; 8];
    for i in 0..20_000 {
        let from = DVec3::new(f64::from(i % 301), 1e-3, f64::from(i % 211));
        let hit = tracer.closest_hit(from, -DVec3::Y, f64::INFINITY, 0).expect("the floor");
        let floor = tracer.surfel(&hit, DVec3::Y);
        let Some((wi, density)) = tracer.sampled_direction(&floor, random4(i, 0, 1, 8)) else { continue };
        let Some(met) =
            tracer.closest_hit(floor.offset_ray_origin(wi), wi, f64::INFINITY, 0).filter(|hit| hit.object == 0)
        else {
            continue;
        };
        let by_chance = tracer.luminaire_pdf(&floor, &tracer.surfel(&met, -wi));
        assert!((density / by_chance - 1.0).abs() < 1e-6, "lamp {}: {density} and {by_chance}", met.triangle);
        seen[met.triangle as usize % 8] += 1;
    }
    // By their power; those that are smaller than a thousandth of the mean are chosen as if they were not.
    assert!(seen[0] > 10_000 && seen[1..4].iter().all(|count| *count > 5), "{seen:?}");
}
