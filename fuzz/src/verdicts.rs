//! Requirements on every input: no panic, a message for every refusal, and finite numbers.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use armill_core::frame::Isometry;
use armill_core::load::ActsOn;
use armill_core::measure::ballbar::{Direction, Run};
use armill_core::nalgebra::Vector3;
use armill_core::path::{Command, Course, GivenSpin, Pace, Step};
use armill_core::robot::Robot;
use armill_core::robot::inverse::posture_at;
use armill_core::roundness::{Plane, Profile};
use armill_formats::convention::Convention;
use armill_formats::document::Problems;
use armill_formats::material;
use armill_formats::measurement::ballbar;
use armill_formats::measurement::format::{self as forces, ForceRecords};
use armill_formats::measurement::{csv as force_csv, dynoware, load_tests as tests, profile};
use armill_formats::robot::format::{self, Format, RobotReadOptions};
use armill_formats::robot::pendant;
use armill_formats::robot::{RobotDescription, armill};
use armill_formats::toolpath::format as program;
use armill_formats::toolpath::{LengthUnit, Summary, apt, csv, gcode};
use armill_programs::{
    Motion, Moved, ProgramText, RobotProgram, Target, inform, krl, rapid, tp, urscript, val3,
};
use armill_study::file::resolve;
use armill_study::{ErrorKind, library};

/// A folder that does not contain the files that an input names.
const NOWHERE: &str = "/nowhere";
/// Joint position at which robots are compared, rad or m: not a special posture of any arm.
const SOMEWHERE: f64 = 0.1;
/// Two poses of the same robot, read and written and read again: the chain is multiplied up again, and every product
/// rounds once.
const SAME: f64 = 1e-9;
/// The lengths of a robot may differ by this many powers of ten before rounding hides the small ones.
const LARGEST_M: f64 = 1e6;

/// A study file, read and checked.
pub fn study(bytes: &[u8]) {
    if let Err(error) = resolve::read("study.toml", Path::new(NOWHERE), bytes) {
        assert_eq!(error.kind(), ErrorKind::InvalidInput, "{error}");
        assert!(!error.to_string().trim().is_empty());
    }
}

/// Our own robot file.
pub fn armill(bytes: &[u8]) {
    check_ours(read_as(bytes, Path::new("arm.toml"), Format::Armill));
}

/// URDF.
pub fn urdf(bytes: &[u8]) {
    check_foreign(read_as(bytes, Path::new("arm.urdf"), Format::Urdf));
}

/// xacro.
pub fn xacro(bytes: &[u8]) {
    check_foreign(read_as(
        bytes,
        &Path::new(NOWHERE).join("arm.xacro"),
        Format::Xacro,
    ));
}

/// OPW parameters.
pub fn opw(bytes: &[u8]) {
    check_foreign(read_as(bytes, Path::new("arm.yaml"), Format::Opw));
}

/// A calibration file of Universal Robots.
pub fn ur(bytes: &[u8]) {
    check_foreign(read_as(bytes, Path::new("arm.yaml"), Format::Ur));
}

/// A Denavit-Hartenberg table.
pub fn dh(bytes: &[u8]) {
    check_foreign(read_as(bytes, Path::new("arm.dh"), Format::Dh));
}

/// A chain of elementary motions.
pub fn chain(bytes: &[u8]) {
    check_foreign(read_as(bytes, Path::new("arm.chain"), Format::Chain));
}

/// A file whose format is to be detected: its ending on the first line, its content after that.
pub fn format(bytes: &[u8]) {
    let end = bytes
        .iter()
        .position(|byte| *byte == b'\n')
        .unwrap_or(bytes.len());
    let (ending, content) = bytes.split_at(end);
    let ending = String::from_utf8_lossy(ending).replace(['/', '\\', '\0'], "");
    let path = PathBuf::from(format!("{NOWHERE}/arm.{ending}"));
    let content = content.get(1..).unwrap_or_default();
    let read = format::read(&path, "arm", content, &RobotReadOptions::default());
    match Format::of(&path, "") {
        Some(Format::Armill) => check_ours(read),
        _ => check_foreign(read),
    }
}

