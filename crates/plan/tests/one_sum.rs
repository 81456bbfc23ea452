//! One sum: an arm with every error source at once deviates by the same amount, with the same shares and the same
//! uncertainty, on every surface that reports a point.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;

use armill_core::machined::FollowedPath;
use armill_core::nalgebra::{DMatrix, Vector3};
use armill_core::optimize::Compensation;
use armill_core::robot::{LearntAxes, LearntSettings, ResidualAt, SmallMotion, UncertainGeometry};
use armill_core::watch::Watch;
use armill_formats::robot::armill::{
    self, Geometry, GeometryCovarianceTable, LearntTable, residuals_file, with_geometry, with_residual,
};
use armill_plan::compensate::compensate;
use armill_study::analysis::runner::Runner;
use armill_study::live::{PoseTarget, PostureQuestion, StudyText, answer_json, postures};
use serde_json::Value;

/// What the robot file of an MH12 has in addition: every part that a robot file can have.
const PARTS: &str = r#"
[[spring]]
at = "L"
about = "x"
compliance_rad_per_n_m = 8e-7
compliance_u_rad_per_n_m = 1e-7
source = "test"

[[spring]]
at = "base"
about = "y"
compliance_rad_per_n_m = 5e-8
compliance_u_rad_per_n_m = 1e-8
source = "test"

[[mass]]
at = "U"
mass_kg = 35
centre_mm = [150, 0, 100]
source = "test"

[compensator]
joint = "L"
fixed_radius_mm = 200
arm_radius_mm = 150
free_length_mm = 120
stiffness_n_per_mm = 8
angle_deg = 10
source = "test"

[repeatability]
pose_mm = 0.08
source = "test"

[model_error]
percent = 9.4
source = "test"

[sources.test]
what = "made up"
where = "this test"
licence = "none"
"#;

/// One plane, one point of it, one posture; the tool stands along the normal, so that across the tool is in the plane.
const STUDY: &str = r#"format = 1
robot = "worn.toml"
calibrated_robot = "calibrated.toml"
tolerance_um = 100
repeatability_mm = 0.06
posture = { branch = "front elbow-up no-flip" }
plane = { centre_mm = [950, 50, 750], tilt_deg = 25, half_size_mm = 0.0005, step_mm = 0.001 }
[load]
cases_n = [[60, -35, 20], [-20, 50, 30]]
u_percent = 12
u_n = [3, 3, 3]
[tool]
flange_from_tool_mm_deg = [60, 0, 150, 0, 30, 0]
length_u_mm = 0.2
stick_out_mm = 50
diameter_mm = 10
material = "carbide"
[[tool.mass]]
at = "flange"
mass_kg = 8
centre_mm = [0, 0, 60]
source = "test"
[gravity]
reference_joints_deg = [0, 20, -10, 0, -60, 0]
[thermal]
difference_k = 8
u_k = 2
[[analysis]]
kind = "map"
name = "plate"
[[analysis]]
kind = "sections"
name = "series"
distances_mm = [950]
[[analysis]]
kind = "volume"
name = "box"
box = { half_size_mm = [0.0005, 0.0005, 0.0005], step_mm = 0.001 }
[[analysis]]
kind = "path"
name = "line"
polyline_mm = [[0, 0], [0.001, 0]]
step_mm = 0.001
[[analysis]]
kind = "holes"
name = "hole"
holes = { at_mm = [[0, 0, 0]] }
posture = { branch = "front elbow-up no-flip", search = { turns_deg = [0, 0] } }
"#;

/// A relative difference below which two numbers are the same one: the points are up to 2 um apart.
const SAME: f64 = 1e-5;

