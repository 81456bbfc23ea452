//! Foreign text and tables in and out of armill.
//!
//! - [`document`]: a TOML file that is checked completely and reports all its problems at once,
//!   each with its place, its limit and a hint.
//! - [`robot`]: robot descriptions in, of seven formats, and out, of six; readings of pendants.
//! - [`controller`]: how a cell writes its robot programs.
//! - [`motion`]: how a controller moves an arm.
//! - [`convention`]: poses as six makers write them.
//! - [`modal`]: modes of vibration at the tip of a cutter: our file of modal data; [`tool_assembly`]: holder and cutter as beams.
//! - [`material`]: what materials take to cut: our material file.
//! - [`sources`]: where the numbers of these files come from.
//! - [`table`]: columns of results as CSV, Parquet and VTK.
//! - [`toolpath`]: tool path programs in.
//! - [`language`]: the languages of robot controllers, and how to recognise them.
//! - [`mesh`]: triangle meshes in, of five formats; [`surface`]: coloured surfaces with values out, in four formats.
//! - [`measurement`]: records of forces, tables of load tests, points of round profiles and circular tests in.
//! - [`file`](mod@file): files that are written: whole or not at all, never over what is not ours.
//! - [`input`]: files that are read: which ones, how far.
//! - [`visible`](mod@visible): text for a terminal, without characters that control it.
//!
//! `xml` is the ground of all that is XML.
//!
//! Nothing in this crate prints, except the panic message of Rust if a fault of the crates `parquet` and `xacro-rs`
//! is caught and reported as a problem of the file. Same input, same bytes.

pub mod controller;
pub mod convention;
pub mod document;
pub mod file;
pub mod input;
pub mod language;
pub mod material;
pub mod measurement;
pub mod mesh;
pub mod modal;
pub mod motion;
pub mod robot;
pub mod sources;
pub mod surface;
pub mod table;
pub mod tool_assembly;
pub mod toolpath;
pub mod visible;

mod xml;
