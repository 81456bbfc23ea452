//! Arguments of `armill ballbar`.
//!
//! `--radius-mm`, `--direction`, `--start-deg`, `--feed-mm-per-min` and `--plane` give what the files do not contain.
//! `--direction` and `--cyclic` are text until they are read below: words of ball-bar files; a period or a keyword.

use armill_core::units::{from_deg, from_mm};
use std::path::PathBuf;

use armill_formats::measurement::ballbar::{BallbarReadOptions, direction_of};
use armill_measure::ballbar::{Centring, CirclePlacement, Cyclic, Question};
use armill_study::StudyError;
use armill_study::measured::circular_test::FileOptions;
use clap::{Args, ValueEnum};

use super::numbers::{above_zero, finite, within};
use super::program::ProgramOptions;
use super::writing::WritingOptions;

/// Highest lobe: higher ones cannot be measured.
const MOST_LOBES: usize = 360;
/// Default and greatest number of corrected points.
const USUAL_POINTS: usize = 72;
const MOST_POINTS: usize = 3600;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
A file is a CSV whose column names end in units (angle_deg,radius_dev_um,direction,run), with `# radius_mm: 100` above \
them, or a result file of a Renishaw ball-bar (.b5r), whose results are shown for comparison. All files must be of the same \
circle. Guide: docs/guide/ballbar.md

Examples:
  armill ballbar runs.csv
  armill ballbar cw.csv ccw.csv --radius-mm 100 --plane XY --out test
  armill ballbar first.csv --teach points.csv
  armill ballbar first.csv --program ring.src --study cell --feed-mm-per-min 1000
  armill ballbar second.csv --before first.csv --json"
)]
pub(crate) struct BallbarArguments {
    /// Measured runs of one circle
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// Nominal radius, if the files do not contain it
    #[arg(long, value_name = "MM")]
    pub radius_mm: Option<f64>,
    /// Direction of all runs, if the files do not contain it: CW or CCW
    #[arg(long, value_name = "WAY")]
    pub direction: Option<String>,
    /// Angle of the first sample, for runs without angles
    #[arg(long, value_name = "DEG")]
    pub start_deg: Option<f64>,
    /// Feed along the circle, if the files do not contain it
    #[arg(long, value_name = "MM/MIN")]
    pub feed_mm_per_min: Option<f64>,
    /// The plane by its two axes, if the files do not contain it: XY
    #[arg(long, value_name = "AXES")]
    pub plane: Option<String>,
    /// Centre from which radii are measured
    #[arg(long, value_name = "CENTRE", value_enum, default_value_t = CentreChoice::LeastSquares)]
    pub centre: CentreChoice,
    /// Highest lobe (per revolution) that is fitted and reported
    #[arg(long, value_name = "N", default_value_t = 6)]
    pub lobes: usize,
    /// Fit a cyclic error along the axes: its period in mm, or `search` to find the period
    #[arg(long, value_name = "MM|search")]
    pub cyclic: Option<String>,
    /// Angle at which a further drive reverses, in both directions of travel (repeatable)
    #[arg(long, value_name = "DEG")]
    pub reversal_deg: Vec<f64>,
    /// The axes of the plane are not drive axes: no reversal at 0, 90, 180 and 270 deg
    #[arg(long)]
    pub no_axes: bool,
    /// Exclude samples that differ strongly from their neighbours
    #[arg(long)]
    pub leave_out_outliers: bool,
    /// Files of the previous test, for comparison (repeatable)
    #[arg(long, value_name = "FILE")]
    pub before: Vec<PathBuf>,
    /// Write the corrected points of the circle to this file (CSV)
    #[arg(long, value_name = "FILE")]
    pub teach: Option<PathBuf>,
    /// Number of corrected points [default: 72; for a program, as many as --within-um requires]
    #[arg(long, value_name = "N")]
    pub points: Option<usize>,
    /// Highest lobe that the corrected circle compensates
    #[arg(long, value_name = "N", default_value_t = 12)]
    pub teach_lobes: usize,
    // `--program` and its options.
    #[command(flatten)]
    pub program: ProgramOptions,
    /// The study that contains the circle, for --program
    #[arg(long, value_name = "STUDY")]
    pub study: Option<PathBuf>,
    /// Name of the circle in that study, if it has several
    #[arg(long, value_name = "NAME", requires = "study")]
    pub analysis: Option<String>,
    /// Angle on the circle, from its +y' towards z', that corresponds to angle 0 in the files
    #[arg(long, value_name = "DEG", default_value_t = 0.0, requires = "study")]
    pub zero_deg: f64,
    /// Angles in the files increase from z' towards y'
    #[arg(long, requires = "study")]
    pub mirrored: bool,
    /// Write the result, tables, pictures and a report into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// Centre of the radii.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CentreChoice {
    /// The pivot as set up
    Setup,
    /// The least-squares centre of all runs
    LeastSquares,
}

