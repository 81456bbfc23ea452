//! One experiment: noisy measurements of the true arm, and the estimates from them.

use std::f64::consts::TAU;

use armill_core::budget::{Datum, Removed, Turn, agreement};
use armill_core::identify::effect::{Effects, State};
use armill_core::identify::fit::Scatter;
use armill_core::identify::unknown::drives as drive_unknowns;
use armill_core::identify::{LoadTest, Loss, Measured, Method, Points, Prior, Reading, identify};
use armill_core::kernel::Question;
use armill_core::load::{LoadCases, LoadFrame, PathLoad};
use armill_core::map::{along_path, radial_deviations};
use armill_core::measure::ballbar::joints::{
    BacklashOptions, Circle, Followed, Observed, fit_backlash, follow,
};
use armill_core::measure::ballbar::{CircularTest, Direction, Run};
use armill_core::nalgebra::{Point2, Vector3};
use armill_core::robot::{Axis, Robot};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

use crate::arms::Stream;
use crate::arms::circles::{RADIUS, question, three, tool};
use crate::cell::{Truth, calibrated, drives, model, name_of, ring, tracked};

/// Standard deviations of the instruments.
mod noise {
    /// Tracker, m.
    pub const TRACKER: f64 = 2e-5;
    /// Dial gauge at the pulled tool, m.
    pub const GAUGE: f64 = 5e-6;
    /// Ball-bar, m.
    pub const BALLBAR: f64 = 1e-6;
    /// Dynamometer, a sample, N.
    pub const DYNAMOMETER: f64 = 15.0;
    /// Probe, m.
    pub const PROBE: f64 = 2e-6;
}

/// Number of loads.
const TESTS: usize = 20;
/// Samples of the dynamometer.
const SAMPLES: usize = 400;

/// An estimate and the true value.
#[derive(Clone, Debug)]
pub struct Estimate {
    pub name: String,
    pub truth: f64,
    pub found: f64,
    pub u: f64,
}

/// Result of one experiment.
pub struct Found {
    pub estimates: Vec<Estimate>,
    /// Root mean square of the ring's radial deviation about its circle, m.
    pub ring_rms: f64,
    /// Share of it that is predicted.
    pub explained: f64,
    /// The same with the values of the controller and the data sheet instead of the measured ones.
    pub explained_untaught: f64,
}

pub fn experiment(truth: &Truth, seed: u64) -> Found {
    let mut random = Stream(100_000 + 977 * seed);
    let mut estimates = Vec::new();

    let poses = tracked(&truth.actual, noise::TRACKER, &mut random);
    let geometry = calibrated(&truth.believed, &poses);
    for (name, true_value) in &truth.geometry {
        let found = geometry
            .estimates
            .iter()
            .find(|one| name_of(&one.unknown) == *name);
        let found = found.unwrap_or_else(|| panic!("seed {seed}: {name} is not identifiable"));
        estimates.push(Estimate {
            name: name.clone(),
            truth: *true_value,
            found: found.value,
            u: found.standard_uncertainty,
        });
    }
    let as_measured = geometry.bare_robot(&truth.believed).unwrap();

    let (compliance, compliance_u) = compliances(truth, &as_measured, &mut random);
    let (gap, gap_u) = play(truth, &as_measured, &mut random);
    let (force, force_u) = forces(truth.force, &mut random);
    let named = |kind: &str, found: &[f64], u: &[f64], truth: &[f64]| -> Vec<Estimate> {
        let of = |k: usize| Estimate {
            name: format!("{kind} {k}"),
            truth: truth[k],
            found: found[k],
            u: u[k],
        };
        (0..truth.len()).map(of).collect()
    };
    estimates.extend(named("compliance", &compliance, &compliance_u, &truth.compliance));
    estimates.extend(named("gap", &gap, &gap_u, &truth.gaps));
    estimates.extend(named(
        "force",
        force.as_slice(),
        force_u.as_slice(),
        truth.force.as_slice(),
    ));

    // The measured ring, and its prediction from all estimates.
    let zeros = [0.0; 6];
    let true_drives = drives(&truth.compliance, &zeros);
    let tool = tool();
    let true_model = truth.model();
    let cut = radial(
        &question(&truth.believed, (&true_drives, &true_model), &tool),
        truth.force,
    );
    let probed: Vec<f64> = cut.iter().map(|r| r + noise::PROBE * random.normal()).collect();
    let found_model = model(&gap, &gap_u, as_measured);
    let found_drives = drives(&compliance, &compliance_u);
    let predicted = radial(
        &question(&truth.believed, (&found_drives, &found_model), &tool),
        force,
    );
    let sheet = truth.believed.compliance().unwrap();
    let plain = model(&zeros, &zeros, truth.believed.clone());
    let untaught = radial(&question(&truth.believed, (sheet, &plain), &tool), truth.force);

    let turn = Turn::new(
        (0..cut.len())
            .map(|k| TAU * k as f64 / cut.len() as f64)
            .collect(),
    )
    .unwrap();
    let datum = Removed {
        centre: true,
        radius: true,
    };
    let [probed, predicted, untaught] =
        [probed, predicted, untaught].map(|curve| Datum::remove(&turn, &curve, datum).1);
    let explained = |curve: &[f64]| agreement(&turn, curve, &probed).unwrap().explained;
    Found {
        estimates,
        ring_rms: turn.rms(&probed),
        explained: explained(&predicted),
        explained_untaught: explained(&untaught),
    }
}

