//! Measured forces in a study: a record made of the forces that the cut predicts gives the deviations of the cut again,
//! whatever the drift, the delay, the sign, the axes and the unit it was made with.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

use armill_core::map::AlongPath;
use armill_core::nalgebra::{Rotation3, Vector3};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use armill_study::analysis::AnalysisData;
use armill_study::analysis::path::PathAnalysis;
use armill_study::answer::{MeasuredAnswer, StudyAnswer, answer};
use armill_study::file::resolve::{Study, read};
use armill_study::run::run;

/// A horizontal plate in front of an MH12.
const CELL: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
plane = { centre_mm = [1000, 50, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }
posture = { branch = "front elbow-up no-flip" }
"#;
const CUT: &str = r#"
[cut]
material = "aluminium-6082-t6"
cutter = { diameter_mm = 10, flutes = 2 }
axial_depth_mm = 1
radial_depth_mm = 3
side = "down"
"#;
/// Lines 5 and 6 take 4 s each, rapids of 50 mm at 100 mm/s half a second, line 10 takes 2 s.
const PROGRAM: &str = "G21 G90 G17\nS9000 M3\nG0 X0 Y0 Z10\nG0 Z0\nG1 X40 F600\nG1 Y20 F300\nG0 Z5\nG0 X0\nG0 Z0\nG1 Y0 F600\nG0 Z10\nM2\n";
const CUTS_S: f64 = 10.5;

/// A study with this program and further keys of its analysis.
fn study(keys: &str, record: &str) -> Result<Study, String> {
    study_of(PROGRAM, keys, record)
}

fn study_of(program: &str, keys: &str, record: &str) -> Result<Study, String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.ngc"), program).unwrap();
    fs::write(folder.path().join("record.csv"), record).unwrap();
    let text = format!(
        "{CELL}{CUT}\n[[analysis]]\nkind = \"path\"\nname = \"part\"\n[analysis.program]\nfile = \"part.ngc\"\n{keys}"
    );
    read("study.toml", folder.path(), text.as_bytes()).map_err(|error| error.to_string())
}

fn program(study: &Study) -> (&PathAnalysis, AlongPath) {
    match run(study, Watch::NONE).unwrap().remove(0).found {
        AnalysisData::Path(analysis, found) => (analysis, found.along),
        _ => panic!("no path"),
    }
}

fn reported(study: &Study) -> (StudyAnswer, MeasuredAnswer) {
    let answer = answer(study, &run(study, Watch::NONE).unwrap());
    let measured = answer.paths[0].measured.clone().unwrap();
    (answer, measured)
}

/// Time of the tip at each point, from the text of the program.
fn times(analysis: &PathAnalysis) -> Vec<f64> {
    let time = |point: &armill_core::path::PathPoint| match point.line {
        5 => point.along / 0.01,
        6 => 4.0 + (point.along - 0.04) / 0.005,
        10 => 8.5 + (point.along - 0.06) / 0.01,
        line => panic!("line {line}"),
    };
    analysis.track.path.points.iter().map(time).collect()
}

/// Forces of the cut at the points where tool and cut rest, base axes, and the deviations that they make.
struct Witness {
    times: Vec<f64>,
    forces: Vec<Vector3<f64>>,
    feeds: Vec<Rotation3<f64>>,
    part: Rotation3<f64>,
    deviations: Vec<Vector3<f64>>,
}

impl Witness {
    fn new() -> Witness {
        let of_cut = study("", "").unwrap();
        let (analysis, found) = program(&of_cut);
        let count = analysis.track.len();
        let force = |i: usize| {
            let mut out = [Wrench::ZERO];
            analysis.track.wrenches(&found.load, i, &mut out);
            out[0].force
        };
        Witness {
            times: times(analysis),
            forces: (0..count).map(force).collect(),
            feeds: (0..count).map(|i| analysis.track.base_from_feed(i)).collect(),
            part: analysis.track.base_from_part.rotation.to_rotation_matrix(),
            deviations: (0..count).map(|i| found.answers.deviations_at(i)[0]).collect(),
        }
    }

    /// The point before an instant and how far it is to the next; `None` where nothing is cut.
    fn at(&self, time: f64) -> Option<(usize, f64)> {
        let after = self.times.iter().position(|t| *t > time)?;
        let before = after.checked_sub(1)?;
        let step = self.times[after] - self.times[before];
        // Points of one cut are at most 0.2 s apart, the rapid takes 0.5 s.
        (step < 0.3).then(|| (before, (time - self.times[before]) / step))
    }

