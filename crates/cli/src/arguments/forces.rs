//! Arguments of `armill forces`.
//!
//! `--columns` and `--rate-hz` are for a CSV, `--channels` and `--cycle` for a DynoWare export. `--air-s` is text
//! until `command::forces` reads it, because clap would read its two numbers as two intervals.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
FILE is a DynoWare text export, or a CSV whose column names end in units (time_s,fx_n,fy_n,fz_n).
Guide: docs/guide/measured-forces.md

Examples:
  armill forces groove.txt
  armill forces groove.txt --air-s 0,0.5 --air-s 9.2,10 --low-pass-hz 50 --out groove
  armill forces groove.csv --spindle-rpm 9000 --json"
)]
pub(crate) struct ForcesArguments {
    /// Force record
    pub file: PathBuf,
    /// Interval without cutting, in seconds (repeatable) [default: the quietest intervals]
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true)]
    pub air_s: Vec<String>,
    /// Do not remove the drift
    #[arg(long, conflicts_with = "air_s")]
    pub no_drift: bool,
    /// Cut-off frequency of the low-pass filter [default: no filter]
    #[arg(long, value_name = "F")]
    pub low_pass_hz: Option<f64>,
    /// Spindle speed, to report mean and extremes per revolution
    #[arg(long, value_name = "N")]
    pub spindle_rpm: Option<f64>,
    /// Number of the cycle, from 1, for an export with several cycles
    #[arg(long, value_name = "N")]
    pub cycle: Option<usize>,
    /// Channel names of the forces in the export, and of the moments if present
    #[arg(long, value_name = "FX,FY,FZ[,MX,MY,MZ]", value_delimiter = ',')]
    pub channels: Option<Vec<String>>,
    /// Sampling rate, for a CSV without a time column
    #[arg(long, value_name = "F", conflicts_with = "channels")]
    pub rate_hz: Option<f64>,
    /// Column names in order, for a CSV without a header: time_s,fx_n,...
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
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
