//! Number of reversals of each joint along a path. A reversal leaves a backlash mark on the part.

use crate::kernel::Answers;
use crate::path::SampledPath;
use crate::robot::STANDSTILL;

/// Number of reversals of each joint on the cuts of `path`; rapids and points without a posture are not included.
pub fn reversals(path: &SampledPath, answers: &Answers) -> Vec<usize> {
    let mut component = vec![0; answers.joint_count];
    for stretch in path.stretches() {
        // Farthest position of each joint since its last reversal, and its direction.
        let mut ends: Option<Vec<(f64, f64)>> = None;
        for index in stretch {
            if answers.points[index].is_err() {
                ends = None;
                continue;
            }
            let joints = answers.joints_at(index);
            let Some(ends) = &mut ends else {
                ends = Some(joints.iter().map(|q| (*q, 0.0)).collect());
                continue;
            };
            for ((count, (end, way)), q) in component.iter_mut().zip(ends).zip(joints) {
                let by = q - *end;
                if by * *way >= 0.0 && (*way != 0.0 || by.abs() > STANDSTILL) {
                    (*end, *way) = (*q, if by == 0.0 { *way } else { by.signum() });
                } else if by.abs() > STANDSTILL {
                    *count += usize::from(*way != 0.0);
                    (*end, *way) = (*q, by.signum());
                }
            }
        }
    }
    component
}

#[cfg(test)]
mod tests {
    use nalgebra::Point2;

    use super::*;
    use crate::arms::answers_at;
    use crate::path::Shape;
    use crate::robot::Unreachable;

    fn path(points: usize) -> SampledPath {
        let end = Point2::new(points as f64 - 1.0, 0.0);
        Shape::Polyline(vec![Point2::origin(), end]).sampled(1.0)
    }

    #[test]
    fn a_wave_reverses_at_each_crest_and_small_oscillations_are_ignored() {
        let joints: Vec<[f64; 2]> = (0..401)
            .map(|k| {
                let t = f64::from(k) * 0.05;
                // 20 rad of a cosine are 6 half turns: crests at pi, 2 pi, ... 6 pi.
                [t.cos(), 0.01 * t + 3e-7 * (40.0 * t).sin()]
            })
            .collect();
        assert_eq!(reversals(&path(401), &answers_at(&joints)), [6, 0]);
    }

    #[test]
    fn a_joint_that_waits_and_continues_has_no_reversal() {
        let at = [0.0, 0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 2.0];
        let joints: Vec<[f64; 2]> = at.iter().map(|q| [*q, -q]).collect();
        assert_eq!(reversals(&path(8), &answers_at(&joints)), [1, 1]);
    }

    #[test]
    fn no_reversal_is_reported_across_a_rapid_or_an_unreachable_point() {
        let joints = [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [1.0, 0.0]];
        let mut answers = answers_at(&joints);
        assert_eq!(reversals(&path(4), &answers), [2, 0]);
        answers.points[2] = Err(Unreachable::TooFar { by: 1.0 });
        assert_eq!(reversals(&path(4), &answers), [0, 0]);
        let mut two = path(2);
        two.points.extend(two.points.clone());
        assert_eq!(reversals(&two, &answers_at(&joints)), [0, 0]);
    }
}
