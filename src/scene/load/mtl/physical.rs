//! A material of an MTL file as a metallic-roughness surface: by words made for it, or by what Blender means by the old ones.

use super::blender::Blender;
use super::current::Current;
use super::words::Words;
use crate::scene::load::map_file::{Channel, MapFile};
use crate::scene::load::material_draft::{Draft, MapDraft, UNSAID_KS};
use crate::scene::load::physical_draft::{MetalColour, PhysicalDraft};
use glam::Vec3;
use std::f32::consts::TAU;

/// The roughness of sheen, of which MTL has no word: Blender's.
const SHEEN_ROUGHNESS: f32 = 0.5;
/// An index this near 1 is what exporters write who know none.
const NEAR_ONE: f32 = 1e-3;

/// The material as such a surface: `Kd`, `Ke`, `d` and their maps as they are, `Ni` the index, and what its words say. `blender`: it wrote the material, so that
/// `Ks`, `Ns`, `Ka` and `illum` say something of it, too. `at` is the material in words.
pub(super) fn draft(mut reading: Current, blender: Option<Blender>, file: &str, at: &str) -> Draft {
    let words = std::mem::take(&mut reading.words);
    let maps = &mut reading.draft.maps;
    let (glossy_map, ambient_map) = (std::mem::take(&mut maps.glossy), std::mem::take(&mut maps.ambient));
    let stand_in = blender.is_some_and(|blender| blender.is_stand_in(&reading));
    let (ks, ns) = (reading.draft.glossy.take(), reading.draft.exponent.take());
    let (ks, ns) = if stand_in { (None, None) } else { (ks, ns) };
    let ka = reading.draft.ambient.take();
    let mut physical = PhysicalDraft::default();
    roughness_and_metal(&mut physical, &words, (ns, ka, reading.illum), blender);
    layers(&mut physical, &words, blender.is_some());
    transmission(&mut physical, &mut reading, words.any(), blender.is_some());
    index(&mut physical, &mut reading, blender);
    let mut idle = vec![(ambient_map.file().is_some(), "map_Ka")];
    if blender.is_some() {
        let black = ks == Some(Vec3::ZERO);
        if black && glossy_map.file().is_some() {
            reading.draft.notes.push(format!("{at}: Ks is black beside a map_Ks; 1 is used"));
        } else if black {
            physical.specular = Some(0.0);
        }
        // A level of 0.5 is what the index says; F0 grows with it.
        physical.specular_color = ks.filter(|_| !black).map(|ks| 2.0 * ks);
        physical.maps.specular_color = with(&glossy_map, |map| MapFile {
            base: 2.0 * map.base,
            gain: 2.0 * map.gain,
            stored: true,
            ..map.clone()
        });
    } else if reading.is_black()
        && physical.transmission.is_none()
        && (glossy_map.file().is_some() || ks.is_some_and(|ks| ks != Vec3::ZERO))
    {
        // What has no other colour has that of its reflection, if it is a metal: a scene file may have a word in that.
        physical.metal_colour = Some(MetalColour { colour: ks, map: glossy_map, file: file.to_owned() });
    } else {
        let unsaid = [Vec3::ZERO, UNSAID_KS];
        let rough = words.roughness.is_some() || physical.maps.roughness.file().is_some();
        idle.extend([
            (ks.is_some_and(|ks| !unsaid.contains(&ks)), "Ks"),
            (glossy_map.file().is_some(), "map_Ks"),
            (ns.is_some() && !rough, "Ns"),
        ]);
    }
    let idle: Vec<&str> = idle.into_iter().filter(|(idle, _)| *idle).map(|(_, word)| word).collect();
    if !idle.is_empty() {
        let words = idle.join(", ");
        reading.shared.push(format!("ignored, for a metallic-roughness material has no use for it: {words}"));
    }
    reading.opacity(at);
    reading.multipliers_of_maps(at);
    // Exporters write 0 beside a map and mean 1.
    let maps = &physical.maps;
    let mut zeros = Vec::new();
    for (word, number, map) in [
        ("Pr", &mut physical.roughness, &maps.roughness),
        ("Pm", &mut physical.metallic, &maps.metallic),
        ("Pc", &mut physical.clearcoat, &maps.clearcoat),
        ("Pcr", &mut physical.clearcoat_roughness, &maps.clearcoat_roughness),
    ] {
        if *number == Some(0.0) && map.file().is_some() {
            *number = None;
            zeros.push(word);
        }
    }
    if physical.sheen_color == Some(Vec3::ZERO) && maps.sheen_color.file().is_some() {
        physical.sheen_color = None;
        zeros.push("Ps");
    }
    for word in zeros {
        reading.draft.notes.push(format!("{at}: {word} is 0 beside a map_{word}; 1 is used"));
    }
    reading.draft.physical = Some(Box::new(physical));
    reading.finished(file)
}

