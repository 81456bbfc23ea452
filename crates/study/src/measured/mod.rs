//! Measurements that a study file names: a force record along a path, a profile or circular tests of a circle.
//!
//! In reading order: [`force_record`] a record from its file, [`treatment`] its drift, filter and revolutions,
//! [`force_picture`] its picture; [`profile`] the points of a round profile; [`circular_test`] the runs of a ball-bar.
//! What a measurement says by itself is the crate `armill-measure`.

pub mod circular_test;
pub mod force_picture;
pub mod force_record;
pub mod profile;
pub mod treatment;
