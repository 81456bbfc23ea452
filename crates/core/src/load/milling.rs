//! Milling force on the tool at an angle of the spindle, and over a revolution.
//!
//! Every engaged tooth is loaded by `dFt` against its motion, `dFr` along the inward normal of the body and
//! `dFa` along its profile to the tip (`s` = 1 for a right-hand helix, -1 for a left-hand one):
//!
//! ```text
//! dFx = -dFt cos(phi) - (dFr sin(kappa) + s dFa cos(kappa)) sin(phi)
//! dFy =  dFt sin(phi) - (dFr sin(kappa) + s dFa cos(kappa)) cos(phi)
//! dFz =  dFr cos(kappa) - s dFa sin(kappa)
//! phi = spindle angle - j 2 pi/N - psi(z)          h = c sin(phi) sin(kappa) - c_z cos(kappa)
//! ```
//!
//! **Signs.** The force acts **on the tool**; the part feels the opposite. Feed frame: x along the feed of the tool, z
//! from part to spindle, y to the left. Picture, seen from the spindle, feed to the right of this page, slot:
//!
//! ```text
//!    y  |    <- tooth at phi = 0 moves to the right   In front of the tool (phi = 90 deg) the tooth moves down the
//!       |   ( tool )  ---> x, feed                    page, to -y: the part pushes the tool to +y by Ft, and back
//!       |      turns clockwise                        to -x by Fr.
//! ```
//!
//! So a slot pushes the tool back and to the left; up-milling (part on the left) pushes it back, down-milling (part on
//! the right) pushes it away from the part, to the left. A right-hand helix pulls it to the part (-z).
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `phi` | immersion angle of a point of an edge, clockwise from +y | rad |
//! | `kappa`, `psi` | axial immersion angle and lag, see [`super::cutter`] | rad |
//! | `c`, `c_z` | feed per tooth across the tool axis, and along it to the spindle | m |
//! | `h`, `db` | chip thickness; chip width, the length of the profile | m |
//!
//! With runout a tooth cuts the material that the teeth before it left; a tooth that cuts nothing leaves its chip to
//! the next (`teeth_at`).
//!
//! The tool may lean from the programmed axis: the feed frame is then that of the leaning tool, and a point of an edge may cut over
//! several arcs (`engaged_arcs`).
//!
//! Where the engagement of a ramp differs from that of the level cut and the edges on the bottom are neglected.
//!
//! Source: Altintas, Manufacturing Automation; Engin and Altintas 2001 for general end mills [both recalled]; the
//! signs are derived in `docs/theory/cutting.md` and tested here.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::arc::{Chip, EngagedArc, Moments};
use super::arcs_of_point::EngagedArcs;
use super::cut::Cut;
use super::cutter::{Cutter, EdgePoint};
use super::edge_part::{EdgePart, parts};
use super::engaged_arcs::LeaningCut;
use super::error::{CuttingError, checked};
use super::law::CuttingLaw;
use super::lean::Lean;
use super::mechanistic::Mechanistic;
use super::teeth_at::TeethAt;

/// A cutter in a cut, under a cutting law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Milling {
    pub(super) cutter: Cutter,
    pub(super) law: CuttingLaw,
    pub(super) cut: Cut,
    /// `None` if the tool is upright.
    pub(super) leaning: Option<LeaningCut>,
}

/// A slice of the edge that cuts.
#[derive(Clone, Debug)]
pub(super) struct EngagedSlice {
    pub(super) point: EdgePoint,
    /// m
    pub(super) width: f64,
    pub(super) arcs: EngagedArcs,
    pub(super) teeth: TeethAt,
}

/// Deepest cut in diameters: it bounds how often a helix winds round.
const MOST_DEPTH_IN_DIAMETERS: f64 = 100.0;
/// Largest feed per tooth in diameters: beyond it the circles of the teeth no longer overlap.
const MOST_FEED_IN_DIAMETERS: f64 = 1.0;
/// Slices of the corner, and of the cylinder, where forces are summed.
const SLICES: u32 = 256;
/// Lag over the depth of cut, rad, below which an edge is treated as straight: its force then differs by rounding.
const STRAIGHT: f64 = 1e-12;
/// Most steps of a revolution.
const MOST_STEPS: u32 = 100_000;

