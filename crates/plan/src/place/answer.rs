//! The best placement, as values of a result.

use armill_core::optimize::{PlacementEvaluation, RankBy};
use armill_core::units::{to_mm, to_um};
use armill_study::analysis::words::micrometres;
use armill_study::input::setting::Setting;
use armill_study::number::without_rounding;
use armill_study::uncertainty_words::{plus_minus, u_in_words};
use schemars::JsonSchema;
use serde::Serialize;

use super::certificate::{CertificateAnswer, GridAnswer};
use super::followed::Outcome;
use super::freedom::{FreeAnswer, PlaceAnswer};

/// Where a path deviates least.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PlacementAnswer {
    /// Version of this format.
    pub format: u32,
    /// The path.
    pub analysis: String,
    /// Component of the deviation: `in-plane`, `cross-track`, `axial`.
    pub component: &'static str,
    /// What was to be least: `worst`, `mean`, `above-tolerance`.
    pub objective: &'static str,
    /// What places were compared by: `nominal`, `plus-two-sigma`, `within-tolerance`.
    pub rank_by: &'static str,
    /// Margin of every joint to its limits, of the elbow to stretched and the wrist to straight.
    pub margin_deg: f64,
    /// Points of the path.
    pub points: usize,
    /// The clearance that postures must keep; none without a cell.
    pub demanded_clearance_mm: Option<f64>,
    /// Where the study has the part, in the branches that it has there.
    pub nominal: OutcomeAnswer,
    /// At the best placement.
    pub recommended: OutcomeAnswer,
    /// Whether the best placement is recommended: it reaches more points, or the same number and its gain exceeds
    /// `least_gain_um`.
    pub is_improvement: bool,
    /// Decrease of the objective from the nominal to the best placement.
    pub gain_um: f64,
    /// Standard uncertainty of the gain, from the inputs that both predictions share; null if not known.
    pub gain_u_um: Option<f64>,
    /// The gain that would be significant.
    pub least_gain_um: f64,
    /// Its fixture, if fixtures are given.
    pub fixture: Option<String>,
    /// The place.
    pub place: PlaceAnswer,
    /// `posture.home_deg` there, where the rail may move.
    pub home_deg: Option<Vec<f64>>,
    /// What was free.
    pub free: Vec<FreeAnswer>,
    /// Placements on grids, compared with the best.
    pub certificate: CertificateAnswer,
    /// The best place for each margin.
    pub by_margin: Vec<MarginAnswer>,
    /// Seed of the search.
    pub seed: u64,
    /// Whether the tool turns with the part though the study does not say so: its inclination varies from point to
    /// point, and its spin is relative to the axes of base. The table of the path then has its spin at each point.
    pub tool_turns_with_part: bool,
    /// Whether the part is turned under forces that are given in base axes: they do not turn with it.
    pub forces_stay: bool,
    /// Rounds that an earlier run, which was stopped, had done.
    pub rounds_taken_up: usize,
    /// Placements that were compared by a search along the path, where the tool leans or external axes move; else 0.
    pub searched_along: usize,
}

/// Result at a placement.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OutcomeAnswer {
    /// The objective, over the reachable points.
    pub cost_um: f64,
    /// Its standard uncertainty, from those of the joints' compliances and of the size of the load; none where it is not
    /// known.
    pub cost_u_um: Option<f64>,
    /// Probability that it is above the tolerance, if it is not certain.
    pub probability_above_tolerance: Option<f64>,
    /// Points that the robot does not reach inside its limits, away from singularities and with the demanded clearance, and points whose cut
    /// is not stable, if it must be.
    pub unreachable_points: usize,
    /// Points whose cut is not stable; none without `[vibration]` and a cut, and where the path cannot be followed.
    pub unstable_points: Option<usize>,
    /// Stable depth at the point whose cut is nearest to its limit; none as above, and if it is deeper than what was sought.
    pub stable_depth_mm: Option<f64>,
    /// Programmed depth there.
    pub depth_mm: Option<f64>,
    /// Of these the points where two bodies are nearer than demanded.
    pub in_collision: usize,
    /// The least distance of two bodies at these points; 0 where they touch, none without such points.
    pub least_clearance_mm: Option<f64>,
    /// The two bodies.
    pub nearest: Option<[String; 2]>,
    /// The branch; none for robots without named branches.
    pub branch: Option<String>,
}

/// The best place for one margin.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MarginAnswer {
    /// Margin of every joint to its limits, of the elbow to stretched and the wrist to straight.
    pub margin_deg: f64,
    /// What was to be least.
    pub cost_um: f64,
    /// Its fixture, if fixtures are given.
    pub fixture: Option<String>,
    /// The place.
    pub place: PlaceAnswer,
}

