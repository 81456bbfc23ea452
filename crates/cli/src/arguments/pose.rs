//! Arguments of `armill pose`.
//!
//! The pose of the tool is given in one of two ways, which exclude each other: `--joints-deg`, or `--at-mm` with the
//! orientation of the tool (`--axis` or `--tilt-deg`, `--spin-deg`) and the preferred positions of redundant joints
//! (`--home-deg`). Without a load the result has no deviation, without compliances neither deviation nor
//! compliance.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

/// What ROBOT may be.
const ROBOT_OR_STUDY_HELP: &str = "Library robot (see `armill robots`), robot file, or a study: then with its tool, its model and the bodies of its cell";

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Joints have the signs and zeros of the robot file. Positions are relative to base_link unless --base is given.
--tool-mm is flange to TCP in the flange frame (z out of the flange): X,Y,Z in mm and RX,RY,RZ in degrees, about the \
fixed axes x, y, z.
--tilt-deg points the tool against the outward normal of a plane that is tilted from the vertical about base y.
At 0 the plane faces the robot (tool along +x, the default), at 90 it faces up (tool down).
In the place of ROBOT a study (its folder or file) adds its tool, its model and the clearance to the bodies of its cell.

Examples:
  armill pose yaskawa/mh12 --joints-deg 0,11.6,-27.8,0,39.4,0
  armill pose yaskawa/mh12 --at-mm 1000,0,800 --tilt-deg 90 --tool-mm 0,0,150 --wrench-n 3,5,5
  armill pose arm.urdf --at-mm 900,0,700 --compliance-rad-per-n-m 1e-6,1e-6,2e-6,1e-5,1e-5,3e-5 --wrench-n 0,0,-50 --json
  armill pose cell --at-mm 1000,0,800 --tilt-deg 90
  armill pose kuka/kr16-2 --at-mm 1000,0,900 --compliance-class light --wrench-n 0,0,-50"
)]
pub(crate) struct PoseArguments {
    #[arg(help = ROBOT_OR_STUDY_HELP)]
    pub robot: String,
    /// Joint positions A,B,... in degrees (mm for prismatic joints)
    #[arg(
        long,
        value_name = "A,B,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        conflicts_with = "at_mm"
    )]
    pub joints_deg: Option<Vec<f64>>,
    /// Position of the TCP
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        allow_hyphen_values = true,
        required_unless_present = "joints_deg"
    )]
    pub at_mm: Option<Vec<f64>>,
    /// Tilt of the plane to which the tool is perpendicular
    #[arg(long, value_name = "A", allow_hyphen_values = true, requires = "at_mm", conflicts_with_all = ["axis", "joints_deg"])]
    pub tilt_deg: Option<f64>,
    /// Tool axis, from the spindle towards the part
    #[arg(
        long,
        value_name = "x,y,z",
        value_delimiter = ',',
        allow_hyphen_values = true,
        requires = "at_mm",
        conflicts_with = "joints_deg"
    )]
    pub axis: Option<Vec<f64>>,
    /// Spin of the tool about its axis; at 0 the y axis of the tool is as close as possible to base y
    #[arg(
        long,
        value_name = "S",
        allow_hyphen_values = true,
        requires = "at_mm",
        conflicts_with = "joints_deg"
    )]
    pub spin_deg: Option<f64>,
    /// Rail position (mm), preferred positions of redundant joints (deg), one value per joint [default: mid-range]
    #[arg(
        long,
        value_name = "A,B,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        requires = "at_mm",
        conflicts_with = "joints_deg"
    )]
    pub home_deg: Option<Vec<f64>>,
    /// Flange to TCP
    #[arg(
        long,
        value_name = "X,Y,Z[,RX,RY,RZ]",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub tool_mm: Option<Vec<f64>>,
    /// Force (N) and moment (N m) on the tool at the TCP, in base axes
    #[arg(
        long,
        value_name = "FX,FY,FZ[,MX,MY,MZ]",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub wrench_n: Option<Vec<f64>>,
    /// Joint compliances in place of those of the robot file (m/N for prismatic joints)
    #[arg(
        long,
        value_name = "C1,...",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub compliance_rad_per_n_m: Option<Vec<f64>>,
    /// Assumed joint compliances by payload: light (to 20 kg), medium (to 100 kg), heavy (to 300 kg)
    #[arg(long, value_name = "CLASS", conflicts_with = "compliance_rad_per_n_m")]
    pub compliance_class: Option<String>,
    /// Apply the load to the deflected arm (force-deflection equilibrium) instead of the undeflected one
    #[arg(long)]
    pub load_dependent: bool,
    /// Joint positions at which the tool was measured, the reference for gravity (needs masses in the robot file)
    #[arg(
        long,
        value_name = "A,B,...",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub reference_joints_deg: Option<Vec<f64>>,
    /// Write a drawing of the arm to this file (.svg, .png): the first posture within joint limits, others faint
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    /// Frame to which positions are relative [default: base_link, or that of the study]
    #[arg(long, value_name = "FRAME")]
    pub base: Option<String>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
