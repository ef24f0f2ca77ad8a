//! The estimators among which the key N changes.

use luminaire::scene::{Estimator, Integrator, Scene};

/// The scene's own estimator, and those that converge to the same picture.
pub struct Estimators {
    /// Each with its name.
    found: Vec<(&'static str, Integrator)>,
    /// Which of them is at work.
    present: usize,
}

impl Estimators {
    /// The estimators for a scene; its own is the first, and at work. The scene itself is unchanged afterwards.
    pub fn of(scene: &mut Scene) -> Self {
        let own = scene.integrator;
        let max_bounces = match own {
            Integrator::Path(estimator) => estimator.max_bounces,
            Integrator::Simple { .. } => None,
        };
        let mut found = vec![("the scene's estimator", own)];
        for name in ["default", "cosine", "uniform", "no-light-sampling"] {
            let preset = Estimator::preset(name).expect("a preset");
            let integrator = Integrator::Path(Estimator { max_bounces, ..preset });
            // Where light is met by chance alone, a scene may be black.
            scene.integrator = integrator;
            let dark = scene.dark_because().is_some();
            scene.integrator = own;
            if integrator == own {
                found[0].0 = name;
            } else if !dark {
                found.push((name, integrator));
            }
        }
        Estimators { found, present: 0 }
    }

    /// The name of the one at work.
    pub fn name(&self) -> &'static str {
        self.found[self.present].0
    }

    /// Goes on to the next one; after the last comes the first.
    pub fn next(&mut self) -> Integrator {
        self.present = (self.present + 1) % self.found.len();
        self.found[self.present].1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::scene::load;

    #[test]
    fn only_estimators_that_agree_are_gone_through() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let light = "[[luminaire]]\nkind = \"point\"\nposition = [0, 0, 1]\nintensity = [1, 1, 1]\n";
        let path = folder.path().join("a.toml");
        let names = |text: &str| {
            std::fs::write(&path, format!("{text}{light}[[object]]\nmesh = \"a.obj\"\n")).unwrap();
            let mut scene = load(&path).unwrap();
            let own = scene.integrator;
            let found = Estimators::of(&mut scene).found;
            assert_eq!((scene.integrator, found[0].1), (own, own));
            found.iter().map(|(name, _)| *name).collect::<Vec<_>>()
        };
        // Light by chance alone never meets the point.
        assert_eq!(names(""), ["default", "cosine", "uniform"]);
        assert_eq!(names("[integrator]\nestimator = \"cosine\"\nmax_bounces = 3\n"), ["cosine", "default", "uniform"]);
        let threshold = names("[integrator]\nestimator = \"threshold\"\n");
        assert_eq!(threshold, ["the scene's estimator", "default", "cosine", "uniform"]);
    }
}
