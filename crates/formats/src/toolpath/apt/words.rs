//! What each word does.

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

use super::modal::{Feed, Interpreter};
use super::statement::Statement;
use super::{Dialect, LengthUnit};

/// Words that say nothing about where the tip goes and how fast.
pub(super) const IGNORED: &[&str] = &[
    "AUXFUN", "CHECK", "CLAMP", "CLEARP", "COOLNT", "CUTCOM", "DELAY", "DISPLY", "INTOL", "LETTER", "MACHIN",
    "MODE", "MULTAX", "OPSKIP", "OPSTOP", "OUTTOL", "PAINT", "PPFUN", "PPRINT", "PREFUN", "REMARK", "RETRCT",
    "SAFETY", "SELECT", "SELCTL", "SEQNO", "SETUP", "STOP", "THREAD", "TITLES", "TMARK", "TOLER", "UNLOAD",
];
/// Words that move the tip, or the points themselves, in a way that is not understood here.
pub(super) const REFUSED: &[&str] = &[
    "ARCDAT", "CALL", "CNTRL", "COPY", "GO", "GOBACK", "GOCLER", "GODLTA", "GODOWN", "GOFWD", "GOLFT",
    "GORGT", "GOUP", "INDEX", "INDIRP", "INDIRV", "KNOT", "MACRO", "MIRROR", "MOVETO", "NURBS", "POLYGO",
    "REFSYS", "SPLINE", "TLLFT", "TLON", "TLRGT", "TRACUT", "TRANS",
];
/// No spindle turns faster, turns a minute.
const FASTEST_SPINDLE_RPM: f64 = 1e6;
/// Axes of a system are perpendicular and of length 1 within this: four decimals.
const AXES_SLACK: f64 = 1e-3;

