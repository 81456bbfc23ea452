//! One list of poses, as given by the programs of `programs/same-poses-six-languages` of the samples.
//!
//! Source: those programs, written by the public RoboDK posts; the numbers are KUKA_KRC4.src's, three decimals of mm.

use std::path::PathBuf;

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;
use armill_programs::{Frame, Motion, ProgramText, RobotMove, RobotProgram, Target, read};

use crate::samples_folder::samples;

/// Base to frame, as KUKA writes it: mm, deg.
pub const FRAME: [f64; 6] = [807.767, -963.700, 41.479, 0.0, 0.0, 0.0];
/// Flange to tool.
pub const TOOL: [f64; 6] = [62.5, -108.253, 100.0, -60.0, 90.0, 0.0];
/// Axes of the first move, deg.
pub const JOINTS: [f64; 6] = [-46.18419, -6.77518, -20.54925, 71.38674, 49.58727, -302.54752];
/// Places of the eight straight moves in the frame, mm.
pub const PLACES: [[f64; 3]; 8] = [
    [200.0, 250.0, 348.735],
    [200.0, 200.0, 262.132],
    [200.0, 250.0, 348.735],
    [250.0, 300.0, 278.024],
    [250.0, 250.0, 191.421],
    [250.0, 300.0, 278.024],
    [250.0, 200.0, 278.024],
    [250.0, 150.0, 191.421],
];
/// A, B, C of all of them, deg.
pub const TURN: [f64; 3] = [180.0, 0.0, -150.0];

/// Places agree to the third decimal that is written, m: half of it each in target and frame.
const PLACE: f64 = 1.01e-6;
/// Angles to 1e-3 deg, rad.
const ANGLE: f64 = 1.75e-5;

/// A pose as KUKA writes it.
pub fn kuka(numbers: [f64; 6]) -> Isometry {
    Convention::Kuka.pose(&numbers).unwrap()
}

/// Path of a file of the list, if there are samples.
pub fn path(file: &str) -> Option<PathBuf> {
    samples("programs/same-poses-six-languages").map(|folder| folder.join(file))
}

/// The program of this file, if there are samples.
pub fn sample(file: &str) -> Option<RobotProgram> {
    let bytes = std::fs::read(path(file)?).unwrap();
    Some(read(vec![ProgramText::new(file, &bytes)]).unwrap())
}

/// That two poses are one, within what the files print.
pub fn same(one: &Isometry, other: &Isometry) {
    let apart = (one.translation.vector - other.translation.vector).amax();
    // The angle from the matrices: the arc cosine of `angle_to` is not accurate below 1e-8.
    let matrix = |pose: &Isometry| *pose.rotation.to_rotation_matrix().matrix();
    let turned = (matrix(one) - matrix(other)).amax();
    assert!(apart < PLACE && turned < ANGLE, "{one} {other}");
}

/// That the joints are those of the list, within what the file prints, deg.
pub fn same_joints(found: &RobotMove, printed: f64) {
    let Target::Joints(joints) = &found.target else {
        panic!("no joints: {found:?}");
    };
    assert_eq!(joints.len(), 6);
    for (joint, expected) in joints.iter().zip(JOINTS) {
        assert!((joint.to_degrees() - expected).abs() <= printed, "{joints:?}");
    }
    assert_eq!(found.motion, Motion::Joint);
}

/// That these are the eight straight moves: from the base to the tool, and the tool at the flange.
pub fn eight_moves(moves: &[RobotMove]) {
    assert_eq!(moves.len(), 8);
    for (found, place) in moves.iter().zip(PLACES) {
        let [[x, y, z], [a, b, c]] = [place, TURN];
        let expected = kuka(FRAME) * kuka([x, y, z, a, b, c]);
        let Frame::Given(base_from_frame) = found.frame else {
            panic!("the frame is not given: {found:?}");
        };
        same(&(base_from_frame * found.target.pose().unwrap()), &expected);
        assert_eq!(found.motion, Motion::Linear);
        let Frame::Given(tool) = found.tool else {
            panic!("the tool is not given: {found:?}");
        };
        same(&tool, &kuka(TOOL));
    }
}