/// The worn arm, its calibrated geometry and the study, in a folder.
fn cell() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mh12 = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/yaskawa/mh12.toml");
    let mh12 = std::fs::read_to_string(mh12).unwrap();
    // A torque decides on the side of each backlash, so that a path and a point agree on it.
    let backlash = "compliance_u_source = \"assumed\"\nbacklash_deg = 0.008\nbacklash_u_deg = 0.001\nbacklash_side = \"torque\"\nbacklash_source = \"test\"\n";
    let curve = "torque_curve_n_m_rad = [[-400, -9e-4], [-40, -1.5e-4], [40, 1.5e-4], [400, 9e-4]]\ncompliance_source = \"test\"\n";
    let worn = mh12
        .replace("compliance_u_source = \"assumed\"\n", backlash)
        .replace("compliance_rad_per_n_m = 2.1e-6\ncompliance_u_rad_per_n_m = 4.2e-7\ncompliance_source = \"paper\"\n", curve)
        .replacen("compliance_u_source = \"assumed\"\n", "", 1);
    let worn = worn + PARTS;
    let calibrated = worn.replace("length_mm = 614", "length_mm = 614.4");
    std::fs::write(folder.path().join("worn.toml"), worn).unwrap();
    let (calibrated, residuals) = with_learnt_residual(&with_uncertain_geometry(&calibrated));
    std::fs::write(folder.path().join("calibrated.toml"), calibrated).unwrap();
    std::fs::write(folder.path().join("residuals.csv"), residuals).unwrap();
    folder
}

/// The robot file with a calibration that left its lengths and angles uncertain.
fn with_uncertain_geometry(text: &str) -> String {
    let robot = armill::read("calibrated.toml", "", text).unwrap().robot;
    let motions = [(0, 3), (1, 0), (1, 4), (3, 2)];
    let motions = motions.map(|(after, component)| SmallMotion { after, component });
    let root = DMatrix::from_fn(4, 4, |i, j| 4e-5 * ((3 * i + 2 * j) as f64).cos());
    let covariance = &root * root.transpose() + DMatrix::identity(4, 4) * 1e-10;
    let geometry = UncertainGeometry::new(motions.to_vec(), &covariance).unwrap();
    let calibrated = Geometry {
        after: Vec::new(),
        what: "made up".to_owned(),
        place: "this test".to_owned(),
        covariance: Some(GeometryCovarianceTable::of(&robot, &geometry)),
    };
    with_geometry("calibrated.toml", text, &calibrated).unwrap()
}

/// The robot file with a residual that twelve poses have shown, and the file of these residuals.
fn with_learnt_residual(text: &str) -> (String, String) {
    let robot = armill::read("calibrated.toml", "", text).unwrap().robot;
    let pose = |k: u32| ResidualAt {
        joints: (0..6)
            .map(|j| 0.4 * (f64::from(k) + 2.0 * f64::from(j)).sin())
            .collect(),
        residual: Vector3::new(3e-5 + 1e-5 * f64::from(k % 3), -2e-5, 5e-5),
    };
    let residuals = residuals_file(&robot, &(0..12).map(pose).collect::<Vec<_>>());
    let settings = LearntSettings {
        lengths: vec![2.0; 6],
        noise: 0.3,
        axes: LearntAxes::FirstJoint,
    };
    let table = LearntTable::of(&robot, &settings, "residuals.csv", &residuals);
    let text = with_residual("calibrated.toml", text, &table, ["made up", "this test"]).unwrap();
    (text, residuals)
}

/// In-plane deviation, its uncertainty and its shares, um.
#[derive(Debug)]
struct Point {
    in_plane: f64,
    u: f64,
    shares: Vec<f64>,
}

impl Point {
    fn of(answer: &Value, at: &str) -> Point {
        let point = answer.pointer(at).unwrap_or_else(|| panic!("{at}: {answer}"));
        let shares = point["joint_share_um"].as_array().unwrap();
        Point {
            in_plane: point["in_plane_um"].as_f64().unwrap(),
            u: point["in_plane_u_um"].as_f64().unwrap(),
            shares: shares.iter().map(|share| share.as_f64().unwrap()).collect(),
        }
    }

