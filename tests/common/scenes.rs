//! Small scenes, built in code.

use glam::{Affine2, Affine3A, DVec2, DVec3, Vec2, Vec3};
use luminaire::reference::physical::{Lobes, PhysicalSurface};
use luminaire::reference::surfel::Surfel;
pub use luminaire::scene::build::*;
use luminaire::scene::*;
use std::sync::Arc;

/// A closed room from -2 to 2: red and green walls, a lamp under the ceiling and a point luminaire, a rotated, unevenly scaled block, and a
/// smooth glossy ball. All light stays inside. Coordinates of the sensor and the luminaires are multiples of 1/16.
pub fn cornell_like(width: u32, height: u32) -> Scene {
    let mut scene = empty(width, height);
    scene.sensor = pinhole(Vec3::new(0.0, 0.0, 1.875), Vec3::new(0.0, -0.25, -1.0), Vec3::Y, 75.0);
    let grey = matte(Vec3::splat(0.7));
    let (x, y, z) = (Vec3::X * 4.0, Vec3::Y * 4.0, Vec3::Z * 4.0);
    let low = Vec3::splat(-2.0);
    for (corner, a, b, material) in [
        (low, x, z, grey.clone()),
        (low + y, x, z, grey.clone()),
        (low, x, y, grey.clone()),
        (low + z, x, y, grey.clone()),
        (low, y, z, matte(Vec3::new(0.65, 0.1, 0.08))),
        (low + x, y, z, matte(Vec3::new(0.15, 0.5, 0.12))),
    ] {
        add(&mut scene, quad(corner, a, b), material, Affine3A::IDENTITY);
    }
    let panel = quad(Vec3::new(-0.5, 1.9375, -0.5), Vec3::X, Vec3::Z);
    add(&mut scene, panel, lamp(Vec3::new(14.0, 12.0, 9.0)), Affine3A::IDENTITY);
    let block = Affine3A::from_translation(Vec3::new(-0.75, -1.0, -0.75))
        * Affine3A::from_rotation_y(0.4)
        * Affine3A::from_scale(Vec3::new(0.5, 1.0, 0.4));
    add(&mut scene, cube(), matte(Vec3::splat(0.6)), block);
    let mut ball = icosphere(3);
    ball.normals = ball.positions.clone();
    let glossy = Material { glossy: Vec3::splat(0.4), exponent: 20.0, ..matte(Vec3::new(0.2, 0.3, 0.5)) };
    let place = Affine3A::from_translation(Vec3::new(0.75, -1.4375, 0.25)) * Affine3A::from_scale(Vec3::splat(0.5625));
    add(&mut scene, ball, glossy, place);
    scene.luminaires.push(Luminaire::Point { position: Vec3::new(-1.5, 0.5, 1.5), intensity: Vec3::splat(1.5) });
    scene
}

/// A surfel at the origin whose normals are +z.
pub fn flat_surfel(lambert: DVec3, glossy: DVec3, exponent: f64) -> Surfel {
    Surfel {
        owner: [u32::MAX; 2],
        position: DVec3::ZERO,
        position_error: DVec3::ZERO,
        geometric_normal: DVec3::Z,
        shading_normal: DVec3::Z,
        tangent: None,
        horizon: None,
        lift: DVec3::ZERO,
        uv: DVec2::ZERO,
        front: true,
        emission: DVec3::ZERO,
        ambient: DVec3::ZERO,
        lambert,
        glossy,
        exponent,
        reflection: DVec3::ZERO,
        transmission: DVec3::ZERO,
        eta: None,
        thin: false,
        coat_transmittance: 1.0,
        impulse_probability: None,
        lobes: None,
    }
}

/// A surfel at the origin whose normals are +z, of a metallic-roughness surface without maps; brushed along +x. Seen from +z: elsewhere see [`viewed_from`].
pub fn physical_surfel(p: &Physical, thin: bool, front: bool) -> Surfel {
    let material = Material { physical: Some(p.clone()), thin, ..Material::default() };
    let surface = PhysicalSurface::without_maps(&material).expect("it has one");
    let surface = PhysicalSurface { tangent: DVec3::X, ..surface };
    let lobes = Some(Lobes::new(&surface, DVec3::Z, front, DVec3::Z));
    Surfel { lobes, front, ..flat_surfel(DVec3::ZERO, DVec3::ZERO, 0.0) }
}