impl Interpreter<'_> {
    /// Takes the next statement.
    pub fn take(&mut self, statement: &Statement) {
        if self.ended {
            let message = format!("`{}` behind FINI", statement.word);
            self.tell(
                statement,
                statement.word_span(),
                message,
                "one file holds one program: cut this one in two",
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
            "PARTNO" => {
                self.summary.part = Some(statement.free_text().to_owned()).filter(|text| !text.is_empty());
            }
            "INSERT" => {
                self.inserted = Some(statement.free_text().to_owned());
                self.ignore(statement);
            }
            "FINI" => self.ended = true,
            word if REFUSED.contains(&word) => {
                let message = format!("`{word}` moves the tool or its points, and is not understood");
                let hint = "let the CAM system write points and arcs alone: GOTO and CIRCLE";
                self.tell(statement, statement.word_span(), message, hint);
            }
            word if IGNORED.contains(&word) || word.starts_with("CSI_") => self.ignore(statement),
            word if word.contains('=') => {
                let message = "a definition: this is the source of an APT program, not its cutter locations";
                let hint = "run it through the APT processor and take the CL file that comes out";
                self.tell(statement, statement.word_span(), message, hint);
            }
            word => {
                let shown: String = word.chars().take(40).collect();
                self.warn(statement, format!("the word `{shown}` is not known"));
            }
        }
    }

    fn unit(&mut self, statement: &Statement) {
        let word = statement.word_at(0);
        self.summary.unit = match word.as_str() {
            "MM" => Some(LengthUnit::Millimetre),
            "INCH" | "INCHES" | "IN" => Some(LengthUnit::Inch),
            _ => {
                let message = format!("`{word}` is no unit of length");
                self.tell(
                    statement,
                    statement.parameters_span(),
                    message,
                    "`UNITS/MM` or `UNITS/INCH`",
                );
                return;
            }
        };
    }

    /// A number and its mode, in either order; without mode as the one before.
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
                    let message = format!("`{word}` is no mode of feed");
                    self.tell(
                        statement,
                        parameter.span,
                        message,
                        "understood are MMPM, IPM, MMPR and IPR",
                    );
                    return;
                }
                None if value.is_some() => {
                    self.tell(
                        statement,
                        parameter.span,
                        "a second number of a FEDRAT",
                        "`FEDRAT/250.,MMPM`",
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
            self.tell(
                statement,
                statement.parameters_span(),
                message,
                "`FEDRAT/250.,MMPM` or `FEDRAT/MMPM,250.`",
            );
            return;
        };
        self.feed_mode = Some(mode);
        self.feed = self.feed_in(statement, mode, value);
    }

    /// A feed of `value` in this mode; `None` if it is not above 0, which is told.
    pub fn feed_in(&mut self, statement: &Statement, mode: &str, value: f64) -> Option<Feed> {
        if value <= 0.0 {
            let message = format!("a feed of {value} {mode} is not above 0");
            self.tell(
                statement,
                statement.parameters_span(),
                message,
                "rapid moves are told by RAPID before their GOTO",
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

    fn spindl(&mut self, statement: &Statement) {
        let (mut speed_rpm, mut sign, mut on_surface) = (None, 1.0, false);
        for parameter in statement.parameters() {
            match parameter.text.to_uppercase().as_str() {
                "OFF" => speed_rpm = Some(0.0),
                "ON" => self.operation.spindle = self.told_spindle,
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
        let Some(speed_rpm) = speed_rpm else { return };
        if !(0.0..=FASTEST_SPINDLE_RPM).contains(&speed_rpm) {
            let message = format!("{speed_rpm} RPM is not between 0 and {FASTEST_SPINDLE_RPM}");
            self.tell(
                statement,
                statement.parameters_span(),
                message,
                "the sense is told by CLW and CCLW",
            );
            return;
        }
        self.operation.spindle = Some(sign * speed_rpm * TAU / 60.0);
        if speed_rpm > 0.0 {
            self.told_spindle = self.operation.spindle;
        }
    }

    /// LOAD/TOOL,n and LOADTL/n.
    fn load(&mut self, statement: &Statement) {
        let at = usize::from(statement.word == "LOAD");
        if at == 1 && statement.word_at(0) != "TOOL" {
            return self.ignore(statement);
        }
        let Some(parameter) = statement.parameters().nth(at) else {
            self.tell(
                statement,
                statement.word_span(),
                "the number of the tool is missing",
                "`LOAD/TOOL,12`",
            );
            return;
        };
        match parameter.text.trim_end_matches('.').parse::<u32>() {
            Ok(tool) => {
                self.operation.tool = Some(tool);
                self.begin_operation(statement);
            }
            Err(_) => {
                let message = format!("`{}` is no number of a tool", parameter.text);
                self.tell(statement, parameter.span, message, "`LOAD/TOOL,12`");
            }
        }
    }

    /// Diameter and corner radius, from parameter `first` on.
    fn cutter(&mut self, statement: &Statement, first: usize) {
        let before = self.problems.len();
        let mut lengths = [None; 2];
        for (length, parameter) in lengths.iter_mut().zip(statement.parameters().skip(first)) {
            *length = self.number(statement, &parameter);
        }
        if self.problems.len() > before {
            return;
        }
        let [diameter, corner] = lengths;
        let Some(diameter) = diameter else {
            self.tell(
                statement,
                statement.word_span(),
                "the diameter of the tool is missing",
                "`CUTTER/12.,0.5`",
            );
            return;
        };
        // Half a thousandth of the unit: a ball whose diameter was rounded.
        if diameter < 0.0 || corner.is_some_and(|corner| corner < 0.0 || corner > diameter / 2.0 + 5e-4) {
            let message = format!(
                "a tool of diameter {diameter} with a corner radius of {}",
                corner.unwrap_or(0.0)
            );
            let hint = "the diameter comes first; the corner radius is no more than half of it";
            self.tell(statement, statement.parameters_span(), message, hint);
            return;
        }
        self.cutter = [Some(diameter), corner];
        self.begin_operation(statement);
    }

    fn tldata(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::Nx);
        match statement.word_at(0).as_str() {
            "MILL" => self.cutter(statement, 1),
            "DRILL" => {
                // What follows the diameter of a drill are its point and its length; a kind may stand before it.
                let kind = statement.word_at(1);
                let at = if kind.starts_with(|c: char| c.is_ascii_alphabetic()) {
                    2
                } else {
                    1
                };
                self.drill_of(statement, at);
            }
            kind => {
                self.cutter = [None; 2];
                self.begin_operation(statement);
                self.warn(
                    statement,
                    format!("TLDATA of a `{kind}`: its diameter is not known"),
                );
            }
        }
    }

    /// A tool of the diameter that parameter `at` tells, without corner.
    fn drill_of(&mut self, statement: &Statement, at: usize) {
        let Some(parameter) = statement.parameters().nth(at) else {
            let hint = "`TLDATA/DRILL,6.,118.`";
            return self.tell(
                statement,
                statement.word_span(),
                "the diameter of the drill is missing",
                hint,
            );
        };
        match self.number(statement, &parameter) {
            Some(diameter) if diameter < 0.0 => {
                let message = format!("a drill of diameter {diameter}");
                self.tell(statement, parameter.span, message, "the diameter comes first");
            }
            Some(diameter) => {
                self.cutter = [Some(diameter), None];
                self.begin_operation(statement);
            }
            None => {}
        }
    }

    fn tool_path(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::Nx);
        let mut words = statement.parameters().map(|parameter| parameter.text);
        self.operation.name = words.next().filter(|name| !name.is_empty()).map(str::to_owned);
        self.operation.tool = None;
        self.cutter = [None; 2];
        // A path writes its first axis, feed and cycle again.
        self.axis = None;
        self.cycle = None;
        self.begin_operation(statement);
    }

    fn trntyp(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::SolidWorks);
        self.world_told = statement.word_at(0) == "WORLD";
        if !self.world_told {
            let message = format!("TRNTYP/{}: in which system are the points?", statement.word_at(0));
            self.tell(
                statement,
                statement.parameters_span(),
                message,
                "let the CAM system write world coordinates: `TRNTYP/WORLD`",
            );
        }
    }

    /// The local system: twelve numbers, row by row, each row ending in a coordinate of its origin.
    fn csys(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::SolidWorks);
        let Some(numbers) = self.numbers(statement) else {
            return;
        };
        let [a, b, c, x, d, e, f, y, g, h, i, z] = numbers[..] else {
            let message = format!("{} numbers of a CSYS", numbers.len());
            self.tell(
                statement,
                statement.parameters_span(),
                message,
                "twelve are wanted: three rows of four",
            );
            return;
        };
        let axes = Matrix3::new(a, b, c, d, e, f, g, h, i);
        if rotation(axes).is_none() {
            self.tell(
                statement,
                statement.parameters_span(),
                SKEW,
                "the first three numbers of each row make a turn",
            );
        } else if !self.world_told && (axes != Matrix3::identity() || [x, y, z] != [0.0; 3]) {
            let message = "a CSYS, but nothing before it says whether points are in it or in the world";
            self.tell(
                statement,
                statement.word_span(),
                message,
                "`TRNTYP/WORLD` before it says that they are in the world",
            );
        }
    }

    /// The system of the points: its origin, x axis and y axis.
    fn msys(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::Nx);
        let Some(numbers) = self.numbers(statement) else {
            return;
        };
        let [x, y, z, ref axes @ ..] = numbers[..] else {
            return self.tell(
                statement,
                statement.parameters_span(),
                "an MSYS without origin",
                MSYS_HINT,
            );
        };
        let [a, b, c, d, e, f] = *axes else {
            let message = format!("{} numbers of an MSYS", numbers.len());
            return self.tell(statement, statement.parameters_span(), message, MSYS_HINT);
        };
        let (first, second) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
        let Some(turn) = rotation(Matrix3::from_columns(&[first, second, first.cross(&second)])) else {
            return self.tell(statement, statement.parameters_span(), SKEW, MSYS_HINT);
        };
        if self.summary.msys.is_none() && self.summary.points > 0 {
            let message = "the first MSYS, but points came before it";
            self.tell(
                statement,
                statement.word_span(),
                message,
                "every path says its MSYS before its points",
            );
        }
        self.system = Some((Vector3::new(x, y, z), turn));
        self.axis = None;
    }

    /// Takes the last MSYS as the system of what follows; its unit may have been told behind it.
    fn settle_system(&mut self, statement: &Statement) {
        let Some((origin, turn)) = self.system.take() else {
            return;
        };
        let origin = origin * self.metres(statement);
        let world_from_here = Isometry::from_parts(Translation3::from(origin), turn);
        let world_from_path = *self.summary.msys.get_or_insert(world_from_here);
        self.path_from_here = world_from_path.inverse() * world_from_here;
    }
}

const SKEW: &str = "these axes are not perpendicular and of length 1";
const MSYS_HINT: &str = "nine numbers: origin, x axis, y axis";

/// The turn of three axes; `None` if they are not perpendicular, of length 1 and right-handed.
fn rotation(axes: Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let off = (axes.transpose() * axes - Matrix3::identity()).abs().max();
    (off <= AXES_SLACK && axes.determinant() > 0.0).then(|| {
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        // Axes are rounded, a turn is not.
        UnitQuaternion::new_normalize(turn.into_inner())
    })
}
