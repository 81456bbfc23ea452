//! Every sample file of the makers: read, or refused for the reason that is named here.

use std::path::{Path, PathBuf};

use armill_core::frame::Isometry;
use armill_core::robot::Robot;
use armill_core::robot::inverse::posture_at;
use armill_formats::robot::format::{self, Format, RobotReadOptions};
use armill_formats::robot::{RobotDescription, armill, xacro};
use nalgebra::Matrix4;

use crate::joints::Joints;
use crate::samples_folder::samples;
use crate::tree;

enum Outcome {
    /// Six turning joints and a closed-form inverse.
    Arm,
    /// The words of the reason.
    Refused(&'static str),
}
use Outcome::{Arm, Refused};

/// Every file below `robots` of the samples.
const FILES: &[(&str, Outcome)] = &[
    ("abb/common_colours.xacro", Refused("defines no robot")),
    ("abb/common_materials.xacro", Refused("defines no robot")),
    ("abb/irb2400.urdf", Arm),
    ("abb/irb2400_macro.xacro", Arm),
    ("abb/irb4400l_30_243_macro.xacro", Arm),
    ("abb/irb6600_225_255_macro.xacro", Arm),
    ("abb/irb6640.urdf", Arm),
    ("abb/irb6640_185_280.urdf", Arm),
    ("abb/irb6640_185_280.xacro", Arm),
    ("abb/irb6640_185_280_macro.xacro", Arm),
    ("abb/irb6640_macro.xacro", Arm),
    ("fanuc/LICENSE", Refused("without ending")),
    ("fanuc/m20ia.xacro", Arm),
    ("fanuc/m20ia10l_macro.xacro", Arm),
    ("fanuc/m20ia_macro.xacro", Arm),
    ("fanuc/m20ib25_macro.xacro", Arm),
    ("fanuc/m710ic45m_macro.xacro", Arm),
    ("fanuc/m710ic50.xacro", Arm),
    ("fanuc/m710ic50_macro.xacro", Arm),
    ("fanuc/opw_parameters_m10ia.yaml", Arm),
    ("fanuc/opw_parameters_m16ib20.yaml", Arm),
    ("fanuc/opw_parameters_m20ia.yaml", Arm),
    ("fanuc/opw_parameters_m20ia10l.yaml", Arm),
    ("fanuc/opw_parameters_m20ib25.yaml", Arm),
    ("fanuc/opw_parameters_m6ib.yaml", Arm),
    ("kuka/LICENSE", Refused("without ending")),
    ("kuka/common_colours.xacro", Refused("defines no robot")),
    ("kuka/common_constants.xacro", Refused("defines no robot")),
    ("kuka/common_materials.xacro", Refused("defines no robot")),
    ("kuka/kr120r2500pro.urdf", Arm),
    ("kuka/kr120r2500pro_macro.xacro", Arm),
    ("kuka/kr150_2_macro.xacro", Arm),
    ("kuka/kr150r3100_2_macro.xacro", Arm),
    ("kuka/kr16_2.urdf", Arm),
    ("kuka/kr16_2.xacro", Arm),
    ("kuka/kr16_2_macro.xacro", Arm),
    ("kuka/kr210l150.urdf", Arm),
    ("kuka/kr210l150.xacro", Arm),
    ("kuka/kr210l150_macro.xacro", Arm),
    ("kuka/kr6r700sixx_macro.xacro", Arm),
    ("kuka/opw_kinematics_kr5.yaml", Arm),
    ("kuka/opw_kinematics_kr6r700sixx.yaml", Arm),
    ("kuka/opw_parameters_kr10r1420.yaml", Arm),
    ("kuka/opw_parameters_kr150r3100_2.yaml", Arm),
    ("kuka/opw_parameters_kr6r900_2.yaml", Arm),
    ("motoman/common_colors.xacro", Refused("defines no robot")),
    ("motoman/common_materials.xacro", Refused("defines no robot")),
    ("motoman/es165.xacro", Refused("load_yaml")),
    (
        "motoman/es165_macro.xacro",
        Refused("requires values for joint_velocities_file"),
    ),
    ("motoman/gp180_120_macro.xacro", Arm),
    ("motoman/gp25_macro.xacro", Arm),
    ("motoman/joint_names_mh12.yaml", Refused("it lists joint names")),
    ("motoman/mh110.xacro", Arm),
    ("motoman/mh110_macro.xacro", Arm),
    ("motoman/mh12.xacro", Arm),
    ("motoman/mh12_macro.xacro", Arm),
    ("motoman/mh50.xacro", Arm),
    ("motoman/mh50_macro.xacro", Arm),
    ("motoman/opw_parameters_gp110.yaml", Arm),
    ("motoman/opw_parameters_gp35l.yaml", Arm),
    ("motoman/opw_parameters_gp4.yaml", Arm),
    ("motoman/opw_parameters_gp70l.yaml", Arm),
    ("motoman/opw_parameters_mh110.yaml", Arm),
    ("motoman/opw_parameters_mh12.yaml", Arm),
    ("motoman/package.xml", Refused("no <robot> element")),
    ("staubli/LICENSE", Refused("without ending")),
    ("staubli/common_colours.xacro", Refused("defines no robot")),
    ("staubli/common_materials.xacro", Refused("defines no robot")),
    ("staubli/opw_parameters_tx2_90.yaml", Arm),
    ("staubli/opw_parameters_tx2_90l.yaml", Arm),
    ("staubli/rx160.urdf", Arm),
    ("staubli/rx160_macro.xacro", Arm),
    ("staubli/rx160l_macro.xacro", Arm),
    ("staubli/tx2_90.xacro", Arm),
    ("staubli/tx2_90_macro.xacro", Arm),
    ("staubli/tx2_90l_macro.xacro", Arm),
    ("staubli/tx90_macro.xacro", Arm),
];

/// OPW parameters and the xacro of the same arm, and the rotation about the flange's z from the first to the second, deg.
const SAME_ARM: &[(&str, &str, f64)] = &[
    (
        "motoman/opw_parameters_mh12.yaml",
        "motoman/mh12_macro.xacro",
        0.0,
    ),
    (
        "motoman/opw_parameters_mh110.yaml",
        "motoman/mh110_macro.xacro",
        0.0,
    ),
    ("fanuc/opw_parameters_m20ia.yaml", "fanuc/m20ia_macro.xacro", 0.0),
    (
        "fanuc/opw_parameters_m20ia10l.yaml",
        "fanuc/m20ia10l_macro.xacro",
        0.0,
    ),
    (
        "fanuc/opw_parameters_m20ib25.yaml",
        "fanuc/m20ib25_macro.xacro",
        0.0,
    ),
    (
        "kuka/opw_kinematics_kr6r700sixx.yaml",
        "kuka/kr6r700sixx_macro.xacro",
        0.0,
    ),
    (
        "kuka/opw_parameters_kr150r3100_2.yaml",
        "kuka/kr150r3100_2_macro.xacro",
        0.0,
    ),
    (
        "staubli/opw_parameters_tx2_90.yaml",
        "staubli/tx2_90_macro.xacro",
        0.0,
    ),
    (
        "staubli/opw_parameters_tx2_90l.yaml",
        "staubli/tx2_90l_macro.xacro",
        0.0,
    ),
];

/// URDFs that ROS expanded, the xacro of the same arm, and the rotation of `tool0` about its y from the first to the
/// second, deg: the URDF of the KR 210 is of an earlier time, before `tool0` was turned out of the flange.
const EXPANDED_BY_ROS: &[(&str, &str, f64)] = &[
    ("abb/irb2400.urdf", "abb/irb2400_macro.xacro", 0.0),
    ("abb/irb6640.urdf", "abb/irb6640_macro.xacro", 0.0),
    ("abb/irb6640_185_280.urdf", "abb/irb6640_185_280.xacro", 0.0),
    ("kuka/kr120r2500pro.urdf", "kuka/kr120r2500pro_macro.xacro", 0.0),
    ("kuka/kr16_2.urdf", "kuka/kr16_2.xacro", 0.0),
    ("kuka/kr210l150.urdf", "kuka/kr210l150.xacro", 90.0),
    ("staubli/rx160.urdf", "staubli/rx160_macro.xacro", 0.0),
];

const POSTURES: usize = 200;

fn robots() -> Option<PathBuf> {
    samples("robots")
}

fn read(path: &Path) -> Result<RobotDescription, String> {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("sample {}: {error}", path.display()));
    format::read(path, "sample", &bytes, &RobotReadOptions::default())
        .map_err(|problems| problems.to_string())
}

