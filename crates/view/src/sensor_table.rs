//! Writes a camera as the `[sensor]` table of a scene file, and how its pictures are shown.

use glam::DVec3;
use luminaire::picture::Development;
use luminaire::scene::{Projection, Sensor};

/// The table of a sensor of a scene with this origin, in the coordinates of the files, and that of exposure and tone curve; read back, they are the same to the
/// last bit.
pub fn to_toml(sensor: &Sensor, origin: DVec3, how: Development) -> String {
    // `{:?}` writes the fewest digits that are read back as the same number.
    let vector = |v: glam::Vec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
    let point = |v: glam::Vec3| {
        if origin == DVec3::ZERO {
            return vector(v);
        }
        let DVec3 { x, y, z } = v.as_dvec3() + origin;
        format!("[{x:?}, {y:?}, {z:?}]")
    };
    let (kind, extent) = match sensor.projection {
        Projection::Perspective { fov } => ("perspective", format!("fov = {fov:?}")),
        Projection::Orthographic { height } => ("orthographic", format!("height = {height:?}")),
    };
    let mut text = format!(
        "[sensor]\nkind = \"{kind}\"\nposition = {}\ntarget = {}\nup = {}\n{extent}\n",
        point(sensor.position),
        point(sensor.target),
        vector(sensor.up)
    );
    if let Some(lens) = sensor.lens {
        text += &format!("aperture = {:?}\nfocus_distance = {:?}\n", lens.radius, lens.focus_distance);
        if lens.blades > 0 {
            text += &format!("blades = {}\nblade_rotation = {:?}\n", lens.blades, lens.rotation);
        }
    }
    if sensor.shift != glam::Vec2::ZERO {
        text += &format!("shift = [{:?}, {:?}]\n", sensor.shift.x, sensor.shift.y);
    }
    let Development { exposure, tone } = how;
    text + &format!("[render]\nexposure = {exposure:?}\ntone = \"{}\"\n", tone.name())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};
    use luminaire::scene::{Exposure, Lens, Tone, load};

    #[test]
    fn a_written_camera_is_read_back_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let lens = Lens { radius: 0.1, focus_distance: 3.3, blades: 5, rotation: 12.7 };
        // Numbers with digits to the end.
        let moved = Sensor {
            position: Vec3::new(-0.123, 3.2 / 1.7, 4.56 / 1.3),
            target: Vec3::new(0.0, 1.0, 1e-9 / 7.0),
            up: Vec3::Y,
            projection: Projection::Perspective { fov: 90.0 },
            lens: None,
            shift: Vec2::ZERO,
        };
        for sensor in [
            moved.clone(),
            Sensor { lens: Some(lens), ..moved.clone() },
            Sensor { lens: Some(Lens { blades: 0, rotation: 0.0, ..lens }), ..moved.clone() },
            Sensor { projection: Projection::Orthographic { height: 1e-7 / 3.0 }, ..moved.clone() },
            Sensor { shift: Vec2::new(-1.0 / 3.0, 0.123_456_79), ..moved },
        ] {
            let path = folder.path().join("a.toml");
            std::fs::write(
                &path,
                to_toml(&sensor, DVec3::ZERO, Development { exposure: -0.1, tone: Tone::Agx })
                    + "[[object]]\nmesh = \"a.obj\"\n",
            )
            .unwrap();
            let scene = load(&path).unwrap();
            assert_eq!((scene.sensor, scene.settings.exposure), (sensor, Exposure::Stops(-0.1)));
            assert_eq!(scene.settings.tone, Tone::Agx);
        }
    }

    #[test]
    fn far_from_the_origin_a_written_camera_is_read_back_too() {
        let folder = tempfile::tempdir().unwrap();
        let mesh =
            "v 412345.678 5654321.234 98.5\nv 412346.678 5654321.234 98.5\nv 412345.678 5654322.234 98.5\nf 1 2 3\n";
        std::fs::write(folder.path().join("a.obj"), mesh).unwrap();
        let path = folder.path().join("a.toml");
        let object = "[[object]]\nmesh = \"a.obj\"\n";
        let sensor =
            "[sensor]\nposition = [412346.1, 5654321.5, 103.75]\ntarget = [412346.0, 5654321.6, 98.5]\nfov = 40\n";
        std::fs::write(&path, format!("{sensor}{object}")).unwrap();
        let scene = load(&path).unwrap();
        assert!(scene.origin.y > 5e6 && scene.sensor.position.length() < 20.0, "{:?}", scene.sensor);
        std::fs::write(&path, to_toml(&scene.sensor, scene.origin, 0.0.into()) + object).unwrap();
        assert_eq!(load(&path).unwrap().sensor, scene.sensor);
    }
}