/// The same surfel, seen from another direction.
pub fn viewed_from(surfel: &Surfel, wo: DVec3) -> Surfel {
    let lobes = surfel.lobes.map(|lobes| lobes.about(surfel.shading_normal, surfel.front, wo));
    Surfel { lobes, ..*surfel }
}

/// A texture from a function of the texel's place.
pub fn texture(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 4]) -> Texture {
    let texels = (0..width * height).map(|i| texel(i % width, i / width).map(half::f16::from_f32)).collect();
    Texture { name: "texture".into(), width, height, texels: Vec::into(texels), ..Texture::default() }
}

/// The room of [`cornell_like`] with impulses: a glass ball and a mirrored one (smooth), a slab of coloured glass, and the lecture's 60/40
/// mirror for a wall.
pub fn glass_room(width: u32, height: u32) -> Scene {
    let mut scene = cornell_like(width, height);
    scene.materials[2] =
        Material { reflection: Vec3::splat(0.6), impulse_probability: Some(0.6), ..matte(Vec3::new(0.4, 0.35, 0.3)) };
    let mut ball = icosphere(3);
    ball.normals = ball.positions.clone();
    let glass = Material {
        name: "glass".into(),
        reflection: Vec3::ONE,
        transmission: Vec3::new(0.9, 1.0, 0.95),
        eta: Some(1.5),
        ..Material::default()
    };
    let place = |x, y, z, r| Affine3A::from_translation(Vec3::new(x, y, z)) * Affine3A::from_scale(Vec3::splat(r));
    add(&mut scene, ball.clone(), glass.clone(), place(-0.25, -0.5, 0.25, 0.5));
    let mirror = Material { name: "mirror".into(), reflection: Vec3::new(0.95, 0.8, 0.6), ..Material::default() };
    add(&mut scene, ball, mirror, place(0.9, 0.5, -0.75, 0.6));
    let slab =
        place(-1.0, 0.75, 0.0, 1.0) * Affine3A::from_rotation_z(0.5) * Affine3A::from_scale(Vec3::new(-0.1, 0.4, 0.4));
    add(&mut scene, cube(), Material { transmission: Vec3::new(0.2, 0.9, 0.4), eta: Some(1.3), ..glass }, slab);
    scene
}

/// A copper of its own index and extinction coefficient (red, green, blue).
pub fn copper(roughness: f32) -> Physical {
    let conductor = Some([Vec3::new(0.2, 0.92, 1.1), Vec3::new(3.91, 2.45, 2.14)]);
    Physical { metallic: 1.0, roughness, conductor, ..Physical::default() }
}

