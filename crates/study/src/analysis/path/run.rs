//! A path with the core: its load, the postures along it, and all that follows from them.
//!
//! `along_path` or `postures_in_stock`, then `worst_points`, `radial_deviations`, `program_limits` of the core.

use armill_core::frame::Isometry;
use armill_core::kernel::{Answers, OnPath, evaluate_posture};
use armill_core::load::PathLoad;
use armill_core::map::{
    AlongPath, CutDemand, ProgramLimits, RadialDeviation, Vibrating, along_path, along_postures,
    measure_stock_clearances, obstacles, program_limits, radial_deviations, worst_points,
};
use armill_core::motion::Motion;
use armill_core::nalgebra::{Point3, Translation3, UnitQuaternion};
use armill_core::optimize::{
    FollowedTrack, Gain, Objective, PostureFound, PostureSearch, SearchedPath, gain_along, postures_in_stock,
};
use armill_core::path::{CutStock, ForceSummary, LoadedTrack, NoForces, Shape, Stock, Track};
use armill_core::spatial::Wrench;
use armill_core::units::to_mm;
use armill_core::watch::Cancelled;
use armill_core::workpiece::Plane;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::machined_part::MachinedPart;
use crate::analysis::path::process_loads::ProcessLoads;
use crate::analysis::path::vibration::{cuts, stability};
use crate::analysis::runner::Runner;
use crate::analysis::vibration::arm_modes::modes_at_tip;
use crate::error::StudyError;
use crate::input::setting::Setting;

/// The result along a path.
#[derive(Clone, Debug)]
pub struct PathResult {
    /// Its deviation.
    pub along: AlongPath,
    /// The worst points, worst first, each from another part of the path.
    pub worst: Vec<PointDetail>,
    /// On a circle that is a shape: its deviation under each load case.
    pub radial: Vec<RadialDeviation>,
    /// Statistics of its forces, if a cut or drill produces them.
    pub forces: Option<ForceSummary>,
    /// Force, torque, chip and removal rate along it, of a cut.
    pub process: Option<ProcessLoads>,
    /// The process limits, if they were requested and can be computed.
    pub limits: Option<ProgramLimits>,
    /// The motion along it, if it was requested; the load is then that at the feed that is reached.
    pub motion: Option<Motion>,
    /// The part that comes out, if it was requested and is cut ([`Runner::cut_part`]).
    pub machined_part: Option<Box<MachinedPart>>,
    /// The search for spins and branches, if there was one.
    pub searched: Option<SearchResult>,
}

/// A search for spins of the tool and branches along a path.
#[derive(Clone, Debug)]
pub struct SearchResult {
    /// The result of the search.
    pub posture: PostureFound,
    /// Whether the path is followed with this result: only where it is a significant improvement.
    pub applied: bool,
    /// The path as it is not followed: without the search where the result is applied, with it where it is not.
    pub other: AlongPath,
    /// The motion along it, if it was requested.
    pub other_motion: Option<Motion>,
    /// Number of points with an obstacle without and with the result.
    pub obstacles: [usize; 2],
    /// Number of points whose cut is not stable without and with the result, if it must be.
    pub unstable: Option<[usize; 2]>,
    /// Gain of the objective by the result.
    pub gain: Gain,
}

/// One point of a path, evaluated with shares and uncertainty on a plane across the tool.
#[derive(Clone, Debug)]
pub struct PointDetail {
    /// Which point.
    pub index: usize,
    /// Its setting.
    pub setting: Setting,
    /// Its answer.
    pub answers: Answers,
}

/// Number of worst points that are reported.
const WORST: usize = 5;

