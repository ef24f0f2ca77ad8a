//! What Ctrl-C and SIGTERM do to a run.

use crate::shared::exit_codes::INTERRUPTED;
use crate::shared::printing::Notes;
use luminaire::{Error, Result, files};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, TryLockError};

/// Set by the first interrupt of a render: it ends at the next batch.
pub static STOP: AtomicBool = AtomicBool::new(false);

/// True while there may be something to write after an interrupt.
static RENDERING: AtomicBool = AtomicBool::new(false);

/// True once the checkpoint holds what this run has rendered, or the most of it.
static SAVED: AtomicBool = AtomicBool::new(false);

/// True once a frame of a sequence is written.
static FRAMES: AtomicBool = AtomicBool::new(false);

/// Held while files are written, which an exit would leave half done beside their targets; and by an exit, so that none is begun.
static WRITING: Mutex<()> = Mutex::new(());

/// Handles interrupts from now on. While files are written ([`hold_off`]), they only set [`STOP`]; while a render runs ([`render_begins`]), the first one
/// stops it; otherwise they end the process. A usage error if there is a handler already.
pub fn listen(notes: Notes) -> Result<()> {
    ctrlc::set_handler(move || {
        let guard = WRITING.try_lock();
        let writing = matches!(guard, Err(TryLockError::WouldBlock));
        let again = STOP.swap(true, Ordering::SeqCst);
        let at_once = !writing && (again || !RENDERING.load(Ordering::SeqCst));
        if at_once {
            notes.note(if SAVED.load(Ordering::SeqCst) {
                "interrupted; no picture is written, but the checkpoint is saved: the same command with --resume goes on from it"
            } else if FRAMES.load(Ordering::SeqCst) {
                "interrupted; the frames that are finished stay: the same command goes on with the others"
            } else {
                "interrupted; nothing is written"
            });
            exit_now();
        } else if !again {
            notes.note(if writing {
                "interrupted: what is being written is finished first"
            } else {
                "interrupted: finishing the batch and writing what there is; once more ends at once"
            });
        }
    })
    .map_err(|e| Error::Usage(format!("cannot listen for Ctrl-C: {e}")))
}

/// From now on the first interrupt sets [`STOP`], so that what has been rendered can be written; a second one ends the process.
pub fn render_begins() {
    RENDERING.store(true, Ordering::SeqCst);
}

/// The checkpoint is complete: an interrupt that ends the process at once costs only what came after.
pub fn saved() {
    SAVED.store(true, Ordering::SeqCst);
}

/// A frame is written: an interrupt that ends the process at once costs only what came after.
pub fn frame_written() {
    FRAMES.store(true, Ordering::SeqCst);
}

/// Runs `write`, which writes files; interrupts end nothing meanwhile.
pub fn hold_off<T>(write: impl FnOnce() -> T) -> T {
    // A panic while it was held leaves nothing half done that it guards.
    let _guard = WRITING.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    write()
}

/// Ends the process without the clean-up of libraries, in which a driver that is just being loaded could crash.
fn exit_now() -> ! {
    files::let_go_of_all();
    #[cfg(unix)]
    signal_hook::low_level::exit(INTERRUPTED.into());
    #[cfg(not(unix))]
    std::process::exit(INTERRUPTED.into());
}
