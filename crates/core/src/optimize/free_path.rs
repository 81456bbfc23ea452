//! Placements of a path along which the tool leans or external axes move: a quick score of many, before a search along the path at a few.
//!
//! Each point is taken by itself, with its best posture among coarse settings of spin, lean and external axes: limits that connect points
//! (joint speed, rates of lean and axes) are left out, and so are settings between the coarse ones. A point without any such posture may
//! still have one between them. The score counts these points and has the cost of the others, as in [`super::placement`].

use rayon::prelude::*;

use super::column_at::fill;
use super::grid::AXES;
use super::placement::Score;
use super::posture_search::{Objective, PostureSearch};
use super::walk::WITHIN;
use super::window::Window;
use crate::clearance::ClearanceAlong;
use crate::kernel::{Column, Columns, PartPlacement, Question};
use crate::load::LeaningForces;
use crate::path::{CutStock, LoadedTrack};
use crate::watch::{Cancelled, Watch};

/// Values along each axis, at most.
const COARSE: [usize; AXES] = [12, 3, 3, 5, 3, 3];

/// A path on a part that is placed, and what is free along it.
#[derive(Clone, Copy, Debug)]
pub struct FreePath<'a> {
    /// The arm and the demanded clearance; the position of the part is that of each placement.
    pub question: &'a Question<'a>,
    /// The path with its load.
    pub path: LoadedTrack<'a>,
    /// What is free along it.
    pub search: &'a PostureSearch,
    /// The stock that it cuts, for a search along the path: the quick score does not include it.
    pub stock: Option<&'a CutStock<'a>>,
}

impl FreePath<'_> {
    /// The quick score of each placement, from these points of the path; the same for any number of threads.
    ///
    /// # Errors
    /// [`Cancelled`] if the watch cancels; it counts placements.
    pub fn quick_scores(
        &self,
        placements: &[PartPlacement],
        points: &[usize],
        watch: Watch<'_>,
    ) -> Result<Vec<Score>, Cancelled> {
        let score = |placement: &PartPlacement| {
            if watch.is_cancelled() {
                return Err(Cancelled);
            }
            let score = self.quick_score(placement, points);
            (watch.finished)(1);
            Ok(score)
        };
        placements.par_iter().map(score).collect()
    }

    fn quick_score(&self, placement: &PartPlacement, points: &[usize]) -> Score {
        let LoadedTrack { track, load } = self.path;
        let question = Question {
            clearance: self.question.clearance_with_part_at(&placement.base_from_part),
            ..*self.question
        };
        let there = track.moved(placement.base_from_part, placement.spin);
        let path = LoadedTrack { track: &there, load };
        let window = Window::coarse(self.search, COARSE);
        let mut columns = Columns::new(question.arm, question.home, self.search.wrist);
        columns.set_rail(placement.rail);
        let mut clearance = question.clearance_check().map(ClearanceAlong::new);
        let joint_count = question.arm.robot.joints().len();
        let forces = LeaningForces::of(load);
        let mut column = Column::default();
        let mut order: Vec<usize> = Vec::new();
        let (mut unreachable, mut worst, mut sum, mut above) = (0, 0.0_f64, 0.0, 0.0);
        for index in points {
            let maker = (&mut columns, &forces);
            fill(maker, path, *index, (self.search, &window), &mut column);
            let deviations = &column.deviations;
            order.clear();
            order.extend((0..deviations.len()).filter(|slot| deviations[*slot].is_finite()));
            order.sort_by(|a, b| deviations[*a].total_cmp(&deviations[*b]));
            // The clearance is checked of the best postures first, until one keeps it.
            let best = order.iter().find(|slot| {
                let joints = column.joints_of(**slot, joint_count);
                clearance
                    .as_mut()
                    .is_none_or(|clearance| clearance.is_kept(joints))
            });
            let Some(best) = best else {
                unreachable += 1;
                continue;
            };
            let deviation = deviations[*best];
            worst = worst.max(deviation);
            sum += deviation;
            if let Objective::Above(tolerance) = self.search.objective {
                above += (deviation - tolerance).max(0.0);
            }
        }
        let count = points.len().max(1) as f64;
        Score {
            unreachable,
            cost: match self.search.objective {
                Objective::Worst => worst,
                Objective::Mean => sum / count,
                Objective::Above(_) => (above + WITHIN * sum) / count,
            },
            branch: None,
        }
    }
}
