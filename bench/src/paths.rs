//! Rows of tool path programs: a program read, and the deviation along it.
//!
//! | work | in | out |
//! |---|---|---|
//! | [`READ_GCODE`], [`READ_APT`], [`READ_CSV`] | text of short straight cuts | its steps, one by one |
//! | [`ALONG`] | points, a load case in the feed frame | joint angles, flags and deviation at each |
//! | [`ALONG_CUT`] | points, cutting conditions | cutting force and the same at each |
//!
//! One thread. The path is a zigzag on the plane of the workload: lines of 400 points, a millimetre apart, that rise
//! and fall a little. Rates count points.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::hint::black_box;

use armill_core::frame::Isometry;
use armill_core::kernel::Question;
use armill_core::load::{Cutter, CuttingLaw, Hand, Immersion, LoadCases, LoadFrame, Mechanistic, PathLoad};
use armill_core::map::along_path;
use armill_core::nalgebra::{Matrix3, Point3, Rotation3, Unit, UnitQuaternion, Vector3};
use armill_core::path::{Cutting, GreatestForce, Pace, PathPoint, Placing, SampledPath, Spin, Step, Track};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use armill_formats::toolpath::{apt, csv, gcode};

use crate::armill::{Arm, ONE_POSTURE};
use crate::clock::Candidate;

/// G-code read.
pub const READ_GCODE: &str = "G-code read";
/// Cutter locations read.
pub const READ_APT: &str = "APT read";
/// A path as a table read.
pub const READ_CSV: &str = "CSV path read";
/// Deviation along a path under a load case.
pub const ALONG: &str = "along a path";
/// Deviation along a path under cutting forces.
pub const ALONG_CUT: &str = "along a path, cutting forces";

/// Points of the path.
const POINTS: usize = 200_000;
/// Points of a line of the zigzag.
const LINE: usize = 400;
/// From point to point, and from line to line, mm.
const PITCH_MM: [f64; 2] = [1.0, 0.5];
/// Feed, m/s.
const FEED: f64 = 0.02;

/// A path and its programs.
pub struct Paths {
    gcode: String,
    apt: String,
    csv: String,
    points: Vec<PathPoint>,
}

impl Paths {
    /// The zigzag of the workload.
    pub fn zigzag() -> Paths {
        let mut gcode = String::from("G21 G90 G94\nG0 X-200 Y-125 Z5\nF1200\n");
        let mut apt =
            String::from("UNIT/MM\nSPINDL/6000,RPM,CLW\nRAPID\nGOTO/-200,-125,5\nFEDRAT/1200,MMPM\n");
        let mut csv = String::from("x_mm,y_mm,z_mm,feed_mm_per_min\n");
        let mut points = Vec::with_capacity(POINTS);
        let mut before = place(0);
        for k in 0..POINTS {
            let at = place(k);
            let [x, y, z] = [at.x, at.y, at.z];
            // A string takes whatever is written.
            let _ = writeln!(gcode, "G1 X{x:.4} Y{y:.4} Z{z:.4}");
            let _ = writeln!(apt, "GOTO/{x:.4},{y:.4},{z:.4}");
            let _ = writeln!(csv, "{x:.4},{y:.4},{z:.4},1200");
            points.push(PathPoint {
                at: at * 1e-3,
                axis: None,
                normal: None,
                spin: None,
                direction: Unit::try_new(at - before, 0.0).unwrap_or(Vector3::x_axis()),
                along: k as f64 * 1e-3,
                pace: Pace::Feed(FEED),
                line: k as u32 + 1,
            });
            before = at;
        }
        Paths {
            gcode,
            apt,
            csv,
            points,
        }
    }

    /// A track of it before the arm.
    fn track(&self) -> Track {
        Track {
            path: SampledPath {
                points: self.points.clone(),
                ..SampledPath::default()
            },
            placing: placing(),
            base_from_part: placing().base_from_path,
            spins: None,
            homes: None,
        }
    }
}

/// Point `k` of the zigzag, mm.
fn place(k: usize) -> Point3<f64> {
    let (line, along) = (k / LINE, k % LINE);
    let along = if line.is_multiple_of(2) {
        along
    } else {
        LINE - 1 - along
    };
    Point3::new(
        PITCH_MM[0] * along as f64 - 200.0,
        PITCH_MM[1] * line as f64 - 125.0,
        -1.0 - (0.05 * k as f64).sin(),
    )
}