    fn assert_is(&self, other: &Point, surface: &str) {
        let close = |a: f64, b: f64| (a - b).abs() < SAME * self.in_plane;
        assert!(
            close(self.in_plane, other.in_plane),
            "{surface}: {self:?} {other:?}"
        );
        assert!(close(self.u, other.u), "{surface}: {self:?} {other:?}");
        assert_eq!(self.shares.len(), other.shares.len(), "{surface}");
        for (a, b) in self.shares.iter().zip(&other.shares) {
            assert!(close(*a, *b), "{surface}: {self:?} {other:?}");
        }
    }
}

#[test]
fn the_same_point_has_the_same_total_and_parts_on_every_surface() {
    let folder = cell();
    let text = StudyText {
        shown: "study.toml",
        folder: folder.path(),
        bytes: STUDY.as_bytes(),
    };
    let answer = |analysis| -> Value {
        let json = answer_json(text, Some(analysis), Watch::NONE).unwrap_or_else(|error| panic!("{error}"));
        serde_json::from_str(&json).unwrap()
    };
    let plate = answer("plate");
    let map = Point::of(&plate, "/maps/0/worst");
    let contributors = &plate["maps"][0]["setting"]["contributors"];
    let named = [
        "S", "L", "U", "R", "B", "T", "base", "tool", "geometry", "thermal", "learnt",
    ];
    assert_eq!(contributors, &serde_json::json!(named));
    // Every source moves the tool here, and together they are the deviation.
    for (name, share) in named.iter().zip(&map.shares) {
        assert!(share.abs() > 0.01, "{name}: {map:?}");
    }
    assert!(
        (map.shares.iter().sum::<f64>() / map.in_plane - 1.0).abs() < 1e-9,
        "{map:?}"
    );

    for (analysis, at) in [
        ("series", "/maps/0/worst"),
        ("box", "/volumes/0/worst"),
        ("line", "/paths/0/worst"),
        ("hole", "/holes/0/worst_holes/0/point"),
    ] {
        map.assert_is(&Point::of(&answer(analysis), at), analysis);
    }

    // The page: a posture with its load cases.
    let question = PostureQuestion {
        analysis: Some("plate"),
        at: PoseTarget {
            y_mm: Some(0.0),
            z_mm: Some(0.0),
            ..PoseTarget::default()
        },
        case: 1,
    };
    let shown = postures(text, &question, Watch::NONE).unwrap();
    let mut branches = shown.answer.postures.iter().zip(&shown.in_plane);
    let (posture, cases) = branches
        .find(|(posture, _)| posture.branch == "front elbow-up no-flip")
        .unwrap();
    let cases: Vec<Point> = cases
        .iter()
        .flatten()
        .map(|case| Point {
            in_plane: case.in_plane_um,
            u: case.in_plane_u_um.unwrap(),
            shares: case.share_um.clone(),
        })
        .collect();
    let worst = cases
        .iter()
        .max_by(|a, b| a.in_plane.total_cmp(&b.in_plane))
        .unwrap();
    map.assert_is(worst, "page");

    // The posture of the page is what `armill pose` computes: shares are vectors there.
    let total = posture.deviation_um.unwrap();
    let shares = posture.joint_share_um.as_ref().unwrap();
    for axis in 0..3 {
        let sum: f64 = shares.iter().map(|share| share[axis]).sum();
        assert!(
            (sum - total[axis]).abs() < 1e-9 * map.in_plane,
            "{total:?} {shares:?}"
        );
    }
    assert_eq!(shown.answer.contributors, named);

    // What compensation begins with. Of two load cases it can only remove what they have in common.
    std::fs::write(folder.path().join("study.toml"), STUDY).unwrap();
    let study = armill_study::studies::find(folder.path())
        .unwrap()
        .read()
        .unwrap();
    let compensation = Compensation {
        rest: 1e-9,
        rounds: 20,
    };
    let paths = compensate(&study, Some("line"), compensation, Watch::NONE).unwrap();
    let (before, after) = (&paths[0].given.before, &paths[0].given.after);
    assert!(
        (before.max_in_plane_um - map.in_plane).abs() < SAME * map.in_plane,
        "{before:?}"
    );
    assert!(after.max_um < before.max_um, "{after:?}");
}

