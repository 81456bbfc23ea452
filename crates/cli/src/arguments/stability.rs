//! Arguments of `armill stability`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
The cut is that of `[cut]` of the study: cutter, material, depths, side. A file of modal data has the modes of vibration at the tip of the
cutter: frequency, damping, direction, modal mass or stiffness. Guide: docs/guide/stability.md

Examples:
  armill stability studies/r2000ic-pocket --modes modes.toml --spindle-rpm 12000 --feed-mm-per-min 1800
  armill stability cell --modes modes.toml --speeds-rpm 6000,18000 --drawing lobes.svg
  armill stability cell --modes modes.toml --json")]
pub(crate) struct StabilityArguments {
    /// Study folder or study file with a path and its cut
    pub study: PathBuf,
    /// File of modal data of the tool (TOML)
    #[arg(long, value_name = "FILE")]
    pub modes: Option<PathBuf>,
    /// Posture whose modes of the arm are added; the arm needs masses
    #[arg(
        long,
        value_name = "Q1,Q2,...",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub joints_deg: Option<Vec<f64>>,
    /// Point of the path with the feed direction for this posture, from 1
    #[arg(long, value_name = "N", default_value_t = 1, requires = "joints_deg")]
    pub point: usize,
    /// Name of the path [default: the first with a cut]
    #[arg(long, value_name = "NAME")]
    pub path: Option<String>,
    /// Spindle speed, in place of that of the study
    #[arg(long, value_name = "N")]
    pub spindle_rpm: Option<f64>,
    /// Feed, in place of that of the study
    #[arg(long, value_name = "F")]
    pub feed_mm_per_min: Option<f64>,
    /// Axial depth of cut, in place of that of the study
    #[arg(long, value_name = "AP")]
    pub depth_mm: Option<f64>,
    /// Spindle speeds of the lobes [default: half to twice the spindle speed]
    #[arg(long, value_name = "LOW,HIGH", value_delimiter = ',')]
    pub speeds_rpm: Option<Vec<f64>>,
    /// Deepest limit that is sought [default: twice the diameter of the cutter]
    #[arg(long, value_name = "AP")]
    pub deepest_mm: Option<f64>,
    /// Draw the lobes into this file, SVG or PNG
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
