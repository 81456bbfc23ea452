//! The robot library compared with the files of its numbers, if they are available.
//!
//! Positions are random, a whole turn a joint, whatever the limits: lengths, signs, order and zeros all show.
//! Files are in `ARMILL_SAMPLES`; without it the tests report that they are skipped.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix4, Rotation3, Translation3, Vector3};

use armill_core::frame::Isometry;
use armill_core::robot::Robot;
use armill_core::robot::inverse::posture_at;

use super::super::between;
use super::xacro::urdf_of_the_macro;
use super::{robots, text};
use crate::arms;
use crate::random::Random;

const SEED: u64 = 11;
const POSTURES: usize = 200;

/// Library robot, file it was typed from, and how its flange is turned about y from the file's (rad): the two
/// that are turned leave `tool0` parallel to the last link.
const URDFS: [(&str, &str, f64); 28] = [
    ("abb/irb2400", "abb/irb2400.urdf", 0.0),
    ("abb/irb2400", "abb/irb2400_macro.xacro", 0.0),
    (
        "abb/irb4400l-30-243",
        "abb/irb4400l_30_243_macro.xacro",
        FRAC_PI_2,
    ),
    ("abb/irb6600-225-255", "abb/irb6600_225_255_macro.xacro", 0.0),
    ("abb/irb6640-185-280", "abb/irb6640_185_280.urdf", 0.0),
    ("abb/irb6640-185-280", "abb/irb6640_185_280_macro.xacro", 0.0),
    ("fanuc/m20ia", "fanuc/m20ia_macro.xacro", 0.0),
    ("fanuc/m20ia-10l", "fanuc/m20ia10l_macro.xacro", 0.0),
    ("fanuc/m20ib-25", "fanuc/m20ib25_macro.xacro", 0.0),
    ("fanuc/m710ic-45m", "fanuc/m710ic45m_macro.xacro", 0.0),
    ("fanuc/m710ic-50", "fanuc/m710ic50_macro.xacro", 0.0),
    ("kuka/kr120r2500pro", "kuka/kr120r2500pro_macro.xacro", 0.0),
    ("kuka/kr150-2", "kuka/kr150_2_macro.xacro", 0.0),
    ("kuka/kr150r3100-2", "kuka/kr150r3100_2_macro.xacro", 0.0),
    ("kuka/kr16-2", "kuka/kr16_2.urdf", 0.0),
    ("kuka/kr210l150", "kuka/kr210l150.urdf", FRAC_PI_2),
    ("kuka/kr210l150", "kuka/kr210l150_macro.xacro", 0.0),
    ("kuka/kr6r700sixx", "kuka/kr6r700sixx_macro.xacro", 0.0),
    ("staubli/rx160", "staubli/rx160.urdf", 0.0),
    ("staubli/rx160l", "staubli/rx160l_macro.xacro", 0.0),
    ("staubli/tx2-90", "staubli/tx2_90_macro.xacro", 0.0),
    ("staubli/tx2-90l", "staubli/tx2_90l_macro.xacro", 0.0),
    ("staubli/tx90", "staubli/tx90_macro.xacro", 0.0),
    ("yaskawa/es165", "motoman/es165_macro.xacro", 0.0),
    ("yaskawa/gp180-120", "motoman/gp180_120_macro.xacro", 0.0),
    ("yaskawa/gp25", "motoman/gp25_macro.xacro", 0.0),
    ("yaskawa/mh110", "motoman/mh110_macro.xacro", 0.0),
    ("yaskawa/mh50", "motoman/mh50_macro.xacro", 0.0),
];

/// Library robot, and the file of its seven lengths, offsets and signs.
const OPW: [(&str, &str); 9] = [
    ("fanuc/m20ia", "fanuc/opw_parameters_m20ia.yaml"),
    ("fanuc/m20ia-10l", "fanuc/opw_parameters_m20ia10l.yaml"),
    ("fanuc/m20ib-25", "fanuc/opw_parameters_m20ib25.yaml"),
    ("kuka/kr150r3100-2", "kuka/opw_parameters_kr150r3100_2.yaml"),
    ("kuka/kr6r700sixx", "kuka/opw_kinematics_kr6r700sixx.yaml"),
    ("staubli/tx2-90", "staubli/opw_parameters_tx2_90.yaml"),
    ("staubli/tx2-90l", "staubli/opw_parameters_tx2_90l.yaml"),
    ("yaskawa/mh110", "motoman/opw_parameters_mh110.yaml"),
    ("yaskawa/mh12", "motoman/opw_parameters_mh12.yaml"),
];

