//! Evaluation of each word; those of frames, tools, moves and cycles are in other files.
//!
//! | word | what it changes |
//! |---|---|
//! | `UNITS` | the unit of lengths, not of feeds |
//! | `FEDRAT` | the feed, until the next one; its mode if given |
//! | `RAPID` | the pace of the next GOTO alone |
//! | `SPINDL` | the speed of the spindle: a new operation |
//! | `COOLNT` | coolant on or off |
//! | `DELAY` | a dwell, in seconds or in revolutions of the spindle |
//! | `STOP`, `OPSTOP` | a stop of the program |
//! | `TOOL PATH` | the name of the operation (NX); forgets axis, feed, cycle and cutter, which a path writes again |
//! | `INSERT` before `CUTTER` | the name of the operation (SolidWorks) |
//! | `END-OF-PATH`, `FINI` | ends a cycle; ends the program |
//! | `CSYS`, `TRNTYP`, `MSYS` | where points are counted: `systems` |
//! | `LOAD`, `LOADTL`, `CUTTER`, `TLDATA` | the tool: `tool` |
//! | `GOTO`, `FROM`, `GOHOME`, `CIRCLE` | where the tip is: `motion` |
//! | `CYCLE` | what a GOTO means: `cycle` |

use std::f64::consts::TAU;

use armill_core::path::Command;

use super::modal::Interpreter;
use super::options::Dialect;
use super::settings::Feed;
use super::statement::Statement;
use crate::toolpath::LengthUnit;

/// Words that say nothing about where the tip goes and how fast.
pub(super) const IGNORED: &[&str] = &[
    "AUXFUN", "CHECK", "CLAMP", "CLEARP", "CUTCOM", "DISPLY", "INTOL", "LETTER", "MACHIN", "MODE", "MULTAX",
    "OPSKIP", "OUTTOL", "PAINT", "PPFUN", "PPRINT", "PREFUN", "REMARK", "RETRCT", "SAFETY", "SELECT",
    "SELCTL", "SEQNO", "SETUP", "THREAD", "TITLES", "TMARK", "TOLER", "UNLOAD",
];
/// Words that move the tip, or the points themselves, in a way that is not understood here.
pub(super) const REFUSED: &[&str] = &[
    "ARCDAT", "CALL", "CNTRL", "COPY", "GO", "GOBACK", "GOCLER", "GODLTA", "GODOWN", "GOFWD", "GOLFT",
    "GORGT", "GOUP", "INDEX", "INDIRP", "INDIRV", "KNOT", "MACRO", "MIRROR", "MOVETO", "NURBS", "POLYGO",
    "REFSYS", "SPLINE", "TLLFT", "TLON", "TLRGT", "TRACUT", "TRANS",
];
/// No spindle turns faster, turns a minute.
const FASTEST_SPINDLE_RPM: f64 = 1e6;

