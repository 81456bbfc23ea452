//! The instructions of a job: moves, and the instructions between them that are ignored.

use armill_formats::document::{Problem, Problems};
use armill_formats::language::Language;

use super::position::Positions;
use crate::arc_row::ArcRow;
use crate::messages::ProgramMessages;
use crate::program::{FramedTarget, RobotMove, RobotProgram, Target};
use crate::spelling::{Line, Part, lines};
use crate::text::ProgramText;

/// Maximum nesting of job calls.
const DEEPEST: usize = 30;

/// Words of control flow.
const CHOICES: [&str; 18] = [
    "JUMP",
    "IF",
    "IFTHEN",
    "IFTHENEXP",
    "ELSE",
    "ELSEIF",
    "ELSEIFEXP",
    "ENDIF",
    "WHILE",
    "WHILEEXP",
    "ENDWHILE",
    "FOR",
    "NEXT",
    "SWITCH",
    "CASE",
    "DEFAULT",
    "ENDSWITCH",
    "RET",
];

/// Words that shift or rotate the positions after them.
const SHIFTS: [&str; 6] = ["SFTON", "SFTOF", "MFRAME", "MIRROR", "MSHIFT", "SETTOOL"];

/// Words that compute variables, position variables among them.
const COMPUTES: [&str; 9] = [
    "SET", "ADD", "SUB", "MULMAT", "INVMAT", "CNVRT", "GETS", "SETE", "GETPOS",
];

/// Reads the first job, and the jobs that it calls if they are among `texts`.
///
/// # Errors
/// Every problem of the files, at most 200.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    let is_job = |text: &ProgramText| {
        let begins = |line: &str| {
            ["/JOB", "//POS", "//INST"]
                .iter()
                .any(|begin| line.trim_start().starts_with(begin))
        };
        text.text().lines().any(begins)
    };
    if let Some(other) = texts.first().filter(|text| !is_job(text)) {
        let message = "this is not a job: it has neither /JOB nor //POS nor //INST";
        return Err(Problem::of_file(
            other.name(),
            message,
            "save the job as the controller writes it (.JBI)",
        )
        .into());
    }
    let mut reader = Reader {
        texts: &texts,
        names: texts.iter().map(job_name).collect(),
        done: vec![false; texts.len()],
        moves: Vec::new(),
        messages: ProgramMessages::new(&texts),
    };
    reader.job(0, 0);
    let given = |one: &RobotMove| !matches!(one.target, Target::Elsewhere { .. });
    if let Some(first) = reader.moves.first()
        && !reader.moves.iter().any(given)
    {
        let message = format!(
            "line {}: no target of this job is given in coordinates",
            first.line
        );
        let hint = "only the controller can convert pulses and variables: save the job as a relative job, with \
            positions in BASE, ROBOT or USER";
        reader.messages.problem(0..0, message, hint);
    }
    let Reader {
        names,
        moves,
        messages,
        ..
    } = reader;
    let notes = messages.finish()?;
    Ok(RobotProgram {
        language: Language::Inform,
        name: names.into_iter().next().unwrap_or_default(),
        moves,
        notes,
        texts,
    })
}

/// The name in a job, or that of its file.
fn job_name(text: &ProgramText) -> String {
    let given = text.text().lines().take(50).find_map(|line| {
        let rest = line.trim_start().strip_prefix("//NAME")?;
        let name = rest.trim();
        (!name.is_empty()).then(|| name.to_owned())
    });
    given.unwrap_or_else(|| text.stem().to_owned())
}

/// Reads jobs.
pub(super) struct Reader<'a> {
    texts: &'a [ProgramText],
    names: Vec<String>,
    done: Vec<bool>,
    pub moves: Vec<RobotMove>,
    pub messages: ProgramMessages<'a>,
}

/// A job while it is read.
pub(super) struct Job {
    pub positions: Positions,
    pub row: ArcRow<FramedTarget>,
    depth: usize,
}