#[test]
fn library_arms_agree_with_the_urdfs_of_their_manufacturers() {
    let Some(folder) = robots() else { return };
    for (name, file, turn) in URDFS {
        let sample = text(&folder.join(file));
        let urdf = if file.ends_with(".xacro") {
            urdf_of_the_macro(&sample)
        } else {
            sample
        };
        let parsed = urdf_rs::read_from_string(&urdf).unwrap_or_else(|error| panic!("{file}: {error}"));
        let turned = Rotation3::from_axis_angle(&Vector3::y_axis(), turn).to_homogeneous();
        assert_same(name, file, |q| {
            super::super::tree::root_from_tool0(&parsed, q) * turned
        });
    }
}

#[test]
fn library_arms_agree_with_their_opw_parameters() {
    let Some(folder) = robots() else { return };
    for (name, file) in OPW {
        let opw = Opw::read(&text(&folder.join(file)));
        assert_same(name, file, |q| opw.base_from_flange(q));
    }
}

/// Positions within 1e-9 m; orientations within 1e-6 rad, to which the files cut their quarter turns.
fn assert_same(name: &str, file: &str, expected: impl Fn(&[f64]) -> Matrix4<f64>) {
    let robot: Robot = arms::library(name);
    let mut random = Random::seeded(SEED);
    for _ in 0..POSTURES {
        let q = random.joints::<6>();
        let found = posture_at(&robot, &q, &Isometry::identity());
        let (metres, radians) = between(&found.base_from_tool.to_homogeneous(), &expected(&q));
        assert!(
            metres < 1e-9 && radians < 1e-6,
            "{name} and {file}: {metres} m, {radians} rad at {q:?} (seed {SEED})"
        );
    }
}

/// Parameters of an ortho-parallel basis with spherical wrist.
///
/// Forward: wrist and flange in the plane of the arm, turned about the first axis; `t = sign q - offset`.
/// Source: Brandstötter, Angerer, Hofbaur 2014, "An analytical solution of the inverse kinematics problem of
/// industrial serial manipulators with an ortho-parallel basis and a spherical wrist".
struct Opw {
    /// a1, a2, b, c1, c2, c3, c4, m.
    lengths: [f64; 7],
    /// One a joint, rad.
    offsets: Vec<f64>,
    /// One a joint, 1 or -1.
    signs: Vec<f64>,
}

impl Opw {
    /// From the lines of the file; it is as flat as these files are.
    fn read(yaml: &str) -> Opw {
        let value = |key: &str| {
            let line = yaml.lines().find(|line| line.trim_start().starts_with(key));
            let line = line.unwrap_or_else(|| panic!("no {key}"));
            line.split_once(':').expect("key: value").1.trim().to_owned()
        };
        let list = |key: &str| -> Vec<f64> {
            let text = value(key);
            let inside = text.trim_matches(['[', ']']).split(',');
            inside.map(|entry| number(entry.trim())).collect()
        };
        Opw {
            lengths: ["a1:", "a2:", "b:", "c1:", "c2:", "c3:", "c4:"].map(|key| number(&value(key))),
            offsets: list("opw_kinematics_joint_offsets"),
            signs: list("opw_kinematics_joint_sign_corrections"),
        }
    }

    /// The flange in base at these positions of the controller (rad).
    fn base_from_flange(&self, q: &[f64]) -> Matrix4<f64> {
        let [a1, a2, b, c1, c2, c3, c4] = self.lengths;
        let t: Vec<f64> = (0..6).map(|i| q[i] * self.signs[i] - self.offsets[i]).collect();
        let (upper, fore) = (t[1], t[1] + t[2]);
        let (y, z) = (Vector3::y_axis(), Vector3::z_axis());
        let about = Rotation3::from_axis_angle;
        let in_plane = Vector3::new(
            a1 + c2 * upper.sin() + c3 * fore.sin() + a2 * fore.cos(),
            b,
            c1 + c2 * upper.cos() + c3 * fore.cos() - a2 * fore.sin(),
        );
        let rotation =
            about(&z, t[0]) * about(&y, fore) * about(&z, t[3]) * about(&y, t[4]) * about(&z, t[5]);
        let flange = about(&z, t[0]) * in_plane + rotation * Vector3::z() * c4;
        Translation3::from(flange).to_homogeneous() * rotation.to_homogeneous()
    }
}

/// A number, or `deg(90.0)` in radians.
fn number(text: &str) -> f64 {
    let inside = text.strip_prefix("deg(").and_then(|rest| rest.strip_suffix(')'));
    let (text, scale) = inside.map_or((text, 1.0), |degrees| (degrees, PI / 180.0));
    scale
        * text
            .parse::<f64>()
            .unwrap_or_else(|_| panic!("`{text}` is not a number"))
}
