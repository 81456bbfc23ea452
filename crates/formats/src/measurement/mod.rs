//! Measurements: records of force over time, load tests, measured poses, round profiles, circular tests, tip traces, joint logs,
//! frequency response functions; the journal of all measurements of an arm.
//!
//! - [`format`](mod@format): a force record in either format.
//! - [`dynoware`]: text exports of Kistler's DynoWare.
//! - [`csv`]: any other table with a column for each channel.
//! - [`load_tests`]: loads on a robot at rest, and its displacements.
//! - [`profile`]: points of a nominally round profile.
//! - [`ballbar`]: radii along a circle, and results of a ball-bar's own software.
//! - [`poses`]: joint positions, and the poses that a laser tracker measured.
//! - [`trace`]: points of the tip along a path, for one or several runs.
//! - [`joint_log`]: joint positions over time.
//! - [`bodies`]: positions and orientations as trackers export them; [`numbers`]: tables of numbers without names, workbooks.
//! - [`scan`]: points of a real part from scanners and coordinate measuring machines.
//! - [`conditions`]: loads and directions of motion at points of a path.
//! - [`journal`]: all measurements of one arm, with their days and temperatures.
//! - [`frf`]: frequency response functions of a modal test.
//! - [`matlab`]: numeric arrays of MATLAB files.
//!
//! Force records are [`Record`](armill_core::load::Record)s in the axes of the sensor. Whether the force acts on the
//! tool or on the part, and how the sensor is oriented, is not in any file: the caller gives it.
//!
//! `columns`: quantity and unit of each column; samples. `workbook`: cells of Excel sheets. `force_records`: the content of a force file in any format.

pub mod ballbar;
pub mod bodies;
mod columns;
pub mod conditions;
pub mod csv;
pub mod dynoware;
mod force_records;
pub mod format;
pub mod frf;
pub mod joint_log;
pub mod journal;
pub mod load_tests;
pub mod matlab;
pub mod numbers;
pub mod poses;
pub mod profile;
pub mod scan;
pub mod trace;
mod workbook;
