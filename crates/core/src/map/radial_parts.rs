//! Parts of the radial deviation of a circle: the part without load, and the effect of each uncertain input on the part
//! of the load.
//!
//! ```text
//! dr(a) = without(a) + load(a)                     without: the same path in the same postures, no wrench
//! d_m(a) = sum over k of L_mk e . (s_k(w) - s_k(0))        S = L^T L
//! d_0(a) = m e . (delta(w) - delta(0))                       by the model error
//! u^2(a) = sum over m of d_m^2(a)
//! g_i(a) = e . s_i u_i u(b_i)/b_i                     of the part without load, by the uncertainty of a backlash
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `without` | gravity, backlash, geometry: as measured by a ball-bar | m |
//! | `d_m` | change of the load's part by one standard uncertainty of an independent input | m |
//! | `s_k(w)` | displacement per unit of compliance k under the wrench `w` | m/(rad/(N m)) |
//! | `S` | covariance of the compliances | |
//! | `delta(w)`, `m` | displacement under the wrench `w`; model error, as a fraction of it | m, 1 |
//! | `g_i` | change of `without` by one standard uncertainty of a backlash | m |
//! | `u_i`, `b_i`, `u(b_i)` | offset of a link in its backlash, the backlash, its standard uncertainty | rad (m) |
//! | `e` | unit vector outwards | 1 |
//!
//! An uncertain input is the same all round the circle: its curve keeps its sign, and its centre and radius are removed
//! as for any curve.

use nalgebra::{Point2, Vector3};

use super::along::{AlongPath, along_postures};
use super::radial::radial_deviations;
use crate::frame::Isometry;
use crate::kernel::Question;
use crate::load::{LoadCases, LoadFrame, PathLoad};
use crate::motion::Motion;
use crate::path::Track;
use crate::robot::forward::{Frames, forward_into};
use crate::source::arm_state::LoadedPosture;
use crate::source::{Arm, ArmState, Unstable, compliance_changes};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// A circle without load: outward deviations, m.
#[derive(Clone, Debug, PartialEq)]
pub struct WithoutLoad {
    /// At each point.
    pub outward: Vec<f64>,
    /// Its change by one standard uncertainty of each backlash: one curve per backlash, independent of each other.
    pub uncertainties: Vec<Vec<f64>>,
}

/// The circle about `centre` (path x and y, m) without load, in the postures of `along`; `None` where only the load
/// moves the tool, or a point is not reached.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
pub fn radial_without_load(
    question: &Question<'_>,
    track: &Track,
    along: &AlongPath,
    centre: Point2<f64>,
    watch: Watch<'_>,
) -> Result<Option<WithoutLoad>, Cancelled> {
    let model = question.arm.model;
    if !model.has_unloaded_deviation() && model.gravity.is_none() {
        return Ok(None);
    }
    let nothing = PathLoad::Cases(LoadCases {
        frame: LoadFrame::Base,
        cases: vec![Wrench::ZERO],
    });
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    let found = along_postures(question, track, nothing, along.choices.clone(), quiet)?;
    let given = radial_deviations(track, &found.answers, centre);
    Ok(given.into_iter().next().map(|case| WithoutLoad {
        outward: case.outward,
        uncertainties: backlash_uncertainties(&question.arm, track, &found, centre),
    }))
}

/// Outward displacement (m) of the unloaded circle by one standard uncertainty of each backlash, in proportion to the
/// backlash, of the thermal growth, of the learnt residual, and of each independent input of the geometry.
fn backlash_uncertainties(
    arm: &Arm<'_>,
    track: &Track,
    found: &AlongPath,
    centre: Point2<f64>,
) -> Vec<Vec<f64>> {
    let Some(effect) = &found.backlash_geometry else {
        return Vec::new();
    };
    let joints = found.answers.joint_count;
    let unsure: Vec<(usize, f64)> = (arm.model.structure.joints_with_backlash())
        .filter(|(_, gap)| gap.standard_uncertainty > 0.0)
        .map(|(joint, gap)| (joint, gap.standard_uncertainty / gap.gap))
        .collect();
    let mut arm_state = ArmState::new(*arm);
    let mut curves = vec![Vec::with_capacity(track.len()); unsure.len()];
    let mut thermal = Vec::with_capacity(track.len());
    let learnt = arm.model.structure.learnt.as_ref();
    let mut by_learnt: [Vec<f64>; 3] = Default::default();
    let inputs = (arm.model.structure.geometry.as_ref()).map_or(0, |geometry| geometry.inputs());
    let mut by_geometry = vec![Vec::with_capacity(track.len()); inputs];
    for index in 0..track.len() {
        arm_state.set_joints(found.answers.joints_at(index));
        let outward = outwards(track, index, centre);
        let link_offsets = effect.link_offsets_at(index, joints);
        for (curve, (joint, relative)) in curves.iter_mut().zip(&unsure) {
            let moved = arm_state.backlash_of(*joint, link_offsets, &Wrench::ZERO).linear;
            curve.push(moved.dot(&outward) * relative);
        }
        thermal.push(arm_state.thermal_uncertainty().dot(&outward));
        for (curve, moved) in by_geometry.iter_mut().zip(arm_state.geometry_uncertainty()) {
            curve.push(moved.linear.dot(&outward));
        }
        let here = learnt.map(|learnt| learnt.at(found.answers.joints_at(index)).uncertainty);
        for (curve, u) in by_learnt.iter_mut().zip(here.into_iter().flatten()) {
            curve.push(u.dot(&outward));
        }
    }
    if arm
        .model
        .thermal
        .is_some_and(|thermal| thermal.standard_uncertainty > 0.0)
    {
        curves.push(thermal);
    }
    if learnt.is_some() {
        curves.extend(by_learnt);
    }
    curves.extend(by_geometry);
    curves
}

