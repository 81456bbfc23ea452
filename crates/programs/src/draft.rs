//! Programs to write: points with poses, postures and speeds, and the definitions of frame and tool.

use std::ops::RangeInclusive;

use armill_core::frame::Isometry;
use armill_core::robot::Branch;

/// A program to write. Lengths m, angles rad, speeds m/s.
#[derive(Clone, Debug)]
pub struct Draft {
    /// Program name: a letter, then letters, digits and underscores.
    pub name: String,
    /// Remarks for its header: origin of the program.
    pub remarks: Vec<String>,
    /// Controller's reference frame to the user frame of the targets.
    pub base_from_frame: Isometry,
    /// Number of that frame on the controller.
    pub frame_number: u32,
    /// Flange to TCP.
    pub flange_from_tool: Isometry,
    /// Number of the tool on the controller.
    pub tool_number: u32,
    /// Points in order; the move to the first is a joint move.
    pub points: Vec<DraftPoint>,
}

/// A target to write.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftPoint {
    /// Frame to tool.
    pub frame_from_tool: Isometry,
    /// Joint positions, rad (m for prismatic joints), as the controller reports them.
    pub joints: Vec<f64>,
    /// Posture, for an arm with named postures.
    pub branch: Option<Branch>,
    /// Tip speed along a straight line, m/s; `None` for a joint move.
    pub speed: Option<f64>,
    /// Distance from the point at which the next move may begin, m; zero is an exact stop.
    pub blend: f64,
}

/// Ranges of a language.
pub(super) struct Bounds {
    /// Name of the language, for messages.
    pub language: &'static str,
    /// Longest name of a program, characters.
    pub longest_name: usize,
    /// Rule for names, for messages.
    pub names: &'static str,
    /// Number of joints, external axes included.
    pub joints: RangeInclusive<usize>,
    /// Numbers of user frames.
    pub frames: RangeInclusive<u32>,
    /// Numbers of tools.
    pub tools: RangeInclusive<u32>,
}

/// Largest position, m, or joint position, rad, in a program.
const LARGEST: f64 = 1e4;
/// Minimum speed that can be written with the decimals of controllers, m/s.
const SLOWEST: f64 = 1e-5;

impl Draft {
    /// Checks that the program can be written within these ranges: its name, its numbers, the number of joints, and
    /// that every value is finite and in range.
    pub(super) fn check(&self, bounds: &Bounds) -> Result<(), DraftError> {
        let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let begins = self.name.starts_with(|c: char| c.is_ascii_alphabetic());
        if !begins || !self.name.chars().all(letters) || self.name.len() > bounds.longest_name {
            return Err(DraftError::Name {
                name: self.name.clone(),
                language: bounds.language,
                rule: bounds.names,
            });
        }
        let numbers = [
            ("frame", self.frame_number, &bounds.frames),
            ("tool", self.tool_number, &bounds.tools),
        ];
        for (what, number, range) in numbers {
            if !range.contains(&number) {
                return Err(DraftError::Number {
                    what,
                    number,
                    language: bounds.language,
                    least: *range.start(),
                    most: *range.end(),
                });
            }
        }
        if self.points.is_empty() {
            return Err(DraftError::Empty);
        }
        for (at, point) in self.points.iter().enumerate() {
            if !bounds.joints.contains(&point.joints.len()) {
                return Err(DraftError::Joints {
                    found: point.joints.len(),
                    language: bounds.language,
                    least: *bounds.joints.start(),
                    most: *bounds.joints.end(),
                });
            }
            let place = point.frame_from_tool.translation.vector;
            let values = place
                .iter()
                .map(|value| ("the position", *value))
                .chain(
                    point
                        .frame_from_tool
                        .rotation
                        .coords
                        .iter()
                        .map(|value| ("the orientation", *value)),
                )
                .chain(point.joints.iter().map(|value| ("a joint", *value)))
                .chain(point.speed.map(|value| ("the speed", value)))
                .chain([("the blend", point.blend)]);
            for (what, value) in values {
                let least = match what {
                    "the speed" => SLOWEST,
                    "the blend" => 0.0,
                    _ => -LARGEST,
                };
                if !(least..=LARGEST).contains(&value) {
                    return Err(DraftError::NotWritable {
                        index: at + 1,
                        what,
                        value,
                    });
                }
            }
        }
        Ok(())
    }
}