    fn force(&self, time: f64) -> Vector3<f64> {
        self.at(time).map_or_else(Vector3::zeros, |(i, part)| {
            self.forces[i] * (1.0 - part) + self.forces[i + 1] * part
        })
    }

    /// A CSV of `seconds` at `rate_hz` in which the program begins at `start`; `change` makes of force (base), time and
    /// sample what the sensor shows.
    fn record(
        &self,
        (seconds, rate_hz, start): (f64, f64, f64),
        change: impl Fn(Vector3<f64>, f64, usize) -> Vector3<f64>,
    ) -> String {
        let mut text = "time_s,fx_n,fy_n,fz_n\n".to_owned();
        for k in 0..(seconds * rate_hz) as usize {
            let time = k as f64 / rate_hz;
            let shown = change(self.force(time - start), time - start, k);
            let _ = writeln!(text, "{time:.6},{:.7},{:.7},{:.7}", shown.x, shown.y, shown.z);
        }
        text
    }

    /// The largest difference of deviations at points that are at least `apart` s from every jump of the force, as part
    /// of the largest deviation; those of `sign` times the cut are expected.
    fn differs(&self, found: &AlongPath, case: usize, apart: f64, sign: f64) -> f64 {
        let largest = self.deviations.iter().map(Vector3::norm).fold(0.0, f64::max);
        let far = |i: &usize| {
            let jumps = [0.0, 4.0, 4.2, 8.0, 8.5, CUTS_S];
            jumps.iter().all(|jump| (self.times[*i] - jump).abs() > apart)
        };
        let inner: Vec<usize> = (0..self.times.len()).filter(far).collect();
        assert!(inner.len() > 40, "{}", inner.len());
        let difference = |i: usize| (found.answers.deviations_at(i)[case] - self.deviations[i] * sign).norm();
        inner.into_iter().map(difference).fold(0.0, f64::max) / largest
    }
}

const START_S: f64 = 1.2345;
const MEASURED: &str = "[analysis.program.measured]\nfile = \"record.csv\"\nrapid_mm_per_min = 6000\n";
const AIR: &str = "air_s = [[0, 1], [12, 13]]\n";

/// A number without pattern from -1 to 1.
fn wild(k: usize, axis: f64) -> f64 {
    2.0 * ((k as f64 * 12.9898 + axis).sin() * 43_758.545_3).fract().abs() - 1.0
}

fn wild_vector(k: usize) -> Vector3<f64> {
    Vector3::new(wild(k, 0.1), wild(k, 0.7), wild(k, 1.9))
}

/// Force constant between points, on a line between samples: what is left is rounding of seven decimals.
const EXACT: f64 = 1e-6;

#[test]
fn the_force_of_the_cut_as_a_drifting_record_deviates_as_the_cut() {
    let witness = Witness::new();
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 30_f64.to_radians());
    // A sensor under the part, turned by 30 deg, with 5 N of drift that grows.
    let record = witness.record((13.0, 1000.0, START_S), |force, time, _| {
        turn.inverse() * -force + Vector3::new(5.0, -3.0, 1.0) + Vector3::new(0.5, 0.2, -0.7) * time
    });
    let keys = format!(
        "{MEASURED}{AIR}acts_on = \"part\"\nframe = \"base\"\nsensor_turned_deg = 30\nstart_s = {START_S}\n"
    );
    let ran = study(&keys, &record).unwrap();
    let (analysis, found) = program(&ran);
    let differs = witness.differs(&found, 0, 0.002, 1.0);
    assert!(differs < EXACT, "{differs}");
    let (_, measured) = reported(&ran);
    assert!((measured.start_s - START_S).abs() < 1e-12 && (measured.end_s - START_S - CUTS_S).abs() < 1e-9);
    // 10.5 s at 1 kHz.
    assert!(
        measured.samples_used.abs_diff(10_500) <= 1,
        "{}",
        measured.samples_used
    );
    let largest = witness.forces.iter().map(Vector3::norm).fold(0.0, f64::max);
    assert!((measured.largest_n - largest).abs() < 1e-3 * largest);
    // Given on the tool in base axes: those of the sensor, rotated and with the other sign.
    let rate = Vector3::from(measured.drift.unwrap().rate_n_per_s);
    assert!(
        (rate + turn * Vector3::new(0.5, 0.2, -0.7)).norm() < 1e-5,
        "{rate}"
    );
    assert!(analysis.cut.is_none() && analysis.forces.is_none());
}

