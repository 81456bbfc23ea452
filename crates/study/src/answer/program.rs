//! A tool path program in the answer: a path like any other, with what only a program has beside it.

mod feature;

pub use feature::FeatureResult;

use armill_core::frame::Isometry;
use armill_core::kernel::{Answers, Held, evaluate};
use armill_core::map::Track;
use armill_core::nalgebra::{Translation3, UnitQuaternion};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use armill_core::workpiece::Plane;
use armill_formats::material::Material;
use serde::Serialize;

use super::limits::{LimitsResult, RestResult, StockResult};
use super::measured::{self, MeasuredResult};
use super::path::{PathResult, joint_ranges};
use super::point::{PointAnswer, SettingAnswer};
use crate::file::program::ProgramAsk;
use crate::file::resolve::{Setting, Study};
use crate::run::{ProgramFound, question};

/// What only a program has.
#[derive(Clone, Debug, Serialize)]
pub struct ProgramResult {
    /// Its file, as the study calls it.
    pub file: String,
    /// The format it is in.
    pub format: &'static str,
    /// Moves, rapids included.
    pub moves: usize,
    /// Length of all cuts.
    pub cutting_length_mm: f64,
    /// Time of the cuts whose feed is told.
    pub cutting_time_s: f64,
    /// Largest deviation along the track, by size.
    pub max_along_um: Option<f64>,
    /// Largest deviation across the track, by size: what walls get.
    pub max_cross_um: Option<f64>,
    /// Largest deviation along the tool, by size: what floors get.
    pub max_normal_um: Option<f64>,
    /// Stretches with the same tool and spindle speed.
    pub operations: Vec<OperationResult>,
    /// What became of the features asked for.
    pub features: Vec<FeatureResult>,
    /// Where it is worst, each from another part of the path.
    pub worst_points: Vec<WorstPoint>,
    /// Material of the cut that the forces were computed from; none where load cases were given.
    pub material: Option<String>,
    /// Points whose cut has no force: plunges and steep dives, where the bottom of the cutter is not modelled.
    pub points_without_force: usize,
    /// Largest mean and largest greatest force along the program, of the cut as drawn, where they were computed from it.
    pub largest_mean_and_peak_n: Option<[f64; 2]>,
    /// What the tool met in the stock, where the study tells one.
    pub stock: Option<StockResult>,
    /// How the force of the cut gave way with the tool.
    pub rest: Option<RestResult>,
    /// What keeps the tolerance everywhere.
    pub limits: Option<LimitsResult>,
    /// The record that the forces come from; none where they were not measured.
    pub measured: Option<MeasuredResult>,
    /// What was passed over in the program, or taken for granted.
    pub notes: Vec<String>,
    /// Where a joint jumps from one point to the next.
    pub jumps: Vec<String>,
}

/// A stretch with the same tool and spindle speed.
#[derive(Clone, Debug, Serialize)]
pub struct OperationResult {
    /// What the program calls it.
    pub name: Option<String>,
    /// Number of its tool.
    pub tool: Option<u32>,
    /// Line where it begins.
    pub line: u32,
    /// Its points.
    pub points: usize,
    /// Largest in-plane deviation.
    pub max_in_plane_um: Option<f64>,
}

/// A point where the deviation is large, and why.
#[derive(Clone, Debug, Serialize)]
pub struct WorstPoint {
    /// Line of the program.
    pub line: u32,
    /// Distance along all cuts.
    pub along_mm: f64,
    /// Deviation of the deciding case along the track, across it and along the tool.
    pub along_cross_normal_um: [f64; 3],
    /// What makes it large.
    pub cause: String,
    /// The point.
    pub point: PointAnswer,
}

/// Points told as worst at most.
const WORST: usize = 5;
/// Part of the size of the path, corner to corner, that one of them stands for.
const APART: f64 = 0.1;
/// A joint that turns farther than this from one point to the next jumps, rad.
const JUMP: f64 = 0.5;
/// Jumps told at most.
const MOST_JUMPS: usize = 10;
/// A feed that turns by more than this between two points turns sharply, rad.
const SHARP: f64 = 0.5;
/// A joint nearer to its limit than this is told, rad.
const NEAR_LIMIT: f64 = 0.087;

