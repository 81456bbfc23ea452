//! The answer for one pose: its postures, with compliance, deviation and clearance.

use armill_formats::sources::Source;
use schemars::JsonSchema;
use serde::Serialize;

/// Every posture of a pose. Positions in the frame `base`, everything else about the TCP in base axes.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PoseAnswer {
    /// Name of the robot.
    pub robot: String,
    /// Frame that positions count from.
    pub base: String,
    /// Names of the joints.
    pub joint_names: Vec<String>,
    /// Units of their positions and of their distances to limits: deg, of a prismatic joint mm.
    pub joint_units: Vec<&'static str>,
    /// Whether the joint compliances are assumed, not measured.
    pub compliance_assumed: bool,
    /// Parts of the stiffness model that were on.
    pub model: Vec<String>,
    /// The contributors of `share_um`: the joints; base, flange and tool if springs are attached there;
    /// geometry with a calibrated robot; thermal growth; learnt residual.
    pub contributors: Vec<String>,
    /// Every posture; empty if the pose is unreachable.
    pub postures: Vec<PostureAnswer>,
    /// Why there is no posture.
    pub unreachable: Option<UnreachableAnswer>,
    /// Notes for the user, also on missing data.
    pub notes: Vec<String>,
    /// Sources of the numbers of the robot.
    pub sources: Vec<Source>,
}

/// One posture.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PostureAnswer {
    /// Its name: words of a branch; without named branches the side of the middle of each joint.
    pub branch: String,
    /// Joint positions (mm for prismatic joints), in the robot file's own signs and zeros.
    pub joints_deg: Vec<f64>,
    /// Whether every joint is inside its limits.
    pub within_limits: bool,
    /// Least distance of a joint to its limit, negative outside; none if no joint has limits.
    pub limit_margin_deg: Option<f64>,
    /// The joint with that margin.
    pub limit_joint: Option<String>,
    /// Pose of the tool.
    pub tool: ToolAnswer,
    /// Near which singularity, if any.
    pub singularity: Option<String>,
    /// Product of the singular values of the Jacobian, SI.
    pub manipulability: f64,
    /// Of the Jacobian, with rotations weighed by a length of 1 m; none if singular.
    pub condition_number: Option<f64>,
    /// 6 x n: TCP twist per unit of joint position, translation first, base axes, SI.
    pub jacobian: Vec<Vec<f64>>,
    /// 6 x 6 at the TCP, translation first, base axes, SI; none if joint compliances are not known.
    pub compliance: Option<[[f64; 6]; 6]>,
    /// Results that follow from the compliance.
    pub stiffness: Option<StiffnessAnswer>,
    /// The same under the load, tangent to it; of a load-dependent model only.
    // unit: SI matrix
    pub loaded_compliance: Option<[[f64; 6]; 6]>,
    /// Why the arm finds no rest under the load; none if it does.
    pub unstable: Option<String>,
    /// Displacement of the TCP under the load; none without load or compliance.
    pub deviation_um: Option<[f64; 3]>,
    /// Rotation of the tool under the load.
    pub rotation_urad: Option<[f64; 3]>,
    /// Share of each of `contributors` in the displacement.
    pub joint_share_um: Option<Vec<[f64; 3]>>,
    /// Standard uncertainty of the displacement, from those of the compliances, the repeatability of the arm and the
    /// error of its model; none where it is not known.
    pub deviation_u_um: Option<[f64; 3]>,
    /// Least distance of two bodies; 0 where they touch; none without bodies in the cell.
    pub clearance_mm: Option<f64>,
    /// The two bodies.
    pub nearest: Option<[String; 2]>,
    /// Their nearest points, in the frame that positions count from.
    pub nearest_mm: Option<[[f64; 3]; 2]>,
}

/// Pose of the tool.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ToolAnswer {
    /// TCP in the frame that positions count from.
    pub xyz_mm: [f64; 3],
    /// Orientation in that frame, unit quaternion.
    pub quaternion_wxyz: [f64; 4],
}

/// Results that follow from the compliance of a posture.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StiffnessAnswer {
    /// 6 x 6, the (pseudo-)inverse of the compliance, SI. // unit: SI matrix
    pub stiffness: [[f64; 6]; 6],
    /// Compliant directions of the arm: 6 if the stiffness is a true inverse.
    pub rank: usize,
    /// Of the compliance, with rotations weighed by a length of 1 m; none below rank 6.
    pub condition_number: Option<f64>,
    /// Principal compliances of the translational block, softest first.
    pub principal_um_per_n: [f64; 3],
    /// Their directions in base.
    pub principal_direction: [[f64; 3]; 3],
    /// Force across the tool axis that every direction permits per micrometre.
    pub permissible_n_per_um: f64,
}

/// Why there is no posture, and by how much.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct UnreachableAnswer {
    /// One word.
    pub reason: String,
    /// By how much the wrist centre misses; of a search the tool.
    pub amount_mm: f64,
    /// Orientation error of the tool in a numerical search.
    pub amount_deg: Option<f64>,
    /// In words.
    pub message: String,
}
