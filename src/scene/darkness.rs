//! Scenes whose picture can only be black.

use super::{Integrator, LightSampling, Scene};
use glam::Vec3;

impl Scene {
    /// Why no light can reach the sensor, as a sentence for a warning; none if some may.
    pub fn dark_because(&self) -> Option<String> {
        let path = self.path.display();
        if self.triangles_emit() || self.environment.is_some() {
            return None;
        }
        match &self.integrator {
            Integrator::Simple { ambient } if *ambient != Vec3::ZERO => None,
            _ if self.luminaires.is_empty() => Some(format!(
                "{path}: no [[luminaire]], no [environment], and no material emits; the picture will be black"
            )),
            Integrator::Path(estimator)
                if estimator.light_sampling == LightSampling::None
                    && !self.luminaires.iter().any(|luminaire| luminaire.is_disc() && luminaire.emits()) =>
            {
                Some(format!(
                    "{path}: no path ever meets a luminaire without an area, and there is nothing else that emits: with light \
                 sampling off (`none`) the picture will be black"
                ))
            }
            _ => None,
        }
    }

    /// Does any triangle emit?
    pub(super) fn triangles_emit(&self) -> bool {
        self.objects.iter().any(|object| {
            let mesh = &self.meshes[object.mesh as usize];
            mesh.triangles.iter().any(|triangle| self.material_of(object, triangle).emission != Vec3::ZERO)
        })
    }
}
