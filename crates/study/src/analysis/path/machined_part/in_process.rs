//! The in-process part: the stock after the first points of a path as it was followed.
//!
//! It goes on from the part that was reached before; for a point before that, from the nearest of some parts that are kept along the path.

use armill_core::machined::{CutBy, MachiningPath, MadePart, Stage};
use armill_core::path::Track;
use armill_core::removal::{DexelPart, RemovalError, SurfaceMesh};
use armill_core::watch::{Cancelled, Watch};

use super::cut::track_of;
use super::run::{MachinedPart, cut_track, refused, tip_deviations, turn_tolerance};
use super::setting::MachinedSetting;
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::runner::Runner;
use crate::error::StudyError;

/// Points that are cut between two checks for cancellation: what was cut before is kept.
const BLOCK: usize = 512;
/// Parts that are kept along the path, without the stock.
const KEPT: usize = 8;
/// Memory of these at most, bytes.
const MOST_KEPT_BYTES: usize = 256 << 20;

/// The stock, and the part after some points of the path.
#[derive(Clone, Debug)]
pub struct InProcessPart {
    track: Track,
    /// Displaced by the deviation of the tool.
    stages: Vec<Stage>,
    /// After ascending numbers of points: the stock first.
    kept: Vec<Reached>,
    reached: Reached,
}

/// The part after so many points.
#[derive(Clone, Debug)]
struct Reached {
    points: usize,
    part: DexelPart,
}

impl Runner<'_> {
    /// The stock of a path as it was followed; `None` if the study does not ask for its part.
    ///
    /// # Errors
    /// A stock that is not a solid; cancelled by the watch.
    pub fn in_process_part(
        &self,
        analysis: &PathAnalysis,
        found: &PathResult,
    ) -> Result<Option<InProcessPart>, StudyError> {
        let Some(machined) = &analysis.machined_part else {
            return Ok(None);
        };
        let track = &track_of(analysis, found);
        let motion = found.motion.as_ref();
        let displacement = |index: usize| analysis.setting.motion_displacement(motion, index);
        let followed = self.followed(analysis, (track, &found.along), &displacement);
        let deviations = tip_deviations(analysis, &followed, self.watch)?;
        let track = cut_track(analysis, track);
        let stages = machining_path(machined, &track).stages(Some(&deviations));
        Ok(Some(InProcessPart::new(analysis, machined, track, stages)?))
    }
}

fn machining_path<'a>(machined: &'a MachinedSetting, track: &'a Track) -> MachiningPath<'a> {
    MachiningPath {
        track,
        tools: &machined.tools,
        turn_tolerance: turn_tolerance(machined),
    }
}

impl InProcessPart {
    /// The stock of a finished part, with the same moves.
    ///
    /// # Errors
    /// A stock that is not a solid.
    pub fn of(
        analysis: &PathAnalysis,
        machined: &MachinedSetting,
        part: &MachinedPart,
    ) -> Result<InProcessPart, StudyError> {
        let [displaced, _] = &part.stages;
        InProcessPart::new(analysis, machined, part.track.clone(), displaced.clone())
    }

    fn new(
        analysis: &PathAnalysis,
        machined: &MachinedSetting,
        track: Track,
        stages: Vec<Stage>,
    ) -> Result<InProcessPart, StudyError> {
        let stock = DexelPart::new(&machined.stock.solid(), machined.cell, machined.directions);
        let stock = Reached {
            points: 0,
            part: stock.map_err(|error| refused(analysis, error))?,
        };
        Ok(InProcessPart {
            track,
            stages,
            kept: vec![stock.clone()],
            reached: stock,
        })
    }

    /// The part after the first `points` points of the path: with all moves that lead to one of them.
    ///
    /// # Errors
    /// Cancelled by the watch: what was cut until then is kept.
    pub fn after(
        &mut self,
        machined: &MachinedSetting,
        points: usize,
        watch: Watch<'_>,
    ) -> Result<&DexelPart, RemovalError> {
        let count = self.track.path.points.len();
        let points = points.min(count);
        let before = self.kept.iter().rfind(|kept| kept.points <= points);
        if let Some(before) =
            before.filter(|kept| points < self.reached.points || kept.points > self.reached.points)
        {
            self.reached = before.clone();
        }
        let spacing = count.div_ceil(KEPT + 1).max(1);
        while self.reached.points < points {
            if watch.is_cancelled() {
                return Err(Cancelled.into());
            }
            let next_kept = (self.reached.points / spacing + 1) * spacing;
            let end = points.min(self.reached.points + BLOCK).min(next_kept);
            self.advance(machined, end)?;
            if end == next_kept {
                self.keep();
            }
        }
        Ok(&self.reached.part)
    }

    /// Cuts the moves that lead to the points up to `end`, without it.
    fn advance(&mut self, machined: &MachinedSetting, end: usize) -> Result<(), RemovalError> {
        let range = self.reached.points..end;
        let stages = self.stages.iter().filter_map(|stage| {
            let place = |points: usize| stage.moves.partition_point(|at| (at.index as usize) < points);
            let moves = &stage.moves[place(range.start)..place(range.end)];
            (!moves.is_empty()).then(|| Stage {
                tool: stage.tool,
                moves: moves.to_vec(),
            })
        });
        let stages: Vec<Stage> = stages.collect();
        let part = self.reached.part.clone();
        let (part, _) = machining_path(machined, &self.track).cut(part, &stages, Watch::NONE)?;
        self.reached = Reached { points: end, part };
        Ok(())
    }

    /// Keeps the part that is reached, if there is memory for it.
    fn keep(&mut self) {
        let is_last = self
            .kept
            .last()
            .is_none_or(|kept| kept.points < self.reached.points);
        let bytes: usize = self.kept.iter().map(|kept| kept.part.bytes()).sum();
        if is_last && bytes + self.reached.part.bytes() <= MOST_KEPT_BYTES {
            self.kept.push(self.reached.clone());
        }
    }

    /// The surface of the part that is reached, with at most so many triangles.
    ///
    /// # Errors
    /// A part that is too large for a mesh.
    pub fn mesh(
        &self,
        machined: &MachinedSetting,
        most_triangles: usize,
    ) -> Result<SurfaceMesh, RemovalError> {
        let part = &self.reached.part;
        let made = MadePart {
            dexels: part,
            stock: machined.stock.solid(),
            cut_by: Some(CutBy {
                stages: &self.stages,
                tools: &machined.tools,
                turn_tolerance: turn_tolerance(machined),
            }),
        };
        part.surface_mesh(part.mesh_stride(most_triangles)?, made.normals())
    }
}
