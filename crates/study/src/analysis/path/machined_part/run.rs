//! The part that comes out of a path: cut as programmed and with the deviations of the arm, and compared.

use armill_core::form::FormError;
use armill_core::machined::{
    CutBy, FollowedPath, MachiningPath, MadePart, MaterialDifference, PartComparison, SearchReach, Stage,
    SurfaceComparison, SurfaceDeviation, TipDeviation, is_known, material_difference, worst_places,
};
use armill_core::map::AlongPath;
use armill_core::motion::Motion;
use armill_core::nalgebra::Vector3;
use armill_core::path::{Shape, Track};
use armill_core::removal::{DexelPart, EndOrigin, MoveRemoval, RemovalError, StockSolid};
use armill_core::robot::Robot;
use armill_core::source::{Deviation, MotionDisplacement};
use armill_core::watch::{Cancelled, Watch};

use super::mesh::{ComparedSurface, MOST_TRIANGLES, PartMesh};
use super::scan::{self, ScanComparison};
use super::scan_contributions::{ScanContributions, contributions};
use super::scan_tips::tips;
use super::setting::{MachinedSetting, NominalPart, ScanSetting};
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::to_measure::MeasuredTip;
use crate::analysis::runner::Runner;
use crate::error::StudyError;

/// A part that came out of a path.
#[derive(Clone, Debug)]
pub struct MachinedPart {
    /// Its surface, compared with the nominal one; only where the deviation of the tool is known.
    pub surface: SurfaceComparison,
    /// Area where the deviation of the tool is not known, m^2.
    pub unknown_area: f64,
    /// Material left and removed too much.
    pub difference: MaterialDifference,
    /// Volume removed from the stock, m^3.
    pub removed: f64,
    /// Points of the path before which a rapid meets material, and those where shank or holder does.
    pub contacts: Contacts,
    /// Deviation of the tool at each point.
    pub deviations: Vec<Option<TipDeviation>>,
    /// The part.
    pub part: DexelPart,
    /// The nominal part.
    pub nominal: DexelPart,
    /// What made the part, and what made the nominal part if that is the program.
    pub stages: [Vec<Stage>; 2],
    /// The worst places, worst first.
    pub worst: Vec<WorstPlace>,
    /// The measured part, if the study names a scan.
    pub scan: Option<MeasuredPart>,
    /// The nominal surface as triangles, with its deviations.
    pub mesh: PartMesh,
    /// The path that the part was cut along: closed if it is a circle.
    pub track: Track,
}

/// A measured part, compared with the prediction.
#[derive(Clone, Debug)]
pub struct MeasuredPart {
    /// Measured and predicted deviations.
    pub comparison: ScanComparison,
    /// What joints, springs and motion contribute to the prediction.
    pub contributions: ScanContributions,
    /// Where the tool was by the measured points.
    pub tips: Vec<MeasuredTip>,
}

/// Where what must not touch material does: points of the path.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Contacts {
    /// Of the rapids before them.
    pub rapids: Vec<usize>,
    /// Of shank or holder.
    pub shank: Vec<usize>,
}

/// A place with a large deviation.
#[derive(Clone, Debug)]
pub struct WorstPlace {
    /// Its point of the surface.
    pub point: SurfaceDeviation,
    /// The point of the path whose move made the surface, and the deviation of the tool there with its shares.
    pub tool: Option<(usize, Deviation)>,
}

/// Worst places that are reported.
const WORST: usize = 5;
/// Their least distance, in diagonals of the stock.
const APART: f64 = 0.08;
/// How far from the nominal surface the part is searched, in radii of the largest tool.
const REACH: f64 = 1.0;
/// Turning axes are exact to this part of a cell.
const TURN: f64 = 0.02;
/// Least tolerance of turning axes, m.
const LEAST_TURN: f64 = 1e-6;