/// `Pr` and `Pm`, or what Blender's `Ns`, `Ka` and `illum` were made of.
fn roughness_and_metal(
    physical: &mut PhysicalDraft,
    words: &Words,
    (ns, ka, illum): (Option<f32>, Option<Vec3>, Option<u32>),
    blender: Option<Blender>,
) {
    let packed = |channel| with(&words.packed_map, |map| MapFile { channel: Channel::One(channel), ..map.clone() });
    physical.maps.roughness = first([words.roughness_map.clone(), packed(1), words.exponent_map.clone()]);
    physical.maps.metallic = first([words.metallic_map.clone(), packed(2), words.reflection_map.clone()]);
    let (rough_map, metal_map) = (&physical.maps.roughness, &physical.maps.metallic);
    let by_exponent = |blender: Blender| ns.filter(|_| rough_map.file().is_none()).map(|ns| blender.roughness(ns));
    let by_ambient = |blender: Blender| metal_map.file().is_none().then(|| blender.metallic(ka, illum));
    physical.roughness = words.roughness.or(blender.and_then(by_exponent));
    // Blender leaves `Ka` out where it writes `Pm`.
    physical.metallic = words.metallic.or(blender.filter(|_| !words.any()).and_then(by_ambient));
}

/// `Pc`, `Ps`, `aniso`, and what belongs to them.
fn layers(physical: &mut PhysicalDraft, words: &Words, blender: bool) {
    let more = |number: Option<f32>, map: &MapDraft| number.is_some_and(|n| n > 0.0) || map.file().is_some();
    if more(words.clearcoat, &words.clearcoat_map) {
        // Its coat once had a factor of 1/4 in it, which its files still have.
        physical.clearcoat = words.clearcoat.map(|coat| if blender { 0.25 * coat } else { coat });
        physical.clearcoat_roughness = words.clearcoat_roughness;
        physical.maps.clearcoat = words.clearcoat_map.clone();
        physical.maps.clearcoat_roughness = words.clearcoat_roughness_map.clone();
    }
    if more(words.sheen, &words.sheen_map) {
        physical.sheen_color = words.sheen.map(Vec3::splat);
        physical.sheen_roughness = Some(SHEEN_ROUGHNESS);
        physical.maps.sheen_color = with(&words.sheen_map, |map| MapFile { stored: true, ..map.clone() });
    }
    if let Some(anisotropy) = words.anisotropy.filter(|anisotropy| *anisotropy > 0.0) {
        physical.anisotropy = Some(anisotropy);
        physical.anisotropy_rotation = words.anisotropy_rotation.map(|turns| TAU * turns);
    }
}

/// `Tf` where there are words that make it a share; and clear glass, which has a black `Kd`.
fn transmission(physical: &mut PhysicalDraft, reading: &mut Current, words: bool, blender: bool) {
    let black = reading.is_black();
    let glass = reading.illum.filter(|illum| matches!(illum, 4 | 6 | 7 | 9) && !blender);
    if let Some(illum) = glass.filter(|_| black) {
        if reading.is_glass(illum) {
            let tint = reading.filter.filter(|tf| *tf != Vec3::ZERO).unwrap_or(Vec3::ONE).min(Vec3::ONE);
            let most = tint.max_element();
            physical.transmission = Some(most);
            reading.draft.diffuse = Some(tint / most);
            (reading.dissolve, reading.transparency) = (None, None);
            if std::mem::take(&mut reading.draft.maps.opacity).file().is_some() {
                reading.ignore("map_d of glass".to_owned());
            }
        }
        return;
    }
    let share = reading.filter.map_or(0.0, |tf| (tf.element_sum() / 3.0).min(1.0));
    if share > 0.0 && (words || blender) {
        physical.transmission = Some(share);
        if !blender {
            reading
                .shared
                .push("Tf makes it transmit, as Blender writes it beside these words; with Tf 0 it is opaque".into());
        }
        if reading.filter.is_some_and(|tf| tf != Vec3::splat(tf.x)) {
            reading.shared.push("of Tf, which is a colour, the mean is the share that passes; its tint is Kd".into());
        }
    } else if let Some(illum) = glass {
        reading.shared.push(format!(
            "illum {illum} asks for glass, but a metallic-roughness material with a colour (Kd) transmits by Tf beside Pr, Pm and others: it is taken as opaque"
        ));
    }
}

/// `Ni`, where it is an index.
fn index(physical: &mut PhysicalDraft, reading: &mut Current, blender: Option<Blender>) {
    let Some(ni) = reading.refraction else { return };
    let transmits = physical.transmission.is_some();
    let (said, near_one) = (blender.is_none_or(Blender::reflects_by_index), (ni - 1.0).abs() <= NEAR_ONE);
    if !transmits && (!said || near_one) {
        if said {
            reading.shared.push("Ni 1, by which nothing would be reflected, is taken as 1.5".into());
        }
    } else if ni < 1.0 && !near_one {
        reading.shared.push(format!("Ni {ni} is below 1, which a metallic-roughness material cannot be: 1.5 is used"));
    } else {
        physical.ior = Some(ni.max(1.0));
    }
}

/// The map with another one of its choices.
fn with(map: &MapDraft, change: impl Fn(&MapFile) -> MapFile) -> MapDraft {
    map.file().map_or(MapDraft::Unstated, |map| MapDraft::File(change(map)))
}

/// The first map that is there.
fn first<const N: usize>(maps: [MapDraft; N]) -> MapDraft {
    maps.into_iter().find(|map| map.file().is_some()).unwrap_or_default()
}
