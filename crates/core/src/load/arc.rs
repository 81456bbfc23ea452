//! The arc over which a point of the edge cuts, and integrals over it in closed form.
//!
//! ```text
//! h(phi) = a sin(phi) + b        integrals of 1, sin, cos and of h, h sin, h cos from entry to exit
//! ```
//!
//! They are given by the middle `m` and the half width `w` of the arc, so that a short arc keeps its digits:
//! `cos p - cos q = 2 sin m sin w`.

use nalgebra::{Matrix3, Vector3};

use super::cutter::{EdgePoint, Hand};

/// From `entry` to `exit`, rad; see [`super::engagement`] for the angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EngagedArc {
    /// Where a tooth enters, rad.
    pub entry: f64,
    /// Where it leaves, rad; beyond `entry`.
    pub exit: f64,
}

/// Chip thickness as a function of the immersion angle: `across sin(phi) + along`, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chip {
    pub(super) across: f64,
    pub(super) along: f64,
}

/// Integrals of a weight, of it times `sin(phi)`, and of it times `cos(phi)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moments {
    pub(super) one: f64,
    pub(super) sin: f64,
    pub(super) cos: f64,
}

impl Chip {
    /// Thickness at `phi`, m; negative where the edge does not reach the part.
    pub(super) fn at(self, phi: f64) -> f64 {
        self.across * phi.sin() + self.along
    }

    /// The part of the arc, inside 0 to 180 deg, in which the chip is not negative.
    pub(super) fn cut_part(self, arc: EngagedArc) -> Option<EngagedArc> {
        if self.along >= 0.0 {
            return Some(arc);
        }
        let least_sine = -self.along / self.across;
        if self.across <= 0.0 || least_sine >= 1.0 {
            return None;
        }
        let begin = least_sine.asin();
        arc.common_with(EngagedArc {
            entry: begin,
            exit: std::f64::consts::PI - begin,
        })
    }
}

impl EngagedArc {
    /// The intersection of both.
    pub(super) fn common_with(self, other: EngagedArc) -> Option<EngagedArc> {
        let common = EngagedArc {
            entry: self.entry.max(other.entry),
            exit: self.exit.min(other.exit),
        };
        (common.exit > common.entry).then_some(common)
    }

    /// Whether it contains `phi` (rad, from 0 to a turn).
    pub(super) fn contains(self, phi: f64) -> bool {
        self.entry <= phi && phi <= self.exit
    }

    /// Integrals over the arc with the weight 1, and with the weight `chip`.
    pub(super) fn moments(self, chip: Chip) -> [Moments; 2] {
        let (m, w) = (0.5 * (self.entry + self.exit), 0.5 * (self.exit - self.entry));
        let ((sin_m, cos_m), (sin_w, cos_w)) = (m.sin_cos(), w.sin_cos());
        let plain = Moments {
            one: 2.0 * w,
            sin: 2.0 * sin_m * sin_w,
            cos: 2.0 * cos_m * sin_w,
        };
        // w - 1/2 sin 2w cos 2m, and 1/2 sin 2w sin 2m.
        let sin_sin = w - sin_w * cos_w * (cos_m * cos_m - sin_m * sin_m);
        let sin_cos = 2.0 * sin_w * cos_w * sin_m * cos_m;
        let Chip { across: a, along: b } = chip;
        let weighted = Moments {
            one: a * plain.sin + b * plain.one,
            sin: a * sin_sin + b * plain.sin,
            cos: a * sin_cos + b * plain.cos,
        };
        [plain, weighted]
    }
}

impl Moments {
    /// Of a single angle with the weight 1.
    pub(super) fn at(phi: f64) -> Moments {
        let (sin, cos) = phi.sin_cos();
        Moments { one: 1.0, sin, cos }
    }

    /// Force on the tool (feed frame) per unit of tangential, radial and axial force on the edge at `point`.
    ///
    /// Tangential: against the way of the tooth. Radial: along the inward normal of the body. Axial: along the
    /// profile to the tip, for a right-hand helix.
    pub(super) fn directions(self, point: &EdgePoint, hand: Hand) -> Matrix3<f64> {
        let (sin_kappa, cos_kappa) = (point.sin_kappa, point.cos_kappa);
        let tangential = Vector3::new(-self.cos, self.sin, 0.0);
        let radial = Vector3::new(-self.sin * sin_kappa, -self.cos * sin_kappa, self.one * cos_kappa);
        let axial = Vector3::new(
            -self.sin * cos_kappa,
            -self.cos * cos_kappa,
            -self.one * sin_kappa,
        );
        Matrix3::from_columns(&[tangential, radial, axial * hand.sign()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Simpson's rule with so many pieces that its error (step^4/180) is below rounding.
    fn simpson(arc: EngagedArc, f: impl Fn(f64) -> f64) -> f64 {
        let pieces = 4000;
        let step = (arc.exit - arc.entry) / f64::from(pieces);
        let term = |i: i32| {
            let weight = match i {
                0 => 1.0,
                _ if i == pieces => 1.0,
                _ if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            weight * f(arc.entry + f64::from(i) * step)
        };
        (0..=pieces).map(term).sum::<f64>() * step / 3.0
    }

    #[test]
    fn closed_integrals_match_simpsons_rule() {
        let chip = Chip {
            across: 0.18,
            along: 0.03,
        };
        for arc in [
            EngagedArc { entry: 0.0, exit: PI },
            EngagedArc {
                entry: 0.3,
                exit: 1.1,
            },
            EngagedArc {
                entry: 1.9,
                exit: 1.900_01,
            },
        ] {
            let [plain, weighted] = arc.moments(chip);
            let pairs = [
                (plain.one, simpson(arc, |_| 1.0)),
                (plain.sin, simpson(arc, f64::sin)),
                (plain.cos, simpson(arc, f64::cos)),
                (weighted.one, simpson(arc, |p| chip.at(p))),
                (weighted.sin, simpson(arc, |p| chip.at(p) * p.sin())),
                (weighted.cos, simpson(arc, |p| chip.at(p) * p.cos())),
            ];
            for (closed, numeric) in pairs {
                // Thousands of terms, each rounded.
                assert!((closed - numeric).abs() < 1e-13 * (arc.exit - arc.entry).max(1e-2));
            }
        }
    }

    #[test]
    fn where_the_edge_lifts_off_there_is_no_chip() {
        let half = EngagedArc { entry: 0.0, exit: PI };
        let lifting = Chip {
            across: 1.0,
            along: -0.5,
        };
        let cut = lifting.cut_part(half).unwrap();
        assert!((cut.entry - PI / 6.0).abs() < 1e-15 && (cut.exit - PI * 5.0 / 6.0).abs() < 1e-15);
        let off = Chip {
            across: 1.0,
            along: -1.5,
        };
        assert_eq!(off.cut_part(half), None);
        let still = Chip {
            across: 0.0,
            along: 0.0,
        };
        assert_eq!(
            still.cut_part(half),
            Some(half),
            "an edge that rubs still touches"
        );
    }
}
