//! Modal settings: frame, tool, tip speed, and whether the tool or the workpiece is on the flange.

use armill_core::frame::Isometry;
use armill_core::units::from_mm;
use armill_formats::convention::Convention;

use super::aggregate::{Aggregate, POSE, Value};
use super::points::{PointValue, Reference};
use super::state::Reader;
use crate::messages::shown;
use crate::program::{Frame, FrameKind, Speed};
use crate::tokens::{Cursor, Kind, Token};

/// Predefined frames; all are the base of the robot if `$ROBROOT` is null.
const NULL_FRAMES: [&str; 3] = ["$NULLFRAME", "$WORLD", "$ROBROOT"];

impl FrameKind {
    /// The array of all frames of this kind.
    fn data(self) -> &'static str {
        match self {
            FrameKind::Reference => "BASE_DATA",
            FrameKind::Tool => "TOOL_DATA",
        }
    }

    /// The component with the number of a frame of this kind.
    fn field(self) -> &'static str {
        match self {
            FrameKind::Reference => "BASE_NO",
            FrameKind::Tool => "TOOL_NO",
        }
    }
}

impl<'a> Reader<'a> {
    /// Assigns the value at the cursor to the variable; `at` is the beginning of the line.
    pub fn assign(&mut self, at: Token, to: &Reference, mut value: Cursor<'a>) {
        match (to.name.as_str(), to.field.as_deref()) {
            ("$BASE", field) => {
                self.modal.base = self.frame(at, FrameKind::Reference, value, field.is_some());
            }
            ("$TOOL", field) => self.modal.tool = self.frame(at, FrameKind::Tool, value, field.is_some()),
            ("$VEL", Some("CP")) => self.speed(at, value.number()),
            ("$VEL", None) => {
                let given = match Aggregate::read(&mut value.clone()) {
                    Ok(all) => all.number("CP"),
                    Err(_) => {
                        let is_call = value.word().is_some_and(|word| word == "SVEL_CP") && value.pass('(');
                        is_call.then(|| value.number()).flatten()
                    }
                };
                self.speed(at, given);
            }
            ("$APO", Some("CDIS")) => self.modal.blend = value.number().map(from_mm),
            ("$APO", None) => {
                let set = self.set(at, value);
                self.modal.blend = set.and_then(|set| set.number("CDIS")).map(from_mm);
            }
            ("FDAT_ACT", None) => {
                if let Some(set) = self.set(at, value) {
                    self.frames_of(at, &set);
                }
            }
            ("LDAT_ACT", None) => self.path_speed = self.set(at, value).and_then(|set| set.number("VEL")),
            ("$IPO_MODE", None) => {
                let text = &value.text[value.place().start..value.end];
                self.modal.tool_is_stationary = match self.set_named_within(value) {
                    Some(set) => set.field("IPO_FRAME") == Some(&Value::Flag("TCP".to_owned())),
                    None => text.trim().eq_ignore_ascii_case("#TCP"),
                };
            }
            (name, field) if !name.starts_with('$') => {
                let name = name.to_owned();
                let is_whole = field.is_none() && value.peek().is_some_and(|token| token.is('{'));
                let given = is_whole.then(|| self.aggregate(&mut value)).flatten();
                let known = match given {
                    Some(aggregate) => PointValue::Given(aggregate),
                    None => PointValue::Computed { line: at.line },
                };
                self.names.put(&self.module.clone(), name, known);
            }
            _ => {}
        }
    }

    /// The assignments after `WITH`, separated by commas.
    pub fn with(&mut self, line: &Cursor<'a>) {
        let mut cursor = line.clone();
        while cursor.word().is_none_or(|word| word != "WITH") {
            if cursor.peek_word().is_none() && cursor.next().is_none() {
                return;
            }
        }
        while let Some(at) = cursor.peek() {
            let Some(reference) = Reference::read(&mut cursor) else {
                return;
            };
            let begins = cursor.pass('=').then_some(cursor.tokens);
            let mut depth = 0_usize;
            let mut length = 0;
            while let Some(token) = cursor.next() {
                match token.kind {
                    Kind::Mark(',') if depth == 0 => break,
                    Kind::Mark('(' | '{' | '[') => depth += 1,
                    Kind::Mark(')' | '}' | ']') => depth = depth.saturating_sub(1),
                    _ => {}
                }
                length += 1;
            }
            if let Some(clause) = begins.map(|tokens| &tokens[..length])
                && reference.name.starts_with('$')
            {
                self.assign(at, &reference, Cursor::new(line.text, clause));
            }
        }
    }

    /// `BAS(#WHAT, number)`.
    pub fn bas(&mut self, mut cursor: Cursor<'a>) {
        let Some(at) = cursor.peek() else { return };
        if !cursor.pass('(') || !cursor.pass('#') {
            return;
        }
        let what = cursor.word().unwrap_or_default();
        let number = cursor.pass(',').then(|| cursor.number()).flatten();
        match what.as_str() {
            "BASE" => self.modal.base = self.numbered(at, FrameKind::Reference, number),
            "TOOL" => self.modal.tool = self.numbered(at, FrameKind::Tool, number),
            "VEL_CP" | "CP_PARAMS" => self.speed(at, number),
            "CP_DAT" => self.speed(at, self.path_speed),
            "EX_BASE" => {
                self.modal.base = Frame::Unknown;
                let sentence = "`BAS(#EX_BASE`: the frame is on another axis, which is not followed";
                self.messages.note(at.line, sentence);
            }
            _ => {}
        }
    }