fn sample(robots: &Path, file: &str) -> Robot {
    read(&robots.join(file))
        .unwrap_or_else(|problems| panic!("{problems}"))
        .robot
}

fn flange(robot: &Robot, q: &[f64]) -> Matrix4<f64> {
    posture_at(robot, q, &Isometry::identity())
        .base_from_tool
        .to_homogeneous()
}

/// The greatest of something over random postures.
fn worst(mut of: impl FnMut(&[f64]) -> f64) -> f64 {
    let mut joints = Joints::seeded(7);
    (0..POSTURES).map(|_| of(&joints.next())).fold(0.0, f64::max)
}

#[test]
fn every_sample_is_read_or_refused_for_the_reason_named() {
    let Some(robots) = robots() else { return };
    let mut wrong = Vec::new();
    for (file, outcome) in FILES {
        let said = match (read(&robots.join(file)), outcome) {
            (Err(problems), Refused(words)) => match problems.contains(words) {
                true => None,
                false => Some(format!("refused for another reason than `{words}`: {problems}")),
            },
            (Err(problems), _) => Some(problems),
            (Ok(_), Refused(words)) => Some(format!("read, not refused with `{words}`")),
            (Ok(found), _) => {
                let closed = found.robot.ortho_parallel().is_some();
                let joints = found.robot.joints().len();
                (joints != 6 || !closed).then(|| format!("{joints} joints, closed form: {closed}"))
            }
        };
        wrong.extend(said.map(|said| format!("{file}: {said}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_sample_is_forgotten() {
    let Some(robots) = robots() else { return };
    let folders = std::fs::read_dir(&robots)
        .unwrap()
        .map(|folder| folder.unwrap().path());
    let files = folders.flat_map(|folder| {
        std::fs::read_dir(folder)
            .unwrap()
            .map(|file| file.unwrap().path())
    });
    for path in files {
        let file = path
            .strip_prefix(&robots)
            .unwrap()
            .to_str()
            .unwrap()
            .replace('\\', "/");
        assert!(
            FILES.iter().any(|(known, _)| *known == file),
            "{file} is not in the table"
        );
    }
}

#[test]
fn every_sample_goes_where_the_tree_of_its_urdf_says() {
    let Some(robots) = robots() else { return };
    for (file, outcome) in FILES {
        let path = robots.join(file);
        let text = std::fs::read_to_string(&path).unwrap();
        let urdf = match Format::of(&path, &text) {
            _ if matches!(outcome, Refused(_)) => continue,
            Some(Format::Urdf) => text,
            Some(Format::Xacro) => xacro::expand(&path, &text).unwrap().urdf,
            _ => continue,
        };
        let parsed = urdf_rs::read_from_string(&urdf).unwrap();
        assert_eq!(tree::moving_joints(&parsed), 6, "{file}");
        let robot = sample(&robots, file);
        let apart = worst(|q| (flange(&robot, q) - tree::root_from_tool0(&parsed, q)).norm());
        // Ten products of numbers of a few metres; 1e-9 m is what is promised.
        assert!(apart < 1e-12, "{file}: {apart} m");
    }
}

#[test]
fn our_expansion_is_that_of_ros() {
    let Some(robots) = robots() else { return };
    for (urdf, xacro, turn_deg) in EXPANDED_BY_ROS {
        let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::y_axis(), turn_deg.to_radians());
        let (theirs, ours) = (sample(&robots, urdf), sample(&robots, xacro));
        let apart = worst(|q| (flange(&theirs, q) * turn.to_homogeneous() - flange(&ours, q)).norm());
        println!("{urdf}: {apart:.1e} m");
        assert!(apart < 1e-9, "{urdf}: {apart} m");
        // These two give other limits: joint 1 of the URDF has 170 deg, that of the xacro 160.
        if *urdf == "staubli/rx160.urdf" {
            continue;
        }
        // Some print their limits with four decimals.
        for (a, b) in theirs.joints().iter().zip(ours.joints()) {
            assert_eq!(a.name, b.name, "{urdf}");
            let (a, b) = (a.limits.unwrap(), b.limits.unwrap());
            assert!(
                (a.lower - b.lower).abs() < 1e-4 && (a.upper - b.upper).abs() < 1e-4,
                "{urdf}"
            );
        }
    }
}

#[test]
fn opw_parameters_are_the_arm_of_the_xacro() {
    let Some(robots) = robots() else { return };
    let mut wrong = Vec::new();
    for (opw, xacro, turn_deg) in SAME_ARM {
        let (a, b) = (sample(&robots, opw), sample(&robots, xacro));
        let away = worst(|q| (flange(&a, q).column(3) - flange(&b, q).column(3)).norm());
        let turn = |q: &[f64]| -> Matrix4<f64> {
            let mut between = flange(&a, q).transpose() * flange(&b, q);
            between.fixed_view_mut::<1, 4>(3, 0).fill(0.0);
            between.fixed_view_mut::<4, 1>(0, 3).fill(0.0);
            between
        };
        let expected =
            nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::z_axis(), turn_deg.to_radians());
        let turned = worst(|q| (turn(q).fixed_view::<3, 3>(0, 0) - expected.matrix()).norm());
        // The sources print quarter turns with six to eleven decimals.
        if away > 1e-9 || turned > 1e-5 {
            wrong.push(format!(
                "{opw}: {away} m away, {turned} turned: {}",
                turn(&[0.0; 6])
            ));
        }
        println!("{opw}: {away:.1e} m, {turned:.1e} rad");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_sample_written_as_ours_reads_back_as_the_same_arm() {
    let Some(robots) = robots() else { return };
    for (file, outcome) in FILES {
        if matches!(outcome, Refused(_)) {
            continue;
        }
        let found = read(&robots.join(file)).unwrap();
        let text = armill::write(&found);
        let again = armill::read("written.toml", "sample", &text)
            .unwrap_or_else(|problems| panic!("{file}: {problems}"));
        let apart = worst(|q| (flange(&found.robot, q) - flange(&again.robot, q)).norm());
        assert!(apart < 1e-12, "{file}: {apart} m");
        assert_eq!(
            found.robot.ortho_parallel().is_some(),
            again.robot.ortho_parallel().is_some(),
            "{file}"
        );
        assert_eq!(found.robot.frames().len(), again.robot.frames().len(), "{file}");
    }
}
