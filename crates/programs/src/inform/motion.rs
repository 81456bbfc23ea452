//! A move of a job: its position, its speed, and rows of MOVC.

use super::position::{ListedName, Name, elsewhere};
use super::read::{Job, Reader};
use crate::arc_row::{ArcEnd, Next};
use crate::program::{FramedTarget, Motion, Speed};
use crate::spelling::{Line, Part, number};
use armill_core::units::from_mm;

impl Reader<'_> {
    /// MOVJ, MOVL, MOVS or MOVC, with the words after it.
    pub fn motion<'l>(
        &mut self,
        job: &mut Job,
        line: &Line<'l>,
        word: &str,
        words: impl Iterator<Item = Part<'l>>,
    ) {
        let mut position = None;
        let mut external = false;
        let mut speed = Speed::Unknown;
        let mut ends_arc = ArcEnd::Unmarked;
        for part in words {
            let text = part.text.to_ascii_uppercase();
            if text.starts_with("//") || text.starts_with('\'') {
                break;
            }
            if text.starts_with('+') {
                let what = "motion of a second robot or a station (+MOV..) is ignored";
                self.messages.note(line.number, what);
                break;
            }
            match (text.as_str(), text.split_once('=')) {
                ("UNTIL" | "SRCH", _) => {
                    let what = format!("{text} is ignored: the full move is used");
                    self.messages.note(line.number, what);
                    break;
                }
                ("FPT", _) => ends_arc = ArcEnd::Marked,
                (_, Some(("V", value))) => speed = self.speed(line, &part, value),
                (_, Some(("VJ" | "VR" | "VE", _))) => speed = Speed::Joints,
                _ => match Name::of(part.text) {
                    Some(Name::Robot(name)) if position.is_none() => {
                        position = self.position(job, line, &part, name);
                        if position.is_none() {
                            return;
                        }
                    }
                    Some(Name::Variable(name)) if position.is_none() => position = Some(elsewhere(&name)),
                    Some(_) => external = true,
                    None => {}
                },
            }
        }
        if external {
            let what =
                "positions of rails and stations (BC, EC, BP, EX) are ignored: they are assumed not to move";
            self.messages.note(line.number, what);
        }
        let Some(position) = position else {
            if !external {
                let message = format!("`{word}` names no position");
                let hint = "a move names one position: `MOVL C00001 V=100.0`";
                self.messages.problem(line.span(), message, hint);
            }
            return;
        };
        if word == "MOVC" {
            let next = job.row.next(position, ends_arc, line.span());
            return self.arc(line, next, speed);
        }
        self.end_row(job);
        if word == "MOVS" {
            let what = "MOVS is read as straight lines between its points";
            self.messages.note(line.number, what);
        }
        let motion = match word {
            "MOVJ" => Motion::Joint,
            _ => Motion::Linear,
        };
        self.moves.push(position.reached(motion, speed, line.number));
    }

    /// The position with this name; P variables that are not listed are on the controller.
    fn position(&mut self, job: &Job, line: &Line, part: &Part, name: ListedName) -> Option<FramedTarget> {
        match job.positions.get(name) {
            Some(position) => Some(position.clone()),
            None if name.list == 'P' => Some(elsewhere(part.text)),
            None => {
                let message = format!("the position {} is not in the list of this job", part.text);
                let hint = "positions are listed below //POS: give the whole job as the controller saves it";
                self.messages.problem(line.span_of(part), message, hint);
                None
            }
        }
    }

    fn speed(&mut self, line: &Line, part: &Part, value: &str) -> Speed {
        if value.starts_with(|c: char| c.is_ascii_alphabetic()) {
            let what = "a speed from a variable is not known";
            self.messages.note(line.number, what);
            return Speed::Unknown;
        }
        match number(value).filter(|value| *value >= 0.0) {
            Some(value) => {
                let what = "speeds V= are read as mm/s; a parameter of the controller may make them cm/min or inch/min";
                self.messages.note(line.number, what);
                Speed::Tip(from_mm(value))
            }
            None => {
                let message = format!("`{value}` is not a valid speed");
                let hint = "write it in mm/s: `V=100.0`";
                self.messages.problem(line.span_of(part), message, hint);
                Speed::Unknown
            }
        }
    }

    /// The meaning of a MOVC in its row.
    fn arc(&mut self, line: &Line, next: Next<FramedTarget>, speed: Speed) {
        match next {
            Next::Straight(position) => self
                .moves
                .push(position.reached(Motion::Linear, speed, line.number)),
            Next::Waits => {}
            Next::Arc { via, end } if via.is_framed_like(&end) => {
                let motion = Motion::Circular { via: via.target };
                self.moves.push(end.reached(motion, speed, line.number));
            }
            Next::Arc { .. } => {
                let message =
                    "the points of this arc are relative to different frames or have different tools";
                let hint = "teach the three points of an arc in one frame with one tool";
                self.messages.problem(line.span(), message, hint);
            }
            Next::Uncertain => {
                let message = "a fourth MOVC in a row: the arcs are ambiguous";
                let hint = "end an arc with FPT, or begin the next one with a MOVL to the current position";
                self.messages.problem(line.span(), message, hint);
            }
        }
    }
}