impl OutcomeAnswer {
    /// The result of a placement of the path of `setting`.
    pub(super) fn of(outcome: &Outcome, setting: &Setting) -> OutcomeAnswer {
        let (evaluated, cell) = (&outcome.evaluation, setting.cell.as_ref());
        let PlacementEvaluation { score, uncertainty } = evaluated;
        let conflicts = cell.zip(outcome.conflicts);
        let worst = outcome.stability.and_then(|stability| stability.worst);
        let cost = if score.cost.is_finite() { score.cost } else { 0.0 };
        OutcomeAnswer {
            cost_um: to_um(cost),
            cost_u_um: uncertainty.map(to_um),
            probability_above_tolerance: evaluated.probability_above(setting.tolerance),
            unreachable_points: score.unreachable,
            unstable_points: outcome.stability.map(|stability| stability.unstable),
            stable_depth_mm: worst.and_then(|cut| cut.limit).map(|limit| to_mm(limit.depth)),
            depth_mm: worst.map(|cut| to_mm(cut.depth)),
            in_collision: conflicts.map_or(0, |(_, conflicts)| conflicts.points),
            least_clearance_mm: conflicts.map(|(_, conflicts)| without_rounding(to_mm(conflicts.distance))),
            nearest: conflicts
                .map(|(cell, conflicts)| conflicts.bodies.map(|body| cell.cell.name(body).to_owned())),
            branch: score.branch.map(|branch| branch.to_string()),
        }
    }
}

impl PlacementAnswer {
    /// The result as sentences.
    pub fn sentences(&self) -> Vec<String> {
        let what = match self.objective {
            "worst" => "largest",
            "mean" => "mean",
            _ => "cost (mean excess over the tolerance plus a thousandth of the mean) of the",
        };
        let value = |outcome: &OutcomeAnswer| match outcome.unreachable_points {
            0 => format!(
                "{} {} µm",
                micrometres(outcome.cost_um),
                plus_minus(outcome.cost_u_um.map(micrometres))
            ),
            lost => format!(
                "no permitted posture at {lost} of {} points{}",
                self.points,
                self.collision_in_words(outcome)
            ),
        };
        let branch = |outcome: &OutcomeAnswer| {
            outcome
                .branch
                .as_deref()
                .map_or(String::new(), |branch| format!(" in {branch}"))
        };
        let mut lines = vec![match self.recommended.unreachable_points {
            0 => format!(
                "{}: {what} {} deviation {}{} at {}; nominal: {}{}.",
                self.analysis,
                self.component,
                value(&self.recommended),
                branch(&self.recommended),
                self.place_in_words(),
                value(&self.nominal),
                branch(&self.nominal),
            ),
            lost => format!(
                "{}: no placement was found at which all points can be reached{}; the best, {}, has no permitted posture at {lost} of {} points{}{}.",
                self.analysis,
                match (self.recommended.in_collision, self.recommended.unstable_points) {
                    (0, None | Some(0)) => "",
                    (0, Some(_)) => " with a stable cut",
                    _ => " with the demanded clearance",
                },
                self.place_in_words(),
                self.points,
                branch(&self.recommended),
                self.collision_in_words(&self.recommended),
            ),
        }];
        if self.recommended.unreachable_points == 0 && self.nominal.unreachable_points == 0 {
            lines.push(self.gain_in_words());
        }
        lines.extend(self.stability_in_words());
        if self.tool_turns_with_part {
            lines.push(
                "The tool turns with the part; in a study use spin = \"along-feed\", otherwise column turn_deg of the table has its spin.".to_owned(),
            );
        }
        if self.forces_stay {
            lines.push(
                "The deviation at this placement may be wrong: the part is turned, but its forces are given in base axes and keep their direction in the room, so that on the part they point elsewhere. Give forces that turn with the part: load.frame = \"part\", or \"feed\".".to_owned(),
            );
        }
        let edges: Vec<&str> = self
            .free
            .iter()
            .filter(|free| free.at_bound)
            .map(|free| free.degree)
            .collect();
        if !edges.is_empty() {
            lines.push(format!(
                "At a bound: {}. Wider bounds may allow a better placement.",
                edges.join(", ")
            ));
        }
        let grid = |grid: &GridAnswer| {
            format!(
                "{} placements every {:.0} mm and {:.1} deg",
                grid.places, grid.pitch_mm, grid.pitch_deg
            )
        };
        let [near, wide] = [&self.certificate.near, &self.certificate.wide];
        if let Some(above) = self
            .recommended
            .probability_above_tolerance
            .filter(|_| self.rank_by == "within-tolerance")
        {
            lines.push(format!(
                "It is above the tolerance with a probability of {:.1} %.",
                100.0 * above
            ));
        }
        if self.free.is_empty() {
            return lines;
        }
        if self.searched_along > 0 {
            lines.push(format!(
                "{} placements were compared by a search along the path, the best of many by a quick score; other placements may be better.",
                self.searched_along
            ));
            return lines;
        }
        lines.push(match near.better + wide.better {
            0 => format!(
                "None is better of {} near it, nor of {} over the whole range.",
                grid(near),
                grid(wide)
            ),
            better => {
                format!("{better} placements of the grids are better: search again with another --seed.")
            }
        });
        lines
    }