impl Milling {
    /// This cutter in this cut; Kienzle's law is used at the rake of the cutter.
    ///
    /// # Errors
    /// A depth of cut that is not above zero, feeds beyond the diameter, numbers that are not finite.
    pub fn new(cutter: Cutter, law: CuttingLaw, cut: Cut) -> Result<Milling, CuttingError> {
        let most_depth = MOST_DEPTH_IN_DIAMETERS * cutter.diameter();
        checked(
            "axial depth of cut",
            cut.depth,
            [f64::MIN_POSITIVE, most_depth],
            "m",
        )?;
        let most_feed = MOST_FEED_IN_DIAMETERS * cutter.diameter();
        checked("feed per tooth", cut.feed, [0.0, most_feed], "m")?;
        checked("rise per tooth", cut.rise, [-most_feed, most_feed], "m")?;
        let leans = cut.lean.lean != Lean::NONE;
        Ok(Milling {
            law: law.with_rake(cutter.rake()),
            leaning: leans.then(|| LeaningCut::of(&cutter, &cut)),
            cutter,
            cut,
        })
    }

    /// The tool.
    pub fn cutter(&self) -> &Cutter {
        &self.cutter
    }

    /// Force of a chip, at the rake of the cutter.
    pub fn law(&self) -> &CuttingLaw {
        &self.law
    }

    /// What is cut.
    pub fn cut(&self) -> &Cut {
        &self.cut
    }

    /// Force on the tool (N, feed frame) when the tip of tooth 0 is at `angle` (rad).
    ///
    /// Exact for a flat end mill with straight flutes, and for one without runout under a linear law; else summed over
    /// 256 slices of the corner and as many of the cylinder, with an error of some thousandths of the peak where an edge
    /// enters or leaves.
    pub fn force_at(&self, angle: f64) -> Vector3<f64> {
        match (&self.law, self.arc_of_cylinder()) {
            (_, Some(arc)) if self.is_straight() => self.straight_force(arc, angle),
            (_, None) if self.is_straight() => Vector3::zeros(),
            (CuttingLaw::Mechanistic(law), Some(arc)) if self.is_plain() => {
                self.closed_force(law, arc, angle)
            }
            (CuttingLaw::Mechanistic(_), None) if self.is_plain() => Vector3::zeros(),
            _ => self.sum_of(&self.engaged_slices(), angle),
        }
    }

    /// After what turn of the spindle (rad) the force comes again: a pitch, with runout a revolution.
    pub fn period(&self) -> f64 {
        if self.cutter.runout().offset == 0.0 {
            self.cutter.pitch()
        } else {
            TAU
        }
    }

    /// Forces (N, feed frame) at `steps` even steps of one revolution, from the angle zero; from 1 to 100 000 steps.
    pub fn revolution(&self, steps: u32) -> Vec<Vector3<f64>> {
        self.forces_at(even_steps(TAU, steps))
    }

    /// Forces (N, feed frame) at these angles: those of [`Milling::force_at`], with the slices of the edge made once.
    pub(crate) fn forces_at(&self, angles: impl Iterator<Item = f64>) -> Vec<Vector3<f64>> {
        if self.is_summed() {
            let slices = self.engaged_slices();
            angles.map(|angle| self.sum_of(&slices, angle)).collect()
        } else {
            angles.map(|angle| self.force_at(angle)).collect()
        }
    }

    /// Chip thickness of an evenly cutting tooth at `point`.
    pub(super) fn chip(&self, point: &EdgePoint) -> Chip {
        let [across, along] = self
            .leaning
            .map_or([self.cut.feed, self.cut.rise], |leaning| leaning.feed);
        Chip {
            across: across * point.sin_kappa,
            along: -along * point.cos_kappa,
        }
    }

    /// The arcs over which `point` cuts; of an upright tool in a rising feed with those where it does not reach the part.
    pub(super) fn arcs_at(&self, point: &EdgePoint) -> EngagedArcs {
        match &self.leaning {
            Some(leaning) => leaning.arcs_at(point, self.cutter.corner_radius()),
            None => EngagedArcs::one(self.cut.engagement.arc_at(point.radius)),
        }
    }

