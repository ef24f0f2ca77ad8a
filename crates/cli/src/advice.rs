//! What is meant instead of a command line that cannot be read, added to what clap says about it.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use std::path::Path;

/// Options that others have, without their dashes, and what stands for them here.
const OPTIONS: &[(&[&str], &str)] = &[
    (&["resolution", "size", "res", "dimensions", "x", "y"], "the size is --width 1920 --height 1080"),
    (&["samples-per-pixel", "sample-count", "num-samples", "pixelsamples", "s"], "samples a pixel are --spp 64"),
    (
        &["threads", "cores", "j", "t", "nthreads"],
        "all cores are used; the variable RAYON_NUM_THREADS limits --backend cpu, and LP_NUM_THREADS Mesa's lavapipe",
    ),
    (&["cpu"], "that is --backend cpu"),
    (
        &["gpu", "cuda", "vulkan", "optix", "hip", "metal", "rtx", "use-gpu"],
        "a GPU is taken by itself (`luminaire devices` shows it); --device chooses another, --backend how rays are traced",
    ),
    (&["list-devices", "device-list", "gpus"], "that is `luminaire devices`"),
    (&["integrator", "method", "mode", "variant", "m"], "the choices are --estimator, and --backend for what traces"),
    (&["depth", "max-depth", "bounces", "maxdepth", "ray-depth"], "the limit of indirect bounces is --max-bounces N"),
    (
        &[
            "tonemap",
            "tone-map",
            "tonemapping",
            "tone-mapping",
            "tonemapper",
            "tone-mapper",
            "tone-curve",
            "view-transform",
            "filmic",
            "agx",
            "aces",
            "look",
            "color-management",
            "colour-management",
        ],
        "the tone curve is --tone: srgb (none), agx or neutral",
    ),
    (&["gamma", "brightness", "ev"], "brightness is --exposure STOPS, or --exposure auto; a PNG is sRGB by itself"),
    (&["auto-exposure", "autoexposure", "exposure-auto"], "that is --exposure auto"),
    (&["format", "f", "file-format", "type"], "the ending of -o says the format: -o picture.png, .exr or .hdr"),
    (&["out", "file", "outfile", "output-file", "save", "image"], "the picture is named with -o FILE.png"),
    (&["output-dir", "outdir", "folder", "dir"], "-o FOLDER/FILE.png names the folder, too"),
    (
        &[
            "camera",
            "cam",
            "sensor",
            "fov",
            "lookat",
            "look-at",
            "eye",
            "position",
            "target",
            "view",
            "viewpoint",
            "shift",
        ],
        "the camera is the table [sensor] of the scene file, or --camera FILE.toml, which `luminaire view` writes with the key C; --camera NAME takes one of several",
    ),
    (
        &["env", "environment", "envmap", "background", "hdri", "light", "lights"],
        "light from all around is --sky FILE.hdr, --sky R,G,B, studio or none; lamps are in the scene file: [[luminaire]], or a material with `emission`",
    ),
    (&["scene", "input", "i", "load"], "the scene stands alone, without an option before it: luminaire render SCENE"),
    (
        &["verbose", "v", "debug", "log", "log-level"],
        "--stats FILE.json has the figures of a run, and `luminaire inspect SCENE` what was loaded",
    ),
    (&["force", "overwrite", "yes"], "pictures are replaced anyway; leave it out"),
    (&["quality", "preset"], "quality is --spp N, or --noise 0.02 for an error of 2 %"),
    (&["timeout", "max-time", "time-limit", "seconds", "duration"], "that is --time SECONDS"),
    (
        &["noise-threshold", "adaptive", "max-error", "target-noise", "error", "threshold"],
        "that is --noise, for example --noise 0.02 for 2 %",
    ),
    (
        &["frame", "frames", "animation", "a", "start", "end", "turn", "orbit", "spin", "rotate", "fps"],
        "a turn around the scene is --turntable N, of which --frames A..B is a part; for any other animation a scene is one picture of it",
    ),
    (
        &["crop", "region", "border", "window", "crop-window", "cropwindow", "roi", "tile"],
        "a part of the picture is --crop X,Y,W,H of `luminaire render`, in pixels; a part of the samples is --samples A..B",
    ),
    (
        &["transparent", "alpha", "rgba", "film-transparent", "transparency", "no-background", "hide-emitters"],
        "a transparent background is --transparent of `luminaire render`",
    ),
    (
        &["aovs", "passes", "layers", "albedo", "normals", "depth-map"],
        "layers for denoisers and compositing are --aov, in an EXR file",
    ),
    (&["continue", "restart", "go-on"], "a render goes on with --checkpoint FILE.exr --resume"),
    (&["benchmark"], "that is `luminaire bench`"),
    (&["help-all", "usage"], "that is --help"),
    #[cfg(not(feature = "shaderc"))]
    (&["watch"], "--watch is in a program that compiles shaders: cargo build --release --features shaderc"),
    #[cfg(not(feature = "denoise"))]
    (
        &["denoised", "denoise", "denoiser", "oidn"],
        "--denoised FILE is in a program that is built with Open Image Denoise: cargo build --release --features denoise; --aov writes what other denoisers want",
    ),
    #[cfg(feature = "denoise")]
    (&["denoise", "denoiser", "oidn"], "that is --denoised FILE"),
];

