//! The thread that traces: it follows what the window wants, and tells what there is to see.

use super::files::free_name;
use super::first_hit::{FirstHit, FirstHits};
use super::lane::{Lane, Sight};
use super::picture::{Developed, Shown, develop};
use super::{Options, camera};
use luminaire::backend::{self, Backend, Request};
use luminaire::render::SceneTracer;
use luminaire::scene::{Estimator, Integrator, Scene};
use luminaire::{Result, picture};
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A picture is shown again no sooner than after this, ...
const TELL: Duration = Duration::from_millis(100);
/// ... and so many times as long is spent on tracing as on developing.
const DEVELOP_SHARE: u32 = 5;
/// Samples of the first surface that are enough.
const FIRST_HIT_SAMPLES: u32 = 64;

/// What the window wants.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// Camera and film.
    pub sight: Sight,
    /// Whether the camera is on its way, so that quick is better than fine.
    pub moving: bool,
    /// What is shown.
    pub shown: Shown,
    /// In stops.
    pub exposure: f32,
    /// Whether to leave the film as it is.
    pub paused: bool,
}

/// What is to be done once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Trace with the next backend that works here.
    NextBackend,
    /// Trace with the next estimator.
    NextEstimator,
    /// Save what is shown as a PNG.
    SavePng,
    /// Save the film as an EXR.
    SaveExr,
    /// Write the camera down.
    SaveCamera,
    /// End.
    Quit,
}

/// What the worker tells the window.
#[derive(Debug)]
pub enum News {
    /// Something to see.
    Frame(Frame),
    /// A sentence about what was done, or could not be.
    Said(String),
    /// A result: a file, or its content, for standard output.
    Done(String),
    /// The worker has ended.
    Ended(Result<()>),
}

/// Something to see, and about it.
#[derive(Debug)]
pub struct Frame {
    pub developed: Developed,
    /// For the title.
    pub figures: String,
}

/// What the window and the worker share.
#[derive(Debug)]
pub struct Link {
    inbox: Mutex<Inbox>,
    changed: Condvar,
}

#[derive(Debug)]
struct Inbox {
    wanted: Wanted,
    orders: Vec<Order>,
    fresh: bool,
}

impl Link {
    pub fn new(wanted: Wanted) -> Self {
        Link { inbox: Mutex::new(Inbox { wanted, orders: vec![], fresh: true }), changed: Condvar::new() }
    }

    /// Tells the worker what is wanted now.
    pub fn want(&self, wanted: &Wanted) {
        let mut inbox = self.inbox();
        if inbox.wanted != *wanted {
            inbox.wanted = wanted.clone();
            inbox.fresh = true;
            self.changed.notify_one();
        }
    }

    /// Tells the worker what to do.
    pub fn order(&self, order: Order) {
        let mut inbox = self.inbox();
        inbox.orders.push(order);
        inbox.fresh = true;
        self.changed.notify_one();
    }

    fn inbox(&self) -> MutexGuard<'_, Inbox> {
        self.inbox.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What is wanted and to be done, and whether anything of it is new. Without `busy` it waits for something new.
    fn take(&self, busy: bool) -> (Wanted, Vec<Order>, bool) {
        let mut inbox = self.inbox();
        while !busy && !inbox.fresh {
            inbox = self.changed.wait(inbox).unwrap_or_else(PoisonError::into_inner);
        }
        let fresh = std::mem::take(&mut inbox.fresh);
        (inbox.wanted.clone(), std::mem::take(&mut inbox.orders), fresh)
    }
}

/// The estimators to go through: the scene's own, and those that converge to the same picture.
fn estimators(scene: &mut Scene) -> Vec<(&'static str, Integrator)> {
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
    found
}

/// The tracer of the picture.
struct Tracing {
    tracer: Box<dyn SceneTracer>,
    lane: Lane,
    backend: Backend,
    /// Backend and device in words.
    name: String,
}