impl Reader<'_> {
    fn job(&mut self, index: usize, depth: usize) {
        let (Some(text), Some(done)) = (self.texts.get(index), self.done.get_mut(index)) else {
            return;
        };
        *done = true;
        let caller = self.messages.go_to(index);
        let mut job = Job {
            positions: Positions::new(text),
            row: ArcRow::default(),
            depth,
        };
        let mut instructions = false;
        let mut jobs = 0;
        for line in lines(text.text()) {
            let said = line.trimmed();
            if said.text.starts_with("/JOB") {
                jobs += 1;
                if jobs == 2 {
                    self.messages
                        .note(line.number, "a second job in the same file is ignored");
                    break;
                }
            } else if said.text.starts_with("//INST") {
                instructions = true;
            } else if instructions && !said.text.starts_with("//") {
                self.instruction(&mut job, &line);
            } else if !instructions {
                job.positions.take(&line, &mut self.messages);
            }
            if self.messages.is_full() {
                break;
            }
        }
        self.end_row(&mut job);
        self.messages.go_to(caller);
    }

    fn instruction(&mut self, job: &mut Job, line: &Line) {
        let said = line.trimmed();
        if said.text.starts_with('\'') {
            return;
        }
        if said.text.starts_with('*') {
            let what = "labels and jumps are ignored: the statements here are read once";
            return self.messages.note(line.number, what);
        }
        let mut words = said.words();
        let Some(first) = words.next() else {
            return;
        };
        let word = first.text.to_ascii_uppercase();
        match word.as_str() {
            "MOVJ" | "MOVL" | "MOVS" | "MOVC" => self.motion(job, line, &word, words),
            "CALL" => self.call(job, line, words.next()),
            _ if word.starts_with("+MOV") => {
                let what = "motion of a second robot or a station (+MOV..) is ignored";
                self.messages.note(line.number, what);
            }
            _ if word.contains("MOV") => {
                let message = format!("the move `{word}` is not followed");
                let hint = match word.as_str() {
                    "IMOV" => "it is an incremental move: write it as MOVL to a position",
                    _ => "supported: MOVJ, MOVL, MOVC and MOVS of one robot",
                };
                self.messages.problem(line.span_of(&first), message, hint);
            }
            _ if CHOICES.contains(&word.as_str()) => {
                let what = format!("{word} is ignored: the statements here are read once");
                self.messages.note(line.number, what);
            }
            _ if SHIFTS.contains(&word.as_str()) => {
                let what = format!("{word} is ignored: the listed positions are used");
                self.messages.note(line.number, what);
            }
            _ if COMPUTES.contains(&word.as_str()) && words.any(|word| word.text.starts_with(['P', 'p'])) => {
                let what = format!("{word} of a position variable is ignored: the listed position is used");
                self.messages.note(line.number, what);
            }
            _ => {}
        }
    }

    fn call(&mut self, job: &mut Job, line: &Line, called: Option<Part>) {
        self.end_row(job);
        let called = called.map_or("", |part| part.text);
        let name = called.split_once(':').map_or(called, |(_, name)| name);
        let known = self
            .names
            .iter()
            .position(|other| other.eq_ignore_ascii_case(name));
        match known {
            Some(index) if !self.done[index] && job.depth < DEEPEST => self.job(index, job.depth + 1),
            Some(_) => {
                let what = format!("the job {name} is called again: it is read once");
                self.messages.note(line.number, what);
            }
            None => {
                let what = format!("the job {name} is called, but not given: it is ignored");
                self.messages.note(line.number, what);
            }
        }
    }

    /// Ends a row of MOVC: checks that it formed arcs.
    pub fn end_row(&mut self, job: &mut Job) {
        if let Some(span) = job.row.end() {
            let message = "this row of MOVC has fewer than three points";
            let hint = "an arc has three MOVC in a row";
            self.messages.problem(span, message, hint);
        }
    }
}
