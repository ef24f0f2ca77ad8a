//! The thread that traces: it follows what the window wants, and sends pictures and messages to it.

use super::develop::develop;
use super::estimators::Estimators;
use super::files::{save_camera, save_picture};
use super::first_hit::{FirstHit, FirstHits};
use super::lane::{Lane, Stage};
use super::link::{Inbox, Link};
use super::news::{Frame, News};
use super::options::Options;
use super::shown::Shown;
use super::title::figures;
use super::wanted::{Order, Saved, Wanted};
use luminaire::backend::{self, Backend, Request};
use luminaire::reference::AutoExposure;
use luminaire::render::SceneTracer;
use luminaire::scene::Scene;
use luminaire::{Error, Result};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// The least time between two pictures of a sight that is still getting better.
const FRAME: Duration = Duration::from_millis(100);
/// The time between two pictures is at least so many times that of developing one, so that most of it goes into tracing.
const DEVELOP_SHARE: u32 = 5;
/// The samples a pixel after which a property of the first surfaces is finished.
const FIRST_HIT_SAMPLES: u32 = 64;

/// The tracer of the picture.
struct Tracing {
    tracer: Box<dyn SceneTracer>,
    lane: Lane,
    backend: Backend,
    /// Backend and device in words.
    name: String,
}

/// What a tracer is looking for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Subject {
    /// The picture, or its error.
    Picture,
    /// A property of the first surfaces.
    Surfaces,
}

impl Subject {
    /// What has to be traced for what is shown.
    fn of(shown: Shown) -> Self {
        match shown {
            Shown::Picture | Shown::Error => Subject::Picture,
            Shown::First(_) => Subject::Surfaces,
        }
    }
}

/// Traces what a window wants.
struct Worker {
    scene: Scene,
    spp: u32,
    /// What the files' names begin with.
    stem: String,
    request: Request,
    estimators: Estimators,
    /// The tracer of the picture; none before it is opened.
    picture: Option<Tracing>,
    /// The film of a property of the first surfaces, by the same tracer.
    surfaces: Lane,
    /// Which property that is.
    kind: Option<FirstHit>,
    /// What the tracer looked for last; none before the first batch.
    subject: Option<Subject>,
    link: Arc<Link>,
    /// Sends to the window.
    send: Box<dyn Fn(News)>,
}

/// Starts a thread that traces what a window wants until it is ordered to quit or fails; its last news is which of the two.
///
/// # Errors
/// If no thread can be started.
pub fn start(
    options: Options,
    link: Arc<Link>,
    send: impl Fn(News) + Clone + Send + 'static,
) -> Result<JoinHandle<()>> {
    let work = move || {
        let news = Box::new(send.clone());
        // After a panic, whose message is on stderr, the window has to close too: without a worker it would only look alive.
        let result = catch_unwind(AssertUnwindSafe(|| Worker::new(options, link, news).run()))
            .unwrap_or_else(|_| Err(Error::NoDevice("the renderer stopped: this is a bug of luminaire".into())));
        send(News::Ended(result));
    };
    let thread = std::thread::Builder::new().name("worker".into());
    thread.spawn(work).map_err(|e| Error::NoDevice(format!("no thread can be started: {e}")))
}

impl Worker {
    fn new(options: Options, link: Arc<Link>, send: Box<dyn Fn(News)>) -> Self {
        let Options { mut scene, request, spp } = options;
        let stem = scene.path.file_stem().unwrap_or("scene".as_ref()).to_string_lossy().into_owned();
        let estimators = Estimators::of(&mut scene);
        Worker {
            scene,
            spp,
            stem,
            request,
            estimators,
            picture: None,
            surfaces: Lane::new(),
            kind: None,
            subject: None,
            link,
            send,
        }
    }

