//! `luminaire render --turntable`: the frames are those of the turned camera, those that are finished stay, and what does not go together is refused.

mod common;
#[path = "../../../tests/common/devices.rs"]
mod devices;

use common::running::Running;
use common::{Folder, stderr};
use luminaire::glam::Vec3;
use luminaire::picture;
use luminaire::scene::{Pivot, load};
use std::time::SystemTime;

/// A room with a lamp, in which walls differ; one is open, towards +x.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write(
        "room.obj",
        "mtllib room.mtl\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nusemtl red\nf 1 2 3 4\nf 5 6 7 8\n\
         usemtl green\nf 1 4 8 5\nf 1 2 6 5\nusemtl lamp\nf 4 3 7 8\n",
    );
    folder.write(
        "room.mtl",
        "newmtl red\nKd 0.7 0.2 0.1\nnewmtl green\nKd 0.1 0.5 0.2\nnewmtl lamp\nKd 0.5 0.5 0.5\nKe 2 2 2\n",
    );
    folder.write("room.toml", &scene([3.0, 0.25, 0.5]));
    folder
}

fn scene([x, y, z]: [f32; 3]) -> String {
    format!(
        "[film]\nwidth = 20\nheight = 14\n[sensor]\nposition = [{x:?}, {y:?}, {z:?}]\ntarget = [0.125, 0, 0.25]\nfov = 50\naperture = 0.02\nfocus_distance = 2.5\n\
         [render]\nexposure = \"auto\"\nspp = 4\n[[object]]\nmesh = \"room.obj\"\n"
    )
}

/// Runs the program, which has to succeed; what it said on stdout and stderr.
fn run(folder: &Folder, line: &str) -> [String; 2] {
    let output = folder.luminaire(&line.split(' ').collect::<Vec<_>>()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "luminaire {line}: {}", stderr(&output));
    [String::from_utf8(output.stdout.clone()).unwrap(), stderr(&output)]
}

fn stats(folder: &Folder) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(folder.path().join("s.json")).unwrap()).unwrap()
}

fn written(folder: &Folder, name: &str) -> SystemTime {
    std::fs::metadata(folder.path().join(name)).unwrap().modified().unwrap()
}

/// The frames that a run has rendered, by its figures, and those that it has kept.
fn rendered_and_kept(folder: &Folder) -> [Vec<u64>; 2] {
    let stats = stats(folder);
    let frames = stats["frames"].as_array().unwrap();
    [false, true].map(|kept| {
        let of = frames.iter().filter(|frame| frame["kept"] == kept && frame["figures"].is_null() == kept);
        of.map(|frame| frame["frame"].as_u64().unwrap()).collect()
    })
}

#[test]
fn a_frame_is_the_picture_of_the_turned_camera() {
    let folder = folder();
    let here = luminaire::backend::devices().unwrap_or_default();
    let runs = |backend: &str| {
        here.iter().any(|device| device.backend.is_ok() && (backend != "ray-query" || device.ray_query))
    };
    let sensor = load(&folder.path().join("room.toml")).unwrap().sensor;
    for backend in ["cpu", "compute-bvh", "ray-query"] {
        if backend != "cpu" && !runs(backend) {
            devices::skip(&format!("{backend} cannot run here: its frames were not looked at"));
            continue;
        }
        let rest = format!("--backend {backend} --aov");
        run(&folder, &format!("render room.toml --turntable 7 {rest} -o {backend}-%d.exr"));
        for frame in [0, 2, 6] {
            let turned = sensor.turned(f64::from(frame) / 7.0, Pivot::Target);
            folder.write("turned.toml", &scene(turned.position.to_array()));
            run(&folder, &format!("render turned.toml {rest} -o turned.exr"));
            let pixels = |name: &str| picture::read(&folder.path().join(name)).unwrap();
            let (found, expected) = (pixels(&format!("{backend}-{frame}.exr")), pixels("turned.exr"));
            assert!(found.rgb == expected.rgb && found.error == expected.error, "{backend}, frame {frame}");
        }
        let of = |frame: u32| picture::read(&folder.path().join(format!("{backend}-{frame}.exr"))).unwrap().rgb;
        assert!(of(0) != of(2));
    }
}