/// A table of load tests.
pub fn load_tests(bytes: &[u8]) {
    static ROBOT: OnceLock<Robot> = OnceLock::new();
    let robot = ROBOT.get_or_init(|| {
        let found = library::robot("yaskawa/mh12").expect("it is in the library");
        found.expect("every robot of the library reads").robot
    });
    match tests::read("tests.csv", bytes, robot, Vector3::new(0.0, 0.0, 0.1)) {
        Err(problems) => refused(&problems),
        Ok(found) => {
            assert_eq!(found.tests.len(), found.names.len());
            for test in &found.tests {
                let readings = test.readings.iter();
                assert!(test.joints.iter().all(|value| value.is_finite()));
                assert!(readings.clone().all(|reading| reading.value.is_finite()));
                let mut uncertainties = readings.clone().map(|reading| reading.standard_uncertainty);
                assert!(uncertainties.all(|u| u > 0.0 && u.is_finite()));
            }
        }
    }
}

/// A reading of a pendant, in the convention of every maker.
pub fn pendant(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    for convention in Convention::ALL {
        match pendant::reading(&text, convention) {
            Err(error) => assert!(!error.to_string().trim().is_empty()),
            Ok((joints, pose)) => {
                assert!(joints.iter().all(|value| value.is_finite()));
                assert!(pose.to_homogeneous().iter().all(|value| value.is_finite()));
            }
        }
    }
}

/// Endless loops end soon enough to try others.
const MOST_REPEATED_LINES: usize = 20_000;

/// G-code of a machine with a tilting table.
pub fn gcode(bytes: &[u8]) {
    let requested = gcode::GcodeReadOptions {
        rotaries: Some(gcode::Rotaries::table_ac()),
        most_repeated_lines: Some(MOST_REPEATED_LINES),
        ..gcode::GcodeReadOptions::default()
    };
    check_program(gcode::read("part.ngc", bytes, &requested, &mut check_step));
}

/// A tool table, in the unit of the machine.
pub fn tool_table(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    match gcode::ToolTable::read("tool.tbl", &text, LengthUnit::Inch) {
        Err(problems) => refused(&problems),
        Ok(table) => {
            for (number, tool) in &table.tools {
                let lengths = tool.offset.iter().chain([&tool.diameter]);
                assert!(lengths.into_iter().all(|value| value.is_finite()), "T{number}");
                assert!(tool.orientation <= 9, "T{number}");
            }
        }
    }
}

/// Cutter locations.
pub fn apt(bytes: &[u8]) {
    let requested = apt::AptReadOptions {
        unit: Some(LengthUnit::Millimetre),
        dialect: None,
    };
    check_program(apt::read("part.apt", bytes, &requested, &mut check_step));
}

/// A path as a table.
pub fn path_csv(bytes: &[u8]) {
    check_program(csv::read("path.csv", bytes, &mut check_step));
}

/// A tool path program whose format is to be detected.
pub fn program(bytes: &[u8]) {
    let requested = program::ToolpathReadOptions {
        most_repeated_lines: Some(MOST_REPEATED_LINES),
        ..program::ToolpathReadOptions::default()
    };
    check_program(program::read("part", bytes, &requested, &mut check_step));
}

/// Half of the last digit that controllers keep, m and rad, in every direction, with angles that add up.
const KEPT: [f64; 2] = [1e-6, 5e-5];

/// A robot program in every language, its files separated by a zero byte: the numbers read are finite, and, written
/// again with its poses, it reads the same.
pub fn robot_program(bytes: &[u8]) {
    let readers = [
        krl::read,
        rapid::read,
        inform::read,
        tp::read,
        urscript::read,
        val3::read,
    ];
    for read in readers {
        let files = bytes.split(|byte| *byte == 0).enumerate();
        let texts = files.map(|(index, bytes)| ProgramText::new(&format!("a{index}"), bytes));
        let program = match read(texts.collect()) {
            Err(problems) => {
                refused(&problems);
                continue;
            }
            Ok(program) => program,
        };
        let moved = as_they_are(&program);
        // Moves to one target may go to different places, where they omit what the move before specified.
        let Ok(files) = program.with_poses(&moved) else {
            continue;
        };
        let texts = files.iter().map(|(name, bytes)| ProgramText::new(name, bytes));
        let again = read(texts.collect()).unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(program.moves.len(), again.moves.len());
        for one in &moved {
            let found = again.moves[one.index].target.pose().expect("a pose stays one");
            let apart = (found.translation.vector - one.target.translation.vector).amax();
            let matrix = |pose: &Isometry| *pose.rotation.to_rotation_matrix().matrix();
            let turned = (matrix(found) - matrix(&one.target)).amax();
            let far = one.target.translation.vector.amax() * 1e-12;
            assert!(apart < KEPT[0] + far && turned < KEPT[1], "{apart} {turned}");
        }
    }
}

