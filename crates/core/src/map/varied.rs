//! The cut at a point with increasing depth, width or feed, until the deviation exceeds the tolerance.
//!
//! The result is the smallest value at which the deviation first exceeds the tolerance, found by a scan from thin to
//! thick and bisection. With gravity in one direction, or a wide cut that pushes back, the deviation need not be
//! monotonic. The vibration under the teeth is added to the deviation, with the same ratio to the mean force as in the nominal
//! cut, and an unstable cut exceeds every tolerance. If the greatest force is a load case, it is included with the same ratio to the mean as in the nominal
//! cut.

use super::vibrating::Vibrating;
use crate::load::{
    Cut, CutHere, CutsAlong, Cutter, CuttingLaw, ForceEquilibrium, GreatestForce, Milling, Rest,
    TipCompliance,
};

/// Permitted value at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Permitted {
    /// This much.
    UpTo(f64),
    /// At least this value, the largest that was examined.
    AtLeast(f64),
    /// None: the deviation is too large even for the smallest value.
    Nothing,
}

/// Limits of the cut at a point, each with all other parameters nominal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutLimits {
    /// Axial depth, m.
    pub depth: Permitted,
    /// Radial depth, m; `None` of a slot, whose width is the tool's.
    pub width: Option<Permitted>,
    /// Feed per tooth, m.
    pub feed_per_tooth: Permitted,
}

/// Deepest cut that is examined, in diameters: end mills have flutes of some three.
pub(super) const MOST_DEPTH: f64 = 3.0;
/// Largest feed per tooth that is examined, in diameters: no end mill takes more.
pub(super) const MOST_FEED: f64 = 0.05;
/// Depths, widths or feeds of a scan, each this many times the one before.
const SCAN: usize = 14;
const SCAN_RATIO: f64 = 1.7;
/// Number of bisections: to a thousandth of the interval.
const HALVINGS: usize = 10;

impl Permitted {
    /// As a number: the smallest permitted value.
    pub fn value(self) -> f64 {
        match self {
            Permitted::UpTo(value) | Permitted::AtLeast(value) => value,
            Permitted::Nothing => 0.0,
        }
    }
}

/// What a cut at a point has to meet.
#[derive(Clone, Debug)]
pub(super) struct PointDemand {
    /// m
    pub(super) tolerance: f64,
    /// What vibrates there, if the vibration is considered.
    pub(super) vibrating: Option<Vibrating>,
}

/// The cut at a point with variable depth, width or feed.
pub(super) struct Varied {
    equilibrium: ForceEquilibrium,
    /// m
    pub(super) cutter_radius: f64,
    /// Radius of the widest circle that is engaged, m.
    widest: f64,
    pub(super) cut: Cut,
    here: CutHere,
    greatest: GreatestForce,
    tip: TipCompliance,
    cutter: Cutter,
    law: CuttingLaw,
    demand: PointDemand,
    /// Vibration across the tool over the mean force, m/N.
    vibration_by_force: f64,
}

impl Varied {
    /// The cut at point `index`, with this tip compliance (feed frame) and this demand; `None` in air.
    pub(super) fn of(
        cuts: &CutsAlong,
        index: usize,
        tip: TipCompliance,
        demand: PointDemand,
    ) -> Option<Varied> {
        let here = cuts.points[index];
        let (cutter, cut) = (cuts.cutters[here.cutter], here.cut?);
        let by_force = demand.vibrating.as_ref().and_then(|vibrating| {
            let milling = Milling::new(cutter, cuts.law, cut).ok()?;
            let amplitude = vibrating.amplitude(&milling)?;
            Some(amplitude / milling.mean_force().norm()).filter(|ratio| ratio.is_finite())
        });
        Some(Varied {
            equilibrium: ForceEquilibrium::new(cutter, cuts.law),
            cutter_radius: cutter.radius(),
            widest: cutter.at_height(cut.depth).radius,
            cut,
            here,
            greatest: cuts.greatest,
            tip,
            cutter,
            law: cuts.law,
            demand,
            vibration_by_force: by_force.unwrap_or(0.0),
        })
    }

    /// Limits of the cut for this tolerance.
    pub(super) fn limits(&mut self) -> CutLimits {
        let (cut, radius) = (self.cut, self.cutter_radius);
        let (diameter, widest) = (2.0 * radius, self.widest);
        let feed = cut.feed.hypot(cut.rise);
        CutLimits {
            depth: self.permitted(MOST_DEPTH * diameter, |depth| Some(Cut { depth, ..cut })),
            width: (cut.engagement.width() < diameter).then(|| {
                self.permitted(2.0 * widest, |width| {
                    let engagement = cut.engagement.of_width(width, [widest, radius])?;
                    Some(Cut { engagement, ..cut })
                })
            }),
            feed_per_tooth: self.permitted(MOST_FEED * diameter, |thick| Some(fed(&cut, thick / feed))),
        }
    }

    /// The value up to `most` at which the deviation first exceeds the tolerance.
    fn permitted(&mut self, most: f64, cut: impl Fn(f64) -> Option<Cut>) -> Permitted {
        let mut within = |value: f64| {
            let cut = cut(value);
            cut.is_none_or(|cut| self.deviation(&cut) <= self.demand.tolerance)
        };
        let (mut low, mut high) = (0.0, most * SCAN_RATIO.powi(1 - SCAN as i32));
        loop {
            if !within(high) {
                break;
            }
            if high >= most {
                return Permitted::AtLeast(most);
            }
            (low, high) = (high, (high * SCAN_RATIO).min(most));
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if within(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        if low > 0.0 {
            Permitted::UpTo(low)
        } else {
            Permitted::Nothing
        }
    }

    /// In-plane deviation under `cut` with its vibration (m); infinite where the tool is pulled in, a cut within the tolerance is
    /// unstable, or there is no such cut.
    pub(super) fn deviation(&mut self, cut: &Cut) -> f64 {
        let Some(drawn) = self.equilibrium.nominal_force(cut) else {
            return f64::INFINITY;
        };
        let rest = self.equilibrium.rest(cut, drawn, &self.tip);
        let Rest::Settled(force) = rest else {
            return f64::INFINITY;
        };
        let [mean, greatest] = self.here.under(force);
        let in_plane = |force| cut.in_plane(&self.tip.under(force));
        let deviation = match self.greatest {
            GreatestForce::LeftOut => in_plane(mean),
            GreatestForce::SecondCase => in_plane(mean).max(in_plane(greatest)),
        };
        let total = deviation + self.vibration_by_force * drawn.norm();
        match total <= self.demand.tolerance && !self.is_stable(cut) {
            true => f64::INFINITY,
            false => total,
        }
    }

    /// Whether `cut` is stable; so is every cut where the vibration is not considered.
    fn is_stable(&self, cut: &Cut) -> bool {
        let Some(vibrating) = &self.demand.vibrating else {
            return true;
        };
        let milling = Milling::new(self.cutter, self.law, *cut);
        milling.is_ok_and(|milling| vibrating.is_stable(&milling))
    }
}

/// The same cut at `times` its feed.
pub(super) fn fed(cut: &Cut, times: f64) -> Cut {
    Cut {
        feed: cut.feed * times,
        rise: cut.rise * times,
        ..*cut
    }
}

#[cfg(test)]
mod tests;
