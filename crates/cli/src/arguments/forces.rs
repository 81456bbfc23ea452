//! What can be typed behind `armill forces`.
//!
//! `--columns` and `--rate-hz` are for a CSV, `--channels` and `--cycle` for an export of DynoWare. `--air-s`
//! stays text until `command::forces` reads it, since clap would take its two numbers for two stretches.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
FILE is a text export of DynoWare, or a CSV whose names end in units (time_s,fx_n,fy_n,fz_n). The guide:
docs/guide/measured-forces.md

Examples:
  armill forces groove.txt
  armill forces groove.txt --air-s 0,0.5 --air-s 9.2,10 --low-pass-hz 50 --out groove
  armill forces groove.csv --spindle-rpm 9000 --json"
)]
pub(crate) struct ForcesArguments {
    /// Record of the forces
    pub file: PathBuf,
    /// A stretch where nothing is cut, from when to when, once a stretch (the quietest ones if left out)
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true)]
    pub air_s: Vec<String>,
    /// Leave the drift in
    #[arg(long, conflicts_with = "air_s")]
    pub no_drift: bool,
    /// Keep only what is slower than this
    #[arg(long, value_name = "F")]
    pub low_pass_hz: Option<f64>,
    /// Speed of the spindle: mean and extremes of each turn
    #[arg(long, value_name = "N")]
    pub spindle_rpm: Option<f64>,
    /// Cycle of an export that holds several, from 1
    #[arg(long, value_name = "N")]
    pub cycle: Option<usize>,
    /// What an export calls its forces, and its moments if it has any
    #[arg(long, value_name = "FX,FY,FZ[,MX,MY,MZ]", value_delimiter = ',')]
    pub channels: Option<Vec<String>>,
    /// Samples a second, of a CSV without column of time
    #[arg(long, value_name = "F", conflicts_with = "channels")]
    pub rate_hz: Option<f64>,
    /// Columns in order, of a CSV without header: time_s,fx_n,...
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        conflicts_with = "channels"
    )]
    pub columns: Option<Vec<String>>,
    /// Write tables and pictures into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
