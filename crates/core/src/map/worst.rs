//! Where along a path is it worst? The largest deviation, then the largest of what is not near the ones before.

use crate::kernel::Answers;
use crate::path::Track;

/// Part of the size of the path, corner to corner, that a worst point stands for.
const APART: f64 = 0.1;

/// Indices of up to `most` points with the largest in-plane deviations, largest first, each a tenth of the size of the path
/// away from those before; of equal ones the first.
pub fn worst_points(track: &Track, answers: &Answers, most: usize) -> Vec<usize> {
    let points = &track.path.points;
    let [low, high] = track.path.corners();
    let apart = APART * (high - low).norm();
    let mut by_size: Vec<(usize, f64)> = answers.held().map(|(i, held)| (i, held.in_plane)).collect();
    // Only the largest are looked at: far more than are told, far fewer than a long path has.
    let looked_at = by_size.len().min(by_size.len() / 10 + 10_000);
    if looked_at < by_size.len() {
        by_size.select_nth_unstable_by(looked_at, |a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        by_size.truncate(looked_at);
    }
    by_size.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut kept: Vec<usize> = Vec::new();
    for (index, _) in by_size {
        if kept.len() == most {
            break;
        }
        let near = |other: &usize| (points[index].at - points[*other].at).norm() < apart;
        if !kept.iter().any(near) {
            kept.push(index);
        }
    }
    kept
}
