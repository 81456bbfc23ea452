//! What a circular test shows, in numbers with their units.
//!
//! Deviations are positive outwards. Angles are from the first axis of the plane towards the second.

use serde::Serialize;

use super::results::ResultsAnswer;
use super::teach::{BeforeAnswer, TaughtAnswer};

/// A circular test in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct BallbarAnswer {
    /// Its files.
    pub files: Vec<String>,
    /// Nominal radius.
    pub radius_mm: f64,
    /// Feed along the circle, if given.
    pub feed_mm_per_min: Option<f64>,
    /// The plane, if given.
    pub plane: Option<String>,
    /// Names of its axes.
    pub axes: [String; 2],
    /// Centre from which radii are measured.
    pub centring: CentringAnswer,
    /// Every run.
    pub runs: Vec<RunAnswer>,
    /// The runs of each direction together.
    pub directions: Vec<DirectionAnswer>,
    /// G(b): circular deviation of both directions together; none for a single direction.
    pub circular_bidirectional_um: Option<f64>,
    /// D: radius of the least-squares circle of both directions minus the nominal one.
    pub mean_bidirectional_um: Option<f64>,
    /// H: largest difference between the directions.
    pub hysteresis_um: Option<f64>,
    /// Differences of runs of the same direction, in pairs.
    pub repeatability: Vec<DifferenceAnswer>,
    /// Clockwise minus anticlockwise.
    pub between_directions: Option<DifferenceAnswer>,
    /// Contributions to the deviation; none if there are too few samples.
    pub parts: Option<PartsAnswer>,
    /// Lobes common to both directions, from the centre of the radii.
    pub lobes: Vec<LobeAnswer>,
    /// Samples that their neighbours contradict.
    pub outliers: Vec<OutlierAnswer>,
    /// Whether these were excluded, except those at a reversal.
    pub outliers_left_out: bool,
    /// Results of the software of the ball-bar: values only.
    pub results: Vec<ResultsAnswer>,
    /// The corrected circle, if requested.
    pub taught: Option<TaughtAnswer>,
    /// The previous test, if given.
    pub before: Option<BeforeAnswer>,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// What a user must know, each a sentence.
    pub warnings: Vec<String>,
}

/// From which centre.
#[derive(Clone, Debug, Serialize)]
pub struct CentringAnswer {
    /// `least-squares` or `setup`.
    pub centre: &'static str,
    /// Least-squares centre of all runs relative to the set-up, used or not; none for short arcs.
    pub offset_um: Option<[f64; 2]>,
    /// Radius of that circle.
    pub radius_mm: Option<f64>,
}

/// One run.
#[derive(Clone, Debug, Serialize)]
pub struct RunAnswer {
    /// `CW1`.
    pub name: String,
    /// As its file calls it.
    pub label: String,
    /// Its file.
    pub file: String,
    /// `CW` or `CCW`.
    pub direction: &'static str,
    /// How many samples.
    pub samples: usize,
    /// Where it began.
    pub start_deg: f64,
    /// Its arc.
    pub arc_deg: f64,
    /// Where no samples are, from and to.
    pub gaps_deg: Vec<[f64; 2]>,
    /// Its quantities.
    #[serde(flatten)]
    pub shown: ShownAnswer,
}

/// The runs of one direction together.
#[derive(Clone, Debug, Serialize)]
pub struct DirectionAnswer {
    /// `CW` or `CCW`.
    pub direction: &'static str,
    /// How many.
    pub runs: usize,
    /// What they show.
    #[serde(flatten)]
    pub shown: ShownAnswer,
}

/// Circular and radial deviation.
#[derive(Clone, Debug, Serialize)]
pub struct ShownAnswer {
    /// G; none if the arc is too short for it.
    pub circular_um: Option<f64>,
    /// F, greatest.
    pub radial_max_um: f64,
    /// Where.
    pub radial_max_at_deg: f64,
    /// F, least.
    pub radial_min_um: f64,
    /// Where.
    pub radial_min_at_deg: f64,
}

/// A difference along the angle.
#[derive(Clone, Debug, Serialize)]
pub struct DifferenceAnswer {
    /// Which is taken from which: first minus second.
    pub of: [String; 2],
    /// Largest by size.
    pub max_um: f64,
    /// Where.
    pub max_at_deg: f64,
    /// Root mean square.
    pub rms_um: f64,
}

/// Contributions to the deviation.
#[derive(Clone, Debug, Serialize)]
pub struct PartsAnswer {
    /// Each as it shows along the radius.
    pub radial: Vec<PartAnswer>,
    /// Scale error of each axis.
    pub scale_um_per_m: Option<[f64; 2]>,
    /// Its standard uncertainty.
    pub scale_u_um_per_m: Option<[f64; 2]>,
    /// Deviation of the angle between the positive axes from 90 degrees; um/m is the same number.
    pub squareness_urad: Option<f64>,
    /// Its standard uncertainty.
    pub squareness_u_urad: Option<f64>,
    /// How much later the first axis follows than the second; where the feed is known.
    pub servo_mismatch_s: Option<f64>,
    /// Its standard uncertainty.
    pub servo_mismatch_u_s: Option<f64>,
    /// Period of a cyclic error along either axis, given or detected.
    pub cyclic_period_mm: Option<f64>,
    /// Sets of parts of which only a sum is determined, or a single part that is not determined.
    pub not_identifiable: Vec<Vec<String>>,
    /// Root mean square without radius and offset, those of the parts.
    pub rms_before_um: f64,
    /// The same, of the residual of all parts.
    pub rms_after_um: f64,
}

/// One part.
#[derive(Clone, Debug, Serialize)]
pub struct PartAnswer {
    /// Its name.
    pub what: String,
    /// What kind of part: `radius`, `offset`, `scale mismatch`, `squareness`, `reversal`, `direction radius`,
    /// `servo mismatch`, `lobes`, `cyclic`.
    pub kind: &'static str,
    /// How large it is along the radius.
    pub value_um: f64,
    /// Standard uncertainty.
    pub u_um: f64,
}

/// So many lobes.
#[derive(Clone, Debug, Serialize)]
pub struct LobeAnswer {
    /// A turn.
    pub waves: usize,
    /// Half of crest to trough.
    pub amplitude_um: f64,
    /// Where a crest is.
    pub crest_deg: f64,
}

/// A sample that its neighbours contradict.
#[derive(Clone, Debug, Serialize)]
pub struct OutlierAnswer {
    /// Its run.
    pub run: String,
    /// Where.
    pub angle_deg: f64,
    /// Its deviation.
    pub off_um: f64,
    /// Whether an axis reverses there: then it is a spike, not dirt.
    pub at_reversal: bool,
}
