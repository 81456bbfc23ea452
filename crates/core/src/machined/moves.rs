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
//! cut before it ended and ends where the next one begins; of several rapids, each with its own axis, the first is displaced and rotated as at the
//! point before, so that a tool leaves its hole as it came, and the others as at that point. A rapid before a change of the tool has the tool before. Where the deviation is not known, the tool is where it is programmed.

use nalgebra::{Point3, Unit, Vector3};

use super::tip::TipDeviation;
use crate::path::{Move, Rapids, Track};
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

/// A tool on its way.
#[derive(Default)]
struct Way {
    stages: Vec<Stage>,
    /// Number of the tool.
    tool: usize,
    /// Where it was before.
    last: Option<Pose>,
}

impl Way {
    /// Adds the move to this pose; the first one only places the tool.
    fn go(&mut self, to: Pose, index: u32, is_rapid: bool) {
        if self.stages.last().is_none_or(|stage| stage.tool != self.tool) {
            self.stages.push(Stage {
                tool: self.tool,
                moves: Vec::new(),
            });
        }
        if let (Some(from), Some(stage)) = (self.last, self.stages.last_mut()) {
            stage.moves.push(ToolMove {
                ends: [from.0, to.0],
                axes: [from.1, to.1],
                index,
                is_rapid,
            });
        }
        self.last = Some(to);
    }
}

impl MachiningPath<'_> {
    /// The moves, as programmed or with these deviations, one for each point.
    pub fn stages(&self, deviations: Option<&[Option<TipDeviation>]>) -> Vec<Stage> {
        let path = &self.track.path;
        let mut way = Way::default();
        let mut tool = 0;
        let mut rapids = path.rapids.iter();
        for index in 0..path.points.len() {
            let before = tool;
            while self.tools.get(tool + 1).is_some_and(|next| next.first <= index) {
                tool += 1;
            }
            let pose = self.pose(index, deviations);
            if path.begins(index)
                && let Some(Rapids {
                    moves,
                    moves_before_tool_change,
                    ..
                }) = rapids.next()
            {
                let changed = moves_before_tool_change.unwrap_or(0);
                for (place, rapid) in moves.iter().enumerate() {
                    way.tool = if place < changed { before } else { tool };
                    let end = match place + 1 == moves.len() {
                        true => pose,
                        false if place == 0 => self.rapid_pose(index.saturating_sub(1), rapid, deviations),
                        false => self.rapid_pose(index, rapid, deviations),
                    };
                    way.go(end, index as u32, true);
                }
            }
            way.tool = tool;
            match path.begins(index) {
                true => way.last = Some(pose),
                false => way.go(pose, index as u32, false),
            }
        }
        way.stages
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
        self.displaced((point.at, placing.path_spindle(point)), index, deviations)
    }

    /// The tool at the end of a rapid, displaced as at this point.
    fn rapid_pose(&self, index: usize, rapid: &Move, deviations: Option<&[Option<TipDeviation>]>) -> Pose {
        let (placing, point) = (&self.track.placing, &self.track.path.points[index]);
        let axis = rapid.axis.filter(|_| !placing.keeps_axis);
        let pose = (rapid.end, axis.unwrap_or_else(|| placing.path_spindle(point)));
        self.displaced(pose, index, deviations)
    }

    /// A pose, displaced as at this point.
    fn displaced(
        &self,
        (tip, axis): Pose,
        index: usize,
        deviations: Option<&[Option<TipDeviation>]>,
    ) -> Pose {
        let placing = &self.track.placing;
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