impl Runner<'_> {
    /// The part that comes out of `track` in these postures, which is meant to be that of the track `nominal`; `None` if the study does not ask for it.
    ///
    /// # Errors
    /// A stock that is not a solid; cancelled by the watch.
    pub fn machined_part(
        &self,
        analysis: &PathAnalysis,
        nominal: &Track,
        (track, along): (&Track, &AlongPath),
        motion: Option<&Motion>,
    ) -> Result<Option<MachinedPart>, StudyError> {
        let Some(machined) = &analysis.machined_part else {
            return Ok(None);
        };
        let displacement = |index: usize| analysis.setting.motion_displacement(motion, index);
        let followed = self.followed(analysis, (track, along), &displacement);
        let deviations = tip_deviations(analysis, &followed, self.watch)?;
        let (track, nominal) = (cut_track(analysis, track), cut_track(analysis, nominal));
        let cut = self.cut(machined, [&track, &nominal], &deviations);
        let cut = cut.map_err(|error| refused(analysis, error))?;
        let points = along.answers.points.len();
        let shares = |point: &SurfaceDeviation| {
            let index = point.made_by.move_index()? % points;
            Some((index, followed.deviation_at(index)?))
        };
        let corners = cut.part.corners();
        let apart = APART * (corners[1] - corners[0]).norm();
        let worst = worst_places(&cut.surface.points, WORST, apart).into_iter();
        let worst = worst
            .map(|index| cut.surface.points[index])
            .map(|point| WorstPlace {
                tool: shares(&point),
                point,
            });
        let mut part = MachinedPart {
            mesh: PartMesh::default(),
            scan: None,
            worst: worst.collect(),
            surface: cut.surface,
            unknown_area: cut.unknown_area,
            difference: material_difference(&cut.part, &cut.nominal),
            removed: cut.removed,
            contacts: cut.contacts,
            part: cut.part,
            nominal: cut.nominal,
            stages: cut.stages,
            deviations,
            track,
        };
        let mesh = part.triangles(self, analysis, machined);
        part.mesh = mesh.map_err(|error| refused(analysis, error))?;
        if let Some(scan) = &machined.scan {
            let found = part.measured(scan, machined, |index| followed.deviation_at(index % points));
            let found = found.map_err(|error| {
                let message = format!("{}: {error} ({})", analysis.shown(), scan.file);
                StudyError::value(message, "check the frame, the unit and `farthest_mm` of the scan")
            });
            part.scan = Some(found?);
        }
        Ok(Some(part))
    }

    /// The path of an analysis as it is followed; `motion`: the displacement by the motion at a point, if there is one.
    pub(super) fn followed<'a>(
        &'a self,
        analysis: &'a PathAnalysis,
        (track, along): (&'a Track, &'a AlongPath),
        motion: &'a (dyn Fn(usize) -> Option<MotionDisplacement> + Sync),
    ) -> FollowedPath<'a> {
        FollowedPath {
            arm: self.question(&analysis.setting).arm,
            uncertainty: analysis.setting.uncertainty,
            track,
            along,
            motion,
        }
    }

    fn cut(
        &self,
        machined: &MachinedSetting,
        [track, nominal]: [&Track; 2],
        deviations: &[Option<TipDeviation>],
    ) -> Result<CutPart, RemovalError> {
        let stock = DexelPart::new(&machined.stock.solid(), machined.cell, machined.directions)?;
        let turn_tolerance = turn_tolerance(machined);
        let path = |track| MachiningPath {
            track,
            tools: &machined.tools,
            turn_tolerance,
        };
        let (path, nominal_path) = (path(track), path(nominal));
        let stages = [path.stages(Some(deviations)), nominal_path.stages(None)];
        let uncut = stock.volume();
        let (programmed, removals) = nominal_path.cut(stock.clone(), &stages[1], self.watch)?;
        let nominal = match &machined.nominal {
            NominalPart::Program => programmed,
            NominalPart::Mesh(triangles) => {
                stock.on_same_raster(&StockSolid::Mesh(triangles), machined.cell)?
            }
        };
        let (part, _) = path.cut(stock, &stages[0], self.watch)?;
        let comparison = comparison(machined, [&part, &nominal], [&stages[0], &stages[1]]);
        let surface = comparison.surface(self.watch)?;
        let (surface, unknown_area) = known(surface, deviations);
        Ok(CutPart {
            removed: uncut - part.volume(),
            contacts: contacts(&stages[1], &removals),
            part,
            nominal,
            surface,
            unknown_area,
            stages,
        })
    }
}

/// The deviation of the tool at each point of a path as it is cut.
///
/// # Errors
/// Cancelled by the watch.
pub(super) fn tip_deviations(
    analysis: &PathAnalysis,
    followed: &FollowedPath<'_>,
    watch: Watch<'_>,
) -> Result<Vec<Option<TipDeviation>>, Cancelled> {
    let mut deviations = followed.deviations(watch)?;
    if let Some(Shape::Circle { .. }) = analysis.shape() {
        deviations.extend(deviations.first().copied());
    }
    Ok(deviations)
}

/// The path that a part is cut along: closed if it is a circle.
pub(super) fn cut_track(analysis: &PathAnalysis, track: &Track) -> Track {
    match analysis.shape() {
        Some(shape @ Shape::Circle { .. }) => track.closed(shape.length()),
        _ => track.clone(),
    }
}

/// Why a part of this analysis cannot be cut.
pub(crate) fn refused(analysis: &PathAnalysis, error: RemovalError) -> StudyError {
    match error {
        RemovalError::Cancelled(cancelled) => StudyError::from(cancelled),
        error => StudyError::value(
            format!("{}: {error}", analysis.shown()),
            "check `machined_part`: stock, cell_mm, tool",
        ),
    }
}

/// How far a turning axis may be off, m.
pub(super) fn turn_tolerance(machined: &MachinedSetting) -> f64 {
    (TURN * machined.cell).max(LEAST_TURN)
}

