//! Runs a study: every ask through the core.
//!
//! | ask | door of the core | what comes out |
//! |---|---|---|
//! | map, sections | `plane_map`, once a plane | a `PlaneMap` each |
//! | volume | `volume_map` | a `VolumeMap` |
//! | holes | `holes_held` | a `HolesFound` |
//! | path | `along_path`, then `worst_points`, `jumps`, `radial_deviations`, `program_limits` | a [`PathFound`] |
//!
//! Asks are done one after the other, the points of each on all threads. What comes out keeps hold of what was asked,
//! so that answers and pictures need nothing else.

use armill_core::frame::Isometry;
use armill_core::kernel::{Answers, Question, evaluate, evaluate_on_path};
use armill_core::load::PathLoad;
use armill_core::map::{
    AlongPath, Jump, PlaneMap, ProgramLimits, RadialDeviation, VolumeMap, along_path, along_postures, jumps,
    plane_map, program_limits, radial_deviations, volume_map, worst_points,
};
use armill_core::nalgebra::{Point3, Translation3, UnitQuaternion};
use armill_core::optimize::{Goal, HolesFound, PostureFound, PostureSearch, holes_held, postures_along};
use armill_core::path::{ForcesTold, NoForces, Shape, Stock, Track};
use armill_core::robot::{JointCompliance, Robot};
use armill_core::source::Arm;
use armill_core::spatial::Wrench;
use armill_core::watch::{Cancelled, Watch};
use armill_core::workpiece::Plane;

use crate::error::StudyError;
use crate::file::holes::HolesAnalysis;
use crate::file::path::PathAnalysis;
use crate::file::resolve::{Ask, Setting, Sheet, Study, Subject};

/// One ask, done.
#[derive(Clone, Debug)]
pub struct Done<'a> {
    /// Its name.
    pub name: &'a str,
    /// What came out.
    pub found: Found<'a>,
}