impl Interpreter<'_> {
    /// Takes the next statement.
    ///
    /// Problems are collected, and the next statement is read without this one. Unknown words are counted
    /// as such, not refused.
    pub fn take(&mut self, statement: &Statement) {
        if self.ended {
            let message = format!("`{}` after FINI", statement.word);
            self.report(
                statement,
                statement.word_span(),
                message,
                "a file must contain one program: split this file",
            );
            return;
        }
        let inserted = self.inserted.take();
        match statement.word.as_str() {
            "GOTO" | "FROM" | "GOHOME" => {
                self.settle_system(statement);
                self.goto(statement);
            }
            "CIRCLE" => {
                self.settle_system(statement);
                self.circle(statement);
            }
            "RAPID" => self.rapid = true,
            "CYCLE" => self.cycle(statement),
            "FEDRAT" => self.fedrat(statement),
            "SPINDL" => self.spindl(statement),
            "COOLNT" => {
                let on = statement.word_at(0) != "OFF";
                self.command(Command::Coolant(on));
            }
            "DELAY" => self.delay(statement),
            "STOP" | "OPSTOP" => self.command(Command::Stop),
            "UNIT" | "UNITS" => self.unit(statement),
            "LOAD" | "LOADTL" => self.load(statement),
            "CUTTER" => {
                self.operation.name = inserted.filter(|text| !text.is_empty());
                self.cutter(statement, 0);
            }
            "TLDATA" => self.tldata(statement),
            "TOOL PATH" => self.tool_path(statement),
            "CSYS" => self.csys(statement),
            "TRNTYP" => self.trntyp(statement),
            "MSYS" => self.msys(statement),
            "END-OF-PATH" => {
                self.evidence(statement, Dialect::Nx);
                self.cycle = None;
            }
            "PARTNO" => {}
            "INSERT" => {
                self.inserted = Some(statement.free_text().to_owned());
                self.ignore(statement);
            }
            "FINI" => self.ended = true,
            word if REFUSED.contains(&word) => {
                let message = format!("`{word}` moves the tool or its points and is not supported");
                let hint = "let the CAM system write only points and arcs: GOTO and CIRCLE";
                self.report(statement, statement.word_span(), message, hint);
            }
            word if IGNORED.contains(&word) || word.starts_with("CSI_") => self.ignore(statement),
            word if word.contains('=') => {
                let message = "a definition: this is the source of an APT program, not its cutter locations";
                let hint = "process it with the APT processor and use the resulting CL file";
                self.report(statement, statement.word_span(), message, hint);
            }
            word => {
                let shown: String = word.chars().take(40).collect();
                self.warn(statement, format!("the word `{shown}` is not known"));
            }
        }
    }

    /// UNITS: mm or inch, from here on.
    fn unit(&mut self, statement: &Statement) {
        let word = statement.word_at(0);
        self.unit = match word.as_str() {
            "MM" => Some(LengthUnit::Millimetre),
            "INCH" | "INCHES" | "IN" => Some(LengthUnit::Inch),
            _ => {
                let message = format!("`{word}` is not a unit of length");
                self.report(
                    statement,
                    statement.parameters_span(),
                    message,
                    "write `UNITS/MM` or `UNITS/INCH`",
                );
                return;
            }
        };
    }

    /// A number and its mode, in either order; without mode as the one before.
    ///
    /// FEDRAT; the unit of the feed is in its mode and has nothing to do with UNITS.
    fn fedrat(&mut self, statement: &Statement) {
        let (mut mode, mut value) = (self.feed_mode, None);
        for parameter in statement.parameters() {
            let word = parameter.text.to_uppercase();
            match ["MMPM", "IPM", "MMPR", "IPR"]
                .into_iter()
                .find(|known| *known == word)
            {
                Some(known) => mode = Some(known),
                None if word.starts_with(|c: char| c.is_ascii_alphabetic()) => {
                    let message = format!("`{word}` is not a feed mode");
                    self.report(
                        statement,
                        parameter.span,
                        message,
                        "supported: MMPM, IPM, MMPR and IPR",
                    );
                    return;
                }
                None if value.is_some() => {
                    self.report(
                        statement,
                        parameter.span,
                        "a second number of a FEDRAT",
                        "write `FEDRAT/250.,MMPM`",
                    );
                    return;
                }
                None => match self.number(statement, &parameter) {
                    Some(number) => value = Some(number),
                    None => return,
                },
            }
        }
        let (Some(mode), Some(value)) = (mode, value) else {
            let missing = if value.is_none() { "number" } else { "unit" };
            let message = format!("a FEDRAT without {missing}");
            self.report(
                statement,
                statement.parameters_span(),
                message,
                "write `FEDRAT/250.,MMPM` or `FEDRAT/MMPM,250.`",
            );
            return;
        };
        self.feed_mode = Some(mode);
        self.feed = self.feed_in(statement, mode, value);
    }

    /// A feed of `value` in this mode; `None` if it is not above 0, which is reported.
    pub fn feed_in(&mut self, statement: &Statement, mode: &str, value: f64) -> Option<Feed> {
        if value <= 0.0 {
            let message = format!("a feed of {value} {mode} is not above 0");
            self.report(
                statement,
                statement.parameters_span(),
                message,
                "write RAPID before a GOTO for a rapid move",
            );
            return None;
        }
        let metres = match mode.starts_with("MM") {
            true => LengthUnit::Millimetre.metres(),
            false => LengthUnit::Inch.metres(),
        };
        Some(match mode.ends_with("PM") {
            true => Feed::Speed(value * metres / 60.0),
            false => Feed::PerTurn(value * metres),
        })
    }

    /// SPINDL: revolutions per minute, CLW or CCLW; clockwise if neither is given. ON restores the last speed above 0.
    /// A speed in other units than RPM is not known, and noted.
    fn spindl(&mut self, statement: &Statement) {
        let (mut speed_rpm, mut sign, mut on_surface) = (None, 1.0, false);
        for parameter in statement.parameters() {
            match parameter.text.to_uppercase().as_str() {
                "OFF" => speed_rpm = Some(0.0),
                "ON" => self.operation.spindle = self.last_spindle,
                "RPM" | "CLW" => {}
                "CCLW" => sign = -1.0,
                "SFM" | "SMM" | "MAXRPM" | "RANGE" => on_surface = true,
                word if word.starts_with(|c: char| c.is_ascii_alphabetic()) => {
                    self.warn(statement, format!("the word `{word}` of SPINDL is not known"));
                }
                _ => match self.number(statement, &parameter) {
                    Some(number) => speed_rpm = speed_rpm.or(Some(number)),
                    None => return,
                },
            }
        }
        self.begin_operation(statement);
        if on_surface {
            self.operation.spindle = None;
            self.warn(
                statement,
                "SPINDL in other units than RPM: its speed is not known".to_owned(),
            );
            return;
        }
        // ON without a number has set the speed already.
        let Some(speed_rpm) = speed_rpm else { return };
        if !(0.0..=FASTEST_SPINDLE_RPM).contains(&speed_rpm) {
            let message = format!("{speed_rpm} RPM is not between 0 and {FASTEST_SPINDLE_RPM}");
            self.report(
                statement,
                statement.parameters_span(),
                message,
                "give the direction with CLW or CCLW",
            );
            return;
        }
        self.operation.spindle = Some(sign * speed_rpm * TAU / 60.0);
        if speed_rpm > 0.0 {
            self.last_spindle = self.operation.spindle;
        }
    }

    /// DELAY: seconds; with REV revolutions of the spindle, which are noted where its speed is not known.
    fn delay(&mut self, statement: &Statement) {
        let (mut value, mut in_revolutions) = (None, false);
        for parameter in statement.parameters() {
            match parameter.text.to_uppercase().as_str() {
                "REV" => in_revolutions = true,
                "SEC" | "ON" => {}
                _ => match self.number(statement, &parameter) {
                    Some(number) => value = value.or(Some(number)),
                    None => return,
                },
            }
        }
        let spindle = self.operation.spindle.map(f64::abs).filter(|speed| *speed > 0.0);
        let seconds = match (value, in_revolutions, spindle) {
            (Some(value), false, _) => value,
            (Some(value), true, Some(speed)) => value * TAU / speed,
            _ => {
                self.warn(statement, "DELAY without a known time is not followed".to_owned());
                return;
            }
        };
        if seconds > 0.0 {
            self.command(Command::Dwell(seconds));
        }
    }

    /// TOOL PATH of NX: another operation, whose name is the first parameter.
    fn tool_path(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::Nx);
        let mut words = statement.parameters().map(|parameter| parameter.text);
        self.operation.name = words.next().filter(|name| !name.is_empty()).map(str::to_owned);
        self.operation.tool = None;
        self.cutter = [None; 2];
        // A path writes its first axis, feed and cycle again.
        self.axis = None;
        self.feed = None;
        self.cycle = None;
        self.begin_operation(statement);
    }
}
