//! `armill place STUDY`: the placement of the part for the least deviation along a path.

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

// Permitted placements; options that are not given are taken from `[place]` of the study.
#[derive(Debug, Args)]
pub(crate) struct PlaceOptions {
    /// Name of the path, if the study has several
    #[arg(long, value_name = "NAME")]
    pub analysis: Option<String>,

    /// Range of the x coordinate of the plane's centre [default if no range is given: 300 mm in each direction]
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub x_mm: Option<[f64; 2]>,

    /// Range of the y coordinate of the plane's centre
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub y_mm: Option<[f64; 2]>,

    /// Range of the z coordinate of the plane's centre
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub z_mm: Option<[f64; 2]>,

    /// Range of the heading: rotation of the part about the vertical, relative to its nominal placement
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub heading_deg: Option<[f64; 2]>,

    /// Range of the tilt, measured as plane.tilt_deg in the study
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub tilt_deg: Option<[f64; 2]>,

    /// Range of the rotation of the part about the plane's normal, relative to its nominal placement
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub roll_deg: Option<[f64; 2]>,

    /// Range of the spin of the tool, constant along the path, relative to that of the study
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub spin_deg: Option<[f64; 2]>,

    /// Range of the position of the rail under the robot
    #[arg(long, value_name = "LEAST,GREATEST", value_parser = bounds, allow_hyphen_values = true)]
    pub rail_mm: Option<[f64; 2]>,

    /// Permitted branches: words of a branch name, such as `front elbow-up`, or `any`
    #[arg(long, value_name = "WORDS")]
    pub branch: Option<String>,

    /// Objective to minimise
    #[arg(long)]
    pub objective: Option<ObjectiveArgument>,

    /// Component of the deviation to minimise
    #[arg(long)]
    pub component: Option<ComponentArgument>,

    /// Margin of the joints from their limits, and of elbow and wrist from their straight positions [default: 0]
    #[arg(long, value_name = "DEG")]
    pub margin_deg: Option<f64>,

    /// Criterion by which placements are ranked [default: nominal]
    #[arg(long)]
    pub rank_by: Option<RankByArgument>,

    /// Seed of the search: the same seed gives the same result
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u32,
}

/// `--rank-by`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum RankByArgument {
    /// The objective, without uncertainty
    Nominal,
    /// The objective plus two standard uncertainties
    PlusTwoSigma,
    /// The probability of meeting the tolerance
    WithinTolerance,
}

impl From<RankByArgument> for RankByName {
    fn from(rank_by: RankByArgument) -> RankByName {
        match rank_by {
            RankByArgument::Nominal => RankByName::Nominal,
            RankByArgument::PlusTwoSigma => RankByName::PlusTwoSigma,
            RankByArgument::WithinTolerance => RankByName::WithinTolerance,
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
  armill place cell --margin-deg 5 --objective mean --analysis rim
The results are those of `armill run` with the path at the best placement. They are written to the folder `place`, with \
placement.json. An interrupted search continues when the command is started again.";
