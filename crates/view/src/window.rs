//! The window: events in, pictures out.

use super::Options;
use super::camera::{self, Ball};
use super::first_hit::FirstHit;
use super::lane::Sight;
use super::overlay::Canvas;
use super::picture::Shown;
use super::present::Presenter;
use super::worker::{Frame, Link, News, Order, Wanted, Worker};
use glam::{DVec2, DVec3};
use luminaire::scene::{Projection, Sensor};
use luminaire::{Error, Result};
use std::collections::HashSet;
use std::f64::consts::PI;
use std::io::Write;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{Key, KeyCode, ModifiersState, NamedKey, PhysicalKey};
use winit::window::{Window, WindowId};

/// The camera rests when it has not moved for so long.
const REST: Duration = Duration::from_millis(150);
/// Between two steps of a flight.
const STEP: Duration = Duration::from_millis(16);
/// How long a message stays in the window.
const MESSAGE: Duration = Duration::from_secs(3);
/// A picture that could not be shown is tried again after this.
const RETRY: Duration = Duration::from_millis(100);
/// Flight in a second, in radii of the scene; with Shift five times as much.
const FLIGHT: f64 = 0.5;
/// What one step of the wheel does to the distance; a touchpad gives so many pixels for a step.
const WHEEL: f64 = 0.9;
const WHEEL_PIXELS: f64 = 40.0;
/// A step of the exposure in stops.
const EXPOSURE: f32 = 1.0 / 3.0;
/// The keys to fly with, by their place on the keyboard, and where each goes: right, up, forward.
const FLY: [(KeyCode, DVec3); 6] = [
    (KeyCode::KeyW, DVec3::Z),
    (KeyCode::KeyS, DVec3::NEG_Z),
    (KeyCode::KeyA, DVec3::NEG_X),
    (KeyCode::KeyD, DVec3::X),
    (KeyCode::KeyQ, DVec3::NEG_Y),
    (KeyCode::KeyE, DVec3::Y),
];

/// Shows a scene in a window until it is closed.
///
/// # Errors
/// If there is no display or no device that presents to it, the window is too large for a film, or the tracer or the device fails.
pub fn run(options: Options) -> Result<()> {
    let event_loop = EventLoop::<News>::with_user_event().build().map_err(|e| {
        let text = e.to_string();
        // Without the place in winit's source that comes first.
        let reason = text.rsplit_once(": ").filter(|_| text.starts_with("os error at ")).map_or(&text[..], |(_, r)| r);
        Error::NoDevice(format!(
            "no window can be opened here ({}): run it where there is a display (DISPLAY or WAYLAND_DISPLAY is set), \
             or use `luminaire render`, which needs none",
            reason.trim().trim_end_matches('.')
        ))
    })?;
    let wanted = Wanted {
        sight: Sight { sensor: options.scene.sensor.clone(), film: options.scene.film },
        moving: false,
        shown: Shown::Picture,
        exposure: options.scene.settings.exposure,
        paused: false,
    };
    let name = options.scene.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let link = Arc::new(Link::new(wanted.clone()));
    let mut app = App {
        name,
        ball: Ball::around(&options.scene),
        start: wanted.sight.sensor.clone(),
        wanted,
        link,
        options: Some((options, event_loop.create_proxy())),
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
    };
    let ran = event_loop.run_app(&mut app);
    app.close();
    app.outcome?;
    ran.map_err(|e| Error::NoDevice(format!("the window system failed: {e}")))
}

/// What is held down, and where the pointer is.
#[derive(Debug, Default)]
struct Input {
    keys: HashSet<KeyCode>,
    buttons: HashSet<MouseButton>,
    modifiers: ModifiersState,
    pointer: Option<PhysicalPosition<f64>>,
    /// When the camera last flew a step.
    flown: Option<Instant>,
}

struct App {
    /// Of the scene, for the title.
    name: String,
    ball: Ball,
    /// The camera to come back to.
    start: Sensor,
    wanted: Wanted,
    link: Arc<Link>,
    /// Until the window is there.
    options: Option<(Options, winit::event_loop::EventLoopProxy<News>)>,
    worker: Option<JoinHandle<()>>,
    // Before the window.
    presenter: Option<Presenter>,
    window: Option<Arc<Window>>,
    frame: Option<Frame>,
    input: Input,
    /// When the camera last moved, until it rests.
    moved: Option<Instant>,
    help: bool,
    /// What to say in the window, and until when.
    message: Option<(String, Instant)>,
    /// When to try again to show the picture.
    retry: Option<Instant>,
    outcome: Result<()>,
}

