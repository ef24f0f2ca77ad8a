//! `--tone` and `--exposure`.

use super::values::stops;
use luminaire::picture::Tone;
use luminaire::scene::Exposure;

/// `--tone`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ToneName {
    /// No curve: radiance 1 is white, what is brighter is clipped.
    Srgb,
    /// AgX, as film has it: soft highlights, bright colours go to white.
    Agx,
    /// Khronos PBR Neutral: base colours as they are, highlights compressed.
    Neutral,
}

impl ToneName {
    /// The curve.
    pub fn tone(self) -> Tone {
        match self {
            ToneName::Srgb => Tone::Srgb,
            ToneName::Agx => Tone::Agx,
            ToneName::Neutral => Tone::Neutral,
        }
    }
}

/// An exposure in stops, or `auto`.
pub fn exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    let problem = |_| "expected a number of stops from -64 to 64, for example 1.5, or auto".to_owned();
    stops(text).map(Exposure::Stops).map_err(problem)
}

/// An exposure in stops, where there is no scene to find one for.
pub fn stops_alone(text: &str) -> Result<f32, String> {
    if text == "auto" {
        return Err("parts hold the exposure that `luminaire render --exposure auto` has found for them: leave it out, or give a number of stops".into());
    }
    stops(text)
}
