//! Meaning and unit of each column of a joint log, from its name.

use std::collections::BTreeSet;

use super::log::HINT;
use super::unit::{AngleUnit, TimeUnit};
use crate::document::lines::Line;
use crate::document::{Problem, Problems};
use crate::table::sheet::Cell;

/// Meaning of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Meaning {
    /// Time.
    Time,
    /// Actual position of a joint, from 0.
    Actual(usize),
    /// Commanded position of a joint, from 0.
    Commanded(usize),
    /// Position of a link encoder.
    Link(usize),
    /// Torque of a motor.
    Torque(usize),
    /// Number of the move.
    Move,
}

/// Columns of a log.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    /// One for each column; `None` is ignored.
    pub meanings: Vec<Option<Meaning>>,
    /// Ignored names.
    pub unused: Vec<String>,
    /// Number of joints.
    pub joints: usize,
    /// Unit of the time, if its name gives one.
    pub time: Option<TimeUnit>,
    /// Unit of the positions, if their names give one.
    pub angle: Option<AngleUnit>,
}

/// A name with its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Named {
    Time(Option<TimeUnit>),
    /// A joint as it is numbered.
    Joint(Role, usize, Option<AngleUnit>),
    Move,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Role {
    Actual,
    Commanded,
    Link,
    Torque,
}

impl Role {
    const ALL: [Role; 4] = [Role::Actual, Role::Commanded, Role::Link, Role::Torque];

    fn meaning(self, joint: usize) -> Meaning {
        match self {
            Role::Actual => Meaning::Actual(joint),
            Role::Commanded => Meaning::Commanded(joint),
            Role::Link => Meaning::Link(joint),
            Role::Torque => Meaning::Torque(joint),
        }
    }

    /// What its columns are.
    fn described(self) -> &'static str {
        match self {
            Role::Actual => "actual positions",
            Role::Commanded => "commanded positions",
            Role::Link => "positions of the link encoders",
            Role::Torque => "torques",
        }
    }
}

/// Words before the name of a joint, with the unit that the interface defines.
const ROLES: [(&str, Role, Option<AngleUnit>); 20] = [
    ("motor", Role::Actual, None),
    ("link", Role::Link, None),
    ("torque", Role::Torque, None),
    ("actual", Role::Actual, None),
    ("act", Role::Actual, None),
    ("measured", Role::Actual, None),
    ("meas", Role::Actual, None),
    ("feedback", Role::Actual, None),
    ("fb", Role::Actual, None),
    ("aipos", Role::Actual, Some(AngleUnit::Degree)),
    ("target", Role::Commanded, None),
    ("planned", Role::Commanded, None),
    ("commanded", Role::Commanded, None),
    ("command", Role::Commanded, None),
    ("cmd", Role::Commanded, None),
    ("desired", Role::Commanded, None),
    ("set", Role::Commanded, None),
    ("ref", Role::Commanded, None),
    ("reference", Role::Commanded, None),
    ("aspos", Role::Commanded, Some(AngleUnit::Degree)),
];

/// Meaning of a name; `None` for a name that has none here.
fn named(name: &str) -> Option<Named> {
    let lower = name.trim().to_lowercase();
    let words: Vec<&str> = lower
        .split(['_', '.', ' ', '[', ']', '(', ')', '/'])
        .filter(|word| !word.is_empty())
        .collect();
    if matches!(
        words[..],
        ["cmd", "num"] | ["move"] | ["move", "number"] | ["move", "num"] | ["segment"]
    ) {
        return Some(Named::Move);
    }
    match words[..] {
        ["ipoc"] => return Some(Named::Time(Some(TimeUnit::Millisecond))),
        ["t" | "time" | "timestamp" | "zeit"] => return Some(Named::Time(None)),
        ["t" | "time" | "timestamp" | "zeit", unit] => {
            return unit.parse().ok().map(|unit| Named::Time(Some(unit)));
        }
        _ => {}
    }
    // Torques: `torque_j1_nm`.
    let words = match words[..] {
        ["torque", ref rest @ .., "nm"] => [&["torque"], rest].concat(),
        _ => words,
    };
    let unit = words.last().and_then(|word| word.parse::<AngleUnit>().ok());
    let words = &words[..words.len() - usize::from(unit.is_some())];
    let (role, own, rest) = match words.split_first() {
        Some((first, rest)) => match ROLES.iter().find(|(word, _, _)| word == first) {
            Some((_, role, own)) => (*role, *own, rest),
            None => (Role::Actual, None, words),
        },
        None => return None,
    };
    // RTDE: `actual_q_0`, `target_q_0`, in rad.
    let is_rtde = rest.len() == 2 && rest[0] == "q" && words.len() == 3;
    let own = own.or(is_rtde.then_some(AngleUnit::Radian));
    // EGM: `fb_j1`, `planned_j1`, in degrees.
    let is_egm = matches!(words.first(), Some(&("fb" | "planned"))) && rest.len() == 1;
    let own = own.or(is_egm.then_some(AngleUnit::Degree));
    let (letters, digits) = match rest {
        [one] => one.split_at(one.find(|c: char| c.is_ascii_digit())?),
        [letters, digits] => (*letters, *digits),
        _ => return None,
    };
    if !matches!(letters, "j" | "a" | "q" | "joint" | "axis" | "achse") || digits.len() > 2 {
        return None;
    }
    let angle = unit.or(own).filter(|_| role != Role::Torque);
    Some(Named::Joint(role, digits.parse().ok()?, angle))
}