impl App {
    /// Opens the window, its device, and the worker.
    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
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
        self.resized(window.inner_size());
        self.window = Some(window);
        let (link, ended) = (self.link.clone(), proxy.clone());
        // The event loop is gone only when nobody wants to know any more.
        let tell = Box::new(move |news| drop(proxy.send_event(news)));
        let worker = std::thread::Builder::new().name("worker".into()).spawn(move || {
            // A window whose worker is gone would look alive. What the panic said is on stderr.
            let run = std::panic::AssertUnwindSafe(|| Worker::new(options, link, tell).run());
            let result = std::panic::catch_unwind(run)
                .unwrap_or_else(|_| Err(Error::NoDevice("the renderer stopped: this is a bug of luminaire".into())));
            let _ = ended.send_event(News::Ended(result));
        });
        self.worker = Some(worker.map_err(|e| Error::NoDevice(format!("no thread can be started: {e}")))?);
        Ok(())
    }

    /// Ends the worker and frees the device; the window goes last.
    fn close(&mut self) {
        self.link.order(Order::Quit);
        if let Some(worker) = self.worker.take() {
            // It tells what went wrong by `News::Ended`.
            let _ = worker.join();
        }
        self.presenter = None;
        self.window = None;
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: Error) {
        self.outcome = Err(error);
        event_loop.exit();
    }

    fn redraw(&self) {
        if let Some(window) = &self.window {
            window.request_redraw();
        }
    }

    fn say(&mut self, text: &str) {
        self.message = Some((text.lines().next().unwrap_or_default().to_owned(), Instant::now() + MESSAGE));
        self.redraw();
    }

    /// The film takes the window's size.
    fn resized(&mut self, size: PhysicalSize<u32>) {
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
    fn place(&mut self, sensor: Sensor) {
        if sensor != self.wanted.sight.sensor {
            self.wanted.sight.sensor = sensor;
            self.wanted.moving = true;
            self.moved = Some(Instant::now());
            self.link.want(&self.wanted);
        }
    }

    fn show(&mut self, shown: Shown) {
        self.wanted.shown = shown;
        self.link.want(&self.wanted);
        self.say(shown.name());
    }

    fn expose(&mut self, by: f32) {
        self.wanted.exposure = (self.wanted.exposure + by).clamp(-64.0, 64.0);
        self.link.want(&self.wanted);
        self.say(&format!("exposure {:+.2} stops", self.wanted.exposure));
    }

    fn draw(&mut self) -> Result<()> {
        let (Some(presenter), Some(window)) = (&mut self.presenter, &self.window) else { return Ok(()) };
        let (frame, help, message) = (&self.frame, self.help, &self.message);
        let dot = window.scale_factor().round().max(1.0) as u32;
        let shown = presenter.show(&mut |bytes, size, reversed| {
            match frame {
                Some(frame) => frame.developed.fill(size, reversed, bytes),
                None => bytes.fill(0),
            }
            let mut canvas = Canvas { bytes, size, dot };
            if help {
                canvas.help();
            }
            if let Some((text, _)) = message {
                canvas.line(text);
            }
        })?;
        self.retry = (!shown).then(|| Instant::now() + RETRY);
        Ok(())
    }

    fn key(&mut self, event_loop: &ActiveEventLoop, event: &KeyEvent) {
        let pressed = event.state == ElementState::Pressed;
        if let PhysicalKey::Code(code) = event.physical_key
            && FLY.iter().any(|(key, _)| *key == code)
        {
            // A key that is held counts from its first step.
            if pressed {
                self.input.keys.insert(code)
            } else {
                self.input.keys.remove(&code)
            };
            return;
        }
        let pixels = self.wanted.sight.film;
        match event.logical_key.as_ref() {
            _ if !pressed => {}
            Key::Character("+" | "=") => self.expose(EXPOSURE),
            Key::Character("-" | "_") => self.expose(-EXPOSURE),
            // The others do not repeat.
            _ if event.repeat => {}
            Key::Named(NamedKey::Escape) => event_loop.exit(),
            Key::Named(NamedKey::Home) | Key::Character("r" | "R") => self.place(self.start.clone()),
            Key::Character("f" | "F") => {
                let aspect = f64::from(pixels.width) / f64::from(pixels.height);
                self.place(camera::frame(&self.wanted.sight.sensor, self.ball, aspect));
            }
            Key::Character("1") => self.show(Shown::Picture),
            Key::Character("2") => self.show(Shown::Error),
            Key::Character("3") => self.show(Shown::First(FirstHit::Albedo)),
            Key::Character("4") => self.show(Shown::First(FirstHit::Normal)),
            Key::Character("5") => self.show(Shown::First(FirstHit::Depth)),
            Key::Character("b" | "B") => self.link.order(Order::NextBackend),
            Key::Character("n" | "N") => self.link.order(Order::NextEstimator),
            Key::Character("p" | "P") => self.link.order(Order::SavePng),
            Key::Character("o" | "O") => self.link.order(Order::SaveExr),
            Key::Character("c" | "C") => self.link.order(Order::SaveCamera),
            Key::Named(NamedKey::Space) => {
                self.wanted.paused = !self.wanted.paused;
                self.link.want(&self.wanted);
                self.say(if self.wanted.paused { "paused" } else { "goes on" });
            }
            Key::Character("h" | "H" | "?") => {
                self.help = !self.help;
                self.redraw();
            }
            _ => {}
        }
    }

    /// The pointer is somewhere else: orbits, pans or looks around, as the buttons say.
    fn drag(&mut self, to: PhysicalPosition<f64>) {
        let Some(from) = self.input.pointer.replace(to) else { return };
        // In heights of the picture.
        let height = f64::from(self.wanted.sight.film.height);
        let by = DVec2::new(to.x - from.x, to.y - from.y) / height;
        let sensor = &self.wanted.sight.sensor;
        let held = |button| self.input.buttons.contains(&button);
        let moved = if held(MouseButton::Middle) || held(MouseButton::Left) && self.input.modifiers.shift_key() {
            camera::pan(sensor, by)
        } else if held(MouseButton::Left) {
            camera::orbit(sensor, PI * by)
        } else if held(MouseButton::Right) {
            // What the pointer is on stays under it.
            let fov = match sensor.projection {
                Projection::Perspective { fov } => f64::from(fov).to_radians(),
                Projection::Orthographic { .. } => 1.0,
            };
            camera::look(sensor, -fov * by)
        } else {
            return;
        };
        self.place(moved);
    }

    /// Flies as far as the keys that are held have taken since the last step.
    fn fly(&mut self) {
        if self.input.keys.is_empty() {
            self.input.flown = None;
            return;
        }
        let now = Instant::now();
        let last = self.input.flown.replace(now).unwrap_or(now - STEP);
        // A window that was not served does not jump.
        let seconds = (now - last).as_secs_f64().min(0.1);
        let direction: DVec3 = FLY.iter().filter(|(key, _)| self.input.keys.contains(key)).map(|(_, by)| *by).sum();
        let fast = if self.input.modifiers.shift_key() { 5.0 } else { 1.0 };
        let by = direction.normalize_or_zero() * FLIGHT * self.ball.radius * fast * seconds;
        self.place(camera::fly(&self.wanted.sight.sensor, by));
    }
}

