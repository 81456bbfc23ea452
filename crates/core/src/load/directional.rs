//! Directional factors: the force that a displacement of the tool against the surface of the tooth before makes.
//!
//! ```text
//! dF = D(phi) f'(h) n^T (u - u_before) db        n = (sin phi sin kappa, cos phi sin kappa, -cos kappa)
//! A(t) = sum over the teeth of the integral of D(phi) f'(h) n^T db along the edge
//! A_0  = N/(2 pi) integral over db integral from entry to exit of D(phi) f'(h) n^T dphi
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `u`, `u_before` | displacement of the tool now and one tooth period ago, feed frame | m |
//! | `n` | outward normal of the body at the edge: a displacement along it makes the chip thicker | - |
//! | `D` | force on the tool per tangential, radial and axial force on the edge | - |
//! | `f'(h)` | derivative of the cutting law by the thickness of the chip, at that of the feed | Pa |
//! | `A`, `A_0` | directional matrix, 3 x 3, and its mean over a revolution | N/m |
//!
//! Runout is neglected: every tooth cuts the same chip. Kienzle's law has no derivative at a chip of thickness zero; below
//! 1 um, which is less than the radius of an edge, its derivative at 1 um is used.
//!
//! Source: Altintas, Budak, Analytical prediction of stability lobes in milling, CIRP Annals 44 (1995) \[recalled\]; here with all
//! three directions, signs of [`super::engagement`].

use nalgebra::{Matrix3, Vector3};

use super::arc::{EngagedArc, Moments};
use super::cutter::EdgePoint;
use super::edge_part::{EdgePart, parts};
use super::law::CuttingLaw;
use super::milling::Milling;
use super::quadrature::{nodes_between_powers, nodes_from_root, unit_nodes};

/// Gauss-Legendre nodes and weights on (0, 1): exact up to degree 5 of the angle within one step.
const STEP_NODES: [[f64; 2]; 3] = [
    [0.112_701_665_379_258_31, 5.0 / 18.0],
    [0.5, 8.0 / 18.0],
    [0.887_298_334_620_741_7, 5.0 / 18.0],
];
/// Slices of each part of the edge where the angle of the spindle matters.
const SLICES: u32 = 64;

impl Milling {
    /// `A_0`: mean directional matrix over a revolution, N/m, feed frame. The helix has no effect on it.
    pub fn mean_directional(&self) -> Matrix3<f64> {
        let sum = match self.leaning {
            None => self.upright_integral(),
            Some(_) => self.leaning_integral(),
        };
        sum / self.cutter.pitch()
    }

    fn upright_integral(&self) -> Matrix3<f64> {
        let mut sum = Matrix3::zeros();
        let straight = self.cut.depth - self.cutter.corner_radius();
        if straight > 0.0 {
            sum += self.over_arcs(&self.cutter.at_height(self.cut.depth), straight);
        }
        let r = self.cutter.corner_radius();
        if r == 0.0 {
            return sum;
        }
        let mut from = 0.0;
        for kink in self.kinks(self.cutter.corner_end(self.cut.depth)) {
            for (kappa, weight) in nodes_from_root(from, kink) {
                sum += self.over_arcs(&self.cutter.in_corner(kappa), r * weight);
            }
            from = kink;
        }
        sum
    }

    fn leaning_integral(&self) -> Matrix3<f64> {
        let mut sum = Matrix3::zeros();
        for part in parts(&self.cutter, &self.cut, self.leaning.as_ref()) {
            let arcs = |along: f64| self.arcs_at(&part.point(&self.cutter, along));
            for [from, to] in part.pieces(arcs) {
                for (along, weight) in nodes_between_powers(from, to) {
                    let point = part.point(&self.cutter, along);
                    sum += self.over_arcs(&point, part.width(&self.cutter) * weight);
                }
            }
        }
        sum
    }

    /// Means of the directional matrix (N/m, feed frame) over `steps` even steps of one pitch, from tooth 0 at the angle zero.
    ///
    /// Exact in the angle for a straight edge; a helix is summed over 64 slices.
    pub fn directional_over_pitch(&self, steps: usize) -> Vec<Matrix3<f64>> {
        let mut sums = vec![Matrix3::zeros(); steps];
        let step = self.cutter.pitch() / steps as f64;
        for part in parts(&self.cutter, &self.cut, self.leaning.as_ref()) {
            let is_alike = self.leaning.is_none() && self.cutter.helix() == 0.0;
            let slices = match part {
                EdgePart::Cylinder(_) if is_alike => 1,
                _ => SLICES,
            };
            for (point, width) in part.middles(&self.cutter, slices) {
                let lag = self.cutter.lag(point.height);
                for arc in self.arcs_that_cut(&point) {
                    self.spread(&point, [lag, width / step], arc, &mut sums);
                }
            }
        }
        sums
    }