/// Traces what a window wants, on a thread of its own.
pub struct Worker {
    scene: Scene,
    spp: u32,
    /// What the files' names begin with.
    stem: String,
    request: Request,
    estimators: Vec<(&'static str, Integrator)>,
    estimator: usize,
    picture: Option<Tracing>,
    /// What the same tracer has done for a property of the first surfaces, and which.
    surfaces: Lane,
    kind: Option<FirstHit>,
    /// Which of the two the tracer looks for.
    looks: Option<bool>,
    link: Arc<Link>,
    tell: Box<dyn Fn(News) + Send>,
}

impl Worker {
    pub fn new(options: Options, link: Arc<Link>, tell: Box<dyn Fn(News) + Send>) -> Self {
        let Options { mut scene, request, spp } = options;
        let stem = scene.path.file_stem().unwrap_or("scene".as_ref()).to_string_lossy().into_owned();
        let estimators = estimators(&mut scene);
        Worker {
            scene,
            spp,
            stem,
            request,
            estimators,
            estimator: 0,
            picture: None,
            surfaces: Lane::new(),
            kind: None,
            looks: None,
            link,
            tell,
        }
    }

    /// Works until it is told to quit.
    ///
    /// # Errors
    /// If no tracer can be opened, or the one that runs fails.
    pub fn run(mut self) -> Result<()> {
        let (mut busy, mut untold, mut next_tell) = (true, false, Instant::now());
        let mut saves = vec![];
        loop {
            let (wanted, orders, fresh) = self.link.take(busy);
            for order in orders {
                match order {
                    Order::Quit => return Ok(()),
                    Order::NextBackend => self.next_backend(&wanted),
                    Order::NextEstimator => self.next_estimator()?,
                    Order::SaveCamera => self.save_camera(&wanted),
                    Order::SavePng | Order::SaveExr => saves.push(order),
                }
            }
            self.open(&wanted)?;
            let Some(Tracing { tracer, lane, .. }) = &mut self.picture else { return Ok(()) };
            let mut hits;
            let (tracer, lane, spp): (&mut dyn SceneTracer, _, _) = match wanted.shown {
                Shown::First(kind) => {
                    hits = FirstHits { tracer: tracer.as_mut(), kind };
                    (&mut hits, &mut self.surfaces, FIRST_HIT_SAMPLES)
                }
                Shown::Picture | Shown::Error => (tracer.as_mut(), lane, self.spp),
            };
            let surfaces = matches!(wanted.shown, Shown::First(_));
            if self.looks.replace(surfaces) != Some(surfaces) {
                lane.look(tracer)?;
            }
            let aimed = lane.aim(tracer, &wanted.sight, wanted.moving, spp)?;
            // A pause does not keep a picture from being begun.
            let traced = !(wanted.paused && lane.film().is_some()) && lane.trace(tracer)?;
            busy = aimed || traced;
            untold |= busy || fresh;
            if let Some(quick) = lane.ready().filter(|_| untold)
                && (quick || !busy || Instant::now() >= next_tell)
            {
                let start = Instant::now();
                self.tell_frame(&wanted);
                untold = false;
                next_tell = Instant::now() + (DEVELOP_SHARE * start.elapsed()).max(TELL);
            }
            self.save(&wanted, &mut saves);
        }
    }

    /// Sees to the tracer that is wanted.
    fn open(&mut self, wanted: &Wanted) -> Result<()> {
        if self.picture.is_none() {
            (self.tell)(News::Said("preparing".into()));
            let request = self.request.clone();
            self.picture = Some(self.tracing(wanted, &request)?);
        }
        if let Shown::First(kind) = wanted.shown
            && self.kind.replace(kind) != Some(kind)
        {
            self.surfaces.restart();
        }
        Ok(())
    }

    /// Opens a tracer of the picture.
    fn tracing(&mut self, wanted: &Wanted, request: &Request) -> Result<Tracing> {
        (self.scene.sensor, self.scene.film) = (wanted.sight.sensor.clone(), wanted.sight.film);
        let opened = backend::open(&self.scene, request)?;
        let name = format!("{} on {}", opened.backend, opened.device);
        let notice = if opened.notice { "notice: " } else { "" };
        (self.tell)(News::Said(format!("{notice}{name}: {}", opened.why)));
        Ok(Tracing { tracer: opened.tracer, lane: Lane::new(), backend: opened.backend, name })
    }

