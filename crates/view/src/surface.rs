//! The Vulkan surface of a window: what a device presents pictures to.

use ash::{khr, vk};
use luminaire::gpu::Instance;
use luminaire::{Error, Result};
use std::ffi::CStr;
use std::sync::Arc;
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

/// What helps where a window cannot be filled.
pub const ADVICE: &str = "install a Vulkan driver that can present (Debian and Ubuntu: mesa-vulkan-drivers), or use `luminaire render`, which needs no window";

/// A window's surface.
pub struct Surface {
    pub(super) raw: vk::SurfaceKHR,
    pub(super) calls: khr::surface::Instance,
    pub(super) instance: Arc<Instance>,
    // Declared after the surface, which refers to it.
    pub(super) window: Arc<Window>,
}

impl Surface {
    /// The surface of a window, with an instance for its kind of display.
    ///
    /// # Errors
    /// If there is no Vulkan, or none for such windows.
    pub fn of(window: &Arc<Window>) -> Result<Self> {
        let display =
            window.display_handle().map_err(|e| Error::NoDevice(format!("the window has no display: {e}")))?;
        let extensions = ash_window::enumerate_required_extensions(display.as_raw())
            .map_err(|e| Error::NoDevice(format!("Vulkan knows no such windows ({e}): {ADVICE}")))?;
        // SAFETY: ash-window gives the names of extensions, which are constants and NUL-terminated.
        let extensions: Vec<&'static CStr> = extensions.iter().map(|name| unsafe { CStr::from_ptr(*name) }).collect();
        let instance = Instance::with_extensions(&extensions).map_err(with_advice)?;
        Self::new(&instance, window)
    }

    /// `instance` has the extensions of the window's display.
    fn new(instance: &Arc<Instance>, window: &Arc<Window>) -> Result<Self> {
        let failed = |reason: String| Error::NoDevice(format!("the window cannot be drawn into ({reason}): {ADVICE}"));
        let display = window.display_handle().map_err(|e| failed(e.to_string()))?.as_raw();
        let handle = window.window_handle().map_err(|e| failed(e.to_string()))?.as_raw();
        // SAFETY: the instance was made with the extensions of this display, and the window, which the surface keeps, outlives it.
        let raw = unsafe { ash_window::create_surface(&instance.entry, &instance.raw, display, handle, None) }
            .map_err(|e| failed(e.to_string()))?;
        let calls = khr::surface::Instance::new(&instance.entry, &instance.raw);
        Ok(Surface { raw, calls, instance: instance.clone(), window: window.clone() })
    }

    /// Makes the surface anew, because it was lost.
    ///
    /// # Errors
    /// If the window cannot be drawn into any more.
    ///
    /// # Safety
    /// Its swapchain is gone.
    pub unsafe fn renew(&mut self) -> Result<()> {
        let (instance, window) = (self.instance.clone(), self.window.clone());
        // Windows have one surface at a time: the old one goes first.
        // SAFETY: the caller's promise. A null handle takes its place, which `drop` may destroy again.
        unsafe { self.calls.destroy_surface(self.raw, None) };
        self.raw = vk::SurfaceKHR::null();
        *self = Surface::new(&instance, &window)?;
        Ok(())
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: the handle is null, or every swapchain of it is gone: the presenter drops its chain first.
        unsafe { self.calls.destroy_surface(self.raw, None) };
    }
}

/// An error of Vulkan with the advice that `luminaire render` needs no window.
pub fn with_advice(error: Error) -> Error {
    match error {
        Error::NoDevice(reason) => Error::NoDevice(format!("a window needs Vulkan: {reason}; or: {ADVICE}")),
        other => other,
    }
}
