//! Checks that a program can be written in a language: names, numbers of frames and tools, joints, ranges of values.

use std::ops::RangeInclusive;

use crate::draft::{Draft, DraftPoint, DraftStep, FrameOn};

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
    /// Which names a mechanical unit that carries the user frame may have, and the rule for them; `None`: no external axis
    /// can carry it.
    pub units: Option<UnitNames>,
    /// Whether the robot can hold the part, with a tool that stands in the cell.
    pub holds_part: bool,
    /// Numbers of user frames.
    pub frames: RangeInclusive<u32>,
    /// Numbers of tools.
    pub tools: RangeInclusive<u32>,
    /// Longest dwell in one statement, s.
    pub longest_dwell: f64,
    /// Minimum acceleration along the path, m/s^2.
    pub least_acceleration: f64,
}

/// Names of mechanical units.
#[derive(Clone, Copy)]
pub(super) struct UnitNames {
    /// Whether a name is one.
    pub are: fn(&str) -> bool,
    /// Rule for them, for messages.
    pub rule: &'static str,
}

/// Joints of an arm that these languages are written for.
const JOINTS: usize = 6;
/// Largest position, m, or joint position, rad, in a program.
const LARGEST: f64 = 1e4;
/// Minimum speed that can be written with the decimals of controllers, m/s.
const SLOWEST: f64 = 1e-5;
/// Longest dwell in languages without a limit of their own, s.
pub(super) const LONGEST_DWELL: f64 = 3600.0;
/// Greatest acceleration along a path that is written, m/s^2.
const GREATEST_ACCELERATION: f64 = 1e3;
/// Minimum acceleration that can be written with the decimals of controllers, m/s^2.
pub(super) const LEAST_ACCELERATION: f64 = 1e-3;
/// Minimum speed or acceleration of joint moves, relative to the maximum: controllers have whole percentages.
const LEAST_PART: f64 = 0.01;
/// Longest name of a frame or tool, characters, and the rule for it.
const LONGEST_NAME: usize = 32;
const NAMES: &str = "a letter, then letters, digits and underscores, at most 32 characters";

impl Draft {
    /// Checks that the program can be written within these ranges: its names and numbers, the settings of the cell, the
    /// number of joints, that its first move is a joint move, that every value is finite and in range, and that every
    /// statement is one line.
    pub(super) fn check(&self, bounds: &Bounds) -> Result<(), DraftError> {
        check_name(&self.name, bounds.longest_name, bounds.language, bounds.names)?;
        self.check_controller(bounds)?;
        self.check_frame(bounds)?;
        let first = self.points().next().ok_or(DraftError::Empty)?;
        if first.speed.is_some() {
            return Err(DraftError::FirstMove);
        }
        for (at, point) in self.points().enumerate() {
            self.check_point(bounds, at + 1, point)?;
        }
        for step in &self.steps {
            match step {
                DraftStep::Dwell(value) if !(0.0..=bounds.longest_dwell).contains(value) => {
                    return Err(DraftError::Dwell {
                        value: *value,
                        language: bounds.language,
                        most: bounds.longest_dwell,
                    });
                }
                _ => {}
            }
        }
        let is_one_line = |line: &str| line.chars().all(|c| c.is_ascii() && !c.is_ascii_control());
        self.check_statements(bounds, is_one_line, "it must be one line of ASCII characters")
    }

    /// Checks every statement of the cell; the reason says what a statement must be.
    pub(super) fn check_statements(
        &self,
        bounds: &Bounds,
        is_valid: impl Fn(&str) -> bool,
        reason: &'static str,
    ) -> Result<(), DraftError> {
        match self.statements().find(|line| !is_valid(line)) {
            Some(line) => Err(DraftError::Statement {
                statement: line.to_owned(),
                language: bounds.language,
                reason,
            }),
            None => Ok(()),
        }
    }

