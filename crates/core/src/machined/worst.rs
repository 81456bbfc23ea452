//! The worst places of a surface.

use super::surface::SurfaceDeviation;

/// Indices of at most `most` points with the largest deviations, worst first, each at least `apart` (m) from all before.
pub fn worst_places(points: &[SurfaceDeviation], most: usize, apart: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|one, other| {
        let size = |index: usize| points[index].deviation.abs();
        size(*other).total_cmp(&size(*one)).then(one.cmp(other))
    });
    let mut worst: Vec<usize> = Vec::new();
    for index in order {
        if worst.len() == most {
            break;
        }
        let position = points[index].position;
        if worst
            .iter()
            .all(|chosen| (points[*chosen].position - position).norm() >= apart)
        {
            worst.push(index);
        }
    }
    worst
}
