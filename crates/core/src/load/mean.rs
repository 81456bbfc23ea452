//! The mean milling force over a revolution, and its uncertainty.
//!
//! Every point of an edge passes all angles in the same way; the helix therefore has no effect:
//!
//! ```text
//! F = N/(2 pi) integral over db integral from entry to exit of dF(phi) dphi
//! ```
//!
//! Under a linear law without runout the integral over `phi` is closed, and so is all of it for a flat end mill; along
//! a rounded corner it is summed over 16 nodes between the points where the arc has a kink. Kienzle's law uses 16
//! nodes in `phi` too. The force is linear in the coefficients `k`, so `F = M k` and
//!
//! ```text
//! cov F = M S M^T            S: covariance of the coefficients (Kienzle: M by differentiation)
//! ```
//!
//! Of a leaning tool every part of its edge is integrated in pieces between the kinks of its arcs (`edge_part`).
//!
//! What a revolution cuts does not depend on runout: teeth share the same `N c` otherwise. So the shear part of the
//! mean never changes; the edge part does where a tooth cuts nothing, since it no longer rubs. Each tooth is integrated
//! over the parts of its arcs in which it cuts down to one earlier tooth (`teeth_at`), over 256 slices of the corner and
//! as many of a cylinder with a helix.
//!
//! Source: integrals of [`super::milling`]; `docs/theory/cutting.md`.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::arc::{Chip, EngagedArc, Moments};
use super::cutter::EdgePoint;
use super::edge_part::parts;
use super::law::CuttingLaw;
use super::milling::Milling;
use super::quadrature::{nodes_between_powers, nodes_from_root};
use super::teeth_at::TeethAt;

/// The mean force on the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanForce {
    /// N, feed frame.
    pub force: Vector3<f64>,
    /// N², feed frame: from the coefficients of the cutting law alone.
    pub covariance: Matrix3<f64>,
}

/// A force and, where requested, its derivatives by the parameters of the law.
#[derive(Clone, Copy)]
struct Sum<const WITH_DERIVATIVES: bool> {
    force: Vector3<f64>,
    by_parameters: SMatrix<f64, 3, 6>,
}

impl Milling {
    /// The mean force over a revolution.
    pub fn mean(&self) -> MeanForce {
        let sum = self.sum::<true>();
        MeanForce {
            force: sum.force,
            covariance: sum.by_parameters * self.law.covariance() * sum.by_parameters.transpose(),
        }
    }

    /// The same without its covariance, in a fraction of the time.
    pub fn mean_force(&self) -> Vector3<f64> {
        self.sum::<false>().force
    }

    fn sum<const D: bool>(&self) -> Sum<D> {
        let mut sum = Sum {
            force: Vector3::zeros(),
            by_parameters: SMatrix::zeros(),
        };
        if self.is_independent_of_runout() && self.leaning.is_some() {
            self.add_leaning(&mut sum);
            sum.scaled(f64::from(self.cutter.flutes()) / TAU)
        } else if self.is_independent_of_runout() {
            self.add_corner(&mut sum);
            self.add_cylinder(&mut sum);
            sum.scaled(f64::from(self.cutter.flutes()) / TAU)
        } else {
            self.add_each_tooth(&mut sum);
            sum.scaled(1.0 / TAU)
        }
    }

    /// Whether the mean is that of a true tool: no runout, or a law for which another distribution of the chips has no
    /// effect.
    fn is_independent_of_runout(&self) -> bool {
        let ploughs = match &self.law {
            CuttingLaw::Mechanistic(law) => law.coefficients().fixed_rows::<3>(3).amax() > 0.0,
            CuttingLaw::Kienzle(_) => true,
        };
        // Lifted off by a ramp, an edge stops cutting: the remaining material is then shared differently.
        self.cutter.runout().offset == 0.0 || (!ploughs && self.cut.rise <= 0.0 && self.leaning.is_none())
    }

    fn add_cylinder<const D: bool>(&self, sum: &mut Sum<D>) {
        let straight = self.cut.depth - self.cutter.corner_radius();
        if straight > 0.0 {
            self.add_slice(&self.cutter.at_height(self.cut.depth), straight, sum);
        }
    }

    fn add_corner<const D: bool>(&self, sum: &mut Sum<D>) {
        let r = self.cutter.corner_radius();
        if r == 0.0 {
            return;
        }
        let end = self.cutter.corner_end(self.cut.depth);
        let mut from = 0.0;
        for kink in self.kinks(end) {
            for (kappa, weight) in nodes_from_root(from, kink) {
                self.add_slice(&self.cutter.in_corner(kappa), r * weight, sum);
            }
            from = kink;
        }
    }

