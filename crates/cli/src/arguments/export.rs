//! Arguments of `armill export`.

use std::path::PathBuf;

use armill_formats::robot::export::{DhConvention, ExportFormat};
use clap::{Args, ValueEnum};

use super::robots::ROBOT_HELP;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Formats: urdf; xacro (macros, and the pose of each joint in a YAML file next to them); ur (calibration file of \
ur_description); dh (Denavit-Hartenberg table, CSV); sdf; mjcf (MuJoCo). Calibrated geometry is in all of them, stiffness in \
sdf and mjcf. Joint positions are those of the robot file. Warnings name what a format does not express. Guide: docs/guide/export.md

Examples:
  armill export yaskawa/mh12 --out mh12.urdf
  armill export calibrated.toml --out arm.xacro
  armill export universal-robots/ur10e --out my_robot_calibration.yaml
  armill export calibrated.toml --format dh --convention hayati > arm.csv
  armill export yaskawa/mh12 --stiffness passive --out mh12.sdf
  armill export yaskawa/mh12 --stiffness joints --joints-deg 0,0,0,0,-90,0 --format mjcf --out mh12.xml"
)]
pub(crate) struct ExportArguments {
    #[arg(help = ROBOT_HELP)]
    pub robot: String,
    /// Format: urdf, xacro, ur, dh, sdf, mjcf [default: by the extension of --out]
    #[arg(long, value_name = "NAME")]
    pub format: Option<ExportFormat>,
    /// File to write (printed on stdout if not given)
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Coupled joints: own (the angle between the links) or mimic (a further joint that follows; urdf, xacro, sdf) [default: refused]
    #[arg(long, value_name = "HOW")]
    pub coupling: Option<CouplingArgument>,
    /// Write the compliance: passive (a spring joint behind each drive) or joints (each joint is a spring at --joints-deg)
    #[arg(long, value_name = "HOW")]
    pub stiffness: Option<StiffnessArgument>,
    /// Joint positions A,B,... in degrees (mm for prismatic joints) that springs keep without load
    #[arg(
        long,
        value_name = "A,B,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        requires = "stiffness"
    )]
    pub joints_deg: Option<Vec<f64>>,
    /// Convention of a DH table: standard, modified, hayati [default: standard]
    #[arg(long, value_name = "NAME")]
    pub convention: Option<DhConvention>,
    /// Joint compliances in place of those of the robot file (m/N for prismatic joints)
    #[arg(
        long,
        value_name = "C1,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        requires = "stiffness"
    )]
    pub compliance_rad_per_n_m: Option<Vec<f64>>,
    /// Assumed joint compliances by payload: light (to 20 kg), medium (to 100 kg), heavy (to 300 kg)
    #[arg(
        long,
        value_name = "CLASS",
        conflicts_with = "compliance_rad_per_n_m",
        requires = "stiffness"
    )]
    pub compliance_class: Option<String>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// How coupled joints are written.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum CouplingArgument {
    /// The angle between the links.
    Own,
    /// A further joint that follows.
    Mimic,
}

/// How the compliance is written.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum StiffnessArgument {
    /// A spring joint behind each drive.
    Passive,
    /// Each joint is a spring.
    Joints,
}