/// Compliances of the drives from pulls at the tool, rad/(N m), and their standard uncertainties.
fn compliances(truth: &Truth, as_measured: &Robot, random: &mut Stream) -> (Vec<f64>, Vec<f64>) {
    let on_truth = drive_unknowns(&truth.actual);
    let state = State::of_sizes(truth.compliance.clone());
    let tests: Vec<LoadTest> = (0..TESTS)
        .map(|_| {
            let mut test = LoadTest {
                joints: random.joints(&truth.believed),
                wrench: Wrench::from_force(random.vector(400.0)),
                force_point: Vector3::new(0.03, -0.02, 0.15),
                measured_point: Vector3::new(0.03, -0.02, 0.15),
                readings: Vec::new(),
            };
            test.readings = Axis::ALL
                .map(|axis| Reading {
                    what: Measured::Displacement(axis),
                    value: 0.0,
                    standard_uncertainty: noise::GAUGE,
                })
                .to_vec();
            let shown = Effects::of(&truth.actual, &on_truth, &test).readings(&on_truth, &state);
            for (reading, shown) in test.readings.iter_mut().zip(shown) {
                reading.value = shown + noise::GAUGE * random.normal();
            }
            test
        })
        .collect();
    let method = Method {
        prior: Prior::None,
        points: Points::Known,
        loss: Loss::Squares,
        scatter: Scatter::Found,
    };
    let found = identify(as_measured, &drive_unknowns(as_measured), &tests, method).unwrap();
    let each = found.estimates.iter();
    each.map(|one| (one.value, one.standard_uncertainty)).unzip()
}

/// Backlash from circular tests, rad, and the standard uncertainties.
fn play(truth: &Truth, as_measured: &Robot, random: &mut Stream) -> (Vec<f64>, Vec<f64>) {
    let tool = tool();
    let sheet = truth.believed.compliance().unwrap();
    let with = |actual: &Robot, circle: &Circle| -> Followed {
        let model = model(&[0.0; 6], &[0.0; 6], actual.clone());
        let question = question(&truth.believed, (sheet, &model), &tool);
        follow(&question, circle, 720, Watch::NONE).unwrap()
    };
    let angles: Vec<f64> = (0..720)
        .map(|k| (0.5 * f64::from(k) + 0.1).to_radians())
        .collect();
    let circles = three();
    let tests: Vec<CircularTest> = circles
        .iter()
        .map(|circle| {
            let of = with(&truth.actual, circle);
            let run = |direction| {
                let shown = of.deviation(&truth.gaps, direction, &angles);
                let noisy = shown.iter().map(|dr| dr + noise::BALLBAR * random.normal());
                Run::new(direction, angles.clone(), noisy.collect()).unwrap()
            };
            let both: Vec<Run> = Direction::BOTH
                .into_iter()
                .chain(Direction::BOTH)
                .map(run)
                .collect();
            CircularTest::new(RADIUS, both).unwrap()
        })
        .collect();
    let followed = circles.each_ref().map(|circle| with(as_measured, circle));
    let observed: Vec<Observed<'_>> = followed
        .iter()
        .zip(&tests)
        .map(|(followed, test)| Observed { followed, test })
        .collect();
    let found = fit_backlash(&observed, &BacklashOptions::of_all(6))
        .unwrap()
        .unwrap();
    let gap = |joint| {
        found
            .of(joint)
            .unwrap_or_else(|| panic!("joint {joint} is not identifiable"))
    };
    (0..6).map(|joint| (gap(joint).gap, gap(joint).u)).unzip()
}

/// Mean force from samples of a dynamometer, N, and its standard uncertainty.
fn forces(truth: Vector3<f64>, random: &mut Stream) -> (Vector3<f64>, Vector3<f64>) {
    let samples: Vec<Vector3<f64>> = (0..SAMPLES)
        .map(|_| truth + Vector3::from_fn(|_, _| noise::DYNAMOMETER * random.normal()))
        .collect();
    let count = SAMPLES as f64;
    let mean = samples.iter().sum::<Vector3<f64>>() / count;
    let squares: Vector3<f64> = samples.iter().map(|s| (s - mean).map(|x| x * x)).sum();
    (mean, squares.map(|s| (s / (count - 1.0) / count).sqrt()))
}

/// Radial deviation of the ring, m, outwards, at each of its points.
fn radial(question: &Question<'_>, force: Vector3<f64>) -> Vec<f64> {
    let track = ring();
    let load = PathLoad::Cases(LoadCases {
        frame: LoadFrame::Base,
        cases: vec![Wrench::from_force(force)],
    });
    let along = along_path(question, &track, load, Watch::NONE).unwrap();
    radial_deviations(&track, &along.answers, Point2::origin())[0]
        .outward
        .clone()
}