/// The comparison of the part and the nominal part, which these stages made.
fn comparison<'a>(
    machined: &'a MachinedSetting,
    [part, nominal]: [&'a DexelPart; 2],
    [displaced, programmed]: [&'a [Stage]; 2],
) -> PartComparison<'a> {
    let cut_by = |stages| CutBy {
        stages,
        tools: &machined.tools,
        turn_tolerance: turn_tolerance(machined),
    };
    let made = |dexels, stages| MadePart {
        dexels,
        stock: machined.stock.solid(),
        cut_by: Some(cut_by(stages)),
    };
    let wanted = match &machined.nominal {
        NominalPart::Program => made(nominal, programmed),
        NominalPart::Mesh(triangles) => MadePart {
            dexels: nominal,
            stock: StockSolid::Mesh(triangles),
            cut_by: None,
        },
    };
    let radii = machined.tools.iter().map(|tool| tool.cutting.radius());
    let reach = SearchReach {
        most: REACH * radii.fold(machined.cell, f64::max),
        cell: machined.cell,
    };
    PartComparison::new(made(part, displaced), wanted, reach)
}

impl MachinedPart {
    /// The comparison of the part with the nominal part.
    pub fn comparison<'a>(&'a self, machined: &'a MachinedSetting) -> PartComparison<'a> {
        let [displaced, programmed] = &self.stages;
        comparison(machined, [&self.part, &self.nominal], [displaced, programmed])
    }

    /// The measured part; `at`: the deviation of the tool at a point of the path with its shares.
    fn measured(
        &self,
        scan: &ScanSetting,
        machined: &MachinedSetting,
        at: impl Fn(usize) -> Option<Deviation> + Sync,
    ) -> Result<MeasuredPart, FormError> {
        let nominal = scan::nominal_surface(&machined.nominal, &self.mesh)?;
        let comparison = scan::compared(scan, &nominal, &self.mesh)?;
        let of_part = (&self.mesh, &self.track);
        Ok(MeasuredPart {
            contributions: contributions((scan, &nominal), &comparison, of_part, &at)?,
            tips: tips(&comparison, of_part, &at),
            comparison,
        })
    }

    /// The nominal surface as triangles.
    fn triangles(
        &self,
        runner: &Runner<'_>,
        analysis: &PathAnalysis,
        machined: &MachinedSetting,
    ) -> Result<PartMesh, RemovalError> {
        let compared = ComparedSurface {
            nominal: &self.nominal,
            comparison: self.comparison(machined),
            deviations: &self.deviations,
            variance: self.variance(runner.robot, analysis),
        };
        compared.triangles(MOST_TRIANGLES, runner.watch)
    }

    /// Variance of the deviation along a normal (path) of a surface that a move makes, m^2: of the position of the tip there. `None` where it is not known.
    pub fn variance(
        &self,
        robot: &Robot,
        analysis: &PathAnalysis,
    ) -> impl Fn(EndOrigin, &Vector3<f64>) -> Option<f64> {
        let is_known = analysis.setting.arm(robot).has_known_uncertainty();
        let base_from_path = self.track.placing.base_from_path.rotation;
        move |made_by, normal| {
            let index = made_by.move_index().filter(|_| is_known)?;
            let TipDeviation { covariance, .. } = self.deviations.get(index)?.as_ref()?;
            let normal = base_from_path * normal;
            Some(normal.dot(&(covariance * normal)).max(0.0))
        }
    }

    /// Standard uncertainty of the deviation at a point of the surface, m; `None` where it is not known.
    pub fn uncertainty(
        &self,
        robot: &Robot,
        analysis: &PathAnalysis,
    ) -> impl Fn(&SurfaceDeviation) -> Option<f64> {
        let variance = self.variance(robot, analysis);
        move |point| variance(point.made_by, &point.normal).map(f64::sqrt)
    }
}

/// The parts and the surface.
struct CutPart {
    part: DexelPart,
    nominal: DexelPart,
    surface: SurfaceComparison,
    unknown_area: f64,
    removed: f64,
    contacts: Contacts,
    stages: [Vec<Stage>; 2],
}

/// The surface without what a tool made whose deviation is not known, and the area of that, m^2.
fn known(surface: SurfaceComparison, deviations: &[Option<TipDeviation>]) -> (SurfaceComparison, f64) {
    let (known, unknown): (Vec<_>, Vec<_>) = surface
        .points
        .into_iter()
        .partition(|point| is_known(deviations, point.made_by));
    let area = unknown
        .iter()
        .map(|point| point.area)
        .fold(0.0, |sum, area| sum + area);
    let surface = SurfaceComparison {
        points: known,
        ..surface
    };
    (surface, area)
}

/// Where rapids, shank or holder meet material as programmed. (A tool that springs back without load touches what it has left, which is no fault of the program.)
fn contacts(stages: &[Stage], removals: &[MoveRemoval]) -> Contacts {
    let mut found = Contacts::default();
    let moves = stages.iter().flat_map(|stage| &stage.moves);
    for (of, removal) in moves.zip(removals) {
        let index = of.index as usize;
        if removal.is_rapid_in_material(of) && found.rapids.last() != Some(&index) {
            found.rapids.push(index);
        }
        if !of.is_rapid && removal.contact > 0.0 && found.shank.last() != Some(&index) {
            found.shank.push(index);
        }
    }
    found
}
