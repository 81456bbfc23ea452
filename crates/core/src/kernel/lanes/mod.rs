//! Many poses in one instruction, for ortho-parallel arms with spherical wrist.
//!
//! Planes of numbers, one value per point, go through short loops without branches; the compiler vectorises them, once
//! for each instruction set ([`Backend`]). In reading order: `geometry` (the arm, a prepared question, poses in the arm's
//! axes); `solve` (postures, joint limits and positions, screws); `load` (compliance and deviations); `whole` (springs,
//! masses, geometry, thermal growth and backlash of any chain at known joint positions); `branches` (named branches of
//! calibrated arms and of three parallel axes); `by_block` ([`Batch`]: entry point for many poses; whole answers for
//! [`super::evaluate`]); `placement` (a path at placements of its part).
//!
//! Theory and accuracy: `docs/theory/lanes.md`.
//!
//! ```
//! use armill_core::kernel::lanes::{Backend, Batch, Envelopes, Poses, flag};
//! # use armill_core::kernel::{BranchChoice, Question};
//! # use armill_core::frame::{Isometry, tool_orientation};
//! # use armill_core::robot::{Amount::*, Axis::*, Branch, Joint, JointCompliance, Motion::*, Robot};
//! # use armill_core::spatial::Wrench;
//! # use nalgebra::Vector3;
//! # let motions = vec![
//! #     Along(Z, Constant(0.45)), About(Z, Joint(0)), Along(X, Constant(0.155)), About(Y, Joint(1)),
//! #     Along(Z, Constant(0.614)), About(Y, Joint(2)), Along(Z, Constant(0.2)), About(X, Joint(3)),
//! #     Along(X, Constant(0.64)), About(Y, Joint(4)), Along(X, Constant(0.1)), About(X, Joint(5)),
//! # ];
//! # let joints = ["S", "L", "U", "R", "B", "T"].map(armill_core::robot::Joint::plain).to_vec();
//! # let compliance = vec![JointCompliance { value: 2e-6, standard_uncertainty: 0.0 }; 6];
//! # let robot = Robot::new("mh12", motions, joints)?.with_compliance(compliance)?;
//! # let (tool, cases) = (Isometry::identity(), [Wrench::from_force(Vector3::new(3.0, 5.0, 5.0))]);
//! # let question = Question {
//! #     arm: armill_core::source::Arm {
//! #         robot: &robot, compliance: robot.compliance().unwrap(), flange_from_tool: &tool,
//! #         model: armill_core::source::StiffnessModel::DRIVES,
//! #     },
//! #     home: None, homes: None, uncertainty: armill_core::load::InputUncertainty::NONE, cases: &cases, normal: -Vector3::x_axis(),
//! #     choice: BranchChoice::Best,
//! #     clearance: None,
//! # };
//! // Three points of a vertical plate, the tool along base x.
//! let (x, y, z) = ([0.9, 0.9, 3.0], [0.0, 0.1, 0.0], [0.8, 0.8, 0.8]);
//! let poses = Poses::Still {
//!     base_from_tool: tool_orientation(Vector3::x_axis(), 0.0).to_rotation_matrix(),
//!     at: [&x, &y, &z],
//! };
//! let mut batch = Batch::<f64>::new(&question, robot.ortho_parallel().unwrap(), Backend::fastest());
//! let mut out = Envelopes::default();
//! batch.envelopes(&poses, Branch::ALL[0], &mut out);
//! assert!(out.in_plane()[0] > 0.0 && out.flags(0) & flag::UNREACHABLE == 0);
//! assert!(out.flags(2) & flag::TOO_FAR != 0);
//! # Ok::<(), armill_core::robot::RobotError>(())
//! ```

mod branches;
mod by_block;
mod geometry;
mod load;
mod placement;
mod solve;
mod whole;

pub use crate::numbers::{Backend, Float, Precision, Real};
pub use by_block::{Arrays, Batch, Envelopes, Poses};
pub use solve::flag;

pub(super) use by_block::{
    BranchMargins, BranchStatus, EveryBranch, LoadedBranches, POINTS, PointLoads, Points, WholePoints,
};
pub(super) use placement::{PlacementPoints, Placer, Tallied};

#[cfg(test)]
mod tests;
