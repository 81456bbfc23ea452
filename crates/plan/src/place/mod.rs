//! Search for the placement of the part with the least deviation along the path.
//!
//! ```text
//! free degrees -> placements spread over them -> best regions -> local search on all points -> certificate -> the study there
//! ```
//!
//! `chosen`: the path; `objective`: what placements are compared by; `freedom`: free degrees; `rail`: the joint that is one; `search`: from spread placements to the best; `certificate`:
//! whether grids contain a better one; `followed`: turns of the joints and forces along the path there; `rounds`: all of that for every fixture and margin; [`journal`]: state of an
//! interrupted search; [`answer`]: the values of the result; `result`: the study at the placement; `pictures`;
//! [`evaluate`]: scores of given placements; `leaning`: all of that where the tool leans or external axes move along the path. Theory: `docs/theory/placement.md`.
//!
//! If fixtures are given each is searched separately, and the best is used. For the margin to limits and singularities
//! the search is repeated for several margins, with the previous placement as an additional start.

pub mod answer;
mod certificate;
mod chosen;
pub mod evaluate;
mod fixture;
mod followed;
mod freedom;
pub mod journal;
mod leaning;
mod objective;
mod pictures;
mod rail;
mod result;
mod rounds;
mod search;

pub use answer::{MarginAnswer, OutcomeAnswer, PlacementAnswer};
pub use certificate::{CertificateAnswer, GridAnswer};
pub use evaluate::{PlacementParameters, PlacementScores};
pub use freedom::{FreeAnswer, PlaceAnswer};
pub use journal::Journal;
pub use result::PlacementResult;

use armill_core::kernel::{BranchChoice, PartPlacement};
use armill_core::load::{LoadFrame, PathLoad};
use armill_core::nalgebra::{Point3, UnitQuaternion, Vector3};
use armill_core::optimize::{PlacementObjective, PostureSearch, ToolTurn, on_part};
use armill_core::path::{LoadedTrack, Spin};
use armill_core::robot::BranchPattern;
use armill_core::units::{from_mm, to_deg, to_mm, to_um};
use armill_core::watch::Watch;
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::answer::search::{component_name, objective_name};
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use armill_study::file::placement::{FixtureTable, PlaceTable};
use armill_study::file::resolve::Study;
use armill_study::input::setting::Setting;
use armill_study::joint_unit::JointUnit;
use armill_study::number::decimals;

use self::answer::rank_by_name;
use self::chosen::chosen;
use self::fixture::plane_of;
use self::followed::{FollowedPath, Outcome, with_room};
use self::freedom::Freedom;
use self::leaning::LeaningRequest;
use self::objective::objective;
use self::rail::{check_rail, home_at, rail_of};
use self::rounds::{Best, FoundPlacements, MARGINS_DEG, Prepared, Site, SiteSearch};
use self::search::Effort;

/// Default range of the part in each direction, mm.
const USUAL_MM: f64 = 300.0;
/// Points of a long path.
const LONG: usize = 50_000;
/// A part that is turned by less is not turned, rad.
const TURNED: f64 = 1e-6;

/// A prepared search.
pub struct PlacementSearch<'a> {
    study: &'a Study,
    /// Index of the analysis.
    index: usize,
    name: &'a str,
    analysis: &'a PathAnalysis,
    /// Spins and branches that each point may have, for a set of holes.
    holes: Option<&'a PostureSearch>,
    table: PlaceTable,
    seed: u64,
    depth: SearchDepth,
}

/// How much a search does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SearchDepth {
    /// All.
    Full,
    /// A quarter of the placements, without further margins and with a coarse grid.
    Brief,
}

