//! The material of an MTL file that is being read, and what its words mean by the letter.

use super::words::Words;
use crate::scene::load::material_draft::{DEFAULT_ETA, Draft, MapDraft};
use glam::Vec3;

/// A mirror-like `Ks` with at least this exponent, or with none, is a perfect mirror.
const MIRROR_EXPONENT: f32 = 1000.0;

/// So many features that nothing models are named for a material.
pub(super) const MOST_IGNORED: usize = 32;

/// The material between two `newmtl`.
#[derive(Clone, Default)]
pub(super) struct Current {
    pub draft: Draft,
    pub illum: Option<u32>,
    /// `d`, and what follows from `Tr`.
    pub dissolve: Option<f32>,
    pub transparency: Option<f32>,
    /// `Tf`.
    pub filter: Option<Vec3>,
    /// `Ni`.
    pub refraction: Option<f32>,
    /// The words of a metallic-roughness surface.
    pub words: Words,
    /// Keywords of features that nothing models.
    pub ignored: Vec<String>,
    /// What exporters write for many materials alike.
    pub shared: Vec<String>,
}

impl Current {
    pub(super) fn ignore(&mut self, what: String) {
        if self.ignored.len() < MOST_IGNORED && !self.ignored.contains(&what) {
            self.ignored.push(what);
        }
    }

    /// Whether it has no diffuse colour.
    pub(super) fn is_black(&self) -> bool {
        self.draft.maps.diffuse.file().is_none() && self.draft.diffuse.is_none_or(|kd| kd == Vec3::ZERO)
    }

    /// What it is where words mean what the format says; `at` is the material in words.
    pub(super) fn by_the_letter(mut self, file: &str, at: &str) -> Draft {
        self.words.names().into_iter().for_each(|word| self.ignore(word));
        self.impulses(at);
        self.multipliers_of_maps(at);
        if self.draft.glossy == Some(Vec3::ZERO) && self.draft.maps.glossy.file().is_some() {
            self.shared.push("map_Ks does nothing where Ks is 0".into());
        }
        self.finished(file)
    }

    /// The draft, with what is said of many materials.
    pub(super) fn finished(self, file: &str) -> Draft {
        let Current { mut draft, ignored, shared, .. } = self;
        let ignored = (!ignored.is_empty()).then(|| format!("not modelled, ignored: {}", ignored.join(", ")));
        draft.shared = shared.into_iter().chain(ignored).map(|said| (file.to_owned(), said)).collect();
        draft
    }

    /// What `illum` makes of `Ks`, `Ns`, `Ni`, `Tf`, `d` and `Tr`.
    fn impulses(&mut self, at: &str) {
        let glass = self.illum.filter(|model| matches!(model, 4 | 6 | 7 | 9)).is_some_and(|model| self.is_glass(model));
        let draft = &mut self.draft;
        let black = |colour: Option<Vec3>| colour.is_none_or(|colour| colour == Vec3::ZERO);
        match self.illum {
            Some(0 | 1) => draft.glossy = None,
            Some(model @ (3 | 5 | 8))
                if draft.exponent.is_none_or(|ns| ns >= MIRROR_EXPONENT) && !black(draft.glossy) =>
            {
                draft.reflection = draft.glossy.take();
                draft.eta = self.refraction.filter(|ni| model == 5 && *ni > 1.0);
                self.unused_map(|draft| &mut draft.maps.glossy, "map_Ks of a mirror");
            }
            Some(4 | 6 | 7 | 9) if glass => {
                draft.reflection = Some(if black(draft.glossy) { Vec3::ONE } else { draft.glossy.unwrap_or_default() });
                draft.transmission = Some(if black(self.filter) { Vec3::ONE } else { self.filter.unwrap_or_default() });
                draft.glossy = None;
                draft.eta = self.refraction.or(Some(DEFAULT_ETA));
                if self.refraction.is_none() {
                    draft
                        .notes
                        .push(format!("{at} is glass without an index of refraction (Ni); {DEFAULT_ETA} is used"));
                }
                self.dissolve = None;
                self.transparency = None;
                self.unused_map(|draft| &mut draft.maps.glossy, "map_Ks of glass");
                self.unused_map(|draft| &mut draft.maps.opacity, "map_d of glass");
            }
            _ => {}
        }
        if matches!(self.illum, Some(0 | 1)) {
            self.draft.maps.glossy = MapDraft::Unstated;
        }
        self.opacity(at);
    }

