//! The memory of the answers of a study: estimated, and refused if it is too much, before anything is allocated.
//!
//! ```text
//! bytes = sum over analyses of  points (answers of a point + tables and fields of a point) + cases (columns of a case)
//! ```
//!
//! At most 4 GiB for each plane, box or path, and for all together. Both parts of a point grow with joints, shares and
//! load cases; the comments of the constants list their contents. Measured (MH12, peak resident size, without pictures)
//! and estimated, bytes a point:
//!
//! | | 1 case | 8 cases |
//! |---|---|---|
//! | volume of 531 441 points | 721, estimated 826 | 1657, estimated 1778 |
//! | map of 361 201 points | 1135, estimated 1162 | 2102, estimated 2366 |
//! | path of 314 160 points | 1165, estimated 1224 | 2416, estimated 2512 |
//!
//! Points are counted in floating point: a grid that is too large may overflow an index. Not included: `--csv` of boxes
//! and sections.

use armill_core::kernel::Answers;
use armill_formats::robot::RobotDescription;

use crate::input::problem_log::ProblemLog;
use crate::input::setting::Setting;

/// Bytes in a GiB.
pub const GIB: f64 = 1024.0 * 1024.0 * 1024.0;
/// Most memory that the answers of a study may take: available on a laptop.
pub const MOST_BYTES: f64 = 4.0 * GIB;
/// Minimum of the bytes of a point in addition to its answers.
pub const LEAST_EXTRA_BYTES: usize = OF_FIELD.point;

/// Bytes of tables and fields in addition to the answers: of a point, of each of its joints and shares, of each of its
/// load cases. A number is 16 in a column that may lack some, about 11 in a field's file and 12 in CSV.
pub struct ExtraBytes {
    point: usize,
    joint_or_share: usize,
    case: usize,
}

/// Boxes and sections: position (24) and 13 columns in the table (148), four numbers in the field and its file (107),
/// and temporary copies (50). Of a case three columns (48), a vector in the field (32) and in its file (32).
pub const OF_FIELD: ExtraBytes = ExtraBytes {
    point: 330,
    joint_or_share: 16,
    case: 112,
};
/// Maps: also CSV.
pub const OF_MAP: ExtraBytes = ExtraBytes {
    point: 330 + 13 * 12,
    joint_or_share: 16 + 12,
    case: 112 + 36,
};
/// Paths and holes: also the points of the path and their columns, and the load at each.
pub const OF_PATH: ExtraBytes = ExtraBytes {
    point: 330 + 350,
    joint_or_share: 16,
    case: 112 + 48,
};
/// The motion along a path, a point of it: the path with its rounded corners and the joints that follow late. Measured with 10^6 points: 250 on a smooth
/// path, 1640 where every point is a corner.
const OF_MOTION: usize = 1700;
/// The vibration at a point: its values (152), the spindle speed of a path (16) and four columns, in the table, a field and CSV (39 each).
const OF_VIBRATION: usize = 152 + 16 + 4 * 39;
/// Names, descriptions and buffers of the columns of one load case, independent of the points; measured 13 kB.
const BYTES_PER_CASE: usize = 16 << 10;

/// Hint for an analysis that is too large.
const HINT: &str = "use a larger step, a smaller plane, or fewer load cases";

/// Points whose answers are in memory at the same time.
pub struct PointMemory<'a> {
    /// The robot.
    pub robot: &'a RobotDescription,
    /// Their common setting.
    pub setting: &'a Setting,
    /// Load cases.
    pub cases: usize,
    /// How many points.
    pub points: f64,
    /// Their tables and fields.
    pub extra: &'a ExtraBytes,
}

impl PointMemory<'_> {
    /// Bytes of the points: their answers in the core, and their tables and fields.
    pub fn bytes(&self) -> f64 {
        let (cases, extra) = (self.cases, self.extra);
        let joints = self.robot.robot.joints().len();
        let shares = self.setting.model.contributors(joints).len();
        let point = Answers::bytes_per_point(joints, shares, cases)
            + extra.point
            + extra.joint_or_share * (joints + shares)
            + extra.case * cases
            + if self.setting.motion.is_some() {
                OF_MOTION
            } else {
                0
            }
            + if self.setting.vibration.is_some() {
                OF_VIBRATION
            } else {
                0
            };
        self.points * point as f64 + (cases * BYTES_PER_CASE) as f64
    }

    /// Whether they fit; a problem at `path` if not.
    pub fn check(&self, log: &mut ProblemLog<'_>, path: &str) -> Option<()> {
        let bytes = self.bytes();
        if bytes <= MOST_BYTES {
            return Some(());
        }
        let (gib, most) = (bytes / GIB, MOST_BYTES / GIB);
        let under = match self.cases {
            1 => String::new(),
            cases => format!(" under {cases} load cases"),
        };
        let points = self.points;
        let message =
            format!("{points:.0} points{under} would take {gib:.1} GiB of memory, more than {most:.0} GiB");
        log.problem(path, message, HINT);
        None
    }
}
