//! A search with a tool that leans in a cut, against every constant setting under the forces of the leaning tool.

use nalgebra::{Point3, Vector3};

use super::tests::{lean, line, on_rail, question, tool};
use super::*;
use crate::kernel::BranchChoice;
use crate::load::{
    Cut, CutHere, CutsAlong, Cutter, CuttingLaw, Engagement, GreatestForce, Immersion, LeanInCut, LoadFrame,
    Mechanistic, Milling, PathLoad,
};
use crate::map::obstacles;
use crate::optimize::posture::tests::search;
use crate::optimize::{Steps, postures_along};
use crate::spatial::Wrench;

/// A ball nose of 12 mm, as the end of `lean`, in a slot of 1 mm.
fn cuts(points: usize) -> CutsAlong {
    let cutter = Cutter::ball(0.012, 2).unwrap();
    let law = Mechanistic::new(Vector3::new(8e8, 3e8, 1e8), Vector3::new(2e4, 3e4, 2e3)).unwrap();
    let law = CuttingLaw::Mechanistic(law);
    let cut = Cut {
        depth: 1e-3,
        engagement: Engagement::at_depth(Immersion::Slot, &cutter, 1e-3).unwrap(),
        feed: 1e-4,
        rise: 0.0,
        lean: LeanInCut::default(),
    };
    let here = CutHere {
        cutter: 0,
        cut: Some(cut),
        mean: Milling::new(cutter, law, cut).unwrap().mean_force(),
        greatest: Vector3::zeros(),
    };
    CutsAlong {
        cutters: vec![cutter],
        law,
        greatest: GreatestForce::LeftOut,
        points: vec![here; points],
    }
}

/// The mean forces alone, without equilibrium: those of a lattice.
fn nominal(cuts: &CutsAlong) -> PathLoad {
    PathLoad::OfEach {
        cases: 1,
        frame: LoadFrame::Feed,
        wrenches: cuts
            .points
            .iter()
            .map(|here| Wrench::from_force(here.mean))
            .collect(),
    }
}

#[test]
fn the_lean_of_a_cut_is_the_best_under_the_forces_of_the_leaning_tool() {
    let (robot, tool) = (on_rail(), tool());
    let question = question(&robot, &tool);
    let track = line(Point3::new(0.8, 0.5, 0.4), 0.3, 0.05);
    let cuts = cuts(track.len());
    let load = PathLoad::Cuts(cuts.clone());
    let spins = Steps {
        first: -0.6,
        step: 0.6,
        count: 3,
    };
    let few = PostureSearch {
        spins,
        lean: Some(LeanRange {
            rate: 1e-9,
            ..lean(0.2, 3)
        }),
        turn_rate: 1e-9,
        ..search(Objective::Worst)
    };
    let path = LoadedTrack {
        track: &track,
        load: &load,
    };
    let found = postures_along(&question, path, &few, Watch::NONE).unwrap();
    assert_eq!((&found.unreachable[..], &found.breaks[..]), (&[][..], &[][..]));
    let mut least = f64::INFINITY;
    for setting in 0..3 * 3 * 3 {
        let digit = |of: usize| setting / of % 3;
        let [lead, tilt] = [digit(3), digit(9)].map(|index| lean(0.2, 3).leads.at(index));
        let leans = vec![Lean { lead, tilt }; track.len()];
        let leaning = track.leaning(&leans, lean(0.2, 3).end).spun(spins.at(digit(1)));
        for branch in Branch::ALL {
            let choices = vec![(0, BranchChoice::Of(branch.into()))];
            let forces = nominal(&cuts.leaning(&leans));
            let along = along_postures(&question, &leaning, forces, choices, Watch::NONE).unwrap();
            let wrist = |index: usize| along.answers.joints_at(index)[5].sin().abs() > few.wrist.sin();
            let usable = along.answers.points.iter().all(|point| {
                point
                    .as_ref()
                    .is_ok_and(|of| of.within_limits() && of.singularity.is_none())
            });
            let fine = usable && (0..track.len()).all(wrist);
            if fine && obstacles(&robot, &track.path, &along.answers, 0.0).count() == 0 {
                least = least.min(Objective::Worst.along(few.component, &leaning, &along.answers));
            }
        }
    }
    assert!(
        (found.reached - least).abs() < 1e-9 * least,
        "{} {least}",
        found.reached
    );
    // The path that is found is evaluated with the forces of its leaning tool, given or calculated there.
    let turned = found.turned(&track);
    let both = [load.clone(), found.load(&load)].map(|load| {
        along_postures(&question, &turned, load, found.choices(), Watch::NONE)
            .unwrap()
            .load
    });
    let means = both.each_ref().map(|load| match load {
        PathLoad::Cuts(cuts) => cuts.points.iter().map(|here| here.mean).collect::<Vec<_>>(),
        _ => Vec::new(),
    });
    assert_eq!(means[0].len(), track.len());
    for (first, second) in means[0].iter().zip(&means[1]) {
        assert!((first - second).norm() < 1e-6 * first.norm());
    }
}
