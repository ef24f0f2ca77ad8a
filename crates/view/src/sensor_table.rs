//! Writes a camera as the `[sensor]` table of a scene file.

use luminaire::scene::{Projection, Sensor};

/// The table of a sensor; read back, it is the same to the last bit.
pub fn to_toml(sensor: &Sensor) -> String {
    // `{:?}` writes the fewest digits that are read back as the same number.
    let vector = |v: glam::Vec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
    let (kind, extent) = match sensor.projection {
        Projection::Perspective { fov } => ("perspective", format!("fov = {fov:?}")),
        Projection::Orthographic { height } => ("orthographic", format!("height = {height:?}")),
    };
    let mut text = format!(
        "[sensor]\nkind = \"{kind}\"\nposition = {}\ntarget = {}\nup = {}\n{extent}\n",
        vector(sensor.position),
        vector(sensor.target),
        vector(sensor.up)
    );
    if let Some(lens) = sensor.lens {
        text += &format!("aperture = {:?}\nfocus_distance = {:?}\n", lens.radius, lens.focus_distance);
        if lens.blades > 0 {
            text += &format!("blades = {}\nblade_rotation = {:?}\n", lens.blades, lens.rotation);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use luminaire::scene::{Lens, load};

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
        };
        for sensor in [
            moved.clone(),
            Sensor { lens: Some(lens), ..moved.clone() },
            Sensor { lens: Some(Lens { blades: 0, rotation: 0.0, ..lens }), ..moved.clone() },
            Sensor { projection: Projection::Orthographic { height: 1e-7 / 3.0 }, ..moved },
        ] {
            let path = folder.path().join("a.toml");
            std::fs::write(&path, to_toml(&sensor) + "[[object]]\nmesh = \"a.obj\"\n").unwrap();
            assert_eq!(load(&path).unwrap().sensor, sensor);
        }
    }
}
