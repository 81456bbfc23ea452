//! Poses of a body from three reflectors on it, and readings that do not belong to it.
//!
//! Three reflectors on one rigid body keep their distances. A reading that changes both distances of its reflector, while the third
//! distance stays, is a misreading of this reflector; it is replaced by where the body, as it was at the reading before, has that reflector.
//!
//! ```text
//! d_ab(i) = |p_a(i) - p_b(i)|        sigma_ab = 1.4826 median |d_ab - median d_ab|        scatter_ab = 1.4826 median |d_ab(i + 1) - d_ab(i)| / sqrt 2
//! wrong_ab(i):  |d_ab(i) - median d_ab| > max(8 sigma_ab, 20 um)
//! reflector a is misread at i:  wrong_ab(i), wrong_ac(i), not wrong_bc(i)
//! drift_ab:  range of the medians of d_ab over stretches of the readings
//! ```
//!
//! A pose is the displacement and rotation that brings the mean triangle of the body nearest to the readings. On a base that is measured with
//! every pose, poses are referred to its first reading: what the base moves in the frame of the tracker is then taken out.
//!
//! Frames: readings in that of the tracker, m; the body has its origin in the middle of the three reflectors, x from the first to the second, z normal
//! to their plane. Source: W. Kabsch, A solution for the best rotation to relate two sets of vectors, Acta Cryst. A32, 1976; median absolute deviation:
//! P. Rousseeuw and C. Croux, Alternatives to the median absolute deviation, J. Am. Stat. Assoc. 88, 1993.

use nalgebra::Vector3;

use crate::frame::Isometry;
use crate::least_squares::superposed;
use crate::statistics::{median, robust_scatter};

/// Distances that deviate by more than this many robust standard deviations are wrong.
const FAR: f64 = 8.0;
/// Smaller deviations are not, m: the noise of any tracker.
const LEAST: f64 = 2e-5;
/// A body whose distances vary by more than this part of them is not rigid.
const FLEXIBLE: f64 = 2e-3;
/// Stretches of the readings for slow changes.
const STRETCHES: usize = 14;
/// Weight of a reflector that is replaced: it only decides what the two others leave open.
const REPLACED: f64 = 1e-3;
/// The three pairs of reflectors, and the reflector that a pair leaves out.
const PAIRS: [([usize; 2], usize); 3] = [([0, 1], 2), ([0, 2], 1), ([1, 2], 0)];

/// The readings of three reflectors at one pose, m.
pub type Readings = [Vector3<f64>; 3];

/// A body with three reflectors, over all poses.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The reflectors in the frame of the body, m.
    pub triangle: Readings,
    /// `tracker_from_body` at each pose.
    pub poses: Vec<Isometry>,
    /// Misreadings, in the order of the poses.
    pub misread: Vec<Misreading>,
    /// Poses at which two or more reflectors are wrong: they have the pose before them.
    pub undetermined: Vec<usize>,
    /// Robust standard deviation of the distances 1-2, 1-3, 2-3 between neighbouring poses, m.
    pub scatter: [f64; 3],
    /// Slow change of these distances, m: the range of their medians over stretches of the poses.
    pub drift: [f64; 3],
}

/// A reading that does not belong to its reflector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misreading {
    /// Index of the pose.
    pub pose: usize,
    /// Reflector: 0, 1, 2.
    pub reflector: usize,
    /// Its distance from where the body has it, m.
    pub distance: f64,
}

/// Why there is no body.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// No readings.
    #[error("there are no readings")]
    Empty,
    /// A reading that is not finite.
    #[error("reading {} of reflector {} is not a number", .0 + 1, .1 + 1)]
    NotFinite(usize, usize),
    /// Reflectors on a line, or at one place.
    #[error("the three reflectors are on one line: they do not determine a rotation")]
    Line,
    /// Distances that differ by this from pose to pose, m.
    #[error("the distances of the three reflectors differ by {:.1} mm from pose to pose: are they on one body, and the rows of the files in one order?", crate::units::to_mm(*.0))]
    NotRigid(f64),
}

