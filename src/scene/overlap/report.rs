//! What was found of lamps that lie on each other, as warnings.

/// Something that was found, how often, and where first.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub count: usize,
    pub first: String,
}

impl Found {
    /// Counts more of it; `first` describes the first one.
    pub(super) fn add(&mut self, count: usize, first: impl FnOnce() -> String) {
        if self.count == 0 {
            self.first = first();
        }
        self.count += count;
    }

    /// A warning, if anything was found.
    pub(super) fn sentence(&self, path: &str, what: &str) -> Option<String> {
        let Found { count, first } = self;
        (*count > 0).then(|| format!("{path}: {count} triangle(s) {what} ({first})"))
    }
}

/// What was found of lamps, each a warning.
#[derive(Debug, Default)]
pub(super) struct Report {
    pub same: Found,
    pub veils: Found,
    pub united: Found,
    pub back_to_back: Found,
    pub other_light: Found,
    pub apart: Found,
    pub hidden: Found,
    pub unresolved: Found,
    pub in_plane: Found,
    pub cut: Found,
    pub cut_out: Found,
    pub glowing: Found,
    pub stuck: Found,
    /// Not all triangles were compared: there are too many in one place.
    pub unsearched: bool,
}

impl Report {
    /// A warning for each kind of thing that was found.
    pub(super) fn sentences(&self, path: &str) -> Vec<String> {
        let kinds = [
            (&self.same, "that emit lie on others of the same light: they are dropped, and the light is counted once"),
            (&self.united, "that emit cover each other in a plane: they are cut anew so that each place emits once"),
            (
                &self.back_to_back,
                "of one-sided lamps lie back to back with others of the same light: they are dropped, and the others shine both ways",
            ),
            (
                &self.apart,
                "lie back to back with one-sided lamps: both are moved apart by a hair, so that each side shows its own",
            ),
            (
                &self.other_light,
                "that emit lie on others of another light, of which only one can be seen: the first counts, and they are dropped",
            ),
            (&self.hidden, "that do not emit lie exactly on lamps: they are dropped, and the lamps show"),
            (
                &self.veils,
                "that are partly transparent, or thin panes, lie on others of the same material: they are dropped, so that the opacity counts once",
            ),
            (
                &self.unresolved,
                "that emit lie in the plane of other lamps and cover a part of them: where they overlap, the light is counted twice; cut or move them",
            ),
            (
                &self.in_plane,
                "that do not emit lie in the plane of lamps and cover a part of them: the lamps are moved off that plane by a hair, so that they show",
            ),
            (
                &self.cut,
                "that emit are covered in a part by lamps of another light in their plane: the first counts, and what it covers is cut out of them",
            ),
            (
                &self.cut_out,
                "that do not emit lie in the plane of lamps and cover a part of them: what is covered is cut out of them, so that the lamps show",
            ),
            (
                &self.glowing,
                "that emit and are partly transparent lie in the plane of other triangles, and are left as they are: which of the two is met first is left to rounding; move one of them",
            ),
            (
                &self.stuck,
                "that emit lie in the plane of others that are so large, or so far from the origin, that to move them by what single precision tells apart there would show: which of the two is met first is left to rounding; cut or move them",
            ),
        ];
        let mut sentences: Vec<String> = kinds.iter().filter_map(|(found, what)| found.sentence(path, what)).collect();
        if self.unsearched {
            sentences.push(format!(
                "{path}: too many lamps lie close together to compare all of them; light may be counted twice where they overlap"
            ));
        }
        sentences
    }
}