/// The room with metallic-roughness surfaces: rough glass that absorbs, a frosted pane, copper, a brushed wall, a varnished block, a floor whose numbers come from
/// maps, a smooth ball of glass.
pub fn physical_room(width: u32, height: u32) -> Scene {
    let mut scene = cornell_like(width, height);
    let physical = |p: Physical| Material { physical: Some(p), ..Material::default() };
    scene.textures = vec![
        texture(8, 8, |x, y| [0.25 + 0.1 * x as f32, 0.9 - 0.05 * y as f32, 0.5, 1.0]).into(),
        texture(5, 3, |x, y| [x as f32 / 4.0, 0.3 + 0.2 * y as f32, 0.2 * x as f32, 1.0 - 0.15 * x as f32]).into(),
    ];
    for mesh in scene.meshes.iter_mut().map(Arc::make_mut) {
        mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(0.5 * p.x + 0.3 * p.z, 0.5 * p.y - 0.4 * p.z)).collect();
    }
    let number = |channel| Some(ChannelMap { texture: 1, channel });
    let maps = PhysicalMaps {
        base_color: Some(0),
        metallic: number(0),
        roughness: number(1),
        specular: number(3),
        specular_color: Some(0),
        ..PhysicalMaps::default()
    };
    scene.materials[0] = physical(Physical { metallic: 1.0, roughness: 0.7, maps, ..Physical::default() });
    let maps = PhysicalMaps { anisotropy: Some(1), ..PhysicalMaps::default() };
    let brushed =
        Physical { metallic: 1.0, roughness: 0.3, anisotropy: 0.8, anisotropy_rotation: 0.5, maps, ..copper(0.3) };
    scene.materials[2] = physical(brushed);
    let ball = scene.materials.len() - 1;
    scene.materials[ball] = physical(Physical { base_color: Vec3::new(0.9, 0.6, 0.3), ..copper(0.25) });
    let maps = PhysicalMaps { clearcoat: number(0), clearcoat_roughness: number(1), ..PhysicalMaps::default() };
    let varnished = Physical {
        base_color: Vec3::new(0.6, 0.1, 0.05),
        clearcoat: 1.0,
        clearcoat_roughness: 0.4,
        maps,
        ..Physical::default()
    };
    scene.materials[ball - 1] = physical(varnished);
    let place = |x, y, z, r| Affine3A::from_translation(Vec3::new(x, y, z)) * Affine3A::from_scale(Vec3::splat(r));
    let mut round = icosphere(3);
    round.normals = round.positions.clone();
    let liquid = Physical {
        roughness: 0.3,
        transmission: 1.0,
        attenuation_color: Vec3::new(0.9, 0.4, 0.2),
        attenuation_distance: 0.5,
        ..Physical::default()
    };
    add(&mut scene, icosphere(2), physical(liquid.clone()), place(-0.25, -0.5, 0.25, 0.5));
    let milky =
        Physical { roughness: 0.0, transmission: 0.7, metallic: 0.2, base_color: Vec3::new(0.8, 0.9, 1.0), ..liquid };
    add(&mut scene, round, physical(milky), place(0.9, 0.5, -0.75, 0.6));
    let maps = PhysicalMaps { transmission: number(3), ..PhysicalMaps::default() };
    let frosted = Physical {
        roughness: 0.45,
        transmission: 0.9,
        base_color: Vec3::new(0.7, 0.9, 0.8),
        maps,
        ..Physical::default()
    };
    let mut pane = quad(Vec3::new(-1.25, 0.25, -0.5), Vec3::X * 1.5, Vec3::Y);
    pane.uvs = vec![Vec2::ZERO, Vec2::X * 2.0, Vec2::new(2.0, 1.5), Vec2::Y * 1.5];
    add(&mut scene, pane, Material { thin: true, ..physical(frosted) }, Affine3A::IDENTITY);
    scene
}

