//! `armill place STUDY`: where the part should lie so that a path deviates least.

use armill_study::file::placement::RankByName;
use clap::{Args, ValueEnum};

use super::posture::{ComponentArgument, ObjectiveArgument};
use super::run::RunOptions;

#[derive(Debug, Args)]
#[command(after_help = PLACE_EXAMPLES)]
pub(crate) struct PlaceArguments {
    #[command(flatten)]
    pub run: RunOptions,

    #[command(flatten)]
    pub place: PlaceOptions,
}

// Where the part may lie; what an option leaves out the study's own `[place]` says.
#[derive(Debug, Args)]
pub(crate) struct PlaceOptions {
    /// The path to place, where the study asks for several
    #[arg(long, value_name = "NAME")]
    pub analysis: Option<String>,

    /// Least and greatest x of the plane's centre [without any bound: 300 mm to all sides]
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub x_mm: Option<[f64; 2]>,

    /// Its y
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub y_mm: Option<[f64; 2]>,

    /// Its z
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub z_mm: Option<[f64; 2]>,

    /// Heading: turn of the part about the vertical, beside where it lies
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub heading_deg: Option<[f64; 2]>,

    /// Tilt, as plane.tilt_deg
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub tilt_deg: Option<[f64; 2]>,

    /// Turn of the part about the plane's normal, beside where it lies
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub roll_deg: Option<[f64; 2]>,

    /// Turn of the tool about its axis, the same all along, beside the one it has
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub spin_deg: Option<[f64; 2]>,

    /// Where the rail under the robot stands
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub rail_mm: Option<[f64; 2]>,

    /// Branches that may be taken: words of a branch, or `any`
    #[arg(long, value_name = "WORDS")]
    pub branch: Option<String>,

    /// What shall be least
    #[arg(long)]
    pub objective: Option<ObjectiveArgument>,

    /// Which part of the deviation counts
    #[arg(long)]
    pub component: Option<ComponentArgument>,

    /// How far every joint stays from its limits, the elbow from stretched, the wrist from straight [default: 0]
    #[arg(long, value_name = "DEG")]
    pub margin_deg: Option<f64>,

    /// What places are compared by: the goal as if all were known, with two standard uncertainties, or how probably it keeps
    /// the limit [default: nominal]
    #[arg(long)]
    pub rank_by: Option<RankByArgument>,

    /// Seed of the search: the same seed gives the same place
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u32,
}

/// `--sure`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum RankByArgument {
    /// As if all were known
    Nominal,
    /// With two standard uncertainties
    PlusTwoSigma,
    /// How probably the limit is kept
    WithinLimit,
}

impl From<RankByArgument> for RankByName {
    fn from(rank_by: RankByArgument) -> RankByName {
        match rank_by {
            RankByArgument::Nominal => RankByName::Nominal,
            RankByArgument::PlusTwoSigma => RankByName::PlusTwoSigma,
            RankByArgument::WithinLimit => RankByName::WithinLimit,
        }
    }
}

/// Two numbers, the least and the greatest.
fn bounds(text: &str) -> Result<[f64; 2], String> {
    let number = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.abs() <= 1e6);
    let both = text
        .split_once(',')
        .and_then(|(a, b)| Some([number(a)?, number(b)?]));
    both.ok_or_else(|| "two numbers up to 1e6, the least and the greatest, such as 700,1300".to_owned())
}

const PLACE_EXAMPLES: &str = "\
Examples:
  armill place cell --x-mm 700,1300 --y-mm -400,400
  armill place cell --x-mm 700,1300 --z-mm 400,1200 --tilt-deg -60,90 --branch any --spin-deg -180,180
  armill place cell --margin-deg 5 --goal mean --analysis rim
The result is that of `armill run` with the path at the place found, in the folder `place`, with placement.json beside it.
A search that was stopped goes on where it was when it is started again.";