impl Body {
    /// The body with these readings.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn of(readings: &[Readings]) -> Result<Body, BodyError> {
        for (pose, three) in readings.iter().enumerate() {
            if let Some(reflector) = three
                .iter()
                .position(|one| !one.iter().all(|part| part.is_finite()))
            {
                return Err(BodyError::NotFinite(pose, reflector));
            }
        }
        if readings.is_empty() {
            return Err(BodyError::Empty);
        }
        let distances = PAIRS.map(|([a, b], _)| -> Vec<f64> {
            readings
                .iter()
                .map(|three| (three[a] - three[b]).norm())
                .collect()
        });
        let middle = [0, 1, 2].map(|pair| median(&distances[pair]));
        let spread = [0, 1, 2].map(|pair| {
            let off: Vec<f64> = distances[pair].iter().map(|d| d - middle[pair]).collect();
            robust_scatter(&off)
        });
        let wrong = |pose: usize| {
            [0, 1, 2].map(|pair: usize| {
                (distances[pair][pose] - middle[pair]).abs() > (FAR * spread[pair]).max(LEAST)
            })
        };
        let apart = (0..3).find(|pair| spread[*pair] > FLEXIBLE * middle[*pair] + LEAST);
        if let Some(pair) = apart {
            return Err(BodyError::NotRigid(spread[pair]));
        }
        let triangle = triangle(middle).ok_or(BodyError::Line)?;
        let states: Vec<State> = (0..readings.len()).map(|pose| State::of(wrong(pose))).collect();
        let first = states
            .iter()
            .position(|state| *state == State::Whole)
            .ok_or(BodyError::NotRigid(spread[0]))?;
        let mut body = Body {
            triangle,
            poses: Vec::with_capacity(readings.len()),
            misread: Vec::new(),
            undetermined: Vec::new(),
            scatter: [0, 1, 2].map(|pair| short_scatter(&distances[pair])),
            drift: [0, 1, 2].map(|pair| slow_change(&distances[pair], &states)),
        };
        let mut before = placed(&triangle, &readings[first], [1.0; 3]);
        for (pose, (three, state)) in readings.iter().zip(&states).enumerate() {
            match *state {
                State::Whole => before = placed(&triangle, three, [1.0; 3]),
                State::Misread(reflector) => {
                    let mut mended = *three;
                    mended[reflector] = (before * nalgebra::Point3::from(triangle[reflector])).coords;
                    let mut weights = [1.0; 3];
                    weights[reflector] = REPLACED;
                    before = placed(&triangle, &mended, weights);
                    let there = before * nalgebra::Point3::from(triangle[reflector]);
                    body.misread.push(Misreading {
                        pose,
                        reflector,
                        distance: (three[reflector] - there.coords).norm(),
                    });
                }
                State::Undetermined => body.undetermined.push(pose),
            }
            body.poses.push(before);
        }
        Ok(body)
    }

    /// The reflector whose two distances change slowly while the third does not, if there is one: by more than three times the
    /// change of the third, and beyond the scatter of a median.
    pub fn drifting(&self) -> Option<usize> {
        PAIRS.iter().enumerate().find_map(|(still, (_, reflector))| {
            let moving = [0, 1, 2].into_iter().filter(|pair| *pair != still);
            let floor = |pair: usize| 3.0 * self.drift[still].max(self.scatter[pair]);
            moving
                .into_iter()
                .all(|pair| self.drift[pair] > floor(pair))
                .then_some(*reflector)
        })
    }
}

/// What is wrong with a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Nothing; or one distance alone, which no single reflector explains.
    Whole,
    /// This reflector.
    Misread(usize),
    /// More than one.
    Undetermined,
}

impl State {
    /// From which of the distances are wrong.
    fn of(wrong: [bool; 3]) -> State {
        match wrong.iter().filter(|wrong| **wrong).count() {
            0 | 1 => State::Whole,
            3 => State::Undetermined,
            _ => PAIRS
                .iter()
                .zip(wrong)
                .find(|(_, wrong)| !wrong)
                .map_or(State::Undetermined, |((_, reflector), _)| {
                    State::Misread(*reflector)
                }),
        }
    }
}