#[test]
fn a_prediction_finds_a_noisy_record_to_a_sample() {
    let witness = Witness::new();
    let largest = witness.forces.iter().map(Vector3::norm).fold(0.0, f64::max);
    let noise = 0.2 * largest;
    let record = witness.record((20.0, 1000.0, 5.4321), |force, time, k| {
        force + wild_vector(k) * noise + Vector3::new(3.0, 2.0, 1.0) + Vector3::x() * (0.1 * time)
    });
    let keys = format!(
        "{MEASURED}air_s = [[0, 5], [17, 20]]\nacts_on = \"tool\"\nframe = \"base\"\nsynchronise = \"predicted\"\nlow_pass_hz = 10\n"
    );
    let ran = study(&keys, &record).unwrap();
    let (answer, measured) = reported(&ran);
    assert!((measured.start_s - 5.4321).abs() < 1e-3, "{}", measured.start_s);
    assert!(
        measured.likeness.unwrap() > 0.9 && measured.confidence.unwrap() > 0.3,
        "{measured:?}"
    );
    assert!(
        !answer
            .warnings
            .iter()
            .any(|warning| warning.contains("is uncertain"))
    );
    // Of noise of 0.2 of the force (all components together) the filter leaves sqrt(2 x 10 / 1000), here three times
    // that; the arm is up to twice as soft across the force as along it. The filter remembers some tenths of a second.
    let differs = witness.differs(&program(&ran).1, 0, 0.15, 1.0);
    assert!(differs < 2.0 * 3.0 * 0.2 * (0.02_f64).sqrt(), "{differs}");
}

#[test]
fn the_first_crossing_of_a_threshold_is_the_begin() {
    let witness = Witness::new();
    let record = witness.record((13.0, 1000.0, START_S), |force, _, _| force);
    let keys = format!(
        "{MEASURED}drift = false\nacts_on = \"tool\"\nframe = \"base\"\nsynchronise = \"threshold\"\nthreshold_n = 1\n"
    );
    let ran = study(&keys, &record).unwrap();
    let (_, measured) = reported(&ran);
    assert!(
        (measured.start_s - START_S).abs() < 1e-3 && measured.drift.is_none(),
        "{measured:?}"
    );
    assert!(measured.confidence.is_none() && measured.synchronised == "threshold");
}

#[test]
fn the_same_force_may_be_given_in_base_part_or_feed() {
    let witness = Witness::new();
    let start = format!("start_s = {START_S}\ndrift = false\nacts_on = \"tool\"\n");
    let feed = |force: Vector3<f64>, time: f64, _: usize| {
        let index = witness.at(time).map_or(0, |(i, _)| i);
        witness.feeds[index].inverse() * force
    };
    let in_part = witness.record((13.0, 1000.0, START_S), |force, _, _| {
        witness.part.inverse() * force
    });
    let in_feed = witness.record((13.0, 1000.0, START_S), feed);
    for (frame, record) in [("part", in_part), ("feed", in_feed)] {
        let ran = study(&format!("{MEASURED}{start}frame = \"{frame}\"\n"), &record).unwrap();
        let differs = witness.differs(&program(&ran).1, 0, 0.002, 1.0);
        assert!(differs < EXACT, "{frame}: {differs}");
    }
}

#[test]
fn a_force_on_the_part_deviates_in_the_opposite_direction() {
    let witness = Witness::new();
    let record = witness.record((13.0, 1000.0, START_S), |force, _, _| force);
    let keys =
        format!("{MEASURED}start_s = {START_S}\ndrift = false\nacts_on = \"part\"\nframe = \"base\"\n");
    let ran = study(&keys, &record).unwrap();
    let differs = witness.differs(&program(&ran).1, 0, 0.002, -1.0);
    assert!(differs < EXACT, "{differs}");
}