/// Every pose of the program, where it is.
fn as_they_are(program: &RobotProgram) -> Vec<Moved> {
    let mut all = Vec::new();
    for (index, of) in program.moves.iter().enumerate() {
        let via = match &of.motion {
            Motion::Circular { via } => via.pose().copied(),
            Motion::Joint | Motion::Linear => None,
        };
        if let Target::Joints(joints) = &of.target {
            assert!(joints.iter().all(|value| value.is_finite()));
        }
        if let Some(pose) = of.target.pose() {
            assert!(pose.to_homogeneous().iter().all(|value| value.is_finite()));
            all.push(Moved {
                index,
                target: *pose,
                via,
            });
        }
    }
    all
}

/// A program is refused with a reason, or summarised.
fn check_program(read: Result<Summary, Problems>) {
    match read {
        Err(problems) => refused(&problems),
        Ok(summary) => {
            assert!(
                summary.moves >= summary.cuts && summary.moves >= summary.arcs,
                "{summary:?}"
            );
            assert!(summary.notes.iter().all(|note| !note.trim().is_empty()));
        }
    }
}

/// A step of a program contains finite numbers, directions, and arcs that turn.
fn check_step(step: Step) {
    let next = match step {
        Step::Move(next) => next,
        Step::Operation(operation) => {
            let depths = operation.depths.map(|depths| [depths.axial, depths.radial]);
            let lengths = [operation.diameter, operation.corner_radius, operation.spindle];
            let mut numbers = lengths.into_iter().flatten().chain(depths.into_iter().flatten());
            assert!(numbers.all(f64::is_finite), "{operation:?}");
            return;
        }
        Step::Command(command) => {
            let rests = |seconds: f64| seconds.is_finite() && seconds >= 0.0;
            assert!(
                !matches!(command, Command::Dwell(seconds) if !rests(seconds)),
                "{command:?}"
            );
            return;
        }
    };
    assert!(next.end.iter().all(|value| value.is_finite()), "{next:?}");
    let spin = next.spin.map(|spin| match spin {
        GivenSpin::Angle(angle) => angle,
        GivenSpin::Orientation(turned) => turned.coords.sum(),
    });
    assert!(spin.is_none_or(f64::is_finite), "{next:?}");
    // A direction is normalised once and turned a few times.
    assert!(
        next.axis.is_none_or(|axis| (axis.norm() - 1.0).abs() < 1e-9),
        "{next:?}"
    );
    if let Course::Arc(arc) = next.course {
        assert!(arc.centre.iter().all(|value| value.is_finite()), "{next:?}");
        assert!(arc.sweep.is_finite() && arc.sweep > 0.0, "{next:?}");
    }
    if let Pace::Feed(speed) = next.pace {
        assert!(speed.is_finite() && speed > 0.0, "{next:?}");
    }
}

/// Forces as DynoWare exports them.
pub fn dynoware(bytes: &[u8]) {
    check_forces(dynoware::read(
        "cut.txt",
        bytes,
        ActsOn::Part,
        &forces::ForceReadOptions::default(),
    ));
}

/// Forces as a table, with a column of time and without.
pub fn force_csv(bytes: &[u8]) {
    for rate_hz in [None, Some(1e4)] {
        let requested = forces::ForceReadOptions {
            rate_hz,
            ..forces::ForceReadOptions::default()
        };
        check_forces(force_csv::read("cut.csv", bytes, ActsOn::Tool, &requested));
    }
}

/// Forces in a format that is to be detected.
pub fn forces(bytes: &[u8]) {
    check_forces(forces::read(
        "cut",
        bytes,
        ActsOn::Tool,
        &forces::ForceReadOptions::default(),
    ));
}

/// Points of a profile, with and without what a file does not state; what can be read is evaluated too.
pub fn profile(bytes: &[u8]) {
    let plain = profile::ProfileReadOptions {
        unit: Some(profile::LengthUnit::Millimetre),
        ..profile::ProfileReadOptions::default()
    };
    let by_deviation = profile::ProfileReadOptions {
        radius_mm: Some(25.0),
        ..profile::ProfileReadOptions::default()
    };
    for requested in [profile::ProfileReadOptions::default(), plain, by_deviation] {
        let found = match profile::read("bore", bytes, &requested) {
            Err(problems) => {
                refused(&problems);
                continue;
            }
            Ok(found) => found,
        };
        assert_eq!(found.points.count(), found.lines.len());
        assert!(found.lines.is_sorted_by(|before, after| before < after));
        let points = match found.points {
            profile::Points::Plane(points) => points,
            profile::Points::Space(points) => match Plane::nearest(&points) {
                Some(plane) => points.iter().map(|point| plane.seen(point)).collect(),
                None => continue,
            },
        };
        assert!(points.iter().all(|p| p.x.is_finite() && p.y.is_finite()));
        if let Ok(round) = Profile::new(points) {
            let circle = round.minimum_circumscribed();
            assert!(
                circle.radius.is_finite() && circle.peak_to_valley.is_finite(),
                "{circle:?}"
            );
        }
    }
}

