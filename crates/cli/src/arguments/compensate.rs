//! `armill compensate STUDY`: compensated paths, commanded so that the tool follows the nominal path.
//!
//! A robot program alone lacks robot, tool and load: it is compensated through a study that refers to it.

use std::path::PathBuf;

use clap::Args;

use super::program::ProgramOptions;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill compensate cell                   all paths of the study, into cell/compensated
  armill compensate cell --analysis ring --out compensated
  armill compensate cell --analysis ring --program ring.src --frame 3 --tool 2
  armill compensate cell --analysis ring --nominal --program first.src --feed-mm-per-min 1000
The extension of --program selects the language: .src KUKA, .mod ABB, .jbi Yaskawa, .ls FANUC, .script UR, .pjx Staubli.
For a path from a robot program (program = { file = \"part.src\" }), that program is also written, under its own name:
only its targets are changed. A program alone does not define robot and load: refer to it in a study.
The table NAME.commanded.csv can be used as `program.file` of a study, with spin = \"given\".")]
pub(crate) struct CompensateArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study
    pub study: PathBuf,
    /// Name of the path to compensate [default: all paths]
    #[arg(long, value_name = "NAME")]
    pub analysis: Option<String>,
    /// Folder for the results [default: STUDY/compensated]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write the nominal path without compensation (for a baseline test)
    #[arg(long)]
    pub nominal: bool,
    /// Compensate only what shows on the surface of the part (`machined_part` of the path), and leave the rest
    #[arg(long, conflicts_with = "nominal")]
    pub surface: bool,
    #[command(flatten)]
    pub program: ProgramOptions,
    /// Feed, if the path does not specify one
    #[arg(long, value_name = "MM/MIN")]
    pub feed_mm_per_min: Option<f64>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
