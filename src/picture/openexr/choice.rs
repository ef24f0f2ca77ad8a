//! Which channels of an OpenEXR file are the picture.

use super::ERROR;
use ::exr::math::Vec2;
use ::exr::meta::header::Header;

/// Which channels of a file are the picture.
#[derive(Debug, PartialEq)]
pub(super) struct Choice {
    /// The part that they are in.
    pub part: usize,
    /// Red, green and blue, which are one and the same if there is only luminance.
    pub rgb: [String; 3],
    /// Alpha.
    pub alpha: Option<String>,
    /// The standard errors of red, green and blue.
    pub error: Option<[String; 3]>,
}

/// Channels that could be the picture.
struct Candidate {
    part: usize,
    /// What stands in front of the names: a layer, with its dot.
    prefix: String,
    /// The file has lower-case names.
    lower: bool,
    /// Red, green and blue; else luminance alone.
    colour: bool,
}

/// The last words of the names of layers that hold the whole picture, in the programs that write others beside it.
const WHOLE: [&str; 8] = ["combined", "composite", "beauty", "rgba", "rgb", "color", "colour", "c"];

impl Choice {
    /// Finds the picture: R, G and B without a prefix, else Y, else a layer that is called as pictures are, else the first one. Where others
    /// could be meant, a warning names them.
    ///
    /// # Errors
    /// In words that can follow the file's name: there is none, or it is of a kind that cannot be read.
    pub(super) fn new(headers: &[Header], warnings: &mut Vec<String>) -> Result<Self, String> {
        let mut candidates: Vec<_> = (0..headers.len()).flat_map(|part| of_part(headers, part)).collect();
        // Lower-case names are how masks are written beside a picture, and rarely the picture itself.
        if candidates.iter().any(|candidate| !candidate.lower) {
            candidates.retain(|candidate| !candidate.lower);
        }
        let Some(best) = (0..candidates.len()).min_by_key(|index| (candidates[*index].rank(headers), *index)) else {
            return Err(nothing(headers));
        };
        let chosen = &candidates[best];
        let plain = candidates.iter().filter(|candidate| candidate.prefix.is_empty()).count();
        if plain > 1 || plain == 0 && candidates.len() > 1 {
            let others =
                (0..candidates.len()).filter(|index| *index != best).map(|index| candidates[index].name(headers));
            let others: Vec<String> = others.collect();
            let more = if others.len() > 8 { ", ..." } else { "" };
            warnings.push(format!(
                "it holds several pictures: {} is used, not {}{more}; if another one is meant, write it to a file of its own",
                chosen.name(headers),
                others[..others.len().min(8)].join(", ")
            ));
        }
        let part = chosen.part;
        let has = |name: &str| names(headers, part).any(|n| n == name);
        let [red, green, blue, alpha, luminance] = chosen.channels();
        let rgb = if chosen.colour { [red, green, blue] } else { [0; 3].map(|_| luminance.clone()) };
        let error = ["R", "G", "B"].map(|c| format!("{ERROR}{c}"));
        let error = Some(error).filter(|error| chosen.prefix.is_empty() && error.iter().all(|name| has(name)));
        for channel in &headers[part].channels.list {
            let name = channel.name.to_string();
            let chroma = !chosen.colour && ["RY", "BY"].iter().any(|c| name == format!("{}{c}", chosen.prefix));
            if rgb.contains(&name) && channel.sampling != Vec2(1, 1) || chroma {
                return Err(format!(
                    "its channel {name} does not have a value for every pixel (subsampled chroma?): convert the picture to RGB"
                ));
            }
        }
        // What was found is read from the first part that has these channels.
        let has_all = |part: usize| rgb.iter().all(|name| names(headers, part).any(|n| n == *name));
        if (0..part).any(|part| !headers[part].deep && has_all(part)) {
            return Err(format!(
                "several of its parts have a channel {}: write the picture to a file of its own",
                rgb[0]
            ));
        }
        Ok(Choice { part, rgb, alpha: Some(alpha).filter(|alpha| has(alpha)), error })
    }
}

impl Candidate {
    /// The lowest is the best.
    fn rank(&self, headers: &[Header]) -> usize {
        if self.prefix.is_empty() {
            return usize::from(!self.colour);
        }
        let name = self.name(headers).trim_matches('`').to_ascii_lowercase();
        let last = name.rsplit('.').next().unwrap_or_default();
        match (WHOLE.iter().position(|whole| *whole == last), self.colour) {
            (Some(place), true) => 2 + place,
            (None, true) => 2 + WHOLE.len(),
            (_, false) => 3 + WHOLE.len(),
        }
    }

    /// What it is called, for a message.
    fn name(&self, headers: &[Header]) -> String {
        let layer = headers[self.part].own_attributes.layer_name.as_ref().map(ToString::to_string).unwrap_or_default();
        let layer = if self.prefix.starts_with(&format!("{layer}.")) { String::new() } else { layer };
        let name: String = format!("{layer}.{}", self.prefix).chars().filter(|c| !c.is_control()).take(80).collect();
        match name.trim_matches('.') {
            "" => format!("`{}`", if self.colour { "RGB" } else { "Y" }),
            name => format!("`{name}`"),
        }
    }

    /// The names of red, green, blue, alpha and luminance.
    fn channels(&self) -> [String; 5] {
        ["R", "G", "B", "A", "Y"].map(|channel| {
            let channel = if self.lower { channel.to_ascii_lowercase() } else { channel.to_owned() };
            format!("{}{channel}", self.prefix)
        })
    }
}

fn names(headers: &[Header], part: usize) -> impl Iterator<Item = String> {
    headers[part].channels.list.iter().map(|channel| channel.name.to_string())
}

/// What could be the picture in one part. Of a part with several samples a pixel, nothing is.
fn of_part(headers: &[Header], part: usize) -> Vec<Candidate> {
    if headers[part].deep {
        return Vec::new();
    }
    let all: Vec<String> = names(headers, part).collect();
    let has = |prefix: &str, channel: &str| all.iter().any(|name| name.strip_prefix(prefix) == Some(channel));
    let mut candidates = Vec::new();
    for name in &all {
        let Some((at, last)) = name.char_indices().next_back() else { continue };
        let prefix = &name[..at];
        if prefix == ERROR || !(prefix.is_empty() || prefix.ends_with('.')) {
            continue;
        }
        let lower = last.is_ascii_lowercase();
        let colour = if lower { ["r", "g", "b"] } else { ["R", "G", "B"] }.iter().all(|c| has(prefix, c));
        // X, Y and Z are a vector.
        let vector = has(prefix, if lower { "x" } else { "X" });
        if matches!(last, 'R' | 'r') && colour || matches!(last, 'Y' | 'y') && !colour && !vector {
            candidates.push(Candidate { part, prefix: prefix.to_owned(), lower, colour });
        }
    }
    candidates
}

/// Why there is no picture.
fn nothing(headers: &[Header]) -> String {
    if headers.iter().any(|header| header.deep) {
        return "it is deep (several samples a pixel): flatten it, for example with `oiiotool IN --flatten -o out.exr`"
            .into();
    }
    let all: Vec<String> = (0..headers.len()).flat_map(|part| names(headers, part)).collect();
    format!("it has neither the channels R, G and B nor Y, but {}", all.join(", "))
}
