//! Inverse of any six revolute joints of which the last three, or the first three, meet in one point.
//!
//! ```text
//! E1 ... E6 = X        X = base_from_flange (base_from_flange at zero)^-1
//! ```
//!
//! `Ei` is the rotation by `theta_i` about axis `i` at chain zero. Rotations 4 to 6 do not move the wrist centre `w`:
//! joints 1 to 3 bring `w` to `X w` (`three_turns`), and for the wrist the rotation `Q = (R1 R2 R3)^T R_X` is left. Let
//! `alpha` and `beta` be the angles from axis 4 to 5 and from 5 to 6, and `gamma` that from axis 4 to `Q z6`. On a
//! sphere about `w` they are the sides of a triangle with the angle `psi` at axis 5:
//!
//! ```text
//! tan(psi/2)^2 = sin((gamma + alpha - beta)/2) sin((gamma - alpha + beta)/2)
//!              / sin((alpha + beta + gamma)/2) sin((alpha + beta - gamma)/2)
//! ```
//!
//! Both signs of `psi` are valid; axes 4, 5 and 6 need not be perpendicular. Then joint 4 brings axis 6 to `Q z6`, and
//! joint 6 makes the rest of the turn. An arm whose first three axes meet is the same seen from its flange: `E6^-1 ...
//! E1^-1 = X^-1`.
//!
//! Lengths m, angles rad. Source: Pieper 1968; J. J. Craig, "Introduction to Robotics", 4.6; the wrist by spherical
//! trigonometry.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use super::super::chain::Chain;
use super::closed_form::{CALIBRATED, SLACK};
use super::lines::{IDEAL, Line, across, lines_at_zero};
use super::three_turns::ThreeTurns;
use super::two_links::WRIST_SINGULAR;
use crate::frame::Isometry;

/// The least sine between neighbouring axes of a wrist: nearer to parallel it does not reach most directions.
const PARALLEL: f64 = 0.05;
/// How far (rad) beyond its range the wrist of a calibrated arm may still answer.
const WRIST_SLACK: f64 = 0.02;

/// Six revolute joints with a spherical wrist at one end.
#[derive(Clone, Debug)]
pub struct SphericalWrist {
    arm: ThreeTurns,
    /// Axes at chain zero, the wrist last: those of a reversed chain in reversed order.
    lines: [Line; 6],
    wrist: Point3<f64>,
    flange_from_base_at_zero: Isometry,
    reversed: bool,
    /// How far (m) beyond its reach it answers: more than zero for the ideal neighbour of a calibrated arm.
    slack: f64,
    /// Angles from axis 4 to 5 and from 5 to 6, and from the plane of 4 and 5 to 6 at chain zero.
    alpha: f64,
    beta: f64,
    psi_at_zero: f64,
}

impl SphericalWrist {
    /// The geometry of `chain`, or `None` if it is of another kind. A wrist at the flange is taken first.
    pub fn recognise(chain: &Chain) -> Option<SphericalWrist> {
        SphericalWrist::of(&lines_at_zero(chain)?, &chain.base_from_flange(&[0.0; 6]), IDEAL)
    }

    /// The geometry next to that of `chain` whose wrist axes are moved into one point, by less than [`CALIBRATED`].
    pub(super) fn next_to(chain: &Chain) -> Option<SphericalWrist> {
        SphericalWrist::of(
            &lines_at_zero(chain)?,
            &chain.base_from_flange(&[0.0; 6]),
            CALIBRATED,
        )
    }

    /// The arm with these axes and this flange at zero, if three axes at one end miss a point by less than `within`
    /// (m).
    pub(super) fn of(lines: &[Line; 6], at_zero: &Isometry, within: f64) -> Option<SphericalWrist> {
        let [a, b, c, d, e, f] = *lines;
        SphericalWrist::with_wrist_last([a, b, c, d, e, f], at_zero, false, within)
            .or_else(|| SphericalWrist::with_wrist_last([f, e, d, c, b, a], at_zero, true, within))
    }

    fn with_wrist_last(
        mut lines: [Line; 6],
        at_zero: &Isometry,
        reversed: bool,
        within: f64,
    ) -> Option<SphericalWrist> {
        let wrist = meeting([&lines[3], &lines[4], &lines[5]])?;
        let deviation = lines[3..]
            .iter()
            .map(|line| line.distance(wrist))
            .fold(0.0, f64::max);
        if deviation >= within {
            return None;
        }
        for line in &mut lines[3..] {
            line.point = wrist;
        }
        let [z4, z5, z6] = [3, 4, 5].map(|i| lines[i].axis);
        let between = |a: &Vector3<f64>, b: &Vector3<f64>| a.cross(b).norm().atan2(a.dot(b));
        let (alpha, beta) = (between(&z4, &z5), between(&z5, &z6));
        if alpha.sin() < PARALLEL || beta.sin() < PARALLEL {
            return None;
        }
        let arm = ThreeTurns::new([lines[0], lines[1], lines[2]], wrist);
        arm.moves_freely().then(|| SphericalWrist {
            arm,
            lines,
            wrist,
            flange_from_base_at_zero: at_zero.inverse(),
            reversed,
            slack: if within > IDEAL { SLACK } else { 0.0 },
            alpha,
            beta,
            psi_at_zero: turn_about(&z5, &z4, &z6),
        })
    }