/// Poses of `body` referred to `base` at its first pose, both measured together: `first_base tracker_from_base^-1 tracker_from_body`.
pub fn referred_to(base: &Body, body: &[Isometry]) -> Vec<Isometry> {
    let Some(first) = base.poses.first() else {
        return body.to_vec();
    };
    let both = base.poses.iter().zip(body);
    both.map(|(base, body)| first * base.inverse() * body).collect()
}

fn placed(triangle: &Readings, readings: &Readings, weights: [f64; 3]) -> Isometry {
    superposed(triangle, readings, &weights)
}

/// Corners of the triangle with the sides 1-2, 1-3, 2-3, about its middle; none if they are on a line.
fn triangle([c, b, a]: [f64; 3]) -> Option<Readings> {
    let x = (b * b + c * c - a * a) / (2.0 * c);
    let height = (b * b - x * x).sqrt();
    if height.is_nan() || height <= 1e-6 * b {
        return None;
    }
    let corners = [
        Vector3::zeros(),
        Vector3::new(c, 0.0, 0.0),
        Vector3::new(x, height, 0.0),
    ];
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    Some(corners.map(|corner| corner - middle))
}

fn short_scatter(distances: &[f64]) -> f64 {
    let steps: Vec<f64> = distances.windows(2).map(|two| two[1] - two[0]).collect();
    robust_scatter(&steps) / std::f64::consts::SQRT_2
}

