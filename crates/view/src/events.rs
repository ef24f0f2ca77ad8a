//! Hands each event of the window system to the part of the [`App`] that it concerns.

use super::app::App;
use super::input::{Input, wheel};
use super::keys::action;
use super::news::News;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::PhysicalKey;
use winit::window::WindowId;

impl ApplicationHandler<News> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if let Err(error) = self.open(event_loop) {
            self.fail(event_loop, error);
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, news: News) {
        self.receive(event_loop, news);
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => self.resize(size),
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.draw() {
                    self.fail(event_loop, error);
                }
            }
            WindowEvent::ScaleFactorChanged { .. } => self.redraw(),
            WindowEvent::ModifiersChanged(modifiers) => self.input.modify(modifiers.state()),
            WindowEvent::Focused(false) => self.input.let_go(),
            WindowEvent::KeyboardInput { event, .. } => key(self, event_loop, &event),
            WindowEvent::CursorMoved { position, .. } => {
                let sight = &self.wanted.sight;
                if let Some(sensor) = self.input.drag(position, &sight.sensor, sight.film.height) {
                    self.place(sensor);
                }
            }
            WindowEvent::CursorLeft { .. } => self.input.leave(),
            WindowEvent::MouseInput { state, button, .. } => self.input.button(button, state == ElementState::Pressed),
            WindowEvent::MouseWheel { delta, .. } => self.place(wheel(delta, &self.wanted.sight.sensor)),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let next = self.pass_time();
        event_loop.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }
}

/// A key was pressed or let go.
fn key(app: &mut App, event_loop: &ActiveEventLoop, event: &KeyEvent) {
    let pressed = event.state == ElementState::Pressed;
    match event.physical_key {
        PhysicalKey::Code(code) if Input::is_to_fly(code) => app.input.key(code, pressed),
        _ if pressed => {
            if let Some(action) = action(event.logical_key.as_ref(), event.repeat) {
                app.act(event_loop, action);
            }
        }
        _ => {}
    }
}
