//! The vibration at points: lowest mode of the arm, and the stable depth of cut with the modes of arm and tool.

use std::ops::Range;

use armill_core::dynamics::Mode;
use armill_core::load::Milling;
use armill_core::nalgebra::Rotation3;
use armill_core::robot::Robot;
use armill_core::source::ArmState;
use armill_core::stability::named_mode::modes;
use armill_core::stability::{CutOfAnyDepth, StabilityLobes};
use armill_core::units::to_mm;
use rayon::prelude::*;

use crate::analysis::numbers::Numbers;
use crate::analysis::rows::Rows;
use crate::analysis::vibration_quantity::{LOWEST_MODE, STABLE_DEPTH};
use crate::input::setting::Setting;

/// Deepest limit that is sought, diameters of the cutter.
const DEEPEST: f64 = 2.0;

/// The cut at a point: its spindle speed is rad/s, its feed frame in base.
pub type CutAt<'a> = dyn Fn(usize) -> Option<(Milling, f64, Rotation3<f64>)> + Send + Sync + 'a;

/// The columns of the vibration; none if the study does not ask for it. `cut_at` gives the cut at a point, if there is one.
pub fn columns<'a>(robot: &'a Robot, setting: &Setting, cut_at: Option<Box<CutAt<'a>>>) -> Vec<Numbers<'a>> {
    let Some(vibration) = &setting.vibration else {
        return Vec::new();
    };
    let mut columns = Vec::new();
    if has_modes(robot, setting) {
        columns.push(Numbers {
            quantity: &LOWEST_MODE,
            name: LOWEST_MODE.key.to_owned(),
            fill: Box::new(move |rows, points, values| {
                values.extend(at_points(robot, rows, points, &|arm, _| {
                    arm.first().map(Mode::frequency_hz)
                }));
            }),
        });
    }
    if let Some(cut_at) = cut_at {
        let of_tool = modes(&vibration.tool_modes);
        columns.push(Numbers {
            quantity: &STABLE_DEPTH,
            name: STABLE_DEPTH.key.to_owned(),
            fill: Box::new(move |rows, points, values| {
                values.extend(at_points(robot, rows, points, &|arm, index| {
                    let (milling, spindle, base_from_feed) = cut_at(index)?;
                    stable_depth(arm, &of_tool, &milling, spindle, &base_from_feed)
                }));
            }),
        });
    }
    columns
}

/// The columns of the points of a map or volume.
pub fn columns_on_plane<'a>(robot: &'a Robot, setting: &Setting) -> Vec<Numbers<'a>> {
    let cut = setting
        .vibration
        .as_ref()
        .and_then(|vibration| vibration.on_plane);
    let cut_at = cut.map(|cut| -> Box<CutAt<'a>> {
        Box::new(move |_| Some((cut.milling, cut.spindle, cut.base_from_feed)))
    });
    columns(robot, setting, cut_at)
}

/// Whether the arm of this setting has a mass that its modes need.
pub fn has_modes(robot: &Robot, setting: &Setting) -> bool {
    let structure = &setting.model.structure;
    robot.compliance().is_some()
        && (!structure.motors.is_empty() || structure.masses.iter().any(|mass| mass.mass > 0.0))
}

/// A value of the modes of the arm at each point with a posture; shapes at the tool, base axes.
pub(super) fn at_points(
    robot: &Robot,
    rows: &Rows<'_>,
    points: Range<usize>,
    value: &(dyn Fn(&[Mode], usize) -> Option<f64> + Sync),
) -> Vec<Option<f64>> {
    let moves = has_modes(robot, rows.setting);
    let at = |state: &mut ArmState<'_>, index: usize| {
        rows.answers.points[index].as_ref().ok()?;
        let mut arm: Vec<Mode> = Vec::new();
        if moves {
            state.set_joints(rows.answers.joints_at(index));
            let found = state.modes().ok()?;
            arm.extend(found.modes.iter().map(|mode| mode.at_tool));
        }
        value(&arm, index)
    };
    let state = || ArmState::new(rows.setting.arm(robot));
    points.into_par_iter().map_init(state, at).collect()
}

/// The stable depth of a cut at a spindle speed (rad/s), m; shapes of the modes of the arm are in base axes.
fn stable_depth(
    arm: &[Mode],
    of_tool: &[Mode],
    milling: &Milling,
    spindle: f64,
    base_from_feed: &Rotation3<f64>,
) -> Option<f64> {
    let of_arm = arm.iter().map(|mode| mode.in_axes(base_from_feed));
    let all: Vec<Mode> = of_arm.chain(of_tool.iter().copied()).collect();
    if all.is_empty() {
        return None;
    }
    let deepest = DEEPEST * milling.cutter().diameter();
    let lobes = StabilityLobes::new(&all, &CutOfAnyDepth::new(milling), deepest).ok()?;
    let limit = lobes.at_speed(spindle).map_or(deepest, |boundary| boundary.depth);
    Some(to_mm(limit.min(deepest)))
}
