//! The placement nearest to the present one at which the robot reaches the part.
//!
//! Some points of the analysis are moved together, without a turn: to the places of a coarse grid about the robot,
//! nearest first, and from the first one that is reached back towards the present place. A point is reached in a
//! posture of the requested branch inside the joint limits that keeps the demanded clearance of the cell; the part moves
//! with the plane.

use armill_core::clearance::ClearanceCheck;
use armill_core::frame::{Isometry, tool_orientation};
use armill_core::kernel::{BranchChoice, postures_at};
use armill_core::nalgebra::Vector3;
use armill_core::robot::{BranchPattern, PostureName, reach};
use armill_core::units::{from_mm, to_mm};
use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::resolve::plane_of;
use crate::analysis::{Sheet, Subject};
use crate::error::StudyError;
use crate::input::setting::Setting;
use crate::live::{EditedAnalysis, StudyText};

/// The nearest placement that the robot reaches.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ReachableAnswer {
    /// The key of the analysis that moves it: `plane.centre_mm` or `box.centre_mm`.
    pub key: &'static str,
    /// The new value of that key; `null` if no placement was found, or if the analysis gives the distances itself.
    pub centre_mm: Option<[f64; 3]>,
    /// Distance from the present placement.
    pub distance_mm: Option<f64>,
    /// Points of the analysis that were tested at each placement.
    pub tested_points: usize,
}

/// Points between the outermost ones that are tested at a placement.
const BETWEEN: usize = 10;
/// Places along half a side of the grid.
const GRID: i32 = 12;
/// Reach of an arm whose reach is not known, m.
const REACH: f64 = 2.0;
/// Halvings of the way back: a thousandth of the pitch of the grid.
const HALVINGS: usize = 10;

/// The placement of this analysis, or of the first, that is nearest to the present one and reached.
///
/// # Errors
/// Every problem of the text that concerns the analysis; no analysis of that name; cancelled by the watch.
pub fn reachable(
    text: StudyText<'_>,
    analysis: Option<&str>,
    watch: Watch<'_>,
) -> Result<ReachableAnswer, StudyError> {
    let edited = text.one_analysis(analysis)?;
    let of_box = edited.table.in_box.as_ref().and_then(|of| of.centre_mm);
    let mut placement = Placement::of(&edited)?;
    let key = match of_box {
        Some(_) => "box.centre_mm",
        None => "plane.centre_mm",
    };
    let tested_points = placement.tools.len();
    // Sections at given distances are not moved by the centre of the plane.
    let moved = match edited.table.distances_mm {
        Some(_) => None,
        None => placement.nearest(watch)?,
    };
    let setting = edited.setting(0)?;
    let centre = of_box.unwrap_or_else(|| plane_of(&edited.parsed.file.plane, &edited.table).centre_mm);
    let new = moved.map(|moved| {
        let moved = setting.base_from_reference.rotation.inverse() * moved;
        let new = Vector3::from(centre) + moved.map(to_mm);
        new.map(f64::round)
    });
    Ok(ReachableAnswer {
        key,
        centre_mm: new.map(Into::into),
        distance_mm: new.map(|new| (new - Vector3::from(centre)).norm().round()),
        tested_points,
    })
}

/// The points of an analysis that are moved.
struct Placement<'a> {
    edited: &'a EditedAnalysis<'a>,
    home: Option<&'a [f64]>,
    /// Permitted branches.
    branches: BranchPattern,
    /// Flange poses at the present place, base.
    tools: Vec<Isometry>,
    clearance: Option<MovedClearance<'a>>,
}

/// The check of the clearance, with the part where the points are moved.
struct MovedClearance<'a> {
    check: ClearanceCheck<'a>,
    /// The part at the present place, base; none if it is not moved.
    base_from_part: Option<Isometry>,
}

impl<'a> MovedClearance<'a> {
    fn of(edited: &'a EditedAnalysis<'a>, setting: &'a Setting) -> Option<MovedClearance<'a>> {
        let cell = setting.cell.as_ref()?;
        let robot = &edited.study.robot.robot;
        // A box has its own centre: its points are moved without the plane.
        let is_box = edited
            .table
            .in_box
            .as_ref()
            .is_some_and(|of| of.centre_mm.is_some());
        Some(MovedClearance {
            check: ClearanceCheck::new(cell.demanded(), robot, &setting.flange_from_tool),
            base_from_part: (!is_box).then_some(cell.base_from_part),
        })
    }

    /// Moves the part by this (m, base) from its present place.
    fn set_motion(&mut self, motion: &Vector3<f64>) {
        if let Some(part) = &self.base_from_part {
            let moved = Isometry::from_parts((part.translation.vector + motion).into(), part.rotation);
            self.check.set_part(&moved);
        }
    }
}

impl<'a> Placement<'a> {
    fn of(edited: &'a EditedAnalysis<'a>) -> Result<Placement<'a>, StudyError> {
        let setting = edited.setting(0)?;
        let mut branches = match setting.choice {
            BranchChoice::Of(pattern) => pattern,
            BranchChoice::Best => BranchPattern::default(),
        };
        let on_plane = |setting: &Setting, tcp: Vector3<f64>| {
            Isometry::from_parts(tcp.into(), tool_orientation(setting.plane.tool_axis(), 0.0))
        };
        let of_sheet = |sheet: &Sheet| -> Vec<Isometry> {
            let plane = sheet.setting.plane;
            (0..sheet.grid.len())
                .map(|index| plane.base_from_tool(sheet.grid.point(index), 0.0))
                .collect()
        };
        let tips: Vec<Isometry> = match &edited.study.analyses[0].subject {
            Subject::Map(sheet) => of_sheet(sheet),
            Subject::Sections(all) => all.iter().flat_map(|(_, sheet)| of_sheet(sheet)).collect(),
            Subject::Volume(setting, grid) => (0..grid.len())
                .map(|index| on_plane(setting, grid.point(index).coords))
                .collect(),
            Subject::Path(path) => (0..path.track.len())
                .map(|index| path.track.stop(index).base_from_tool)
                .collect(),
            Subject::Holes(holes) => {
                branches = holes.search.branches;
                let track = &holes.path.track;
                (0..track.len())
                    .map(|index| track.stop(index).base_from_tool)
                    .collect()
            }
        };
        let flange = setting.flange_from_tool.inverse();
        let tested = tested(&tips).into_iter().map(|index| tips[index] * flange);
        Ok(Placement {
            edited,
            home: setting.home.as_deref(),
            branches,
            tools: tested.collect(),
            clearance: MovedClearance::of(edited, setting),
        })
    }