fn slow_change(distances: &[f64], states: &[State]) -> f64 {
    let good: Vec<f64> = (distances.iter().zip(states))
        .filter(|(_, state)| **state == State::Whole)
        .map(|(distance, _)| *distance)
        .collect();
    let length = good.len().div_ceil(STRETCHES).max(1);
    let medians: Vec<f64> = good.chunks(length).map(median).collect();
    let most = medians.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = medians.iter().copied().fold(f64::INFINITY, f64::min);
    (most - least).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms::Stream;

    const CORNERS: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [0.15, 0.0, 0.0], [0.07, 0.13, 0.0]];

    /// Poses of a body, and the readings of its reflectors with noise of 4 um.
    fn readings(count: usize) -> (Vec<Isometry>, Vec<Readings>) {
        let mut next = Stream(9);
        let mut pose = || Isometry::new(next.vector(1.0), next.vector(2.0));
        let poses: Vec<Isometry> = (0..count).map(|_| pose()).collect();
        let mut noise = Stream(10);
        let three = |pose: &Isometry| {
            CORNERS.map(|corner| {
                let there = pose * nalgebra::Point3::from(corner);
                there.coords + Vector3::from_fn(|_, _| 4e-6 * noise.normal())
            })
        };
        let three = poses.iter().map(three).collect();
        (poses, three)
    }

    /// The largest difference (m, rad) of two rows of poses, after the constant frame of the body.
    fn apart(found: &[Isometry], truth: &[Isometry]) -> f64 {
        let frame = truth[0].inverse() * found[0];
        let each = found.iter().zip(truth).map(|(found, truth)| {
            let off = (truth * frame).inverse() * found;
            off.translation.vector.norm() + off.rotation.angle()
        });
        each.fold(0.0, f64::max)
    }

    #[test]
    fn poses_are_those_of_the_body() {
        let (poses, three) = readings(60);
        let body = Body::of(&three).unwrap();
        // Noise of 4 um over an arm of 0.1 m: rotations within some 1e-4.
        assert!(apart(&body.poses, &poses) < 4e-4);
        assert!(body.misread.is_empty() && body.undetermined.is_empty() && body.drifting().is_none());
        for (pair, side) in [0.15, 0.147_648_230, 0.152_643_375].into_iter().enumerate() {
            let [a, b] = PAIRS[pair].0;
            assert!(((body.triangle[a] - body.triangle[b]).norm() - side).abs() < 3e-6);
            assert!(body.scatter[pair] < 1.2e-5);
        }
    }

    #[test]
    fn misread_reflectors_are_found_and_poses_next_to_them_are_not_changed() {
        let (poses, mut three) = readings(80);
        let clean = Body::of(&three).unwrap();
        let whole = three.clone();
        // The body rests before a misreading, as a base does.
        for (pose, reflector, by) in [(5, 2, 1.97), (6, 2, 0.002), (30, 1, 0.3e-3), (31, 0, 2.0)] {
            three[pose] = whole[if pose < 10 { 4 } else { 29 }];
            three[pose][reflector].y += by;
        }
        three[50][0].x += 0.1;
        three[50][1].x -= 0.2;
        let body = Body::of(&three).unwrap();
        let found: Vec<(usize, usize)> = body.misread.iter().map(|one| (one.pose, one.reflector)).collect();
        assert_eq!(found, [(5, 2), (6, 2), (30, 1), (31, 0)]);
        assert!(
            (body.misread[3].distance - 2.0).abs() < 1e-3,
            "{:?}",
            body.misread
        );
        assert_eq!(body.undetermined, [50]);
        assert_eq!(body.poses[50], body.poses[49]);
        for pose in (0..80).filter(|pose| ![5, 6, 30, 31, 50].contains(pose)) {
            let off = clean.poses[pose].inverse() * body.poses[pose];
            assert!(
                off.translation.vector.norm() + off.rotation.angle() < 2e-5,
                "{pose}"
            );
        }
        let rests = [4, 5].map(|pose| body.poses[pose]);
        assert!(apart(&rests, &[poses[4], poses[4]]) < 4e-4);
    }

    #[test]
    fn a_drifting_reflector_is_distinguished_from_a_base_that_moves() {
        let (_, three) = readings(1);
        let mut noise = Stream(3);
        let mut at = |count: usize, moved: &dyn Fn(f64) -> [Vector3<f64>; 3]| -> Vec<Readings> {
            (0..count)
                .map(|k| {
                    let by = moved(k as f64 / count as f64);
                    [0, 1, 2]
                        .map(|r: usize| three[0][r] + by[r] + Vector3::from_fn(|_, _| 2e-6 * noise.normal()))
                })
                .collect()
        };
        let direction = (three[0][1] - (three[0][0] + three[0][2]) / 2.0).normalize();
        let drifting = at(280, &|part| {
            [Vector3::zeros(), direction * (5e-5 * part), Vector3::zeros()]
        });
        let body = Body::of(&drifting).unwrap();
        assert_eq!(body.drifting(), Some(1), "{:?} {:?}", body.drift, body.scatter);
        let moving = at(280, &|part| [Vector3::x() * (5e-5 * part); 3]);
        let base = Body::of(&moving).unwrap();
        assert_eq!(base.drifting(), None, "{:?}", base.drift);
        // A body that moves with its base does not move on it.
        let referred = referred_to(&base, &base.poses);
        assert!(
            referred
                .iter()
                .all(|pose| (pose.translation.vector - referred[0].translation.vector).norm() < 1e-12)
        );
    }

    #[test]
    fn readings_that_are_no_body_are_refused() {
        let (_, mut three) = readings(10);
        assert_eq!(Body::of(&[]).unwrap_err(), BodyError::Empty);
        three[3][1].z = f64::NAN;
        assert_eq!(Body::of(&three).unwrap_err(), BodyError::NotFinite(3, 1));
        let line: Vec<Readings> = (0..5)
            .map(|_| [0.0, 1.0, 2.0].map(|x| Vector3::new(x, 0.0, 0.0)))
            .collect();
        assert_eq!(Body::of(&line).unwrap_err(), BodyError::Line);
        let mut next = Stream(1);
        let apart: Vec<Readings> = (0..9)
            .map(|_| [next.vector(1.0), next.vector(1.0), next.vector(1.0)])
            .collect();
        assert!(matches!(Body::of(&apart), Err(BodyError::NotRigid(_))));
    }
}