    /// The stable depth at both placements; none where it was not evaluated.
    fn stability_in_words(&self) -> Option<String> {
        let of = |outcome: &OutcomeAnswer| {
            let unstable = outcome.unstable_points?;
            let limit = match (outcome.stable_depth_mm, outcome.depth_mm) {
                (Some(limit), Some(depth)) => format!("{limit:.3} mm (programmed {depth:.3} mm)"),
                _ => "deeper than what was sought".to_owned(),
            };
            Some(match unstable {
                0 => limit,
                count => format!("{limit}: unstable at {count} of {} points", self.points),
            })
        };
        let nominal = of(&self.nominal).unwrap_or_else(|| "not known".to_owned());
        let recommended = of(&self.recommended)?;
        Some(format!("Least stable depth: {recommended}; nominal: {nominal}."))
    }

    /// What is in the way at a placement, if anything is: ` (40 points are too near; at the worst spindle and wall touch)`.
    pub(crate) fn collision_in_words(&self, outcome: &OutcomeAnswer) -> String {
        let clearance = outcome.least_clearance_mm.zip(self.demanded_clearance_mm);
        let (Some([first, second]), Some((least, demanded))) = (&outcome.nearest, clearance) else {
            return String::new();
        };
        let points = match outcome.in_collision {
            1 => "one point is too near".to_owned(),
            count => format!("{count} points are too near"),
        };
        let there = match least > 0.0 {
            true => format!("are {least:.1} mm apart where {demanded:.1} mm are demanded"),
            false => "touch".to_owned(),
        };
        format!(" ({points}; at the worst {first} and {second} {there})")
    }

    /// The gain, its uncertainty, and whether it counts.
    fn gain_in_words(&self) -> String {
        let u = u_in_words(self.gain_u_um);
        let amount = format!("{} µm ({u})", micrometres(self.gain_um.max(0.0)));
        let least = micrometres(self.least_gain_um);
        match self.is_improvement {
            true => format!("The gain is {amount}; it is significant from {least} µm."),
            false => format!(
                "The gain of {amount} is not significant (from {least} µm): keep the nominal placement."
            ),
        }
    }

    /// The placement as text: `centre (700.0, 0.0, 1028.7) mm, tilt 90.0 deg`.
    pub fn place_in_words(&self) -> String {
        let place = &self.place;
        let [x, y, z] = place.centre_mm;
        let mut words = match &self.fixture {
            Some(name) => format!("fixture `{name}`, "),
            None => String::new(),
        };
        words += &format!("centre ({x:.1}, {y:.1}, {z:.1}) mm");
        if let Some(tilt) = place.tilt_deg {
            words += &format!(", tilt {tilt:.1} deg");
        }
        if let Some([rx, ry, rz]) = place.rotation_deg {
            words += &format!(", rotated by ({rx:.1}, {ry:.1}, {rz:.1}) deg");
        }
        if let Some(rail) = place.rail_mm {
            words += &format!(", rail at {rail:.1} mm");
        }
        if place.spin_deg != 0.0 {
            words += &format!(", tool spin changed by {:.1} deg", place.spin_deg);
        }
        words
    }

    /// Lines of a study file for this placement; none if not all points can be reached, or it is no improvement.
    pub fn study_lines(&self) -> String {
        if self.recommended.unreachable_points > 0 || !self.is_improvement {
            return String::new();
        }
        let place = &self.place;
        let list = |values: &[f64]| {
            let values: Vec<String> = values.iter().map(|value| format!("{value:.4}")).collect();
            format!("[{}]", values.join(", "))
        };
        let mut lines = format!("plane.centre_mm = {}\n", list(&place.centre_mm));
        if let Some(tilt) = place.tilt_deg {
            lines += &format!("plane.tilt_deg = {tilt:.4}\n");
        }
        if let Some(rotation) = place.rotation_deg {
            lines += &format!("plane.rotation_deg = {}\n", list(&rotation));
        }
        if let Some(branch) = &self.recommended.branch {
            lines += &format!("posture.branch = \"{branch}\"\n");
        }
        if let Some(home) = &self.home_deg {
            lines += &format!("posture.home_deg = {}\n", list(home));
        }
        if place.spin_deg != 0.0 {
            lines += &format!(
                "spin_deg = {:.4} # of a program: add this to program.spin_deg\n",
                place.spin_deg
            );
        }
        lines
    }
}

/// Its name in the study.
pub(super) fn rank_by_name(rank_by: RankBy) -> &'static str {
    match rank_by {
        RankBy::Nominal => "nominal",
        RankBy::PlusTwoSigma => "plus-two-sigma",
        RankBy::WithinTolerance(_) => "within-tolerance",
    }
}