/// The number of passes over a path: a stock is cut in a separate pass. A search also evaluates the
/// path without it and passes over the lattice once or twice; if reversals have a penalty, once more, and evaluates
/// two chains.
pub fn passes(path: &PathAnalysis) -> usize {
    let searched = path.setting.search.as_ref().map_or(0, |search| {
        let worst = usize::from(search.objective == Objective::Worst);
        2 + worst + if search.back_price > 0.0 { 3 } else { 0 }
    });
    let tracks = 1 + usize::from(path.setting.search.is_some());
    let slowed = tracks * usize::from(path.setting.motion.is_some() && path.cut.is_some());
    let replayed = match (path.has_stock(), &path.setting.cell, &path.setting.search) {
        (false, ..) | (_, None, _) => 0,
        (true, Some(_), None) => 1 + slowed,
        (true, Some(_), Some(_)) => 2 + slowed,
    };
    1 + searched + usize::from(path.has_stock()) + replayed + slowed
}

/// Hint for a program that does not meet its stock.
const STOCK_HINT: &str = "check the position of the stock relative to the program";

/// A path that misses its stock would be within any tolerance.
fn nothing_cut(analysis: &PathAnalysis, stock: &Stock) -> StudyError {
    let mm = |corners: [Point3<f64>; 2]| {
        let [low, high] =
            corners.map(|at| format!("({:.1}, {:.1}, {:.1})", to_mm(at.x), to_mm(at.y), to_mm(at.z)));
        format!("{low} to {high} mm")
    };
    let message = format!(
        "{}: the program cuts nothing of its stock: the cuts extend from {}, the stock from {}",
        analysis.shown(),
        mm(analysis.track.path.corners()),
        mm(stock.corners())
    );
    StudyError::value(message, STOCK_HINT)
}

/// The cut of a path is not known, or was cancelled.
fn no_forces(analysis: &PathAnalysis, error: &NoForces) -> StudyError {
    match error {
        NoForces::Cancelled => StudyError::Cancelled(Cancelled),
        error => StudyError::value(format!("{}: {error}", analysis.shown()), STOCK_HINT),
    }
}

/// A path as it is followed.
pub struct Followed {
    /// The path with the spins that a search found; `None` without a search.
    pub turned: Option<Track>,
    /// The nominal load along it: of a cut with the lean that a search found.
    pub load: PathLoad,
    /// The answers along it.
    pub along: AlongPath,
    /// The result of the search.
    pub searched: Option<SearchResult>,
}

/// Spins and branches that a search found, and the path with them.
pub struct FoundSpins {
    /// The result of the search.
    pub posture: PostureFound,
    /// The path with the spins found.
    pub turned: Track,
    /// The nominal load along it: of a cut with the lean found.
    pub load: PathLoad,
    /// The answers along it.
    pub along: AlongPath,
}

