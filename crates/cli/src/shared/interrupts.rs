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

/// Listens: an interrupt ends the process, unless a render runs ([`render_begins`]), which the first one stops, or files are written
/// ([`hold_off`]), when it does nothing. A usage error if something else listens already.
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

/// Writes files, which no interrupt cuts short.
pub fn hold_off<T>(write: impl FnOnce() -> T) -> T {
    WRITING.store(true, Ordering::SeqCst);
    let written = write();
    WRITING.store(false, Ordering::SeqCst);
    written
}

/// Ends the process without the clean-up of libraries: a driver that is just being loaded does not survive that.
fn exit_now() -> ! {
    #[cfg(unix)]
    signal_hook::low_level::exit(INTERRUPTED.into());
    #[cfg(not(unix))]
    std::process::exit(INTERRUPTED.into());
}