    /// The smallest motion (m, base) found after which all points are reached; none if there is none.
    fn nearest(&mut self, watch: Watch<'_>) -> Result<Option<Vector3<f64>>, StudyError> {
        let robot = &self.edited.study.robot.robot;
        let whole = reach(robot).unwrap_or(REACH);
        let pitch = whole / f64::from(GRID);
        let sum: Vector3<f64> = self.tools.iter().map(|tool| tool.translation.vector).sum();
        let centre = sum / self.tools.len().max(1) as f64;
        let side = -GRID..=GRID;
        let at = |x, y, z| Vector3::new(f64::from(x), f64::from(y), f64::from(z)) * pitch;
        let mut motions: Vec<Vector3<f64>> = side
            .clone()
            .flat_map(|x| side.clone().map(move |y| (x, y)))
            .flat_map(|(x, y)| (-GRID / 2..=GRID).map(move |z| at(x, y, z) - centre))
            .collect();
        // Along the line towards the robot at the same height, finer than the grid.
        let level = Vector3::new(centre.x, centre.y, 0.0);
        motions.extend((1..=8 * GRID).map(|k| -level * f64::from(k) / f64::from(8 * GRID)));
        motions.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
        for motion in motions {
            if self.fits(&motion, watch)? {
                return self.back(&motion, watch).map(Some);
            }
        }
        Ok(None)
    }

    /// The shortest part of this motion after which all points are still reached, in whole millimetres.
    fn back(&mut self, motion: &Vector3<f64>, watch: Watch<'_>) -> Result<Vector3<f64>, StudyError> {
        let whole = |part: f64| (motion * part).map(|m| from_mm(to_mm(m).round()));
        let (mut lost, mut reached) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let part = 0.5 * (lost + reached);
            match self.fits(&whole(part), watch)? {
                true => reached = part,
                false => lost = part,
            }
        }
        // The whole motion is reached, its rounding may not be.
        match self.fits(&whole(reached), watch)? {
            true => Ok(whole(reached)),
            false => Ok(*motion),
        }
    }

    /// Whether all points are reached after this motion (m, base).
    fn fits(&mut self, motion: &Vector3<f64>, watch: Watch<'_>) -> Result<bool, StudyError> {
        let robot = &self.edited.study.robot.robot;
        if let Some(clearance) = &mut self.clearance {
            clearance.set_motion(motion);
        }
        for tool in &self.tools {
            let moved = Isometry::from_parts((tool.translation.vector + motion).into(), tool.rotation);
            let found = postures_at(robot, 1, |_| moved, self.home, watch)?;
            let joints = found.joints.chunks(robot.joints().len());
            let postures = found.names.iter().zip(&found.within_limits).zip(joints);
            let good = postures.into_iter().any(|((name, inside), joints)| {
                let permitted = match name {
                    PostureName::Branch(branch) => self.branches.matches(*branch),
                    PostureName::Sides(_) => true,
                };
                let mut is_clear = || match &mut self.clearance {
                    Some(clearance) => clearance.check.conflict(joints).is_none(),
                    None => true,
                };
                *inside && permitted && is_clear()
            });
            if !good {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// The points that are tested: the outermost one in each direction along axes and diagonals, and some between them.
fn tested(tips: &[Isometry]) -> Vec<usize> {
    let signs = [-1.0, 0.0, 1.0];
    let directions = signs
        .iter()
        .flat_map(|x| signs.iter().map(move |y| (*x, *y)))
        .flat_map(|(x, y)| signs.iter().map(move |z| Vector3::new(x, y, *z)));
    let outermost = |direction: Vector3<f64>| {
        let along = |index: &usize| tips[*index].translation.vector.dot(&direction);
        (0..tips.len()).max_by(|a, b| along(a).total_cmp(&along(b)))
    };
    let between = (0..BETWEEN)
        .map(|k| k * tips.len() / BETWEEN)
        .filter(|index| *index < tips.len());
    let mut indices: Vec<usize> = directions.filter_map(outermost).chain(between).collect();
    indices.sort_unstable();
    indices.dedup();
    indices
}
