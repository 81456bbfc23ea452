//! Work at every pose. The names are the columns of the table and the second field of a row.
//!
//! | work | in | out |
//! |---|---|---|
//! | [`DEV`] | pose | largest in-plane deviation of the four forces, posture front elbow-up |
//! | [`DEV8`] | pose | the same for each of the 8 branches |
//! | [`C66`] | pose | 6 x 6 compliance at the TCP, posture front elbow-up |
//! | [`IK8`] | pose | joint angles of all 8 branches |
//! | [`DEV_AT`], [`C66_AT`] | joint angles | as `dev` and `C66`, for those who have no inverse |
//!
//! Distances of two bodies, which are in [`crate::clearance`]: [`CAPSULE_MESH`], [`CAPSULE_FINE_MESH`], [`MESH_MESH`], [`CYLINDER_BOX`].
//!
//! Any other name is work of one candidate only; it has a table of its own.

/// Deviation of one branch.
pub const DEV: &str = "dev";
/// Deviation of all branches.
pub const DEV8: &str = "dev8";
/// Compliance at the tool.
pub const C66: &str = "C66";
/// Joint angles of all branches.
pub const IK8: &str = "ik8";
/// Deviation, joint angles given.
pub const DEV_AT: &str = "dev from angles";
/// Compliance, joint angles given.
pub const C66_AT: &str = "C66 from angles";
/// Distance of a capsule and a coarse mesh.
pub const CAPSULE_MESH: &str = "capsule, mesh of 512";
/// Distance of a capsule and a fine mesh.
pub const CAPSULE_FINE_MESH: &str = "capsule, mesh of 32 768";
/// Distance of two meshes.
pub const MESH_MESH: &str = "meshes of 2048";
/// Distance of a cylinder and a box.
pub const CYLINDER_BOX: &str = "cylinder, box";
