//! Greatest force of a cutter over a period of its turn.
//!
//! The force is a piecewise smooth function of the spindle angle. Its breakpoints are where an end of an edge enters or
//! leaves the engagement (a straight edge does so at once, and the force jumps), and where a tooth begins or ends to cut
//! because of the runout:
//!
//! ```text
//! phi = entry, exit            m c sin(phi) + rho_j - rho_(j-m) = 0,   m from 1 to N
//! ```
//!
//! The force is computed at even steps and on both sides of each breakpoint; the largest of neighbouring angles are
//! refined by golden section. Symbols are those of [`super::milling`]. Sums over slices have steps of their own at each
//! slice; of them the even steps are used as they are.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::milling::{Milling, even_steps};

/// Distance from a breakpoint at which the force on either side of it is computed, rad.
const SIDE: f64 = 1e-9;
/// Largest of neighbouring angles whose force is below this part of the greatest are not refined: between even steps of
/// a degree no smooth part of the force grows by as much.
const REFINED: f64 = 0.9;
/// Squares of forces that differ by less than this part are equal.
const ROUNDING: f64 = 1e-12;
/// Ratio of the golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Steps of the golden section: the interval shrinks to a millionth, and the force near a maximum is known to 1e-12.
const SECTIONS: u32 = 30;

impl Milling {
    /// The force of greatest length (N, feed frame) over one period.
    pub fn peak(&self, steps: u32) -> Vector3<f64> {
        let period = self.period();
        let mut angles: Vec<f64> = even_steps(period, steps).collect();
        if !self.is_summed() {
            let sides = self.breakpoints().into_iter();
            let sides = sides.flat_map(|angle| [angle - SIDE, angle + SIDE]);
            angles.extend(sides.map(|angle| angle.rem_euclid(period)));
            angles.sort_by(f64::total_cmp);
        }
        let forces = self.forces_at(angles.iter().copied());
        let mut greatest = forces.iter().copied().fold(Vector3::zeros(), longer);
        if self.is_summed() {
            return greatest;
        }
        let bar = REFINED * greatest.norm();
        let count = angles.len();
        for index in 0..count {
            let (before, after) = ((index + count - 1) % count, (index + 1) % count);
            let here = forces[index].norm();
            if here < bar || here < forces[before].norm() || here < forces[after].norm() {
                continue;
            }
            // The neighbours of the first and the last angle are a period away.
            let turn = |wraps: bool| if wraps { period } else { 0.0 };
            let low = angles[before] - turn(before > index);
            let high = angles[after] + turn(after < index);
            for ends in [[low, angles[index]], [angles[index], high]] {
                greatest = longer(greatest, self.greatest_between(ends));
            }
        }
        greatest
    }

