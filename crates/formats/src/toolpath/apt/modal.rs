//! What holds until something else is said: unit, dialect, frame, axis, feed, spindle, tool, cycle.
//!
//! | what | held | given to the core in |
//! |---|---|---|
//! | cutter, last MSYS | in the unit of the file, until a move needs it: UNITS may come later | m |
//! | points, heights of cycles | m, in the frame of the path | m |
//! | feed | m/s, or m a turn until the spindle is known | m/s |
//! | spindle | rad/s, below 0 counterclockwise | rad/s |
//!
//! An operation is begun by a word (`begin_operation`) and given before the next move, so that several words about one
//! tool make one operation.

use std::ops::Range;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, Unit, UnitQuaternion, Vector3};
use armill_core::path::{Move, Operation, Step};

use super::cycle::Cycle;
use super::motion::Circle;
use super::statement::{Parameter, Statement};
use super::{Dialect, LengthUnit, Wanted};
use crate::document::{MOST_PROBLEMS, Problem, Problems};
use crate::toolpath::direction::LARGEST;
use crate::toolpath::notes::Notes;

/// So many different words are counted; a file with more is of another kind.
const MOST_WORDS: usize = 1000;
/// Longer words are cut where they are counted, in characters.
const LONGEST_WORD: usize = 120;

/// How feed is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Feed {
    /// m/s
    Speed(f64),
    /// m for each turn of the spindle.
    PerTurn(f64),
}

/// Follows a program word by word.
pub(super) struct Interpreter<'a> {
    /// The path that problems show.
    pub name: &'a str,
    /// What the user says where the file is silent.
    pub requested: &'a Wanted,
    /// Takes the steps.
    out: &'a mut dyn FnMut(Step),
    /// Those found so far.
    pub problems: Vec<Problem>,
    /// Words that say nothing about the path.
    ignored: Notes<String>,
    /// Words that are not known, and what was assumed, as sentences.
    warnings: Notes<String>,
    /// Points named so far: GOTO, FROM and GOHOME.
    pub points: u64,
    /// The unit of length, where it was told or needed.
    pub unit: Option<LengthUnit>,
    /// As it was wanted, or as the first word shows that one of them alone writes.
    pub dialect: Option<Dialect>,
    /// Whether the missing unit has been told already.
    unit_asked: bool,
    /// Cutter in the unit of the file, until a move needs it: the unit may be told later.
    pub cutter: [Option<f64>; 2],
    /// The one at hand, its cutter aside; line 0 until a word begins it.
    pub operation: Operation,
    /// Whether the next move begins an operation.
    begins: bool,
    /// INSERT right before a CUTTER names the tool.
    pub inserted: Option<String>,
    /// Speed that SPINDL/ON comes back to, rad/s.
    pub told_spindle: Option<f64>,
    /// Of moves that are no rapids, until another is told.
    pub feed: Option<Feed>,
    /// Unit of a FEDRAT that tells none.
    pub feed_mode: Option<&'static str>,
    /// Whether the next GOTO is a rapid.
    pub rapid: bool,
    /// A CIRCLE whose GOTO has not come yet.
    pub circle: Option<Circle>,
    /// What every GOTO drills at present.
    pub cycle: Option<Cycle>,
    /// What was told of the tool axis, in the frame of the path.
    pub axis: Option<Unit<Vector3<f64>>>,
    /// Where the tip stands, m.
    pub at: Option<Point3<f64>>,
    /// The last MSYS, in the unit of the file, until a point needs it.
    pub system: Option<(Vector3<f64>, UnitQuaternion<f64>)>,
    /// Where the first MSYS lies, m.
    pub world_from_path: Option<Isometry>,
    /// Path from the system that GOTO counts in.
    pub path_from_here: Isometry,
    /// Whether TRNTYP said that points are in the world.
    pub world_told: bool,
    /// Whether FINI came.
    pub ended: bool,
}

