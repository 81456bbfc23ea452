//! Programs of controllers in the samples of one list of poses for several languages: Yaskawa, FANUC, Staubli.
//!
//! The eight poses are typed here from `KUKA_KRC4.src` of the same folder, whose text is read by none of these readers.

mod samples_folder;

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;
use armill_formats::robot_program::{
    Frame, Language, Motion, ProgramText, RobotProgram, Speed, Target, read,
};
use samples_folder::samples;

const FOLDER: &str = "programs/same-poses-six-languages";

/// X, Y, Z of the targets in the frame, mm.
const PLACES: [[f64; 3]; 8] = [
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
const TURN: [f64; 3] = [180.0, 0.0, -150.0];
const BASE_FROM_FRAME: [f64; 6] = [807.767, -963.700, 41.479, 0.0, 0.0, 0.0];
const FLANGE_FROM_TOOL: [f64; 6] = [62.500, -108.253, 100.000, -60.000, 90.000, 0.000];
/// Of the first move, deg.
const JOINTS: [f64; 6] = [-46.18419, -6.77518, -20.54925, 71.38674, 49.58727, -302.54752];

fn kuka(numbers: &[f64]) -> Isometry {
    Convention::Kuka.pose(numbers).unwrap()
}

fn near(one: &Isometry, other: &Isometry, what: &str) {
    let far = (one.translation.vector - other.translation.vector).norm();
    let turned = one.rotation.angle_to(&other.rotation);
    // Both write 0.001 mm, and the frame that Yaskawa's base poses add is rounded as well: three roundings an axis. Angles are
    // whole degrees; what is left is the arc cosine of `angle_to`.
    assert!(far < 2.6e-6 && turned < 1e-7, "{what}: {far:e} m, {turned:e} rad");
}

fn sample(name: &str) -> Option<(RobotProgram, Vec<u8>)> {
    let bytes = std::fs::read(samples(FOLDER)?.join(name)).unwrap();
    let program = read(vec![ProgramText::new(name, &bytes)]).unwrap_or_else(|problems| panic!("{problems}"));
    Some((program, bytes))
}

/// The poses of the moves behind the first.
fn poses(program: &RobotProgram) -> Vec<Isometry> {
    let straight = program.moves.iter().skip(1);
    straight
        .map(|one| {
            assert_eq!(one.motion, Motion::Linear);
            *one.target.pose().unwrap()
        })
        .collect()
}

fn in_frame(at: usize) -> Isometry {
    kuka(&[PLACES[at].as_slice(), &TURN].concat())
}

#[test]
fn the_yaskawa_job_has_the_poses_of_the_others_in_the_base() {
    let Some((program, bytes)) = sample("Motoman.JBI") else {
        return;
    };
    assert_eq!(
        (program.language, program.name.as_str()),
        (Language::Inform, "Progra")
    );
    let first = Target::Elsewhere {
        name: "C00000".to_owned(),
    };
    assert_eq!(
        (&program.moves[0].target, &program.moves[0].motion),
        (&first, &Motion::Joint)
    );
    for (at, pose) in poses(&program).iter().enumerate() {
        near(
            pose,
            &(kuka(&BASE_FROM_FRAME) * in_frame(at)),
            &format!("target {at}"),
        );
    }
    for one in &program.moves[1..] {
        assert_eq!(one.frame, Frame::Told(Isometry::identity()));
        assert_eq!((one.tool, one.speed), (Frame::Numbered(9), Speed::Tip(0.1)));
        let Target::Pose { branch, turns, .. } = &one.target else {
            panic!("{one:?}")
        };
        assert_eq!(branch.to_string(), "front elbow-up no-flip");
        assert_eq!(turns, &[0, -1, 0]);
    }
    assert_eq!(
        program.moves.iter().map(|one| one.line).collect::<Vec<_>>(),
        [33, 34, 35, 39, 40, 41, 45, 46, 47]
    );
    assert_eq!(program.with_poses(&[]).unwrap()[0].1, bytes);
}

#[test]
fn the_fanuc_listing_has_the_poses_of_the_others_in_the_frame() {
    let Some((program, bytes)) = sample("Fanuc_R30iA.LS") else {
        return;
    };
    assert_eq!(
        (program.language, program.name.as_str()),
        (Language::Tp, "Program")
    );
    let Target::Joints(joints) = &program.moves[0].target else {
        panic!("{:?}", program.moves[0])
    };
    for (joint, told) in joints.iter().zip(JOINTS) {
        // Three decimals here, five there.
        assert!((joint.to_degrees() - told).abs() < 0.000_51, "{joint} {told}");
    }
    for (at, pose) in poses(&program).iter().enumerate() {
        near(pose, &in_frame(at), &format!("target {at}"));
    }
    for one in &program.moves {
        let (Frame::Told(frame), Frame::Told(tool)) = (one.frame, one.tool) else {
            panic!("{one:?}")
        };
        near(&frame, &kuka(&BASE_FROM_FRAME), "frame");
        // W 0, P 90, R -60 here, A -60, B 90, C 0 there: the same turns.
        near(&tool, &kuka(&FLANGE_FROM_TOOL), "tool");
    }
    for one in &program.moves[1..] {
        assert_eq!(one.speed, Speed::Tip(0.5));
        let Target::Pose { branch, turns, .. } = &one.target else {
            panic!("{one:?}")
        };
        assert_eq!(branch.to_string(), "front elbow-up no-flip");
        // Of the joints of the first move: axes 1 and 4 within half a turn, axis 6 at -302.5 deg.
        assert_eq!(turns, &[0, 0, -1]);
    }
    assert_eq!(program.with_poses(&[]).unwrap()[0].1, bytes);
}