    /// The greatest force that a golden section finds between two angles, rad.
    fn greatest_between(&self, [mut low, mut high]: [f64; 2]) -> Vector3<f64> {
        let inner = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let [mut a, mut b] = inner(low, high);
        let (mut at_a, mut at_b) = (self.force_at(a), self.force_at(b));
        let mut greatest = longer(at_a, at_b);
        for _ in 0..SECTIONS {
            if at_a.norm_squared() > at_b.norm_squared() {
                (high, b, at_b) = (b, a, at_a);
                a = inner(low, high)[0];
                at_a = self.force_at(a);
                greatest = longer(greatest, at_a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = inner(low, high)[1];
                at_b = self.force_at(b);
                greatest = longer(greatest, at_b);
            }
        }
        greatest
    }

    /// Spindle angles at which the force is not smooth, rad.
    fn breakpoints(&self) -> Vec<f64> {
        let Some(arc) = self.arc_of_cylinder() else {
            return Vec::new();
        };
        let cutter = &self.cutter;
        let lags = [0.0, cutter.lag(self.cut.depth)];
        let mut angles = Vec::new();
        for tooth in 0..cutter.flutes() {
            let at_tooth = f64::from(tooth) * cutter.pitch();
            for lag in lags {
                angles.extend([arc.entry, arc.exit].map(|phi| phi + lag + at_tooth));
            }
            let own = cutter.radial_runout(tooth, 0.0);
            for before in 1..=cutter.flutes() {
                let other = (tooth + cutter.flutes() - before % cutter.flutes()) % cutter.flutes();
                let farther_out = own - cutter.radial_runout(other, 0.0);
                let sine = -farther_out / (f64::from(before) * self.cut.feed);
                if farther_out != 0.0 && sine.abs() <= 1.0 {
                    let phi = sine.asin();
                    let both = [phi, PI - phi].map(|phi| phi.rem_euclid(TAU));
                    let inside = both.into_iter().filter(|phi| arc.contains(*phi));
                    angles.extend(inside.map(|phi| phi + at_tooth));
                }
            }
        }
        angles
    }
}

/// The longer of two forces; of those that differ by rounding the first.
fn longer(first: Vector3<f64>, second: Vector3<f64>) -> Vector3<f64> {
    match second.norm_squared() > (1.0 + ROUNDING) * first.norm_squared() {
        true => second,
        false => first,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{Cut, Cutter, CuttingLaw, Engagement, Hand, Immersion, LeanInCut, Mechanistic, Runout};

    const MM: f64 = 1e-3;

    /// A flat end mill of 8 mm with 4 flutes in a cut 1 mm deep, 25 um per tooth.
    fn milling(helix: f64, offset: f64, immersion: Immersion) -> Milling {
        let runout = Runout { offset, angle: 0.3 };
        let cutter = Cutter::flat(8.0 * MM, 4).unwrap();
        let cutter = cutter.with_helix(helix, Hand::Right).unwrap();
        let cutter = cutter.with_runout(runout).unwrap();
        let law = Mechanistic::new(Vector3::new(8e8, 2.5e8, 1e8), Vector3::new(1.2e4, 1.4e4, 1e3)).unwrap();
        let cut = Cut {
            depth: MM,
            engagement: Engagement::of(immersion, 8.0 * MM).unwrap(),
            feed: 25e-6,
            rise: 0.0,
            lean: LeanInCut::default(),
        };
        Milling::new(cutter, CuttingLaw::Mechanistic(law), cut).unwrap()
    }

    /// The greatest force at very fine steps.
    fn fine(milling: &Milling) -> f64 {
        let angles = even_steps(milling.period(), 100_000);
        angles
            .map(|angle| milling.force_at(angle).norm())
            .fold(0.0, f64::max)
    }

    #[test]
    fn the_peak_is_that_of_very_fine_steps() {
        let immersions = [
            Immersion::Up(4.277 * MM),
            Immersion::Down(1.3 * MM),
            Immersion::Centred(3.1 * MM),
            Immersion::Slot,
        ];
        for immersion in immersions {
            for offset in [0.0, 3e-6, 15e-6, 60e-6] {
                // With a helix and runout forces are summed over slices, which is not exact.
                for helix in if offset == 0.0 { vec![0.0, 0.5] } else { vec![0.0] } {
                    let milling = milling(helix, offset, immersion);
                    let (peak, fine) = (milling.peak(360).norm(), fine(&milling));
                    // Half a fine step, 3e-5 rad, from a jump or maximum: the force changes by less than as many
                    // parts of itself.
                    let within = fine * (1.0 - 1e-12)..=fine * (1.0 + 1e-4);
                    assert!(
                        within.contains(&peak),
                        "{immersion:?} {offset} {helix}: {peak} {fine}"
                    );
                }
            }
        }
    }

    #[test]
    fn even_steps_alone_miss_where_a_straight_tooth_leaves() {
        let ratio = |tenths: u32| {
            let milling = milling(0.0, 15e-6, Immersion::Up(f64::from(tenths) * 0.1 * MM));
            let angles = even_steps(milling.period(), 360);
            let coarse = angles
                .map(|angle| milling.force_at(angle).norm())
                .fold(0.0, f64::max);
            milling.peak(360).norm() / coarse
        };
        let ratios: Vec<f64> = (2..80).map(ratio).collect();
        // A degree of a thin cut is a large part of it.
        assert!(ratios.iter().all(|ratio| *ratio >= 1.0));
        assert!(ratios.iter().any(|ratio| *ratio > 1.005), "{ratios:?}");
    }
}
