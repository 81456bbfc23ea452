//! The circles of a study, the joint motion along them without load, and what measurements on them show.

use armill_core::kernel::Question;
use armill_core::measure::ballbar::joints::circle::STATIONS;
use armill_core::measure::ballbar::joints::{BacklashFit, Circle, Followed, NotFollowed, follow};
use armill_core::nalgebra::Point3;
use armill_core::path::Shape;
use armill_core::watch::Watch;
use armill_study::analysis::Subject;
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use armill_study::file::circles::MeasuredCircle;
use armill_study::file::resolve::Study;

/// A circle of a study.
#[derive(Clone, Copy, Debug)]
pub struct CircleAnalysis<'a> {
    /// Its name.
    pub name: &'a str,
    /// The path.
    pub path: &'a PathAnalysis,
    /// The circle in the cell.
    pub circle: Circle,
}

/// What circles show. SI.
#[derive(Clone, Debug)]
pub struct BacklashEstimate<'a> {
    /// Each measured circle.
    pub circles: Vec<FollowedCircle<'a>>,
    /// The joint estimate from all of them.
    pub gaps: BacklashFit,
}

/// A measured circle with the joint motion along it.
#[derive(Clone, Debug)]
pub struct FollowedCircle<'a> {
    /// Its test.
    pub measured: &'a MeasuredCircle,
    /// Its path.
    pub circle: CircleAnalysis<'a>,
    /// The joint motion.
    pub followed: Followed,
}

impl CircleAnalysis<'_> {
    /// Its centre, m, base.
    pub fn centre(&self) -> Point3<f64> {
        let at = self.circle.centre;
        self.circle.placing.base_from_path * Point3::new(at.x, at.y, 0.0)
    }
}

/// The circles with these names, in this order; all if none is named.
///
/// # Errors
/// No circle, or none of that name; one whose posture is searched for.
pub fn circles<'a>(study: &'a Study, names: &[String]) -> Result<Vec<CircleAnalysis<'a>>, StudyError> {
    let all: Vec<CircleAnalysis<'a>> = (study.analyses.iter())
        .filter_map(|analysis| match &analysis.subject {
            Subject::Path(path) => match path.shape()? {
                Shape::Circle { centre, radius } => Some(CircleAnalysis {
                    name: &analysis.name,
                    path,
                    circle: Circle {
                        placing: path.track.placing,
                        centre: *centre,
                        radius: *radius,
                    },
                }),
                Shape::Polyline(_) => None,
            },
            _ => None,
        })
        .collect();
    let hint = "an analysis of kind = \"path\" with circle = { radius_mm = 100 }";
    if all.is_empty() {
        return Err(StudyError::value("the study has no circle", hint));
    }
    let named = |name: &String| {
        let found = all.iter().find(|circle| circle.name == name);
        found
            .copied()
            .ok_or_else(|| StudyError::value(format!("the study has no circle called `{name}`"), hint))
    };
    let found = match names {
        [] => all.clone(),
        names => names.iter().map(named).collect::<Result<_, _>>()?,
    };
    match found.iter().find(|circle| circle.path.setting.search.is_some()) {
        Some(circle) => Err(StudyError::value(
            format!(
                "{}: a ball-bar test needs a constant spin of the tool",
                circle.name
            ),
            "remove posture.search from this analysis",
        )),
        None => Ok(found),
    }
}

/// A circle and the joint motion along it.
pub(super) fn followed(
    study: &Study,
    circle: &CircleAnalysis<'_>,
    watch: Watch<'_>,
) -> Result<Followed, StudyError> {
    let runner = Runner::new(&study.robot.robot, watch)?;
    // The branch is the one that the study follows the path in, under its load.
    let (load, _) = runner.pushed(circle.path)?;
    let along = runner.follow(circle.path, load)?.along;
    let question = Question {
        choice: along.choice_at(0),
        ..question(&runner, circle)
    };
    follow(&question, &circle.circle, STATIONS, Watch::NONE).map_err(|error| match error {
        NotFollowed::Cancelled(cancelled) => StudyError::Cancelled(cancelled),
        error => StudyError::value(
            format!("{}: {error}", circle.name),
            "another place of the circle, or another branch",
        ),
    })
}

/// The question to the core for this circle.
pub(super) fn question<'a>(runner: &'a Runner<'a>, circle: &CircleAnalysis<'a>) -> Question<'a> {
    runner.question(&circle.path.setting)
}
