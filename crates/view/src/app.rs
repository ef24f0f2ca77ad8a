//! The state of the window, and every change to it: the camera moves, a key was pressed, the worker sent something, time passed.

use super::ball::Ball;
use super::camera;
use super::input::{Input, STEP};
use super::keys::Action;
use super::link::Link;
use super::message::Message;
use super::news::{Frame, News};
use super::options::Options;
use super::overlay::Canvas;
use super::present::Presenter;
use super::shown::Shown;
use super::sight::Sight;
use super::wanted::{Order, Wanted};
use super::worker;
use luminaire::backend::development;
use luminaire::scene::Sensor;
use luminaire::{Error, Result};
use std::io::Write;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use winit::dpi::PhysicalSize;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::Window;

/// After so long without a move the camera counts as resting.
const REST: Duration = Duration::from_millis(150);
/// A picture that could not be shown is tried again after this.
const RETRY: Duration = Duration::from_millis(100);

/// The window, all that belongs to it, and the worker.
pub struct App {
    /// The scene's name, for the title.
    name: String,
    ball: Ball,
    /// The scene's own camera, to which R and Home return.
    start: Sensor,
    pub(super) wanted: Wanted,
    link: Arc<Link>,
    /// What the window is opened for; taken when it opens.
    options: Option<(Options, EventLoopProxy<News>)>,
    worker: Option<JoinHandle<()>>,
    // Declared before `window`, so that it is dropped first.
    presenter: Option<Presenter>,
    window: Option<Arc<Window>>,
    frame: Option<Frame>,
    pub(super) input: Input,
    /// When the camera last moved; none once it rests.
    moved: Option<Instant>,
    help: bool,
    message: Option<Message>,
    /// When to try again to show the picture.
    retry: Option<Instant>,
    outcome: Result<()>,
}

impl App {
    /// Has no window yet ([`App::open`]). The worker's news come through `proxy`.
    pub fn new(options: Options, proxy: EventLoopProxy<News>) -> Self {
        let wanted = Wanted {
            sight: Sight { sensor: options.scene.sensor.clone(), film: options.scene.film },
            moving: false,
            shown: Shown::Picture,
            development: development(&options.scene),
            paused: false,
        };
        App {
            name: options.scene.path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            ball: Ball::around(&options.scene),
            start: wanted.sight.sensor.clone(),
            link: Arc::new(Link::new(wanted.clone())),
            wanted,
            options: Some((options, proxy)),
            worker: None,
            presenter: None,
            window: None,
            frame: None,
            input: Input::default(),
            moved: None,
            help: false,
            message: None,
            retry: None,
            outcome: Ok(()),
        }
    }