pub(super) fn answer(study: &Study, name: &str, ask: &ProgramAsk, found: &ProgramFound) -> PathResult {
    let (setting, answers) = (&ask.setting, &found.answer.answers);
    let told = Told { study, ask, found };
    let held = || answers.held().map(|(_, held)| held);
    let within = held().filter(|held| held.in_plane <= setting.limit).count();
    let points = answers.points.len();
    let worst_points = told.worst_points();
    let largest = |part: fn([f64; 3]) -> f64| {
        let of_point = |(i, _)| told.cases_at(i).map(part).fold(0.0_f64, |a, b| a.max(b.abs()));
        answers
            .held()
            .map(of_point)
            .max_by(f64::total_cmp)
            .map(|m| m * 1e6)
    };
    PathResult {
        name: name.to_owned(),
        branch: Setting {
            choice: found.answer.choice,
            ..setting.clone()
        }
        .branch(),
        points,
        unreached: points - held().count(),
        outside_joint_limits: held().filter(|held| !held.within_limits()).count(),
        max_in_plane_um: answers.worst().map(|(_, held)| held.in_plane * 1e6),
        min_in_plane_um: answers.best().map(|(_, held)| held.in_plane * 1e6),
        max_full_um: held().map(|held| held.full * 1e6).max_by(f64::total_cmp),
        fraction_within: within as f64 / points.max(1) as f64,
        roundness_um: told
            .features()
            .iter()
            .filter_map(|feature| feature.roundness_um)
            .max_by(f64::total_cmp),
        circle_cases: Vec::new(),
        worst: worst_points.first().map(|worst| worst.point.clone()),
        setting: SettingAnswer::of(study, setting),
        joint_range_deg: joint_ranges(study, answers),
        program: Some(ProgramResult {
            file: ask.file.clone(),
            format: ask.summary.format,
            moves: ask.moves,
            cutting_length_mm: ask.length * 1e3,
            cutting_time_s: ask.time,
            max_along_um: largest(|[along, ..]| along),
            max_cross_um: largest(|[_, cross, _]| cross),
            max_normal_um: largest(|[.., normal]| normal),
            operations: told.operations(),
            features: told.features(),
            worst_points,
            material: material(ask).map(|material| material.name.clone()),
            points_without_force: found.forces.map_or(0, |forces| forces.without_force),
            largest_mean_and_peak_n: found.forces.map(|forces| [forces.largest_mean, forces.greatest]),
            stock: found
                .forces
                .and_then(|forces| forces.met)
                .map(|met| StockResult::of(&met)),
            rest: found.answer.rested.map(|rested| RestResult::of(ask, &rested)),
            limits: LimitsResult::of(ask, found),
            measured: ask.measured.as_deref().map(MeasuredResult::of),
            notes: told.notes(),
            jumps: told.jumps(),
        }),
    }
}

/// What is cut or drilled.
fn material(ask: &ProgramAsk) -> Option<&Material> {
    let cut = ask.cut.as_ref().map(|cut| &cut.material);
    cut.or(ask.drill.as_ref().map(|drill| &drill.material))
}

struct Told<'a> {
    study: &'a Study,
    ask: &'a ProgramAsk,
    found: &'a ProgramFound,
}

