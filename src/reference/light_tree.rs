//! The choice of a luminaire by the light tree: down from the root with one random number, each child in proportion to what may arrive of it.
//!
//! The number is a whole one below the width of what is still possible, and a node cuts that width: what is left at the leaf, over the whole, is
//! the probability to the last number. Where few numbers are left, further bits come from a second random number, which first chooses between
//! the tree and what stands beside it: so the way down always begins with the same width, and whoever asks for the probability of a leaf
//! finds the very one with which it is chosen.

use super::prepared_scene::Reference;
use super::surfel::Surfel;
use crate::scene::light_tree::{CHILDREN, Child, LEAF, LightNode};
use crate::scene::{LightChoice, LightTree};
use glam::DVec3;

/// What is added to a ball's apparent size against the surface's horizon, for rounding.
pub const HORIZON_MARGIN: f64 = 1e-4;
/// The ball's radius over its distance counts at most as this.
pub const MOST_SINE: f64 = 2.0;
/// What may contribute is chosen at least by this much of the strongest.
pub const LEAST_IMPORTANCE: f64 = 1e-24;
/// A squared distance is at least this.
pub const LEAST_DISTANCE2: f64 = 1e-37;
/// What the inner side of a closed lamp counts, which is seen from within it alone.
pub const INNER_SIDE: f64 = 1.0 / 32.0;
/// Fewer numbers than these get further bits.
pub const LEAST_WIDTH: u32 = 1 << 24;
/// The largest fraction of 2^32 that is also an `f32`.
pub const LAST_FRACTION: f64 = 4_294_967_040.0;
/// What is added to a cosine before it is held against a cone's, for the rounding of axes to 16 bits.
pub const CONE_COSINE_MARGIN: f64 = 2e-4;
/// A choice among more numbers than these is none: it never happens, and one over its probability might not be a number.
pub const MOST_NUMBERS: f64 = 1e30;

/// What is left of the random number on the way down.
struct Numbers {
    /// How many are possible still.
    width: u32,
    /// How many those at the root were, in units of what is left.
    whole: f64,
    /// Which of them it is.
    number: u32,
    /// Further bits.
    more: u32,
}

impl Numbers {
    /// Those at the root.
    fn all(number: u32, more: u32) -> Self {
        Numbers { width: u32::MAX, whole: u32::MAX.into(), number, more }
    }

    /// Makes sure that there are enough to cut.
    fn renew(&mut self) {
        while self.width < LEAST_WIDTH {
            // First, as the upper bits have chosen among what stands beside the tree; below those all are as likely.
            self.more = self.more.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            self.width <<= 8;
            self.number = self.number << 8 | self.more >> 24;
            self.whole *= 256.0;
        }
    }

    /// Takes those of a child.
    fn take(&mut self, cuts: [u32; 3], child: usize) {
        let begin = if child == 0 { 0 } else { cuts[child - 1] };
        let end = if child == 3 { self.width } else { cuts[child] };
        self.width = end - begin;
        self.number = self.number.wrapping_sub(begin);
    }
}

/// The mean of a cosine's positive part, where it may be off by `spread`: itself far above the horizon, 0 far below.
fn facing(cosine: f64, spread: f64) -> f64 {
    if cosine >= spread {
        return cosine;
    }
    let above = (cosine + spread).max(0.0);
    above * above / (4.0 * spread)
}

/// Whether some light of a ball may arrive that stays within cones: `cone` is their cosine around an axis, `cosine` that of the way here, `sine` the ball's radius
/// over its distance.
fn within_cone(cone: f64, cosine: f64, sine: f64) -> bool {
    let other = (1.0 - sine * sine).max(0.0).sqrt();
    // The cosine of the cone's angle and the ball's together, unless they are half a turn.
    let both = cone * other - (1.0 - cone * cone).max(0.0).sqrt() * sine;
    sine >= 1.0 || cone + other <= 0.0 || cosine + CONE_COSINE_MARGIN >= both
}

/// How much light of each child of a node may arrive at a surface with this normal, relative to each other; 0: surely none. A normal of length 2 says that
/// light from both sides counts ([`Surfel::receiver`]).
pub fn light_importances(position: DVec3, normal: DVec3, node: &LightNode) -> [f64; CHILDREN] {
    let children: [_; CHILDREN] = std::array::from_fn(|number| node.child(number));
    let both = normal.length_squared() > 2.0;
    let to_child = children.map(|child| child.center.as_dvec3() - position);
    let distance2 = to_child.map(|d| d.length_squared().max(LEAST_DISTANCE2));
    let near: [f64; CHILDREN] =
        std::array::from_fn(|i| distance2[i].max(f64::from(children[i].radius) * f64::from(children[i].radius)));
    let nearest = near.iter().fold(f64::INFINITY, |least, near| least.min(*near));
    std::array::from_fn(|i| {
        let child = &children[i];
        let inverse = distance2[i].sqrt().recip();
        let sine = (f64::from(child.radius) * inverse).min(MOST_SINE);
        let incident = normal.dot(to_child[i]) * inverse;
        let incident = facing(if both { 0.5 * incident.abs() } else { incident }, sine + HORIZON_MARGIN);
        let mut cosine = -child.axis.dot(to_child[i]) * inverse;
        if child.spread.two_sided {
            cosine = cosine.abs();
        }
        let spread = sine + child.spread.sine;
        let inner = if child.closed { INNER_SIDE * facing(-cosine, spread) } else { 0.0 };
        let emitted = match child {
            Child { cone: true, .. } if within_cone(child.spread.sine, cosine, sine) => 1.0,
            Child { cone: true, .. } => 0.0,
            _ if child.spread.sine >= 1.0 => 1.0 + cosine,
            _ => facing(cosine, spread).max(inner),
        };
        if child.strength == 0.0 || incident == 0.0 || emitted == 0.0 {
            return 0.0;
        }
        (f64::from(child.strength) * (nearest / near[i]) * incident * emitted).max(LEAST_IMPORTANCE)
    })
}

