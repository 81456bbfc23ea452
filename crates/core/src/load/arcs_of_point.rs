//! The arcs over which one point of an edge cuts, with what bounds each.
//!
//! Conditions on the point ([`super::engaged_arcs`], [`super::pass_before`]) are numbered; each leaves parts of the arcs.

use std::f64::consts::TAU;

use super::arc::EngagedArc;

/// Most arcs of a point.
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

    pub(super) fn none() -> EngagedArcs {
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

    /// They, each with the conditions that make its ends.
    pub(super) fn with_ends(&self) -> impl Iterator<Item = (EngagedArc, [u8; 2])> + '_ {
        self.iter().zip(self.ends)
    }

    pub(super) fn push(&mut self, arc: EngagedArc, ends: [u8; 2]) {
        if self.count < MOST && arc.exit > arc.entry {
            (self.arcs[self.count], self.ends[self.count]) = (arc, ends);
            self.count += 1;
        }
    }

    /// The parts of them inside `permitted`, or in whole turns from it.
    pub(super) fn within(&self, permitted: EngagedArc, condition: u8) -> EngagedArcs {
        let mut within = EngagedArcs::none();
        for (arc, ends) in self.with_ends() {
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