#[test]
fn kilonewtons_and_an_export_with_tabs_are_the_same_force() {
    let witness = Witness::new();
    let record = witness.record((13.0, 1000.0, START_S), |force, _, _| force * 1e-3);
    let export = record
        .replace(
            "time_s,fx_n,fy_n,fz_n\n",
            "Date:,today\nTime\tFx\tFy\tFz\ns\tkN\tkN\tkN\n",
        )
        .replace(',', "\t");
    let record = record.replace("_n,", "_kn,").replace("fz_n", "fz_kn");
    let keys =
        format!("{MEASURED}start_s = {START_S}\ndrift = false\nacts_on = \"tool\"\nframe = \"base\"\n");
    for (text, format) in [(record, "CSV"), (export, "DynoWare")] {
        let ran = study(&keys, &text).unwrap();
        assert_eq!(reported(&ran).1.format, format);
        // Seven decimals of kN: a thousandth of what is left otherwise.
        let differs = witness.differs(&program(&ran).1, 0, 0.002, 1.0);
        assert!(differs < 1e3 * EXACT, "{differs}");
    }
}

#[test]
fn tooth_passing_leaves_the_mean_of_a_revolution_and_determines_its_extreme() {
    let witness = Witness::new();
    // Two teeth a turn at 9000 rpm: the force swings by half of itself, 20 samples a turn.
    let swing = |time: f64| 1.0 + 0.5 * (2.0 * TAU * 150.0 * time).sin();
    let record = witness.record((13.0, 3000.0, START_S), |force, time, _| force * swing(time));
    let keys = format!(
        "{MEASURED}start_s = {START_S}\ndrift = false\nacts_on = \"tool\"\nframe = \"base\"\nspindle_rpm = 9000\npeak = true\nu_percent = 20\n"
    );
    let ran = study(&keys, &record).unwrap();
    let (analysis, found) = program(&ran);
    assert_eq!(found.answers.case_count, 2);
    // A turn takes 6.7 ms; two waves of ten samples each have no mean.
    let differs = witness.differs(&found, 0, 0.02, 1.0);
    assert!(differs < 1e-3, "{differs}");
    // The highest of ten samples is within 18 deg of the crest: 1.5 down to 1.475.
    // Away from the corner at point 40 and the rapid behind point 60.
    for i in (5..35).chain(45..57).chain(65..78) {
        let ratio = found.answers.deviations_at(i)[1].norm() / witness.deviations[i].norm();
        assert!((1.45..1.51).contains(&ratio), "{i}: {ratio}");
    }
    assert!((analysis.setting.uncertainty.relative - 0.2).abs() < 1e-15);
    let (answer, measured) = reported(&ran);
    let (mean, most) = (measured.largest_n, measured.largest_peak_n.unwrap());
    assert!((1.4..1.51).contains(&(most / mean)), "{mean} {most}");
    let worst = answer.paths[0].worst.as_ref().unwrap();
    assert!(worst.worst_case == 2 && worst.in_plane_u_um.unwrap() >= 0.2 * worst.in_plane_um);
}

#[test]
fn a_cut_that_fits_twice_is_warned_of() {
    let witness = Witness::new();
    let once = "G21 G90 G17\nS9000 M3\nG0 X0 Y0 Z10\nG0 Z0\nG1 X40 F600\nG0 Z10\nM2\n";
    let constant = witness.forces[20];
    let twice = witness.record((20.0, 1000.0, 0.0), |_, time, _| {
        let cutting = (3.0..7.0).contains(&time) || (12.0..16.0).contains(&time);
        constant * f64::from(cutting)
    });
    let keys = format!(
        "{MEASURED}drift = false\nacts_on = \"tool\"\nframe = \"base\"\nsynchronise = \"predicted\"\n"
    );
    let ran = study_of(once, &keys, &twice).unwrap();
    let (answer, measured) = reported(&ran);
    assert!(measured.confidence.unwrap() < 0.05, "{measured:?}");
    assert!(
        answer
            .warnings
            .iter()
            .any(|warning| warning.contains("is uncertain") && warning.contains("start_s")),
        "{:?}",
        answer.warnings
    );
}

