//! Scores of given placements, such as those of a sweep.
//!
//! Each is evaluated at all points of the path, by the objective, the branches and the margin of the study, without
//! uncertainty.

use armill_core::kernel::PartPlacement;
use armill_core::optimize::{Placeable, PlacementObjective, RankBy, Score, ToolTurn, on_part};
use armill_core::path::LoadedTrack;
use armill_core::watch::Watch;
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use armill_study::file::placement::PlaceTable;

use super::PlacementSearch;
use super::freedom::Freedom;
use super::rail::{check_rail, rail_of};

/// Placement of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacementParameters {
    /// x, y, z of the plane's centre in the reference frame of the study, m; heading, tilt and roll of the plane, rad.
    pub part: [f64; 6],
    /// Spin of the tool about its axis, relative to that of the study, rad.
    pub spin: f64,
    /// Position of the rail, m, for a robot on one; `None` for that of the study.
    pub rail: Option<f64>,
}

/// Scores of placements.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacementScores {
    /// Score of each placement; the cost is that of the reachable points, m.
    pub scores: Vec<Score>,
    /// Points of the path.
    pub points: usize,
    /// Load cases at each.
    pub cases: usize,
}

impl PlacementSearch<'_> {
    /// The placement in the study; with its rail, if the robot is on one.
    pub fn nominal_parameters(&self) -> PlacementParameters {
        let [x, y, z, heading, tilt, roll, spin, rail] = self.nominal().values(&[]);
        PlacementParameters {
            part: [x, y, z, heading, tilt, roll],
            spin,
            rail: rail_of(&self.study.robot.robot).map(|_| rail),
        }
    }

    /// The score of each of these placements; the same on any number of threads.
    ///
    /// # Errors
    /// A rail that is not there, or beyond its limits; errors of [`PlacementSearch::search`].
    pub fn evaluate(
        &self,
        places: &[PlacementParameters],
        watch: Watch<'_>,
    ) -> Result<PlacementScores, StudyError> {
        let robot = &self.study.robot.robot;
        for rail in places.iter().filter_map(|place| place.rail) {
            check_rail(robot, [rail, rail])?;
        }
        let quiet = Watch {
            finished: &|_| (),
            ..watch
        };
        let runner = Runner::new(&self.study.robot.robot, quiet)?;
        let (load, _) = runner.pushed(self.analysis)?;
        let objective = PlacementObjective {
            rank_by: RankBy::Nominal,
            ..self.objective()?
        };
        let track = &self.analysis.track;
        let all: Vec<usize> = (0..track.len()).collect();
        let path = on_part(LoadedTrack { track, load: &load }, objective.component, &all);
        let placeable = Placeable {
            question: &runner.question(&self.analysis.setting),
            path: &path,
            objective,
        };
        let freedom = self.nominal();
        let placements: Vec<PartPlacement> = places
            .iter()
            .map(|place| part_placement(&freedom, place))
            .collect();
        let scores = placeable.scores(&placements, None, watch)?;
        // If no branch is permitted, no point can be reached.
        let none = Score {
            unreachable: path.len(),
            cost: 0.0,
            branch: None,
        };
        Ok(PlacementScores {
            scores: scores.into_iter().map(|score| score.unwrap_or(none)).collect(),
            points: path.len(),
            cases: path.case_count(),
        })
    }

    /// Nothing free: the placement of the study.
    pub(super) fn nominal(&self) -> Freedom {
        let setting = &self.analysis.setting;
        Freedom::new(
            setting,
            self.rail(),
            ToolTurn::of(&self.analysis.track),
            &PlaceTable::default(),
        )
    }
}

fn part_placement(freedom: &Freedom, place: &PlacementParameters) -> PartPlacement {
    let [x, y, z, heading, tilt, roll] = place.part;
    let rail = place.rail.unwrap_or(0.0);
    PartPlacement {
        rail: place.rail,
        ..freedom.placement_of([x, y, z, heading, tilt, roll, place.spin, rail])
    }
}

#[cfg(test)]
mod tests {
    use armill_study::answer::answer;
    use armill_study::file::resolve::{Study, read};
    use armill_study::run::run;

    use super::*;

    /// A circle with this plane under two cases.
    fn study(centre_mm: [f64; 3], tilt_deg: f64) -> Study {
        let text = format!(
            r#"
format = 1
robot = "yaskawa/mh12"
tolerance_um = 200
tool = {{ flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }}
plane = {{ centre_mm = {centre_mm:?}, tilt_deg = {tilt_deg}, half_size_mm = 150, step_mm = 75 }}
load = {{ cases_n = [[3, -5, -5], [30, 5, 5]] }}
[[analysis]]
kind = "path"
name = "groove"
circle = {{ radius_mm = 100 }}
"#
        );
        read("study.toml", std::path::Path::new("."), text.as_bytes()).unwrap()
    }

    fn placing(study: &Study) -> PlacementSearch<'_> {
        PlacementSearch::new(study, PlaceTable::default(), 0).unwrap()
    }

    #[test]
    fn the_nominal_placement_is_that_of_the_study() {
        let study = study([800.0, 50.0, 700.0], 30.0);
        let nominal = placing(&study).nominal_parameters();
        let requested = [0.8, 0.05, 0.7, 0.0, 30.0_f64.to_radians(), 0.0];
        let apart = nominal
            .part
            .iter()
            .zip(requested)
            .map(|(given, requested)| (given - requested).abs());
        // The last digit, from mm into m.
        assert!(apart.fold(0.0, f64::max) < 1e-15, "{nominal:?}");
        assert_eq!((nominal.spin, nominal.rail), (0.0, None));
    }

    #[test]
    fn the_cost_of_a_placement_is_that_of_a_study_with_the_part_there() {
        let places = [
            ([1000.0, 0.0, 800.0], 0.0),
            ([900.0, 150.0, 750.0], 40.0),
            ([850.0, -200.0, 600.0], 90.0),
        ];
        let studies = places.map(|(centre_mm, tilt_deg)| study(centre_mm, tilt_deg));
        let part_placement = |study: &Study| placing(study).nominal_parameters();
        let scores = placing(&studies[0])
            .evaluate(&studies.each_ref().map(part_placement), Watch::NONE)
            .unwrap();
        assert_eq!((scores.points, scores.cases), (360, 2));
        for (score, study) in scores.scores.iter().zip(&studies) {
            let done = run(study, Watch::NONE).unwrap();
            let given = &answer(study, &done).paths[0];
            let max_um = given.max_in_plane_um.unwrap();
            assert_eq!(score.unreachable, 0);
            // The result is rounded to a thousandth of a micrometre.
            assert!((score.cost * 1e6 - max_um).abs() < 1e-3, "{score:?} {max_um}");
        }
    }

    #[test]
    fn a_placement_out_of_reach_has_unreachable_points() {
        let study = study([1000.0, 0.0, 800.0], 0.0);
        let placing = placing(&study);
        let far = PlacementParameters {
            part: [9.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            ..placing.nominal_parameters()
        };
        let scores = placing.evaluate(&[far], Watch::NONE).unwrap();
        assert_eq!(scores.scores[0].unreachable, scores.points);
    }

    #[test]
    fn a_rail_that_is_not_there_is_refused() {
        let study = study([1000.0, 0.0, 800.0], 0.0);
        let placing = placing(&study);
        let on_rail = PlacementParameters {
            rail: Some(1.0),
            ..placing.nominal_parameters()
        };
        let error = placing.evaluate(&[on_rail], Watch::NONE).unwrap_err();
        assert!(error.to_string().contains("has no rail"), "{error}");
    }
}
