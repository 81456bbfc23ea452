//! Checks that a program can be written in a language: names, numbers of frames and tools, joints, ranges of values.

use std::ops::RangeInclusive;

use crate::draft::{Draft, DraftPoint, DraftStep};

/// Ranges of a language.
pub(super) struct Bounds {
    /// Name of the language, for messages.
    pub language: &'static str,
    /// Longest name of a program, characters.
    pub longest_name: usize,
    /// Rule for names, for messages.
    pub names: &'static str,
    /// Largest number of external axes.
    pub external: usize,
    /// Numbers of user frames.
    pub frames: RangeInclusive<u32>,
    /// Numbers of tools.
    pub tools: RangeInclusive<u32>,
}

/// Joints of an arm that these languages are written for.
const JOINTS: usize = 6;
/// Largest position, m, or joint position, rad, in a program.
const LARGEST: f64 = 1e4;
/// Minimum speed that can be written with the decimals of controllers, m/s.
const SLOWEST: f64 = 1e-5;
/// Longest dwell, s.
const LONGEST_DWELL: f64 = 3600.0;

impl Draft {
    /// Checks that the program can be written within these ranges: its name, its numbers, the number of joints, that
    /// its first move is a joint move, and that every value is finite and in range.
    pub(super) fn check(&self, bounds: &Bounds) -> Result<(), DraftError> {
        self.check_name(bounds)?;
        let numbers = [
            ("frame", self.controller.frame_number, &bounds.frames),
            ("tool", self.controller.tool_number, &bounds.tools),
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
        let first = self.points().next().ok_or(DraftError::Empty)?;
        if first.speed.is_some() {
            return Err(DraftError::FirstMove);
        }
        for (at, point) in self.points().enumerate() {
            self.check_point(bounds, at + 1, point)?;
        }
        for step in &self.steps {
            match step {
                DraftStep::Dwell(value) if !(0.0..=LONGEST_DWELL).contains(value) => {
                    return Err(DraftError::Dwell { value: *value });
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn check_name(&self, bounds: &Bounds) -> Result<(), DraftError> {
        let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let begins = self.name.starts_with(|c: char| c.is_ascii_alphabetic());
        if !begins || !self.name.chars().all(letters) || self.name.len() > bounds.longest_name {
            return Err(DraftError::Name {
                name: self.name.clone(),
                language: bounds.language,
                rule: bounds.names,
            });
        }
        Ok(())
    }

    fn check_point(&self, bounds: &Bounds, index: usize, point: &DraftPoint) -> Result<(), DraftError> {
        if point.joints.len() != JOINTS {
            return Err(DraftError::Joints {
                found: point.joints.len(),
                language: bounds.language,
            });
        }
        if point.external.len() > bounds.external || point.external.len() != self.external_slides.len() {
            return Err(DraftError::External {
                found: point.external.len(),
                language: bounds.language,
                most: bounds.external,
            });
        }
        let pose = &point.frame_from_tool;
        let named = |what: &'static str| move |value: &f64| (what, *value);
        let values = pose.translation.vector.iter().map(named("the position"));
        let values = values
            .chain(pose.rotation.coords.iter().map(named("the orientation")))
            .chain(point.joints.iter().map(named("a joint")))
            .chain(point.external.iter().map(named("an external axis")))
            .chain(point.speed.iter().map(named("the speed")))
            .chain([("the blend", point.blend)]);
        for (what, value) in values {
            let least = match what {
                "the speed" => SLOWEST,
                "the blend" => 0.0,
                _ => -LARGEST,
            };
            if !(least..=LARGEST).contains(&value) {
                return Err(DraftError::NotWritable { index, what, value });
            }
        }
        Ok(())
    }

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

    /// Checks that the language can write all tip speeds, m/s.
    pub(super) fn check_speeds(&self, is_writable: impl Fn(f64) -> bool) -> Result<(), DraftError> {
        let mut speeds = (1..)
            .zip(self.points())
            .filter_map(|(index, point)| Some((index, point.speed?)));
        match speeds.find(|(_, speed)| !is_writable(*speed)) {
            Some((index, value)) => Err(DraftError::NotWritable {
                index,
                what: "the speed",
                value,
            }),
            None => Ok(()),
        }
    }
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
    /// There are no moves.
    #[error("the program has no moves")]
    Empty,
    /// The first move is not a joint move.
    #[error("the first move of a program must be a joint move, whose posture is unique")]
    FirstMove,
    /// The number of joints is not that of the language.
    #[error("the arm has {found} joints, but {language} programs are written for arms with 6 joints")]
    Joints {
        /// Number of joints.
        found: usize,
        /// The language.
        language: &'static str,
    },
    /// More external axes than can be written.
    #[error("{found} external axes, but {language} programs are written with at most {most}")]
    External {
        /// Number of external axes.
        found: usize,
        /// The language.
        language: &'static str,
        /// Maximum number.
        most: usize,
    },
    /// The data of frame and tool cannot come from where they are requested.
    #[error("{language}: {reason}")]
    Data {
        /// The language.
        language: &'static str,
        /// Why.
        reason: &'static str,
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
    /// A dwell that is negative or longer than an hour.
    #[error("a dwell of {value} s is not between 0 and 3600 s")]
    Dwell {
        /// s
        value: f64,
    },
}