impl Runner<'_> {
    /// The answers along a path, and all that follows from them in the branch that was followed.
    pub fn path(&self, analysis: &PathAnalysis) -> Result<PathResult, StudyError> {
        let (programmed, forces) = self.pushed(analysis)?;
        let question = self.question(&analysis.setting);
        let Followed {
            turned,
            load,
            mut along,
            mut searched,
        } = self.follow(analysis, programmed.clone())?;
        let forces = match (&load, &searched) {
            (PathLoad::Cuts(cuts), Some(searched))
                if searched.applied && searched.posture.leans.is_some() =>
            {
                forces.map(|forces| forces.of_leaning(cuts))
            }
            _ => forces,
        };
        let track = turned.as_ref().unwrap_or(&analysis.track);
        let limits = match analysis.reports_limits() {
            true => self.limits(analysis, track, &along)?,
            false => None,
        };
        let motion = self.move_along(analysis, track, &load, &mut along)?;
        if let Some(searched) = &mut searched {
            self.move_along_other(analysis, &programmed, searched)?;
        }
        if along.answers.clearances.is_empty() {
            along.answers.measure_clearances(&question);
        }
        let worst = worst_points(&analysis.track, &along.answers, WORST);
        Ok(PathResult {
            worst: worst
                .into_iter()
                .map(|index| self.in_full(analysis, track, (&along, motion.as_ref()), index))
                .collect(),
            radial: match analysis.shape() {
                Some(Shape::Circle { centre, .. }) => {
                    radial_deviations(&analysis.track, &along.answers, *centre)
                }
                _ => Vec::new(),
            },
            process: (analysis.cut.as_ref())
                .and_then(|cut| ProcessLoads::of(&cut.cutting, &analysis.track, &along.load)),
            machined_part: None,
            along,
            forces,
            limits,
            motion,
            searched,
        })
    }

    /// The process limits along a path; with its vibration, if the study asks for it.
    fn limits(
        &self,
        analysis: &PathAnalysis,
        track: &Track,
        along: &AlongPath,
    ) -> Result<Option<ProgramLimits>, StudyError> {
        let setting = &analysis.setting;
        let cuts = cuts(analysis, track, &along.load);
        let vibrating = |index: usize| {
            let cut = (cuts.as_ref()?.at)(index)?;
            let modes = modes_at_tip(
                self.robot,
                setting,
                along.answers.joints_at(index),
                &cut.base_from_feed,
            )?;
            Some(Vibrating {
                modes,
                spindle: cut.spindle,
            })
        };
        let demand = CutDemand {
            tolerance: setting.tolerance,
            vibrating: setting.vibration.is_some().then_some(&vibrating),
        };
        Ok(program_limits(
            &self.question(setting),
            track,
            along,
            demand,
            self.watch,
        )?)
    }

    /// The path under this load. A search that is requested changes its posture only where that is a significant
    /// improvement: fewer obstacles and unstable cuts, or as many and a gain beyond its uncertainty.
    pub fn follow(&self, analysis: &PathAnalysis, load: PathLoad) -> Result<Followed, StudyError> {
        let question = self.question(&analysis.setting);
        let track = &analysis.track;
        let mut nominal = along_path(&question, track, load.clone(), self.watch)?;
        self.keep_clear_of_stock(analysis, &mut nominal)?;
        let Some(search) = &analysis.setting.search else {
            return Ok(Followed {
                turned: None,
                load,
                along: nominal,
                searched: None,
            });
        };
        let FoundSpins {
            posture,
            turned,
            load: leaning,
            along: mut found,
        } = self.search(analysis, &load, search)?;
        self.keep_clear_of_stock(analysis, &mut found)?;
        let ways = [(track, &load, &nominal), (&turned, &leaning, &found)];
        let followed = ways.map(|(track, load, along)| FollowedTrack {
            path: LoadedTrack { track, load },
            choices: &along.choices,
            home: None,
        });
        let gain = gain_along(
            &question,
            followed,
            (search.component, search.objective),
            self.watch,
        )?;
        let number = |along: &AlongPath| obstacles(self.robot, &track.path, &along.answers, 0.0).count();
        let numbers = [number(&nominal), number(&found)];
        let [before, after] = ways.map(|(track, load, along)| {
            let followed = LoadedTrack { track, load };
            stability(self.robot, analysis, followed, &along.answers)
                .filter(|_| analysis.setting.must_be_stable())
                .map(|stability| stability.unstable)
        });
        let unstable = before.zip(after).map(|(before, after)| [before, after]);
        let significant = gain.is_significant(&analysis.setting.least_gain);
        let faults = [0, 1].map(|way: usize| numbers[way] + unstable.map_or(0, |unstable| unstable[way]));
        let applied = faults[1] < faults[0] || (faults[1] == faults[0] && significant);
        let (along, other) = match applied {
            true => (found, nominal),
            false => (nominal, found),
        };
        Ok(Followed {
            turned: applied.then_some(turned),
            load: if applied { leaning } else { load },
            along,
            searched: Some(SearchResult {
                posture,
                applied,
                other,
                other_motion: None,
                obstacles: numbers,
                unstable,
                gain,
            }),
        })
    }

    /// Measures the clearances along a path from the cell and from the stock as it becomes while it is cut: points that do not
    /// keep the demanded clearance from the stock are in collision. Nothing where the study has no stock or no bodies.
    pub fn keep_clear_of_stock(
        &self,
        analysis: &PathAnalysis,
        along: &mut AlongPath,
    ) -> Result<(), StudyError> {
        let Some(stock) = self.cut_stock(analysis)? else {
            return Ok(());
        };
        let question = self.question(&analysis.setting);
        Ok(measure_stock_clearances(&question, &stock, along, self.watch)?)
    }

    /// The stock that the path cuts, if a clearance from it is demanded.
    ///
    /// # Errors
    /// A tool of the program that is not possible.
    pub fn cut_stock<'a>(&self, analysis: &'a PathAnalysis) -> Result<Option<CutStock<'a>>, StudyError> {
        let is_demanded = analysis.setting.cell.is_some();
        let Some((cut, stock)) = analysis.cut_in_stock().filter(|_| is_demanded) else {
            return Ok(None);
        };
        let Track { path, placing, .. } = &analysis.track;
        let cut_stock = CutStock::new(&cut.cutting, (path, placing), stock);
        cut_stock.map(Some).map_err(|error| no_forces(analysis, &error))
    }

    /// The spins and branches that `search` finds along the path under this load, clear of its stock, and the path with them.
    pub fn search(
        &self,
        analysis: &PathAnalysis,
        load: &PathLoad,
        search: &PostureSearch,
    ) -> Result<FoundSpins, StudyError> {
        let question = self.question(&analysis.setting);
        let track = &analysis.track;
        let stock = self.cut_stock(analysis)?;
        let path = SearchedPath::new(LoadedTrack { track, load }, stock.as_ref());
        let posture = postures_in_stock(&question, path, search, self.watch)?;
        let turned = posture.turned(track);
        let load = posture.load(load);
        let along = along_postures(&question, &turned, load.clone(), posture.choices(), self.watch)?;
        Ok(FoundSpins {
            posture,
            turned,
            load,
            along,
        })
    }

    /// The load along a path: of a cut in a stock from the engagement of the tool there.
    pub fn pushed(&self, analysis: &PathAnalysis) -> Result<(PathLoad, Option<ForceSummary>), StudyError> {
        let Some((cut, stock)) = analysis.cut_in_stock() else {
            return Ok((analysis.load.clone(), analysis.forces));
        };
        let mut stock = stock.clone();
        let (path, placing) = (&analysis.track.path, &analysis.track.placing);
        let found = cut.cutting.along(path, placing, Some(&mut stock), self.watch);
        let found = found.map_err(|error| no_forces(analysis, &error))?;
        if found.cuts.points.iter().all(|here| here.cut.is_none()) {
            return Err(nothing_cut(analysis, &stock));
        }
        Ok((PathLoad::Cuts(found.cuts), Some(found.summary)))
    }

    /// One point of a path evaluated separately: under the forces found there, in the branch that was followed, on a
    /// plane through the TCP across the tool, so that shares and uncertainty are available.
    fn in_full(
        &self,
        analysis: &PathAnalysis,
        track: &Track,
        (along, motion): (&AlongPath, Option<&Motion>),
        index: usize,
    ) -> PointDetail {
        let mut cases = vec![Wrench::ZERO; along.answers.case_count];
        track.wrenches(&along.load, index, &mut cases);
        let stop = track.stop(index);
        let across = Plane {
            base_from_part: Isometry::from_parts(
                Translation3::from(stop.base_from_tool.translation.vector),
                UnitQuaternion::from_rotation_matrix(&track.base_from_surface(index)),
            ),
        };
        let setting = Setting {
            plane: across,
            tilt: None,
            cases,
            ..analysis.setting.clone()
        };
        let unloaded = along.backlash_geometry.as_ref();
        let on_path = OnPath {
            link_offsets: unloaded.map(|unloaded| unloaded.link_offsets_at(index, along.answers.joint_count)),
            motion: setting.motion_displacement(motion, index),
        };
        let joints = along.answers.joints_at(index);
        let answers = evaluate_posture(&self.question(&setting), joints, on_path);
        PointDetail {
            index,
            setting,
            answers,
        }
    }
}