impl<'a> PlacementSearch<'a> {
    /// For the path named in `requested`, or in the table of the study, or the only one; what `requested` does not
    /// give is taken from the study, else the default.
    ///
    /// # Errors
    /// No such path, or several; empty bounds; words that name no branch.
    pub fn new(
        study: &'a Study,
        requested: PlaceTable,
        seed: u64,
    ) -> Result<PlacementSearch<'a>, StudyError> {
        let mut table = requested.or(study.place.clone().unwrap_or_default());
        let (index, chosen) = chosen(study, table.analysis.as_deref())?;
        let (name, (analysis, holes)) = (chosen.0, chosen.1);
        let stays = analysis
            .source
            .robot()
            .is_some_and(|robot| robot.cell.base_from_path.is_none());
        if stays {
            let message =
                format!("`{name}` is from a robot program, which is placed where its frame is given");
            let hint = "program.part_from_path_mm_deg = [0, 0, 0, 0, 0, 0] places its frame on the plane, which can be moved";
            return Err(StudyError::value(message, hint));
        }
        if let Some([least, greatest]) = table.rail_mm {
            check_rail(&study.robot.robot, [from_mm(least), from_mm(greatest)])?;
        }
        if holes.is_some() && table.spin_deg.is_some() {
            let message =
                "`spin_deg` changes the spin at all points alike, but each hole has its own best spin";
            return Err(StudyError::value(
                message,
                "posture.search.turns_deg bounds the spin of holes",
            ));
        }
        leaning::check(&table, free_search(analysis, holes.is_some()), &study.robot.robot)?;
        leaning::check_stability(analysis, free_search(analysis, holes.is_some()))?;
        let faults = table.faults();
        if let Some((_, _, hint)) = faults.first() {
            let messages: Vec<&str> = faults.iter().map(|(_, message, _)| message.as_str()).collect();
            return Err(StudyError::value(messages.join("; "), *hint));
        }
        if !table.is_free() {
            let at = analysis
                .setting
                .in_reference(&analysis.setting.plane.at(Point3::origin().xy()));
            let about = |at: f64| Some([to_mm(at) - USUAL_MM, to_mm(at) + USUAL_MM]);
            (table.x_mm, table.y_mm, table.z_mm) = (about(at.x), about(at.y), about(at.z));
        }
        Ok(PlacementSearch {
            study,
            index,
            name,
            analysis,
            holes,
            table,
            seed,
            depth: SearchDepth::Full,
        })
    }

    /// The same with a quarter of the effort: for one placement of several that are compared. Margins other than the
    /// requested one are not searched.
    #[must_use]
    pub fn brief(self) -> PlacementSearch<'a> {
        PlacementSearch {
            depth: SearchDepth::Brief,
            ..self
        }
    }

    /// [`PlacementSearch::brief`] for a path of more than 50 000 points: its search takes minutes otherwise.
    #[must_use]
    pub fn brief_if_long(self) -> PlacementSearch<'a> {
        match self.analysis.track.len() > LONG {
            true => self.brief(),
            false => self,
        }
    }

    /// Its study.
    pub fn study(&self) -> &Study {
        self.study
    }

    /// Name of the path.
    pub fn name(&self) -> &str {
        self.name
    }

    /// Whether it is a set of holes.
    pub fn is_of_holes(&self) -> bool {
        self.holes.is_some()
    }

    /// Approximate number of placements evaluated: the end of its progress.
    pub fn place_count(&self) -> usize {
        let effort = self.effort();
        let margins = match self.depth {
            SearchDepth::Full => MARGINS_DEG.len() - 1,
            SearchDepth::Brief => 0,
        };
        let sites = self.table.fixture.len().max(1);
        if self.free_search().is_some() {
            return sites * leaning::PLACEMENTS;
        }
        sites * (effort.most() + margins * effort.cheaper().most() + effort.grid)
    }

    /// What is free along the path, if the tool leans or external axes move.
    fn free_search(&self) -> Option<&'a PostureSearch> {
        free_search(self.analysis, self.is_of_holes())
    }

    fn effort(&self) -> Effort {
        let robot = &self.study.robot.robot;
        let effort = match robot.ortho_parallel().is_some() && self.analysis.setting.model.is_drives_alone() {
            true => Effort::lanes(self.analysis.track.len()),
            false => Effort::ONE_BY_ONE,
        };
        let effort = effort.shared_by(self.holes.map_or(1, |search| search.spins.count));
        match self.depth {
            SearchDepth::Full => effort,
            SearchDepth::Brief => Effort {
                grid: effort.grid / 4,
                ..effort.cheaper()
            },
        }
    }

    /// Searches; `given` receives the best so far, `watch` every placement.
    ///
    /// # Errors
    /// A robot without compliance; a path that misses its stock; cancelled by the watch; a journal that cannot be
    /// written.
    pub fn search(
        &self,
        journal: &mut Journal<'_>,
        watch: Watch<'_>,
        given: &dyn Fn(&str),
    ) -> Result<PlacementResult, StudyError> {
        if let Some(search) = self.free_search() {
            let turn = ToolTurn::of(&self.analysis.track);
            let request = LeaningRequest {
                robot: &self.study.robot.robot,
                named: (self.index, self.name, self.analysis),
                table: &self.table,
                search,
                sites: &self.sites(turn),
                nominal: &self.nominal(),
                seed: self.seed,
            };
            let (mut found, placement) = request.result(journal, (watch, given))?;
            found.answer.home_deg = (found.answer.place.rail_mm).and_then(|rail| self.home_with_rail(rail));
            found.answer.forces_stay = self.forces_stay(&placement);
            return Ok(found);
        }
        let quiet = Watch {
            finished: &|_| (),
            ..watch
        };
        let runner = Runner::new(&self.study.robot.robot, quiet)?;
        let (load, _) = runner.pushed(self.analysis)?;
        let objective = self.objective()?;
        let track = &self.analysis.track;
        let effort = self.effort();
        let all: Vec<usize> = (0..track.len()).collect();
        let stride = track.len().div_ceil(effort.points).max(1);
        let some: Vec<usize> = all.iter().copied().step_by(stride).collect();
        let on_part =
            |indices: &[usize]| on_part(LoadedTrack { track, load: &load }, objective.component, indices);
        let question = with_room(runner.question(&self.analysis.setting));
        let (all, some) = (on_part(&all), on_part(&some));
        let followed = FollowedPath {
            question: &question,
            path: LoadedTrack { track, load: &load },
            some: track.every(stride),
            analysis: self.analysis,
            watch: quiet,
        };
        let turn = ToolTurn::of(track);
        let sites = self.sites(turn);
        let prepared = Prepared {
            robot: &self.study.robot.robot,
            setting: &self.analysis.setting,
            seed: self.seed,
            question: &question,
            paths: [&some, &all],
            followed: &followed,
            sites: &sites,
            effort,
            watch,
            given,
        };
        journal.take_up(prepared.fingerprint(&objective));
        let search = SiteSearch {
            objective,
            effort,
            name: "",
            also: None,
        };
        let mut best = prepared.best(&search, journal)?;
        let mut front = match self.depth {
            SearchDepth::Full => prepared.front(objective, &best, journal)?,
            SearchDepth::Brief => Vec::new(),
        };
        if let Some((_, first)) = front.first() {
            best = first.clone();
        }
        let (best, certificate) = prepared.certified(best, objective, journal)?;
        if let Some((_, first)) = front.first_mut() {
            *first = best.clone();
        }
        let found = FoundPlacements {
            best,
            certificate,
            front,
        };
        let answer = self.answer(&prepared, objective, &found, journal.taken())?;
        let best = found.best;
        let freedom = &sites[best.site].freedom;
        let mut pictures = prepared
            .searched(freedom, objective, effort)
            .sections(&best.spot, &answer, watch)?;
        pictures.extend(pictures::front(&answer, self.analysis.setting.tolerance));
        Ok(PlacementResult {
            with_part: answer
                .tool_turns_with_part
                .then(|| self.tool_on_part(&freedom.part_placement(&best.spot.at))),
            analysis: self.index,
            is_of_holes: self.is_of_holes(),
            answer,
            pictures,
        })
    }

    /// The values of the result.
    fn answer(
        &self,
        prepared: &Prepared<'_>,
        objective: PlacementObjective,
        found: &FoundPlacements,
        rounds_taken_up: usize,
    ) -> Result<PlacementAnswer, StudyError> {
        let (track, setting) = (&self.analysis.track, &self.analysis.setting);
        let turn = ToolTurn::of(track);
        let drawn = self.nominal();
        let as_requested = PlacementObjective {
            branches: match setting.choice {
                BranchChoice::Of(pattern) => pattern,
                BranchChoice::Best => BranchPattern::default(),
            },
            ..objective
        };
        let followed = prepared.followed;
        let outcome = |freedom: &Freedom, objective: PlacementObjective, at: &[f64]| {
            followed.outcome(objective, &freedom.part_placement(at))
        };
        let of = |best: &Best| &prepared.sites[best.site];
        let best = &found.best;
        let place = of(best).freedom.answer(&best.spot.at);
        let nominal = outcome(&drawn, as_requested, &[])?;
        // The branch of the nominal placement, unless another one is a significant improvement.
        let there = &of(best).freedom;
        let least = &setting.least_gain;
        let mut recommended = outcome(there, objective, &best.spot.at)?;
        if let Some(branch) = nominal.evaluation.score.branch {
            let branches = BranchPattern::from(branch);
            let kept = outcome(
                there,
                PlacementObjective {
                    branches,
                    ..objective
                },
                &best.spot.at,
            )?;
            let lost = [&kept, &recommended].map(|outcome| outcome.evaluation.score.unreachable);
            if lost[0] == lost[1] && !followed.gain(&kept, &recommended)?.is_significant(least) {
                recommended = kept;
            }
        }
        let gain = followed.gain(&nominal, &recommended)?;
        let answer_of = |outcome: &Outcome| OutcomeAnswer::of(outcome, setting);
        let (nominal, recommended) = (answer_of(&nominal), answer_of(&recommended));
        let (lost, before) = (recommended.unreachable_points, nominal.unreachable_points);
        let is_improvement = lost < before || (lost == before && gain.is_significant(least));
        let mut by_margin = Vec::new();
        for (margin, best) in &found.front {
            by_margin.push(MarginAnswer {
                margin_deg: decimals(to_deg(*margin), 4),
                cost_um: answer_of(&outcome(&of(best).freedom, objective, &best.spot.at)?).cost_um,
                fixture: of(best).name.map(str::to_owned),
                place: of(best).freedom.answer(&best.spot.at),
            });
        }
        Ok(PlacementAnswer {
            format: 1,
            analysis: self.name.to_owned(),
            component: component_name(objective.component),
            objective: objective_name(objective.objective),
            margin_deg: decimals(to_deg(objective.margin), 4),
            rank_by: rank_by_name(objective.rank_by),
            nominal,
            recommended,
            is_improvement,
            gain_um: to_um(gain.by()),
            gain_u_um: gain.uncertainty.map(to_um),
            least_gain_um: to_um(gain.required(least)),
            fixture: of(best).name.map(str::to_owned),
            home_deg: place.rail_mm.and_then(|rail| self.home_with_rail(rail)),
            place,
            free: of(best).freedom.reported(&best.spot.at),
            certificate: found.certificate.clone(),
            by_margin,
            forces_stay: self.forces_stay(&there.part_placement(&best.spot.at)),
            seed: self.seed,
            points: track.len(),
            demanded_clearance_mm: setting.cell.as_ref().map(|cell| decimals(to_mm(cell.least), 4)),
            rounds_taken_up,
            searched_along: 0,
            tool_turns_with_part: turn == ToolTurn::WithPart
                && !matches!(track.placing.spin, Spin::AlongFeed(_)),
        })
    }

    /// `posture.home_deg` of the study with its rail at `rail_mm`.
    fn home_with_rail(&self, rail_mm: f64) -> Option<Vec<f64>> {
        let robot = &self.study.robot.robot;
        rail_of(robot)?;
        let home = home_at(robot, self.analysis.setting.home.as_deref(), from_mm(rail_mm));
        let scaled = home.iter().enumerate();
        Some(
            scaled
                .map(|(joint, at)| at * JointUnit::of(robot, joint).scale)
                .collect(),
        )
    }

    /// Whether forces in base axes do not turn with a part that is turned at this placement.
    fn forces_stay(&self, placement: &PartPlacement) -> bool {
        let turned =
            (self.analysis.track.base_from_part.rotation).angle_to(&placement.base_from_part.rotation);
        let frame = match &self.analysis.load {
            PathLoad::Cases(load) => Some(load.frame),
            PathLoad::OfEach { frame, .. } => Some(*frame),
            PathLoad::Cuts(_) => None,
        };
        turned > TURNED && frame == Some(LoadFrame::Base)
    }

    /// The tool on the part at each point, with its spin at this placement.
    fn tool_on_part(&self, part_placement: &PartPlacement) -> Vec<UnitQuaternion<f64>> {
        let track = &self.analysis.track;
        let part_from_base = track.base_from_part.inverse().rotation;
        let spin = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), part_placement.spin);
        let at = |index: usize| part_from_base * track.stop(index).base_from_tool.rotation * spin;
        (0..track.len()).map(at).collect()
    }

    fn objective(&self) -> Result<PlacementObjective, StudyError> {
        objective(&self.table, self.analysis, self.holes, &self.study.robot.robot)
    }

    /// Position of the rail in the study, m; 0 without one.
    fn rail(&self) -> f64 {
        let robot = &self.study.robot.robot;
        let home = robot.home(self.analysis.setting.home.as_deref());
        rail_of(robot).map_or(0.0, |joint| home[joint])
    }

    fn sites(&self, turn: ToolTurn) -> Vec<Site<'_>> {
        let setting = &self.analysis.setting;
        if self.table.fixture.is_empty() {
            return vec![Site {
                name: None,
                freedom: Freedom::new(setting, self.rail(), turn, &self.table),
            }];
        }
        let at = |fixture: &'_ FixtureTable| {
            let (plane, tilt) = plane_of(fixture, setting);
            let there = Setting {
                plane,
                tilt,
                ..setting.clone()
            };
            Freedom::new(&there, self.rail(), turn, &self.table)
        };
        let sites = self.table.fixture.iter().map(|fixture| Site {
            name: Some(&fixture.name),
            freedom: at(fixture),
        });
        sites.collect()
    }
}

/// What is free along a path, if the tool leans or external axes move.
fn free_search(analysis: &PathAnalysis, is_of_holes: bool) -> Option<&PostureSearch> {
    let search = analysis.setting.search.as_ref().filter(|_| !is_of_holes)?;
    (!search.is_of_spins()).then_some(search)
}
