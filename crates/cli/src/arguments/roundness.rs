//! Arguments of `armill roundness`.
//!
//! `--unit` and `--radius-mm` give what a file does not contain; `--upr` and `--harmonics` are settings of the
//! evaluation.

use std::path::PathBuf;

use armill_formats::measurement::profile::LengthUnit;
use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
A file is a table whose column names end in units (x_mm,y_mm or x_mm,y_mm,z_mm or angle_deg,radius_mm), or, with --unit, \
rows of numbers without column names. Guide: docs/guide/roundness.md

Examples:
  armill roundness bore.csv
  armill roundness bore.csv --upr 50 --out bore
  armill roundness deviations.csv --radius-mm 25 --json
  armill roundness cir2d1.ds --unit mm"
)]
pub(crate) struct RoundnessArguments {
    /// Points of the profiles, one file per profile
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// Cut-off of the Gaussian filter in undulations per revolution [default: no filter]
    #[arg(long, value_name = "N")]
    pub upr: Option<u32>,
    /// Number of harmonics to report, from 1
    #[arg(long, value_name = "N", default_value_t = 15)]
    pub harmonics: usize,
    /// Nominal radius, for a table of angles and deviations
    #[arg(long, value_name = "R")]
    pub radius_mm: Option<f64>,
    /// Unit of rows without column names: mm, um, m or in
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<LengthUnit>,
    /// Write tables and pictures into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
