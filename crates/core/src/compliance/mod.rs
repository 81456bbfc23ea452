//! Compliance of the arm at the tool.
//!
//! [`cartesian`]: the 6 x 6 compliance and stiffness at the TCP. [`directions`]: principal compliances
//! and the permissible force for a tolerance.

pub mod cartesian;
pub mod directions;

pub use cartesian::{Stiffness, by_force, compliance_at_tool, stiffness_at_tool};
pub use directions::{
    PrincipalCompliance, permissible_force, permissible_force_in_worst_direction, principal_compliances,
};