impl ApplicationHandler<News> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if let Err(error) = self.open(event_loop) {
            self.fail(event_loop, error);
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, news: News) {
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
                    // What was said while the window was black.
                    self.message = None;
                }
                self.redraw();
            }
            News::Said(text) => {
                eprintln(&text);
                self.say(&text);
            }
            News::Done(text) => {
                // A reader that has gone away misses it.
                let mut out = std::io::stdout().lock();
                let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
                self.say(&format!("wrote {}", text.lines().next().unwrap_or_default()));
            }
            News::Ended(Ok(())) => event_loop.exit(),
            News::Ended(Err(error)) => self.fail(event_loop, error),
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => self.resized(size),
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.draw() {
                    self.fail(event_loop, error);
                }
            }
            WindowEvent::ScaleFactorChanged { .. } => self.redraw(),
            WindowEvent::ModifiersChanged(modifiers) => self.input.modifiers = modifiers.state(),
            WindowEvent::Focused(false) => {
                // Keys and buttons that are let go elsewhere are not told.
                self.input.keys.clear();
                self.input.buttons.clear();
            }
            WindowEvent::KeyboardInput { event, .. } => self.key(event_loop, &event),
            WindowEvent::CursorMoved { position, .. } => self.drag(position),
            WindowEvent::CursorLeft { .. } if self.input.buttons.is_empty() => self.input.pointer = None,
            WindowEvent::MouseInput { state: ElementState::Pressed, button, .. } => {
                self.input.buttons.insert(button);
            }
            WindowEvent::MouseInput { state: ElementState::Released, button, .. } => {
                self.input.buttons.remove(&button);
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let steps = match delta {
                    MouseScrollDelta::LineDelta(_, y) => f64::from(y),
                    MouseScrollDelta::PixelDelta(by) => by.y / WHEEL_PIXELS,
                };
                self.place(camera::dolly(&self.wanted.sight.sensor, WHEEL.powf(steps)));
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        self.fly();
        let now = Instant::now();
        let rests = self.moved.map(|moved| moved + REST);
        if rests.is_some_and(|rests| now >= rests) {
            self.moved = None;
            self.wanted.moving = false;
            self.link.want(&self.wanted);
        }
        if self.message.as_ref().is_some_and(|(_, until)| now >= *until) {
            self.message = None;
            self.redraw();
        }
        if self.retry.take_if(|retry| now >= *retry).is_some() {
            self.redraw();
        }
        let flies = (!self.input.keys.is_empty()).then(|| now + STEP);
        let message = self.message.as_ref().map(|(_, until)| *until);
        let next = [flies, self.moved.and(rests), message, self.retry].into_iter().flatten().min();
        event_loop.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }
}

/// Says a line on stderr. A stderr that nobody reads is no reason to fail.
fn eprintln(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
