//! The small displacements that poses are asked for.
//!
//! After each joint but the last the arm may be displaced by six small motions in the axes of that joint: along x, y, z,
//! then about x, y, z. With the place of the base in the tracker and of the measured point on the flange this is every
//! error that constant lengths and angles, skew or nearly parallel axes and wrong zeros can make; some of them
//! twice, which `select` finds.

use crate::robot::chain::{Axis, Motion};
use crate::robot::{Amount, Robot};

/// Where an unknown sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The base in the tracker.
    Base,
    /// Right after the joint with this index.
    After(usize),
    /// The measured point on the flange.
    Tool,
}

/// One small motion whose size is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unknown {
    /// Where.
    pub place: Place,
    /// Along x, y, z: 0, 1, 2; about x, y, z: 3, 4, 5; of the axes that stand there.
    pub component: usize,
}

/// What of the chain is asked for, beside base and tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// Nothing: the chain is taken as it is.
    BaseAndTool,
    /// Where the joints count from.
    Zeros,
    /// Zeros, lengths and angles.
    Geometry,
}

impl Unknown {
    /// Whether it turns; else it slides.
    pub fn turns(&self) -> bool {
        self.component > 2
    }

    /// The axis that it moves along or about.
    pub fn axis(&self) -> Axis {
        Axis::ALL[self.component % 3]
    }

    /// Whether this is the zero of the joint that it follows.
    pub fn is_zero_of(&self, robot: &Robot) -> bool {
        let Place::After(joint) = self.place else {
            return false;
        };
        match robot.chain().links()[joint].motion {
            Motion::About(axis, _) => self.turns() && axis == self.axis(),
            Motion::Along(axis, _) => !self.turns() && axis == self.axis(),
        }
    }

    /// The motion by `value` (m or rad).
    pub fn motion(&self, value: f64) -> Motion {
        match self.turns() {
            true => Motion::About(self.axis(), Amount::Constant(value)),
            false => Motion::Along(self.axis(), Amount::Constant(value)),
        }
    }
}

/// All that is asked, those first that are kept where two do the same: base, tool, zeros, lengths, angles.
///
/// A body whose turn was not measured has no turn to find.
pub(super) fn unknowns(robot: &Robot, requested: Asked, turns_measured: bool) -> Vec<Unknown> {
    let six = |place| (0..6).map(move |component| Unknown { place, component });
    let mut all: Vec<Unknown> = six(Place::Base).collect();
    all.extend(six(Place::Tool).filter(|unknown| turns_measured || !unknown.turns()));
    let attachments: Vec<Unknown> = (0..robot.joints().len().saturating_sub(1))
        .flat_map(|joint| six(Place::After(joint)))
        .collect();
    let (zeros, others): (Vec<Unknown>, Vec<Unknown>) =
        attachments.into_iter().partition(|unknown| unknown.is_zero_of(robot));
    if requested != Asked::BaseAndTool {
        all.extend(zeros);
    }
    if requested == Asked::Geometry {
        all.extend(others.iter().filter(|unknown| !unknown.turns()));
        all.extend(others.iter().filter(|unknown| unknown.turns()));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms;

    #[test]
    fn a_six_axis_arm_has_six_small_motions_after_five_joints_and_five_zeros_among_them() {
        let robot = arms::mh12();
        assert_eq!(unknowns(&robot, Asked::BaseAndTool, false).len(), 9);
        assert_eq!(unknowns(&robot, Asked::BaseAndTool, true).len(), 12);
        assert_eq!(unknowns(&robot, Asked::Zeros, true).len(), 17);
        assert_eq!(unknowns(&robot, Asked::Geometry, false).len(), 39);
        let zeros = unknowns(&robot, Asked::Geometry, false);
        assert_eq!(
            zeros.iter().filter(|unknown| unknown.is_zero_of(&robot)).count(),
            5
        );
    }
}