    /// Works until it is ordered to quit.
    ///
    /// # Errors
    /// If no tracer can be opened, or the one that runs fails.
    fn run(mut self) -> Result<()> {
        // Whether there may be more to trace, and whether anything is new since the last frame.
        let (mut busy, mut unseen) = (true, false);
        let mut next_frame = Instant::now();
        let mut saves = vec![];
        loop {
            let Inbox { wanted, orders, fresh } = if busy { self.link.take() } else { self.link.wait() };
            for order in orders {
                match order {
                    Order::Quit => return Ok(()),
                    Order::NextBackend => self.next_backend(&wanted),
                    Order::NextEstimator => self.next_estimator()?,
                    Order::Expose => self.expose(&wanted),
                    Order::SaveCamera => {
                        let news = save_camera(&self.stem, &wanted.sight.sensor, self.scene.origin, wanted.development);
                        news.into_iter().for_each(&self.send);
                    }
                    Order::Save(saved) => saves.push(saved),
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
            let subject = Subject::of(wanted.shown);
            if self.subject.replace(subject) != Some(subject) {
                lane.look(tracer)?;
            }
            let aimed = lane.aim(tracer, &wanted.sight, wanted.moving, spp)?;
            // While paused, too, a new sight is traced until every pixel has a sample.
            let traced = !(wanted.paused && lane.film().is_some()) && lane.trace(tracer)?;
            busy = aimed || traced;
            unseen |= busy || fresh;
            let due = match lane.stage() {
                Stage::Nothing => false,
                Stage::Quick => true,
                Stage::Better => !busy || Instant::now() >= next_frame,
            };
            if unseen && due {
                let start = Instant::now();
                self.send_frame(&wanted);
                unseen = false;
                next_frame = Instant::now() + (DEVELOP_SHARE * start.elapsed()).max(FRAME);
            }
            self.save(&wanted, &mut saves);
        }
    }

    /// Opens the tracer if there is none, and drops the film of the first surfaces if another property is wanted.
    fn open(&mut self, wanted: &Wanted) -> Result<()> {
        if self.picture.is_none() {
            self.say("preparing".into());
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

    /// Opens a tracer for the picture, and has the window show which it is.
    fn tracing(&mut self, wanted: &Wanted, request: &Request) -> Result<Tracing> {
        (self.scene.sensor, self.scene.film) = (wanted.sight.sensor.clone(), wanted.sight.film);
        let opened = backend::open(&self.scene, request)?;
        let name = format!("{} on {}", opened.backend, opened.device);
        let notice = if opened.notice { "notice: " } else { "" };
        self.say(format!("{notice}{name}: {}", opened.why));
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
                Err(error) => self.say(format!("no {backend}: {error}")),
            }
        }
    }

    fn next_estimator(&mut self) -> Result<()> {
        let Some(picture) = &mut self.picture else { return Ok(()) };
        let integrator = self.estimators.next();
        self.scene.integrator = integrator;
        picture.tracer.integrate(&integrator)?;
        picture.lane.restart();
        self.say(format!("estimator: {}", self.estimators.name()));
        Ok(())
    }

    /// Finds an exposure for what is seen.
    fn expose(&self, wanted: &Wanted) {
        let mut scene = self.scene.clone();
        scene.sensor = wanted.sight.sensor.clone();
        let found = AutoExposure::of(&scene, &wanted.sight.film);
        let text = found.in_words();
        match found.warning {
            Some(warning) => self.say(format!("warning: {warning}")),
            None => {
                (self.send)(News::Exposed(found.stops));
                self.say(text);
            }
        }
    }

    /// The lane whose film is shown.
    fn lane(&mut self, shown: Shown) -> Option<&mut Lane> {
        match Subject::of(shown) {
            Subject::Surfaces => Some(&mut self.surfaces),
            Subject::Picture => self.picture.as_mut().map(|picture| &mut picture.lane),
        }
    }

    /// Has the window show a message.
    fn say(&self, text: String) {
        (self.send)(News::Said(text));
    }

    /// Develops what is shown, and sends it.
    fn send_frame(&mut self, wanted: &Wanted) {
        let Some(picture) = &self.picture else { return };
        let tracer = match Subject::of(wanted.shown) {
            Subject::Picture => format!("{}, {}", picture.name, self.estimators.name()),
            Subject::Surfaces => picture.name.clone(),
        };
        let Some(lane) = self.lane(wanted.shown) else { return };
        let Some(progress) = lane.progress() else { return };
        let Some((film, before)) = lane.films() else { return };
        let developed = develop(film, before, wanted.shown, wanted.development);
        let window = (wanted.sight.film.width, wanted.sight.film.height);
        let figures = figures(&progress, wanted.shown, developed.size, window, &tracer);
        (self.send)(News::Frame(Frame { developed, figures }));
    }

    /// Writes the pictures that were ordered, as soon as the film has the window's resolution and a sample in every pixel.
    fn save(&mut self, wanted: &Wanted, saves: &mut Vec<Saved>) {
        let stem = self.stem.clone();
        let Some(film) = self.lane(wanted.shown).and_then(|lane| lane.film()).filter(|_| !saves.is_empty()) else {
            return;
        };
        let written: Vec<News> = saves.drain(..).map(|saved| save_picture(&stem, saved, film, wanted)).collect();
        written.into_iter().for_each(&self.send);
    }
}
