//! Triangles and objects, in the order in which the kernel counts them.

use crate::gpu::bvh::MeshBvh;
use crate::gpu::layout::{self, CornerTangents, HAS_PLANE, ORDINAL_SHIFT, VertexColours, VertexNormals};
use crate::scene::light_tree::{LightTree, emissive_ordinals};
use crate::scene::{Mesh, Scene, Texture, Triangle, widen};
use glam::{DAffine3, Vec2, Vec3};

/// Each triangle of each mesh, with its index in the mesh, in the order of `meshes`.
fn in_order<'a>(scene: &'a Scene, meshes: &'a [MeshBvh]) -> impl Iterator<Item = (&'a Mesh, u32, &'a Triangle)> {
    scene.meshes.iter().zip(meshes).flat_map(|(mesh, place)| {
        let mesh: &Mesh = mesh;
        place.order.iter().map(move |&index| (mesh, index, &mesh.triangles[index as usize]))
    })
}

/// The triangles of all meshes; `ordinals`: with the numbers of emissive triangles before each, which the light tree wants.
pub(in crate::gpu) fn triangles(scene: &Scene, meshes: &[MeshBvh], ordinals: bool) -> Vec<layout::Triangle> {
    let mut packed = Vec::with_capacity(count(meshes));
    packed.extend(in_order(scene, meshes).map(|(mesh, index_in_mesh, triangle)| {
        let corners = triangle.vertices.map(|v| mesh.positions[v as usize]);
        let [a, b, c] = corners.map(|corner| corner.to_array());
        layout::Triangle { a, material: triangle.material, b, index_in_mesh, c, shape: shape(corners) }
    }));
    if ordinals {
        let mut first = 0;
        for (mesh, place) in scene.meshes.iter().zip(meshes) {
            let ordinals = emissive_ordinals(scene, mesh);
            for (packed, &index) in packed[first..].iter_mut().zip(&place.order) {
                packed.shape |= ordinals.get(index as usize).map_or(0, |ordinal| ordinal << ORDINAL_SHIFT);
            }
            first += place.order.len();
        }
    }
    packed
}

/// Their vertex normals; zero where a mesh has none.
pub(in crate::gpu) fn vertex_normals(scene: &Scene, meshes: &[MeshBvh]) -> Vec<VertexNormals> {
    let mut packed = Vec::with_capacity(count(meshes));
    packed.extend(in_order(scene, meshes).map(|(mesh, _, triangle)| {
        triangle.vertices.map(|v| mesh.normals.get(v as usize).copied().unwrap_or(Vec3::ZERO).extend(0.0).to_array())
    }));
    packed
}

/// Their vertex colours; white where a mesh has none.
pub(in crate::gpu) fn vertex_colours(scene: &Scene, meshes: &[MeshBvh]) -> Vec<VertexColours> {
    let mut packed = Vec::with_capacity(count(meshes));
    packed.extend(in_order(scene, meshes).map(|(mesh, _, triangle)| {
        triangle.vertices.map(|v| mesh.colours.get(v as usize).copied().unwrap_or(Vec3::ONE).extend(0.0).to_array())
    }));
    packed
}

/// The tangents of their corners; zero where a mesh has none.
pub(in crate::gpu) fn corner_tangents(scene: &Scene, meshes: &[MeshBvh]) -> Vec<CornerTangents> {
    let mut packed = Vec::with_capacity(count(meshes));
    packed.extend(in_order(scene, meshes).map(|(mesh, index, _)| {
        let corner = |corner: usize| mesh.tangents.get(3 * index as usize + corner).map_or([0.0; 4], |t| t.to_array());
        [0, 1, 2].map(corner)
    }));
    packed
}

/// Texture coordinates that are larger lose digits of the place in the image, which are had back by leaving whole turns out.
const FAR: f32 = 64.0;

/// Their texture coordinates; zero where a mesh has none. Where every image repeats, and is scaled by whole numbers if at all, large ones are
/// those of the first turns.
pub(in crate::gpu) fn texture_coordinates(scene: &Scene, meshes: &[MeshBvh]) -> Vec<layout::TriangleUvs> {
    let whole = |texture: &Texture| {
        !texture.clamp && texture.transform.matrix2.to_cols_array().iter().all(|factor| factor.fract() == 0.0)
    };
    let turns_say_nothing = scene.textures.iter().all(|texture| whole(texture));
    let mut packed = Vec::with_capacity(count(meshes));
    packed.extend(in_order(scene, meshes).map(|(mesh, _, triangle)| {
        let corners = triangle.vertices.map(|v| mesh.uvs.get(v as usize).copied().unwrap_or(Vec2::ZERO));
        let least = corners[0].min(corners[1]).min(corners[2]).floor();
        let far = turns_say_nothing && least.is_finite();
        let turns = if far { Vec2::select(least.abs().cmpgt(Vec2::splat(FAR)), least, Vec2::ZERO) } else { Vec2::ZERO };
        let [a, b, c] = corners.map(|corner| (corner - turns).to_array());
        layout::TriangleUvs { a, b, c, padding: [0; 2] }
    }));
    packed
}

/// How many triangles all meshes have.
fn count(meshes: &[MeshBvh]) -> usize {
    meshes.iter().map(|mesh| mesh.order.len()).sum()
}

/// The object of this index in the scene.
pub(in crate::gpu) fn object(
    scene: &Scene,
    meshes: &[MeshBvh],
    tree: Option<&LightTree>,
    index: u32,
) -> layout::Object {
    let object = &scene.objects[index as usize];
    let place = &meshes[object.mesh as usize];
    let to_world = widen(object.object_to_world);
    layout::Object {
        object_to_world: rows(to_world),
        world_to_object: rows(to_world.inverse()),
        root_node: place.root,
        triangle_offset: place.triangle_offset,
        material: object.material.unwrap_or(layout::NONE),
        scene_index: index,
        first_emitter: tree.map_or(0, |tree| tree.first_of_object[index as usize]),
        padding: [0; 3],
    }
}

/// The rows of an affine map, rounded to `f32`.
fn rows(map: DAffine3) -> [[f32; 4]; 3] {
    let m = map.matrix3;
    [0, 1, 2].map(|r| [m.x_axis[r], m.y_axis[r], m.z_axis[r], map.translation[r]].map(|x| x as f32))
}
/// What the kernel's distance along a ray needs to know of a triangle: [`layout::LONGEST_EDGE`] (0: from the first corner to the second,
/// 1: to the third, 2: back), and [`HAS_PLANE`] if the other two edges say what plane it lies in.
fn shape([a, b, c]: [Vec3; 3]) -> u32 {
    let edges = [b - a, c - b, a - c];
    let lengths = edges.map(|edge| edge.abs().max_element());
    let longest = (0..3).rev().max_by(|i, j| lengths[*i].total_cmp(&lengths[*j])).unwrap_or(0);
    let (next, last) = ((longest + 1) % 3, (longest + 2) % 3);
    let normal = edges[next].cross(edges[last]);
    let plane = normal.abs().max_element() > 1e-4 * lengths[next] * lengths[last];
    longest as u32 | if plane { HAS_PLANE } else { 0 }
}
