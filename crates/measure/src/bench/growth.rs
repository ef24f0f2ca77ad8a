//! The section `growth`: how the cost of a sample and of a ray grows with luminaires, resolution and bounces, in the whole path tracer. How it
//! grows with triangles and instances is in [`super::rays`].

use super::definition::{Definition, Progress};
use super::effort::Effort;
use super::figure::{Better, Figure};
use super::figure_name::FigureName;
use super::meshes::{lamps, short};
use super::power_law::{fit, with_exponents};
use super::rounds::Rounds;
use super::section::Section;
use super::settings::Settings;
use crate::Workbench;
use crate::chart::{Axis, Chart, Series};
use crate::report::table::Table;
use crate::report::words::number;
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::film::GROUPS_IN_TURN;
use luminaire::film::{Batch, Tile};
use luminaire::render::Tracer;
use luminaire::scene::{Estimator, Extinction, Integrator, Scene};
use std::time::Instant;

/// What is measured, and for how long.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Who renders.
    pub backends: Vec<Backend>,
    /// Numbers of area luminaires.
    pub luminaires: Vec<u64>,
    /// Sides of square pictures.
    pub sides: Vec<u32>,
    /// Limits of the bounces.
    pub bounces: Vec<u32>,
    /// The side where something else grows.
    pub side: u32,
    /// Samples of a group: a picture gets four times that at least.
    pub group: u32,
    /// How often everything is timed.
    pub rounds: usize,
    /// Seconds of one timing, at least.
    pub seconds: f64,
}

impl Plan {
    /// What suits a machine and the time that there is.
    pub fn new(bench: &Workbench, settings: &Settings) -> Self {
        let software = bench.is_software();
        let quick = settings.effort == Effort::Quick;
        let large = settings.effort == Effort::Long || !software && !quick;
        let luminaires: &[u64] = &[1, 10, 100, 1000, 10_000];
        let sides: &[u32] = if large { &[64, 128, 256, 512, 1024] } else { &[32, 64, 128, 256] };
        let bounces: &[u32] = &[0, 1, 2, 4, 8, 16, 32];
        Plan {
            backends: settings.backends.clone(),
            luminaires: luminaires[..if quick { 3 } else { luminaires.len() }].to_vec(),
            sides: sides[..if quick { 3 } else { sides.len() }].to_vec(),
            bounces: bounces[..if quick { 4 } else { bounces.len() }].to_vec(),
            side: if software { 48 } else { 512 },
            group: if software { 1 } else { 4 },
            rounds: settings.rounds,
            seconds: if settings.effort == Effort::Long { 0.2 } else { 0.05 },
        }
    }
}

/// What grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Area luminaires.
    Luminaires,
    /// Pixels.
    Resolution,
    /// The limit of bounces, plus one: the surfaces that a path meets.
    Bounces,
}

impl Quantity {
    /// Part of names.
    fn name(self) -> &'static str {
        match self {
            Quantity::Luminaires => "luminaires",
            Quantity::Resolution => "resolution",
            Quantity::Bounces => "bounces",
        }
    }

    /// A horizontal axis.
    fn axis(self) -> &'static str {
        match self {
            Quantity::Luminaires => "area luminaires",
            Quantity::Resolution => "pixels",
            Quantity::Bounces => "surfaces on a path (max_bounces + 1)",
        }
    }

    /// Who grows, in a sentence.
    fn words(self) -> &'static str {
        match self {
            Quantity::Luminaires => "the number of area luminaires",
            Quantity::Resolution => "the number of pixels",
            Quantity::Bounces => "the surfaces on a path",
        }
    }
}

/// A backend at one point of a sweep.
#[derive(Debug, Clone)]
pub struct Cost {
    /// What grows.
    pub quantity: Quantity,
    /// How much of it there is: what is on the horizontal axis.
    pub x: f64,
    /// The point's part of a figure's name: `1e3`, `256`.
    pub at: String,
    /// Who rendered.
    pub backend: Backend,
    /// Rays of one sample, of all kinds.
    pub rays_a_sample: f64,
    /// Microseconds a sample.
    pub sample: Rounds,
}

impl Cost {
    /// Nanoseconds a ray.
    pub fn ray(&self) -> Rounds {
        self.sample.map(|us| 1e3 * us / self.rays_a_sample)
    }

    /// Millions of rays a second.
    pub fn rate(&self) -> Rounds {
        self.sample.map(|us| self.rays_a_sample / us)
    }
}

