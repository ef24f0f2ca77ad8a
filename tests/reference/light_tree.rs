//! The light tree: what it chooses, how often, and that nothing is left out that can contribute.

use crate::common::many_lamps::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::Reference;
use luminaire::reference::surfel::Surfel;
use luminaire::sampling::random4;
use luminaire::scene::*;

fn chosen_by(scene: &mut Scene, light_choice: LightChoice) {
    scene.integrator = Integrator::Path(Estimator { light_choice, ..Estimator::default() });
}

/// The probability with which an entry is chosen, by the walk to its leaf, or by what stands beside the tree; none for points.
fn said(tracer: &Reference, from: &Surfel, index: usize, entry: &SampledLuminaire) -> Option<f64> {
    let tree = tracer.light_tree().expect("a tree");
    match entry {
        SampledLuminaire::Area(t) => Some(tracer.tree_probability(tree, from, t.object, t.triangle)),
        SampledLuminaire::Impulse(luminaire) if !matches!(luminaire, Luminaire::Infinite { .. }) => None,
        _ => {
            let outer = tree.outer.iter().position(|outer| *outer == Some(index as u32)).expect("beside the tree");
            Some(tree.outer_choice.pdf[outer])
        }
    }
}

/// The same: whoever asks goes the same way, with the same width.
fn alike(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a
}

/// Luminaires are drawn as often as the walk up to their leaf says, and as the choice itself says.
#[test]
fn luminaires_are_drawn_by_their_probability() {
    let mut tests = vec![];
    let n = 100_000;
    for (name, mut scene, size) in hard() {
        chosen_by(&mut scene, LightChoice::Tree);
        let tracer = Reference::new(&scene);
        let entries = LuminaireTable::new(&scene).entries;
        for surface in 0..3 {
            let from = some_surface(surface, size);
            let mut counts = vec![0; entries.len() + 1];
            let mut found = vec![None; entries.len()];
            for i in 0..n {
                match tracer.choose_luminaire(&from, random4(i, surface, 2, 9)) {
                    None => counts[entries.len()] += 1,
                    Some((index, probability, ideal)) => {
                        assert!(probability > 0.0 && probability.is_finite() && ideal == probability, "{name}");
                        let before = found[index].get_or_insert(probability);
                        // Whatever number it was chosen by.
                        assert!(alike(*before, probability), "{name}: {before} and {probability}");
                        counts[index] += 1;
                    }
                }
            }
            let mut expected: Vec<f64> = entries
                .iter()
                .enumerate()
                .map(|(index, entry)| {
                    let said = said(&tracer, &from, index, entry);
                    if let (Some(said), Some(found)) = (said, found[index]) {
                        assert!(alike(said, found), "{name}: {said} and {found}");
                    }
                    f64::from(n) * said.or(found[index]).unwrap_or(0.0)
                })
                .collect();
            let none = f64::from(n) - expected.iter().sum::<f64>();
            assert!(none > -1e-3 * f64::from(n), "{name}: {none}");
            expected.push(none.max(0.0));
            if expected.iter().filter(|expected| **expected >= 10.0).count() >= 2 {
                tests.push((format!("{name}, {surface}"), chi_square_against(&counts, &expected)));
            }
        }
    }
    assert!(tests.len() >= 15, "{tests:?}");
    assert_plausible(&tests);
}

/// Where all can contribute, the probabilities of all add up to 1.
#[test]
fn probabilities_add_up() {
    let mut scene = empty(1, 1);
    for i in 0..300 {
        let corner = Vec3::new((i % 20) as f32, 5.0 + (i % 7) as f32, (i / 20) as f32);
        let emission = Vec3::splat(10f32.powi(i % 11 - 5));
        add(&mut scene, quad(corner, Vec3::X * 0.5, Vec3::Z * 0.5), lamp(emission), Affine3A::IDENTITY);
    }
    let tracer = Reference::new(&scene);
    let tree = tracer.light_tree().expect("many lamps");
    for i in 0..20u32 {
        let from = surface(DVec3::new(f64::from(i), 0.0, f64::from(i % 5)), DVec3::Y);
        let sum: f64 = (0..300).flat_map(|o| [0, 1].map(|t| tracer.tree_probability(tree, &from, o, t))).sum();
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
    }
}