impl<'a> Interpreter<'a> {
    /// Before the first statement.
    pub fn new(name: &'a str, requested: &'a Wanted, out: &'a mut dyn FnMut(Step)) -> Interpreter<'a> {
        Interpreter {
            name,
            requested,
            out,
            problems: Vec::new(),
            ignored: Notes::default(),
            warnings: Notes::default(),
            points: 0,
            unit: None,
            dialect: requested.dialect,
            unit_asked: false,
            cutter: [None; 2],
            operation: Operation::default(),
            begins: true,
            inserted: None,
            told_spindle: None,
            feed: None,
            feed_mode: None,
            rapid: false,
            circle: None,
            cycle: None,
            axis: None,
            at: None,
            system: None,
            world_from_path: None,
            path_from_here: Isometry::identity(),
            world_told: false,
            ended: false,
        }
    }

    /// What is to be noted, or every problem.
    ///
    /// # Errors
    /// All problems, among them a CIRCLE without end and a file without a point.
    pub fn finish(mut self) -> Result<Vec<String>, Problems> {
        if let Some(circle) = &self.circle {
            self.problems.push(circle.without_end.clone());
        }
        if self.points == 0 && self.problems.is_empty() {
            let message = "no GOTO in this file: it moves no tool";
            let hint = "cutter locations have lines such as `GOTO/10.,20.,-5.`";
            self.problems.push(Problem::of_file(self.name, message, hint));
        }
        Problems::from(self.problems).into_result()?;
        let warnings = self.warnings.iter();
        let warnings = warnings.map(|(sentence, noted)| format!("{sentence} ({noted})"));
        let ignored = self.ignored.iter();
        let ignored = ignored.map(|(word, noted)| format!("{word} was passed over {noted}"));
        Ok(warnings.chain(ignored).collect())
    }

    /// Keeps a problem, unless there are enough already.
    pub fn tell(
        &mut self,
        statement: &Statement,
        span: Range<usize>,
        message: impl Into<String>,
        hint: &str,
    ) {
        if self.problems.len() < MOST_PROBLEMS {
            self.problems
                .push(statement.problem(self.name, span, message, hint));
        }
    }

    /// Counts a word that says nothing about the path.
    pub fn ignore(&mut self, statement: &Statement) {
        note(&mut self.ignored, &statement.word, statement.line());
    }

    /// Counts what is not known or was assumed.
    pub fn warn(&mut self, statement: &Statement, sentence: String) {
        note(&mut self.warnings, &sentence, statement.line());
    }

    /// From here on another tool, speed or name.
    pub fn begin_operation(&mut self, statement: &Statement) {
        if !self.begins {
            self.begins = true;
            self.operation.line = 0;
        }
        if self.operation.line == 0 {
            self.operation.line = statement.line();
        }
    }

    /// Gives a move, and before it the operation that it begins.
    pub fn give(&mut self, statement: &Statement, next: Move) {
        if self.begins {
            self.begins = false;
            let metres = self.metres(statement);
            let [diameter, corner_radius] = self.cutter.map(|length| length.map(|length| length * metres));
            (self.out)(Step::Operation(Operation {
                diameter,
                corner_radius,
                line: match self.operation.line {
                    0 => statement.line(),
                    line => line,
                },
                ..self.operation.clone()
            }));
        }
        self.at = Some(next.end);
        (self.out)(Step::Move(next));
    }

    /// Metres of the unit of length; asks for it once if nobody told it.
    ///
    /// Where nobody did, a file has a problem, and mm stand in so that the rest is looked at.
    pub fn metres(&mut self, statement: &Statement) -> f64 {
        self.unit = self.unit.or(self.requested.unit);
        if self.unit.is_none() && !self.unit_asked {
            self.unit_asked = true;
            let message = "a length, but nothing before it tells the unit of this file";
            let hint = "say whether it is in mm or inch (unit = \"mm\" or \"inch\"), or add the line `UNITS/MM` at its beginning";
            self.tell(statement, statement.parameters_span(), message, hint);
        }
        self.unit.unwrap_or(LengthUnit::Millimetre).metres()
    }

    /// What a word tells of whose file this is.
    ///
    /// Words of both are a problem, unless the user has said whose it is.
    pub fn evidence(&mut self, statement: &Statement, dialect: Dialect) {
        match self.dialect {
            None => self.dialect = Some(dialect),
            Some(known) if known != dialect && self.requested.dialect.is_none() => {
                let message = format!(
                    "`{}` is a word of {dialect}, but those before are of {known}",
                    statement.word
                );
                self.tell(
                    statement,
                    statement.word_span(),
                    message,
                    "say whose it is: dialect = \"nx\" or \"solidworks\"",
                );
            }
            Some(_) => {}
        }
    }

    /// All parameters as numbers; `None` if one is none, which is told.
    pub fn numbers(&mut self, statement: &Statement) -> Option<Vec<f64>> {
        let before = self.problems.len();
        let numbers: Vec<f64> = statement
            .parameters()
            .filter_map(|parameter| self.number(statement, &parameter))
            .collect();
        (self.problems.len() == before).then_some(numbers)
    }

    /// A parameter as a number; `None` if it is none, which is told.
    pub fn number(&mut self, statement: &Statement, parameter: &Parameter) -> Option<f64> {
        match parameter.text.parse::<f64>() {
            Ok(number) if number.abs() <= LARGEST => Some(number),
            Ok(_) => {
                let message = format!("`{}` is not a number from -1e9 to 1e9", parameter.text);
                self.tell(
                    statement,
                    parameter.span.clone(),
                    message,
                    "is a decimal point missing?",
                );
                None
            }
            Err(_) if parameter.text.is_empty() => {
                let at = parameter.span.clone();
                self.tell(
                    statement,
                    at,
                    "a number is missing here",
                    "two commas stand side by side, or one at the end",
                );
                None
            }
            Err(_) => {
                let message = format!("`{}` is not a number", parameter.text);
                let hint = format!(
                    "`{}` takes numbers such as `12.5`, separated by commas",
                    statement.word
                );
                self.tell(statement, parameter.span.clone(), message, &hint);
                None
            }
        }
    }
}

/// Counts a word or sentence, cut to [`LONGEST_WORD`]; beyond [`MOST_WORDS`] different ones all are `other words`.
fn note(words: &mut Notes<String>, word: &str, line: u32) {
    let word: String = word.chars().take(LONGEST_WORD).collect();
    match words.len() < MOST_WORDS || words.has(&word) {
        true => words.count(word, line),
        false => words.count("other words".to_owned(), line),
    }
}
