//! What is to be written: points with poses, postures and speeds, and what the controller is told of frame and tool.

use std::ops::RangeInclusive;

use armill_core::frame::Isometry;
use armill_core::robot::Branch;

/// A program to be written. Lengths m, angles rad, speeds m/s.
#[derive(Clone, Debug)]
pub struct Draft {
    /// What it is called: a letter, then letters, digits and underscores.
    pub name: String,
    /// What its head tells a reader: who made it from what.
    pub remarks: Vec<String>,
    /// Where the controller counts from to the user frame that targets count in.
    pub base_from_frame: Isometry,
    /// Number of that frame on the controller.
    pub frame_number: u32,
    /// Flange to TCP.
    pub flange_from_tool: Isometry,
    /// Number of the tool on the controller.
    pub tool_number: u32,
    /// Where it goes, in order: the first by joints.
    pub points: Vec<DraftPoint>,
}

/// A target to be written.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftPoint {
    /// Frame to tool.
    pub frame_from_tool: Isometry,
    /// The joints there, rad (m of a sliding one), as the controller counts them.
    pub joints: Vec<f64>,
    /// The posture, of an arm whose postures have names.
    pub branch: Option<Branch>,
    /// Speed of the tip along a straight line, m/s; `None` where the joints go as they like.
    pub speed: Option<f64>,
    /// How near the tip must come before it goes on, m; zero stops there.
    pub blend: f64,
}

/// What a language holds.
pub(super) struct Bounds {
    /// Its name for people.
    pub language: &'static str,
    /// Longest name of a program, characters.
    pub longest_name: usize,
    /// What names are made of, for people.
    pub names: &'static str,
    /// Joints, those of rails and tables included.
    pub joints: RangeInclusive<usize>,
    /// Numbers of user frames.
    pub frames: RangeInclusive<u32>,
    /// Numbers of tools.
    pub tools: RangeInclusive<u32>,
}

/// No controller writes a larger place, m, or joint position, rad.
const LARGEST: f64 = 1e4;
/// A speed below this is none in the digits that controllers write, m/s.
const SLOWEST: f64 = 1e-5;

impl Draft {
    /// Whether it can be written within these bounds: its name, its numbers, the counts of its joints, and that every
    /// value is finite and none too large.
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
                .map(|value| ("the place", *value))
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
    /// Whether its name is none of these words, which differ by more than capitals.
    pub(super) fn avoid(&self, bounds: &Bounds, words: &[&str]) -> Result<(), DraftError> {
        let is_word = words.iter().any(|word| word.eq_ignore_ascii_case(&self.name));
        let refused = || DraftError::Name {
            name: self.name.clone(),
            language: bounds.language,
            rule: bounds.names,
        };
        if is_word { Err(refused()) } else { Ok(()) }
    }

    /// The remarks line by line: what ends a line in one of them must not begin a statement.
    pub(super) fn remark_lines(&self) -> impl Iterator<Item = &str> {
        self.remarks
            .iter()
            .flat_map(|remark| remark.split(|c: char| c.is_control() || c == '\u{2028}' || c == '\u{2029}'))
            .filter(|line| !line.is_empty())
    }

    /// How near the tip must come to this point, m: at the last it stops.
    pub(super) fn blend(&self, point: &DraftPoint) -> f64 {
        match self.points.last().is_some_and(|last| std::ptr::eq(last, point)) {
            true => 0.0,
            false => point.blend,
        }
    }

    /// The points in parts of so many; one part is the program itself.
    pub(super) fn parts(&self, most: usize) -> impl Iterator<Item = (String, &[DraftPoint])> {
        let is_split = self.points.len() > most;
        self.points.chunks(most).enumerate().map(move |(index, points)| {
            let name = match is_split {
                true => format!("{}_{:03}", self.name, index + 1),
                false => self.name.clone(),
            };
            (name, points)
        })
    }
}

/// These characters as ISO-8859-1, with `?` for what it lacks.
pub(super) fn latin1(text: &str) -> Vec<u8> {
    text.chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?'))
        .collect()
}

/// The files of a program as they are written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Names, in the folder of the program, and bytes.
    pub files: Vec<(String, Vec<u8>)>,
    /// What a user must know before running it, each a sentence.
    pub notes: Vec<String>,
}

/// What a language cannot hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DraftError {
    /// The name is none there.
    #[error("`{name}` is no name in {language}: {rule}")]
    Name {
        /// As it was given.
        name: String,
        /// The language.
        language: &'static str,
        /// What names are made of there.
        rule: &'static str,
    },
    /// Nothing to write.
    #[error("a program without points is none")]
    Empty,
    /// Another number of joints than the language writes.
    #[error("{found} joints, where {language} is written for {least} to {most}")]
    Joints {
        /// How many there are.
        found: usize,
        /// The language.
        language: &'static str,
        /// How many at least.
        least: usize,
        /// How many at most.
        most: usize,
    },
    /// A number of frame or tool that controllers do not have.
    #[error("{what} {number} is outside {least} to {most} of {language}")]
    Number {
        /// Frame or tool.
        what: &'static str,
        /// The number.
        number: u32,
        /// The language.
        language: &'static str,
        /// The least.
        least: u32,
        /// The greatest.
        most: u32,
    },
    /// A number that is not finite, or larger than controllers write.
    #[error("point {index}: {what} is {value}, which cannot be written")]
    NotWritable {
        /// Which point, from 1.
        index: usize,
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
}