/// A triangle of which a corner is above the surface's horizon, and from which the surface is on a side that emits, has a chance.
#[test]
fn whatever_may_contribute_is_chosen() {
    let (mut seen, mut none) = (0, 0);
    for (name, mut scene, size) in hard() {
        chosen_by(&mut scene, LightChoice::Tree);
        let tracer = Reference::new(&scene);
        let tree = tracer.light_tree().expect("a tree");
        let entries = LuminaireTable::new(&scene).entries;
        for number in 0..200 {
            let mut from = some_surface(number, size);
            if number % 4 == 0
                && let SampledLuminaire::Area(t) = &entries[number as usize % entries.len()]
            {
                // On a lamp, or within its plane.
                from.position = t.vertices[0].lerp(t.vertices[1], f64::from(number % 16) / 8.0);
            }
            for entry in entries.iter().step_by(1 + entries.len() / 300) {
                let SampledLuminaire::Area(t) = entry else { continue };
                let p = tracer.tree_probability(tree, &from, t.object, t.triangle);
                assert!((0.0..=1.0).contains(&p), "{name}: {p}");
                let one_sided = scene.materials[t.material as usize].one_sided;
                let above = t.vertices.iter().any(|v| from.shading_normal.dot(*v - from.position) > 1e-6 * size);
                let lit = !one_sided || t.normal.dot(from.position - t.vertices[0]) > 1e-6 * size;
                if above && lit {
                    assert!(p > 0.0, "{name}: {from:?} and {t:?}");
                    seen += 1;
                } else {
                    none += u32::from(p == 0.0);
                }
            }
        }
    }
    assert!(seen > 10_000 && none > 5_000, "{seen} and {none}");
}

/// A one-sided lamp is not chosen from behind, a two-sided one is as likely from both sides, and the inner side of a ball is less likely than the
/// outer one of another.
#[test]
fn sides_count() {
    let mut scene = empty(1, 1);
    let square = || quad(Vec3::new(-0.5, 0.0, -0.5), Vec3::X, Vec3::Z);
    let high = Affine3A::from_translation(Vec3::Y * 2.0);
    add(&mut scene, square(), Material { one_sided: true, ..lamp(Vec3::ONE) }, high);
    add(&mut scene, square(), lamp(Vec3::ONE), Affine3A::from_translation(Vec3::new(0.0, 2.0, 3.0)));
    for x in [4.0, 7.0] {
        add(&mut scene, icosphere(1), lamp(Vec3::ONE), Affine3A::from_translation(Vec3::X * x));
    }
    let tracer = Reference::new(&scene);
    let tree = tracer.light_tree().expect("a tree");
    let chance = |from: &Surfel, object: u32, triangle| tracer.tree_probability(tree, from, object, triangle);
    let of = |y: f64, normal: DVec3, object| chance(&surface(DVec3::new(0.1, y, 0.2), normal), object, 0);
    let sides = [of(0.0, DVec3::Y, 0), of(4.0, -DVec3::Y, 0)];
    assert!(sides[0] > 1e-3 && sides[1] < 1e-6 || sides[1] > 1e-3 && sides[0] < 1e-6, "{sides:?}");
    let both = [of(0.0, DVec3::Y, 1), of(4.0, -DVec3::Y, 1)];
    assert!(both[0] > 1e-2 && both[1] > 1e-2, "{both:?}");
    let from = surface(DVec3::new(5.5, 0.0, 0.0), -DVec3::X);
    let mut by_side = [0.0; 2];
    for triangle in 0..scene.meshes[2].triangles.len() {
        let corners = scene.meshes[2].triangles[triangle].vertices.map(|v| scene.meshes[2].positions[v as usize]);
        let middle = (corners[0] + corners[1] + corners[2]).as_dvec3() / 3.0;
        let outer = middle.dot(from.position - middle - 4.0 * DVec3::X) > 0.0;
        by_side[usize::from(outer)] += chance(&from, 2, triangle as u32);
    }
    assert!(by_side[1] > 4.0 * by_side[0] && by_side[0] > 0.0, "{by_side:?}");
}

/// Where it pays, and where it is asked for.
#[test]
fn the_tree_is_where_there_are_several_lamps() {
    let mut one = empty(1, 1);
    add(&mut one, quad(Vec3::Y, Vec3::X, Vec3::Z), lamp(Vec3::ONE), Affine3A::IDENTITY);
    let mut two = one.clone();
    add(&mut two, quad(Vec3::Y * 2.0, Vec3::X, Vec3::Z), lamp(Vec3::ONE), Affine3A::IDENTITY);
    let has = |scene: &Scene, choice| {
        let mut scene = scene.clone();
        chosen_by(&mut scene, choice);
        LuminaireTable::new(&scene).tree.is_some()
    };
    assert!(!has(&one, LightChoice::Auto) && has(&one, LightChoice::Tree) && !has(&one, LightChoice::Power));
    assert!(has(&two, LightChoice::Auto) && has(&two, LightChoice::Tree) && !has(&two, LightChoice::Power));
    assert!(!has(&empty(1, 1), LightChoice::Tree));
    two.integrator = Integrator::Path(Estimator { light_sampling: LightSampling::None, ..Estimator::default() });
    assert!(LuminaireTable::new(&two).tree.is_none());
}