#[test]
fn finished_frames_are_kept_and_others_are_rendered() {
    let folder = folder();
    let line = "render room.toml --backend cpu --turntable 5 -o a-%02d.png -o b.exr -o c.hdr --stats s.json";
    let [said, _] = run(&folder, line);
    assert!(said.contains("a-03.png, b-0003.exr, c-0003.hdr: 20 x 14 pixels, 4 samples a pixel"), "{said}");
    assert!(said.contains("5 frames: 5 rendered, 0 kept"), "{said}");
    assert_eq!(rendered_and_kept(&folder), [vec![0, 1, 2, 3, 4], vec![]]);
    let figures = &stats(&folder)["frames"];
    let exposures: Vec<_> = (0..5).map(|frame| figures[frame]["figures"]["exposure"].as_f64().unwrap()).collect();
    assert!(exposures[0] != 0.0 && exposures.iter().all(|stops| *stops == exposures[0]), "{exposures:?}");
    let times = || ["a-01.png", "b-0001.exr", "c-0001.hdr"].map(|name| written(&folder, name));
    let first = times();

    // Nothing to do, also in another way of saying it.
    let [said, noted] = run(&folder, &line.replace("room.toml", "./room.toml"));
    assert!(said.contains("0 rendered, 5 kept") && noted.contains("5 of 5 frames are there already"), "{said}{noted}");
    assert!(!noted.contains("cpu on"), "no device is opened: {noted}");
    // One that is missing, one that is damaged, one of which a file is another picture.
    std::fs::remove_file(folder.path().join("b-0002.exr")).unwrap();
    let bytes = std::fs::read(folder.path().join("a-03.png")).unwrap();
    std::fs::write(folder.path().join("a-03.png"), &bytes[..bytes.len() - 30]).unwrap();
    std::fs::copy(folder.path().join("a-01.png"), folder.path().join("a-04.png")).unwrap();
    run(&folder, line);
    assert_eq!(rendered_and_kept(&folder), [vec![2, 3, 4], vec![0, 1]]);
    assert_eq!(std::fs::read(folder.path().join("a-03.png")).unwrap(), bytes);
    assert_eq!(times(), first, "what is kept is not touched");

    // What shows in a picture is rendered anew, and what does not is not.
    run(&folder, &format!("{line} --quiet"));
    assert!(rendered_and_kept(&folder)[0].is_empty());
    for change in [" --spp 5", " --spp 5 --seed 1", " --spp 5 --tone agx", " --spp 5 --width 10", " --estimator cosine"]
    {
        run(&folder, &format!("{line}{change}"));
        assert_eq!(rendered_and_kept(&folder), [vec![0, 1, 2, 3, 4], vec![]], "{change}");
    }
    assert!(times() > first);
    let turn = line.replace("--turntable 5", "--turntable 6");
    run(&folder, &turn);
    assert_eq!(rendered_and_kept(&folder)[0].len(), 6, "another turn has other cameras");
    // Another backend gives the same picture, but for rounding.
    run(&folder, &turn.replace("--backend cpu", "--backend auto"));
    assert_eq!(rendered_and_kept(&folder)[1].len(), 6);
    // Linear pictures do not depend on how others are shown.
    run(&folder, "render room.toml --backend cpu --turntable 3 -o d.exr --stats s.json");
    run(&folder, "render room.toml --backend cpu --turntable 3 -o d.exr --stats s.json --tone agx --exposure 3");
    assert_eq!(rendered_and_kept(&folder), [vec![], vec![0, 1, 2]]);
    run(&folder, "render room.toml --backend cpu --turntable 3 -o d.exr --stats s.json --aov");
    assert_eq!(rendered_and_kept(&folder), [vec![0, 1, 2], vec![]]);
}

