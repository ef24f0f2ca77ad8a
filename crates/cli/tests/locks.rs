//! Two jobs never write one checkpoint, nor one part; and a job that was killed is in nobody's way.

mod common;

use common::{Folder, stderr};
use std::process::Child;
use std::time::Duration;

const CHECKPOINT: [&str; 5] = ["--checkpoint", "c.exr", "--checkpoint-every", "0.01", "--resume"];

/// A job that is killed when a test ends, however it does.
struct Job(Child);

impl Job {
    /// Kills it as a power cut does.
    fn kill(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Drop for Job {
    fn drop(&mut self) {
        self.kill();
    }
}

/// A render that lasts until it is killed, once it has a checkpoint.
fn endless(folder: &Folder, more: &[&str]) -> Job {
    let words = ["render", "good.obj", "--backend", "cpu", "--width", "16", "--quiet", "-o", "a.exr"];
    let mut job = Job(folder.luminaire(&[&words[..], &CHECKPOINT, more].concat()).spawn().unwrap());
    for _ in 0..6000 {
        if folder.path().join("c.exr").exists() {
            return job;
        }
        assert!(job.0.try_wait().unwrap().is_none(), "the render has ended");
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("there is no checkpoint after a minute");
}

#[test]
fn one_checkpoint_is_one_jobs() {
    let folder = Folder::new();
    let mut first = endless(&folder, &["--time", "600"]);
    let process = format!("process {} on ", first.0.id());
    let words = ["render", "good.obj", "--backend", "cpu", "--width", "16", "--quiet", "--spp", "4", "-o", "b.exr"];
    for name in ["c.exr", "./c.exr"] {
        let more = ["--checkpoint", name, "--resume"];
        let output = folder.luminaire(&[&words[..], &more].concat()).output().unwrap();
        let said = stderr(&output);
        assert!(output.status.code() == Some(1) && said.contains(&process) && said.contains("c.exr.lock"), "{said}");
    }
    assert!(!folder.path().join("b.exr").exists());
    // Killed as a power cut does: the lock file stays, and nobody holds it.
    first.kill();
    assert!(folder.path().join("c.exr.lock").exists());
    let output = folder.luminaire(&[&words[..], &CHECKPOINT].concat()).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(
        !folder.names().iter().any(|name| name.ends_with(".lock") || name.ends_with(".tmp")),
        "{:?}",
        folder.names()
    );
}

#[test]
fn one_part_is_one_jobs() {
    let folder = Folder::new();
    let mut first = endless(&folder, &["--samples", "0..4000000000"]);
    let words = ["render", "good.obj", "--backend", "cpu", "--width", "16", "--quiet", "--samples", "0..4"];
    let job = |name: &str| folder.luminaire(&[&words[..], &["-o", name]].concat()).output().unwrap();
    let output = job("a.exr");
    assert!(output.status.code() == Some(1) && stderr(&output).contains("a.exr.lock"), "{}", stderr(&output));
    assert!(job("b.exr").status.success());
    first.kill();
    assert!(job("a.exr").status.success());
}

#[test]
fn a_file_in_the_locks_place_is_spared() {
    let folder = Folder::new();
    folder.write("c.exr.lock", "precious");
    let words = ["render", "good.obj", "--backend", "cpu", "--width", "8", "--spp", "2", "-o", "a.png"];
    let output = folder.luminaire(&[&words[..], &CHECKPOINT].concat()).output().unwrap();
    let said = stderr(&output);
    assert!(output.status.code() == Some(1) && said.contains("c.exr.lock") && said.contains("rename it"), "{said}");
    assert_eq!(std::fs::read_to_string(folder.path().join("c.exr.lock")).unwrap(), "precious");
    assert!(!folder.path().join("a.png").exists());
}

#[cfg(unix)]
#[test]
fn a_link_has_the_lock_of_what_it_leads_to() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("far")).unwrap();
    symlink("far/real.exr", folder.path().join("c.exr")).unwrap();
    // At first the link leads nowhere, and then to what was saved.
    let lock = folder.path().join("far/real.exr.lock");
    for _ in 0..2 {
        let _ = std::fs::remove_file(&lock);
        let mut first = endless(&folder, &["--time", "600"]);
        // The second time the checkpoint is there before the job has its lock.
        let start = std::time::Instant::now();
        while std::fs::read(&lock).is_ok_and(|text| text.is_empty()) || !lock.exists() {
            assert!(start.elapsed().as_secs() < 60, "no lock");
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        assert!(folder.path().join("c.exr").is_symlink() && folder.path().join("far/real.exr").is_file());
        let words = ["render", "good.obj", "--backend", "cpu", "--width", "16", "--quiet", "--spp", "4", "-o", "b.exr"];
        for name in ["c.exr", "far/real.exr"] {
            let more = ["--checkpoint", name, "--resume"];
            let output = folder.luminaire(&[&words[..], &more].concat()).output().unwrap();
            let said = stderr(&output);
            assert!(output.status.code() == Some(1) && said.contains("real.exr.lock"), "{name}: {said}");
        }
        first.kill();
    }
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_no_lock() {
    let folder = Folder::new();
    // It takes a while to load.
    let mut text = "mtllib good.mtl\nusemtl lamp\n".to_owned();
    for n in 0..100_000 {
        text += &format!("v {n} 0 0\nv {n} 1 0\nv {n} 0 1\nf -1 -2 -3\n");
    }
    folder.write("large.obj", &text);
    let words = ["render", "large.obj", "--backend", "cpu", "--width", "16", "--time", "600", "-o", "a.exr"];
    let mut job = Job(folder.luminaire(&[&words[..], &CHECKPOINT].concat()).spawn().unwrap());
    while !folder.path().join("c.exr.lock").exists() {
        assert!(job.0.try_wait().unwrap().is_none(), "the render has ended");
        std::thread::sleep(Duration::from_millis(1));
    }
    let signal = format!("kill -s INT {}", job.0.id());
    assert!(std::process::Command::new("sh").args(["-c", &signal]).status().unwrap().success());
    assert_eq!(job.0.wait().unwrap().code(), Some(130));
    assert!(!folder.names().iter().any(|name| name.ends_with(".lock")), "{:?}", folder.names());
}
