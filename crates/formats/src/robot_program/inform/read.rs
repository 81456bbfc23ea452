//! What a job does with its positions: moves, and what is passed over between them.

use super::position::{Name, Position, Positions, elsewhere};
use crate::document::Problems;
use crate::robot_program::arc_row::{ArcEnd, ArcRow, Next};
use crate::robot_program::findings::Findings;
use crate::robot_program::language::Language;
use crate::robot_program::program::{Motion, RobotMove, RobotProgram, Speed, Target};
use crate::robot_program::spelling::{Line, Part, lines, number};
use crate::robot_program::text::ProgramText;

/// Jobs that call jobs are followed so deep.
const DEEPEST: usize = 30;

/// Words that choose what runs and how often.
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

/// Words that shift or turn what follows.
const SHIFTS: [&str; 6] = ["SFTON", "SFTOF", "MFRAME", "MIRROR", "MSHIFT", "SETTOOL"];

/// Words that compute variables, position variables among them.
const COMPUTES: [&str; 9] = [
    "SET", "ADD", "SUB", "MULMAT", "INVMAT", "CNVRT", "GETS", "SETE", "GETPOS",
];

/// Reads the job that comes first, with the jobs that it calls as far as they are among `texts`.
///
/// # Errors
/// Every problem of the files, at most 200.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    let mut reader = Reader {
        texts: &texts,
        names: texts.iter().map(job_name).collect(),
        done: vec![false; texts.len()],
        moves: Vec::new(),
        findings: Findings::default(),
    };
    reader.job(0, 0);
    let told = |one: &RobotMove| !matches!(one.target, Target::Elsewhere { .. });
    if let (Some(first), Some(text)) = (reader.moves.first(), texts.first()) {
        if !reader.moves.iter().any(told) {
            let message = format!(
                "line {}: no target of this job is told in coordinates",
                first.line
            );
            let hint = "pulses and variables are known to the controller alone: save the job as a relative job, with positions \
                        in BASE, ROBOT or USER";
            reader.findings.problem(text, 0..0, message, hint);
        }
    }
    let Reader {
        names,
        moves,
        findings,
        ..
    } = reader;
    let notes = findings.finish()?;
    Ok(RobotProgram {
        language: Language::Inform,
        name: names.into_iter().next().unwrap_or_default(),
        moves,
        notes,
        texts,
    })
}

/// What a job calls itself, or its file.
fn job_name(text: &ProgramText) -> String {
    let told = text.text().lines().take(50).find_map(|line| {
        let rest = line.trim_start().strip_prefix("//NAME")?;
        let name = rest.trim();
        (!name.is_empty()).then(|| name.to_owned())
    });
    told.unwrap_or_else(|| {
        let name = text.name().rsplit(['/', '\\']).next().unwrap_or_default();
        name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned()
    })
}

struct Reader<'a> {
    texts: &'a [ProgramText],
    names: Vec<String>,
    done: Vec<bool>,
    moves: Vec<RobotMove>,
    findings: Findings,
}