/// Where the numbers of a node's second, third and fourth child begin: each has one at least. None: nothing of the node can contribute.
fn light_cuts(importances: [f64; CHILDREN], width: u32) -> Option<[u32; 3]> {
    let [a, b, c, d] = importances;
    let sums = [a, a + b, a + b + c];
    let total = sums[2] + d;
    if total.is_nan() || total <= 0.0 {
        return None;
    }
    let usable = u64::from(width - CHILDREN as u32);
    Some(std::array::from_fn(|i| {
        let fraction = (sums[i] / total * LAST_FRACTION) as u32;
        ((usable * u64::from(fraction)) >> 32) as u32 + i as u32 + 1
    }))
}

impl Reference {
    /// The tree, if luminaires are chosen by it.
    pub fn light_tree(&self) -> Option<&LightTree> {
        self.luminaires.tree.as_ref().filter(|_| self.scene.integrator.estimator().light_choice != LightChoice::Power)
    }

    /// Index of a luminaire, chosen by number 2 of `random`, or, by the tree, by 3 (between the tree and what stands beside it) and 2 (in the tree); the probability of that, and the one that the
    /// power heuristic is given. None if there is none, or if nothing can contribute to this surface.
    pub fn choose_luminaire(&self, surfel: &Surfel, random: [u32; 4]) -> Option<(usize, f64, f64)> {
        let Some(tree) = self.light_tree() else {
            if self.luminaires.entries.is_empty() {
                return None;
            }
            let chosen = self.luminaires.choice.choose(random[2]);
            return Some((chosen, self.luminaires.choice.pdf[chosen], self.luminaires.ideal_probability(chosen)));
        };
        let slots = &tree.outer_choice.slots;
        let product = u64::from(random[3]) * slots.len() as u64;
        let (slot, number) = ((product >> 32) as usize, product as u32);
        let (threshold, alias) = slots[slot];
        let outer = if number < threshold { slot } else { alias as usize };
        if let Some(entry) = tree.outer[outer] {
            let probability = tree.outer_choice.pdf[outer];
            return Some((entry as usize, probability, probability));
        }
        let mut numbers = Numbers::all(random[2].min(u32::MAX - 1), random[3]);
        let mut node = &tree.nodes[0];
        loop {
            numbers.renew();
            let cuts = light_cuts(light_importances(surfel.position, surfel.receiver(), node), numbers.width)?;
            let child = cuts.iter().filter(|cut| numbers.number >= **cut).count();
            numbers.take(cuts, child);
            let link = node.link[child];
            if node.strength[child] == 0.0 || numbers.whole > MOST_NUMBERS {
                return None;
            }
            if link & LEAF != 0 {
                let probability = tree.probability * f64::from(numbers.width) / numbers.whole;
                return Some(((link & !LEAF) as usize, probability, probability));
            }
            node = &tree.nodes[link as usize];
        }
    }

    /// The probability of choosing a disc at infinity, which has this index in the luminaire table.
    pub(super) fn sun_probability(&self, entry: usize) -> f64 {
        let Some(tree) = self.light_tree() else { return self.luminaires.ideal_probability(entry) };
        let outer = tree.outer.iter().position(|outer| *outer == Some(entry as u32));
        outer.map_or(0.0, |outer| tree.outer_choice.pdf[outer])
    }

    /// The probability with which [`Reference::choose_luminaire`] gives an emissive triangle, by the tree, seen from a surface.
    pub fn tree_probability(&self, tree: &LightTree, from: &Surfel, object: u32, triangle: u32) -> f64 {
        let Some(mut path) = tree.path(&self.scene, object, triangle) else { return 0.0 };
        let mut numbers = Numbers::all(0, 0);
        let mut node = &tree.nodes[0];
        loop {
            numbers.renew();
            let Some(cuts) = light_cuts(light_importances(from.position, from.receiver(), node), numbers.width) else {
                return 0.0;
            };
            let child = (path & 3) as usize;
            path >>= 2;
            numbers.take(cuts, child);
            if numbers.whole > MOST_NUMBERS {
                return 0.0;
            }
            let link = node.link[child];
            if link & LEAF != 0 {
                return tree.probability * f64::from(numbers.width) / numbers.whole;
            }
            node = &tree.nodes[link as usize];
        }
    }
}