    /// Opens the window, its device, and the worker.
    pub fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        let Some((options, proxy)) = self.options.take() else { return Ok(()) };
        let film = self.wanted.sight.film;
        let attributes = Window::default_attributes()
            .with_title(format!("{} - luminaire", self.name))
            .with_inner_size(PhysicalSize::new(film.width, film.height))
            .with_min_inner_size(PhysicalSize::new(16, 16));
        let window = event_loop.create_window(attributes).map_err(|e| {
            Error::NoDevice(format!("no window can be opened here: {e}; `luminaire render` needs none"))
        })?;
        let window = Arc::new(window);
        self.presenter = Some(Presenter::new(&window)?);
        self.resize(window.inner_size());
        self.window = Some(window);
        // Sending fails only when the event loop has ended, and then nobody needs the news.
        let send = move |news| drop(proxy.send_event(news));
        self.worker = Some(worker::start(options, self.link.clone(), send)?);
        Ok(())
    }

    /// Ends the worker and frees the device; the window goes last.
    ///
    /// # Errors
    /// What went wrong while the window was open.
    pub fn close(mut self) -> Result<()> {
        self.link.order(Order::Quit);
        if let Some(worker) = self.worker.take() {
            // What went wrong came as `News::Ended`.
            let _ = worker.join();
        }
        self.presenter = None;
        self.window = None;
        self.outcome
    }

    /// Ends the event loop because of an error.
    pub fn fail(&mut self, event_loop: &ActiveEventLoop, error: Error) {
        self.outcome = Err(error);
        event_loop.exit();
    }

    /// Asks the window system to have the picture drawn again.
    pub fn redraw(&self) {
        if let Some(window) = &self.window {
            window.request_redraw();
        }
    }

    /// Shows a line over the picture for a moment.
    fn say(&mut self, text: &str) {
        self.message = Some(Message::new(text));
        self.redraw();
    }

    /// The film takes the window's size.
    pub fn resize(&mut self, size: PhysicalSize<u32>) {
        if size.width > 0 && size.height > 0 {
            (self.wanted.sight.film.width, self.wanted.sight.film.height) = (size.width, size.height);
            self.link.want(&self.wanted);
        }
        if let Some(presenter) = &mut self.presenter {
            presenter.drop_chain();
        }
        self.redraw();
    }

    /// Puts the camera elsewhere.
    pub fn place(&mut self, sensor: Sensor) {
        if sensor != self.wanted.sight.sensor {
            self.wanted.sight.sensor = sensor;
            self.wanted.moving = true;
            self.moved = Some(Instant::now());
            self.link.want(&self.wanted);
        }
    }

    /// Carries out what a key stands for.
    pub fn act(&mut self, event_loop: &ActiveEventLoop, action: Action) {
        match action {
            Action::Expose(by) => {
                let exposure = &mut self.wanted.development.exposure;
                *exposure = (*exposure + by).clamp(-64.0, 64.0);
                let text = format!("exposure {exposure:+.2} stops");
                self.link.want(&self.wanted);
                self.say(&text);
            }
            Action::NextTone => {
                let tone = &mut self.wanted.development.tone;
                *tone = tone.next();
                let text = format!("tone: {}", tone.name());
                self.link.want(&self.wanted);
                self.say(&text);
            }
            Action::Show(shown) => {
                self.wanted.shown = shown;
                self.link.want(&self.wanted);
                self.say(shown.name());
            }
            Action::Return => self.place(self.start.clone()),
            Action::Frame => {
                let pixels = self.wanted.sight.film;
                let aspect = f64::from(pixels.width) / f64::from(pixels.height);
                self.place(camera::frame(&self.wanted.sight.sensor, self.ball, aspect));
            }
            Action::Order(order) => self.link.order(order),
            Action::Pause => {
                self.wanted.paused = !self.wanted.paused;
                self.link.want(&self.wanted);
                self.say(if self.wanted.paused { "paused" } else { "goes on" });
            }
            Action::Help => {
                self.help = !self.help;
                self.redraw();
            }
            Action::Quit => event_loop.exit(),
        }
    }

    /// Takes what the worker has sent.
    pub fn receive(&mut self, event_loop: &ActiveEventLoop, news: News) {
        match news {
            News::Frame(frame) => {
                if let Some(window) = &self.window {
                    let shown = match self.wanted.shown {
                        Shown::Picture => String::new(),
                        other => format!("{}, ", other.name()),
                    };
                    window.set_title(&format!("{}: {shown}{} - luminaire", self.name, frame.figures));
                }
                if self.frame.replace(frame).is_none() {
                    // With the first picture, messages about the wait for it are over.
                    self.message = None;
                }
                self.redraw();
            }
            News::Exposed(stops) => {
                self.wanted.development.exposure = stops;
                self.link.want(&self.wanted);
            }
            News::Said(text) => {
                // A stderr that nobody reads is no reason to fail.
                let _ = writeln!(std::io::stderr(), "{text}");
                self.say(&text);
            }
            News::Done(text) => {
                // A stdout that nobody reads is no reason to fail.
                let mut out = std::io::stdout().lock();
                let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
                self.say(&format!("wrote {}", text.lines().next().unwrap_or_default()));
            }
            News::Ended(Ok(())) => event_loop.exit(),
            News::Ended(Err(error)) => self.fail(event_loop, error),
        }
    }

    /// Draws the picture, with the help and the message over it.
    pub fn draw(&mut self) -> Result<()> {
        let (Some(presenter), Some(window)) = (&mut self.presenter, &self.window) else { return Ok(()) };
        let (frame, help, message) = (&self.frame, self.help, &self.message);
        let dot = window.scale_factor().round().max(1.0) as u32;
        let shown = presenter.show(&mut |bytes, size, blue_first| {
            match frame {
                Some(frame) => frame.developed.fill(size, blue_first, bytes),
                None => bytes.fill(0),
            }
            let mut canvas = Canvas { bytes, size, dot };
            if help {
                canvas.help();
            }
            if let Some(message) = message {
                canvas.line(&message.text);
            }
        })?;
        self.retry = (!shown).then(|| Instant::now() + RETRY);
        Ok(())
    }

    /// Does what is due: a step of a flight, a camera that comes to rest, a message that goes, another try to show the picture. Returns when it has
    /// to be called again if no event comes before; none: only events bring more to do.
    pub fn pass_time(&mut self) -> Option<Instant> {
        if let Some(sensor) = self.input.fly(&self.wanted.sight.sensor, self.ball.radius) {
            self.place(sensor);
        }
        let now = Instant::now();
        let rests = self.moved.map(|moved| moved + REST);
        if rests.is_some_and(|rests| now >= rests) {
            self.moved = None;
            self.wanted.moving = false;
            self.link.want(&self.wanted);
        }
        if self.message.as_ref().is_some_and(|message| now >= message.until) {
            self.message = None;
            self.redraw();
        }
        if self.retry.take_if(|retry| now >= *retry).is_some() {
            self.redraw();
        }
        let flies = self.input.flies().then(|| now + STEP);
        let message = self.message.as_ref().map(|message| message.until);
        [flies, self.moved.and(rests), message, self.retry].into_iter().flatten().min()
    }
}