    /// Adds an arc of a point to the steps that the tip of its tooth passes: `lag` behind the tip, mean over a step with `weight`.
    fn spread(&self, point: &EdgePoint, [lag, weight]: [f64; 2], arc: EngagedArc, sums: &mut [Matrix3<f64>]) {
        let steps = sums.len() as i64;
        let step = self.cutter.pitch() / steps as f64;
        let (from, to) = (arc.entry + lag, arc.exit + lag);
        let mut index = (from / step).floor() as i64;
        while index as f64 * step < to {
            let (low, high) = (
                (index as f64 * step).max(from),
                ((index + 1) as f64 * step).min(to),
            );
            if high > low {
                let sum = &mut sums[index.rem_euclid(steps) as usize];
                for [node, part] in STEP_NODES {
                    let phi = low + node * (high - low) - lag;
                    *sum += self.factor(point, phi) * (part * (high - low) * weight);
                }
            }
            index += 1;
        }
    }

    /// The arcs of a point without those parts where a rising feed lifts the edge off.
    fn arcs_that_cut(&self, point: &EdgePoint) -> impl Iterator<Item = EngagedArc> {
        let chip = self.chip(point);
        let is_upright = self.leaning.is_none();
        let arcs: Vec<EngagedArc> = self
            .arcs_at(point)
            .iter()
            .filter_map(|arc| if is_upright { chip.cut_part(arc) } else { Some(arc) })
            .collect();
        arcs.into_iter()
    }

    /// The integral over the angle at one point, times its chip width.
    fn over_arcs(&self, point: &EdgePoint, width: f64) -> Matrix3<f64> {
        let mut sum = Matrix3::zeros();
        for arc in self.arcs_that_cut(point) {
            match &self.law {
                CuttingLaw::Mechanistic(_) => {
                    let span = arc.exit - arc.entry;
                    for (node, weight) in unit_nodes() {
                        sum += self.factor(point, arc.entry + node * span) * (weight * span);
                    }
                }
                CuttingLaw::Kienzle(_) => {
                    for (phi, weight) in nodes_between_powers(arc.entry, arc.exit) {
                        sum += self.factor(point, phi) * weight;
                    }
                }
            }
        }
        sum * width
    }

