//! Why a robot is not written, and what to do.

/// Why a robot is not written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// A coupled joint, and no decision.
    #[error(
        "joint {joint} is coupled to joint {other}: the position on its controller is not the angle between its links"
    )]
    Coupled {
        /// The joint.
        joint: String,
        /// The joint that it is coupled to.
        other: String,
    },
    /// A follower in a format without them.
    #[error("{0} has no joint that follows another")]
    NoFollower(&'static str),
    /// Springs in a format without them.
    #[error("{0} cannot express stiffness")]
    NoStiffness(&'static str),
    /// Stiffness of a robot whose compliances are not known.
    #[error("the joint compliances of this robot are not known, so that no stiffness can be written")]
    NoCompliance,
    /// A joint without compliance that should be a spring.
    #[error("the compliance of joint {0} is 0: it cannot be a spring")]
    Rigid(String),
    /// Springs around a posture that is not given.
    #[error("springs in the joints keep one posture, which is not given")]
    NoPosture,
    /// Another number of positions than joints.
    #[error("{given} joint positions for {joints} joints")]
    PostureCount {
        /// Positions.
        given: usize,
        /// Joints.
        joints: usize,
    },
    /// A prismatic joint without limits in a format that requires them.
    #[error("prismatic joint {0} has no limits, which a URDF requires")]
    NoLimits(String),
    /// An arm that is not like those of Universal Robots.
    #[error("a UR calibration file cannot describe this robot: {0}")]
    NotUr(String),
    /// Axes whose common normal is too far away.
    #[error(
        "joints {first} and {second} are parallel within {angle_deg:.2e} deg: the common normal of their axes is {distance:.3e} m away"
    )]
    FarNormal {
        /// The joint before.
        first: String,
        /// The joint behind.
        second: String,
        /// Angle between their axes.
        angle_deg: f64,
        /// Distance of the common normal, m.
        distance: f64,
    },
}

impl ExportError {
    /// How to correct it.
    pub fn hint(&self) -> &'static str {
        match self {
            ExportError::Coupled { .. } => {
                "--coupling own writes the angle between the links, --coupling mimic a further joint that follows (URDF, xacro, SDF)"
            }
            ExportError::NoFollower(_) => "--coupling own writes the angle between the links",
            ExportError::NoStiffness(_) => "--format sdf and --format mjcf can",
            ExportError::NoCompliance => {
                "--compliance-rad-per-n-m gives them, --compliance-class assumes them by payload"
            }
            ExportError::Rigid(_) => "--stiffness passive leaves rigid joints without a spring",
            ExportError::NoPosture | ExportError::PostureCount { .. } => {
                "--joints-deg gives one position for each joint"
            }
            ExportError::NoLimits(_) => "add limits_mm to its robot file",
            ExportError::NotUr(_) => "--format urdf describes any serial robot",
            ExportError::FarNormal { .. } => {
                "--convention hayati turns such axes about y instead, --convention standard and modified need the normal"
            }
        }
    }
}
