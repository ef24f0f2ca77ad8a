//! A camera within a body of glass.

use super::around::Bodies;
use super::glass::SAME_INDEX;
use crate::scene::Scene;
use crate::scene::load::loader::listed;

/// Says what is seen from within glass. Radiance is larger in there by the square of the index of refraction, which is right, and not what a
/// camera in a housing would record.
pub(super) fn within(scene: &Scene, bodies: &Bodies) -> Option<String> {
    let around = bodies.index_at(scene.sensor.position.as_dvec3());
    let index: f64 = around.iter().map(|(_, index)| index).sum();
    if index.abs() <= SAME_INDEX {
        return None;
    }
    let names = listed(around.iter().map(|(object, _)| scene.objects[*object].name.as_str()));
    let (index, factor) = (index.exp(), (2.0 * index).exp());
    Some(format!(
        "the camera stands within glass, of index {index:.3} ({names}): what it sees through the surface from outside is {factor:.3} times as bright \
         as for a camera in air, by the square of the index, and bent; move it out, or state an `exposure` of {:+.2} stops more to make up for \
         the brightness",
        -factor.log2()
    ))
}
