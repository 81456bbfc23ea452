//! Why a program cannot be followed: data that neither the program nor its cell gives.

/// Why a program gives no path in its cell.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FollowError {
    /// A frame that is stored on the controller and not given by the cell.
    #[error(
        "line {line}: coordinates are relative to frame {number} of the controller, which the program does not define"
    )]
    Numbered {
        /// Line of the first such move.
        line: u32,
        /// Number of the frame.
        number: u32,
    },
    /// The frame is not named.
    #[error("line {line}: the program does not define the frame of its coordinates")]
    UnknownFrame {
        /// Line of the first such move.
        line: u32,
    },
    /// Both the cell and the program give the frame.
    #[error("line {line}: the program already defines its frame")]
    FrameGivenTwice {
        /// Line of the first such move.
        line: u32,
    },
    /// Frames whose relative pose is not known.
    #[error("lines {} and {}: coordinates are relative to two frames, and the pose of one in the other is not \
        known", lines[0], lines[1])]
    Several {
        /// A line with each of the frames.
        lines: [u32; 2],
    },
    /// The tip of the program's tool differs from that of the cell's tool.
    #[error(
        "line {line}: the tip of the program's tool is at {tip_mm} mm from the flange, {apart_mm:.3} mm from the tip \
         of the study's tool"
    )]
    Tip {
        /// Line of the first such cut.
        line: u32,
        /// Flange to tip in the program, mm.
        tip_mm: String,
        /// Distance from the tip of the cell's tool, mm.
        apart_mm: f64,
        /// Flange to tool in the form of a study: x, y, z in mm, rotations about fixed x, y, z in deg.
        tool_mm_deg: String,
    },
    /// Joints of another robot.
    #[error("line {line}: {found} joint positions, but robot `{robot}` has {expected} joints")]
    Joints {
        /// Line of the move.
        line: u32,
        /// Number of given joint positions.
        found: usize,
        /// Name of the robot.
        robot: String,
        /// Number of its joints.
        expected: usize,
    },
}
