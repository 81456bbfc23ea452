//! What can be typed behind `armill`.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;

/// How far from the drawing will this robot cut, why, and what can be done about it?
#[derive(Debug, Parser)]
#[command(name = "armill", version, propagate_version = true, arg_required_else_help = true, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

const EXAMPLES: &str = "\
Examples:
  armill run studies/mh12-groove            the paper's study, with pictures and a report in its folder out/
  armill new cell && armill run cell        your own, from a commented study file
  armill pose yaskawa/mh12 --at-mm 1000,0,800 --wrench-n 3,5,5
Lengths in mm, angles in degrees, forces in N, moments in N m; deviations come back in micrometres.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a study: numbers, tables, pictures and a report
    Run(RunArguments),
    /// Check a study file without running it
    Check(CheckArguments),
    /// Make a folder with a commented study that runs
    New(NewArguments),
    /// List the robot library, or show one robot
    Robots(RobotsArguments),
    /// Every posture of one pose: joints, compliance, deviation
    Pose(Box<PoseArguments>),
    /// Print shell completions
    Completions(CompletionsArguments),
}

impl Command {
    pub(crate) fn wants_json(&self) -> bool {
        match self {
            Command::Run(a) => a.json,
            Command::Check(a) => a.json,
            Command::New(a) => a.json,
            Command::Robots(a) => a.json,
            Command::Pose(a) => a.json,
            Command::Completions(_) => false,
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill run studies/mh12-groove
  armill run cell/study.toml --out results --no-pictures
  armill run cell --json --strict && echo \"the tolerance holds everywhere\"")]
pub(crate) struct RunArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study
    pub study: PathBuf,
    /// Folder for the results (STUDY/out if left out)
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write tables only: no pictures, no report
    #[arg(long)]
    pub no_pictures: bool,
    /// Write a CSV of series and volumes too, not of maps and paths only
    #[arg(long)]
    pub csv: bool,
    /// Threads to use (all processors if left out)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Exit with 1 unless every point holds the tolerance
    #[arg(long)]
    pub strict: bool,
    /// Print the whole result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill check cell                  every problem of cell/study.toml at once
  armill check --schema > study.schema.json   JSON Schema, for your editor")]
pub(crate) struct CheckArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study
    #[arg(required_unless_present = "schema")]
    pub study: Option<PathBuf>,
    /// Print the JSON Schema of the study file instead
    #[arg(long)]
    pub schema: bool,
    /// Print problems as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill new cell
  armill new cell --robot kuka/kr120r2500pro")]
pub(crate) struct NewArguments {
    /// Folder to make
    pub dir: PathBuf,
    /// Library name, or a robot file (.toml, .urdf)
    #[arg(long, value_name = "NAME", default_value = "yaskawa/mh12")]
    pub robot: String,
    /// Print what was made as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill robots
  armill robots yaskawa/mh12
  armill robots my-arm.urdf --drawing arm.svg")]
pub(crate) struct RobotsArguments {
    /// Library name, or a robot file (.toml, .urdf)
    pub name: Option<String>,
    /// Write a drawing of the arm to this file (.svg, .png)
    #[arg(long, value_name = "FILE", requires = "name")]
    pub drawing: Option<PathBuf>,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Joints are in the robot file's own signs and zeros. Heights count from base_link unless --base says otherwise.
--tool-mm is flange to TCP in the flange frame (z out of the flange), turns about the fixed axes x, y, z.
--tilt-deg puts the tool against the outward normal of a plane tilted from the vertical about base y:
0 faces the robot (tool along +x, the default), 90 faces up (tool down).

Examples:
  armill pose yaskawa/mh12 --joints-deg 0,11.6,-27.8,0,39.4,0
  armill pose yaskawa/mh12 --at-mm 1000,0,800 --tilt-deg 90 --tool-mm 0,0,150 --wrench-n 3,5,5
  armill pose arm.urdf --at-mm 900,0,700 --compliance-rad-per-n-m 1e-6,1e-6,2e-6,1e-5,1e-5,3e-5 --wrench-n 0,0,-50 --json"
)]
pub(crate) struct PoseArguments {
    /// Library name, or a robot file (.toml, .urdf)
    pub robot: String,
    /// Joint positions A,B,... in degrees (mm for sliding joints)
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
    /// Tilt of the plane that the tool stands against
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
    /// Turn of the tool about its axis; at 0 its second axis lies as near as possible to base y
    #[arg(
        long,
        value_name = "S",
        allow_hyphen_values = true,
        requires = "at_mm",
        conflicts_with = "joints_deg"
    )]
    pub spin_deg: Option<f64>,
    /// Flange to TCP
    #[arg(
        long,
        value_name = "X,Y,Z[,RX,RY,RZ]",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub tool_mm: Option<Vec<f64>>,
    /// Force and moment on the tool at the TCP, base axes, N and N m
    #[arg(
        long,
        value_name = "FX,FY,FZ[,MX,MY,MZ]",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub wrench_n: Option<Vec<f64>>,
    /// Joint compliances in place of the robot file's
    #[arg(
        long,
        value_name = "C1,...",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub compliance_rad_per_n_m: Option<Vec<f64>>,
    /// Let the load act on the arm as it has yielded, instead of as it stood
    #[arg(long)]
    pub load_dependent: bool,
    /// Joint positions where the tool was set: gravity counts against them (needs masses in the robot file)
    #[arg(
        long,
        value_name = "A,B,...",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub reference_joints_deg: Option<Vec<f64>>,
    /// Write a drawing of the arm there to this file (.svg, .png): the first posture inside limits, the others faintly
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    /// Frame that positions count from
    #[arg(long, value_name = "FRAME", default_value = armill_study::BASE_LINK)]
    pub base: String,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill completions bash > /etc/bash_completion.d/armill
  armill completions fish > ~/.config/fish/completions/armill.fish")]
pub(crate) struct CompletionsArguments {
    /// Which shell
    pub shell: Shell,
}
