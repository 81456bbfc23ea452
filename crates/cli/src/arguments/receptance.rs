//! Arguments of `armill receptance`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Holder and cutter are beams, coupled to the modes of an arm in a posture, to modes measured at the spindle nose (--modes), or to a rigid \
nose (--rigid). Results are in the feed frame: x along the feed, y to its left, z from part to spindle. --nose-mm is flange to \
spindle nose in the flange frame, X,Y,Z in mm and RX,RY,RZ in degrees; the tool points along z of the nose. Guide: docs/guide/receptance.md

Examples:
  armill receptance arm.toml --joints-deg 0,-20,-100,0,40,0 --nose-mm 0,0,250 --assembly cutter.toml
  armill receptance --modes nose.toml --assembly cutter.toml --frequencies-hz 50,5000 --drawing tip.svg
  armill receptance --rigid --assembly cutter.toml --modal-out modes.toml"
)]
pub(crate) struct ReceptanceArguments {
    /// Library robot, robot file, or a study: then with the springs and masses of its tool as those of the spindle
    pub robot: Option<String>,
    /// File of the tool assembly: holder and cutter (TOML)
    #[arg(long, value_name = "FILE", required = true)]
    pub assembly: PathBuf,
    /// Joint positions A,B,... in degrees (mm for prismatic joints)
    #[arg(
        long,
        value_name = "A,B,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        requires = "robot"
    )]
    pub joints_deg: Option<Vec<f64>>,
    /// Flange to spindle nose [default: the flange]
    #[arg(
        long,
        value_name = "X,Y,Z[,RX,RY,RZ]",
        value_delimiter = ',',
        allow_hyphen_values = true,
        requires = "robot"
    )]
    pub nose_mm: Option<Vec<f64>>,
    /// Joint compliances in place of those of the robot file (m/N for prismatic joints)
    #[arg(
        long,
        value_name = "C1,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        requires = "robot"
    )]
    pub compliance_rad_per_n_m: Option<Vec<f64>>,
    /// Assumed joint compliances by payload: light (to 20 kg), medium (to 100 kg), heavy (to 300 kg)
    #[arg(
        long,
        value_name = "CLASS",
        conflicts_with = "compliance_rad_per_n_m",
        requires = "robot"
    )]
    pub compliance_class: Option<String>,
    /// Damping ratio of every mode of the arm, in place of the damping of the robot file
    #[arg(long, value_name = "Z", requires = "robot")]
    pub damping_ratio: Option<f64>,
    /// File of modal data of the spindle nose, in the place of a robot (TOML)
    #[arg(long, value_name = "FILE", conflicts_with_all = ["robot", "rigid"])]
    pub modes: Option<PathBuf>,
    /// A rigid spindle nose, in the place of a robot
    #[arg(long, conflicts_with = "robot")]
    pub rigid: bool,
    /// Angle of the feed about the axis of the nose, from its x axis
    #[arg(long, value_name = "A", default_value_t = 0.0, allow_hyphen_values = true)]
    pub feed_deg: f64,
    /// Lowest and highest frequency, and how many [default: 5,5000,400]
    #[arg(
        long,
        value_name = "LOW,HIGH[,COUNT]",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub frequencies_hz: Option<Vec<f64>>,
    /// Write the receptances by forces to this table (CSV), which `armill frf` reads
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write the modes of the tip to this file of modal data (TOML), for `armill stability --modes`
    #[arg(long, value_name = "FILE")]
    pub modal_out: Option<PathBuf>,
    /// Draw magnitude and phase into this file, SVG or PNG
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