/// The section about how the cost of the path tracer grows.
pub(super) const DEFINITION: Definition = Definition {
    name: "growth",
    title: "How the cost grows with luminaires, resolution and bounces",
    scenes: false,
    run: |bench, settings, progress| {
        let plan = Plan::new(bench, settings);
        Ok(section(&plan, &measure(bench, &plan, progress)?))
    },
};

/// Samples of these bounces, all of which trace that far.
fn scene(luminaires: u64, side: u32, bounces: u32) -> Scene {
    let mut scene = lamps(luminaires);
    (scene.film.width, scene.film.height) = (side, side);
    let estimator = Estimator { extinction: Extinction::Off, max_bounces: Some(bounces), ..Estimator::default() };
    scene.integrator = Integrator::Path(estimator);
    scene
}

/// Bounces and luminaires where something else grows.
const BOUNCES: u32 = 2;
const LUMINAIRES: u64 = 10;

/// Measures every point of a plan.
///
/// # Errors
/// If the driver fails.
pub fn measure(bench: &Workbench, plan: &Plan, progress: Progress) -> Result<Vec<Cost>> {
    let mut points: Vec<(Quantity, f64, String, Scene)> = Vec::new();
    for &n in &plan.luminaires {
        points.push((Quantity::Luminaires, n as f64, short(n), scene(n, plan.side, BOUNCES)));
    }
    for &side in &plan.sides {
        let pixels = f64::from(side) * f64::from(side);
        points.push((Quantity::Resolution, pixels, side.to_string(), scene(LUMINAIRES, side, BOUNCES)));
    }
    for &bounces in &plan.bounces {
        let x = f64::from(bounces) + 1.0;
        points.push((Quantity::Bounces, x, bounces.to_string(), scene(LUMINAIRES, plan.side, bounces)));
    }
    let mut costs = Vec::new();
    for (quantity, x, at, scene) in points {
        progress(&format!("path tracer: {} {at}", quantity.name()));
        let mut timed = Vec::new();
        for &backend in &plan.backends {
            let tracer = bench.tracer(&scene, backend)?;
            timed.push((backend, Picture::calibrated(tracer, scene.film.width, plan)?, Rounds::default(), 0.0));
        }
        for _ in 0..plan.rounds {
            for (_, picture, sample, rays) in &mut timed {
                let once = picture.render()?;
                sample.0.push(1e6 * once.seconds / once.samples);
                *rays = once.rays / once.samples;
            }
        }
        costs.extend(timed.into_iter().map(|(backend, _, sample, rays_a_sample)| Cost {
            quantity,
            x,
            at: at.clone(),
            backend,
            rays_a_sample,
            sample,
        }));
    }
    Ok(costs)
}

/// A square picture that is rendered again and again.
struct Picture {
    tracer: Box<dyn Tracer>,
    side: u32,
    samples: u32,
    group: u32,
}

/// What rendering it took.
struct Once {
    seconds: f64,
    samples: f64,
    rays: f64,
}

impl Picture {
    /// With as many samples a pixel as take the plan's seconds.
    fn calibrated(tracer: Box<dyn Tracer>, side: u32, plan: &Plan) -> Result<Self> {
        let least = plan.group * GROUPS_IN_TURN;
        let mut picture = Picture { tracer, side, samples: least, group: plan.group };
        // The first run compiles the kernel, and the last is as warm as the rounds.
        picture.render_tile(Tile { x: 0, y: 0, width: side.min(8), height: side.min(8) }, 0)?;
        for _ in 0..2 {
            let seconds = picture.render()?.seconds;
            if seconds >= plan.seconds {
                break;
            }
            let wanted = f64::from(picture.samples) * plan.seconds / seconds.max(1e-7);
            picture.samples = (wanted / f64::from(least)).ceil().clamp(1.0, 4096.0) as u32 * least;
        }
        Ok(picture)
    }

    fn render(&mut self) -> Result<Once> {
        // As many samples in a batch as it can hold of the whole picture, else rows of it.
        let least = self.group * GROUPS_IN_TURN;
        let room = self.tracer.max_sums() as u32 / GROUPS_IN_TURN;
        let rows = (room / self.side).clamp(1, self.side);
        let step = (room / (rows * self.side)).max(1) * least;
        let mut all = Once { seconds: 0.0, samples: 0.0, rays: 0.0 };
        for first in (0..self.samples).step_by(step as usize) {
            for y in (0..self.side).step_by(rows as usize) {
                let tile = Tile { x: 0, y, width: self.side, height: rows.min(self.side - y) };
                let once = self.batch(tile, first..self.samples.min(first + step))?;
                all.seconds += once.seconds;
                all.samples += once.samples;
                all.rays += once.rays;
            }
        }
        Ok(all)
    }

