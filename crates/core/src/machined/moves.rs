//! The moves of the tools along a path, as programmed or displaced by the deviation of the arm.
//!
//! ```text
//! tip  = x + delta          axis = unit(a + omega x a)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x`, `a` | programmed tip and tool axis from the tip towards the spindle, path | m, - |
//! | `delta`, `omega` | displacement of the tip and rotation of the tool, path axes | m, rad |
//!
//! Between two points the deviation changes evenly. A step has the number of the point that it leads to, a rapid that of the first point after it. A rapid begins where the
//! cut before it ended and ends where the next one begins; between several rapids the tool is displaced as at that point. Where the deviation is not known, the tool is where it is programmed.

use nalgebra::{Point3, Unit, Vector3};

use super::tip::TipDeviation;
use crate::path::Track;
use crate::removal::{DexelPart, MoveRemoval, RemovalError, RotatingTool, ToolMove, ToolSolid};
use crate::watch::Watch;

/// A tool of a path.
#[derive(Clone, Debug)]
pub struct PathTool {
    /// The first point that it is used at.
    pub first: usize,
    /// What cuts.
    pub cutting: ToolSolid,
    /// Shank and holder in pieces, which must not touch material.
    pub clear: Vec<ToolSolid>,
}

/// A path and its tools.
#[derive(Clone, Copy, Debug)]
pub struct MachiningPath<'a> {
    /// Points and poses.
    pub track: &'a Track,
    /// At least one, in the order of their first points; the first begins at point 0.
    pub tools: &'a [PathTool],
    /// How far a turning axis may be off, m.
    pub turn_tolerance: f64,
}

/// Consecutive moves with one tool.
#[derive(Clone, Debug)]
pub struct Stage {
    /// Number of the tool.
    pub tool: usize,
    /// In their order; the index of each is a point of the path.
    pub moves: Vec<ToolMove>,
}

/// Tip and axis of a tool, path.
type Pose = (Point3<f64>, Unit<Vector3<f64>>);

impl MachiningPath<'_> {
    /// The moves, as programmed or with these deviations, one for each point.
    pub fn stages(&self, deviations: Option<&[Option<TipDeviation>]>) -> Vec<Stage> {
        let path = &self.track.path;
        let mut stages: Vec<Stage> = Vec::new();
        let mut tool = 0;
        // Where the tool was before.
        let mut last: Option<Pose> = None;
        let mut rapids = path.rapids.iter();
        for index in 0..path.points.len() {
            while self.tools.get(tool + 1).is_some_and(|next| next.first <= index) {
                tool += 1;
            }
            if stages.last().is_none_or(|stage| stage.tool != tool) {
                stages.push(Stage {
                    tool,
                    moves: Vec::new(),
                });
            }
            let Some(Stage { moves, .. }) = stages.last_mut() else {
                continue;
            };
            let pose = self.pose(index, deviations);
            let number = index as u32;
            if path.begins(index) {
                let off = pose.0 - path.points[index].at;
                let rapids = rapids.next().map_or(&[][..], |rapids| &rapids.moves);
                for (place, rapid) in rapids.iter().enumerate() {
                    let end = match place + 1 == rapids.len() {
                        true => pose,
                        false => (rapid.end + off, pose.1),
                    };
                    if let Some(from) = last {
                        moves.push(ToolMove {
                            ends: [from.0, end.0],
                            axes: [from.1, end.1],
                            index: number,
                            is_rapid: true,
                        });
                    }
                    last = Some(end);
                }
            } else if let Some(from) = last {
                moves.push(ToolMove {
                    ends: [from.0, pose.0],
                    axes: [from.1, pose.1],
                    index: number,
                    is_rapid: false,
                });
            }
            last = Some(pose);
        }
        stages
    }

    /// Number of moves.
    pub fn move_count(&self) -> usize {
        let path = &self.track.path;
        let rapids: usize = path.rapids.iter().map(|rapids| rapids.moves.len()).sum();
        path.points.len() + rapids
    }

    /// Cuts these stages, one after the other; what each move removed, in their order.
    ///
    /// # Errors
    /// As [`DexelPart::cut`].
    pub fn cut(
        &self,
        mut part: DexelPart,
        stages: &[Stage],
        watch: Watch<'_>,
    ) -> Result<(DexelPart, Vec<MoveRemoval>), RemovalError> {
        let mut removals = Vec::new();
        for Stage { tool, moves } in stages {
            let used = &self.tools[*tool];
            let tool = RotatingTool {
                cutting: &used.cutting,
                clear: &used.clear,
            };
            let (cut, of_stage) = part.cut(moves, &tool, self.turn_tolerance, watch)?;
            part = cut;
            removals.extend(of_stage);
        }
        Ok((part, removals))
    }

    /// The tool at a point.
    fn pose(&self, index: usize, deviations: Option<&[Option<TipDeviation>]>) -> Pose {
        let (placing, point) = (&self.track.placing, &self.track.path.points[index]);
        let (tip, axis) = (point.at, placing.path_spindle(point));
        let Some(deviation) = deviations.and_then(|all| all[index].as_ref()) else {
            return (tip, axis);
        };
        let path_from_base = placing.base_from_path.rotation.inverse();
        let displaced = tip + path_from_base * deviation.twist.linear;
        let rotation = path_from_base * deviation.twist.angular;
        (
            displaced,
            Unit::new_normalize(axis.into_inner() + rotation.cross(&axis)),
        )
    }
}
