//! Every posture of random poses against rs-opw-kinematics. See README.md.
//!
//! Two sets of postures a pose: each of ours takes the nearest of theirs, joints compared modulo a turn, and
//! the rest on either side is unmatched. For any order of the two lists, the sets are equal if
//! nothing is unmatched.

use std::f64::consts::TAU;

use rs_opw_kinematics::glam::{DQuat, DVec3};
use rs_opw_kinematics::kinematic_traits::{Kinematics, Pose};
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;

use armill_core::frame::Isometry;
use armill_core::robot::inverse::{ToolAt, postures};
use armill_core::robot::jacobian::jacobian;
use armill_core::robot::{Posture, Robot};

use crate::arms;
use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const REFERENCE: &str = "rs-opw-kinematics 3.0.0";
const SEED: u64 = 1;
/// Poses an arm: two thirds made from joint positions, one third placed freely.
const POSES: usize = 33_400;
/// Poses with a posture nearer to a singularity than this are left out: product of the sines of elbow and wrist
/// bend and of the distance of the wrist centre from the first axis over the arm's length. Each program makes
/// its own choice there.
const SINGULAR: f64 = 3e-4;

/// One arm in both programs.
///
/// One arm in both programs.
struct Arm {
    /// Maker and type, for the table.
    title: &'static str,
    /// As armill has it: a chain of motions.
    robot: Robot,
    /// As the other program has it: seven lengths, offsets and signs.
    reference: OPWKinematics,
    /// Upper arm and forearm, m.
    links: [f64; 2],
}

/// The arm, with the lengths of its links from the parameters of the other program.
fn arm(title: &'static str, robot: Robot, parameters: Parameters) -> Arm {
    let links = [parameters.c2, parameters.a2.hypot(parameters.c3)];
    Arm {
        title,
        robot,
        reference: OPWKinematics::new(parameters),
        links,
    }
}

/// Three arms that differ in what goes wrong easily, see README.md.
fn arms() -> [Arm; 3] {
    arms::with_opw_parameters().map(|(title, robot, parameters)| arm(title, robot, parameters))
}

/// What came out of many poses.
#[derive(Default)]
struct Tally {
    /// Poses compared, those of them with no posture on either side, and those left out.
    compared: usize,
    unreachable: usize,
    singular: usize,
    /// Postures compared.
    postures: usize,
    /// Postures that only one side finds.
    alone: usize,
    /// Greatest distance between two joints, rad.
    distances: Vec<f64>,
}

impl Arm {
    /// All poses of one arm, from the same seed.
    fn tally(&self) -> Tally {
        let mut random = Random::seeded(SEED);
        let mut tally = Tally::default();
        for index in 0..POSES {
            // Half the side of their cube is what both links reach, so that some free poses have no posture.
            let pose = if index % 3 < 2 {
                self.reference.forward(&random.joints())
            } else {
                let reach = self.links[0] + self.links[1];
                let [i, j, k, w] = <[f64; 4]>::from(random.orientation().coords);
                let at = <[f64; 3]>::from(random.vector(reach));
                Pose::from_parts(DVec3::from(at), DQuat::from_xyzw(i, j, k, w))
            };
            self.compare(&pose, &mut tally);
        }
        tally
    }

    /// Compares both results for one pose and counts.
    fn compare(&self, pose: &Pose, tally: &mut Tally) {
        let tool = ToolAt {
            flange_from_tool: &Isometry::identity(),
            near: None,
            home: None,
        };
        let mine = postures(&self.robot, &isometry(pose), tool).unwrap_or_default();
        if mine
            .iter()
            .any(|posture| self.away_from_singularity(posture) < SINGULAR)
        {
            tally.singular += 1;
            return;
        }
        let mut theirs = self.reference.inverse(pose);
        tally.compared += 1;
        tally.unreachable += usize::from(mine.is_empty() && theirs.is_empty());
        for posture in &mine {
            // Taken away once it is matched: no posture is the partner of two.
            let nearest = theirs
                .iter()
                .map(|other| apart(&posture.joints, other))
                .enumerate()
                .min_by(|a, b| a.1.total_cmp(&b.1))
                // A posture of another branch does not match.
                .filter(|(_, away)| *away < 1e-3);
            match nearest {
                Some((index, away)) => {
                    theirs.swap_remove(index);
                    tally.postures += 1;
                    tally.distances.push(away);
                }
                None => tally.alone += 1,
            }
        }
        tally.alone += theirs.len();
    }

    /// `|det J| / (l2 l3 (l2 + l3))`: 0 where joints are not determined, at most about 1.
    fn away_from_singularity(&self, posture: &Posture) -> f64 {
        let [l2, l3] = self.links;
        let square = jacobian(&self.robot, &posture.screws)
            .fixed_columns::<6>(0)
            .into_owned();
        square.determinant().abs() / (l2 * l3 * (l2 + l3))
    }
}

/// A pose of the other program as ours.
fn isometry(pose: &Pose) -> Isometry {
    let (t, q) = (pose.translation, pose.rotation);
    let rotation = nalgebra::Quaternion::new(q.w, q.x, q.y, q.z);
    Isometry::from_parts(
        [t.x, t.y, t.z].into(),
        nalgebra::UnitQuaternion::from_quaternion(rotation),
    )
}

/// Greatest distance between two joints, whole turns apart, rad.
fn apart(a: &[f64], b: &[f64; 6]) -> f64 {
    worst(a.iter().zip(b).map(|(a, b)| {
        let turns = (a - b) / TAU;
        (turns - turns.round()) * TAU
    }))
}

/// Postures against those of the other program, pose after pose.
pub fn checks() -> Vec<Check> {
    arms().iter().flat_map(|arm| rows(arm, &arm.tally())).collect()
}

/// Checks of one arm: largest joint difference, and number of unmatched postures.
fn rows(arm: &Arm, tally: &Tally) -> [Check; 2] {
    let Tally {
        compared,
        unreachable,
        singular,
        postures,
        alone,
        distances,
    } = tally;
    let title = arm.title;

    [
        Check::computed(
            format!(
                "{title}: joints of {postures} postures of {compared} poses, modulo a turn ({singular} singular poses omitted)"
            ),
            REFERENCE,
            // Rounding over the distance from the singularity: 1e-15 / 3e-4, two programs, a margin of a hundred.
            ErrorBound {
                worst: worst(distances.iter().copied()),
                tolerance: 1e-9,
                unit: "rad",
            },
        ),
        Check::none_wrong(
            format!("{title}: postures found by one program only ({unreachable} of the poses have none)"),
            REFERENCE,
            *alone,
        ),
    ]
}
