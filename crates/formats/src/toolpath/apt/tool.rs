//! The tool: its number by LOAD and LOADTL, its diameter and corner radius by CUTTER and TLDATA.
//!
//! | word | parameters |
//! |---|---|
//! | `LOAD/TOOL,n`, `LOADTL/n` | number of the tool; other kinds of LOAD are ignored |
//! | `CUTTER/d,r` | diameter, corner radius; in the unit of the file |
//! | `TLDATA/MILL,d,r` | the same (NX) |
//! | `TLDATA/DRILL,d` or `DRILL,kind,d` | diameter alone (NX); what follows is ignored |
//!
//! Each begins an operation. Lengths stay in the unit of the file until a move needs them.

use super::modal::Interpreter;
use super::options::Dialect;
use super::statement::Statement;

impl Interpreter<'_> {
    /// LOAD/TOOL,n and LOADTL/n.
    pub fn load(&mut self, statement: &Statement) {
        let at = usize::from(statement.word == "LOAD");
        if at == 1 && statement.word_at(0) != "TOOL" {
            return self.ignore(statement);
        }
        let Some(parameter) = statement.parameters().nth(at) else {
            self.report(
                statement,
                statement.word_span(),
                "the number of the tool is missing",
                "write `LOAD/TOOL,12`",
            );
            return;
        };
        match parameter.text.trim_end_matches('.').parse::<u32>() {
            Ok(tool) => {
                self.operation.tool = Some(tool);
                self.begin_operation(statement);
            }
            Err(_) => {
                let message = format!("`{}` is not a number of a tool", parameter.text);
                self.report(statement, parameter.span, message, "`LOAD/TOOL,12`");
            }
        }
    }

    /// Diameter and corner radius, from parameter `first` on.
    ///
    /// A corner radius that is left out is not known, and not zero.
    pub fn cutter(&mut self, statement: &Statement, first: usize) {
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
            self.report(
                statement,
                statement.word_span(),
                "the diameter of the tool is missing",
                "write `CUTTER/12.,0.5`",
            );
            return;
        };
        // Half a thousandth of the unit: a ball whose diameter was rounded.
        if diameter < 0.0 || corner.is_some_and(|corner| corner < 0.0 || corner > diameter / 2.0 + 5e-4) {
            let message = format!(
                "a tool of diameter {diameter} with a corner radius of {}",
                corner.unwrap_or(0.0)
            );
            let hint = "write the diameter first; the corner radius must not exceed half of it";
            self.report(statement, statement.parameters_span(), message, hint);
            return;
        }
        self.cutter = [Some(diameter), corner];
        self.begin_operation(statement);
    }

    /// TLDATA: the tool of an NX path.
    ///
    /// Of a kind other than MILL and DRILL no diameter is taken, and that is noted.
    pub fn tldata(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::Nx);
        match statement.word_at(0).as_str() {
            "MILL" => self.cutter(statement, 1),
            "DRILL" => {
                // The diameter of a drill is followed by its point and length; a kind may precede it.
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

    /// A tool with the diameter in parameter `at`, without a corner radius.
    fn drill_of(&mut self, statement: &Statement, at: usize) {
        let Some(parameter) = statement.parameters().nth(at) else {
            let hint = "write `TLDATA/DRILL,6.,118.`";
            return self.report(
                statement,
                statement.word_span(),
                "the diameter of the drill is missing",
                hint,
            );
        };
        match self.number(statement, &parameter) {
            Some(diameter) if diameter < 0.0 => {
                let message = format!("a drill of diameter {diameter}");
                self.report(statement, parameter.span, message, "write the diameter first");
            }
            Some(diameter) => {
                self.cutter = [Some(diameter), None];
                self.begin_operation(statement);
            }
            None => {}
        }
    }
}