    /// Axial immersion angles at which pieces of the corner end, rising, the last of them `end`.
    pub(super) fn kinks(&self, end: f64) -> [f64; 4] {
        let r = self.cutter.corner_radius();
        let begin_of_corner = self.cutter.radius() - r;
        let at_radius = |radius: f64| ((radius - begin_of_corner) / r).clamp(0.0, 1.0).asin();
        let [a, b] = self.cut.engagement.kinks().map(at_radius);
        // Below this angle a rising edge lifts off.
        let lifts = self.cut.rise.max(0.0).atan2(self.cut.feed);
        let mut kinks = [a, b, lifts, end].map(|kappa| kappa.min(end));
        kinks.sort_by(f64::total_cmp);
        kinks
    }

    /// Adds what a slice of chip width `width` gives over its arc.
    fn add_slice<const D: bool>(&self, point: &EdgePoint, width: f64, sum: &mut Sum<D>) {
        let chip = self.chip(point);
        let arc = self.cut.engagement.arc_at(point.radius);
        if let Some(arc) = arc.and_then(|arc| chip.cut_part(arc)) {
            self.add_arc((point, width), chip, arc, sum);
        }
    }

    /// Adds what the edge of a leaning tool gives, piece after piece.
    fn add_leaning<const D: bool>(&self, sum: &mut Sum<D>) {
        let Some(leaning) = &self.leaning else {
            return;
        };
        let corner = self.cutter.corner_radius();
        for part in parts(&self.cutter, &self.cut, self.leaning.as_ref()) {
            let rough = |along: f64| leaning.rough_arcs_at(&part.point(&self.cutter, along), corner);
            for [from, to] in part.pieces(rough) {
                for (along, weight) in nodes_between_powers(from, to) {
                    let point = part.point(&self.cutter, along);
                    let width = part.width(&self.cutter) * weight;
                    for arc in self.arcs_at(&point).iter() {
                        self.add_arc((&point, width), self.chip(&point), arc, sum);
                    }
                }
            }
        }
    }

    /// Adds what a slice, a point with its chip width, gives over an arc.
    fn add_arc<const D: bool>(
        &self,
        (point, width): (&EdgePoint, f64),
        chip: Chip,
        arc: EngagedArc,
        sum: &mut Sum<D>,
    ) {
        match &self.law {
            CuttingLaw::Mechanistic(law) => {
                let hand = self.cutter.hand();
                let [edge, shear] = arc
                    .moments(chip)
                    .map(|moments| moments.directions(point, hand) * width);
                let k = law.coefficients();
                sum.force += shear * k.fixed_rows::<3>(0) + edge * k.fixed_rows::<3>(3);
                if D {
                    let mut by_shear = sum.by_parameters.fixed_view_mut::<3, 3>(0, 0);
                    by_shear += shear;
                    let mut by_edge = sum.by_parameters.fixed_view_mut::<3, 3>(0, 3);
                    by_edge += edge;
                }
            }
            CuttingLaw::Kienzle(_) => {
                for (phi, weight) in nodes_between_powers(arc.entry, arc.exit) {
                    sum.add(
                        self.directions(point, phi) * (width * weight),
                        &self.law,
                        chip.at(phi),
                    );
                }
            }
        }
    }

    /// Adds every tooth separately, slice by slice.
    fn add_each_tooth<const D: bool>(&self, sum: &mut Sum<D>) {
        for (point, width) in self.slices() {
            let (even, teeth) = (self.chip(&point), TeethAt::new(&self.cutter, &point));
            for arc in self.arcs_at(&point).iter() {
                for tooth in 0..self.cutter.flutes() {
                    for (part, chip) in teeth.cuts(tooth, even, arc) {
                        self.add_arc((&point, width), chip, part, sum);
                    }
                }
            }
        }
    }

    /// Directions of the force on an edge at the angle `phi`.
    fn directions(&self, point: &EdgePoint, phi: f64) -> Matrix3<f64> {
        Moments::at(phi).directions(point, self.cutter.hand())
    }
}

impl<const D: bool> Sum<D> {
    /// Adds an edge with these directions, times its width, and the chip `h`.
    fn add(&mut self, directions: Matrix3<f64>, law: &CuttingLaw, h: f64) {
        self.force += directions * law.force(h);
        if D {
            self.by_parameters += directions * law.derivatives(h);
        }
    }

    fn scaled(self, factor: f64) -> Self {
        Sum {
            force: self.force * factor,
            by_parameters: self.by_parameters * factor,
        }
    }
}

#[cfg(test)]
mod tests;
