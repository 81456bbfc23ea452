//! Arguments of `armill stability`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
The cut is that of `[cut]` of the study: cutter, material, depths, side; or that of the options, without a study. A file of modal data has the modes of vibration at the tip of the \
cutter: frequency, damping, direction, modal mass or stiffness. Guide: docs/guide/stability.md

Examples:
  armill stability studies/r2000ic-pocket --modes modes.toml --spindle-rpm 12000 --feed-mm-per-min 1800
  armill stability cell --modes modes.toml --speeds-rpm 6000,18000 --drawing lobes.svg
  armill stability cell --modes modes.toml --json
  armill stability --modes modes.toml --material aluminium-7075-t6 --cutter-diameter-mm 10 --teeth 2 --side down --radial-mm 3 --depth-mm 2 --spindle-rpm 12000 --feed-mm-per-min 1800")]
pub(crate) struct StabilityArguments {
    /// Study folder or study file with a path and its cut [default: the cut of the options]
    pub study: Option<PathBuf>,
    #[command(flatten)]
    pub cut: CutOptions,
    /// File of modal data of the tool (TOML)
    #[arg(long, value_name = "FILE")]
    pub modes: Option<PathBuf>,
    /// Posture whose modes of the arm are added; the arm needs masses
    #[arg(
        long,
        value_name = "Q1,Q2,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        requires = "study"
    )]
    pub joints_deg: Option<Vec<f64>>,
    /// Point of the path with the feed direction for this posture, from 1
    #[arg(long, value_name = "N", default_value_t = 1, requires = "joints_deg")]
    pub point: usize,
    /// Name of the path [default: the first with a cut]
    #[arg(long, value_name = "NAME", requires = "study")]
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

/// A cut without a study.
#[derive(Debug, Args)]
pub(crate) struct CutOptions {
    /// Without a study: material of the library (`armill materials`)
    #[arg(
        long,
        value_name = "NAME",
        conflicts_with = "study",
        required_unless_present = "study"
    )]
    pub material: Option<String>,
    /// Without a study: diameter of the cutter
    #[arg(
        long,
        value_name = "D",
        conflicts_with = "study",
        required_unless_present = "study"
    )]
    pub cutter_diameter_mm: Option<f64>,
    /// Without a study: number of teeth
    #[arg(
        long,
        value_name = "N",
        conflicts_with = "study",
        required_unless_present = "study"
    )]
    pub teeth: Option<u32>,
    /// Without a study: helix of the cutter, negative is left-hand [default: 30]
    #[arg(
        long,
        value_name = "ANGLE",
        conflicts_with = "study",
        allow_hyphen_values = true
    )]
    pub helix_deg: Option<f64>,
    /// Without a study: radius of the corner of the cutter; half the diameter is a ball [default: 0]
    #[arg(long, value_name = "R", conflicts_with = "study")]
    pub corner_radius_mm: Option<f64>,
    /// Without a study: side of the feed on which the part is: up, down, centred or slot [default: slot without --radial-mm]
    #[arg(
        long,
        value_name = "SIDE",
        conflicts_with = "study",
        required_unless_present = "study"
    )]
    pub side: Option<String>,
    /// Without a study: radial depth of cut; a slot has none
    #[arg(long, value_name = "AE", conflicts_with = "study")]
    pub radial_mm: Option<f64>,
}
