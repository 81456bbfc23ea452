//! The small displacements to be estimated.
//!
//! After each joint but the last the arm may be displaced by six small motions in the axes of that joint: along x, y,
//! z, then about x, y, z. With the frames of the base in the tracker and of the measured point on the flange this
//! covers every error by constant lengths and angles, skew or nearly parallel axes and wrong zeros; some of them twice,
//! which `select` finds.

use nalgebra::DMatrix;

use crate::robot::chain::{Axis, Motion};
use crate::robot::{Amount, Robot, SmallMotion, UncertainGeometry};

/// Location of an unknown in the chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterLocation {
    /// The base in the tracker.
    Base,
    /// Right after the joint with this index.
    After(usize),
    /// The measured point on the flange.
    Tool,
}

/// One small motion of unknown size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unknown {
    /// Its location.
    pub place: ParameterLocation,
    /// Along x, y, z: 0, 1, 2; about x, y, z: 3, 4, 5; of the axes there.
    pub component: usize,
}

/// Unknowns of the chain, in addition to base and tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterSet {
    /// None, and the measured point is known too: the base alone.
    Base,
    /// None: the chain is nominal.
    BaseAndTool,
    /// The zeros of the joints.
    Zeros,
    /// Zeros, lengths and angles.
    Geometry,
}

impl Unknown {
    /// Whether it is a rotation; otherwise a translation.
    pub fn turns(&self) -> bool {
        self.component > 2
    }

    /// The axis that it moves along or about.
    pub fn axis(&self) -> Axis {
        Axis::ALL[self.component % 3]
    }

    /// Whether this is the zero of the joint that it follows.
    pub fn is_zero_of(&self, robot: &Robot) -> bool {
        let ParameterLocation::After(joint) = self.place else {
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

/// All unknowns, those first that are kept where two have the same effect: base, tool, zeros, lengths, angles.
///
/// A body without measured rotation has no unknown rotation.
pub(crate) fn unknowns(robot: &Robot, requested: ParameterSet, turns_measured: bool) -> Vec<Unknown> {
    let six = |place| (0..6).map(move |component| Unknown { place, component });
    let mut all: Vec<Unknown> = six(ParameterLocation::Base).collect();
    if requested == ParameterSet::Base {
        return all;
    }
    all.extend(six(ParameterLocation::Tool).filter(|unknown| turns_measured || !unknown.turns()));
    let attachments: Vec<Unknown> = (0..robot.joints().len().saturating_sub(1))
        .flat_map(|joint| six(ParameterLocation::After(joint)))
        .collect();
    let (zeros, others): (Vec<Unknown>, Vec<Unknown>) = attachments
        .into_iter()
        .partition(|unknown| unknown.is_zero_of(robot));
    if matches!(requested, ParameterSet::Zeros | ParameterSet::Geometry) {
        all.extend(zeros);
    }
    if requested == ParameterSet::Geometry {
        all.extend(others.iter().filter(|unknown| !unknown.turns()));
        all.extend(others.iter().filter(|unknown| unknown.turns()));
    }
    all
}

/// Uncertainty of the small motions among these unknowns with this covariance, each by its row; `None` without any, or where the covariance is
/// beyond small motions.
pub(crate) fn uncertain_motions(
    unknowns: impl Iterator<Item = (usize, Unknown)>,
    covariance: &DMatrix<f64>,
) -> Option<UncertainGeometry> {
    let small = |(row, unknown): (usize, Unknown)| match unknown.place {
        ParameterLocation::After(after) => {
            let component = unknown.component;
            Some((row, SmallMotion { after, component }))
        }
        ParameterLocation::Base | ParameterLocation::Tool => None,
    };
    let (rows, motions): (Vec<usize>, Vec<SmallMotion>) = unknowns.filter_map(small).unzip();
    let of = DMatrix::from_fn(rows.len(), rows.len(), |i, j| {
        let (i, j) = (rows[i], rows[j]);
        0.5 * (covariance[(i, j)] + covariance[(j, i)])
    });
    let found = UncertainGeometry::new(motions, &of).ok()?;
    (found.inputs() > 0).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms;

    #[test]
    fn a_six_axis_arm_has_six_small_motions_after_five_joints_and_five_zeros_among_them() {
        let robot = arms::mh12();
        assert_eq!(unknowns(&robot, ParameterSet::Base, true).len(), 6);
        assert_eq!(unknowns(&robot, ParameterSet::BaseAndTool, false).len(), 9);
        assert_eq!(unknowns(&robot, ParameterSet::BaseAndTool, true).len(), 12);
        assert_eq!(unknowns(&robot, ParameterSet::Zeros, true).len(), 17);
        assert_eq!(unknowns(&robot, ParameterSet::Geometry, false).len(), 39);
        let zeros = unknowns(&robot, ParameterSet::Geometry, false);
        assert_eq!(
            zeros.iter().filter(|unknown| unknown.is_zero_of(&robot)).count(),
            5
        );
    }
}
