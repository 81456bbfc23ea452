//! What a cut asks of spindle and edge: torque, chip thickness, volume removed.
//!
//! ```text
//! T(angle) = sum over engaged teeth of integral dFt R(z) db         mean T = sum over teeth of 1/(2 pi) integral of Ft R dphi db
//! Q = ap ae v                                                       h = largest chip of a tooth over its arc
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `T` | torque of the cut against the turn of the spindle | N m |
//! | `Ft`, `R` | tangential force on an edge, radius of its point | N, m |
//! | `Q` | material removal rate of a full strip | m³/s |
//! | `ap`, `ae`, `v` | axial depth, width across the feed, feed speed | m, m, m/s |
//!
//! Sums over slices of the edge and even steps of the arc; see [`super::milling`] for the other symbols.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::arc::EngagedArc;
use super::cut::Cut;
use super::milling::{EngagedSlice, Milling, even_steps};
use super::teeth_at::TeethAt;

/// Steps over the arc of an edge.
const STEPS: u32 = 128;

impl Cut {
    /// Material removal rate at the feed speed `speed` (m/s), m³/s.
    pub fn removal_rate(&self, speed: f64) -> f64 {
        let [right, left] = self.engagement.edges();
        self.depth * (left - right).max(0.0) * speed
    }
}

impl Milling {
    /// Torque at an angle of the spindle (rad), N m.
    pub fn torque_at(&self, angle: f64) -> f64 {
        self.torque_of(&self.engaged_slices(), angle)
    }

    fn torque_of(&self, slices: &[EngagedSlice], angle: f64) -> f64 {
        let of_chip = |(slice, _, h): (&EngagedSlice, f64, f64)| {
            self.law.force(h)[0] * slice.point.radius * slice.width
        };
        self.chips_at(slices, angle).map(of_chip).sum()
    }

    /// The greatest torque at `steps` even steps of a period, N m.
    pub fn greatest_torque(&self, steps: u32) -> f64 {
        let slices = self.engaged_slices();
        let angles = even_steps(self.period(), steps);
        angles
            .map(|angle| self.torque_of(&slices, angle))
            .fold(0.0, f64::max)
    }

    /// The torque averaged over a revolution, N m.
    pub fn mean_torque(&self) -> f64 {
        let mut sum = 0.0;
        for (point, width) in self.slices() {
            let (even, teeth) = (self.chip(&point), TeethAt::new(&self.cutter, &point));
            for arc in self.arcs_at(&point).iter() {
                let step = (arc.exit - arc.entry) / f64::from(STEPS);
                for tooth in 0..self.cutter.flutes() {
                    let tangential = angles_of(arc)
                        .map(|phi| teeth.chip(tooth, even.at(phi)))
                        .filter(|h| *h >= 0.0)
                        .map(|h| self.law.force(h)[0]);
                    sum += tangential.sum::<f64>() * step * point.radius * width;
                }
            }
        }
        sum / TAU
    }

    /// The largest chip thickness of any tooth, m.
    pub fn largest_chip(&self) -> f64 {
        let mut largest = 0.0f64;
        for (point, _) in self.slices() {
            let (even, teeth) = (self.chip(&point), TeethAt::new(&self.cutter, &point));
            for arc in self.arcs_at(&point).iter() {
                for tooth in 0..self.cutter.flutes() {
                    // The chip is largest straight ahead, or at an end of the arc.
                    let turn = TAU * ((arc.entry - FRAC_PI_2) / TAU).ceil();
                    let ahead = (FRAC_PI_2 + turn).min(arc.exit);
                    for phi in [arc.entry, ahead] {
                        largest = largest.max(teeth.chip(tooth, even.at(phi)));
                    }
                }
            }
        }
        largest
    }
}

/// Middles of even steps over an arc, rad.
fn angles_of(arc: EngagedArc) -> impl Iterator<Item = f64> {
    (0..STEPS).map(move |k| arc.entry + (arc.exit - arc.entry) * (f64::from(k) + 0.5) / f64::from(STEPS))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::load::{Cutter, CuttingLaw, Engagement, Hand, Immersion, LeanInCut, Mechanistic};

    const MM: f64 = 1e-3;

    fn milling(helix: f64, immersion: Immersion) -> Milling {
        let cutter = Cutter::flat(10.0 * MM, 3).unwrap();
        let cutter = cutter.with_helix(helix, Hand::Right).unwrap();
        let law = Mechanistic::new(Vector3::new(8e8, 3e8, 1e8), Vector3::zeros()).unwrap();
        let cut = Cut {
            depth: 2.0 * MM,
            engagement: Engagement::of(immersion, 10.0 * MM).unwrap(),
            feed: 0.05 * MM,
            rise: 0.0,
            lean: LeanInCut::default(),
        };
        Milling::new(cutter, CuttingLaw::Mechanistic(law), cut).unwrap()
    }

    #[test]
    fn the_mean_torque_is_the_power_of_the_removed_volume() {
        for immersion in [
            Immersion::Up(4.0 * MM),
            Immersion::Down(1.0 * MM),
            Immersion::Slot,
        ] {
            let milling = milling(0.5, immersion);
            // Without edge forces each volume takes the work Ktc: T 2 pi = Ktc ap ae N c.
            let per_turn = milling.cut().removal_rate(1.0) * 3.0 * 0.05 * MM;
            let expected = 8e8 * per_turn / TAU;
            assert!(
                (milling.mean_torque() / expected - 1.0).abs() < 1e-4,
                "{immersion:?}"
            );
        }
    }

    #[test]
    fn the_mean_of_the_turn_is_the_mean_and_below_the_greatest() {
        let milling = milling(0.5, Immersion::Down(4.0 * MM));
        let angles = even_steps(milling.period(), 720);
        let mean = angles.map(|angle| milling.torque_at(angle)).sum::<f64>() / 720.0;
        // 256 slices of an edge enter and leave one by one.
        assert!((mean / milling.mean_torque() - 1.0).abs() < 2e-3);
        assert!(milling.greatest_torque(360) > milling.mean_torque());
    }

    #[test]
    fn the_largest_chip_is_the_feed_per_tooth_where_the_tooth_passes_ahead() {
        let chip = |immersion| milling(0.0, immersion).largest_chip();
        assert!((chip(Immersion::Slot) - 0.05 * MM).abs() < 1e-12);
        // Up to 1 mm of a tool of 10 mm: cos = 0.8, sin = 0.6.
        assert!((chip(Immersion::Up(1.0 * MM)) - 0.03 * MM).abs() < 1e-12);
    }
}
