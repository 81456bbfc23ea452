//! Forces of the cuts along a path with a tool that leans.
//!
//! The cut at a point is that of the programmed axis, or that found in a stock, made with the leaning tool
//! ([`Cut::leaning`](super::Cut::leaning)). Its forces are in the feed frame of the leaning tool. In a search over many different
//! cuts, as in a stock, those that are equal to a fiftieth of the diameter share the ratio of the greatest force to the mean.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, PoisonError};

use nalgebra::Vector3;
use rayon::prelude::*;

use super::along::{CutHere, CutsAlong, GreatestForce, PathLoad};
use super::cut::Cut;
use super::lean::Lean;
use super::milling::Milling;

/// Number of different cuts up to which each has its own greatest force in a search.
const FEW_CUTS: usize = 16;
/// Beyond it, cuts whose depth and edges differ by less than this part of the diameter share one ratio.
const ALIKE: f64 = 0.02;
/// Leans that differ by less, rad, are the same: roundings of an axis.
const SAME: f64 = 1e-12;
/// Steps of a period at which the peak of a leaning tool is sought: its force has no jumps.
const PEAK_STEPS: u32 = 120;

impl CutsAlong {
    /// The cuts with the tool leaning by `leans`, point after point; cuts that lean so already are kept.
    ///
    /// # Panics
    /// If there are fewer leans than points.
    #[must_use]
    pub fn leaning(&self, leans: &[Lean]) -> CutsAlong {
        let points = self.points.par_iter().zip(&leans[..self.points.len()]);
        CutsAlong {
            cutters: self.cutters.clone(),
            points: points
                .map(|(here, lean)| self.leaning_here(here, *lean))
                .collect(),
            ..*self
        }
    }

    /// The milling of the cut here with the tool leaning; `None` where nothing is cut.
    fn leaning_milling(&self, here: &CutHere, lean: Lean) -> Option<Milling> {
        let cutter = self.cutters[here.cutter];
        let cut = here.cut?.leaning(lean, cutter.body());
        Milling::new(cutter, self.law, cut).ok()
    }

    fn leaning_here(&self, here: &CutHere, lean: Lean) -> CutHere {
        let leans_so = |cut: Cut| {
            let had = cut.lean.lean;
            (had.lead - lean.lead).abs().max((had.tilt - lean.tilt).abs()) <= SAME
        };
        let milling = (!here.cut.is_some_and(leans_so)).then(|| self.leaning_milling(here, lean));
        let Some(milling) = milling.flatten() else {
            return *here;
        };
        CutHere {
            cut: Some(*milling.cut()),
            mean: milling.mean_force(),
            greatest: match self.greatest {
                GreatestForce::LeftOut => here.greatest,
                GreatestForce::SecondCase => milling.peak(PEAK_STEPS),
            },
            ..*here
        }
    }
}

impl PathLoad {
    /// The load with the tool leaning by `leans` from the programmed axis, point after point: that of a cut changes.
    ///
    /// # Panics
    /// If there are fewer leans than points of a cut.
    #[must_use]
    pub fn leaning(&self, leans: &[Lean]) -> PathLoad {
        match self {
            PathLoad::Cuts(cuts) => PathLoad::Cuts(cuts.leaning(leans)),
            given => given.clone(),
        }
    }
}

/// Forces of upright cuts in the leans of a search, each computed once.
#[derive(Debug, Default)]
pub struct LeaningForces {
    /// Whether there are so many cuts that those alike share the ratio of the greatest force to the mean.
    many: bool,
    known: Mutex<BTreeMap<CutKey, [Vector3<f64>; 2]>>,
}

/// A cut with its lean: tool, depth, edges, pass before, feed, rise, lead, tilt.
type CutKey = [u64; 9];

impl LeaningForces {
    /// For the cuts of this load, if it has any.
    pub fn of(load: &PathLoad) -> LeaningForces {
        let mut different = BTreeSet::new();
        if let PathLoad::Cuts(cuts) = load {
            for here in &cuts.points {
                different.extend(here.cut.map(|cut| key(here, &cut, Lean::NONE)));
                if different.len() > FEW_CUTS {
                    break;
                }
            }
        }
        LeaningForces {
            many: different.len() > FEW_CUTS,
            known: Mutex::default(),
        }
    }

    /// Mean and greatest force at point `index` of upright cuts with the tool leaning by `lean`; N, feed frame of the
    /// leaning tool.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn at(&self, cuts: &CutsAlong, index: usize, lean: Lean) -> [Vector3<f64>; 2] {
        let here = &cuts.points[index];
        let Some(cut) = here.cut.filter(|_| lean != Lean::NONE) else {
            return [here.mean, here.greatest];
        };
        if !self.many {
            return self.known(cuts, here, lean);
        }
        let milling = cuts.leaning_milling(here, lean);
        let mean = milling.map_or(here.mean, |milling| milling.mean_force());
        if cuts.greatest == GreatestForce::LeftOut {
            return [mean, here.greatest];
        }
        let alike = CutHere {
            cut: Some(cut.rounded(ALIKE, cuts.cutters[here.cutter].diameter())),
            ..*here
        };
        let [of_alike, greatest] = self.known(cuts, &alike, lean);
        [
            mean,
            greatest * (mean.norm() / of_alike.norm().max(f64::MIN_POSITIVE)),
        ]
    }

    /// The forces of this cut, computed once.
    fn known(&self, cuts: &CutsAlong, here: &CutHere, lean: Lean) -> [Vector3<f64>; 2] {
        let Some(cut) = here.cut else {
            return [here.mean, here.greatest];
        };
        let key = key(here, &cut, lean);
        let lock = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(&key) {
            return *known;
        }
        let leaning = cuts.leaning_here(here, lean);
        let forces = [leaning.mean, leaning.greatest];
        lock().insert(key, forces);
        forces
    }
}