/// Records contain finite numbers, and their time increases.
fn check_forces(read: Result<ForceRecords, Problems>) {
    let found = match read {
        Err(problems) => return refused(&problems),
        Ok(found) => found,
    };
    assert!(!found.records.is_empty());
    for record in &found.records {
        assert!(record.time().is_sorted_by(|before, after| before < after));
        let samples = record.force().iter().chain(record.moment().into_iter().flatten());
        assert!(samples.flatten().all(|value| value.is_finite()));
    }
}

/// Runs of a circular test: angles and radii are numbers.
pub fn ballbar_csv(bytes: &[u8]) {
    for start in [None, Some(0.0)] {
        let given = ballbar::BallbarReadOptions {
            direction: start.map(|_| Direction::Clockwise),
            start,
            radius: None,
        };
        match ballbar::csv::read("bar.csv", bytes, &given) {
            Err(problems) => refused(&problems),
            Ok(found) => {
                assert_eq!(found.runs.len(), found.names.len());
                let mut samples = found.runs.iter().flat_map(Run::samples);
                assert!(samples.all(|(angle, deviation)| angle.is_finite() && deviation.is_finite()));
            }
        }
    }
}

/// Results of a ball-bar's own program.
pub fn ballbar_results(bytes: &[u8]) {
    match ballbar::b5r::read("bar.b5r", &String::from_utf8_lossy(bytes)) {
        Err(problems) => refused(&problems),
        Ok(found) => assert!(found.features.iter().all(|feature| feature.value.is_finite())),
    }
}

/// A material file.
pub fn material(bytes: &[u8]) {
    match material::read("metal.toml", &String::from_utf8_lossy(bytes)) {
        Err(problems) => refused(&problems),
        Ok(found) => {
            assert!(found.mechanistic().is_none() || !found.mechanistic.is_empty());
            assert_eq!(found.kienzle().is_some(), !found.kienzle.is_empty());
        }
    }
}

fn read_as(bytes: &[u8], path: &Path, format: Format) -> Result<RobotDescription, Problems> {
    let requested = RobotReadOptions {
        format: Some(format),
        tip: None,
    };
    format::read(path, "arm", bytes, &requested)
}

/// A robot of ours can be posed.
fn check_ours(read: Result<RobotDescription, Problems>) {
    match read {
        Err(problems) => refused(&problems),
        Ok(found) => {
            let pose = flange(&found.robot);
            assert!(pose.iter().all(|value| value.is_finite()), "{pose}");
        }
    }
}

/// A robot of another format can be posed, written as ours, and read again as the same.
fn check_foreign(read: Result<RobotDescription, Problems>) {
    let found = match read {
        Err(problems) => return refused(&problems),
        Ok(found) => found,
    };
    let pose = flange(&found.robot);
    assert!(pose.iter().all(|value| value.is_finite()), "{pose}");
    let text = armill::write(&found);
    match armill::read("written.toml", "arm", &text) {
        Err(problems) => panic!("what was written cannot be read: {problems}\n{text}"),
        Ok(again) => {
            let apart = (pose - flange(&again.robot)).norm();
            let near = apart <= SAME * pose.norm() || pose.norm() > LARGEST_M;
            assert!(near, "written and read again it is {apart} apart\n{text}");
        }
    }
}

fn flange(robot: &Robot) -> armill_core::nalgebra::Matrix4<f64> {
    let q = vec![SOMEWHERE; robot.joints().len()];
    posture_at(robot, &q, &Isometry::identity())
        .base_from_tool
        .to_homogeneous()
}

pub(crate) fn refused(problems: &Problems) {
    let all = problems.as_slice();
    assert!(!all.is_empty());
    assert!(all.iter().all(|problem| !problem.message().trim().is_empty()));
    assert!(!problems.to_string().trim().is_empty());
}
