//! Arguments of `armill frf`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
A file is a universal file (dataset 58 or 58b) or a table with frequency_hz and receptance_real_um_per_n, receptance_imag_um_per_n (or mobility, \
accelerance; magnitude and phase_deg), and response, reference (1X, 12-Y). One FRF has its force and its response at the same point in the \
same direction. Guide: docs/guide/stability.md

Examples:
  armill frf tap-x.uff tap-y.uff
  armill frf tap.csv --band-hz 300,4000 --out modes.toml --drawing tap.svg
  armill frf tap.uff --axes X=x,Y=-z
  armill frf tap.uff --modes 3 --json")]
pub(crate) struct FrfArguments {
    /// Files of frequency response functions (UFF 58, CSV)
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// Band of the fit [default: that of the FRFs]
    #[arg(long, value_name = "LOW,HIGH", value_delimiter = ',')]
    pub band_hz: Option<Vec<f64>>,
    /// Number of modes [default: as many as the FRFs determine]
    #[arg(long, value_name = "N")]
    pub modes: Option<usize>,
    /// Point of the tip [default: the only drive point]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub point: Option<i64>,
    /// Measured axes as directions of the feed: x along the feed, y to its left, z from part to spindle
    #[arg(
        long,
        value_name = "X=x,Y=y",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub axes: Option<Vec<String>>,
    /// Draw measured and fitted FRFs into this file, SVG or PNG
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    /// Write the modes to this file of modal data (TOML)
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
