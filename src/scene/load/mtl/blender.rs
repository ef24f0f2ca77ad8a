//! What Blender means by the old words of MTL: the numbers of a Principled BSDF.

use super::current::Current;
use glam::Vec3;
use std::path::Path;

/// The Blender that wrote a file: its exporter up to 3.0 (`export_obj.py`) names itself without a version, the one since 3.1 (`obj_export_mtl.cc`) with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Blender {
    version: Option<(u32, u32)>,
}

/// The largest `Ns` that any Blender writes.
const LARGEST_NS: f32 = 1000.0;

impl Blender {
    /// By the first line of an MTL file: `# Blender 5.0.1 MTL File: 'None'`, or `# Blender MTL File: 'None'`.
    pub(super) fn of(text: &str) -> Option<Self> {
        let first = text.lines().map(str::trim).find(|line| !line.is_empty())?;
        let (version, _) = first.strip_prefix("# Blender")?.split_once("MTL File")?;
        let mut numbers = version.trim().trim_start_matches('v').split(|c: char| !c.is_ascii_digit());
        let mut number = || numbers.next()?.parse().ok();
        Some(Blender { version: number().zip(number()) })
    }

    /// Whether the index of refraction says how much a dielectric reflects; before 4.0 the specular level alone did, and the index only what is bent.
    pub(super) fn reflects_by_index(self) -> bool {
        self.version >= Some((4, 0))
    }

    /// The roughness that an `Ns` was made of: (1 - roughness)^2 times 900, and since 3.2, which can read its own files, 1000.
    pub(super) fn roughness(self, ns: f32) -> f32 {
        let most = if self.version >= Some((3, 2)) { 1000.0 } else { 900.0 };
        1.0 - (ns / most).sqrt().min(1.0)
    }

    /// The metal that `Ka` and `illum` were made of. Without a specular level (`illum 1`) metal and no metal both are `Ka 1`, and no metal is more likely.
    pub(super) fn metallic(self, ka: Option<Vec3>, illum: Option<u32>) -> f32 {
        let ka = ka.map_or(1.0, |ka| ka.x.min(1.0));
        match illum {
            Some(3 | 6) => ka,
            Some(1) if ka < 1.0 => ka,
            _ => 0.0,
        }
    }

    /// Why Blender cannot have written a material: somebody changed it, or it is of a time before the Principled BSDF.
    pub(super) fn is_another_hand(self, current: &Current) -> Option<String> {
        let coloured = |colour: Option<Vec3>| colour.is_some_and(|colour| colour != Vec3::splat(colour.x));
        let why = if coloured(current.draft.glossy) {
            "its Ks is a colour".to_owned()
        } else if coloured(current.draft.ambient) {
            "its Ka is a colour".to_owned()
        } else if let Some(ns) = current.draft.exponent.filter(|ns| *ns > LARGEST_NS) {
            format!("its Ns is {ns}")
        } else if let Some(illum) = current.illum.filter(|illum| ![1, 2, 3, 6, 9].contains(illum)) {
            format!("its illum is {illum}")
        } else if current.filter.is_some() {
            "it has a Tf".to_owned()
        } else {
            return None;
        };
        Some(format!(
            "{why}, which is not as Blender, which the first line names, writes a Principled BSDF: its words are taken by the letter"
        ))
    }

    /// Whether it is what the exporter up to 3.0 writes for faces without a material: a grey with a highlight that nobody chose.
    pub(super) fn is_stand_in(self, current: &Current) -> bool {
        let eight_tenths = Some(Vec3::splat(0.8));
        let draft = &current.draft;
        let alone = current.refraction.is_none() && draft.emission.is_none();
        self.version.is_none() && alone && draft.diffuse == eight_tenths && draft.glossy == eight_tenths
    }

    /// What is said of a file that is read so.
    pub(super) fn note(self, path: &Path) -> String {
        format!(
            "{}: written by Blender, so that its words are taken as those of a Principled BSDF: Ks is a specular level, Ns the roughness, Ka and illum the metal; \
             without its first line, or with model = \"blinn-phong\" in a [[material]] of a scene file, they mean what they say",
            path.display()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_lines_of_all_versions() {
        for (text, version) in [
            ("# Blender MTL File: 'None'\n# Material Count: 1\n", Some(None)),
            ("\n  # Blender MTL File: 'a b.blend'\r\n", Some(None)),
            ("# Blender 3.1.2 MTL File: 'None'\n# www.blender.org\n", Some(Some((3, 1)))),
            ("# Blender 4.0.0 Alpha MTL File: 'x 2.blend'\n", Some(Some((4, 0)))),
            ("# Blender 5.2.1 LTS MTL File: 'None'\n", Some(Some((5, 2)))),
            ("# Blender v2.93.0 MTL File: ''\n", Some(Some((2, 93)))),
            ("# Blender 5.0.1\n# www.blender.org\n", None),
            ("# Made by hand\n# Blender MTL File: 'None'\n", None),
            ("newmtl a\n# Blender MTL File: 'None'\n", None),
            ("", None),
        ] {
            assert_eq!(Blender::of(text).map(|blender| blender.version), version, "{text}");
        }
    }

    /// The default of each: 225 of roughness 0.5 up to 3.1, 250 since; 324 of 0.4.
    #[test]
    fn exponents_are_roughness() {
        let of = |version| Blender { version };
        for (version, ns, roughness) in [
            (None, 225.0, 0.5),
            (None, 323.999_994, 0.4),
            (Some((3, 1)), 225.0, 0.5),
            (Some((3, 2)), 250.0, 0.5),
            (Some((5, 0)), 490.0, 0.3),
            (Some((5, 0)), 0.0, 1.0),
            (Some((5, 0)), 1000.0, 0.0),
            (None, 1000.0, 0.0),
        ] {
            assert!((of(version).roughness(ns) - roughness).abs() < 1e-6, "{version:?} {ns}");
        }
    }
}
