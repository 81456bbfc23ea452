//! The plane of an arm, and the triangle of upper arm and forearm in it: the angles that bring its end to a point.
//!
//! ```text
//! eps:  cos = (d^2 - l2^2 - l3^2) / (2 l2 l3), sin = +-sqrt(...)           d^2 = u^2 + v^2
//! psi:  (cos, sin) = (v k1 + u k2, u k1 - v k2) / d^2                       k1 = l2 + l3 cos eps, k2 = l3 sin eps
//! ```
//!
//! `u` to the front, `v` upwards, from the shoulder (m); `psi` of the upper arm and `chi` of the forearm from the
//! vertical towards the front; `eps = chi - psi`. Source: textbook geometry; `docs/theory/inverse.md`.

use nalgebra::Point3;

use super::super::branch::{Elbow, Shoulder};
use super::super::posture::Singularity;
use super::super::unreachable::Unreachable;
use super::lines::Turn;
use crate::numbers::{Float, Real};

/// A posture nearer than this (sine of 1 deg) to a singularity is flagged.
pub(crate) const NEAR_SINGULAR: f64 = 0.017_452_406;
/// Below this sine of the wrist bend joints 4 and 6 are not distinguishable.
pub(crate) const WRIST_SINGULAR: f64 = 1e-9;
const _: () = assert!(WRIST_SINGULAR * WRIST_SINGULAR == <f64 as Float>::NOTHING);

/// Lengths of upper arm and forearm, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwoLinks {
    pub l2: f64,
    pub l3: f64,
    /// How far (m) beyond its reach the arm still answers, with its elbow nearly straight: zero except for starting
    /// values.
    pub slack: f64,
}

/// Bend of the elbow, as a fraction of the reach, in the answer to a point beyond it.
pub(crate) const NEARLY_STRAIGHT: f64 = 2e-3;

impl TwoLinks {
    /// Signed distance of `p` (m, arm axes) from axis 1 in the plane of the links, which has the offset `b` (m) from
    /// that axis; and the turn that brings the plane there.
    pub(super) fn reach(
        &self,
        p: &Point3<f64>,
        b: f64,
        shoulder: Shoulder,
    ) -> Result<(f64, Turn), Unreachable> {
        let r_squared = p.x * p.x + p.y * p.y - b * b;
        if r_squared < 0.0 {
            let by = b.abs() - p.x.hypot(p.y);
            if by >= self.slack {
                return Err(Unreachable::InsideLateralOffset { by });
            }
        }
        let r = match shoulder {
            Shoulder::Front => r_squared.max(0.0).sqrt(),
            Shoulder::Back => -r_squared.max(0.0).sqrt(),
        };
        Ok((r, Turn::new(r * p.x + b * p.y, r * p.y - b * p.x)))
    }

    /// Angles of upper arm and forearm that bring its end to (`u`, `v`).
    pub(super) fn solve(&self, u: f64, v: f64, elbow: Elbow) -> Result<(Turn, Turn), Unreachable> {
        Ok(self.turns(u, v, self.across(u, v, elbow)?))
    }

    /// Distance (m) of its end from the line of the upper arm: `l3` times the sine of the elbow's bend.
    pub(super) fn across(&self, u: f64, v: f64, elbow: Elbow) -> Result<f64, Unreachable> {
        let d_squared = u * u + v * v;
        let (reach, fold) = (self.l2 + self.l3, self.l2 - self.l3);
        let (mut stretched, mut folded) = (reach * reach - d_squared, d_squared - fold * fold);
        if stretched < 0.0 {
            let by = d_squared.sqrt() - reach;
            if by >= self.slack {
                return Err(Unreachable::TooFar { by });
            }
        }
        if folded < 0.0 {
            let by = fold.abs() - d_squared.sqrt();
            if by >= self.slack {
                return Err(Unreachable::TooNear { by });
            }
        }
        if self.slack > 0.0 {
            let least = NEARLY_STRAIGHT * self.l2 * self.l3;
            (stretched, folded) = (stretched.max(least), folded.max(least));
        }
        let across = 0.5 * (stretched * folded).sqrt() / self.l2;
        // Bending the forearm forwards lifts the elbow if the wrist is before the shoulder.
        Ok(if (elbow == Elbow::Up) == (u >= 0.0) {
            across
        } else {
            -across
        })
    }

    /// Angles of upper arm and forearm that bring its end to (`u`, `v`), with the end [`across`](Self::across) from
    /// the upper arm.
    #[inline(always)]
    pub(super) fn turns<R: Real>(&self, u: R, v: R, across: R) -> (Turn<R>, Turn<R>) {
        let l2 = R::of(self.l2);
        let k1 =
            u.mul_add(u, v.mul_add(v, R::of(self.l2 * self.l2 - self.l3 * self.l3))) * R::of(0.5 / self.l2);
        let psi = Turn::new(v.mul_add(k1, u * across), u.mul_add(k1, -(v * across)));
        let chi = Turn::new((-l2).mul_add(psi.cos, v), (-l2).mul_add(psi.sin, u));
        (psi, chi)
    }

    /// The singularity that an arm is near with these sines of wrist bend and elbow bend, and its wrist centre at
    /// the signed distance `r` (m) from axis 1.
    pub(super) fn singularity(&self, sin_bend: f64, sin_elbow: f64, r: f64) -> Option<Singularity> {
        if sin_bend.abs() < NEAR_SINGULAR {
            Some(Singularity::Wrist)
        } else if sin_elbow.abs() < NEAR_SINGULAR {
            Some(Singularity::Elbow)
        } else if r.abs() < NEAR_SINGULAR * (self.l2 + self.l3) {
            Some(Singularity::Shoulder)
        } else {
            None
        }
    }

