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
//! Each is `A cos(phi - delta) <= B`: an arc. The body is convex: a point with `F . N > 0` was never inside it before, and one with
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
use super::cut::Cut;
use super::cutter::{Cutter, EdgePoint};

/// Most arcs of a point: four conditions.
const MOST: usize = 6;
/// Ends of an arc that no condition makes.
const NO_LIMIT: u8 = 9;

/// Arcs over which a point of an edge cuts, in ascending order.
#[derive(Clone, Copy, Debug)]
pub(super) struct EngagedArcs {
    arcs: [EngagedArc; MOST],
    /// The conditions that make the ends.
    ends: [[u8; 2]; MOST],
    count: usize,
}

impl EngagedArcs {
    /// This arc, or none.
    pub(super) fn one(arc: Option<EngagedArc>) -> EngagedArcs {
        let mut arcs = EngagedArcs::none();
        if let Some(arc) = arc {
            arcs.push(arc, [NO_LIMIT; 2]);
        }
        arcs
    }

    fn none() -> EngagedArcs {
        EngagedArcs {
            arcs: [EngagedArc {
                entry: 0.0,
                exit: 0.0,
            }; MOST],
            ends: [[NO_LIMIT; 2]; MOST],
            count: 0,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = EngagedArc> + '_ {
        self.arcs[..self.count].iter().copied()
    }

    /// Whether one of them contains `phi` (rad, from 0 to a turn).
    pub(super) fn contains(&self, phi: f64) -> bool {
        let on = |turn: f64| move |arc: EngagedArc| arc.contains(phi + turn);
        self.iter().any(on(0.0)) || self.iter().any(on(TAU)) || self.iter().any(on(-TAU))
    }

    /// Which conditions make their ends: it changes where the arcs have a kink.
    pub(super) fn kind(&self) -> ([[u8; 2]; MOST], usize) {
        (self.ends, self.count)
    }

    fn push(&mut self, arc: EngagedArc, ends: [u8; 2]) {
        if self.count < MOST && arc.exit > arc.entry {
            (self.arcs[self.count], self.ends[self.count]) = (arc, ends);
            self.count += 1;
        }
    }

    /// The parts of them inside `permitted`, or in whole turns from it.
    fn within(&self, permitted: EngagedArc, condition: u8) -> EngagedArcs {
        let mut within = EngagedArcs::none();
        for (arc, ends) in self.arcs.iter().zip(self.ends).take(self.count) {
            let mut turn = TAU * ((arc.entry - permitted.exit) / TAU).ceil();
            while permitted.entry + turn < arc.exit {
                let [entry, exit] = [permitted.entry + turn, permitted.exit + turn];
                let (entry, first) = if entry > arc.entry {
                    (entry, condition)
                } else {
                    (arc.entry, ends[0])
                };
                let (exit, last) = if exit < arc.exit {
                    (exit, condition)
                } else {
                    (arc.exit, ends[1])
                };
                within.push(EngagedArc { entry, exit }, [first, last]);
                turn += TAU;
            }
        }
        within
    }
}

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
        LeaningCut {
            feed,
            lean: [normal.z, normal.xy().norm()],
            below: Condition::of(normal, cut.depth - body.height_over_surface(&axis)),
            sides: [
                (right_edge > -radius).then(|| Condition::of(-left, -(right_edge + moved[0]))),
                (left_edge < radius).then(|| Condition::of(left, left_edge + moved[1])),
            ],
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
        arcs
    }
}

#[cfg(test)]
mod tests;
