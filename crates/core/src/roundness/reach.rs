//! The nearest and the farthest of points.

use nalgebra::Vector2;

/// The least and greatest distance of `points` from `centre`, and which points they belong to.
pub(super) fn reach(points: &[Vector2<f64>], centre: &Vector2<f64>) -> [(f64, usize); 2] {
    let (mut near, mut far) = ((f64::MAX, 0), (-1.0, 0));
    for (index, point) in points.iter().enumerate() {
        let squared = (point - centre).norm_squared();
        if squared < near.0 {
            near = (squared, index);
        }
        if squared > far.0 {
            far = (squared, index);
        }
    }
    [(near.0.sqrt(), near.1), (far.0.sqrt(), far.1)]
}
