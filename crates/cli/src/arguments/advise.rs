//! `armill advise STUDY`: measures that bring a path within its tolerance.

use clap::Args;

use super::place::PlaceOptions;
use super::program::ProgramOptions;
use super::run::RunOptions;

#[derive(Debug, Args)]
#[command(after_help = ADVISE_EXAMPLES)]
pub(crate) struct AdviseArguments {
    #[command(flatten)]
    pub run: RunOptions,

    #[command(flatten)]
    pub place: PlaceOptions,

    #[command(flatten)]
    pub program: ProgramOptions,
}

const ADVISE_EXAMPLES: &str = "\
Examples:
  armill advise cell                               the part may move by up to 300 mm in each direction
  armill advise cell --x-mm 700,1300 --tilt-deg 0,90 --branch any
  armill advise cell --analysis rim --json
The results are those of `armill run` with all recommended measures. They are written to the folder `advice`, with \
advice.json; the folder `advised` next to it has the study as advised, the path to command, and a table of the steps.";
