//! `luminaire render --watch`: render again whenever a shader changes, for those who change them.

use crate::shared::printing::{self, note};
use luminaire::{Result, gpu};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime};

/// Runs `render` over and over, each time that a file in the shaders' folder changes; a change stops a running render (by
/// `stop`, which Ctrl-C sets too). What fails to compile is printed, and the next change awaited. Ends with Ctrl-C.
pub fn repeat(stop: &'static AtomicBool, render: &dyn Fn() -> Result<ExitCode>) -> Result<ExitCode> {
    static CHANGED: AtomicBool = AtomicBool::new(false);
    let folder = gpu::shader_folder();
    note(&format!("watching {}; Ctrl-C ends", folder.display()));
    let newest = move || -> Option<SystemTime> {
        let files = std::fs::read_dir(&folder).ok()?.filter_map(|f| f.ok()?.metadata().ok()?.modified().ok());
        files.max()
    };
    std::thread::spawn(move || {
        let mut last = newest();
        loop {
            std::thread::sleep(Duration::from_millis(200));
            let now = newest();
            if now != last {
                last = now;
                CHANGED.store(true, Ordering::SeqCst);
                stop.store(true, Ordering::SeqCst);
            }
        }
    });
    loop {
        let outcome = render();
        if let Err(e) = &outcome {
            printing::error(e);
        }
        while !stop.load(Ordering::SeqCst) {
            std::thread::sleep(Duration::from_millis(100));
        }
        if !CHANGED.swap(false, Ordering::SeqCst) {
            return outcome;
        }
        stop.store(false, Ordering::SeqCst);
        note("a shader changed");
    }
}
