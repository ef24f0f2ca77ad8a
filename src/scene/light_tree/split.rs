//! How the luminaires of a node are shared out among its children: those together that lie close and look the same way.

use super::node::{CHILDREN, axis_sum};
use super::source::Source;
use glam::{DVec3, Vec3};

/// Candidates along each axis are one less.
const BINS: usize = 16;

/// Some luminaires together.
#[derive(Clone, Copy)]
struct Pile {
    count: usize,
    low: Vec3,
    high: Vec3,
    strength: f64,
    normals: DVec3,
}

impl Pile {
    const NOTHING: Pile =
        Pile { count: 0, low: Vec3::INFINITY, high: Vec3::NEG_INFINITY, strength: 0.0, normals: DVec3::ZERO };

    fn add(&mut self, source: &Source, axis: DVec3) {
        let [a, b, c] = source.corners;
        let normal = source.strength * source.normal;
        self.count += 1;
        self.low = self.low.min(a).min(b).min(c);
        self.high = self.high.max(a).max(b).max(c);
        self.strength += source.strength;
        self.normals += if source.turns() && normal.dot(axis) < 0.0 { -normal } else { normal };
    }

    fn with(self, other: Pile) -> Pile {
        Pile {
            count: self.count + other.count,
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            strength: self.strength + other.strength,
            normals: self.normals + other.normals,
        }
    }

    /// How badly it is known where its light goes: intensity, times the square of its size, times one for one normal to four for normals all
    /// around (the solid angles of Conty Estevez and Kulla's orientation measure, by the length of the mean normal).
    fn cost(&self) -> f64 {
        if self.count == 0 {
            return 0.0;
        }
        let size2 = (self.high.as_dvec3() - self.low.as_dvec3()).length_squared();
        let together = if self.strength > 0.0 { (self.normals.length() / self.strength).min(1.0) } else { 1.0 };
        self.strength * size2 * (4.0 - 3.0 * together)
    }
}

fn center(source: &Source) -> Vec3 {
    let [a, b, c] = source.corners;
    (a / 3.0) + (b / 3.0) + (c / 3.0)
}

/// At most [`CHILDREN`] groups, of which the most costly ones were split last; `balanced`: by number alone.
pub(super) fn groups(sources: &mut [Source], balanced: bool) -> Vec<&mut [Source]> {
    let cost = |group: &[Source]| match (group.len(), balanced) {
        (1, _) => -1.0,
        (count, true) => count as f64,
        _ => {
            let axis = axis_sum(group);
            let mut pile = Pile::NOTHING;
            group.iter().for_each(|source| pile.add(source, axis));
            pile.cost()
        }
    };
    let mut groups = vec![(cost(sources), sources)];
    while groups.len() < CHILDREN {
        let most = (0..groups.len()).max_by(|a, b| groups[*a].0.total_cmp(&groups[*b].0)).expect("one at least");
        if groups[most].1.len() < 2 {
            break;
        }
        let (_, group) = groups.swap_remove(most);
        let cut = split(group, balanced);
        let (left, right) = group.split_at_mut(cut);
        // The last ones are not split here.
        let cost = |group: &[Source]| if groups.len() + 2 < CHILDREN { cost(group) } else { 0.0 };
        let costs = [cost(left), cost(right)];
        groups.extend(costs.into_iter().zip([left, right]));
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

/// Sorts a group of two or more into two, and says where the second begins.
fn split(group: &mut [Source], balanced: bool) -> usize {
    let half = group.len() / 2;
    let (low, high) = group.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), source| {
        let center = center(source);
        (low.min(center), high.max(center))
    });
    let extent = high - low;
    // All in one place, or so far apart that the differences overflow.
    if !(extent.max_element() > 0.0 && extent.is_finite()) {
        return half;
    }
    if balanced {
        let axis = extent.max_position();
        group.select_nth_unstable_by(half, |a, b| center(a)[axis].total_cmp(&center(b)[axis]));
        return half;
    }
    let scale = Vec3::splat(BINS as f32) / extent;
    let bin = |source: &Source, axis: usize| {
        // An extent of 0 makes this no number, which is bin 0.
        (((center(source)[axis] - low[axis]) * scale[axis]) as usize).min(BINS - 1)
    };
    let toward = axis_sum(group);
    let mut bins = [[Pile::NOTHING; BINS]; 3];
    for source in group.iter() {
        for (axis, bins) in bins.iter_mut().enumerate() {
            bins[bin(source, axis)].add(source, toward);
        }
    }
    let mut best = (f64::INFINITY, 0, 0);
    for (axis, bins) in bins.iter().enumerate() {
        let mut above = [Pile::NOTHING; BINS + 1];
        for cut in (0..BINS).rev() {
            above[cut] = above[cut + 1].with(bins[cut]);
        }
        let mut below = Pile::NOTHING;
        for cut in 1..BINS {
            below = below.with(bins[cut - 1]);
            let cost = below.cost() + above[cut].cost();
            if below.count > 0 && above[cut].count > 0 && cost < best.0 {
                best = (cost, axis, cut);
            }
        }
    }
    let (cost, axis, cut) = best;
    if !cost.is_finite() {
        return half;
    }
    let mut place = 0;
    for index in 0..group.len() {
        if bin(&group[index], axis) < cut {
            group.swap(place, index);
            place += 1;
        }
    }
    place
}