/// The room with textures: a chequered floor, a glossy map, a screen that glows by a texture, a curtain with holes, a half-transparent one.
/// The floor's map and the curtain's are scaled and moved, and the block is of plastic.
pub fn textured_room(width: u32, height: u32) -> Scene {
    let mut scene = cornell_like(width, height);
    let chequer = |x: u32, y: u32| if (x + y).is_multiple_of(2) { 0.9 } else { 0.2 };
    scene.textures = vec![
        texture(8, 8, |x, y| [chequer(x, y), chequer(x, y + 1), 0.5, 1.0]).into(),
        texture(5, 3, |x, y| [x as f32 / 4.0, y as f32 / 2.0, 1.0, 1.0]).into(),
        texture(16, 16, |x, y| [1.0, 1.0, 1.0, if x % 4 < 2 && y % 3 > 0 { 0.0 } else { 1.0 }]).into(),
    ];
    Arc::make_mut(&mut scene.textures[1]).clamp = true;
    for mesh in scene.meshes.iter_mut().map(Arc::make_mut) {
        // From the positions, so that every triangle has some that vary.
        mesh.uvs =
            mesh.positions.iter().map(|p| glam::Vec2::new(0.5 * p.x + 0.3 * p.z, 0.5 * p.y - 0.4 * p.z)).collect();
    }
    scene.materials[0].maps.lambert = Some(0);
    let ball = scene.materials.len() - 1;
    scene.materials[ball].maps.glossy = Some(1);
    let block = ball - 1;
    scene.materials[block] = Material { reflection: Vec3::ONE, eta: Some(1.5), ..scene.materials[block].clone() };
    for (map, scale, offset) in [(0, Vec2::new(2.0, 0.5), Vec2::new(0.25, 0.0)), (2, Vec2::splat(-1.5), Vec2::Y * 0.3)]
    {
        let texture = Arc::make_mut(&mut scene.textures[map]);
        texture.transform = Affine2::from_scale_angle_translation(scale, 0.0, offset);
    }
    scene.materials[4].maps.ambient = Some(1);
    let with_uvs = |mut mesh: Mesh| {
        mesh.uvs = vec![glam::Vec2::ZERO, glam::Vec2::X * 2.0, glam::Vec2::new(2.0, 1.5), glam::Vec2::Y * 1.5];
        mesh
    };
    let screen = with_uvs(quad(Vec3::new(1.9375, -0.5, -1.0), Vec3::Z, Vec3::Y));
    let mut glow = lamp(Vec3::splat(3.0));
    glow.maps.emission = Some(1);
    add(&mut scene, screen, glow, Affine3A::IDENTITY);
    // A lamp that emits downwards only, in an instance that mirrors.
    let one_sided = Material { one_sided: true, ..lamp(Vec3::new(2.0, 4.0, 8.0)) };
    let lamp_below = quad(Vec3::new(-0.25, 0.0, -0.25), Vec3::X * 0.5, Vec3::Z * 0.5);
    let mirrored =
        Affine3A::from_translation(Vec3::new(0.75, 1.0, -1.25)) * Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    add(&mut scene, lamp_below, one_sided, mirrored);
    let curtain = with_uvs(quad(Vec3::new(-1.25, 0.25, -0.5), Vec3::X, Vec3::Y));
    let mut cloth = matte(Vec3::new(0.5, 0.6, 0.7));
    cloth.maps.opacity = Some(2);
    add(&mut scene, curtain, cloth, Affine3A::IDENTITY);
    let veil = with_uvs(quad(Vec3::new(0.0, 0.25, 0.5), Vec3::X, Vec3::Y * 0.75));
    // It glows as well, where it is.
    let veil_material = Material { opacity: 0.4, emission: Vec3::splat(0.5), ..matte(Vec3::splat(0.8)) };
    add(&mut scene, veil, veil_material, Affine3A::IDENTITY);
    scene
}

/// Under a sky with a sun: the boxes and the glossy ball on a floor, seen through a lens with six blades, with a Gaussian filter, by Sobol
/// points.
pub fn open_air(width: u32, height: u32) -> Scene {
    let mut scene = cornell_like(width, height);
    // Without walls, ceiling and lamp.
    scene.objects.retain(|object| ![1, 2, 3, 4, 5, 6].contains(&object.mesh));
    scene.luminaires.clear();
    let (columns, rows) = (16, 8);
    let sky = |x: u32, y: u32| match (x, y) {
        (11, 2) => Vec3::new(60.0, 50.0, 40.0),
        (_, 4..) => Vec3::new(0.1, 0.08, 0.06),
        _ => Vec3::new(0.3, 0.5, 0.9) * (1.0 + 0.1 * x as f32),
    };
    scene.environment = Some(Environment {
        radiance: Vec3::new(0.8, 0.9, 1.0),
        image: Some(
            EnvironmentImage {
                name: "sky".into(),
                width: columns,
                height: rows,
                texels: (0..columns * rows).map(|i| sky(i % columns, i / columns)).collect(),
            }
            .into(),
        ),
        rotation: 30.0,
    });
    scene.sensor.lens = Some(Lens { radius: 0.0625, focus_distance: 2.5, blades: 6, rotation: 10.0 });
    scene.film.filter = Filter::Gaussian;
    scene.film.filter_radius = 1.5;
    scene.settings.sampler = Sampler::Sobol;
    scene
}