const FILES: &[&str] =
    &["o", "out", "output", "file", "outfile", "output-file", "save", "dir", "folder", "output-dir", "outdir"];
const SECONDS: &[&str] = &["time", "timeout", "max-time", "time-limit", "seconds", "duration", "spp", "samples"];
const VERBOSE: &[&str] = &["verbose", "v", "debug", "log", "log-level"];

/// What stands for options in one subcommand alone: its name, the options, the advice.
const OWN: &[(&str, &[&str], &str)] = &[
    (
        "compare",
        &[
            "noise",
            "noise-threshold",
            "max-error",
            "target-noise",
            "error",
            "threshold",
            "tolerance",
            "epsilon",
            "limit",
        ],
        "limits are --max-relmse X, --max-rmse X, --max-bias X and --max-flip X",
    ),
    ("compare", FILES, "the picture of the errors is --heatmap FILE.png, and the figures are --stats FILE.json"),
    ("compare", &["diff", "map", "error-map", "heat-map", "image"], "the picture of the errors is --heatmap FILE.png"),
    ("compare", VERBOSE, "all is said already; --worst N lists more pixels, and --stats FILE.json has the figures"),
    ("stability", FILES, "the folder is --out DIR, and the page is --page FILE"),
    ("stability", SECONDS, "it takes what its sweeps take: name those to run, as --list shows them"),
    ("bench", FILES, "the folder is --out DIR, and the page is --page FILE.md"),
    ("bench", SECONDS, "the effort is --quick, --long or --rounds N, and --section NAME runs a part"),
    ("man", FILES, "the folder stands alone: luminaire man DIR"),
    ("completions", FILES, "the script is printed: luminaire completions SHELL > FILE"),
    (
        "view",
        FILES,
        "keys write files, as `luminaire view --help` says; without a window it is `luminaire render SCENE -o FILE.png`",
    ),
    (
        "view",
        &["time", "timeout", "seconds", "noise"],
        "the picture gets better until the window is closed; --spp N stops it",
    ),
    ("inspect", VERBOSE, "all is said already"),
    ("inspect", FILES, "it is printed: luminaire inspect SCENE > FILE"),
    ("devices", VERBOSE, "all is said already"),
    ("devices", FILES, "it is printed: luminaire devices > FILE"),
];

/// Names that --backend cannot have, and what is meant.
const BACKENDS: &[(&[&str], &str)] = &[
    (
        &["vulkan", "gpu", "device"],
        "auto takes the best Vulkan device (`luminaire devices` shows them); --device chooses another",
    ),
    (
        &["cuda", "optix", "hip", "oneapi", "metal", "opencl", "dx12", "directx", "nvidia", "amd", "intel"],
        "GPUs are used through Vulkan, whoever makes them: auto, or --device for a certain one",
    ),
    (&["rtx", "rt", "rayquery", "ray_query", "hardware", "rt-cores"], "ray queries are ray-query"),
    (
        &["bvh", "compute", "computebvh", "compute_bvh", "software", "lavapipe", "llvmpipe"],
        "our own BVH, which every Vulkan device runs, is compute-bvh",
    ),
    (&["reference", "embree", "llvm", "scalar", "scalar_rgb", "llvm_ad_rgb", "host", "x86"], "the CPU is cpu"),
];