fn key(here: &CutHere, cut: &Cut, lean: Lean) -> CutKey {
    let [right, left] = cut.engagement.edges();
    let pass_before = cut.engagement.pass_before().unwrap_or(0.0);
    let [depth, right, left, pass_before, feed, rise, lead, tilt] = [
        cut.depth,
        right,
        left,
        pass_before,
        cut.feed,
        cut.rise,
        lean.lead,
        lean.tilt,
    ]
    .map(f64::to_bits);
    [
        here.cutter as u64,
        depth,
        right,
        left,
        pass_before,
        feed,
        rise,
        lead,
        tilt,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{Cutter, CuttingLaw, Engagement, Immersion, LeanInCut, Mechanistic};

    const MM: f64 = 1e-3;

    fn cuts(greatest: GreatestForce) -> CutsAlong {
        let cutter = Cutter::bull_nose(12.0 * MM, 3.0 * MM, 2).unwrap();
        let law = Mechanistic::new(Vector3::new(8e8, 3e8, 1e8), Vector3::new(1e4, 1e4, 2e3)).unwrap();
        let law = CuttingLaw::Mechanistic(law);
        let here = |depth: f64| {
            let cut = Cut {
                depth,
                engagement: Engagement::at_depth(Immersion::Up(3.0 * MM), &cutter, depth).unwrap(),
                feed: 0.1 * MM,
                rise: 0.0,
                lean: LeanInCut::default(),
            };
            let milling = Milling::new(cutter, law, cut).unwrap();
            CutHere {
                cutter: 0,
                cut: Some(cut),
                mean: milling.mean_force(),
                greatest: milling.peak(PEAK_STEPS),
            }
        };
        CutsAlong {
            cutters: vec![cutter],
            law,
            greatest,
            points: vec![here(MM), here(MM), CutHere::NOTHING, here(2.0 * MM)],
        }
    }

    const LEAN: Lean = Lean {
        lead: 0.2,
        tilt: -0.1,
    };

    #[test]
    fn the_forces_of_a_search_are_those_of_the_path_that_it_finds() {
        let cuts = cuts(GreatestForce::LeftOut);
        let leaning = cuts.leaning(&[LEAN, Lean::NONE, LEAN, LEAN]);
        let forces = LeaningForces::of(&PathLoad::Cuts(cuts.clone()));
        for (index, lean) in [
            (0, LEAN),
            (1, Lean::NONE),
            (1, LEAN),
            (2, LEAN),
            (3, LEAN),
            (0, LEAN),
        ] {
            let [mean, _] = forces.at(&cuts, index, lean);
            let expected = if (index, lean) == (1, LEAN) { 0 } else { index };
            assert_eq!(mean, leaning.points[expected].mean, "{index}");
        }
        assert!((leaning.points[0].mean - cuts.points[0].mean).norm() > 5.0);
        assert_eq!(leaning.points[1], cuts.points[1]);
        assert_eq!(leaning.points[2], CutHere::NOTHING);
        // Upright again is the cut before.
        let upright = leaning.leaning(&[Lean::NONE; 4]);
        assert_eq!(upright.points[0].cut, cuts.points[0].cut);
        assert_eq!(upright.points[0].mean, cuts.points[0].mean);
    }

    #[test]
    fn the_greatest_force_is_that_of_the_leaning_tool() {
        let cuts = cuts(GreatestForce::SecondCase);
        let leaning = cuts.leaning(&[LEAN; 4]);
        let ratio = |here: &CutHere| here.greatest.norm() / here.mean.norm();
        let [upright, leaned] = [&cuts, &leaning].map(|of| ratio(&of.points[0]));
        assert!(
            leaned > 1.0 && (leaned - upright).abs() > 1e-3,
            "{leaned} {upright}"
        );
        assert_eq!(leaning.points[2], CutHere::NOTHING);
        let forces = LeaningForces::of(&PathLoad::Cuts(cuts.clone()));
        assert_eq!(forces.at(&cuts, 0, LEAN)[1], leaning.points[0].greatest);
    }

    #[test]
    fn of_many_cuts_those_alike_share_the_ratio_of_the_greatest_force() {
        let few = cuts(GreatestForce::SecondCase);
        let deeper = |k: usize| {
            let cut = few.points[0].cut.map(|cut| Cut {
                depth: cut.depth + 1e-6 * k as f64,
                ..cut
            });
            CutHere { cut, ..few.points[0] }
        };
        let many = CutsAlong {
            points: (0..40).map(deeper).collect(),
            ..few.clone()
        };
        let forces = LeaningForces::of(&PathLoad::Cuts(many.clone()));
        let exact = many.leaning(&[LEAN; 40]);
        for (index, here) in exact.points.iter().enumerate() {
            let [mean, greatest] = forces.at(&many, index, LEAN);
            assert_eq!(mean, here.mean);
            // Depths rounded to 0.24 mm in 1 mm.
            assert!((greatest - here.greatest).norm() < 0.1 * here.greatest.norm());
        }
        assert_eq!(forces.known.lock().unwrap().len(), 1);
    }

    #[test]
    fn given_loads_do_not_change() {
        let given = PathLoad::OfEach {
            cases: 1,
            frame: crate::load::LoadFrame::Feed,
            wrenches: vec![crate::spatial::Wrench::from_force(Vector3::x()); 2],
        };
        assert_eq!(given.leaning(&[LEAN; 2]), given);
    }
}
