//! Arguments of `armill robots`.
//!
//! A name without a subcommand shows that robot; without a name the library is listed. Options of a subcommand are not
//! valid without it.

use std::path::PathBuf;

use armill_formats::robot::format::Format;
use clap::{Args, Subcommand};

use super::writing::WritingOptions;

/// Help text of every option that accepts a robot.
pub(super) const ROBOT_HELP: &str =
    "Library name, or a robot file (.toml, .urdf, .xacro, .yaml, .dh, .chain)";

/// Most capsules around a mesh.
const MOST_CAPSULES: usize = 10;

#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "\
Examples:
  armill robots
  armill robots yaskawa/mh12
  armill robots my-arm.urdf --drawing arm.svg
  armill robots yaskawa/mh12 --drawing bodies.png --bodies
  armill robots import my-arm.urdf --out my-arm.toml
  armill robots bodies my-arm.urdf --out my-bodies.toml
  armill robots masses kuka/kr120r2500pro --total-kg 1049 --out masses.toml
  armill robots check --help"
)]
pub(crate) struct RobotsArguments {
    #[command(subcommand)]
    pub action: Option<RobotsAction>,
    #[arg(help = ROBOT_HELP)]
    pub name: Option<String>,
    /// Write a drawing of the arm to this file (.svg, .png)
    #[arg(long, value_name = "FILE", requires = "name")]
    pub drawing: Option<PathBuf>,
    /// Draw the bodies of its links, which clearances are measured to, instead of the arm
    #[arg(long, requires = "drawing")]
    pub bodies: bool,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum RobotsAction {
    /// Convert a URDF, xacro, OPW or UR file, DH table, chain or library robot to an armill robot file
    Import(ImportArguments),
    /// Enclose the links of a URDF or xacro by capsules: [[body]] tables of a robot file
    Bodies(BodiesArguments),
    /// Estimate the masses of the links from the mass of the arm and their bodies: [[mass]] tables of a robot file
    Masses(MassesArguments),
    /// Check a robot file against poses read from the pendant: report which sign, zero or base differs
    Check(RobotsCheckArguments),
}

#[derive(Debug, Args)]
#[command(after_help = "\
The extension selects the format: .urdf, .xacro, .xml; .yaml (OPW, UR calibration); .dh, .csv (Denavit-Hartenberg table); \
.chain, .fsf (elementary motions). Comments in the robot file state what was assumed and what is missing.

Examples:
  armill robots import kr120.urdf --out kr120.toml
  armill robots import yaskawa/mh12 --out mine.toml      a copy, to add backlash, masses, measured stiffness
  armill robots import m20ia_macro.xacro --tip tool0 --out m20ia.toml
  armill robots import opw_parameters_mh12.yaml > mh12.toml
  armill robots import table.txt --format dh --out arm.toml --force")]
pub(crate) struct ImportArguments {
    /// Robot file of another format, or a robot of the library
    pub file: PathBuf,
    /// Flange link of a URDF or xacro [default: the end of the chain with the most joints]
    #[arg(long, value_name = "LINK")]
    pub tip: Option<String>,
    /// Format: urdf, xacro, opw, ur, dh, chain [default: by extension and content]
    #[arg(long, value_name = "NAME")]
    pub format: Option<Format>,
    /// Robot file to write (printed on stdout if not given)
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
The collision meshes are those that the file names, in its folder. Each capsule contains its part of a mesh; accuracy_mm is a bound \
of the largest distance of its surface from the link. Joints are called as in the robot file of `armill robots import`.

Examples:
  armill robots bodies my-arm.urdf --out my-bodies.toml
  armill robots bodies my-arm.urdf --capsules 1 >> my-arm.toml")]
pub(crate) struct BodiesArguments {
    /// URDF or xacro with the collision meshes of the links
    pub file: String,
    /// Largest number of capsules for each mesh, 1 to 10
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = parse_capsules)]
    pub capsules: usize,
    /// File to write with the tables (printed on stdout if not given)
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
The mass of the arm is in the maker's data sheet. It is distributed over the links in the ratio of the volumes of their bodies, less the \
masses that the robot file already gives. The mass of a link has a standard uncertainty of 45 %: enough for frequencies of vibration \
within some 15 %, not for a calibration.

Examples:
  armill robots masses kuka/kr120r2500pro --total-kg 1049
  armill robots masses my-arm.toml --total-kg 560 --total-u-percent 5 >> my-arm.toml")]
pub(crate) struct MassesArguments {
    #[arg(help = ROBOT_HELP)]
    pub robot: String,
    /// Mass of the whole arm without its tool, kg
    #[arg(long, value_name = "KG", value_parser = parse_mass)]
    pub total_kg: f64,
    /// Standard uncertainty of this mass, per cent
    #[arg(long, value_name = "U", default_value_t = 0.0, value_parser = parse_percent)]
    pub total_u_percent: f64,
    /// File to write with the tables (printed on stdout if not given)
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// A mass, kg.
fn parse_mass(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|kg| (1e-3..=1e6).contains(kg));
    number.ok_or_else(|| "a number from 0.001 to 1e6 kg".to_owned())
}

/// A percentage.
fn parse_percent(text: &str) -> Result<f64, String> {
    let number = text
        .parse()
        .ok()
        .filter(|percent| (0.0..=100.0).contains(percent));
    number.ok_or_else(|| "a number from 0 to 100".to_owned())
}

/// A number of capsules.
fn parse_capsules(text: &str) -> Result<usize, String> {
    let number = text
        .parse()
        .ok()
        .filter(|number| (1..=MOST_CAPSULES).contains(number));
    number.ok_or_else(|| format!("a number from 1 to {MOST_CAPSULES}"))
}

#[derive(Debug, Args)]
#[command(after_help = "\
A reading is joint positions, `=`, and the pose that the pendant shows for them: X,Y,Z in mm and the orientation, which \
is A,B,C (kuka), W,P,R (fanuc) or Rx,Ry,Rz (yaskawa, staubli) in degrees, the quaternion q1,q2,q3,q4 (abb), or the \
rotation vector in rad (ur).
Read two or three poses with every joint well away from 0 and 90 deg, in the base or world frame of the robot and with \
tool 0 selected.

Examples:
  armill robots check yaskawa/mh12 --convention yaskawa --pose \"10,20,-30,40,50,60 = 991.88,224.90,203.74,96.64,-5.38,129.09\"")]
pub(crate) struct RobotsCheckArguments {
    #[arg(help = ROBOT_HELP)]
    pub robot: String,
    /// A reading of the pendant: joints = pose (repeatable)
    #[arg(
        long,
        value_name = "J1,... = X,Y,Z,...",
        required = true,
        allow_hyphen_values = true
    )]
    pub pose: Vec<String>,
    /// Manufacturer of the pendant: kuka, abb, fanuc, yaskawa, staubli, ur
    #[arg(long, value_name = "MAKER")]
    pub convention: String,
    /// Flange to TCP of the tool active on the pendant
    #[arg(
        long,
        value_name = "X,Y,Z[,RX,RY,RZ]",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub tool_mm: Option<Vec<f64>>,
    /// Frame to which the readings are expected to be relative
    #[arg(long, value_name = "FRAME", default_value = armill_study::BASE_LINK)]
    pub base: String,
    /// Maximum difference of the position at which a reading agrees
    #[arg(long, value_name = "D", default_value_t = 1.0, allow_hyphen_values = true)]
    pub within_mm: f64,
    /// Maximum difference of the orientation at which a reading agrees
    #[arg(long, value_name = "A", default_value_t = 0.1, allow_hyphen_values = true)]
    pub within_deg: f64,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