impl Columns {
    /// Those of a header.
    ///
    /// # Errors
    /// No time; joints that are missing, too many or numbered with holes; repeated columns; different units of one quantity.
    pub(super) fn of(
        path: &str,
        header: &Line,
        names: Vec<Cell<'_>>,
        joints: Option<usize>,
    ) -> Result<Columns, Problems> {
        let found: Vec<Option<Named>> = names.iter().map(|cell| named(&cell.text)).collect();
        let numbers = |role: Role| -> BTreeSet<usize> {
            let all = found.iter().flatten();
            all.filter_map(|named| match named {
                Named::Joint(own, number, _) if *own == role => Some(*number),
                _ => None,
            })
            .collect()
        };
        let roles = Role::ALL.map(|role| (role, numbers(role)));
        let joints =
            joints.unwrap_or_else(|| roles.iter().map(|(_, numbers)| numbers.len()).max().unwrap_or(0));
        let first = |role: Role| numbers(role).first().copied().unwrap_or(0);
        let mut columns = Columns {
            meanings: Vec::new(),
            unused: Vec::new(),
            joints,
            time: None,
            angle: None,
        };
        let mut problems: Vec<Problem> = Vec::new();
        for (cell, named) in names.iter().zip(&found) {
            let meaning = named.map(|named| match named {
                Named::Time(_) => Meaning::Time,
                Named::Move => Meaning::Move,
                Named::Joint(role, number, _) => role.meaning(number - first(role)),
            });
            let mut refuse = |message: String, hint: &str| {
                problems.push(header.problem(path, cell.span.clone(), message, hint));
            };
            if meaning.is_some_and(|meaning| columns.has(meaning)) {
                refuse(
                    format!("`{}` repeats an earlier column", cell.text),
                    "remove one of the two columns",
                );
            }
            let unit = match named {
                Some(Named::Joint(_, _, unit)) => *unit,
                _ => None,
            };
            if columns
                .angle
                .zip(unit)
                .is_some_and(|(earlier, unit)| earlier != unit)
            {
                let message = format!("`{}` has another unit than the joints before it", cell.text);
                refuse(message, "give all joint positions in one unit");
            }
            columns.angle = columns.angle.or(unit);
            if let Some(Named::Time(unit)) = named {
                columns.time = *unit;
            }
            if meaning.is_none() {
                columns.unused.push(cell.text.to_string());
            }
            columns.meanings.push(meaning);
        }
        let whole = 0..header.text.len();
        if !columns.has(Meaning::Time) {
            problems.push(header.problem(path, whole.clone(), "no column gives the time", HINT));
        }
        if numbers(Role::Actual).is_empty() && numbers(Role::Commanded).is_empty() {
            problems.push(header.problem(path, whole.clone(), "no column is the position of a joint", HINT));
        }
        for (role, numbers) in &roles {
            let range = numbers.first().zip(numbers.last());
            let Some((first, last)) = range else { continue };
            let fits = numbers.len() == joints && last - first + 1 == joints && *first <= 1;
            if !fits {
                let shown: Vec<String> = numbers.iter().map(ToString::to_string).collect();
                let message = format!(
                    "{} of the joints {}, but the robot has {joints} joints",
                    role.described(),
                    shown.join(", ")
                );
                let hint = "give one column for each joint, numbered from 0 or from 1";
                problems.push(header.problem(path, whole.clone(), message, hint));
            }
        }
        Problems::from(problems).into_result()?;
        Ok(columns)
    }

    /// Whether there is a column with this meaning.
    pub(super) fn has(&self, meaning: Meaning) -> bool {
        self.meanings.contains(&Some(meaning))
    }

    /// Whether there are actual and commanded positions.
    pub(super) fn has_both(&self) -> bool {
        self.has(Meaning::Actual(0)) && self.has(Meaning::Commanded(0))
    }
}
