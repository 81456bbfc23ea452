//! Modes of the arm in a posture, with their names and uncertainties.
//!
//! The frequency follows the root of the stiffness: its relative uncertainty is half that of the stiffness, and that by the masses is added. An assumed damping ratio has
//! half of itself as standard uncertainty ([`ASSUMED_U`]).

use armill_core::dynamics::Mode;
use armill_core::nalgebra::Rotation3;
use armill_core::robot::Robot;
use armill_core::source::{Arm, ArmState, Unstable};
use armill_core::stability::named_mode::modes;
use armill_core::stability::{ModeUncertainty, NamedMode};

use crate::input::setting::Setting;

/// Relative standard uncertainty of a damping ratio that is assumed.
pub const ASSUMED_U: f64 = 0.5;

/// Whether the arm of this setting has the compliances and the inertia that its modes need.
pub fn has_modes(robot: &Robot, setting: &Setting) -> bool {
    robot.compliance().is_some() && setting.model.structure.has_inertia()
}

/// The modes of the arm at joint positions `q` (rad, m), shapes in the axes of base.
///
/// # Errors
/// [`Unstable`] where the compensator is stiffer than its joint.
pub fn named_modes(arm: Arm<'_>, q: &[f64]) -> Result<Vec<NamedMode>, Unstable> {
    let mut state = ArmState::new(arm);
    state.set_joints(q);
    let found = state.modes()?;
    let compliances = state.tangent_compliances()?;
    let covariance = compliance_covariance(&arm);
    let known = arm.has_known_uncertainty();
    let damping = match arm.model.structure.damping {
        Some(_) => 0.0,
        None => ASSUMED_U,
    };
    let by_masses = state.frequency_uncertainties_by_masses(&found.modes);
    let modes = found.modes.iter().enumerate().map(|(index, mode)| {
        let by_compliances = match known {
            true => mode.relative_uncertainty(&compliances, &covariance),
            false => 0.0,
        };
        NamedMode {
            name: format!("arm mode {}{}", index + 1, most_of(arm.robot, &mode.shares)),
            mode: mode.at_tool,
            uncertainty: ModeUncertainty {
                frequency: by_compliances.hypot(by_masses[index]),
                damping,
                stiffness: 2.0 * by_compliances,
            },
        }
    });
    Ok(modes.collect())
}

/// These modes of the arm in the feed frame.
pub fn in_feed_frame(modes: Vec<NamedMode>, base_from_feed: &Rotation3<f64>) -> Vec<NamedMode> {
    let turned = |named: NamedMode| NamedMode {
        mode: named.mode.in_axes(base_from_feed),
        ..named
    };
    modes.into_iter().map(turned).collect()
}

/// Modes of the arm (axes of base) and of the tool (feed frame) together, in the feed frame.
pub fn at_tip(of_arm: &[Mode], of_tool: &[Mode], base_from_feed: &Rotation3<f64>) -> Vec<Mode> {
    let of_arm = of_arm.iter().map(|mode| mode.in_axes(base_from_feed));
    of_arm.chain(of_tool.iter().copied()).collect()
}

/// Modes of arm and tool with their names in the posture `q` (rad, m), in the feed frame; none if the study does not ask for the vibration.
pub fn named_at_tip(
    robot: &Robot,
    setting: &Setting,
    q: &[f64],
    base_from_feed: &Rotation3<f64>,
) -> Option<Vec<NamedMode>> {
    let vibration = setting.vibration.as_ref()?;
    let mut named = Vec::new();
    if has_modes(robot, setting) {
        named.extend(in_feed_frame(
            named_modes(setting.arm(robot), q).ok()?,
            base_from_feed,
        ));
    }
    named.extend(vibration.tool_modes.iter().cloned());
    Some(named)
}

/// Modes of arm and tool in the posture `q` (rad, m), in the feed frame; none where nothing vibrates.
pub fn modes_at_tip(
    robot: &Robot,
    setting: &Setting,
    q: &[f64],
    base_from_feed: &Rotation3<f64>,
) -> Option<Vec<Mode>> {
    let mut of_arm = Vec::new();
    if has_modes(robot, setting) {
        let mut state = ArmState::new(setting.arm(robot));
        state.set_joints(q);
        of_arm.extend(state.modes().ok()?.modes.iter().map(|mode| mode.at_tool));
    }
    let of_tool = modes(&setting.vibration.as_ref()?.tool_modes);
    Some(at_tip(&of_arm, &of_tool, base_from_feed)).filter(|modes| !modes.is_empty())
}

/// Covariance of the compliances of an arm: independent where the file gives none.
pub(crate) fn compliance_covariance<'a>(arm: &Arm<'a>) -> impl Fn(usize, usize) -> f64 + use<'a> {
    let own: Vec<f64> = arm
        .compliances()
        .iter()
        .map(|c| c.standard_uncertainty.powi(2))
        .collect();
    let joint = arm.model.structure.covariance.as_ref();
    move |k, l| match joint.filter(|matrix| k < matrix.nrows() && l < matrix.nrows()) {
        Some(matrix) => matrix[(k, l)],
        None if k == l => own[k],
        None => 0.0,
    }
}

/// The joint with the largest share, in words; empty if a spring has it.
fn most_of(robot: &Robot, shares: &[f64]) -> String {
    let largest = shares.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let of_joint = largest.and_then(|(k, share)| Some((robot.joints().get(k)?, share)));
    of_joint.map_or_else(String::new, |(joint, share)| {
        format!(" ({:.0} % {})", 100.0 * share, joint.name)
    })
}
