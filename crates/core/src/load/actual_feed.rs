//! Cuts at a feed that is not the programmed one: chips are thinner in proportion, at the same spindle speed.

use rayon::prelude::*;

use super::along::{CutHere, CutsAlong};
use super::milling::Milling;

/// A smaller part of the feed has the force of this one: the tool rests, its chips have no thickness.
const LEAST_PART: f64 = 1e-3;

impl CutsAlong {
    /// The cuts with the feed of each point multiplied by its factor, and their forces; the greatest force keeps its ratio to the mean.
    ///
    /// # Panics
    /// If there are fewer factors than points.
    #[must_use]
    pub fn at_feeds(&self, factors: &[f64]) -> CutsAlong {
        let points = self.points.par_iter().zip(&factors[..self.points.len()]);
        CutsAlong {
            cutters: self.cutters.clone(),
            points: points.map(|(here, factor)| self.here_at(here, *factor)).collect(),
            ..*self
        }
    }

    fn here_at(&self, here: &CutHere, factor: f64) -> CutHere {
        // Not a number: the feed is not known.
        let factor = factor.max(LEAST_PART);
        if (factor - 1.0).abs() < 1e-9 {
            return *here;
        }
        let Some(mut cut) = here.cut else { return *here };
        cut.feed *= factor;
        cut.rise *= factor;
        let Ok(milling) = Milling::new(self.cutters[here.cutter], self.law, cut) else {
            return *here;
        };
        let mean = milling.mean_force();
        let [mean, greatest] = here.under(mean);
        CutHere {
            cut: Some(cut),
            mean,
            greatest,
            ..*here
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::load::{
        Cut, Cutter, CuttingLaw, Engagement, GreatestForce, Immersion, LeanInCut, Mechanistic,
    };

    #[test]
    fn a_law_without_edge_force_has_forces_in_proportion_to_the_feed() {
        let cutter = Cutter::flat(0.01, 2).unwrap();
        for (edge, exact) in [(0.0, true), (2e4, false)] {
            let law = Mechanistic::new(Vector3::new(8e8, 3e8, 2e8), Vector3::repeat(edge)).unwrap();
            let cut = Cut {
                depth: 1e-3,
                engagement: Engagement::at_depth(Immersion::Down(0.003), &cutter, 1e-3).unwrap(),
                feed: 5e-5,
                rise: 0.0,
                lean: LeanInCut::default(),
            };
            let milling = Milling::new(cutter, CuttingLaw::Mechanistic(law), cut).unwrap();
            let mean = milling.mean_force();
            let cuts = CutsAlong {
                cutters: vec![cutter],
                law: CuttingLaw::Mechanistic(law),
                greatest: GreatestForce::SecondCase,
                points: vec![
                    CutHere {
                        cutter: 0,
                        cut: Some(cut),
                        mean,
                        greatest: 2.0 * mean,
                    };
                    4
                ],
            };
            let found = cuts.at_feeds(&[1.0, 0.5, 0.0, f64::NAN]);
            assert_eq!(found.points[0], cuts.points[0]);
            let half = &found.points[1];
            assert_eq!(((half.mean - 0.5 * mean).norm() < 1e-9 * mean.norm()), exact);
            assert!(half.mean.norm() < mean.norm() && half.mean.norm() > 0.49 * mean.norm());
            assert!((half.greatest.norm() - 2.0 * half.mean.norm()).abs() < 1e-9);
            assert!(found.points[2].mean.norm() < half.mean.norm());
            assert_eq!(found.points[2], found.points[3]);
        }
    }
}
