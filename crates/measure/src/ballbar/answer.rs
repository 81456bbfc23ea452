//! What a circular test shows, in numbers with their units.
//!
//! Deviations are positive outwards. Angles are from the first axis of the plane towards the second.

use armill_core::measure::ballbar::parts::{Axis, Part, Parts, Term, Wave};
use armill_core::measure::ballbar::{Difference, Direction, Quantities, Run};
use armill_core::units::{to_deg, to_mm, to_um};
use serde::Serialize;

use super::analyse::{BallbarAnalysis, Question};
use super::results::{ResultsAnswer, add_own_values, results};
use super::teach::{BeforeAnswer, TaughtAnswer};
use super::warnings::warnings;

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

/// The result `found` as numbers with their units.
pub fn answer(question: &Question, found: &BallbarAnalysis<'_>) -> BallbarAnswer {
    let measured = found.measured;
    let axes = measured.axes();
    let parts = found.parts.as_ref().map(|parts| of_parts(parts, found));
    let names: Vec<&str> = measured
        .origins
        .iter()
        .map(|origin| origin.name.as_str())
        .collect();
    let difference = |of: [String; 2], difference: &Difference| {
        difference.span().map(|span| DifferenceAnswer {
            of,
            max_um: to_um(span.largest),
            max_at_deg: to_deg(span.angle),
            rms_um: to_um(span.rms),
        })
    };
    let both = found.test.is_bidirectional();
    let mut given = BallbarAnswer {
        files: measured.files.clone(),
        radius_mm: to_mm(measured.test.radius()),
        feed_mm_per_min: measured.feed.map(|feed| feed * 60e3),
        plane: measured.plane.clone(),
        centring: CentringAnswer {
            centre: if found.is_centred {
                "least-squares"
            } else {
                "setup"
            },
            offset_um: found
                .centre
                .map(|centre| [to_um(centre.offset.x), to_um(centre.offset.y)]),
            radius_mm: found.centre.map(|centre| to_mm(centre.radius)),
        },
        runs: (0..names.len()).map(|index| of_run(found, index)).collect(),
        directions: Direction::BOTH
            .iter()
            .filter_map(|direction| {
                Some(DirectionAnswer {
                    direction: direction.name(),
                    runs: found.test.of(*direction).count(),
                    shown: ShownAnswer::of(&found.directions[direction.index()]?),
                })
            })
            .collect(),
        circular_bidirectional_um: found.all.circular.ok().filter(|_| both).map(to_um),
        mean_bidirectional_um: found.mean_bidirectional.map(to_um),
        hysteresis_um: found.hysteresis.map(to_um),
        repeatability: (found.repeats.iter())
            .filter_map(|([one, other], of)| {
                difference([names[*one].to_owned(), names[*other].to_owned()], of)
            })
            .collect(),
        between_directions: difference(["CW", "CCW"].map(str::to_owned), &found.between),
        lobes: found
            .lobes
            .iter()
            .flat_map(|lobes| &lobes.harmonics)
            .map(LobeAnswer::of)
            .collect(),
        outliers: outliers(&names, found),
        outliers_left_out: question.without_outliers,
        results: results(measured),
        axes,
        parts,
        taught: None,
        before: None,
        unused: measured.unused.clone(),
        warnings: Vec::new(),
    };
    add_own_values(&mut given, found);
    given.warnings = warnings(question, found, &given);
    given
}

impl ShownAnswer {
    fn of(shown: &Quantities) -> ShownAnswer {
        let [least, greatest] = shown.radial;
        ShownAnswer {
            circular_um: shown.circular.ok().map(to_um),
            radial_max_um: to_um(greatest.deviation),
            radial_max_at_deg: to_deg(greatest.angle),
            radial_min_um: to_um(least.deviation),
            radial_min_at_deg: to_deg(least.angle),
        }
    }
}

impl LobeAnswer {
    fn of(lobe: &armill_core::roundness::Harmonic) -> LobeAnswer {
        let waves = lobe.waves as f64;
        LobeAnswer {
            waves: lobe.waves,
            amplitude_um: to_um(lobe.amplitude),
            crest_deg: (to_deg(lobe.phase) / waves).rem_euclid(360.0 / waves),
        }
    }
}