/// Outward displacement (m) at each point by rounded corners, and by joints that follow late.
pub fn radial_motion(track: &Track, motion: &Motion, centre: Point2<f64>) -> [Vec<f64>; 2] {
    [&motion.blending, &motion.servo].map(|moved| {
        let moved = moved.iter().enumerate();
        moved
            .map(|(index, by)| by.dot(&outwards(track, index, centre)))
            .collect()
    })
}

/// The unit vector (base) from `centre` to point `index` of the circle.
fn outwards(track: &Track, index: usize, centre: Point2<f64>) -> Vector3<f64> {
    let at = track.path.points[index].at.xy() - centre;
    track.placing.base_from_path.rotation * at.push(0.0).normalize()
}

/// Change (m) of the outward deviation under load by one standard uncertainty of each independent input (compliances,
/// load and tool), point by point: one curve per input. The mean of the first `cases` load cases; inputs without an
/// effect are left out, all of them where a point is not reached.
pub fn radial_uncertainties(
    question: &Question<'_>,
    track: &Track,
    along: &AlongPath,
    centre: Point2<f64>,
    cases: usize,
) -> Vec<Vec<f64>> {
    let answers = &along.answers;
    if answers.points.iter().any(Result::is_err) || cases == 0 {
        return Vec::new();
    }
    let mut room = Room::new(question);
    let mut wrenches = vec![Wrench::ZERO; along.load.case_count()];
    let mut curves: Vec<Vec<f64>> = Vec::new();
    for index in 0..answers.points.len() {
        track.wrenches(&along.load, index, &mut wrenches);
        let outward = outwards(track, index, centre);
        let joints = answers.joints_at(index);
        let base_from_tool = track.stop(index).base_from_tool;
        let of_case = |wrench| room.moves(joints, &base_from_tool, wrench, &outward);
        let moved: Result<Vec<Vec<f64>>, Unstable> = wrenches.iter().take(cases).map(of_case).collect();
        // The nominal arm has an equilibrium under the load; with a changed input it may not.
        let Ok(moved) = moved else {
            return Vec::new();
        };
        let count = moved.len() as f64;
        curves.resize(moved[0].len(), Vec::new());
        for (unknown, curve) in curves.iter_mut().enumerate() {
            curve.push(moved.iter().map(|case| case[unknown]).sum::<f64>() / count);
        }
    }
    curves.retain(|curve| curve.iter().any(|by| *by != 0.0));
    curves
}

/// An arm at one point after the other.
struct Room<'q> {
    question: Question<'q>,
    arm_state: ArmState<'q>,
    frames: Frames,
    /// Rows of `L`: compliances of one independent input each.
    unknowns: Vec<Vec<f64>>,
}

impl<'q> Room<'q> {
    fn new(question: &Question<'q>) -> Room<'q> {
        Room {
            question: *question,
            arm_state: ArmState::new(question.arm),
            frames: Frames::for_robot(question.arm.robot),
            unknowns: compliance_changes(&question.arm),
        }
    }

    /// Displacement of the tool along `outward` by each input at these joint positions, m.
    fn moves(
        &mut self,
        joints: &[f64],
        base_from_tool: &Isometry,
        wrench: &Wrench,
        outward: &Vector3<f64>,
    ) -> Result<Vec<f64>, Unstable> {
        let Room {
            question,
            arm_state,
            frames,
            unknowns,
        } = self;
        forward_into(question.arm.robot, joints, frames);
        arm_state.set_frames(joints, frames, &base_from_tool.translation.vector.into());
        let size = arm_state.screws().len();
        // By each compliance, and last by the model error.
        let mut sensitive = |wrench: &Wrench| -> Result<Vec<f64>, Unstable> {
            arm_state.elastic(wrench)?;
            let by_compliance = (0..size).map(|k| arm_state.sensitivity(k).dot(outward));
            Ok(by_compliance
                .chain([arm_state.model_error().dot(outward)])
                .collect())
        };
        let without = sensitive(&Wrench::ZERO)?;
        let mut by_load = sensitive(wrench)?;
        by_load
            .iter_mut()
            .zip(&without)
            .for_each(|(with, without)| *with -= without);
        let along_row = |row: &Vec<f64>| row.iter().zip(&by_load).map(|(l, s)| l * s).sum();
        let mut moves: Vec<f64> = unknowns
            .iter()
            .map(along_row)
            .chain(by_load.last().copied())
            .collect();
        let posture = LoadedPosture {
            joints,
            frames,
            tcp: base_from_tool.translation.vector.into(),
            tool_axis: base_from_tool.rotation * Vector3::z(),
            wrench,
        };
        arm_state.displacements_by_inputs(&question.uncertainty, &posture, outward, |by| moves.push(by))?;
        Ok(moves)
    }
}

#[cfg(test)]
mod tests;
