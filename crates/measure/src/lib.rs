//! What a measurement says of a robot.
//!
//! [`identify`] determines joint compliances from load tests, [`calibrate`] the geometry from measured poses,
//! [`learn`] what the calibrated geometry leaves of them, [`journal`] all of this from all measurements of an arm,
//! [`tracker`] makes poses of the files of a laser tracker,
//! [`backlash`] the backlash of the joints from circular tests. [`ballbar`] evaluates circular tests, [`roundness`]
//! round profiles, [`forces`] records of a dynamometer, [`pose_accuracy`] and [`path_accuracy`] measured poses and
//! paths ([`path_repeatability`]: paths of which nothing is commanded), [`motion`] joint logs, [`drives`] friction and load of joints, and the torsion of those with two encoders, [`frf`] frequency response functions. [`data_check`] searches slips in the data of each: signs, order of columns, zeros, units.

pub mod backlash;
pub mod ballbar;
pub mod calibrate;
pub mod data_check;
pub mod drives;
pub mod forces;
pub mod frf;
pub mod identify;
pub mod journal;
pub mod learn;
pub mod motion;
pub mod path_accuracy;
pub mod path_repeatability;
pub mod pose_accuracy;
pub mod roundness;
pub mod tracker;
