//! A tree over the luminaires that are somewhere: which of them is chosen depends on where the choice is made.
//!
//! Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", HPG 2018, with four children a node. A node
//! knows of each child its strength, a ball around it, and a cone around its normals; by these the tracers estimate how much light of it may
//! arrive ([`crate::reference::light_tree`], `shaders/light_tree.glsl`), and go down with one random number. What can contribute nothing, by
//! bounds that hold, is not chosen; all else is, if seldom.

mod node;
mod source;
mod split;

pub use node::{CHILDREN, Child, LEAF, LightNode, Spread};
pub use source::Source;

use super::world::Scene;
use crate::sampling::AliasTable;
use glam::Vec3;
use node::child;
use rayon::prelude::*;
use split::groups;

/// The path to what is never chosen.
pub const NO_PATH: u64 = u64::MAX;
/// From this level on nodes are split by number alone, so that a path has at most 32 steps: 16 more hold 2^32 luminaires.
const BALANCED_FROM: u32 = 16;
/// Fewer luminaires are not worth a task of their own.
const TASK: usize = 4096;

/// The tree, and what is chosen beside it.
#[derive(Debug, Clone)]
pub struct LightTree {
    /// The first is the root.
    pub nodes: Vec<LightNode>,
    /// For each emissive triangle of each object, in the order of [`LightTree::first_of_object`] and [`emissive_ordinals`], the way to its leaf:
    /// two bits a step, the root's the lowest; or [`NO_PATH`].
    pub paths: Vec<u64>,
    /// For each object, the place of its first emissive triangle in `paths`.
    pub first_of_object: Vec<u32>,
    /// For each mesh, [`emissive_ordinals`]; empty where nothing of its own emits.
    ordinals: Vec<Vec<u32>>,
    /// Indices into the luminaire table of what is infinitely far away; none: the tree.
    pub outer: Vec<Option<u32>>,
    /// Chooses one of `outer`, in proportion to their power.
    pub outer_choice: AliasTable,
    /// Probability that the tree is chosen.
    pub probability: f64,
    /// Probability that the environment is chosen.
    pub environment_probability: f64,
    /// Steps of the longest path.
    pub levels: u32,
}

impl LightTree {
    /// A tree over `sources`, of which there is one at least. `place` says for each where its path goes in `paths`, if it has one; there are
    /// `emissive` of them. `outer` is what is chosen beside the tree, the environment last; `powers` are those of the tree and of each of these.
    pub(super) fn new(
        scene: &Scene,
        mut sources: Vec<Source>,
        place: impl Fn(u32) -> Option<u32>,
        emissive: usize,
        outer: &[u32],
        powers: &[f64],
        environment: bool,
    ) -> Self {
        let nodes = subtree(&mut sources, 0);
        let mut tree = LightTree {
            nodes,
            paths: vec![NO_PATH; emissive],
            first_of_object: first_of_object(scene),
            ordinals: scene.meshes.iter().map(|mesh| emissive_ordinals(scene, mesh)).collect(),
            outer: std::iter::once(None).chain(outer.iter().copied().map(Some)).collect(),
            outer_choice: AliasTable::new(powers),
            probability: 0.0,
            environment_probability: 0.0,
            levels: 0,
        };
        tree.probability = tree.outer_choice.pdf[0];
        if environment {
            tree.environment_probability = *tree.outer_choice.pdf.last().expect("the tree at least");
        }
        let mut stack = vec![(0u32, 0u64, 0u32)];
        while let Some((node, path, depth)) = stack.pop() {
            let node = &tree.nodes[node as usize];
            tree.levels = tree.levels.max(depth + 1);
            for (number, link) in (0u64..).zip(node.link) {
                if node.strength[number as usize] == 0.0 {
                    continue;
                }
                let path = path | number << (2 * depth);
                if link & LEAF == 0 {
                    stack.push((link, path, depth + 1));
                } else if let Some(place) = place(link & !LEAF) {
                    tree.paths[place as usize] = path;
                }
            }
        }
        tree
    }

    /// Bytes that nodes and paths take, here and on the device.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.paths[..])
    }

    /// The way to the leaf of an emissive triangle; none if it is never chosen.
    pub fn path(&self, scene: &Scene, object: u32, triangle: u32) -> Option<u64> {
        let placed = &scene.objects[object as usize];
        let ordinal = match placed.material {
            Some(_) => triangle,
            None => *self.ordinals[placed.mesh as usize].get(triangle as usize)?,
        };
        let path = *self.paths.get(self.first_of_object[object as usize] as usize + ordinal as usize)?;
        (path != NO_PATH).then_some(path)
    }
}

/// Whether a material emits anything.
fn emits(scene: &Scene, material: u32) -> bool {
    scene.materials[material as usize].emission != Vec3::ZERO
}

/// For each triangle of a mesh, how many before it emit by the mesh's own materials; empty if none does.
pub fn emissive_ordinals(scene: &Scene, mesh: &super::Mesh) -> Vec<u32> {
    if !mesh.triangles.iter().any(|triangle| emits(scene, triangle.material)) {
        return vec![];
    }
    let mut before = 0;
    mesh.triangles
        .iter()
        .map(|triangle| {
            let ordinal = before;
            before += u32::from(emits(scene, triangle.material));
            ordinal
        })
        .collect()
}

/// Where the emissive triangles of each object begin, if those of all objects stand one after the other.
fn first_of_object(scene: &Scene) -> Vec<u32> {
    let own: Vec<u32> = scene
        .meshes
        .iter()
        .map(|mesh| mesh.triangles.iter().filter(|triangle| emits(scene, triangle.material)).count() as u32)
        .collect();
    let mut next = 0;
    scene
        .objects
        .iter()
        .map(|object| {
            let first = next;
            next += match object.material {
                Some(material) if emits(scene, material) => scene.meshes[object.mesh as usize].triangles.len() as u32,
                Some(_) => 0,
                None => own[object.mesh as usize],
            };
            first
        })
        .collect()
}

/// The nodes of a tree over `sources`, whose links count from its own root.
fn subtree(sources: &mut [Source], depth: u32) -> Vec<LightNode> {
    let parallel = sources.len() > TASK;
    let mut groups = groups(sources, depth >= BALANCED_FROM);
    let below = |group: &mut &mut [Source]| if group.len() > 1 { subtree(group, depth + 1) } else { vec![] };
    let below: Vec<Vec<LightNode>> =
        if parallel { groups.par_iter_mut().map(below).collect() } else { groups.iter_mut().map(below).collect() };
    let mut nodes = Vec::with_capacity(1 + below.iter().map(Vec::len).sum::<usize>());
    nodes.push(LightNode::default());
    let strongest = groups.iter().map(|group| node::strength(group)).fold(0.0, f64::max);
    for (number, (group, below)) in groups.iter().zip(below).enumerate() {
        let first = nodes.len() as u32;
        let link = if group.len() == 1 { group[0].entry | LEAF } else { first };
        nodes[0].set(number, &child(group, strongest), link);
        nodes.extend(below.into_iter().map(|mut node| {
            for link in node.link.iter_mut().filter(|link| **link & LEAF == 0) {
                *link += first;
            }
            node
        }));
    }
    // What there is none of lies where the first one does, so that its numbers are harmless.
    for number in groups.len()..CHILDREN {
        let first = nodes[0].child(0);
        nodes[0].set(number, &Child { strength: 0.0, ..first }, u32::MAX);
    }
    nodes
}