impl Draft {
    /// Refuses names that are reserved words; not case-sensitive.
    pub(super) fn avoid(&self, bounds: &Bounds, words: &[&str]) -> Result<(), DraftError> {
        let is_word = words.iter().any(|word| word.eq_ignore_ascii_case(&self.name));
        let refused = || DraftError::Name {
            name: self.name.clone(),
            language: bounds.language,
            rule: bounds.names,
        };
        if is_word { Err(refused()) } else { Ok(()) }
    }

    /// The remarks, line by line: a line break inside a remark must not begin a statement.
    pub(super) fn remark_lines(&self) -> impl Iterator<Item = &str> {
        self.remarks
            .iter()
            .flat_map(|remark| remark.split(|c: char| c.is_control() || c == '\u{2028}' || c == '\u{2029}'))
            .filter(|line| !line.is_empty())
    }

    /// Whether this point is the first of the program. The move to it is a joint move, whatever speed it has.
    pub(super) fn is_first(&self, point: &DraftPoint) -> bool {
        self.points
            .first()
            .is_some_and(|first| std::ptr::eq(first, point))
    }

    /// Tip speed of the move to this point, m/s; `None` for a joint move.
    pub(super) fn tip_speed(&self, point: &DraftPoint) -> Option<f64> {
        point.speed.filter(|_| !self.is_first(point))
    }

    /// Checks that the language can write all tip speeds, m/s.
    pub(super) fn check_speeds(&self, is_writable: impl Fn(f64) -> bool) -> Result<(), DraftError> {
        let mut speeds = (1..)
            .zip(&self.points)
            .filter_map(|(index, point)| Some((index, self.tip_speed(point)?)));
        match speeds.find(|(_, speed)| !is_writable(*speed)) {
            Some((index, value)) => Err(DraftError::NotWritable {
                index,
                what: "the speed",
                value,
            }),
            None => Ok(()),
        }
    }

    /// Blend distance of this point, m; the last point is an exact stop.
    pub(super) fn blend(&self, point: &DraftPoint) -> f64 {
        match self.points.last().is_some_and(|last| std::ptr::eq(last, point)) {
            true => 0.0,
            false => point.blend,
        }
    }

    /// The points in parts of at most this number, each with its name: that of the program, `separator` and a number.
    /// A single part has the name of the program.
    pub(super) fn parts(
        &self,
        most: usize,
        separator: &str,
    ) -> impl Iterator<Item = (String, &[DraftPoint])> {
        let is_split = self.points.len() > most;
        self.points.chunks(most).enumerate().map(move |(index, points)| {
            let name = match is_split {
                true => format!("{}{separator}{:03}", self.name, index + 1),
                false => self.name.clone(),
            };
            (name, points)
        })
    }
}

/// The written files of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// File names in the program's folder, and contents.
    pub files: Vec<(String, Vec<u8>)>,
    /// Warnings to read before running it, one sentence each.
    pub notes: Vec<String>,
}

/// Why a draft cannot be written in a language.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DraftError {
    /// The name is not valid in the language.
    #[error("`{name}` is not a valid name in {language}: {rule}")]
    Name {
        /// The given name.
        name: String,
        /// The language.
        language: &'static str,
        /// Rule for names.
        rule: &'static str,
    },
    /// There are no points.
    #[error("the program has no points")]
    Empty,
    /// The number of joints is outside the range of the language.
    #[error("{found} joints, but {language} programs can have {least} to {most}")]
    Joints {
        /// Number of joints.
        found: usize,
        /// The language.
        language: &'static str,
        /// Minimum number.
        least: usize,
        /// Maximum number.
        most: usize,
    },
    /// The number of a frame or tool is outside the range of the controller.
    #[error("{what} {number} is outside {least} to {most} of {language}")]
    Number {
        /// Frame or tool.
        what: &'static str,
        /// The number.
        number: u32,
        /// The language.
        language: &'static str,
        /// Minimum number.
        least: u32,
        /// Maximum number.
        most: u32,
    },
    /// A number that is not finite or exceeds the range of controllers.
    #[error("point {index}: {what} is {value}, which cannot be written")]
    NotWritable {
        /// Number of the point, from 1.
        index: usize,
        /// Quantity.
        what: &'static str,
        /// Its value.
        value: f64,
    },
}
