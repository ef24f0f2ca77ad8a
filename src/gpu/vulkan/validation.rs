//! What the validation layer has to say.

use ash::vk;
use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The layer that checks every call.
pub(in crate::gpu) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Counts the messages.
static VALIDATION_MESSAGES: AtomicUsize = AtomicUsize::new(0);

/// Warnings and errors that the validation layer has given in this process so far. Zero without the layer, which
/// `LUMINAIRE_VALIDATION=1` switches on.
pub fn validation_messages() -> usize {
    VALIDATION_MESSAGES.load(Ordering::SeqCst)
}

/// Asks for warnings and errors of the validation layer; [`on_message`] gets them.
pub(in crate::gpu) fn messenger_info() -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR)
        .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE)
        .pfn_user_callback(Some(on_message))
}

/// Prints and counts a validation message.
///
/// # Safety
/// Called by Vulkan with a valid callback structure.
unsafe extern "system" fn on_message(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    _user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan passes a valid structure whose strings are null or NUL-terminated.
    let message = unsafe { (*data).message_as_c_str() }.unwrap_or(c"?");
    eprintln!("Vulkan validation ({severity:?}): {}", message.to_string_lossy());
    VALIDATION_MESSAGES.fetch_add(1, Ordering::SeqCst);
    vk::FALSE
}
