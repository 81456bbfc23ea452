//! The prismatic joints that carry an arm: they stay where a question or a placement puts them, and the branches are
//! those of the arm on them.

use crate::frame::Isometry;
use crate::kernel::answer::AT_LIMIT;
use crate::robot::Robot;
use crate::robot::inverse::kind::Rail;

/// A rail and where it is.
#[derive(Clone, Debug)]
pub(super) struct RailBlock {
    robot: Robot,
    rail: Rail,
    /// Joint positions of the rail, m.
    pub positions: Vec<f64>,
    /// Base as seen from the arm.
    pub arm_from_base: Isometry,
    /// Smallest distance to a limit and the joint that has it, m; none without limits.
    pub margin: Option<(usize, f64)>,
}

impl RailBlock {
    /// For the rail of `robot`, at home or, without that, in the middle of its range.
    pub fn of(robot: &Robot, rail: &Rail, home: Option<&[f64]>) -> RailBlock {
        let mut block = RailBlock {
            robot: robot.clone(),
            rail: rail.clone(),
            positions: Vec::new(),
            arm_from_base: Isometry::identity(),
            margin: None,
        };
        block.set_home(home);
        block
    }

    /// Moves the rail.
    pub fn set_home(&mut self, home: Option<&[f64]>) {
        let home = self.robot.home(home);
        let theta = |joint: usize| self.robot.theta(joint, &home);
        self.arm_from_base = self.rail.base_from_arm(theta).inverse();
        let limited = |joint: usize| Some((joint, self.robot.joints()[joint].limits?.margin(home[joint])));
        let margins = (0..self.rail.joints()).filter_map(limited);
        self.margin = margins.min_by(|a, b| a.1.total_cmp(&b.1));
        self.positions.clear();
        self.positions.extend_from_slice(&home[..self.rail.joints()]);
    }

    /// Whether it is inside its range.
    pub fn is_inside(&self) -> bool {
        self.margin.is_none_or(|(_, margin)| margin >= -AT_LIMIT)
    }
}

/// The arm on a rail; none if its joints are coupled to those of the rail.
pub(super) fn arm_on(rail: &Rail, robot: &Robot) -> Option<Robot> {
    let first = rail.joints();
    let mut joints = robot.joints()[first..].to_vec();
    for coupling in joints.iter_mut().flat_map(|joint| &mut joint.coupling) {
        coupling.joint = coupling.joint.checked_sub(first)?;
    }
    Robot::new(robot.name(), rail.chain().motions().to_vec(), joints).ok()
}
