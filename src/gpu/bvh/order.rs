//! A spatial order for drivers that split primitives in the order they come.

use glam::Vec3;

/// An order of `centroids` in which neighbours in space are neighbours in the list: recursive median splits along the
/// widest axis, the left half taking the larger part. Lavapipe halves its primitives by index and never sorts; without this
/// order its rays are up to a hundred times slower.
pub fn spatial_order(centroids: &[Vec3]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..centroids.len() as u32).collect();
    split(centroids, &mut order);
    order
}

fn split(centroids: &[Vec3], order: &mut [u32]) {
    if order.len() <= 2 {
        return;
    }
    let (low, high) = order.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &i| {
        let c = centroids[i as usize];
        (low.min(c), high.max(c))
    });
    let size = high - low;
    let axis = size.max_position();
    let middle = order.len().div_ceil(2);
    order.select_nth_unstable_by(middle - 1, |&a, &b| {
        let key = |i: u32| centroids[i as usize][axis];
        // Ties by index, so that the order does not depend on the sort.
        key(a).total_cmp(&key(b)).then(a.cmp(&b))
    });
    let (left, right) = order.split_at_mut(middle);
    if left.len() > 4096 {
        rayon::join(|| split(centroids, left), || split(centroids, right));
    } else {
        split(centroids, left);
        split(centroids, right);
    }
}
