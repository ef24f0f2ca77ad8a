//! The picture that all renders of a scene are compared with: given as a file, or rendered with many samples.

use super::contenders::Contender;
use crate::bench::renders::{picture, render_samples, warm_up};
use crate::{Workbench, metrics};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::picture::Picture;
use luminaire::scene::Scene;

/// What the pictures of a scene are compared with.
pub(super) struct Reference {
    pub picture: Picture,
    /// The estimate of its own relMSE; none where its errors are not known.
    pub own_error: Option<f64>,
    /// Where it comes from.
    pub words: String,
}

impl Reference {
    /// A file's picture, whose error is known if it holds standard errors.
    pub fn given(picture: &Picture) -> Self {
        let own_error = picture.error.as_ref().and_then(|errors| {
            let brightness = metrics::brightness(picture);
            let relative = |error: f32, radiance: f32| brightness.relative_square(error.into(), radiance.into());
            let pairs = errors.iter().zip(&picture.rgb).filter(|(e, b)| metrics::finite(e) && metrics::finite(b));
            let all: Vec<f64> =
                pairs.flat_map(|(e, b)| (0..3).map(move |c| (e[c], b[c]))).map(|(e, b)| relative(e, b)).collect();
            (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
        });
        Reference { picture: picture.clone(), own_error, words: "the picture that was given".into() }
    }

    /// Seconds of a short render, the least of three: what else the machine does can only make it slower.
    ///
    /// # Errors
    /// If the backend fails.
    pub fn pace(bench: &Workbench, scene: &Scene, backend: Backend) -> Result<f64> {
        let mut tracer = bench.tracer(scene, backend)?;
        warm_up(tracer.as_mut(), scene)?;
        (0..3).try_fold(f64::INFINITY, |least, _| {
            Ok(least.min(render_samples(tracer.as_mut(), scene, 4)?.progress.seconds))
        })
    }

    /// Renders a scene in about `seconds`. The number of samples is a power of two, so that two runs on the same machine mostly get the same.
    ///
    /// # Errors
    /// If the backend fails.
    pub fn rendered(
        bench: &Workbench,
        scene: &Scene,
        contender: &Contender,
        backend: Backend,
        seconds: f64,
    ) -> Result<Self> {
        let mut tracer = bench.tracer(scene, backend)?;
        warm_up(tracer.as_mut(), scene)?;
        let mut spp = 4;
        let mut rendered = render_samples(tracer.as_mut(), scene, spp)?;
        // A sample of a short render takes longer: the number of samples is estimated again after every render.
        while rendered.progress.seconds < 0.5 * seconds {
            let more = (seconds / rendered.progress.seconds.max(1e-9)).clamp(2.0, 16.0).log2().floor().exp2() as u32;
            spp = spp.saturating_mul(more).min(1 << 22);
            rendered = render_samples(tracer.as_mut(), scene, spp)?;
            if spp == 1 << 22 {
                break;
            }
        }
        let own_error = rendered.film.error().map(|error| error.rel_mse);
        let words = format!("{spp} samples a pixel of `{}` on {backend}, with another seed", contender.name);
        Ok(Reference { picture: picture(&rendered), own_error, words })
    }
}