    /// `D f'(h) n^T` at the immersion angle `phi`, Pa.
    fn factor(&self, point: &EdgePoint, phi: f64) -> Matrix3<f64> {
        let directions = Moments::at(phi).directions(point, self.cutter.hand());
        let (sin, cos) = phi.sin_cos();
        let normal = Vector3::new(sin * point.sin_kappa, cos * point.sin_kappa, -point.cos_kappa);
        directions * self.law.by_thickness(self.chip(point).at(phi)) * normal.transpose()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::load::{
        Cut, Cutter, Engagement, Estimate, Hand, Immersion, Kienzle, KienzleValues, LeanInCut, Mechanistic,
    };

    const MM: f64 = 1e-3;

    fn milling(cutter: Cutter, law: CuttingLaw, immersion: Immersion) -> Milling {
        let depth = 2.0 * MM;
        let cut = Cut {
            depth,
            engagement: Engagement::at_depth(immersion, &cutter, depth).unwrap(),
            feed: 0.1 * MM,
            rise: 0.0,
            lean: LeanInCut::default(),
        };
        Milling::new(cutter, law, cut).unwrap()
    }

    fn linear() -> CuttingLaw {
        CuttingLaw::Mechanistic(
            Mechanistic::new(Vector3::new(600e6, 200e6, 100e6), Vector3::new(1e4, 2e4, 0.0)).unwrap(),
        )
    }

    fn power() -> CuttingLaw {
        let exact = |value| Estimate {
            value,
            standard_uncertainty: 0.0,
        };
        CuttingLaw::Kienzle(
            Kienzle::new(KienzleValues {
                specific_force: exact(800e6),
                exponent: exact(0.25),
                radial_ratio: exact(0.4),
                axial_ratio: exact(0.1),
            })
            .unwrap(),
        )
    }

    #[test]
    fn mean_factors_are_the_closed_integrals_of_altintas_and_budak() {
        // A_0 = (N a Kt / 4 pi) alpha, alpha_xx to alpha_yy between entry and exit; the same axes and signs.
        let flat = Cutter::flat(10.0 * MM, 3).unwrap();
        let (kt, kr) = (600e6, 200.0 / 600.0);
        for immersion in [
            Immersion::Up(3.0 * MM),
            Immersion::Down(1.0 * MM),
            Immersion::Slot,
        ] {
            let cut = milling(flat, linear(), immersion);
            let arc = cut.arc_of_cylinder().unwrap();
            let between = |f: fn(f64, f64) -> f64| 0.5 * (f(arc.exit, kr) - f(arc.entry, kr));
            let xx = between(|p, k| (2.0 * p).cos() - 2.0 * k * p + k * (2.0 * p).sin());
            let xy = between(|p, k| -(2.0 * p).sin() - 2.0 * p + k * (2.0 * p).cos());
            let yx = between(|p, k| -(2.0 * p).sin() + 2.0 * p + k * (2.0 * p).cos());
            let yy = between(|p, k| -(2.0 * p).cos() - 2.0 * k * p - k * (2.0 * p).sin());
            let factor = 0.5 * 2.0 * MM * kt * 3.0 / (2.0 * PI);
            let ours = cut.mean_directional();
            for (row, line) in [[xx, xy], [yx, yy]].iter().enumerate() {
                for (column, value) in line.iter().enumerate() {
                    let got = ours[(row, column)];
                    assert!(
                        (got - factor * value).abs() < 1e-9 * factor,
                        "{immersion:?} {row} {column}: {got}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_mean_is_the_derivative_of_the_mean_force_by_the_feed_along_the_feed() {
        // A displacement along x by d makes every chip thicker by d sin(phi), as more feed does.
        for law in [linear(), power()] {
            for cutter in [
                Cutter::flat(10.0 * MM, 2).unwrap(),
                Cutter::ball(10.0 * MM, 2).unwrap(),
                Cutter::bull_nose(10.0 * MM, 1.0 * MM, 4).unwrap(),
            ] {
                let cut = milling(cutter, law, Immersion::Down(4.0 * MM));
                let at = |feed: f64| {
                    let other = Cut { feed, ..*cut.cut() };
                    Milling::new(cutter, law, other).unwrap().mean_force()
                };
                let step = 1e-7;
                let feed = cut.cut().feed;
                let numeric = (at(feed + step) - at(feed - step)) / (2.0 * step);
                let column = cut.mean_directional().column(0).into_owned();
                // Kienzle's derivative is bounded below 1 um of chip: some thousandths there.
                let bound = if matches!(law, CuttingLaw::Kienzle(_)) {
                    1e-2
                } else {
                    1e-6
                };
                assert!(
                    (column - numeric).norm() < bound * numeric.norm(),
                    "{column} {numeric}"
                );
            }
        }
    }

    #[test]
    fn the_steps_of_a_pitch_have_the_mean_with_and_without_helix() {
        let straight = Cutter::flat(10.0 * MM, 2).unwrap();
        let wound = straight.with_helix(0.6, Hand::Right).unwrap();
        let ball = Cutter::ball(10.0 * MM, 2)
            .unwrap()
            .with_helix(0.5, Hand::Left)
            .unwrap();
        // The ball is summed over even slices, with an error of their width at the tip.
        for (cutter, bound) in [(straight, 1e-9), (wound, 1e-9), (ball, 3e-3)] {
            let cut = milling(cutter, linear(), Immersion::Up(2.0 * MM));
            let steps = cut.directional_over_pitch(37);
            let mean: Matrix3<f64> = steps.iter().sum::<Matrix3<f64>>() / 37.0;
            let exact = cut.mean_directional();
            assert!((mean - exact).norm() < bound * exact.norm(), "{mean} {exact}");
        }
    }

    #[test]
    fn a_straight_tooth_out_of_the_cut_has_no_factor() {
        let cut = milling(
            Cutter::flat(10.0 * MM, 2).unwrap(),
            linear(),
            Immersion::Up(0.5 * MM),
        );
        let steps = cut.directional_over_pitch(100);
        let cuts = steps.iter().filter(|step| step.norm() > 0.0).count();
        // acos(0.9) is 25.84 deg of the pitch of 180 deg: 14.4 steps.
        assert_eq!(cuts, 15);
    }
}
