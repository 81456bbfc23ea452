//! Arguments of `armill path-accuracy`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Files have one row per point (x_mm, y_mm, z_mm), in time order and in the same axes; a column `run` separates several \
runs in one file. Guide: docs/guide/calibrate.md

Examples:
  armill path-accuracy tracker.csv --commanded path.csv
  armill path-accuracy tracker.txt
  armill path-accuracy run1.csv run2.csv run3.csv --commanded path.csv --points points.csv --drawing path.svg")]
pub(crate) struct PathAccuracyArguments {
    /// Measured runs (CSV, or an export of SpatialAnalyzer)
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// The commanded path (CSV); without it the repeatability of the measured passes is evaluated
    #[arg(long, value_name = "FILE")]
    pub commanded: Option<PathBuf>,
    /// Write the results at every commanded point to this file (CSV)
    #[arg(long, value_name = "FILE", requires = "commanded")]
    pub points: Option<PathBuf>,
    /// Write a drawing of accuracy and repeatability along the path to this file (.svg, .png)
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
