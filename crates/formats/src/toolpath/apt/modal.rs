//! Modal settings: unit, dialect, frame, axis, feed, spindle, tool, cycle.
//!
//! | what | stored | given to the core in |
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
use armill_core::path::{Command, Move, Operation, Step};

use super::options::{AptReadOptions, Dialect};
use super::settings::{Circle, Cycle, Feed};
use super::statement::{Parameter, Statement};
use crate::document::{MOST_PROBLEMS, Problem, Problems};
use crate::toolpath::LengthUnit;
use crate::toolpath::direction::LARGEST;
use crate::toolpath::notes::Notes;

/// So many different words are counted; a file with more is of another kind.
const MOST_WORDS: usize = 1000;
/// Longer words are cut where they are counted, in characters.
const LONGEST_WORD: usize = 120;

/// Follows a program word by word.
pub(super) struct Interpreter<'a> {
    /// The file name shown in problems.
    pub name: &'a str,
    /// Options for a file that does not give these values.
    pub requested: &'a AptReadOptions,
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
    /// The unit of length, as soon as it is given or needed.
    pub unit: Option<LengthUnit>,
    /// The option, or the dialect of the first word that only one of them uses.
    pub dialect: Option<Dialect>,
    /// Whether the missing unit has been reported.
    unit_reported: bool,
    /// Cutter in the unit of the file, until a move needs it: the unit may be given later.
    pub cutter: [Option<f64>; 2],
    /// The one at hand, its cutter aside; line 0 until a word begins it.
    pub operation: Operation,
    /// Whether the next move begins an operation.
    begins: bool,
    /// INSERT right before a CUTTER names the tool.
    pub inserted: Option<String>,
    /// Speed that SPINDL/ON restores, rad/s.
    pub last_spindle: Option<f64>,
    /// Feed of moves that are not rapid, until the next FEDRAT.
    pub feed: Option<Feed>,
    /// Unit of a FEDRAT without a unit.
    pub feed_mode: Option<&'static str>,
    /// Whether the next GOTO is a rapid.
    pub rapid: bool,
    /// A CIRCLE whose GOTO has not come yet.
    pub circle: Option<Circle>,
    /// What every GOTO drills at present.
    pub cycle: Option<Cycle>,
    /// Last given tool axis, in the frame of the path.
    pub axis: Option<Unit<Vector3<f64>>>,
    /// Position of the tip, m.
    pub at: Option<Point3<f64>>,
    /// The last MSYS, in the unit of the file, until a point needs it.
    pub system: Option<(Vector3<f64>, UnitQuaternion<f64>)>,
    /// Pose of the first MSYS, m.
    pub world_from_path: Option<Isometry>,
    /// Path from the system that GOTO counts in.
    pub path_from_here: Isometry,
    /// Whether TRNTYP said that points are in the world.
    pub in_world: bool,
    /// Whether FINI came.
    pub ended: bool,
}

impl<'a> Interpreter<'a> {
    /// Before the first statement.
    pub fn new(
        name: &'a str,
        requested: &'a AptReadOptions,
        out: &'a mut dyn FnMut(Step),
    ) -> Interpreter<'a> {
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
            unit_reported: false,
            cutter: [None; 2],
            operation: Operation::default(),
            begins: true,
            inserted: None,
            last_spindle: None,
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
            in_world: false,
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
            let message = "the file has no GOTO and moves no tool";
            let hint = "cutter locations have lines such as `GOTO/10.,20.,-5.`";
            self.problems.push(Problem::of_file(self.name, message, hint));
        }
        Problems::from(self.problems).into_result()?;
        let warnings = self.warnings.iter();
        let warnings = warnings.map(|(sentence, noted)| format!("{sentence} ({noted})"));
        let ignored = self.ignored.iter();
        let ignored = ignored.map(|(word, noted)| format!("{word} was ignored {noted}"));
        Ok(warnings.chain(ignored).collect())
    }

    /// Keeps a problem, unless there are enough already.
    pub fn report(
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

    /// Gives a command.
    pub fn command(&mut self, command: Command) {
        (self.out)(Step::Command(command));
    }

    /// Metres per unit of length. Reports a missing unit once.
    ///
    /// A missing unit is a problem; mm is then used so that the rest of the file can be checked.
    pub fn metres(&mut self, statement: &Statement) -> f64 {
        self.unit = self.unit.or(self.requested.unit);
        if self.unit.is_none() && !self.unit_reported {
            self.unit_reported = true;
            let message = "a length, but the unit of this file has not been given before";
            let hint = "give the unit (unit = \"mm\" or \"inch\"), or add the line `UNITS/MM` at the beginning of the \
                file";
            self.report(statement, statement.parameters_span(), message, hint);
        }
        self.unit.unwrap_or(LengthUnit::Millimetre).metres()
    }

    /// The dialect to which a word belongs.
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
                self.report(
                    statement,
                    statement.word_span(),
                    message,
                    "give the dialect: dialect = \"nx\" or \"solidworks\"",
                );
            }
            Some(_) => {}
        }
    }

    /// All parameters as numbers; `None` if one is not a number, which is reported.
    pub fn numbers(&mut self, statement: &Statement) -> Option<Vec<f64>> {
        let before = self.problems.len();
        let numbers: Vec<f64> = statement
            .parameters()
            .filter_map(|parameter| self.number(statement, &parameter))
            .collect();
        (self.problems.len() == before).then_some(numbers)
    }

    /// A parameter as a number; `None` if it is not a number, which is reported.
    pub fn number(&mut self, statement: &Statement, parameter: &Parameter) -> Option<f64> {
        match parameter.text.parse::<f64>() {
            Ok(number) if number.abs() <= LARGEST => Some(number),
            Ok(_) => {
                let message = format!("`{}` is not a number from -1e9 to 1e9", parameter.text);
                self.report(
                    statement,
                    parameter.span.clone(),
                    message,
                    "check whether a decimal point is missing",
                );
                None
            }
            Err(_) if parameter.text.is_empty() => {
                let at = parameter.span.clone();
                self.report(
                    statement,
                    at,
                    "a number is missing here",
                    "there are two commas in a row, or one at the end",
                );
                None
            }
            Err(_) => {
                let message = format!("`{}` is not a number", parameter.text);
                let hint = format!(
                    "`{}` needs numbers such as `12.5`, separated by commas",
                    statement.word
                );
                self.report(statement, parameter.span.clone(), message, &hint);
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