/// What came out of one ask, beside what was asked.
#[derive(Clone, Debug)]
pub enum Found<'a> {
    /// One plane.
    Map(&'a Sheet, PlaneMap),
    /// Several planes, in the order asked.
    Sections(Vec<Section<'a>>),
    /// A box of points.
    Volume(&'a Setting, VolumeMap),
    /// A path.
    Path(&'a PathAnalysis, Box<PathFound>),
    /// Holes.
    Holes(&'a HolesAnalysis, Box<HolesFound>),
}

/// One plane of a series.
#[derive(Clone, Debug)]
pub struct Section<'a> {
    /// What tells it from the others.
    pub label: &'a str,
    /// What was asked.
    pub sheet: &'a Sheet,
    /// What came out.
    pub map: PlaneMap,
}

/// What came out along a path.
#[derive(Clone, Debug)]
pub struct PathFound {
    /// Its deviation.
    pub along: AlongPath,
    /// Where it is worst, worst first, each from another part of the path.
    pub worst: Vec<InFull>,
    /// Where the arm jumps, as many as are told and one more.
    pub jumps: Vec<Jump>,
    /// On a circle that is a shape: what becomes of it under each load case.
    pub radial: Vec<RadialDeviation>,
    /// What is worth telling of its forces, where a cut or drill makes them.
    pub forces: Option<ForcesTold>,
    /// What keeps the tolerance, where that was asked and can be told.
    pub limits: Option<ProgramLimits>,
    /// Turns and branches that were searched for, where they were.
    pub searched: Option<Searched>,
}

/// Turns of the tool and branches along a path.
#[derive(Clone, Debug)]
pub struct Searched {
    /// What was found.
    pub posture: PostureFound,
    /// The path with the turn and the branch that it has without.
    pub as_asked: Answers,
}

/// One point of a path, asked with shares and uncertainty on a plane across the tool.
#[derive(Clone, Debug)]
pub struct InFull {
    /// Which point.
    pub index: usize,
    /// How it was asked.
    pub setting: Setting,
    /// The answer, alone.
    pub answers: Answers,
}

/// Points told as worst at most.
const WORST: usize = 5;
/// Jumps told at most.
pub(crate) const MOST_JUMPS: usize = 10;

/// How many points the study asks for.
///
/// The points that the progress of `run` ends at: those of a path in a stock count twice, since the stock is cut in a
/// pass of its own.
pub fn point_count(study: &Study) -> usize {
    let of = |analysis: &Ask| match &analysis.subject {
        Subject::Map(sheet) => sheet.grid.len(),
        Subject::Sections(sections) => sections.iter().map(|(_, sheet)| sheet.grid.len()).sum(),
        Subject::Volume(_, grid) => grid.len(),
        Subject::Path(path) => path.track.len() * passes(path),
        Subject::Holes(holes) => holes.path.track.len(),
    };
    study.analyses.iter().map(of).sum()
}

/// How often a path is passed over until it is followed: a stock is cut in a pass of its own, and a search answers the path
/// without it too and passes over the lattice once or twice; where turning back has a price once more, and answers two
/// chains.
pub(crate) fn passes(path: &PathAnalysis) -> usize {
    let searched = path.setting.search.map_or(0, |search| {
        let worst = usize::from(search.objective == Goal::Worst);
        2 + worst + if search.back_price > 0.0 { 3 } else { 0 }
    });
    1 + searched + usize::from(path.has_stock())
}

/// All asks of the study, done in its order on the threads of the current rayon pool.
///
/// # Errors
/// Cancelled by the watch; a robot without compliance; a path that misses its stock.
///
/// `watch` hears of every point and may cancel. The same study gives the same values on any number of threads.
pub fn run<'a>(study: &'a Study, watch: Watch<'_>) -> Result<Vec<Done<'a>>, StudyError> {
    let runner = runner(study, watch)?;
    let done = |analysis: &'a Ask| {
        let found = runner.find(analysis)?;
        Ok(Done {
            name: &analysis.name,
            found,
        })
    };
    study.analyses.iter().map(done).collect()
}

/// What asks of this study are done with.
///
/// # Errors
/// A robot without compliance.
pub(crate) fn runner<'a>(study: &'a Study, watch: Watch<'a>) -> Result<Runner<'a>, StudyError> {
    let robot = &study.robot.robot;
    let compliance = robot.compliance().ok_or_else(|| {
        let message = format!("robot `{}` has no joint compliance", robot.name());
        StudyError::value(message, "see `armill check`")
    })?;
    Ok(Runner {
        robot,
        compliance,
        watch,
    })
}

/// What to ask oneself where a path and its stock do not meet.
const BESIDE_STOCK: &str = "is the stock where the program cuts?";

/// A path that misses its stock would hold any tolerance.
fn nothing_cut(analysis: &PathAnalysis, stock: &Stock) -> StudyError {
    let mm = |corners: [Point3<f64>; 2]| {
        let [low, high] =
            corners.map(|at| format!("({:.1}, {:.1}, {:.1})", at.x * 1e3, at.y * 1e3, at.z * 1e3));
        format!("{low} to {high} mm")
    };
    let message = format!(
        "{}: the program cuts nothing of its stock: the cuts go from {}, the stock from {}",
        analysis.shown(),
        mm(analysis.track.path.corners()),
        mm(stock.corners())
    );
    StudyError::value(message, BESIDE_STOCK)
}

/// The robot of the study, and who watches.
pub(crate) struct Runner<'a> {
    /// The arm.
    pub robot: &'a Robot,
    compliance: &'a [JointCompliance],
    /// Who hears of the work.
    pub watch: Watch<'a>,
}

/// A path as it is followed.
pub(crate) struct Followed {
    /// The path with the turns that a search found; `None` without a search.
    pub turned: Option<Track>,
    /// What came out along it.
    pub along: AlongPath,
    /// What the search found.
    pub searched: Option<Searched>,
}

impl Runner<'_> {
    /// What comes out of one ask.
    fn find<'s>(&self, analysis: &'s Ask) -> Result<Found<'s>, StudyError> {
        Ok(match &analysis.subject {
            Subject::Map(sheet) => Found::Map(sheet, self.map(sheet)?),
            Subject::Sections(sections) => {
                let section = |(label, sheet): &'s (String, Sheet)| {
                    let map = self.map(sheet)?;
                    Ok(Section { label, sheet, map })
                };
                Found::Sections(sections.iter().map(section).collect::<Result<_, StudyError>>()?)
            }
            Subject::Volume(setting, grid) => {
                let question = self.question(setting);
                Found::Volume(setting, volume_map(&question, setting.plane, *grid, self.watch)?)
            }
            Subject::Path(path) => Found::Path(path, Box::new(self.path(path)?)),
            Subject::Holes(holes) => {
                let (path, question) = (&holes.path, self.question(&holes.path.setting));
                let of = (&path.track, &path.load);
                let found = holes_held(&question, of, &holes.search, self.watch)?;
                Found::Holes(holes, Box::new(found))
            }
        })
    }

    /// The answers over one plane.
    fn map(&self, sheet: &Sheet) -> Result<PlaneMap, StudyError> {
        let question = self.question(&sheet.setting);
        Ok(plane_map(&question, sheet.setting.plane, sheet.grid, self.watch)?)
    }

    /// The answers along a path, and all that follows from them in the branch that was followed.
    pub(crate) fn path(&self, analysis: &PathAnalysis) -> Result<PathFound, StudyError> {
        let (load, forces) = self.pushed(analysis)?;
        let question = self.question(&analysis.setting);
        let Followed {
            turned,
            along,
            searched,
        } = self.follow(analysis, load)?;
        let track = turned.as_ref().unwrap_or(&analysis.track);
        let limits = match analysis.tells_limits() {
            true => program_limits(&question, &analysis.track, &along, analysis.setting.limit, self.watch)?,
            false => None,
        };
        let worst = worst_points(&analysis.track, &along.answers, WORST);
        Ok(PathFound {
            worst: worst
                .into_iter()
                .map(|index| self.in_full((analysis, track), &along, index))
                .collect::<Result<_, Cancelled>>()?,
            jumps: jumps(self.robot, &analysis.track.path, &along.answers)
                .take(MOST_JUMPS + 1)
                .collect(),
            radial: match analysis.shape() {
                Some(Shape::Circle { centre, .. }) => radial_deviations(&analysis.track, &along.answers, *centre),
                _ => Vec::new(),
            },
            along,
            forces,
            limits,
            searched,
        })
    }

    /// The path under this load, turned as a search finds it where one is asked for.
    pub(crate) fn follow(&self, analysis: &PathAnalysis, load: PathLoad) -> Result<Followed, StudyError> {
        let question = self.question(&analysis.setting);
        let Some(search) = &analysis.setting.search else {
            let along = along_path(&question, &analysis.track, load, self.watch)?;
            return Ok(Followed {
                turned: None,
                along,
                searched: None,
            });
        };
        let searched = self.search(analysis, &load, search)?;
        let turned = searched.posture.turned(&analysis.track);
        let choices = searched.posture.choices();
        Ok(Followed {
            along: along_postures(&question, (&turned, load), choices, self.watch)?,
            turned: Some(turned),
            searched: Some(searched),
        })
    }

    /// The best turns and branches along a path, and the path as it is without them.
    fn search(&self, analysis: &PathAnalysis, load: &PathLoad, search: &PostureSearch) -> Result<Searched, StudyError> {
        let question = self.question(&analysis.setting);
        let as_asked = along_path(&question, &analysis.track, load.clone(), self.watch)?;
        Ok(Searched {
            as_asked: as_asked.answers,
            posture: postures_along(&question, (&analysis.track, load), search, self.watch)?,
        })
    }

    /// What pushes along a path: of a cut in a stock what the tool meets there.
    pub(crate) fn pushed(&self, analysis: &PathAnalysis) -> Result<(PathLoad, Option<ForcesTold>), StudyError> {
        let in_stock = analysis.cut.as_ref().and_then(|cut| Some((cut, cut.stock.clone()?)));
        let Some((cut, mut stock)) = in_stock else {
            return Ok((analysis.load.clone(), analysis.forces));
        };
        let (path, placing) = (&analysis.track.path, &analysis.track.placing);
        let found = cut.cutting.along(path, placing, Some(&mut stock), self.watch);
        let found = found.map_err(|error| match error {
            NoForces::Cancelled => StudyError::Cancelled(Cancelled),
            error => StudyError::value(format!("{}: {error}", analysis.shown()), BESIDE_STOCK),
        })?;
        if found.cuts.points.iter().all(|here| here.cut.is_none()) {
            return Err(nothing_cut(analysis, &stock));
        }
        Ok((PathLoad::Cuts(found.cuts), Some(found.given)))
    }

    /// One point of a path asked by itself: under the forces found there, in the branch that was followed, on a plane
    /// through the TCP across the tool, so that shares and uncertainty are told.
    fn in_full(
        &self,
        (analysis, track): (&PathAnalysis, &Track),
        along: &AlongPath,
        index: usize,
    ) -> Result<InFull, Cancelled> {
        let mut cases = vec![Wrench::ZERO; along.answers.case_count];
        track.wrenches(&along.load, index, &mut cases);
        let stop = track.stop(index);
        let across = Plane {
            base_from_part: Isometry::from_parts(
                Translation3::from(stop.base_from_tool.translation.vector),
                UnitQuaternion::from_rotation_matrix(&track.base_from_feed(index)),
            ),
        };
        let setting = Setting {
            plane: across,
            tilt: None,
            cases,
            choice: along.choice_at(index),
            // The arm stands as it does on the path, whatever its joints to spare.
            home: Some(along.answers.joints_at(index).to_vec()),
            ..analysis.setting.clone()
        };
        let question = self.question(&setting);
        let answers = match &along.unloaded {
            Some(unloaded) => {
                let dragged = unloaded.dragged_at(index, along.answers.joint_count);
                evaluate_on_path(&question, &stop.base_from_tool, dragged)
            }
            None => evaluate(&question, 1, |_| stop.base_from_tool, Watch::NONE)?,
        };
        Ok(InFull {
            index,
            setting,
            answers,
        })
    }

    /// What the core is asked under this setting.
    pub(crate) fn question<'q>(&'q self, setting: &'q Setting) -> Question<'q> {
        Question {
            arm: Arm {
                robot: self.robot,
                compliance: self.compliance,
                model: &setting.model,
                flange_from_tool: &setting.flange_from_tool,
            },
            home: setting.home.as_deref(),
            cases: &setting.cases,
            uncertainty: setting.uncertainty,
            normal: setting.plane.normal(),
            choice: setting.choice,
        }
    }
}