    /// Up or down, from the bend (rad) and the coordinate `u` of the end, to the front of the shoulder.
    pub fn elbow(bend: f64, u: f64) -> Elbow {
        if (bend.sin() >= 0.0) == (u >= 0.0) {
            Elbow::Up
        } else {
            Elbow::Down
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: TwoLinks = TwoLinks {
        l2: 0.6,
        l3: 0.5,
        slack: 0.0,
    };

    #[test]
    fn both_elbows_end_at_the_point_and_the_upper_one_is_higher() {
        for (u, v) in [(0.7, 0.3), (-0.4, 0.5), (0.2, -0.6)] {
            let ends = [Elbow::Up, Elbow::Down].map(|elbow| {
                let (psi, chi) = ARM.solve(u, v, elbow).unwrap();
                let end = [0.6 * psi.sin + 0.5 * chi.sin, 0.6 * psi.cos + 0.5 * chi.cos];
                assert!((end[0] - u).hypot(end[1] - v) < 1e-15);
                assert_eq!(TwoLinks::elbow(chi.less(psi).angle(), u), elbow);
                psi.cos
            });
            assert!(ends[0] > ends[1], "({u}, {v})");
        }
    }

    #[test]
    fn slack_answers_slightly_beyond_the_reach_with_both_elbows() {
        let miss = ARM.solve(1.11, 0.0, Elbow::Up).unwrap_err();
        assert!(matches!(miss, Unreachable::TooFar { by } if (by - 0.01).abs() < 1e-12));
        let slack = TwoLinks { slack: 0.02, ..ARM };
        let bend = |elbow| {
            let (psi, chi) = slack.solve(1.11, 0.0, elbow).unwrap();
            chi.less(psi).angle()
        };
        assert!(bend(Elbow::Up) > 0.01 && bend(Elbow::Down) < -0.01);
        assert!(slack.solve(1.13, 0.0, Elbow::Up).is_err());
    }

    #[test]
    fn the_miss_is_reported_in_metres() {
        for (u, v) in [(0.03, 0.04), (0.0, -0.05), (-0.05, 0.0)] {
            // The folded arm stays 0.6 - 0.5 m away.
            let miss = ARM.solve(u, v, Elbow::Down).unwrap_err();
            assert!(
                matches!(miss, Unreachable::TooNear { by } if (by - 0.05).abs() < 1e-15),
                "{miss}"
            );
        }
        let point = Point3::new(0.03, -0.04, 1.0);
        for (b, missing) in [(0.08, 0.03), (-0.08, 0.03)] {
            let miss = ARM.reach(&point, b, Shoulder::Front).unwrap_err();
            assert!(matches!(miss, Unreachable::InsideLateralOffset { by } if (by - missing).abs() < 1e-15));
        }
        assert!(ARM.reach(&point, 0.0499, Shoulder::Back).is_ok());
    }

    #[test]
    fn the_plane_of_the_arm_is_rotated_until_it_contains_the_point() {
        for b in [0.0, 0.05, -0.2] {
            for i in 0..12 {
                let at = 0.5 * f64::from(i);
                let p = Point3::new(0.7 * at.cos(), 0.7 * at.sin(), 0.3);
                for (shoulder, side) in [(Shoulder::Front, 1.0), (Shoulder::Back, -1.0)] {
                    let (r, phi) = ARM.reach(&p, b, shoulder).unwrap();
                    let turned = phi.back_about_z(p.coords);
                    assert!((turned - nalgebra::Vector3::new(r, b, 0.3)).norm() < 1e-15);
                    assert!(r * side > 0.0);
                }
            }
        }
    }

    #[test]
    fn singularities_are_flagged_within_a_degree_the_wrist_first() {
        let near = NEAR_SINGULAR;
        assert!((near - 1_f64.to_radians().sin()).abs() < 1e-9);
        let (in_line, clear) = (0.9 * near, 1.1 * near);
        for side in [1.0, -1.0] {
            assert_eq!(
                ARM.singularity(side * in_line, 1.0, 1.0),
                Some(Singularity::Wrist)
            );
            assert_eq!(
                ARM.singularity(clear, side * in_line, 1.0),
                Some(Singularity::Elbow)
            );
            // The shoulder is scaled by the length of the arm: 1.1 m.
            assert_eq!(
                ARM.singularity(clear, clear, side * 1.1 * in_line),
                Some(Singularity::Shoulder)
            );
            assert_eq!(ARM.singularity(clear, clear, side * 1.1 * clear), None);
        }
        assert_eq!(ARM.singularity(0.0, 0.0, 0.0), Some(Singularity::Wrist));
        assert_eq!(ARM.singularity(1.0, 0.0, 0.0), Some(Singularity::Elbow));
    }

    #[test]
    fn straight_and_folded_arms_are_reached_exactly() {
        for (d, bend) in [(1.1, 0.0), (0.1, std::f64::consts::PI)] {
            for elbow in [Elbow::Up, Elbow::Down] {
                let (psi, chi) = ARM.solve(0.6 * d, 0.8 * d, elbow).unwrap();
                // The bend at the end of a branch is accurate to the root of rounding.
                assert!((chi.less(psi).angle().abs() - bend).abs() < 1e-7);
                let end = [0.6 * psi.sin + 0.5 * chi.sin, 0.6 * psi.cos + 0.5 * chi.cos];
                assert!((end[0] - 0.6 * d).hypot(end[1] - 0.8 * d) < 1e-8);
            }
        }
    }
}
