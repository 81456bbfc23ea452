//! `armill compensate STUDY`: the paths that must be commanded so that the tool goes where it is drawn.
//!
//! A program of a robot alone lacks robot, tool and load: it is compensated through a study that follows it.

use std::path::PathBuf;

use clap::Args;

use super::program::ProgramOptions;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill compensate cell                   every path of the study, into cell/compensated
  armill compensate cell --analysis ring --out fixed
  armill compensate cell --analysis ring --program ring.src --frame 3 --tool 2
  armill compensate cell --analysis ring --nominal --program first.src --feed-mm-per-min 1000
The ending of --program is the language: .src KUKA, .mod ABB, .jbi Yaskawa, .ls FANUC, .script UR, .pjx Staubli.
A path that follows a program of a robot (program = { file = \"part.src\" }) brings that program too, under its own name, with
its targets moved and every other byte as it was. A program alone tells no robot and no load: put it into a study.
The table NAME.commanded.csv is a path that `program.file` of a study reads, with spin = \"given\".")]
pub(crate) struct CompensateArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study
    pub study: PathBuf,
    /// The path to compensate, by its name (every path if left out)
    #[arg(long, value_name = "NAME")]
    pub analysis: Option<String>,
    /// Folder for the results (STUDY/compensated if left out)
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Make up for nothing: the path as it is drawn, such as a first circle of a ball-bar
    #[arg(long)]
    pub nominal: bool,
    #[command(flatten)]
    pub program: ProgramOptions,
    /// Speed of the tip where the path tells none
    #[arg(long, value_name = "MM/MIN")]
    pub feed_mm_per_min: Option<f64>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the answer as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