/// A job on its way.
struct Job<'a> {
    text: &'a ProgramText,
    positions: Positions<'a>,
    row: ArcRow<Position>,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn job(&mut self, index: usize, depth: usize) {
        let (Some(text), Some(done)) = (self.texts.get(index), self.done.get_mut(index)) else {
            return;
        };
        *done = true;
        let mut job = Job {
            text,
            positions: Positions::new(text, index),
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
                    self.findings
                        .note(text, line.number, "a second job in the same file is passed over");
                    break;
                }
            } else if said.text.starts_with("//INST") {
                instructions = true;
            } else if instructions && !said.text.starts_with("//") {
                self.instruction(&mut job, &line);
            } else if !instructions {
                job.positions.take(&line, &mut self.findings);
            }
            if self.findings.is_full() {
                return;
            }
        }
        self.end_row(&mut job);
    }

    fn instruction(&mut self, job: &mut Job<'a>, line: &Line) {
        let said = line.trimmed();
        if said.text.starts_with('\'') {
            return;
        }
        if said.text.starts_with('*') {
            let what = "labels and jumps are passed over: what stands here runs once";
            return self.findings.note(job.text, line.number, what);
        }
        let mut words = said.words();
        let Some(first) = words.next() else {
            return;
        };
        let word = first.text.to_ascii_uppercase();
        match word.as_str() {
            "MOVJ" | "MOVL" | "MOVS" | "MOVC" => self.motion(job, line, (&word, words)),
            "CALL" => self.call(job, line, words.next()),
            _ if word.starts_with("+MOV") => {
                let what = "what a second robot or a station does beside (+MOV..) is passed over";
                self.findings.note(job.text, line.number, what);
            }
            _ if word.contains("MOV") => {
                let message = format!("the move `{word}` is not followed");
                let hint = match word.as_str() {
                    "IMOV" => "it goes by an increment: write it as MOVL to a position",
                    _ => "understood are MOVJ, MOVL, MOVC and MOVS of one robot",
                };
                self.findings
                    .problem(job.text, line.span_of(&first), message, hint);
            }
            _ if CHOICES.contains(&word.as_str()) => {
                let what = format!("{word} is passed over: what stands here runs once");
                self.findings.note(job.text, line.number, what);
            }
            _ if SHIFTS.contains(&word.as_str()) => {
                let what = format!("{word} is passed over: positions are taken as they are listed");
                self.findings.note(job.text, line.number, what);
            }
            _ if COMPUTES.contains(&word.as_str()) => {
                if words.any(|word| word.text.starts_with(['P', 'p'])) {
                    let what =
                        format!("{word} of a position variable is passed over: it is taken as it is listed");
                    self.findings.note(job.text, line.number, what);
                }
            }
            _ => {}
        }
    }

    fn call(&mut self, job: &mut Job<'a>, line: &Line, called: Option<Part>) {
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
                self.findings.note(job.text, line.number, what);
            }
            None => {
                let what = format!("the job {name} is called, but not given: what it does is passed over");
                self.findings.note(job.text, line.number, what);
            }
        }
    }

    fn motion<'l>(
        &mut self,
        job: &mut Job<'a>,
        line: &Line<'l>,
        (word, words): (&str, impl Iterator<Item = Part<'l>>),
    ) {
        let mut position = None;
        let mut external = false;
        let mut speed = Speed::Untold;
        let mut ends_arc = ArcEnd::Untold;
        for part in words {
            let text = part.text.to_ascii_uppercase();
            if text.starts_with("//") || text.starts_with('\'') {
                break;
            }
            if text.starts_with('+') {
                let what = "what a second robot or a station does beside (+MOV..) is passed over";
                self.findings.note(job.text, line.number, what);
                break;
            }
            match (text.as_str(), text.split_once('=')) {
                ("UNTIL" | "SRCH", _) => {
                    let what = format!("{text} is passed over: the move goes to its end");
                    self.findings.note(job.text, line.number, what);
                    break;
                }
                ("FPT", _) => ends_arc = ArcEnd::Told,
                (_, Some(("V", value))) => speed = self.speed(job, line, (&part, value)),
                (_, Some(("VJ" | "VR" | "VE", _))) => speed = Speed::Joints,
                _ => match Name::of(part.text) {
                    Some(Name::Robot(list, number)) if position.is_none() => {
                        position = self.position(job, line, (&part, list, number));
                        if position.is_none() {
                            return;
                        }
                    }
                    Some(Name::Found(name)) if position.is_none() => position = Some(elsewhere(&name)),
                    Some(_) => external = true,
                    None => {}
                },
            }
        }
        if external {
            let what = "positions of rails and stations (BC, EC, BP, EX) are passed over: they are taken as standing still";
            self.findings.note(job.text, line.number, what);
        }
        let Some(position) = position else {
            if !external {
                let message = format!("`{word}` names no position");
                let hint = "a move names one: `MOVL C00001 V=100.0`";
                self.findings.problem(job.text, line.span(), message, hint);
            }
            return;
        };
        if word == "MOVC" {
            return self.arc(job, line, (position, speed, ends_arc));
        }
        self.end_row(job);
        if word == "MOVS" {
            let what = "MOVS is taken as straight between its points";
            self.findings.note(job.text, line.number, what);
        }
        let motion = match word {
            "MOVJ" => Motion::Joint,
            _ => Motion::Linear,
        };
        self.push((motion, position, speed), line);
    }

    /// The position of this name; P variables that are not listed stand on the controller.
    fn position(
        &mut self,
        job: &Job<'a>,
        line: &Line,
        (part, list, number): (&Part, char, u32),
    ) -> Option<Position> {
        match (job.positions.get(list, number), list) {
            (Some(position), _) => Some(position.clone()),
            (None, 'P') => Some(elsewhere(part.text)),
            (None, _) => {
                let message = format!("the position {} is not in the list of this job", part.text);
                let hint = "its line stands below //POS: give the whole job, as the controller saves it";
                self.findings.problem(job.text, line.span_of(part), message, hint);
                None
            }
        }
    }

    fn speed(&mut self, job: &Job<'a>, line: &Line, (part, value): (&Part, &str)) -> Speed {
        if value.starts_with(|c: char| c.is_ascii_alphabetic()) {
            let what = "a speed out of a variable is not known";
            self.findings.note(job.text, line.number, what);
            return Speed::Untold;
        }
        match number(value).filter(|value| *value >= 0.0) {
            Some(value) => {
                let what = "speeds V= are taken as mm/s; a parameter of the controller may make them cm/min or inch/min";
                self.findings.note(job.text, line.number, what);
                Speed::Tip(value * 1e-3)
            }
            None => {
                let message = format!("`{value}` is no speed");
                let hint = "write it in mm/s: `V=100.0`";
                self.findings.problem(job.text, line.span_of(part), message, hint);
                Speed::Untold
            }
        }
    }

    /// One more MOVC of a row.
    fn arc(&mut self, job: &mut Job<'a>, line: &Line, (position, speed, end): (Position, Speed, ArcEnd)) {
        match job.row.next(position, end, line.span()) {
            Next::Straight(position) => self.push((Motion::Linear, position, speed), line),
            Next::Waits => {}
            Next::Arc { via, end } if (via.frame, via.tool) == (end.frame, end.tool) => {
                self.push((Motion::Circular { via: via.target }, end, speed), line);
            }
            Next::Arc { .. } => {
                let message =
                    "the points of this arc count in different frames or have different tools".to_owned();
                let hint = "teach the three points of an arc in one frame with one tool";
                self.findings.problem(job.text, line.span(), message, hint);
            }
            Next::Uncertain => {
                let message = "a fourth MOVC in a row: which points make which arc is not certain".to_owned();
                let hint =
                    "end an arc by FPT, or begin the next with a MOVL to the place where the tip stands";
                self.findings.problem(job.text, line.span(), message, hint);
            }
        }
    }

    /// No MOVC follows: whether what came made arcs.
    fn end_row(&mut self, job: &mut Job<'a>) {
        if let Some(span) = job.row.end() {
            let message = "this row of MOVC has no three points".to_owned();
            let hint = "an arc goes through three MOVC in a row";
            self.findings.problem(job.text, span, message, hint);
        }
    }

    fn push(&mut self, (motion, position, speed): (Motion, Position, Speed), line: &Line) {
        let Position { target, frame, tool } = position;
        let speed = match motion {
            Motion::Joint => Speed::Joints,
            _ => speed,
        };
        self.moves.push(RobotMove {
            motion,
            target,
            frame,
            tool,
            speed,
            line: line.number,
        });
    }
}
