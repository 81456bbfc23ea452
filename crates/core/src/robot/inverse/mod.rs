//! Inverse kinematics: the joint positions of a tool pose.
//!
//! [`kind`] is the closed list of methods: [`closed_form`] ([`ortho_parallel`], solved in `eight_branches`;
//! [`three_parallel`]) with names, [`spherical_wrist`] without, the same followed by damped least squares for calibrated
//! arms, a redundant [`fixed_joint`], a search for any other chain, rails, and the arm that holds the part. A [`Finder`] solves one pose after the
//! other; [`postures`] gives all properties of the postures of one. Each posture is verified by forward kinematics.
//!
//! `finder` runs them, `verify` checks their solutions, `starts` and `descent` are the search, in lanes in
//! `step_in_lanes`, `descents_in_lanes` and `descents`. The closed forms share `lines` (axes in space), `roots`,
//! `two_links` and `three_turns`.

pub mod closed_form;
mod descent;
mod descents;
mod descents_in_lanes;
mod eight_branches;
mod finder;
pub mod fixed_joint;
pub mod kind;
mod lines;
pub mod ortho_parallel;
mod roots;
pub mod spherical_wrist;
mod starts;
mod step_in_lanes;
pub mod three_parallel;
mod three_turns;
pub(crate) mod two_links;
mod verify;

pub use closed_form::ClosedForm;
pub use finder::{Finder, InverseSolution, InverseTarget};
pub(crate) use finder::{WholeTurns, name as name_of};
pub use fixed_joint::FixedJoint;
pub use kind::Inverse;
pub use ortho_parallel::OrthoParallel;
pub use spherical_wrist::SphericalWrist;
pub use three_parallel::ThreeParallel;
pub(crate) use verify::VERIFIED;
pub use verify::verify;

use super::forward::{Frames, forward, tool_at};
use super::jacobian::screws_at;
use super::model::Robot;
use super::posture::Posture;
use super::unreachable::Unreachable;
use crate::frame::Isometry;

/// The tool on the flange, with the joint positions before the pose and at home.
#[derive(Clone, Copy, Debug)]
pub struct ToolAt<'a> {
    /// Flange to tool centre point.
    pub flange_from_tool: &'a Isometry,
    /// Joint positions of the point before, if there is one.
    pub near: Option<&'a [f64]>,
    /// Joint positions at which a rail or a fixed redundant joint is kept, and to which other redundant joints are
    /// pulled; by default the middle of their ranges.
    pub home: Option<&'a [f64]>,
}

impl<'a> ToolAt<'a> {
    /// The tool on an arm without previous joint positions, with home in the middle of its ranges.
    pub fn on(flange_from_tool: &'a Isometry) -> ToolAt<'a> {
        ToolAt {
            flange_from_tool,
            near: None,
            home: None,
        }
    }
}

/// Every posture with the tool at `base_from_tool`; of a searched chain those that were found. Without names the
/// nearest to `near` (or `home`) first. At the wrist singularity the joint that is left free stays as in `near`;
/// without, joints 4 and 6 of a spherical wrist share the turn evenly.
///
/// Postures outside the joint limits are included: see [`Robot::limit_margin`].
///
/// # Errors
/// The reason of the branch that misses by least, if no branch reaches; how near a search came.
///
/// # Panics
/// If `near` or `home` have another number of entries than the robot has joints.
pub fn postures(
    robot: &Robot,
    base_from_tool: &Isometry,
    tool: ToolAt<'_>,
) -> Result<Vec<Posture>, Unreachable> {
    let requested = InverseTarget {
        base_from_flange: base_from_tool * tool.flange_from_tool.inverse(),
        near: tool.near,
        home: tool.home,
    };
    let mut finder = Finder::new(robot);
    let count = finder.all(&requested)?.len();
    let tcp = base_from_tool.translation.vector.into();
    let take = |index| finder.take_posture(index, &tcp, tool.flange_from_tool);
    Ok((0..count).map(take).collect())
}

/// The posture of a robot at these joint positions, whatever its chain.
pub fn posture_at(robot: &Robot, q: &[f64], flange_from_tool: &Isometry) -> Posture {
    let frames = forward(robot, q);
    let base_from_tool = tool_on(&frames, flange_from_tool);
    let (name, singularity) = name_of(robot, q);
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
    tool_at(&frames.base_from_flange, flange_from_tool)
}