    fn next_backend(&mut self, wanted: &Wanted) {
        const ALL: [Backend; 3] = [Backend::RayQuery, Backend::ComputeBvh, Backend::Cpu];
        let Some(present) = self.picture.as_ref().map(|picture| picture.backend) else { return };
        let at = ALL.iter().position(|backend| *backend == present).unwrap_or(0);
        for backend in [ALL[(at + 1) % 3], ALL[(at + 2) % 3]] {
            let device = self.request.device.clone().filter(|_| backend != Backend::Cpu);
            match self.tracing(wanted, &Request { backend: Some(backend), device }) {
                Ok(picture) => {
                    self.picture = Some(picture);
                    self.surfaces.restart();
                    return;
                }
                Err(error) => (self.tell)(News::Said(format!("no {backend}: {error}"))),
            }
        }
    }

    fn next_estimator(&mut self) -> Result<()> {
        let Some(picture) = &mut self.picture else { return Ok(()) };
        self.estimator = (self.estimator + 1) % self.estimators.len();
        let (name, integrator) = self.estimators[self.estimator];
        self.scene.integrator = integrator;
        picture.tracer.integrate(&integrator)?;
        picture.lane.restart();
        (self.tell)(News::Said(format!("estimator: {name}")));
        Ok(())
    }

    /// The lane that is shown.
    fn lane(&mut self, shown: Shown) -> Option<&mut Lane> {
        match shown {
            Shown::First(_) => Some(&mut self.surfaces),
            Shown::Picture | Shown::Error => self.picture.as_mut().map(|picture| &mut picture.lane),
        }
    }

    fn tell_frame(&mut self, wanted: &Wanted) {
        let (estimator, _) = self.estimators[self.estimator];
        let tracer = match (&self.picture, wanted.shown) {
            (Some(picture), Shown::Picture | Shown::Error) => format!("{}, {estimator}", picture.name),
            (Some(picture), Shown::First(_)) => picture.name.clone(),
            (None, _) => return,
        };
        let Some(lane) = self.lane(wanted.shown) else { return };
        let (samples, mrays, error) = lane.figures();
        let Some((film, before)) = lane.films() else { return };
        let developed = develop(film, before, wanted.shown, wanted.exposure);
        let error = match (error, wanted.shown) {
            (Some(error), Shown::Picture | Shown::Error) => format!("error {:.2} %, ", 100.0 * error),
            _ => String::new(),
        };
        let coarse = if developed.size == (wanted.sight.film.width, wanted.sight.film.height) {
            String::new()
        } else {
            format!(" of {} x {}", developed.size.0, developed.size.1)
        };
        let figures = format!("{samples:.1} samples a pixel{coarse}, {mrays:.2} Mrays/s, {error}{tracer}");
        (self.tell)(News::Frame(Frame { developed, figures }));
    }

    fn save_camera(&self, wanted: &Wanted) {
        let text = camera::to_toml(&wanted.sight.sensor);
        let path = free_name(Path::new(""), &self.stem, "camera", "toml");
        (self.tell)(News::Done(text.clone()));
        (self.tell)(saved(luminaire::files::save_text(&path, &text), &path));
    }

    /// Writes the pictures that are due, once there is one in full resolution.
    fn save(&mut self, wanted: &Wanted, orders: &mut Vec<Order>) {
        let stem = self.stem.clone();
        let Some(film) = self.lane(wanted.shown).and_then(|lane| lane.film()).filter(|_| !orders.is_empty()) else {
            return;
        };
        let written: Vec<News> = orders
            .drain(..)
            .map(|order| {
                let ending = if order == Order::SaveExr { "exr" } else { "png" };
                let path = free_name(Path::new(""), &stem, "view", ending);
                let done = if order == Order::SaveExr || wanted.shown == Shown::Picture {
                    film.save(&path, wanted.exposure)
                } else {
                    picture::save_png(&path, &develop(film, None, wanted.shown, wanted.exposure).image)
                };
                saved(done, &path)
            })
            .collect();
        written.into_iter().for_each(&self.tell);
    }
}

/// What to say about a file.
fn saved(result: Result<()>, path: &Path) -> News {
    match result {
        Ok(()) => News::Done(format!("{}\n", path.display())),
        Err(error) => News::Said(format!("error: {error}")),
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
            let found = estimators(&mut scene);
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
