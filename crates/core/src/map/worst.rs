//! The worst points of a path: the largest deviation, then the largest one away from those before.

use crate::kernel::Answers;
use crate::path::Track;

/// Smallest distance between worst points, as a fraction of the diagonal of the path.
const APART: f64 = 0.1;

/// Indices of up to `most` points with the largest in-plane deviations, largest first, each a tenth of the diagonal of
/// the path away from those before; of equal ones the first.
pub fn worst_points(track: &Track, answers: &Answers, most: usize) -> Vec<usize> {
    let points = &track.path.points;
    let [low, high] = track.path.corners();
    let apart = APART * (high - low).norm();
    let mut by_size: Vec<(usize, f64)> = answers
        .evaluations()
        .map(|(i, evaluation)| (i, evaluation.in_plane))
        .collect();
    // Only the largest are examined: far more than are reported, far fewer than a long path has.
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

#[cfg(test)]
mod tests {
    use nalgebra::{Point2, Point3, Vector3};

    use super::*;
    use crate::kernel::Evaluation;
    use crate::path::{Placing, Shape};
    use crate::robot::{Branch, PostureName, Unreachable};
    use crate::workpiece::Plane;

    /// A line of 1 m with a point every millimetre, and the deviation of each of its points; all are reached.
    fn answered(in_plane: impl Fn(usize) -> Option<f64>) -> (Track, Answers) {
        let line = Shape::Polyline(vec![Point2::origin(), Point2::new(1.0, 0.0)]);
        let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.0);
        let track = Track {
            path: line.sampled(1e-3),
            placing: Placing::on_plane(&plane),
            base_from_part: plane.base_from_part,
            spins: None,
            homes: None,
        };
        let evaluation = |in_plane| Evaluation {
            name: PostureName::Branch(Branch::ALL[0]),
            limit_margin: 1.0,
            limit_joint: 0,
            singularity: None,
            worst_case: 0,
            in_plane,
            in_plane_uncertainty: None,
            normal: 0.0,
            full: in_plane,
        };
        let point = |i| in_plane(i).map(evaluation).ok_or(Unreachable::TooFar { by: 1.0 });
        let answers = Answers {
            points: (0..track.len()).map(point).collect(),
            joints: Vec::new(),
            deviations: vec![Vector3::zeros(); track.len()],
            shares: Vec::new(),
            clearances: Vec::new(),
            joint_count: 0,
            case_count: 1,
            share_count: 0,
        };
        (track, answers)
    }

    #[test]
    fn each_worst_point_is_a_tenth_of_the_path_from_those_before() {
        // It rises to the end: the last point, then those 100 mm before.
        let (track, answers) = answered(|i| Some(i as f64));
        let worst = worst_points(&track, &answers, 4);
        assert_eq!(worst[0], 1000);
        for pair in worst.windows(2) {
            // 100 steps of a millimetre, and one for rounding.
            assert!((99..=101).contains(&(pair[0] - pair[1])), "{worst:?}");
        }
    }

    #[test]
    fn unreachable_points_are_not_the_worst_and_fewer_than_requested_may_be_found() {
        let (track, answers) = answered(|i| (450..550).contains(&i).then_some(1.0));
        // Of equal ones the first; no other is a tenth of the path away from it.
        assert_eq!(worst_points(&track, &answers, 5), [450]);
        let (track, answers) = answered(|_| None);
        assert!(worst_points(&track, &answers, 5).is_empty());
    }
}
