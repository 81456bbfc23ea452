//! Names that a user gives: of a frame that coordinates count from, of a posture.

use armill_core::frame::Isometry;
use armill_core::kernel::BranchChoice;
use armill_core::nalgebra::UnitQuaternion;
use armill_core::robot::forward::forward;
use armill_core::robot::{BranchPattern, Robot};

/// Name of the frame on the robot's floor plane, which every robot has.
pub const BASE_LINK: &str = "base_link";

/// Name of the table of a positioner as a reference frame.
pub const TABLE: &str = "table";

/// Name of the flange of a robot that holds the part as a reference frame.
pub const FLANGE: &str = "flange";

/// Name of the base of the chain: the table of a positioner that carries the part, the flange of a robot that holds it.
pub fn base_name(robot: &Robot) -> &'static str {
    let ground = robot.chain().ground();
    match (ground.is_base(), ground.part_is_in_hand()) {
        (true, _) => BASE_LINK,
        (false, true) => FLANGE,
        (false, false) => TABLE,
    }
}

/// The frame that coordinates are relative to where none is given: `base_link`, or the flange of a robot that holds the part.
pub fn usual_reference(robot: &Robot) -> &'static str {
    match robot.chain().ground().part_is_in_hand() {
        true => FLANGE,
        false => BASE_LINK,
    }
}

/// Names of all frames that coordinates can be relative to.
pub fn references(robot: &Robot) -> Vec<&str> {
    let usual = usual_reference(robot);
    let others = robot.frames().iter().map(|frame| frame.name.as_str());
    std::iter::once(usual)
        .chain(others.filter(|name| *name != usual))
        .collect()
}

/// The frame `name` that coordinates count from, in base. If a positioner carries the part, base is its table, and
/// `base_link` is where the base of the robot is as seen from there, with the positioner at home. A robot that holds the part has
/// no frame but its flange.
///
/// # Errors
/// The names that the robot knows.
pub fn base_from_reference(robot: &Robot, name: &str) -> Result<Isometry, String> {
    let found = robot.frames().iter().find(|frame| frame.name == name);
    if let Some(frame) = found {
        return Ok(frame.base_from_frame);
    }
    match name == usual_reference(robot) {
        true => Ok(Isometry::identity()),
        false => Err(references(robot).join(", ")),
    }
}

/// Name of the reference frame of a controller, if that is not `base_link`.
pub(crate) const CONTROLLER: &str = "controller";

/// Reference frame of the controller of this robot, in base; with its positioner at these joint positions, rad (m), from the
/// table back, or where it stands in the study.
pub fn base_from_controller(robot: &Robot, positioner: Option<&[f64]>) -> Isometry {
    let at_home = |name: &str| base_from_reference(robot, name).unwrap_or_else(|_| Isometry::identity());
    let link_from_base = at_home(BASE_LINK).inverse();
    let controller = base_from_reference(robot, CONTROLLER).unwrap_or_else(|_| at_home(BASE_LINK));
    let ground = robot.chain().ground();
    let Some(positions) = positioner.filter(|_| !ground.is_base()) else {
        return controller;
    };
    let mut joints = robot.home(None);
    joints[..positions.len()].copy_from_slice(positions);
    let base_from_link = ground.in_base(&forward(robot, &joints).base_from_joint);
    let turned = UnitQuaternion::from_rotation_matrix(&base_from_link.rotation);
    Isometry::from_parts(base_from_link.translation, turned) * link_from_base * controller
}

/// Where the tool of a robot that holds the part stands: from the reference frame of its controller to the mount; `None`
/// of a robot that holds the tool.
pub fn controller_from_mount(robot: &Robot) -> Option<Isometry> {
    let hand = robot.hand()?;
    Some(base_from_controller(&hand.arm, None).inverse() * hand.base_from_mount)
}

/// The posture that `words` specify: a branch completed by the nominal one, `nominal`, or `best`.
///
/// # Errors
/// The word that names no branch.
pub fn branch_choice(words: &str, nominal: BranchPattern) -> Result<BranchChoice, String> {
    match words.trim() {
        "best" => Ok(BranchChoice::Best),
        "nominal" => Ok(BranchChoice::Of(nominal)),
        words => {
            let pattern: BranchPattern = words.parse().map_err(|error| format!("{error}"))?;
            Ok(BranchChoice::Of(pattern.or(nominal)))
        }
    }
}

/// The posture that `words` specify for `robot`: a branch completed by the nominal one, `nominal`, or `best`; if its
/// branches have no names, only `nominal` and `best` say something.
///
/// # Errors
/// The word that is not a branch name; any word if there are no branch names.
pub fn branch_choice_of(robot: &Robot, words: &str) -> Result<BranchChoice, String> {
    if robot.inverse().has_branches() {
        return branch_choice(words, robot.nominal_branch());
    }
    match branch_choice(words, BranchPattern::default())? {
        BranchChoice::Of(pattern) if pattern != BranchPattern::default() => Err(format!(
            "`{}`: the branches of robot `{}` have no names",
            words.trim(),
            robot.name()
        )),
        choice => Ok(choice),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_left_out_come_from_the_nominal_branch() {
        let nominal = BranchPattern::FRONT_ELBOW_UP;
        let choice = branch_choice("elbow-down", nominal).unwrap();
        assert_eq!(choice, BranchChoice::Of("front elbow-down".parse().unwrap()));
        assert_eq!(branch_choice("best", nominal), Ok(BranchChoice::Best));
        assert!(
            branch_choice("sideways", nominal)
                .unwrap_err()
                .contains("`sideways`")
        );
    }
}
