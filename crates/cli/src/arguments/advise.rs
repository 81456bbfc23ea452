//! `armill advise STUDY`: what to do so that a path holds its tolerance.

use clap::Args;

use super::place::PlaceOptions;
use super::run::RunOptions;

#[derive(Debug, Args)]
#[command(after_help = ADVISE_EXAMPLES)]
pub(crate) struct AdviseArguments {
    #[command(flatten)]
    pub run: RunOptions,

    #[command(flatten)]
    pub place: PlaceOptions,
}

const ADVISE_EXAMPLES: &str = "\
Examples:
  armill advise cell                               the part may move by 300 mm to all sides
  armill advise cell --x-mm 700,1300 --tilt-deg 0,90 --branch any
  armill advise cell --analysis rim --json
The result is that of `armill run` with all that is advised, in the folder `advice`, with advice.json beside it.";