#[test]
fn machines_share_a_turn() {
    let folder = folder();
    run(&folder, "render room.toml --backend cpu --turntable 4 -o whole-%d.png");
    run(&folder, "render room.toml --backend cpu --turntable 4 --frames 0..1 -o part-%d.png");
    run(&folder, "render room.toml --backend cpu --turntable 4 --frames 1..4 -o part-%d.png");
    for frame in 0..4 {
        let bytes = |name: &str| std::fs::read(folder.path().join(format!("{name}-{frame}.png"))).unwrap();
        assert_eq!(bytes("whole"), bytes("part"), "frame {frame}");
    }
    // The name that nobody gave.
    let [said, _] = run(&folder, "render room.toml --backend cpu --turntable 4 --frames 2..3");
    assert!(said.contains("room-0002.png: ") && said.contains("1 frame: 1 rendered"), "{said}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = folder();
    folder.write("room-0001.png", "precious");
    folder.write("textured.toml", "[[object]]\nmesh = \"good.obj\"\n[environment]\nimage = \"sky-0001.png\"\n");
    image::RgbImage::new(2, 1).save(folder.path().join("sky-0001.png")).unwrap();
    let before = folder.names();
    for (line, part) in [
        ("room.toml --turntable 0", "from 1 to 10000"),
        ("room.toml --turntable 3.5", "from 1 to 10000"),
        ("room.toml --frames 0..2", "--turntable"),
        ("room.toml --turntable 4 --frames 2..5", "the frames 0 to 3"),
        ("room.toml --turntable 4 --frames 2", "0..60 or 60..120"),
        ("room.toml --turntable 4 --frames 3..3", "0..60 or 60..120"),
        ("room.toml --turntable 4 --checkpoint c.exr -o a.png", "kept by the same command"),
        ("room.toml --turntable 4 --samples 0..2 -o a.exr", "--frames A..B"),
        ("room.toml --turntable 4 --error-map e.png -o a.png", "render that alone"),
        ("room.toml --turntable 4 --pixel 0,0 --sample 0", "--turntable"),
        ("room.toml --turntable 4 -o a-%s.png", "`%s` is no number"),
        ("room.toml --turntable 4 -o a-%d.jpg", "choose .png"),
        ("room.toml --turntable 4 -o a-%d.png -o ./a-%1d.png", "the same file"),
        ("room.toml --turntable 4 -o a-%d.png --aov", "EXR"),
        ("room.toml --turntable 4", "room-0001.png: there is a file of this name"),
        ("textured.toml --turntable 4 -o sky.png", "a file of the scene"),
        ("textured.toml --turntable 4 -o sky-%04d.png", "a file of the scene"),
        ("room.toml --orbit 4", "--turntable N"),
        ("room.toml --turntable -3", "from 1 to 10000"),
        ("room.toml --turntable --aov", "a value is required for '--turntable"),
        ("room.toml --turntable 4 --frames -1..2", "0..60 or 60..120"),
        ("room.toml --turntable 4 --frames=-1..2", "0..60 or 60..120"),
        ("room.toml --turntable 4 -o a-%4d.png", "say %04d"),
        ("room.toml --pivot camera", "--turntable"),
        ("room.toml --turntable 4 --pivot moon", "auto, target, camera"),
    ] {
        let words: Vec<&str> = ["render"].into_iter().chain(line.split(' ')).collect();
        let output = folder.luminaire(&words).output().unwrap();
        let said = stderr(&output);
        assert!(output.status.code() == Some(2) && said.contains(part), "{line} said:\n{said}");
        assert_eq!(folder.names(), before, "{line}");
    }
    assert_eq!(std::fs::read(folder.path().join("room-0001.png")).unwrap(), b"precious");
}

/// A closed room, its lamp the ceiling, and the camera in it at an end: it looks around, whoever renders which frames, unless it is to go around.
#[test]
fn in_a_room_the_camera_turns_on_the_spot() {
    let folder = folder();
    let mesh = std::fs::read_to_string(folder.path().join("room.obj")).unwrap();
    folder.write("closed.obj", &(mesh + "usemtl green\nf 2 3 7 6\n"));
    let closed = |position: Vec3, target: Vec3| {
        let [[x, y, z], [a, b, c]] = [position.to_array(), target.to_array()];
        format!(
            "[film]\nwidth = 8\nheight = 6\n[sensor]\nposition = [{x:?}, {y:?}, {z:?}]\ntarget = [{a:?}, {b:?}, {c:?}]\nfov = 50\n[render]\nspp = 2\n\
             [[object]]\nmesh = \"closed.obj\"\n"
        )
    };
    let (position, target) = (Vec3::new(0.75, 0.25, 0.5), Vec3::new(-0.75, 0.0, 0.25));
    folder.write("closed.toml", &closed(position, target));
    let note = "the camera stands in a room: it turns on the spot";
    let [_, said] = run(&folder, "render closed.toml --backend cpu --turntable 5 -o a-%d.exr --stats s.json");
    assert!(said.contains(note) && !said.contains("warning"), "{said}");
    assert_eq!(stats(&folder)["pivot"], "camera");
    let [_, said] = run(&folder, "render closed.toml --backend cpu --turntable 5 --frames 3..4 -o b-%d.exr");
    assert!(said.contains(note), "{said}");
    let sensor = load(&folder.path().join("closed.toml")).unwrap().sensor;
    folder.write("turned.toml", &closed(position, sensor.turned(0.6, Pivot::Position).target));
    run(&folder, "render turned.toml --backend cpu -o c.exr");
    let pixels = |name: &str| picture::read(&folder.path().join(name)).unwrap().rgb;
    assert!(pixels("a-3.exr") == pixels("b-3.exr") && pixels("a-3.exr") == pixels("c.exr"));

    // Other frames than these are on the way around, of which nothing is said to somebody who asks for it.
    let line = "render closed.toml --backend cpu --turntable 5 -o a-%d.exr --stats s.json --pivot";
    let [said, noted] = run(&folder, &format!("{line} target"));
    assert!(said.contains("4 rendered, 1 kept") && !noted.contains("on the spot"), "{said}{noted}");
    assert!(stats(&folder)["pivot"] == "target" && pixels("a-3.exr") != pixels("b-3.exr"));
    let [said, _] = run(&folder, &format!("{line} camera"));
    assert!(said.contains("4 rendered, 1 kept") && pixels("a-3.exr") == pixels("b-3.exr"), "{said}");
    // Through the open side from outside: around, and those frames are named that look at walls.
    let [_, said] = run(&folder, "render room.toml --backend cpu --turntable 4 -o d-%d.png");
    assert!(
        said.contains("warning: room.toml: on its turn the camera comes to where something stands before its target"),
        "{said}"
    );
    assert!(said.contains("about frames 1 to 3 of 0 to 3"), "{said}");
}

#[test]
fn a_number_in_a_name_of_one_picture_is_noted() {
    let folder = folder();
    let line = "render room.toml --backend cpu --width 4 --spp 1 -o";
    let [_, said] = run(&folder, &format!("{line} one%d.png"));
    assert!(
        said.contains("one%d.png: one picture has no number") && folder.path().join("one%d.png").exists(),
        "{said}"
    );
    assert!(!run(&folder, &format!("{line} 100%.png"))[1].contains("number"));
}

#[test]
fn a_lost_device_leaves_what_is_finished() {
    let folder = folder();
    let words = ["render", "room.toml", "--backend", "cpu", "--turntable", "3", "-o", "a-%d.png", "--stats", "s.json"];
    run(&folder, "render room.toml --backend cpu --turntable 3 --frames 1..2 -o a-%d.png");
    let first = written(&folder, "a-1.png");
    let output = folder.luminaire(&words).env("LUMINAIRE_LOSE_DEVICE_AFTER", "0").output().unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("device is lost") && said.contains("1 of 3 frames are finished"), "{said}");
    assert_eq!((&stats(&folder)["end"], rendered_and_kept(&folder)), (&"failed".into(), [vec![], vec![1]]));
    assert_eq!(written(&folder, "a-1.png"), first);
    assert!(!folder.path().join("a-0.png").exists());
    assert!(folder.luminaire(&words).status().unwrap().success());
    assert_eq!(rendered_and_kept(&folder), [vec![0, 2], vec![1]]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_what_is_finished() {
    let folder = folder();
    // More samples where a machine was at the end before the signal came.
    for spp in [50, 400, 3000, 20_000] {
        let spp = spp.to_string();
        let words = ["render", "room.toml", "--backend", "cpu", "--turntable", "60", "-o", "a-%d.png", "--spp", &spp];
        let program = Running::start(&mut folder.luminaire(&words));
        program.until("the second frame", || folder.path().join("a-1.png").exists().then_some(()));
        // The shell's own `kill`: a bare system has no other.
        let signal = format!("kill -s INT {}", program.id());
        let signalled = std::process::Command::new("sh").args(["-c", &signal]).status();
        assert!(signalled.unwrap().success());
        let output = program.output();
        if output.status.code() == Some(0) {
            continue;
        }
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(130), "{said}");
        assert!(said.contains("of 60 frames are finished: the same command goes on"), "{said}");
        let finished = folder.names().iter().filter(|name| name.starts_with("a-")).count();
        assert!((2..60).contains(&finished) && !folder.names().iter().any(|name| name.ends_with(".tmp")));
        for frame in 0..finished {
            let name = format!("a-{frame}.png");
            assert!(picture::read(&folder.path().join(&name)).is_ok(), "{name}");
        }
        return;
    }
    panic!("the renders are too short to be interrupted");
}
