//! What all points of an analysis share, in SI and in the base of the robot.

use armill_core::frame::Isometry;
use armill_core::kernel::BranchChoice;
use armill_core::load::{InputUncertainty, LoadCases};
use armill_core::motion::Motion;
use armill_core::nalgebra::{Matrix6, Point3};
use armill_core::optimize::{LeastGain, PostureSearch};
use armill_core::robot::{BranchPattern, Robot};
use armill_core::source::{Arm, ArmState, MotionDisplacement, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::workpiece::Plane;

use crate::input::cell::AnalysisCell;
use crate::input::motion::MotionSetting;
use crate::input::vibration::VibrationSetting;
use crate::joint_order::contributor_names;
use crate::uncertainty_words::inputs_without_uncertainty;

/// Everything needed to evaluate a point, SI, base.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Name of the frame that coordinates count from.
    pub base_name: String,
    /// Whether the study names that frame.
    pub base_is_given: bool,
    /// That frame in base.
    pub base_from_reference: Isometry,
    /// Flange to tool centre point.
    pub flange_from_tool: Isometry,
    /// Compliances and masses in addition to the drives.
    pub model: StiffnessModel,
    /// The workpiece plane.
    pub plane: Plane,
    /// Its tilt as given, rad, if it was given by one.
    pub tilt: Option<f64>,
    /// Load cases as given; none if the forces come with a path.
    pub load: LoadCases,
    /// The same in base; a load that turns with the feed as if the feed were along x of the part.
    pub cases: Vec<Wrench>,
    /// Where the load comes from, in the user's words.
    pub load_source: Option<String>,
    /// Where springs and masses of the tool come from, in the user's words.
    pub tool_sources: Vec<String>,
    /// Uncertainty of load and tool.
    pub uncertainty: InputUncertainty,
    /// The tolerance, m.
    pub tolerance: f64,
    /// The least gain for which a change is proposed.
    pub least_gain: LeastGain,
    /// Which posture.
    pub choice: BranchChoice,
    /// Position of a rail and preferred positions of redundant joints, rad (m).
    pub home: Option<Vec<f64>>,
    /// Branches that the words of the study leave open; all where it has none.
    pub open: BranchPattern,
    /// Along a path: which turns and branches are tried.
    pub search: Option<PostureSearch>,
    /// Along a path: how the controller moves the arm, if the motion is requested.
    pub motion: Option<MotionSetting>,
    /// What is asked of the vibration at each point, if it is requested.
    pub vibration: Option<VibrationSetting>,
    /// The bodies of the cell, and the demanded clearance; none where the study has no bodies.
    pub cell: Option<AnalysisCell>,
}

impl Setting {
    /// Whether the cut must be stable.
    pub fn must_be_stable(&self) -> bool {
        self.vibration
            .as_ref()
            .is_some_and(|vibration| vibration.must_be_stable)
    }

    /// The names of the contributors to a deviation: the joints, the others of the model, those of the motion.
    pub fn contributor_names(&self, robot: &Robot) -> Vec<String> {
        contributor_names(robot, &self.model, self.motion.is_some())
    }

    /// The displacement by the motion at a point; `None` where the study asks for no motion, zero where it is not known.
    pub fn motion_displacement(&self, motion: Option<&Motion>, index: usize) -> Option<MotionDisplacement> {
        let lag_u = self.motion.as_ref()?.known_lag_u();
        Some(motion.map_or_else(MotionDisplacement::default, |motion| {
            motion.displacement_at(index, lag_u)
        }))
    }

    /// Names of the inputs of a prediction that have an effect, but no uncertainty.
    pub fn inputs_without_uncertainty(&self, robot: &Robot) -> Vec<String> {
        let of_motion = self
            .motion
            .iter()
            .flat_map(MotionSetting::inputs_without_uncertainty);
        inputs_without_uncertainty(&self.arm(robot))
            .into_iter()
            .chain(of_motion)
            .collect()
    }

    /// Name of the requested posture: words of a branch, or `best`.
    pub fn branch(&self) -> String {
        match self.choice {
            BranchChoice::Of(pattern) if pattern == BranchPattern::default() => "nominal".to_owned(),
            BranchChoice::Of(pattern) => pattern.to_string(),
            BranchChoice::Best => "best".to_owned(),
        }
    }

    /// The arm with its tool; without compliances if `robot` has none.
    pub fn arm<'a>(&'a self, robot: &'a Robot) -> Arm<'a> {
        Arm {
            robot,
            compliance: robot.compliance().unwrap_or_default(),
            model: &self.model,
            flange_from_tool: &self.flange_from_tool,
        }
    }

    /// Compliance of the unloaded arm at joint positions `q` (rad, m), SI; zeros if the arm is not stable.
    pub fn compliance_at(&self, robot: &Robot, q: &[f64]) -> Matrix6<f64> {
        let mut arm_state = ArmState::new(self.arm(robot));
        arm_state.set_joints(q);
        arm_state.compliance().unwrap_or_else(Matrix6::zeros)
    }

    /// A point of base relative to the reference frame of the study, m.
    pub fn in_reference(&self, in_base: &Point3<f64>) -> Point3<f64> {
        self.base_from_reference.inverse_transform_point(in_base)
    }
}