/// What clap says about a command line, with its guesses replaced by what is meant where that is known. `words` is the command line of
/// `program`.
pub fn with_advice(error: clap::Error, words: &[String], mut program: clap::Command) -> clap::Error {
    program.build();
    let advice = advice(&error, words, &program);
    // Clap takes an option that it does not know for a name that begins with a dash, which nobody means.
    let as_a_value = |kind: ContextKind, value: &ContextValue| {
        kind == ContextKind::Suggested
            && matches!(value, ContextValue::StyledStrs(tips) if tips.iter().any(|tip| tip.to_string().contains("as a value, use")))
    };
    if advice.is_none() && !error.context().any(|(kind, value)| as_a_value(kind, value)) {
        return error;
    }
    let name = words.get(1).map_or("", String::as_str);
    let mut advised = clap::Error::new(error.kind()).with_cmd(program.find_subcommand(name).unwrap_or(&program));
    let guesses = [
        ContextKind::SuggestedArg,
        ContextKind::SuggestedSubcommand,
        ContextKind::SuggestedValue,
        ContextKind::Suggested,
    ];
    for (kind, value) in error.context() {
        let dropped = if advice.is_some() { guesses.contains(&kind) } else { as_a_value(kind, value) };
        if !dropped {
            advised.insert(kind, value.clone());
        }
    }
    if let Some(advice) = advice {
        advised.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![advice.into()]));
    }
    advised
}

fn advice(error: &clap::Error, words: &[String], program: &clap::Command) -> Option<String> {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    match error.kind() {
        ErrorKind::InvalidSubcommand => subcommand(text(ContextKind::InvalidSubcommand)?),
        ErrorKind::UnknownArgument => {
            // With its value, where it has one behind an equals sign.
            let word = text(ContextKind::InvalidArg)?.split_whitespace().next()?;
            argument(word, words, program)
        }
        ErrorKind::InvalidValue if text(ContextKind::InvalidArg)?.starts_with("--backend") => {
            let name = text(ContextKind::InvalidValue)?.to_lowercase();
            let known = ["auto", "ray-query", "compute-bvh", "cpu"].into_iter().find(|known| *known == name);
            known.map(|known| format!("names are written in small letters: {known}")).or_else(|| row(BACKENDS, &name))
        }
        _ => None,
    }
}

fn row(rows: &[(&[&str], &str)], word: &str) -> Option<String> {
    rows.iter().find(|(words, _)| words.contains(&word)).map(|(_, advice)| (*advice).to_owned())
}

/// Whether a word names a scene, or a picture, by its ending.
fn ends_with(word: &str, endings: &[&str]) -> bool {
    let ending = Path::new(word).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| endings.contains(&&*ending))
}

fn is_scene(word: &str) -> bool {
    luminaire::scene::is_scene(Path::new(word))
}

fn is_picture(word: &str) -> bool {
    ends_with(word, &["png", "exr", "hdr", "jpg", "jpeg", "tif", "tiff", "bmp", "webp"])
}

/// What a word in the place of a subcommand means.
fn subcommand(word: &str) -> Option<String> {
    if is_scene(word) || Path::new(word).exists() {
        return Some(format!("to render a scene: luminaire render {word}"));
    }
    let row: Option<&str> = match word.to_lowercase().as_str() {
        "show" | "gui" | "open" | "display" | "window" | "preview" => Some("luminaire view SCENE"),
        "diff" | "cmp" | "difference" | "metrics" => Some("luminaire compare IMAGE REFERENCE"),
        "info" | "check" | "validate" | "stats" | "list" => Some("luminaire inspect SCENE"),
        "gpus" | "device" | "adapters" => Some("luminaire devices"),
        "join" | "combine" | "concat" => Some("luminaire merge PART... -o FILE.exr"),
        "benchmark" | "perf" => Some("luminaire bench"),
        "run" | "trace" | "start" | "rendering" => Some("luminaire render SCENE"),
        _ => None,
    };
    row.map(|line| format!("that is `{line}`"))
}

