//! Which force was measured? Records over time in.
//!
//! - [`dynoware`]: text exports of Kistler's DynoWare.
//! - [`csv`]: any other table with a column for each channel.
//! - [`known`]: either, whichever the file is.
//!
//! All give a [`Record`](armill_core::load::Record) in the axes of the sensor. Whether it acts on the tool or on the part,
//! and how the sensor stands, no file tells: the caller says it.
//!
//! `columns`: what a column holds, in which unit; samples as they come.

mod columns;
pub mod csv;
pub mod dynoware;
pub mod known;