    fn render_tile(&mut self, tile: Tile, first: u32) -> Result<Once> {
        self.batch(tile, first..first + self.group * GROUPS_IN_TURN)
    }

    fn batch(&mut self, tile: Tile, samples: std::ops::Range<u32>) -> Result<Once> {
        let count = f64::from(samples.end - samples.start) * tile.pixels() as f64;
        let start = Instant::now();
        let traced = self.tracer.trace(&Batch { tile, samples, group: self.group })?;
        let wall = start.elapsed().as_secs_f64();
        let rays: u64 = traced.sums.iter().map(|sum| u64::from(sum.rays.all)).sum();
        Ok(Once { seconds: traced.device_seconds.unwrap_or(wall), samples: count, rays: rays as f64 })
    }
}

/// The section of what was measured by a plan.
pub fn section(plan: &Plan, costs: &[Cost]) -> Section {
    let mut text = vec![format!(
        "A room with a block and small lamps below its ceiling, which have the same area together whatever their number, rendered by the whole path \
         tracer with multiple importance sampling and without roulette: every path goes on to its limit of bounces. Where nothing else is said it has \
         {LUMINAIRES} lamps, {BOUNCES} bounces and {0} by {0} pixels. Times are the device's own where it has a clock, {1} rounds of {2} s at least in \
         which the backends take turns. The exponent is that of the power law fitted to the points (least squares of the logarithms), with its standard \
         error; 0 is no growth, 1 is in proportion. How the cost of a ray grows with triangles and instances is said with the rays alone.",
        plan.side, plan.rounds, plan.seconds
    )];
    if let Some(side) = plan.sides.iter().max().filter(|side| **side < 1024) {
        text.push(format!(
            "Pictures larger than {side} by {side} pixels are left out: without a GPU they take minutes."
        ));
    }
    let mut charts = Vec::new();
    for quantity in [Quantity::Luminaires, Quantity::Resolution, Quantity::Bounces] {
        let by_ray = quantity == Quantity::Luminaires;
        let here: Vec<&Cost> = costs.iter().filter(|cost| cost.quantity == quantity).collect();
        let line = |backend: &Backend| {
            let of_backend = here.iter().filter(|cost| cost.backend == *backend);
            let point = |cost: &&Cost| if by_ray { cost.ray().point(cost.x) } else { cost.sample.point(cost.x) };
            Series { name: backend.to_string(), points: of_backend.map(point).collect() }
        };
        let series: Vec<Series> = plan.backends.iter().map(line).filter(|series| !series.points.is_empty()).collect();
        if series.is_empty() {
            continue;
        }
        let what = if by_ray { "ray" } else { "sample" };
        let laws: Vec<String> =
            series.iter().filter_map(|s| Some(format!("{} on {}", fit(&s.points)?, s.name))).collect();
        if !laws.is_empty() {
            text.push(format!("The time of a {what} over {}: exponent {}.", quantity.words(), laws.join(", ")));
        }
        charts.push(Chart {
            name: quantity.name().into(),
            title: format!("What a {what} of the path tracer costs over {}", quantity.words()),
            x: Axis::log(quantity.axis()),
            y: Axis::log(if by_ray { "ns a ray" } else { "microseconds a sample" }),
            series: with_exponents(series),
        });
    }
    let row = |cost: &Cost| {
        vec![
            format!("{} {}", cost.quantity.name(), cost.at),
            cost.backend.to_string(),
            cost.sample.spread().to_string(),
            number(cost.rays_a_sample),
            cost.rate().spread().to_string(),
        ]
    };
    let names = ["scene", "backend", "microseconds a sample", "rays a sample", "Mrays/s"];
    let tables = vec![Table::new(names).with_rows(costs.iter().map(row))];
    Section {
        name: DEFINITION.name,
        title: "How the cost of the path tracer grows".into(),
        text,
        tables,
        charts,
        figures: costs.iter().flat_map(figures).collect(),
    }
}

fn figures(cost: &Cost) -> Vec<Figure> {
    let of = format!("{}-{}/{}", cost.quantity.name(), cost.at, cost.backend);
    let name = |quantity: &str| FigureName { section: DEFINITION.name, of: &of, quantity }.to_string();
    let sample = Figure::of(name("sample"), "us", Better::Lower, &cost.sample.0);
    let rays = Figure::of(name("rays"), "Mrays/s", Better::Higher, &cost.rate().0);
    [sample, rays].into_iter().flatten().collect()
}
