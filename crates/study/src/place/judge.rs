//! What places are worth that somebody else chose: those of a sweep over placements.
//!
//! Each is judged on all points of the path, by the goal, the branches and the margin of the study, as if all were known.

use armill_core::kernel::Lie;
use armill_core::optimize::{Merit, Placeable, PlacementGoal, Sure, ToolTurn, on_part};
use armill_core::watch::Watch;

use super::freedom::Freedom;
use super::{Placing, check_rail, rail_of};
use crate::error::StudyError;
use crate::file::placement::PlaceTable;
use crate::run::runner;

/// Where a part lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartPlace {
    /// x, y, z of the plane's centre in the frame that the study counts from, m; heading, tilt and roll of the plane, rad.
    pub part: [f64; 6],
    /// Turn of the tool about its axis, beside the one it has, rad.
    pub spin: f64,
    /// Where the rail stands, m, of an arm on one; `None` where the study has it.
    pub rail: Option<f64>,
}

/// What places are worth.
#[derive(Clone, Debug, PartialEq)]
pub struct Worth {
    /// Of each place; the cost is that of the points that are held, m.
    pub merits: Vec<Merit>,
    /// Points of the path.
    pub points: usize,
    /// Load cases at each.
    pub cases: usize,
}

impl Placing<'_> {
    /// Where the study has the part; with its rail, where the arm stands on one.
    pub fn drawn(&self) -> PartPlace {
        let [x, y, z, heading, tilt, roll, spin, rail] = self.as_drawn().values(&[]);
        PartPlace {
            part: [x, y, z, heading, tilt, roll],
            spin,
            rail: rail_of(&self.study.robot.robot).map(|_| rail),
        }
    }

    /// What each of these places is worth; the same on any number of threads.
    ///
    /// # Errors
    /// A rail that is not there, or beyond its limits; what [`Placing::search`] gives.
    pub fn judge(&self, places: &[PartPlace], watch: Watch<'_>) -> Result<Worth, StudyError> {
        let robot = &self.study.robot.robot;
        for rail in places.iter().filter_map(|place| place.rail) {
            check_rail(robot, [rail, rail])?;
        }
        let quiet = Watch {
            finished: &|_| (),
            ..watch
        };
        let runner = runner(self.study, quiet)?;
        let (load, _) = runner.pushed(self.ask)?;
        let goal = PlacementGoal {
            sure: Sure::Nominal,
            ..self.goal()?
        };
        let track = &self.ask.track;
        let all: Vec<usize> = (0..track.len()).collect();
        let path = on_part((track, &load), goal.counts, &all);
        let placeable = Placeable {
            question: &runner.question(&self.ask.setting),
            path: &path,
            goal,
        };
        let freedom = self.as_drawn();
        let lies: Vec<Lie> = places.iter().map(|place| lie(&freedom, place)).collect();
        let merits = placeable.merits(&lies, None, watch)?;
        // Where no branch is open all points are lost.
        let none = Merit {
            lost: path.len(),
            cost: 0.0,
            branch: None,
        };
        Ok(Worth {
            merits: merits.into_iter().map(|merit| merit.unwrap_or(none)).collect(),
            points: path.len(),
            cases: path.case_count(),
        })
    }

    /// Nothing free: the place that the study has.
    fn as_drawn(&self) -> Freedom {
        let setting = &self.ask.setting;
        Freedom::new(
            (setting, self.rail()),
            ToolTurn::of(&self.ask.track),
            &PlaceTable::default(),
        )
    }
}

fn lie(freedom: &Freedom, place: &PartPlace) -> Lie {
    let [x, y, z, heading, tilt, roll] = place.part;
    let rail = place.rail.unwrap_or(0.0);
    Lie {
        rail: place.rail,
        ..freedom.lie_of([x, y, z, heading, tilt, roll, place.spin, rail])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::answer;
    use crate::file::resolve::{Study, read};
    use crate::run::run;

    /// A circle with this plane under two cases.
    fn study(centre_mm: [f64; 3], tilt_deg: f64) -> Study {
        let text = format!(
            r#"
format = 1
robot = "yaskawa/mh12"
limit_um = 200
tool = {{ flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }}
plane = {{ centre_mm = {centre_mm:?}, tilt_deg = {tilt_deg}, half_size_mm = 150, step_mm = 75 }}
load = {{ cases_n = [[3, -5, -5], [30, 5, 5]] }}
[[ask]]
kind = "path"
name = "groove"
circle = {{ radius_mm = 100 }}
"#
        );
        read("study.toml", std::path::Path::new("."), text.as_bytes()).unwrap()
    }

    fn placing(study: &Study) -> Placing<'_> {
        Placing::new(study, PlaceTable::default(), 0).unwrap()
    }

    #[test]
    fn the_place_as_drawn_is_that_of_the_study() {
        let study = study([800.0, 50.0, 700.0], 30.0);
        let drawn = placing(&study).drawn();
        let wanted = [0.8, 0.05, 0.7, 0.0, 30.0_f64.to_radians(), 0.0];
        let apart = drawn
            .part
            .iter()
            .zip(wanted)
            .map(|(told, wanted)| (told - wanted).abs());
        // The last digit, from mm into m.
        assert!(apart.fold(0.0, f64::max) < 1e-15, "{drawn:?}");
        assert_eq!((drawn.spin, drawn.rail), (0.0, None));
    }

    #[test]
    fn a_place_costs_what_the_study_says_that_has_the_part_there() {
        let places = [
            ([1000.0, 0.0, 800.0], 0.0),
            ([900.0, 150.0, 750.0], 40.0),
            ([850.0, -200.0, 600.0], 90.0),
        ];
        let studies = places.map(|(centre_mm, tilt_deg)| study(centre_mm, tilt_deg));
        let lie = |study: &Study| placing(study).drawn();
        let worth = placing(&studies[0])
            .judge(&studies.each_ref().map(lie), Watch::NONE)
            .unwrap();
        assert_eq!((worth.points, worth.cases), (360, 2));
        for (merit, study) in worth.merits.iter().zip(&studies) {
            let done = run(study, Watch::NONE).unwrap();
            let told = &answer(study, &done).paths[0];
            let max_um = told.max_in_plane_um.unwrap();
            assert_eq!(merit.lost, 0);
            // The answer is rounded to a thousandth of a micrometre.
            assert!((merit.cost * 1e6 - max_um).abs() < 1e-3, "{merit:?} {max_um}");
        }
    }

    #[test]
    fn a_place_out_of_reach_loses_its_points() {
        let study = study([1000.0, 0.0, 800.0], 0.0);
        let placing = placing(&study);
        let far = PartPlace {
            part: [9.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            ..placing.drawn()
        };
        let worth = placing.judge(&[far], Watch::NONE).unwrap();
        assert_eq!(worth.merits[0].lost, worth.points);
    }

    #[test]
    fn a_rail_that_is_not_there_is_refused() {
        let study = study([1000.0, 0.0, 800.0], 0.0);
        let placing = placing(&study);
        let on_rail = PartPlace {
            rail: Some(1.0),
            ..placing.drawn()
        };
        let error = placing.judge(&[on_rail], Watch::NONE).unwrap_err();
        assert!(error.to_string().contains("stands on no rail"), "{error}");
    }
}