impl BallbarArguments {
    /// Data that the files do not contain.
    ///
    /// # Errors
    /// An unknown direction; invalid numbers.
    pub(crate) fn file_options(&self) -> Result<FileOptions, StudyError> {
        let direction = self.direction.as_deref().map(|word| {
            direction_of(word).ok_or_else(|| {
                StudyError::value(format!("--direction: `{word}` is not a direction"), "CW or CCW")
            })
        });
        let positive =
            |flag: &str, value: Option<f64>| value.map(|value| above_zero(flag, value)).transpose();
        finite("--start-deg", self.start_deg.as_slice())?;
        Ok(FileOptions {
            given: BallbarReadOptions {
                radius: positive("--radius-mm", self.radius_mm)?.map(from_mm),
                direction: direction.transpose()?,
                start: self.start_deg.map(from_deg),
            },
            plane: self.plane.clone(),
            feed: positive("--feed-mm-per-min", self.feed_mm_per_min)?.map(|feed| feed / 60e3),
        })
    }

    /// Settings of the analysis; all numbers of lobes and points are checked.
    ///
    /// # Errors
    /// Numbers out of range; a cyclic error that is neither a period nor `search`.
    pub(crate) fn question(&self) -> Result<Question, StudyError> {
        within("--lobes", self.lobes, [0, MOST_LOBES])?;
        within("--teach-lobes", self.teach_lobes, [0, MOST_LOBES])?;
        within("--points", self.points.unwrap_or(USUAL_POINTS), [3, MOST_POINTS])?;
        finite("--reversal-deg", &self.reversal_deg)?;
        let cyclic = match self.cyclic.as_deref() {
            None => Cyclic::None,
            Some("search") => Cyclic::Search,
            Some(word) => {
                let period = word.parse().map_err(|_| {
                    StudyError::value(
                        format!("--cyclic: `{word}` is not a period"),
                        "millimetres such as 10, or `search`",
                    )
                })?;
                Cyclic::Period(from_mm(above_zero("--cyclic", period)?))
            }
        };
        Ok(Question {
            centring: match self.centre {
                CentreChoice::Setup => Centring::Setup,
                CentreChoice::LeastSquares => Centring::LeastSquares,
            },
            most_lobes: self.lobes,
            cyclic,
            reversals: self.reversal_deg.iter().map(from_deg).collect(),
            axes_reverse: !self.no_axes,
            without_outliers: self.leave_out_outliers,
        })
    }

    /// Number of corrected points: as given, or as many as a program needs, or the default.
    ///
    /// # Errors
    /// Too few for the lobes.
    pub(crate) fn point_count(&self, needed: Option<usize>) -> Result<usize, StudyError> {
        let usual = needed.unwrap_or(USUAL_POINTS).min(MOST_POINTS);
        let points = self.points.unwrap_or(usual);
        if points <= 2 * self.teach_lobes {
            let message = format!(
                "--points: {points} points are too few for the {} lobes of --teach-lobes",
                self.teach_lobes
            );
            return Err(StudyError::value(message, "more than two points per lobe"));
        }
        Ok(points)
    }

    /// Where the circle is in the study.
    ///
    /// # Errors
    /// An angle that is not finite.
    pub(crate) fn placement(&self) -> Result<CirclePlacement, StudyError> {
        finite("--zero-deg", &[self.zero_deg])?;
        Ok(CirclePlacement {
            analysis: self.analysis.clone(),
            zero: from_deg(self.zero_deg),
            mirrored: self.mirrored,
        })
    }
}