    /// Whether its wrist axes meet exactly.
    pub fn is_exact(&self) -> bool {
        self.slack == 0.0
    }

    /// Chain positions that bring the flange to `base_from_flange`, modulo whole turns: up to four of the arm with
    /// two of the wrist each. Joints that a singularity leaves free keep their positions in `kept` (chain positions,
    /// rad); without, the first is at zero and the outer two of the wrist share the turn evenly.
    ///
    /// Not checked: forward kinematics (see [`verify`](fn@super::verify)). Of an arm that is not exact they are starting values.
    pub fn chain_positions(&self, base_from_flange: &Isometry, kept: Option<&[f64; 6]>) -> Vec<[f64; 6]> {
        let moved = base_from_flange * self.flange_from_base_at_zero;
        let x = if self.reversed { moved.inverse() } else { moved };
        let kept = kept.map(|kept| self.in_order(*kept));
        let mut found = Vec::with_capacity(8);
        let first = kept.map_or(0.0, |kept| kept[0]);
        for [a, b, c] in self.arm.bring_to(&(x * self.wrist), self.slack, first) {
            let turn = self.lines[0].rotation(a) * self.lines[1].rotation(b) * self.lines[2].rotation(c);
            let left = turn.inverse() * x.rotation.to_rotation_matrix();
            for [d, e, f] in self.wrist(&left, kept.map(|kept| kept[3])) {
                found.push(self.in_order([a, b, c, d, e, f]));
            }
        }
        found
    }

    /// Positions in the order and sense of the chain from those of the arm with its wrist last, and back.
    fn in_order(&self, theta: [f64; 6]) -> [f64; 6] {
        if self.reversed {
            let [a, b, c, d, e, f] = theta;
            [-f, -e, -d, -c, -b, -a]
        } else {
            theta
        }
    }

    /// Positions of joints 4 to 6 that turn by `q`.
    fn wrist(&self, q: &Rotation3<f64>, kept: Option<f64>) -> Vec<[f64; 3]> {
        let [z4, z5, z6] = [3, 4, 5].map(|i| self.lines[i].axis);
        let out = q * z6;
        let gamma = z4.cross(&out).norm().atan2(z4.dot(&out));
        let half_sine = |angle: f64| (0.5 * angle).sin();
        let (alpha, beta) = (self.alpha, self.beta);
        let near = half_sine(gamma + alpha - beta) * half_sine(gamma - alpha + beta);
        let far = half_sine(alpha + beta + gamma) * half_sine(alpha + beta - gamma);
        let beyond = if self.is_exact() { IDEAL } else { WRIST_SLACK };
        if near < -beyond || far < -beyond {
            return Vec::new();
        }
        let mut psi = 2.0 * near.max(0.0).sqrt().atan2(far.max(0.0).sqrt());
        if !self.is_exact() {
            // Nearly straight, so that both signs start apart.
            psi = psi.clamp(WRIST_SLACK, PI - WRIST_SLACK);
        }
        let side = across(z5, &z6);
        let with = |psi: f64| {
            let theta5 = psi - self.psi_at_zero;
            let bent = self.lines[4].rotation(theta5);
            let tip = bent * z6;
            let rest = |theta4: f64| {
                let left = self.lines[3].rotation(theta4) * bent * side;
                turn_about(&out, &left, &(q * side))
            };
            let theta4 = if z4.cross(&tip).norm() < WRIST_SINGULAR {
                // Only the sum (or difference) of joints 4 and 6 has an effect here.
                kept.unwrap_or_else(|| 0.5 * rest(0.0) * z4.dot(&out).signum())
            } else {
                turn_about(&z4, &tip, &out)
            };
            [theta4, theta5, rest(theta4)]
        };
        if psi == 0.0 {
            vec![with(0.0)]
        } else {
            vec![with(psi), with(-psi)]
        }
    }
}

/// The angle about the unit vector `axis` from `from` to `to`, both seen along it; zero where one of them is on it.
fn turn_about(axis: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    let across = axis.cross(from);
    across.dot(to).atan2(across.dot(&axis.cross(to)))
}

/// The point with the least sum of squared distances from these lines; `None` where they are all parallel.
fn meeting(lines: [&Line; 3]) -> Option<Point3<f64>> {
    let off = |line: &Line| Matrix3::identity() - line.axis * line.axis.transpose();
    let origin = lines[1].point;
    let normal: Matrix3<f64> = lines.iter().map(|line| off(line)).sum();
    let right: Vector3<f64> = lines.iter().map(|line| off(line) * (line.point - origin)).sum();
    (normal.determinant() > IDEAL).then(|| normal.cholesky().map(|factor| origin + factor.solve(&right)))?
}

#[cfg(test)]
mod tests;
