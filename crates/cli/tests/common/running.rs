//! A program that a test waits for. It gets time for as long as it works; where it ends too early or does nothing, the test shows what it said.

use std::cell::RefCell;
use std::fs::File;
use std::process::{Child, Command, ExitStatus, Output};
use std::time::{Duration, Instant};

/// A program that uses no processor for so long waits for something that does not come. A busy machine gives every program some of it.
const IDLE: Duration = Duration::from_secs(60);
/// Nothing that a test waits for takes so long, however busy the machine is.
const END: Duration = Duration::from_secs(600);
/// At most, between two looks; at first less, so that a short program is seen at its work.
const PAUSE: Duration = Duration::from_millis(30);

/// A program that runs, and ends with this. What it says goes to files, so that it never waits for a reader.
pub struct Running {
    child: RefCell<Child>,
    name: String,
    said: tempfile::TempDir,
}

impl Running {
    /// Starts it.
    pub fn start(command: &mut Command) -> Self {
        let said = tempfile::tempdir().unwrap();
        let file = |name: &str| File::create(said.path().join(name)).unwrap();
        let child = command.stdout(file("stdout")).stderr(file("stderr")).spawn();
        let child = child.unwrap_or_else(|error| panic!("{command:?} cannot be started: {error}"));
        Running { child: RefCell::new(child), name: format!("{command:?}"), said }
    }

    /// Its number.
    pub fn id(&self) -> u32 {
        self.child.borrow().id()
    }

    /// How it ended, if it did.
    pub fn ended(&self) -> Option<ExitStatus> {
        self.child.borrow_mut().try_wait().unwrap()
    }

    /// Waits until `happens` gives something. Panics if the program ends before that, does nothing, or takes for ever.
    pub fn until<T>(&self, what: &str, happens: impl Fn() -> Option<T>) -> T {
        let reason = match self.wait_until(happens) {
            Ok(found) => return found,
            Err(reason) => reason,
        };
        panic!("never came: {what}: {reason}\n{}", self.state())
    }

    /// Waits until `happens` gives something; else the reason why that is not waited for any longer.
    pub fn wait_until<T>(&self, happens: impl Fn() -> Option<T>) -> Result<T, &'static str> {
        let start = Instant::now();
        let mut worked = (self.processor_time(), start);
        loop {
            // Before the look: what a program does last still counts.
            let ended = self.ended().is_some();
            if let Some(found) = happens() {
                return Ok(found);
            }
            let time = self.processor_time();
            if time != worked.0 {
                worked = (time, Instant::now());
            }
            if ended {
                return Err("the program ended");
            } else if time.is_some() && worked.1.elapsed() > IDLE {
                return Err("the program did nothing for a minute");
            } else if start.elapsed() > END {
                return Err("the program took ten minutes");
            }
            std::thread::sleep((start.elapsed() / 16).clamp(Duration::from_millis(1), PAUSE));
        }
    }

    /// What it said, and whether it runs: for the message of a test that fails.
    pub fn state(&self) -> String {
        let state = self.ended().map_or("it still runs".to_owned(), |status| format!("it ended with {status}"));
        let text = |name: &str| String::from_utf8_lossy(&self.read(name)).into_owned();
        format!("{}\n{state}; stdout:\n{}\nstderr:\n{}", self.name, text("stdout"), text("stderr"))
    }

    /// What it said on stdout so far.
    pub fn stdout(&self) -> String {
        String::from_utf8_lossy(&self.read("stdout")).into_owned()
    }

    /// Waits for its end; what it said.
    pub fn output(self) -> Output {
        let status = self.until("its end", || self.ended());
        Output { status, stdout: self.read("stdout"), stderr: self.read("stderr") }
    }

    /// Ends it at once, as `kill -9` does.
    pub fn kill(&self) {
        let mut child = self.child.borrow_mut();
        let _ = child.kill();
        let _ = child.wait();
    }

    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.said.path().join(name)).unwrap_or_default()
    }

    /// Processor time in ticks, where the system says it (Linux: the fields `utime` and `stime` of `proc(5)`).
    fn processor_time(&self) -> Option<u64> {
        let line = std::fs::read_to_string(format!("/proc/{}/stat", self.id())).ok()?;
        // After the name, which may hold anything and ends with the last parenthesis, `state` is field 3.
        let fields: Vec<&str> = line.rsplit_once(')')?.1.split_whitespace().collect();
        Some(fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.kill();
    }
}
