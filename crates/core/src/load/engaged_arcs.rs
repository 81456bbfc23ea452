//! Arcs over which a point of the edge of a leaning tool cuts.
//!
//! A point of the edge is at `p`, relative to `P`, and its body has the outward normal `N`. It cuts where it is below the upper
//! surface of the material, between the sides of the strip, and in front of the body:
//!
//! ```text
//! p = rho (sin(phi) x + cos(phi) y) + zeta a             N = sin(kappa) (sin(phi) x + cos(phi) y) - cos(kappa) a
//! n . p < ap - P . n      right < l . p < left           F . N > 0
//! ```
//!
//! Next to a pass before, one side is its profile ([`super::pass_before`]). Each other condition is `A cos(phi - delta) <= B`: an arc. The body is convex: a point with `F . N > 0` was never inside it before, and one with
//! `F . N < 0` just was.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x`, `y`, `a` | feed frame of the tool: along the feed across its axis, to the left, the tool axis | - |
//! | `n`, `l` | normal of the surface, left of the feed across it | - |
//! | `rho`, `zeta` | distance of the point from the tool axis, height over the centres of the corner | m |
//! | `kappa`, `phi` | axial immersion angle, immersion angle ([`super::milling`]) | rad |
//! | `ap` | depth along the normal of the surface | m |
//! | `F` | feed per tooth | m |
//!
//! Source: plane geometry \[derived\].

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Vector3;

use super::arc::EngagedArc;
use super::arcs_of_point::EngagedArcs;
use super::cut::Cut;
use super::cutter::{Cutter, EdgePoint};
use super::pass_before::{CLOSE, PassBefore};

/// `across rho cos(phi - direction) + along zeta <= bound`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Condition {
    direction: f64,
    across: f64,
    along: f64,
    bound: f64,
}

impl Condition {
    /// `v . p <= bound` with `v` in the feed frame of the tool.
    fn of(v: Vector3<f64>, bound: f64) -> Condition {
        Condition {
            direction: v.x.atan2(v.y),
            across: v.xy().norm(),
            along: v.z,
            bound,
        }
    }

    /// Keeps the parts of `arcs` on which a point at this radius and height meets it; `condition` is its number.
    fn keep(&self, arcs: &mut EngagedArcs, [rho, zeta]: [f64; 2], condition: u8) {
        let (amplitude, rest) = (self.across * rho, self.bound - self.along * zeta);
        if rest >= amplitude {
            return;
        }
        if rest <= -amplitude {
            *arcs = EngagedArcs::none();
            return;
        }
        let half = (rest / amplitude).acos();
        let permitted = EngagedArc {
            entry: self.direction + half,
            exit: self.direction + TAU - half,
        };
        *arcs = arcs.within(permitted, condition);
    }
}

/// A cut with a leaning tool, in the feed frame of the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LeaningCut {
    /// Feed per tooth across the tool axis, and along it, m.
    pub(super) feed: [f64; 2],
    /// Cosine and sine of the angle between the tool axis and the normal.
    pub(super) lean: [f64; 2],
    below: Condition,
    sides: [Option<Condition>; 2],
    pass_before: Option<PassBefore>,
    in_front: Condition,
}

impl LeaningCut {
    /// The cut of this cutter.
    pub(super) fn of(cutter: &Cutter, cut: &Cut) -> LeaningCut {
        let axis = cut.lean.lean.axis();
        let along = cut.feed * axis.x + cut.rise * axis.z;
        let across = (Vector3::new(cut.feed, 0.0, cut.rise) - axis * along).norm();
        let [left, normal] = cut.left_and_normal();
        let body = cutter.body();
        let [right_edge, left_edge] = cut.engagement.edges();
        let radius = cutter.radius();
        let moved = cut.lean.moved;
        let feed = [across, along];
        let pass_before = PassBefore::of(cutter, cut);
        let has_walls = pass_before.is_none();
        LeaningCut {
            feed,
            lean: [normal.z, normal.xy().norm()],
            below: Condition::of(normal, cut.depth - body.height_over_surface(&axis)),
            sides: [
                (has_walls && right_edge > -radius).then(|| Condition::of(-left, -(right_edge + moved[0]))),
                (has_walls && left_edge < radius).then(|| Condition::of(left, left_edge + moved[1])),
            ],
            pass_before,
            // With the sine and the cosine of the axial immersion angle for radius and height.
            in_front: Condition {
                direction: -FRAC_PI_2,
                across: feed[0],
                along: feed[1],
                bound: 0.0,
            },
        }
    }

    /// Where the point of an edge cuts; `corner_radius` in m.
    pub(super) fn arcs_at(&self, point: &EdgePoint, corner_radius: f64) -> EngagedArcs {
        self.arcs_within(point, corner_radius, CLOSE)
    }

    /// The same where the conditions that make the ends matter alone: ends without a closed form are not refined.
    pub(super) fn rough_arcs_at(&self, point: &EdgePoint, corner_radius: f64) -> EngagedArcs {
        self.arcs_within(point, corner_radius, f64::INFINITY)
    }

    fn arcs_within(&self, point: &EdgePoint, corner_radius: f64, close: f64) -> EngagedArcs {
        let mut arcs = EngagedArcs::one(Some(EngagedArc {
            entry: 0.0,
            exit: TAU,
        }));
        self.in_front
            .keep(&mut arcs, [point.sin_kappa, point.cos_kappa], 0);
        let at = [point.radius, point.height - corner_radius];
        self.below.keep(&mut arcs, at, 1);
        for (side, number) in self.sides.iter().flatten().zip([2, 3]) {
            side.keep(&mut arcs, at, number);
        }
        match &self.pass_before {
            Some(pass) => pass.beyond(&arcs, at, close),
            None => arcs,
        }
    }
}

#[cfg(test)]
mod tests;