    fn speed(&mut self, at: Token, given: Option<f64>) {
        self.modal.speed = match given {
            Some(speed) if speed > 0.0 => Speed::Tip(speed),
            _ => {
                let sentence = "the tip speed is not a number here: it is not known";
                self.messages.note(at.line, sentence);
                Speed::Unknown
            }
        };
    }

    /// The set of numbers at the cursor, or the one it names; a note if there is none.
    fn set(&mut self, at: Token, mut value: Cursor<'a>) -> Option<Aggregate> {
        if let Ok(set) = Aggregate::read(&mut value.clone()) {
            return Some(set);
        }
        let name = Reference::read(&mut value).map(|reference| reference.name)?;
        match self.names.find(&self.module, &name) {
            Some(PointValue::Given(set)) => Some(set.aggregate.clone()),
            _ if matches!(name.as_str(), "PDEFAULT" | "LDEFAULT") => None,
            _ => {
                let sentence = format!("`{name}` is not defined: its settings remain unchanged");
                self.messages.note(at.line, sentence);
                None
            }
        }
    }

    fn frames_of(&mut self, at: Token, set: &Aggregate) {
        if set.field("BASE_NO").is_some() {
            self.modal.base = self.numbered(at, FrameKind::Reference, set.number("BASE_NO"));
        }
        if set.field("TOOL_NO").is_some() {
            self.modal.tool = self.numbered(at, FrameKind::Tool, set.number("TOOL_NO"));
        }
        if let Some(Value::Flag(frame)) = set.field("IPO_FRAME") {
            self.modal.tool_is_stationary = frame == "TCP";
        }
    }

    /// The set named in `F(NAME.FIELD)` or `F(NAME)`.
    fn set_named_within(&self, mut value: Cursor<'a>) -> Option<Aggregate> {
        value.word()?;
        value.pass('(').then_some(())?;
        let name = Reference::read(&mut value)?.name;
        match self.names.find(&self.module, &name)? {
            PointValue::Given(set) => Some(set.aggregate.clone()),
            PointValue::Computed { .. } => None,
        }
    }

    /// The frame or tool with this number: its value in the program or a data file, otherwise its number.
    fn numbered(&mut self, at: Token, what: FrameKind, number: Option<f64>) -> Frame {
        let number = number.filter(|number| number.fract() == 0.0 && (0.0..=1e4).contains(number));
        let Some(number) = number.map(|number| number as u32) else {
            let sentence = format!("{} is not given as a number here", what.field());
            self.messages.note(at.line, sentence);
            return Frame::Unknown;
        };
        let name = format!("{}[{number}]", what.data());
        let given = match self.names.find(&self.module, &name) {
            Some(PointValue::Given(pose)) => pose.aggregate.numbers(POSE, None).ok(),
            _ => None,
        };
        match given.and_then(|numbers| Convention::Kuka.pose(&numbers).ok()) {
            Some(pose) => Frame::Given(pose),
            None if number == 0 => Frame::Given(Isometry::identity()),
            None => Frame::Numbered(number),
        }
    }

    /// The value assigned to `$BASE` or `$TOOL`.
    fn frame(&mut self, at: Token, what: FrameKind, mut value: Cursor<'a>, is_part: bool) -> Frame {
        let begin = value.place().start;
        let mut found = if is_part {
            None
        } else {
            self.frame_at(at, what, &mut value)
        };
        while let (Some(Frame::Given(one)), true) = (found, value.pass(':')) {
            found = match self.frame_at(at, what, &mut value) {
                Some(Frame::Given(other)) => Some(Frame::Given(one * other)),
                _ => None,
            };
        }
        match found.filter(|_| value.peek().is_none()) {
            Some(frame) => frame,
            None => {
                let text = shown(&value.text[begin..value.end]);
                let sentence =
                    format!("`{text}` is computed on the controller: poses relative to it are not known");
                self.messages.note(at.line, sentence);
                Frame::Unknown
            }
        }
    }

    /// One frame of an expression.
    fn frame_at(&mut self, at: Token, what: FrameKind, value: &mut Cursor<'a>) -> Option<Frame> {
        if value.peek().is_some_and(|token| token.is('{')) {
            let former = match what {
                FrameKind::Reference => self.modal.base,
                FrameKind::Tool => self.modal.tool,
            };
            let former = match former {
                Frame::Given(pose) => <[f64; 6]>::try_from(Convention::Kuka.numbers_of(&pose)).ok(),
                Frame::Numbered(_) | Frame::Unknown => None,
            };
            let aggregate = self.aggregate(value)?;
            let numbers = self.complete(&aggregate, POSE, former)?;
            return Convention::Kuka.pose(&numbers).ok().map(Frame::Given);
        }
        let call = value.clone();
        let reference = Reference::read(value)?;
        if reference.field.is_some() {
            return None;
        }
        if NULL_FRAMES.contains(&reference.name.as_str()) {
            return Some(Frame::Given(Isometry::identity()));
        }
        if let Some((name, number)) = reference.index()
            && name == what.data()
        {
            return Some(self.numbered(at, what, Some(f64::from(number))));
        }
        if value.pass('(') {
            let mut inner = value.clone();
            while value.next().is_some_and(|token| !token.is(')')) {}
            let number = match inner.number() {
                Some(number) => Some(number),
                None => self.set_named_within(call)?.number(what.field()),
            };
            return Some(self.numbered(at, what, number));
        }
        match self.names.find(&self.module, &reference.name)? {
            PointValue::Given(pose) => {
                let numbers = pose.aggregate.numbers(POSE, None).ok()?;
                Convention::Kuka.pose(&numbers).ok().map(Frame::Given)
            }
            PointValue::Computed { .. } => None,
        }
    }
}
