//! Which joint positions hold this tool pose?
//!
//! [`kind`] is the closed list of ways: [`closed_form`] ([`ortho_parallel`], [`three_parallel`]) with names,
//! [`spherical_wrist`] without, the same followed by damped least squares for calibrated arms, a
//! [`fixed_joint`] to spare, a search for any other chain, and rails. A [`Finder`] takes one pose after
//! the other; [`postures`] gives everything about the postures of one. Each is checked by forward kinematics before
//! it leaves.
//!
//! `finder` is the work behind them, `starts` and `descent` the search. The closed forms share `lines` (axes in space), `roots`,
//! `two_links` and `three_turns`.

pub mod closed_form;
mod descent;
mod finder;
pub mod kind;
mod lines;
pub mod ortho_parallel;
mod roots;
pub mod spherical_wrist;
pub mod fixed_joint;
mod starts;
pub mod three_parallel;
mod three_turns;
pub(crate) mod two_links;

pub use closed_form::ClosedForm;
pub use finder::{Finder, Found, Wanted};
pub use kind::Inverse;
pub use ortho_parallel::OrthoParallel;
pub use spherical_wrist::SphericalWrist;
pub use fixed_joint::FixedJoint;
pub use three_parallel::ThreeParallel;

use nalgebra::UnitQuaternion;

use super::forward::{Frames, forward, forward_into};
use super::jacobian::screws_at;
use super::model::Robot;
use super::posture::Posture;
use super::unreachable::Unreachable;
use crate::frame::{Isometry, turn_between};

/// How far the forward kinematics of a solution may lie from the pose asked for, m and rad.
///
/// The closed form reaches 1e-15 of the arm's length; a thousand times its worst is a broken geometry.
const VERIFIED: f64 = 1e-9;

/// The tool on the flange, where the arm stood before, and where it likes to stand.
#[derive(Clone, Copy, Debug)]
pub struct ToolAt<'a> {
    /// Flange to tool centre point.
    pub flange_from_tool: &'a Isometry,
    /// Joint positions of the point before, if there is one.
    pub near: Option<&'a [f64]>,
    /// Joint positions where a rail or a joint to spare stands, and that further joints to spare are drawn to; without,
    /// the middle of their ranges.
    pub home: Option<&'a [f64]>,
}

impl<'a> ToolAt<'a> {
    /// The tool on an arm that stood nowhere before and likes the middle of its ranges.
    pub fn on(flange_from_tool: &'a Isometry) -> ToolAt<'a> {
        ToolAt {
            flange_from_tool,
            near: None,
            home: None,
        }
    }
}

/// Every posture that holds the tool at `base_from_tool`, of a searched chain those that were found; without names the
/// nearest to `near` (or `home`) first. At the wrist singularity the joint that is left free stays as in `near`; without, joints 4
/// and 6 of a spherical wrist share the turn evenly.
///
/// Outside joint limits counts as a posture: ask [`Robot::limit_margin`].
///
/// # Errors
/// The reason of the branch that misses by least, if no branch reaches; how near a search came.
///
/// # Panics
/// If `near` or `home` have not as many entries as the robot has joints.
pub fn postures(
    robot: &Robot,
    base_from_tool: &Isometry,
    tool: ToolAt<'_>,
) -> Result<Vec<Posture>, Unreachable> {
    let requested = Wanted {
        base_from_flange: base_from_tool * tool.flange_from_tool.inverse(),
        near: tool.near,
        home: tool.home,
    };
    let mut finder = Finder::new(robot);
    let mut frames = Frames::for_robot(robot);
    let mut posture = |found: &Found| {
        forward_into(robot, &found.joints, &mut frames);
        Posture {
            name: found.name,
            joints: found.joints.clone(),
            screws: screws_at(robot, &frames, &base_from_tool.translation.vector.into()),
            base_from_tool: tool_on(&frames, tool.flange_from_tool),
            singularity: found.singularity,
        }
    };
    Ok(finder.all(&requested)?.iter().map(&mut posture).collect())
}

/// Checks that these frames bring the flange to where it was asked to be, within 1e-9 m and rad.
///
/// # Errors
/// [`Unreachable::Unverified`] with the distance missed.
pub fn holds(frames: &Frames, base_from_flange: &Isometry) -> Result<(), Unreachable> {
    let reached = &frames.base_from_flange;
    let away = reached.translation.vector - base_from_flange.translation.vector;
    let requested = base_from_flange.rotation.to_rotation_matrix();
    let turned = turn_between(reached.rotation.matrix(), requested.matrix());
    if away.norm() < VERIFIED && turned.norm() < VERIFIED {
        Ok(())
    } else {
        Err(Unreachable::Unverified { by: away.norm() })
    }
}

/// The posture of a robot at these joint positions, whatever its chain.
pub fn posture_at(robot: &Robot, q: &[f64], flange_from_tool: &Isometry) -> Posture {
    let frames = forward(robot, q);
    let base_from_tool = tool_on(&frames, flange_from_tool);
    let (name, singularity) = finder::name(robot, q);
    Posture {
        name,
        joints: q.to_vec(),
        base_from_tool,
        screws: screws_at(robot, &frames, &base_from_tool.translation.vector.into()),
        singularity,
    }
}

/// The tool pose of these frames.
pub fn tool_on(frames: &Frames, flange_from_tool: &Isometry) -> Isometry {
    let flange = &frames.base_from_flange;
    let rotation = UnitQuaternion::from_rotation_matrix(&flange.rotation);
    Isometry::from_parts(flange.translation, rotation) * flange_from_tool
}