/// What an option or a word that has no place means.
fn argument(word: &str, words: &[String], program: &clap::Command) -> Option<String> {
    let name = word.trim_start_matches('-');
    let dashes = word.len() - name.len();
    let name = name.split_once('=').map_or(name, |(name, _)| name);
    let here = words.get(1).map_or("", String::as_str);
    let at_top = program.find_subcommand(here).is_none();
    let has = |command: &clap::Command, name: &str| command.get_arguments().any(|arg| arg.get_long() == Some(name));
    // `-spp 4` is read as the options s, p and p.
    if dashes == 1
        && let Some(long) = words.iter().filter(|word| !word.starts_with("--")).find_map(|word| {
            let long = word.strip_prefix('-')?;
            let long = long.split_once('=').map_or(long, |(name, _)| name);
            (long.len() > 1 && program.get_subcommands().any(|command| has(command, long))).then_some(long)
        })
    {
        return Some(format!("an option of more than one letter has two dashes: --{long}"));
    }
    if dashes == 0 {
        if is_picture(word) || is_scene(word) && first_is_picture(words) {
            let scene = words.iter().skip(2).find(|word| is_scene(word)).map_or("SCENE", String::as_str);
            let picture = words.iter().skip(2).find(|word| is_picture(word)).map_or("PICTURE", String::as_str);
            return Some(format!(
                "the scene comes first, and the picture behind -o: luminaire render {scene} -o {picture}"
            ));
        }
        if is_scene(word) {
            return Some(format!("one scene a run; then the other: luminaire {here} {word}"));
        }
        let command = program.find_subcommand(here)?;
        let long = name.to_lowercase();
        return has(command, &long).then(|| format!("an option has two dashes: --{}", word.replacen('=', " ", 1)));
    }
    if at_top && program.find_subcommand(name).is_some() {
        return Some(format!("a subcommand has no dashes: luminaire {name}"));
    }
    if at_top {
        let owner = program.get_subcommands().find(|command| {
            has(command, name)
                || command
                    .get_arguments()
                    .any(|arg| dashes == 1 && arg.get_short().map(String::from).as_deref() == Some(name))
        });
        if let Some(owner) = owner {
            return Some(format!("the subcommand comes first: luminaire {} SCENE {word} ...", owner.get_name()));
        }
    }
    let plain = name.to_lowercase().replace('_', "-");
    if plain != name && program.find_subcommand(here).is_some_and(|command| has(command, &plain)) {
        return Some(format!("it is written --{plain}"));
    }
    let Some(command) = program.find_subcommand(here) else { return row(OPTIONS, &plain) };
    if let Some((.., advice)) = OWN.iter().find(|(own, words, _)| *own == here && words.contains(&plain.as_str())) {
        return Some((*advice).to_owned());
    }
    row(OPTIONS, &plain).filter(|advice| has_all_of(command, advice)).or_else(|| {
        let short = |command: &clap::Command| {
            dashes == 1 && command.get_arguments().any(|arg| arg.get_short().map(String::from).as_deref() == Some(name))
        };
        let owner = program.get_subcommands().find(|command| has(command, &plain) || short(command))?.get_name();
        Some(format!("{word} is an option of `luminaire {owner}`; `luminaire {here} --help` lists its own"))
    })
}

/// Whether a subcommand has every option that an advice names; what another build has is an advice for `render` and `view`, which differ in it.
fn has_all_of(command: &clap::Command, advice: &str) -> bool {
    if advice.contains("cargo build") {
        return ["render", "view"].contains(&command.get_name());
    }
    let words = advice.split(|c: char| !c.is_ascii_alphanumeric() && c != '-').filter(|word| word.starts_with('-'));
    words.into_iter().all(|word| match word.strip_prefix("--") {
        Some("" | "help") => true,
        Some(long) => command.get_arguments().any(|arg| arg.get_long() == Some(long)),
        None => command.get_arguments().any(|arg| arg.get_short().map(String::from).as_deref() == word.get(1..)),
    })
}

/// Whether the first word behind the subcommand that is no option is a picture.
fn first_is_picture(words: &[String]) -> bool {
    words.iter().skip(2).find(|word| !word.starts_with('-')).is_some_and(|word| is_picture(word))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    /// But for other command lines, which stand between backticks.
    #[test]
    fn own_advice_names_options_that_are_there() {
        let program = crate::Args::command();
        for (own, _, advice) in OWN {
            let command = program.find_subcommand(own).unwrap();
            let here: String = advice.split('`').step_by(2).collect();
            assert!(has_all_of(command, &here), "{own}: {advice}");
        }
    }
}