    /// Points of the edge with their chip width (m): middles of even slices of the profile.
    pub(super) fn slices(&self) -> impl Iterator<Item = (EdgePoint, f64)> + '_ {
        // All slices of a straight edge cut alike.
        let alike = self.leaning.is_none() && self.cutter.helix() == 0.0;
        parts(&self.cutter, &self.cut, self.leaning.as_ref()).flat_map(move |part| {
            let slices = if alike && matches!(part, EdgePart::Cylinder(_)) {
                1
            } else {
                SLICES
            };
            part.middles(&self.cutter, slices)
        })
    }

    /// The slices that cut, with their arcs.
    pub(super) fn engaged_slices(&self) -> Vec<EngagedSlice> {
        let slices = self.slices().map(|(point, width)| EngagedSlice {
            point,
            width,
            arcs: self.arcs_at(&point),
            teeth: TeethAt::new(&self.cutter, &point),
        });
        slices.filter(|slice| !slice.arcs.is_empty()).collect()
    }

    /// Where the cylinder cuts; `None` if the strip is outside it.
    pub(super) fn arc_of_cylinder(&self) -> Option<EngagedArc> {
        self.cut.engagement.arc_at(self.cutter.radius())
    }

    fn is_plain(&self) -> bool {
        self.leaning.is_none() && self.cutter.corner_radius() == 0.0 && self.cutter.runout().offset == 0.0
    }

    /// Whether all of an edge is at one immersion angle.
    pub(super) fn is_straight(&self) -> bool {
        self.leaning.is_none()
            && self.cutter.corner_radius() == 0.0
            && self.cutter.lag(self.cut.depth).abs() < STRAIGHT
    }

    /// Whether forces are summed over slices: such sums step where a slice enters or leaves.
    pub(super) fn is_summed(&self) -> bool {
        !(self.is_straight() || self.is_plain() && matches!(self.law, CuttingLaw::Mechanistic(_)))
    }

    /// Immersion angle of the tip of tooth `tooth`, rad.
    fn tip_angle(&self, tooth: u32, angle: f64) -> f64 {
        angle - f64::from(tooth) * self.cutter.pitch()
    }

    /// The chips at an angle of the spindle: of every tooth that cuts at a slice, the immersion angle (rad) and the thickness (m).
    pub(super) fn chips_at<'a>(
        &'a self,
        slices: &'a [EngagedSlice],
        angle: f64,
    ) -> impl Iterator<Item = (&'a EngagedSlice, f64, f64)> {
        slices.iter().flat_map(move |slice| {
            let lag = self.cutter.lag(slice.point.height);
            let chip = self.chip(&slice.point);
            (0..self.cutter.flutes()).filter_map(move |tooth| {
                let phi = (self.tip_angle(tooth, angle) - lag).rem_euclid(TAU);
                let cuts = slice.arcs.contains(phi);
                let thickness = cuts.then(|| slice.teeth.chip(tooth, chip.at(phi)));
                thickness.filter(|h| *h >= 0.0).map(|h| (slice, phi, h))
            })
        })
    }

    fn sum_of(&self, slices: &[EngagedSlice], angle: f64) -> Vector3<f64> {
        let of_chip = |(slice, phi, h): (&EngagedSlice, f64, f64)| {
            let directions = Moments::at(phi).directions(&slice.point, self.cutter.hand());
            directions * self.law.force(h) * slice.width
        };
        self.chips_at(slices, angle).map(of_chip).sum()
    }

    /// The force on the teeth of a flat end mill with straight flutes.
    fn straight_force(&self, arc: EngagedArc, angle: f64) -> Vector3<f64> {
        let point = self.cutter.at_height(0.0);
        let (even, teeth) = (self.chip(&point), TeethAt::new(&self.cutter, &point));
        let of_tooth = |tooth: u32| {
            let phi = self.tip_angle(tooth, angle).rem_euclid(TAU);
            let h = teeth.chip(tooth, even.at(phi));
            let cuts = arc.contains(phi) && h >= 0.0;
            let directions = Moments::at(phi).directions(&point, self.cutter.hand());
            cuts.then(|| directions * self.law.force(h) * self.cut.depth)
        };
        (0..self.cutter.flutes()).filter_map(of_tooth).sum()
    }

    /// The integral along a flat end mill with a helix: with `dz = depth/lag dphi` it runs over the angles that the edge covers.
    fn closed_force(&self, law: &Mechanistic, arc: EngagedArc, angle: f64) -> Vector3<f64> {
        let depth = self.cut.depth;
        let point = self.cutter.at_height(0.0);
        let lag = self.cutter.lag(depth);
        let hand = self.cutter.hand();
        let mut sum = Vector3::zeros();
        for tooth in 0..self.cutter.flutes() {
            let tip = self.tip_angle(tooth, angle).rem_euclid(TAU);
            let (low, high) = (tip.min(tip - lag), tip.max(tip - lag));
            let mut turn = TAU * ((low - arc.exit) / TAU).ceil();
            while arc.entry + turn < high {
                let covered = EngagedArc {
                    entry: low - turn,
                    exit: high - turn,
                };
                if let Some(cut) = arc.common_with(covered) {
                    let [edge, shear] = cut.moments(self.chip(&point));
                    let k = law.coefficients();
                    let force = shear.directions(&point, hand) * k.fixed_rows::<3>(0)
                        + edge.directions(&point, hand) * k.fixed_rows::<3>(3);
                    sum += force * (depth / lag.abs());
                }
                turn += TAU;
            }
        }
        sum
    }
}

/// Angles at even steps of `turn` (rad), from zero.
pub(super) fn even_steps(turn: f64, steps: u32) -> impl Iterator<Item = f64> {
    let steps = steps.clamp(1, MOST_STEPS);
    (0..steps).map(move |step| turn * f64::from(step) / f64::from(steps))
}

#[cfg(test)]
mod tests;
