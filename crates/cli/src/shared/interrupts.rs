//! What Ctrl-C and SIGTERM do to a run.

use crate::shared::exit_codes::INTERRUPTED;
use crate::shared::printing::Notes;
use luminaire::{Error, Result};
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by the first interrupt of a render: it ends at the next batch.
pub static STOP: AtomicBool = AtomicBool::new(false);

/// True while there may be something to write after an interrupt.
static RENDERING: AtomicBool = AtomicBool::new(false);

/// True while files are written, which an exit would leave half done beside their targets.
static WRITING: AtomicBool = AtomicBool::new(false);

/// Handles interrupts from now on. While files are written ([`hold_off`]), they do nothing; while a render runs ([`render_begins`]), the first one
/// stops it; otherwise they end the process. A usage error if there is a handler already.
pub fn listen(notes: Notes) -> Result<()> {
    ctrlc::set_handler(move || {
        if WRITING.load(Ordering::SeqCst) {
            return;
        }
        let at_once = !RENDERING.load(Ordering::SeqCst) || STOP.swap(true, Ordering::SeqCst);
        notes.note(if at_once {
            "interrupted; nothing is written"
        } else {
            "interrupted: finishing the batch and writing what there is; once more ends at once"
        });
        if at_once {
            exit_now();
        }
    })
    .map_err(|e| Error::Usage(format!("cannot listen for Ctrl-C: {e}")))
}

/// From now on the first interrupt sets [`STOP`], so that what has been rendered can be written; a second one ends the process.
pub fn render_begins() {
    RENDERING.store(true, Ordering::SeqCst);
}

/// Runs `write`, which writes files; interrupts do nothing meanwhile.
pub fn hold_off<T>(write: impl FnOnce() -> T) -> T {
    WRITING.store(true, Ordering::SeqCst);
    let written = write();
    WRITING.store(false, Ordering::SeqCst);
    written
}

/// Ends the process without the clean-up of libraries, in which a driver that is just being loaded could crash.
fn exit_now() -> ! {
    #[cfg(unix)]
    signal_hook::low_level::exit(INTERRUPTED.into());
    #[cfg(not(unix))]
    std::process::exit(INTERRUPTED.into());
}
