//! The words of MTL that make a metallic-roughness surface of a material (Clara.io's extension, as Blender and tinyobjloader have it).

use crate::scene::load::material_draft::MapDraft;

/// What they say.
#[derive(Clone, Default)]
pub(super) struct Words {
    /// `Pr`.
    pub roughness: Option<f32>,
    /// `Pm`.
    pub metallic: Option<f32>,
    /// `Ps`.
    pub sheen: Option<f32>,
    /// `Pc`; Blender writes four times what it has.
    pub clearcoat: Option<f32>,
    /// `Pcr`.
    pub clearcoat_roughness: Option<f32>,
    /// `aniso`.
    pub anisotropy: Option<f32>,
    /// `anisor`, in turns.
    pub anisotropy_rotation: Option<f32>,
    /// `map_Pr`.
    pub roughness_map: MapDraft,
    /// `map_Pm`.
    pub metallic_map: MapDraft,
    /// `map_Ps`.
    pub sheen_map: MapDraft,
    /// `map_Pc`.
    pub clearcoat_map: MapDraft,
    /// `map_Pcr`.
    pub clearcoat_roughness_map: MapDraft,
    /// `map_ORM`: roughness in green, metal in blue.
    pub packed_map: MapDraft,
    /// `map_Ns`, and `map_refl` or `refl`: Blender's maps of roughness and metal where it writes the old words.
    pub exponent_map: MapDraft,
    pub reflection_map: MapDraft,
    /// The words that were there, in their order, whether or not what followed them could be read.
    said: Vec<String>,
}

impl Words {
    /// Whether there is any of them.
    pub(super) fn any(&self) -> bool {
        self.said.iter().any(|word| !["map_Ns", "map_refl"].contains(&&**word))
    }

    /// The words that were there.
    pub(super) fn names(&self) -> Vec<String> {
        self.said.clone()
    }

    /// Keeps a number; none: it could not be read, and what was there before it counts.
    pub(super) fn state(&mut self, word: &str, number: Option<f32>) {
        self.say(word);
        let place = match word {
            "Pr" => &mut self.roughness,
            "Pm" => &mut self.metallic,
            "Ps" => &mut self.sheen,
            "Pc" => &mut self.clearcoat,
            "Pcr" => &mut self.clearcoat_roughness,
            "aniso" => &mut self.anisotropy,
            _ => &mut self.anisotropy_rotation,
        };
        *place = number.or(*place);
    }

    /// The place of a map, by its keyword in small letters; none: it is no map of these words. What only Blender means by them only counts if it wrote the file.
    pub(super) fn map(&mut self, keyword: &str, blender: bool) -> Option<&mut MapDraft> {
        let word = match keyword {
            "map_pr" => "map_Pr",
            "map_pm" => "map_Pm",
            "map_ps" => "map_Ps",
            "map_pc" => "map_Pc",
            "map_pcr" => "map_Pcr",
            "map_orm" => "map_ORM",
            "map_ns" if blender => "map_Ns",
            "map_refl" if blender => "map_refl",
            _ => return None,
        };
        self.say(word);
        Some(match word {
            "map_Pr" => &mut self.roughness_map,
            "map_Pm" => &mut self.metallic_map,
            "map_Ps" => &mut self.sheen_map,
            "map_Pc" => &mut self.clearcoat_map,
            "map_Pcr" => &mut self.clearcoat_roughness_map,
            "map_ORM" => &mut self.packed_map,
            "map_Ns" => &mut self.exponent_map,
            _ => &mut self.reflection_map,
        })
    }

    fn say(&mut self, word: &str) {
        if !self.said.iter().any(|said| said == word) {
            self.said.push(word.to_owned());
        }
    }
}
