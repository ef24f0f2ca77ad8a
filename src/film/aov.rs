//! What the camera sees first (arbitrary output variables, AOVs): what denoisers and compositing programs want to know besides the picture.

use crate::picture::Values;

/// Depth of a pixel that sees nothing, as Blender writes it.
const NOTHING_SEEN: f32 = 1e10;

/// What the camera rays of one pixel hit first, added up over samples.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AovSum {
    /// Albedos: diffuse and glossy, and the larger one of impulse reflection and transmission; under a Fresnel mirror that transmits nothing, what
    /// goes on from straight above.
    pub albedo: [f32; 3],
    /// Distances along the line of sight (not along the ray), in the scene's unit.
    pub depth: f32,
    /// Unit shading normals in world space, on the side of the camera.
    pub normal: [f32; 3],
    /// Rays that hit something.
    pub hits: u32,
}

/// First hits over a whole film.
#[derive(Debug, Clone, PartialEq)]
pub struct Aovs {
    /// Camera rays of every pixel.
    pub samples: u32,
    /// The sums of every pixel, rows from the top.
    pub sums: Vec<AovSum>,
}

impl Aovs {
    /// Means, as channels of an EXR file: `albedo.R`, `albedo.G`, `albedo.B`, over all rays; `N.X`, `N.Y`, `N.Z`, of unit length, or 0 where nothing is
    /// seen; and `Z`, over the rays that hit something, or 1e10 where none does.
    pub fn channels(&self) -> Vec<(String, Values)> {
        let plane = |value: &dyn Fn(&AovSum) -> f32| Values::Float(self.sums.iter().map(value).collect());
        let mut channels = Vec::new();
        for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
            channels.push((format!("albedo.{name}"), plane(&|sum| sum.albedo[c] / self.samples.max(1) as f32)));
        }
        for (c, name) in ["X", "Y", "Z"].into_iter().enumerate() {
            let unit = |sum: &AovSum| {
                let length = sum.normal.iter().map(|v| v * v).sum::<f32>().sqrt();
                if length > 0.0 { sum.normal[c] / length } else { 0.0 }
            };
            channels.push((format!("N.{name}"), plane(&unit)));
        }
        let depth = |sum: &AovSum| if sum.hits > 0 { sum.depth / sum.hits as f32 } else { NOTHING_SEEN };
        channels.push(("Z".into(), plane(&depth)));
        channels
    }
}