/// The path on the plane of the workload, its z towards the robot.
fn placing() -> Placing {
    let axes = Matrix3::from_columns(&[Vector3::y(), -Vector3::z(), -Vector3::x()]);
    let turned = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    Placing {
        base_from_path: Isometry::from_parts(Vector3::new(1.0, 0.0, 0.8).into(), turned),
        axis: Vector3::z_axis(),
        keeps_axis: false,
        spin: Spin::Fixed(0.0),
    }
}

/// A flat end mill in aluminium, coefficients of Altintas as in the tests of the force law.
fn cutting() -> Cutting {
    let shear = Vector3::new(1930.4e6, 1159.6e6, 200.6e6);
    let law = Mechanistic::new(shear, Vector3::zeros()).expect("coefficients of a metal");
    let cutter =
        Cutter::flat(16e-3, 4).and_then(|cutter| cutter.with_helix(45_f64.to_radians(), Hand::Right));
    Cutting {
        cutter: cutter.expect("an end mill of a catalogue"),
        law: CuttingLaw::Mechanistic(law),
        depth: 1e-3,
        immersion: Immersion::Up(5e-3),
        feed: None,
        spindle: Some(6000.0 * TAU / 60.0),
        greatest: GreatestForce::LeftOut,
    }
}

/// Every row.
pub fn candidates<'a>(arm: &'a Arm, paths: &'a Paths) -> Vec<Candidate<'a>> {
    let mut all = readers(paths);
    all.extend(predictions(arm, paths));
    all
}

fn readers(paths: &Paths) -> Vec<Candidate<'_>> {
    const WHO: &str = "armill, tool path program";
    let mut take = |step: Step| {
        black_box(&step);
    };
    let of_gcode = move || {
        let requested = gcode::GcodeReadOptions::default();
        let read = gcode::read("part.ngc", paths.gcode.as_bytes(), &requested, &mut take);
        assert_eq!(read.expect("what was written here").cuts, POINTS as u64);
    };
    let of_apt = move || {
        let requested = apt::AptReadOptions {
            unit: None,
            dialect: None,
        };
        let read = apt::read("part.apt", paths.apt.as_bytes(), &requested, &mut take);
        black_box(read.expect("what was written here"));
    };
    let of_csv = move || {
        let read = csv::read("part.csv", paths.csv.as_bytes(), &mut take);
        black_box(read.expect("what was written here"));
    };
    vec![
        Candidate::new(WHO, READ_GCODE, POINTS, of_gcode).note("G1 with three coordinates a line"),
        Candidate::new(WHO, READ_APT, POINTS, of_apt).note("GOTO with three coordinates a line"),
        Candidate::new(WHO, READ_CSV, POINTS, of_csv).note("three coordinates and feed a row"),
    ]
}

fn predictions<'a>(arm: &'a Arm, paths: &'a Paths) -> Vec<Candidate<'a>> {
    const WHO: &str = "armill along_path";
    let push = Wrench::from_force(Vector3::new(-150.0, 36.0, 14.0));
    let load = PathLoad::Cases(LoadCases {
        frame: LoadFrame::Feed,
        cases: vec![push],
    });
    let track = paths.track();
    let of_cut = track.clone();
    let question = Question {
        cases: &[],
        ..arm.question(ONE_POSTURE)
    };
    let along = move || {
        let answer = along_path(&question, &track, load.clone(), Watch::NONE).expect("not cancelled");
        assert_eq!(answer.answers.evaluations().count(), POINTS);
        black_box(answer);
    };
    let cutting = cutting();
    let along_cut = move || {
        let forces = cutting.along(&of_cut.path, &of_cut.placing, None, Watch::NONE);
        let load = PathLoad::Cuts(forces.expect("feed and spindle are given").cuts);
        black_box(along_path(&question, &of_cut, load, Watch::NONE)).ok();
    };
    vec![
        Candidate::new(WHO, ALONG, POINTS, along).note("MH12, one load case in the feed frame, one posture"),
        Candidate::new(WHO, ALONG_CUT, POINTS, along_cut)
            .note("the same under the mean force of a flat end mill, mechanistic, at rest with the tool"),
    ]
}