    /// Whether `illum`, which is one of those of glass, makes glass. Many exporters write one of them for everything, so that a material with a
    /// colour is glass only if it has an index of refraction, too, and nothing says how much of it is there; and a black one is not if its index is 1.
    pub(super) fn is_glass(&mut self, illum: u32) -> bool {
        let draft = &self.draft;
        let coloured = draft.maps.diffuse.file().is_some() || draft.diffuse.is_some_and(|kd| kd != Vec3::ZERO);
        if !coloured {
            // Clear glass that bends nothing cannot be seen, and nobody means that: black rubber, and lamps, are written so.
            let clear = self.filter.is_none_or(|tf| tf == Vec3::ZERO || tf == Vec3::ONE);
            let unseen = clear && self.refraction.is_some_and(|ni| (ni - 1.0).abs() <= 1e-3);
            if unseen {
                self.shared.push(format!(
                    "illum {illum} asks for glass, but with Ni 1 and without a tint (Tf) nothing could be seen of it: it is taken as opaque"
                ));
            }
            return !unseen;
        }
        let transparency = self.transparency.filter(|tr| *tr < 1.0).map_or(1.0, |tr| 1.0 - tr);
        let dissolves = self.dissolve.unwrap_or(transparency) < 1.0 || draft.maps.opacity.file().is_some();
        let refraction = self.refraction.filter(|ni| (ni - 1.0).abs() > 1e-3);
        let (glass, said) = match refraction {
            _ if dissolves => (
                false,
                "but with a colour (Kd): d, Tr or map_d is taken as the opacity, and nothing is refracted; `Kd 0 0 0` makes it glass".into(),
            ),
            _ if self.filter == Some(Vec3::ZERO) => (
                false,
                "but with a colour (Kd) and a Tf of 0, through which nothing goes: it is taken as opaque".to_owned(),
            ),
            None => (
                false,
                "but with a colour (Kd), without transparency (d) and without an index of refraction (Ni): it is taken as opaque; \
                 `Kd 0 0 0` makes it glass"
                    .into(),
            ),
            Some(ni) => (
                true,
                format!(
                    "with Ni {ni} and a colour (Kd): glass and diffuse share the light; without Ni, or with illum 2, it is opaque, and with \
                     `Kd 0 0 0` clear glass"
                ),
            ),
        };
        self.shared.push(format!("illum {illum} asks for glass, {said}"));
        glass
    }

    /// `d`, or 1 - `Tr`. They say the same in opposite ways, and exporters disagree on `Tr`: `d` wins where both are given, and what would be
    /// invisible by `Tr` alone is not meant to be.
    pub(super) fn opacity(&mut self, at: &str) {
        if let (Some(d), Some(tr)) = (self.dissolve, self.transparency)
            && (d + tr - 1.0).abs() > 1e-3
        {
            self.draft.notes.push(format!("{at}: d {d} and Tr {tr} contradict each other; d counts"));
        }
        if let (None, Some(tr)) = (self.dissolve, self.transparency)
            && tr >= 1.0
        {
            self.shared.push(format!(
                "Tr {tr} alone would make it invisible (Tr is 1 - d), but programs that write this mean opaque, as which it is taken: write `d 1` \
                 in its place, or `d 0` if nothing is to be seen"
            ));
            self.transparency = None;
        }
        let opacity = self.dissolve.or(self.transparency.map(|tr| 1.0 - tr));
        self.draft.opacity = opacity.map(|d| d.clamp(0.0, 1.0));
    }

    /// Drops a map that nothing uses, and says so.
    fn unused_map(&mut self, map: fn(&mut Draft) -> &mut MapDraft, what: &str) {
        if std::mem::take(map(&mut self.draft)).file().is_some() {
            self.ignore(what.to_owned());
        }
    }

    /// Exporters write 0 beside a map and mean 1.
    pub(super) fn multipliers_of_maps(&mut self, at: &str) {
        let draft = &mut self.draft;
        for (keyword, colour, map) in
            [("Kd", &mut draft.diffuse, &draft.maps.diffuse), ("Ke", &mut draft.emission, &draft.maps.emission)]
        {
            if *colour == Some(Vec3::ZERO) && map.file().is_some() {
                *colour = Some(Vec3::ONE);
                draft.notes.push(format!("{at}: {keyword} is black beside a map_{keyword}; 1 is used"));
            }
        }
        if draft.opacity == Some(0.0) && draft.maps.opacity.file().is_some() {
            draft.opacity = Some(1.0);
            draft.notes.push(format!("{at}: d is 0 beside a map_d; 1 is used"));
        }
    }
}
