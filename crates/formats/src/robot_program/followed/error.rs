//! What keeps a program from being followed: what neither it nor its cell tells.

/// Why a program is no path in its cell.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FollowError {
    /// A frame that stands on the controller, and that the cell does not tell.
    #[error(
        "line {line}: places count from frame {number} of the controller, which the program does not tell"
    )]
    Numbered {
        /// Line of the first such move.
        line: u32,
        /// Number of the frame.
        number: u32,
    },
    /// Nothing is said of the frame.
    #[error("line {line}: the program does not tell which frame its places count from")]
    EvaluateError {
        /// Line of the first such move.
        line: u32,
    },
    /// The cell tells a frame that the program tells too.
    #[error("line {line}: the program tells its frame itself")]
    Told {
        /// Line of the first such move.
        line: u32,
    },
    /// Frames whose places beside each other are not known.
    #[error("lines {} and {}: places count from two frames, and how they lie to each other is not told", lines[0], lines[1])]
    Several {
        /// Lines of moves in either.
        lines: [u32; 2],
    },
    /// The tool of the program has another tip than the cell's.
    #[error(
        "line {line}: the program's tool has its tip at {told_mm} mm from the flange, {apart_mm:.3} mm from that of the study's"
    )]
    Tip {
        /// Line of the first such cut.
        line: u32,
        /// Flange to tip, as the program tells it, mm.
        told_mm: String,
        /// How far that is from the tip of the cell's tool, mm.
        apart_mm: f64,
        /// Flange to tool as numbers of a study: x, y, z in mm, turns about fixed x, y, z in deg.
        tool_mm_deg: String,
    },
    /// Joints of another robot.
    #[error("line {line}: {found} joint positions, where robot `{robot}` has {expected} joints")]
    Joints {
        /// Line of the move.
        line: u32,
        /// How many are told.
        found: usize,
        /// Name of the robot.
        robot: String,
        /// How many it has.
        expected: usize,
    },
}
