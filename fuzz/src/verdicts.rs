//! What must hold of every input: no panic, a refusal that says something, and numbers that are numbers.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::robot::inverse::posture_at;
use armill_formats::document::Problems;
use armill_formats::robot::format::{self, Format, Wanted};
use armill_formats::robot::pendant::{self, Convention};
use armill_formats::robot::{RobotDescription, armill};
use armill_formats::table::load_tests as tests;
use armill_study::file::resolve;
use armill_study::{ErrorKind, library};

/// Where no file of an input's naming is.
const NOWHERE: &str = "/nowhere";
/// Joint position at which robots are compared, rad or m: no special posture of any arm.
const SOMEWHERE: f64 = 0.1;
/// Two poses of the same robot, read and written and read again: the chain is multiplied up anew, and every product
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
    judge_ours(read_as(bytes, Path::new("arm.toml"), Format::Armill));
}

/// URDF.
pub fn urdf(bytes: &[u8]) {
    judge_foreign(read_as(bytes, Path::new("arm.urdf"), Format::Urdf));
}

/// xacro.
pub fn xacro(bytes: &[u8]) {
    judge_foreign(read_as(
        bytes,
        &Path::new(NOWHERE).join("arm.xacro"),
        Format::Xacro,
    ));
}

/// OPW parameters.
pub fn opw(bytes: &[u8]) {
    judge_foreign(read_as(bytes, Path::new("arm.yaml"), Format::Opw));
}

/// A Denavit-Hartenberg table.
pub fn dh(bytes: &[u8]) {
    judge_foreign(read_as(bytes, Path::new("arm.dh"), Format::Dh));
}

/// A chain of elementary motions.
pub fn chain(bytes: &[u8]) {
    judge_foreign(read_as(bytes, Path::new("arm.chain"), Format::Chain));
}

/// A file whose format is to be found out: its ending on the first line, its content after that.
pub fn format(bytes: &[u8]) {
    let end = bytes
        .iter()
        .position(|byte| *byte == b'\n')
        .unwrap_or(bytes.len());
    let (ending, content) = bytes.split_at(end);
    let ending = String::from_utf8_lossy(ending).replace(['/', '\\', '\0'], "");
    let path = PathBuf::from(format!("{NOWHERE}/arm.{ending}"));
    let content = content.get(1..).unwrap_or_default();
    let read = format::read(&path, "arm", content, &Wanted::default());
    match Format::of(&path, "") {
        Some(Format::Armill) => judge_ours(read),
        _ => judge_foreign(read),
    }
}

/// A table of load tests.
pub fn load_tests(bytes: &[u8]) {
    static ROBOT: OnceLock<Robot> = OnceLock::new();
    let robot = ROBOT.get_or_init(|| {
        let found = library::robot("yaskawa/mh12").expect("it is in the library");
        found.expect("every robot of the library reads").robot
    });
    let text = String::from_utf8_lossy(bytes);
    match tests::read("tests.csv", &text, robot, Vector3::new(0.0, 0.0, 0.1)) {
        Err(problems) => refused(&problems),
        Ok(found) => {
            assert_eq!(found.tests.len(), found.names.len());
            for test in &found.tests {
                let readings = test.readings.iter();
                assert!(test.joints.iter().all(|value| value.is_finite()));
                assert!(readings.clone().all(|reading| reading.value.is_finite()));
                assert!(readings.clone().all(|reading| reading.standard_uncertainty > 0.0));
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

fn read_as(bytes: &[u8], path: &Path, format: Format) -> Result<RobotDescription, Problems> {
    let wanted = Wanted {
        format: Some(format),
        tip: None,
    };
    format::read(path, "arm", bytes, &wanted)
}

/// A robot of ours can be posed.
fn judge_ours(read: Result<RobotDescription, Problems>) {
    match read {
        Err(problems) => refused(&problems),
        Ok(found) => {
            let pose = flange(&found.robot);
            assert!(pose.iter().all(|value| value.is_finite()), "{pose}");
        }
    }
}

/// A robot of another format can be posed, written as ours, and read again as the same.
fn judge_foreign(read: Result<RobotDescription, Problems>) {
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
            assert!(near, "written and read again it stands {apart} apart\n{text}");
        }
    }
}

fn flange(robot: &Robot) -> armill_core::nalgebra::Matrix4<f64> {
    let q = vec![SOMEWHERE; robot.joints().len()];
    posture_at(robot, &q, &Isometry::identity())
        .base_from_tool
        .to_homogeneous()
}

fn refused(problems: &Problems) {
    let all = problems.as_slice();
    assert!(!all.is_empty());
    assert!(all.iter().all(|problem| !problem.message().trim().is_empty()));
    assert!(!problems.to_string().trim().is_empty());
}