fn of_run(found: &BallbarAnalysis<'_>, index: usize) -> RunAnswer {
    let measured = found.measured;
    let (origin, shown) = (&measured.origins[index], &found.runs[index]);
    let run: &Run = &measured.test.runs()[index];
    let profile = armill_core::measure::ballbar::Profile::of(&found.test.runs()[index]);
    RunAnswer {
        name: origin.name.clone(),
        label: origin.label.clone(),
        file: origin.file.clone(),
        direction: run.direction().name(),
        samples: run.angle().len(),
        start_deg: to_deg(run.angle()[0]).rem_euclid(360.0),
        arc_deg: to_deg(shown.arc),
        gaps_deg: profile.gaps().iter().map(|gap| gap.map(to_deg)).collect(),
        shown: ShownAnswer::of(shown),
    }
}

/// What a term is called.
pub(crate) fn name_of(term: Term, axes: &[String; 2], found: &BallbarAnalysis<'_>) -> String {
    let axis = |axis: Axis| match axis {
        Axis::A => &axes[0],
        Axis::B => &axes[1],
    };
    let wave = |wave: Wave| match wave {
        Wave::Cosine => "cosine",
        Wave::Sine => "sine",
    };
    match term {
        Term::Radius => "radius".to_owned(),
        Term::Offset(of) => format!("offset along {}", axis(of)),
        Term::ScaleMismatch => "scale mismatch".to_owned(),
        Term::Squareness => "squareness".to_owned(),
        Term::DirectionRadius => "radius CCW minus CW".to_owned(),
        Term::ServoMismatch => "servo mismatch".to_owned(),
        Term::Reversal(index) => format!("step {}", found.requested.reversals[index].name),
        Term::Lobes(count, of) => format!("{count} lobes, {}", wave(of)),
        Term::Cyclic(along, of) => format!("cyclic along {}, {}", axis(along), wave(of)),
    }
}

/// Kind of the part of a term.
fn kind_of(term: Term) -> &'static str {
    match term {
        Term::Radius => "radius",
        Term::Offset(_) => "offset",
        Term::ScaleMismatch => "scale mismatch",
        Term::Squareness => "squareness",
        Term::DirectionRadius => "direction radius",
        Term::ServoMismatch => "servo mismatch",
        Term::Reversal(_) => "reversal",
        Term::Lobes(..) => "lobes",
        Term::Cyclic(..) => "cyclic",
    }
}

fn of_parts(parts: &Parts, found: &BallbarAnalysis<'_>) -> PartsAnswer {
    let measured = found.measured;
    let axes = measured.axes();
    let radius = measured.test.radius();
    let name = |term: Term| name_of(term, &axes, found);
    // A sum of several errors is none of them.
    let of = |term: Term| parts.alone(term);
    // alpha = (radius + mismatch)/R, beta = (radius - mismatch)/R.
    let scale = of(Term::Radius).zip(of(Term::ScaleMismatch));
    let per_m = 1e6 / radius;
    let both = |(mean, half): (&Part, &Part)| {
        [1.0, -1.0].map(|side| {
            let variance = mean.u.powi(2) + half.u.powi(2) + 2.0 * side * parts.scale_covariance;
            variance.max(0.0).sqrt() * per_m
        })
    };
    let servo = of(Term::ServoMismatch).zip(measured.feed);
    PartsAnswer {
        radial: (parts.parts.iter())
            .map(|part| PartAnswer {
                what: name(part.term),
                kind: kind_of(part.term),
                value_um: to_um(part.value),
                u_um: to_um(part.u),
            })
            .collect(),
        scale_um_per_m: scale.map(|(mean, half)| {
            [
                (mean.value + half.value) * per_m,
                (mean.value - half.value) * per_m,
            ]
        }),
        scale_u_um_per_m: scale.map(both),
        squareness_urad: of(Term::Squareness).map(|part| 2.0 * part.value * per_m),
        squareness_u_urad: of(Term::Squareness).map(|part| 2.0 * part.u * per_m),
        servo_mismatch_s: servo.map(|(part, feed)| 2.0 * part.value / feed),
        servo_mismatch_u_s: servo.map(|(part, feed)| 2.0 * part.u / feed),
        cyclic_period_mm: found.requested.period.map(to_mm),
        not_identifiable: (parts.together.iter())
            .map(|set| set.iter().map(|term| name(*term)).collect())
            .collect(),
        rms_before_um: to_um(parts.rms_before),
        rms_after_um: to_um(parts.rms_after),
    }
}

fn outliers(names: &[&str], found: &BallbarAnalysis<'_>) -> Vec<OutlierAnswer> {
    let of_run = names.iter().zip(&found.outliers);
    of_run
        .flat_map(|(name, outliers)| {
            outliers.iter().map(|outlier| OutlierAnswer {
                run: (*name).to_owned(),
                angle_deg: to_deg(outlier.angle),
                off_um: to_um(outlier.off),
                at_reversal: outlier.at_reversal,
            })
        })
        .collect()
}