impl Told<'_> {
    fn track(&self) -> &Track {
        &self.ask.track
    }

    /// Deviation of each case at a point along the track, across it and along the tool, m.
    fn cases_at(&self, index: usize) -> impl Iterator<Item = [f64; 3]> + '_ {
        let deviations = self.found.answer.answers.deviations_at(index).iter();
        deviations.map(move |deviation| {
            let parts = self.track().parts(index, deviation);
            [parts.along, parts.cross, parts.normal]
        })
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = self.ask.summary.notes.clone();
        if let Some(cut) = &self.ask.cut {
            notes.extend(super::limits::notes(self.ask, self.found));
            notes.extend(cut.remarks.iter().cloned());
        }
        notes.extend(
            self.ask
                .drill
                .iter()
                .flat_map(|drill| drill.remarks.iter().cloned()),
        );
        notes.extend(
            self.ask
                .measured
                .iter()
                .flat_map(|measured| measured::notes(measured)),
        );
        notes
    }

    fn operations(&self) -> Vec<OperationResult> {
        let all = &self.ask.operations;
        let end = |i: usize| {
            all.get(i + 1)
                .map_or(self.found.answer.answers.points.len(), |next| next.0)
        };
        let of = |(i, (first, operation)): (usize, &(usize, armill_core::path::Operation))| {
            let points = &self.found.answer.answers.points[*first..end(i)];
            let largest = points.iter().flatten().map(|held| held.in_plane * 1e6);
            OperationResult {
                name: operation.name.clone(),
                tool: operation.tool,
                line: operation.line,
                points: points.len(),
                max_in_plane_um: largest.max_by(f64::total_cmp),
            }
        };
        let told = all.iter().enumerate().map(of);
        told.filter(|operation| operation.points > 0).collect()
    }

    /// The worst point, then the worst of what is not near the ones before.
    fn worst_points(&self) -> Vec<WorstPoint> {
        let points = &self.track().points;
        let [low, high] = self.ask.track.corners();
        let apart = APART * (high - low).norm();
        let mut by_size: Vec<(usize, f64)> = self
            .found
            .answer
            .answers
            .held()
            .map(|(i, held)| (i, held.in_plane))
            .collect();
        let mut kept: Vec<usize> = Vec::new();
        // Only the largest are looked at: far more than are told, far fewer than a long path has.
        let most = by_size.len().min(by_size.len() / 10 + 10_000);
        if most < by_size.len() {
            by_size.select_nth_unstable_by(most, |a, b| b.1.total_cmp(&a.1));
            by_size.truncate(most);
        }
        by_size.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        for (index, _) in by_size {
            if kept.len() == WORST {
                break;
            }
            let near = |other: &usize| (points[index].at - points[*other].at).norm() < apart;
            if !kept.iter().any(near) {
                kept.push(index);
            }
        }
        kept.into_iter()
            .filter_map(|index| self.worst_point(index))
            .collect()
    }

    fn worst_point(&self, index: usize) -> Option<WorstPoint> {
        let (setting, answers) = self.here(index)?;
        let held = *answers.points.first()?.as_ref().ok()?;
        let parts = self
            .track()
            .parts(index, &answers.deviations_at(0)[held.deciding_case]);
        let at = setting.plane.base_from_part.translation.vector.into();
        let point = PointAnswer::of(self.study, &setting, &answers, (0, &held, at));
        Some(WorstPoint {
            line: self.track().points[index].line,
            along_mm: self.track().points[index].along * 1e3,
            along_cross_normal_um: [parts.along, parts.cross, parts.normal].map(|c| c * 1e6),
            cause: self.cause(index, &held, &point),
            point,
        })
    }

    /// One point asked in full: with shares and uncertainty, on a plane across the tool.
    fn here(&self, index: usize) -> Option<(Setting, Answers)> {
        let track = self.track();
        let mut cases = vec![Wrench::ZERO; self.found.answer.answers.case_count];
        track.wrenches(&self.found.answer.load, index, &mut cases);
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
            choice: self.found.answer.choice,
            // The arm stands as it does on the path, whatever its joints to spare.
            home: Some(self.found.answer.answers.joints_at(index).to_vec()),
            ..self.ask.setting.clone()
        };
        let robot = &self.study.robot.robot;
        let asked = question(robot, robot.compliance()?, &setting);
        let answers = evaluate(&asked, 1, |_| stop.base_from_tool, Watch::NONE).ok()?;
        Some((setting, answers))
    }

    fn cause(&self, index: usize, held: &Held, point: &PointAnswer) -> String {
        let names = self
            .ask
            .setting
            .model
            .sharer_names(self.study.robot.robot.joints());
        let largest = (0..names.len().min(point.joint_share_um.len())).max_by(|a, b| {
            point.joint_share_um[*a]
                .abs()
                .total_cmp(&point.joint_share_um[*b].abs())
        });
        let mut parts: Vec<String> = largest
            .filter(|_| point.in_plane_um > 0.0)
            .map(|i| {
                let share = 100.0 * point.joint_share_um[i] / point.in_plane_um;
                format!("{} {share:.0} %", names[i])
            })
            .into_iter()
            .collect();
        if let Some(singularity) = held.singularity {
            parts.push(format!("near the {singularity}"));
        }
        if held.limit_margin < NEAR_LIMIT {
            let joint = &self.study.robot.robot.joints()[held.limit_joint];
            parts.push(format!("joint {} at its limit", joint.name));
        }
        let points = &self.track().points;
        if let Some(before) = index.checked_sub(1).map(|i| &points[i]) {
            let turn = before.direction.angle(&points[index].direction);
            if turn > SHARP {
                parts.push(format!("the feed turns by {:.0} deg here", turn.to_degrees()));
            }
        }
        parts.join(", ")
    }

    /// Joints that jump between points next to each other on the path.
    fn jumps(&self) -> Vec<String> {
        let (answers, robot) = (&self.found.answer.answers, &self.study.robot.robot);
        let points = &self.track().points;
        let mut told = Vec::new();
        for index in 1..points.len() {
            // After a rapid the arm may have turned on the way.
            let follows = points[index].along > points[index - 1].along;
            if !follows || answers.points[index].is_err() || answers.points[index - 1].is_err() {
                continue;
            }
            for (joint, (before, after)) in answers
                .joints_at(index - 1)
                .iter()
                .zip(answers.joints_at(index))
                .enumerate()
            {
                let by = after - before;
                if robot.slides(joint) || by.abs() < JUMP {
                    continue;
                }
                if told.len() == MOST_JUMPS {
                    told.push("more jumps follow".to_owned());
                    return told;
                }
                told.push(format!(
                    "joint {} turns by {:.0} deg at once in line {}",
                    robot.joints()[joint].name,
                    by.to_degrees(),
                    points[index].line
                ));
            }
        }
        told
    }
}
