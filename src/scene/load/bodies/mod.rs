//! Bodies of glass: light that enters one must leave it, so its surface has to be closed, with all faces outwards.
//!
//! Around an edge a closed surface crosses in and out as often: the indices of refraction that are passed on the way around multiply to 1. That
//! holds for one body, for several that share an edge, where glass, water and air meet in faces that each have their own index, and for a body whose
//! parts stand in several objects.

mod around;
mod camera;
mod faults;
mod glass;
mod near;
mod reach;
mod seams;
mod split;

use crate::scene::Scene;
use around::Bodies;
use glass::{Glass, Use};
use seams::Seams;
use std::collections::HashMap;

/// A warning for each mesh whose glass is not made of closed bodies with all faces outwards, for bodies that stand twice in one place or reach through each other, and for a camera
/// within one.
pub(super) fn warnings(scene: &Scene) -> Vec<String> {
    let uses = uses(scene);
    if uses.is_empty() {
        return Vec::new();
    }
    let mut warnings = in_one_place(scene, &uses);
    let seams = Seams::find(scene, &uses);
    for (of, faults) in uses.iter().zip(&seams.faults) {
        warnings.extend(faults::sentence(scene, &uses, of, faults));
        let Glass { against, faces, .. } = &of.glass;
        if (1..faces.len()).contains(against) {
            warnings.push(format!(
                "{}: {against} of {} faces of glass ({}) are wound against their vertex normals, which are taken to say which side is outside",
                faults::who(scene, &of.objects),
                faces.len(),
                faults::names(scene, of.glass.materials(0..faces.len()))
            ));
        }
    }
    let bodies = Bodies::new(scene, &uses, &seams);
    for (objects, count, materials) in bodies.inside_out() {
        warnings.push(format!(
            "{}: {} of glass ({}) {} inside out: the faces point inwards, so that what is around it would be the glass; turn them around",
            faults::who(scene, &objects),
            if count == 1 { "a body".into() } else { format!("{count} bodies") },
            faults::names(scene, materials),
            if count == 1 { "is" } else { "are" },
        ));
    }
    warnings.extend(reach::sentence(scene, &uses, &seams));
    warnings.extend(camera::within(scene, &bodies));
    warnings
}

/// The glass of the scene: objects that show the same of a mesh together.
fn uses(scene: &Scene) -> Vec<Use> {
    let mut objects_of: HashMap<(u32, Option<u32>), Vec<usize>> = HashMap::new();
    let mut order = Vec::new();
    for (index, object) in scene.objects.iter().enumerate() {
        // Where the object has a material of its own, it alone decides.
        if object.material.is_some_and(|material| !scene.materials[material as usize].bends()) {
            continue;
        }
        let key = (object.mesh, object.material);
        let objects = objects_of.entry(key).or_insert_with(|| {
            order.push(key);
            Vec::new()
        });
        objects.push(index);
    }
    let uses = order.into_iter().map(|key| {
        let objects = objects_of.remove(&key).expect("every key has objects");
        let glass = Glass::of(scene, &scene.objects[objects[0]]);
        Use { objects, glass }
    });
    uses.filter(|of| !of.glass.faces.is_empty()).collect()
}

/// A warning for each object that shows the glass of another in the same place.
fn in_one_place(scene: &Scene, uses: &[Use]) -> Vec<String> {
    let mut places: HashMap<(u32, [u32; 12]), &str> = HashMap::new();
    let mut warnings = Vec::new();
    for object in uses.iter().flat_map(|of| &of.objects).map(|index| &scene.objects[*index]) {
        let place = object.object_to_world.to_cols_array().map(|x| (x + 0.0).to_bits());
        if let Some(other) = places.insert((object.mesh, place), &object.name) {
            warnings.push(format!(
                "objects `{other}` and `{}` are the same body of glass in the same place; light would enter it twice: remove one",
                object.name
            ));
        }
    }
    warnings
}