    fn check_controller(&self, bounds: &Bounds) -> Result<(), DraftError> {
        let controller = &self.controller;
        let numbers = [
            ("frame", controller.frame_number, &bounds.frames),
            ("tool", controller.tool_number, &bounds.tools),
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
        for name in [&controller.frame_name, &controller.tool_name]
            .into_iter()
            .flatten()
        {
            check_name(name, LONGEST_NAME, bounds.language, NAMES)?;
        }
        let settings = [
            (
                "joint speed relative to the maximum",
                Some(controller.joint_speed),
                LEAST_PART,
                1.0,
            ),
            (
                "joint acceleration relative to the maximum",
                controller.joint_acceleration,
                LEAST_PART,
                1.0,
            ),
            (
                "acceleration in m/s^2",
                controller.acceleration,
                bounds.least_acceleration,
                GREATEST_ACCELERATION,
            ),
        ];
        for (what, value, least, most) in settings {
            if let Some(value) = value.filter(|value| !(least..=most).contains(value)) {
                return Err(DraftError::Setting {
                    what,
                    value,
                    least,
                    most,
                });
            }
        }
        Ok(())
    }

    /// What the user frame is fixed to, and the mechanical unit of one on a table.
    fn check_frame(&self, bounds: &Bounds) -> Result<(), DraftError> {
        let language = bounds.language;
        match self.frame_on {
            FrameOn::Cell => return Ok(()),
            FrameOn::Flange if bounds.holds_part => return Ok(()),
            FrameOn::Flange => return Err(DraftError::PartInHand { language }),
            FrameOn::Table => {}
        }
        let names = bounds.units.ok_or(DraftError::Carried { language })?;
        match &self.controller.positioner_unit {
            Some(unit) if !(names.are)(unit) => Err(DraftError::Unit {
                unit: unit.clone(),
                language,
                rule: names.rule,
            }),
            _ => Ok(()),
        }
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

/// Checks that a name is a letter, then letters, digits and underscores, at most `longest` characters.
fn check_name(
    name: &str,
    longest: usize,
    language: &'static str,
    rule: &'static str,
) -> Result<(), DraftError> {
    let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
    if begins && name.chars().all(letters) && name.len() <= longest {
        return Ok(());
    }
    Err(DraftError::Name {
        name: name.to_owned(),
        language,
        rule,
    })
}

/// Refuses a name that is a reserved word; not case-sensitive.
pub(super) fn avoid(name: &str, bounds: &Bounds, words: &[&str]) -> Result<(), DraftError> {
    if words.iter().any(|word| word.eq_ignore_ascii_case(name)) {
        return Err(DraftError::Name {
            name: name.to_owned(),
            language: bounds.language,
            rule: bounds.names,
        });
    }
    Ok(())
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
    /// The part moves with external axes, which the language does not coordinate.
    #[error(
        "a positioner moves the part along the path, but {language} programs are written with a part that stands still"
    )]
    Carried {
        /// The language.
        language: &'static str,
    },
    /// The robot holds the part, and the language has no tools that stand in the cell, or how it names them is not known here.
    #[error(
        "the robot holds the part, but {language} programs are written with the tool on the flange; of these languages ABB RAPID \
         programs are written with a tool that stands in the cell"
    )]
    PartInHand {
        /// The language.
        language: &'static str,
    },
    /// The mechanical unit of the positioner has a name that the language does not have.
    #[error("the mechanical unit `{unit}` of the positioner: in {language} {rule}")]
    Unit {
        /// The name given.
        unit: String,
        /// The language.
        language: &'static str,
        /// The rule.
        rule: &'static str,
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
    /// A speed or acceleration of the cell that is not finite or out of range.
    #[error("the {what} is {value}: it must be between {least} and {most}")]
    Setting {
        /// The setting, with its unit if it has one.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Its minimum.
        least: f64,
        /// Its maximum.
        most: f64,
    },
    /// A dwell that is negative or too long for a statement of the language.
    #[error("a dwell of {value} s is not between 0 and {most} s of {language}")]
    Dwell {
        /// s
        value: f64,
        /// The language.
        language: &'static str,
        /// Longest dwell, s.
        most: f64,
    },
    /// A statement of the cell that is not one statement on one line.
    #[error("the statement {statement:?} cannot be written in {language}: {reason}")]
    Statement {
        /// The statement.
        statement: String,
        /// The language.
        language: &'static str,
        /// What it must be.
        reason: &'static str,
    },
}