#[test]
fn errors_are_reported_at_their_positions() {
    let witness = Witness::new();
    let good = witness.record((13.0, 100.0, START_S), |force, _, _| force);
    let short = witness.record((8.0, 100.0, 0.5), |force, _, _| force);
    let base = format!("{MEASURED}drift = false\n");
    let axes = "acts_on = \"tool\"\nframe = \"base\"\n";
    let start = "start_s = 1.2\n";
    for (keys, record, words) in [
        (
            format!("{base}frame = \"base\"\n{start}"),
            &good,
            &["acts_on"][..],
        ),
        (format!("{base}acts_on = \"tool\"\n{start}"), &good, &["frame"]),
        (
            format!("{base}{axes}{start}").replace("record.csv", "none.csv"),
            &good,
            &["cannot read", "none.csv", "study.toml:"],
        ),
        (
            format!("{base}{axes}{start}"),
            &good.replace("fz_n", "fz"),
            &["record.csv:1:1", "missing columns: `Fz`"],
        ),
        (
            format!("{base}{axes}{start}"),
            &short,
            &["the record lasts 7.990 s", "take 10.500 s", "study.toml:"],
        ),
        (
            format!("{base}{axes}start_s = 4\n"),
            &good,
            &["from 4.000 to 14.500 s"],
        ),
        (
            format!("{base}{axes}"),
            &good,
            &["start of the program in the record is not given", "synchronise"],
        ),
        (
            format!("{base}{axes}{start}synchronise = \"threshold\"\n"),
            &good,
            &["either `start_s` or"],
        ),
        (
            format!("{base}{axes}synchronise = \"threshold\"\n"),
            &good,
            &["no", "threshold_n = 10"],
        ),
        (
            format!("{base}{axes}synchronise = \"threshold\"\nthreshold_n = 1e6\n"),
            &good,
            &["never crosses"],
        ),
        (
            format!("{base}{axes}{start}").replace("rapid_mm_per_min = 6000", ""),
            &good,
            &["the rapid of 50.0 mm", "line 10", "rapid_mm_per_min = 6000"],
        ),
        (
            format!("{base}{axes}{start}peak = true\n"),
            &good,
            &["spindle_rpm = 9000"],
        ),
        (
            format!("{base}{axes}{start}spindle_rpm = 9000\n"),
            &good,
            &["a revolution has 0.7 samples"],
        ),
        (
            format!("{base}{axes}{start}low_pass_hz = 60\n"),
            &good,
            &["cutoff of 60 Hz", "below half"],
        ),
        (format!("{base}{axes}{start}{AIR}"), &good, &["drift = false"]),
        (
            format!("{MEASURED}{axes}{start}air_s = [[20, 21]]\n"),
            &good,
            &["0 samples", "from 0 to"],
        ),
        (
            format!("{base}{axes}{start}cycle = 2\n"),
            &good,
            &["has 1 cycles, but no cycle 2"],
        ),
        (
            format!("{base}{axes}{start}\n[analysis.load]\ncases_n = [[1, 2, 3]]\n"),
            &good,
            &["a load and measured forces"],
        ),
    ] {
        let message = study(&keys, record).map(|_| ()).unwrap_err();
        for word in words {
            assert!(message.contains(word), "no `{word}` in\n{message}");
        }
    }
}

#[test]
fn a_prediction_needs_its_cut_and_a_program_its_feed() {
    let folder = tempfile::tempdir().unwrap();
    let silent = "x_mm,y_mm,z_mm\n0,0,0\n40,0,0\n40,20,0\n";
    fs::write(folder.path().join("part.csv"), silent).unwrap();
    let witness = Witness::new();
    let good = witness.record((13.0, 100.0, START_S), |force, _, _| force);
    fs::write(folder.path().join("record.csv"), good).unwrap();
    let analysis = "\n[[analysis]]\nkind = \"path\"\n[analysis.program]\nfile = \"part.csv\"\n";
    let axes = "drift = false\nacts_on = \"tool\"\nframe = \"base\"\n";
    let reported = |last: &str| {
        let text = format!("{CELL}{analysis}{MEASURED}{axes}{last}\n");
        let read = read("study.toml", folder.path(), text.as_bytes());
        read.map(|_| ()).map_err(|error| error.to_string())
    };
    let message = reported("synchronise = \"predicted\"\nfeed_mm_per_min = 600").unwrap_err();
    assert!(message.contains("requires a `cut`"), "{message}");
    let message = reported("start_s = 1").unwrap_err();
    assert!(
        message.contains("feed") && message.contains("feed_mm_per_min = 600"),
        "{message}"
    );
    // 60 mm at 10 mm/s: the record is long enough.
    assert_eq!(reported("start_s = 1\nfeed_mm_per_min = 600"), Ok(()));
}