#[test]
fn the_tool_that_cuts_a_part_deviates_as_its_path() {
    let folder = cell();
    // One load case: the part is cut under the mean of all.
    let text = STUDY.replace("[[60, -35, 20], [-20, 50, 30]]", "[[60, -35, 20]]");
    std::fs::write(folder.path().join("study.toml"), text).unwrap();
    let study = armill_study::studies::find(folder.path())
        .unwrap()
        .read()
        .unwrap();
    let (_, path) = study.paths(Some("line")).next().unwrap();
    let runner = Runner::new(&study.robot.robot, Watch::NONE).unwrap();
    let found = runner.path(path).unwrap();
    let motion = |index: usize| path.setting.motion_displacement(found.motion.as_ref(), index);
    let followed = FollowedPath {
        arm: runner.question(&path.setting).arm,
        uncertainty: path.setting.uncertainty,
        track: &path.track,
        along: &found.along,
        motion: &motion,
    };
    for (index, deviation) in followed.deviations(Watch::NONE).unwrap().iter().enumerate() {
        let (deviation, of_path) = (deviation.unwrap(), found.along.answers.deviations_at(index)[0]);
        assert!(
            (deviation.twist.linear - of_path).norm() < SAME * of_path.norm(),
            "{index}"
        );
        let shares = followed.deviation_at(index).unwrap().shares;
        let sum: Vector3<f64> = shares.iter().map(|share| share.linear).sum();
        assert!(
            (sum - of_path).norm() < SAME * of_path.norm(),
            "{index}: {shares:?}"
        );
    }
    let worst = &found.worst[0];
    let evaluation = worst.answers.points[0].unwrap();
    let of_path = worst.answers.deviations_at(0)[0];
    let normal = path.track.stop(worst.index).normal;
    let in_plane = (of_path - normal.into_inner() * of_path.dot(&normal)).normalize();
    let covariance = followed.deviations(Watch::NONE).unwrap()[worst.index]
        .unwrap()
        .covariance;
    let u = in_plane.dot(&(covariance * in_plane)).sqrt();
    let expected = evaluation.in_plane_uncertainty.unwrap();
    assert!((u - expected).abs() < 1e-6 * expected, "{u} {expected}");
}

#[test]
fn a_source_taken_away_takes_its_share_away_and_leaves_the_others() {
    let folder = cell();
    let worst = |study: &str| {
        let text = StudyText {
            shown: "study.toml",
            folder: Path::new(folder.path()),
            bytes: study.as_bytes(),
        };
        let answer: Value =
            serde_json::from_str(&answer_json(text, Some("plate"), Watch::NONE).unwrap()).unwrap();
        (
            answer["maps"][0]["setting"]["contributors"]
                .as_array()
                .unwrap()
                .len(),
            Point::of(&answer, "/maps/0/worst"),
        )
    };
    let (all, with) = worst(STUDY);
    let (fewer, without) = worst(&STUDY.replace("[thermal]\ndifference_k = 8\nu_k = 2\n", ""));
    assert_eq!(fewer + 1, all);
    assert!(
        (with.in_plane - without.in_plane).abs() > 1.0,
        "{with:?} {without:?}"
    );
    assert!(with.u > without.u);
    let (_, cold) = worst(&STUDY.replace("difference_k = 8", "difference_k = 0"));
    assert!(
        (cold.in_plane - without.in_plane).abs() < 1e-9 && cold.u > without.u,
        "{cold:?}"
    );
}
