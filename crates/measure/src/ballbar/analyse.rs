//! What a circular test shows, in SI.

use armill_core::measure::ballbar::centre::seen_from;
use armill_core::measure::ballbar::parts::{
    Parts, PartsOptions, Reversal, Step, of_axes, parts, periods, strongest_period,
};
use armill_core::measure::ballbar::{
    Centre, CircularTest, Difference, Direction, Lobes, Outlier, Quantities, Run, between_directions,
    hysteresis, least_squares_centre, lobes, mean_bidirectional, most_lobes, outliers, quantities, repeats,
};
use armill_core::units::{to_deg, to_mm};
use armill_study::StudyError;
use armill_study::measured::circular_test::MeasuredTest;
use armill_study::number::decimals;

/// Centre from which radii are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Centring {
    /// Where the pivot was set up.
    Setup,
    /// The least-squares centre of all runs.
    LeastSquares,
}

/// Whether an error that repeats along an axis is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cyclic {
    /// Not fitted.
    None,
    /// With this period, m.
    Period(f64),
    /// With the period that has a significant peak, if there is one.
    Search,
}

/// Settings of the analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// From which centre.
    pub centring: Centring,
    /// Greatest number of lobes that are fitted and reported.
    pub most_lobes: usize,
    /// Error of an axis that repeats.
    pub cyclic: Cyclic,
    /// Angles of further reversals apart from those of the axes, rad.
    pub reversals: Vec<f64>,
    /// Whether the axes of the plane reverse at their ends: not for a robot with revolute joints.
    pub axes_reverse: bool,
    /// Whether outliers are excluded.
    pub without_outliers: bool,
}

/// What a test shows.
#[derive(Clone, Debug)]
pub struct BallbarAnalysis<'a> {
    /// The test.
    pub measured: &'a MeasuredTest,
    /// The runs as reported: from the requested centre, without outliers if these are excluded.
    pub test: CircularTest,
    /// The least-squares centre of all runs, from the set-up; none of short arcs.
    pub centre: Option<Centre>,
    /// Whether radii are measured from it.
    pub is_centred: bool,
    /// Of each run.
    pub runs: Vec<Quantities>,
    /// Of the runs of each direction together, clockwise first.
    pub directions: [Option<Quantities>; 2],
    /// Of all runs.
    pub all: Quantities,
    /// D, m.
    pub mean_bidirectional: Option<f64>,
    /// H, m.
    pub hysteresis: Option<f64>,
    /// Pairs of runs of the same direction, by their indices, and their difference.
    pub repeats: Vec<([usize; 2], Difference)>,
    /// Clockwise minus anticlockwise, of the means.
    pub between: Difference,
    /// What was looked for.
    pub requested: PartsOptions,
    /// Contributions to the deviation; none if there are too few samples.
    pub parts: Option<Parts>,
    /// Lobes common to both directions; none if there is a gap in the samples.
    pub lobes: Option<Lobes>,
    /// Of each run.
    pub outliers: Vec<Vec<Outlier>>,
}

/// What `measured` shows.
///
/// # Errors
/// Runs with too few samples without their outliers; a centre that is too far off.
pub fn analyse<'a>(
    measured: &'a MeasuredTest,
    question: &Question,
) -> Result<BallbarAnalysis<'a>, StudyError> {
    let [a, b] = measured.axes();
    let mut reversals = match question.axes_reverse {
        true => of_axes([a.as_str(), b.as_str()]),
        false => Vec::new(),
    };
    reversals.extend(question.reversals.iter().map(|angle| Reversal {
        name: format!("at {} deg", decimals(to_deg(angle), 3)),
        steps: vec![Step {
            angle: *angle,
            outwards: [1.0; 2],
        }],
    }));
    let angles: Vec<f64> = (reversals.iter().flat_map(|reversal| &reversal.steps))
        .map(|step| step.angle)
        .collect();
    let dirt: Vec<Vec<Outlier>> = measured
        .test
        .runs()
        .iter()
        .map(|run| outliers(run, &angles))
        .collect();
    let test = match question.without_outliers {
        true => without(&measured.test, &dirt)?,
        false => measured.test.clone(),
    };
    let centre = least_squares_centre(&test);
    let mut requested = PartsOptions {
        reversals,
        most_lobes: question.most_lobes.min(most_lobes(&test)),
        period: None,
    };
    requested.period = match question.cyclic {
        Cyclic::None => None,
        Cyclic::Period(period) => Some(period_of(&test, period)?),
        Cyclic::Search => strongest_period(&test, &requested),
    };
    let parts = parts(&test, &requested);
    let offset = centre.filter(|_| question.centring == Centring::LeastSquares);
    let shown = match offset {
        Some(centre) => seen_from(&test, centre.offset).map_err(|error| {
            StudyError::value(
                error.to_string(),
                "set the pivot up nearer to the centre of the path",
            )
        })?,
        None => test,
    };
    let nothing = || StudyError::value("a test without runs", "name a file with radii");
    let of = |runs: &[&Run]| quantities(&shown, runs);
    let direction = |direction: Direction| of(&shown.of(direction).collect::<Vec<_>>());
    let runs = shown.runs().iter().map(|run| of(&[run]).ok_or_else(nothing));
    Ok(BallbarAnalysis {
        measured,
        centre,
        is_centred: offset.is_some(),
        runs: runs.collect::<Result<_, _>>()?,
        directions: Direction::BOTH.map(direction),
        all: of(&shown.runs().iter().collect::<Vec<_>>()).ok_or_else(nothing)?,
        mean_bidirectional: mean_bidirectional(&shown),
        hysteresis: hysteresis(&shown),
        repeats: repeats(&shown),
        between: between_directions(&shown),
        requested,
        parts,
        lobes: lobes(&shown, question.most_lobes.max(2)),
        outliers: dirt,
        test: shown,
    })
}

/// A given period, if the test can resolve it.
fn period_of(test: &CircularTest, period: f64) -> Result<f64, StudyError> {
    let [least, most] = periods(test);
    // A period at its limit is shown with as many digits as the limit.
    if period >= least * (1.0 - 1e-3) && period <= most * (1.0 + 1e-3) {
        return Ok(period);
    }
    let message = format!(
        "a cyclic error with a period of {} mm is outside {} to {} mm: four samples, and the radius",
        decimals(to_mm(period), 6),
        decimals(to_mm(least), 3),
        decimals(to_mm(most), 3)
    );
    Err(StudyError::value(message, "give the period in mm, or `search`"))
}

/// The runs without the outliers that belong to no reversal.
fn without(test: &CircularTest, dirt: &[Vec<Outlier>]) -> Result<CircularTest, StudyError> {
    let clean = |(run, dirt): (&Run, &Vec<Outlier>)| {
        let places: Vec<usize> = (dirt.iter().filter(|of| !of.at_reversal))
            .map(|of| of.sample)
            .collect();
        run.without(&places)
    };
    let runs: Option<Vec<Run>> = test.runs().iter().zip(dirt).map(clean).collect();
    let left = runs.and_then(|runs| CircularTest::new(test.radius(), runs).ok());
    left.ok_or_else(|| {
        StudyError::value(
            "without its outliers too little is left of a run",
            "keep them, and look at the run",
        )
    })
}
