//! Moves: their targets by components, by name, relative to the previous move, or composed of frames.

use armill_core::frame::Isometry;
use armill_core::path::Passage;
use armill_core::units::from_deg;
use armill_formats::convention::Convention;

use super::aggregate::{AXES, Aggregate, LocatedAggregate, POSE};
use super::points::{PointValue, Reference};
use super::state::{Former, Reader};
use crate::program::{Motion, RobotMove, Speed, Spelled, Target};
use crate::tokens::{Cursor, Kind, Token};

/// Target of a move.
pub(super) enum KrlTarget {
    Pose([f64; 6], Target),
    Axes([f64; 6]),
    /// A position that only the controller knows.
    PassedOver,
}

/// Hints for missing targets.
const HINT_POINT: &str = "give the .dat file that declares it together with the .src file";
const HINT_TARGET: &str = "a target is `{X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0}`, `{A1 0.0,...}` or a name";

impl<'a> Reader<'a> {
    /// The move that begins with this word; its targets are at the cursor.
    pub fn motion(&mut self, at: Token, word: &str, cursor: Cursor<'a>) {
        let before = self.modal.clone();
        self.with(&cursor);
        let with = cursor.tokens.iter().position(|token| {
            token.kind == Kind::Word && cursor.text[token.span()].eq_ignore_ascii_case("WITH")
        });
        let mut target = Cursor::new(cursor.text, &cursor.tokens[..with.unwrap_or(cursor.tokens.len())]);
        target.end = target.end.max(at.end);
        let made = match word {
            "CIRC" | "SCIRC" => self.circle(at, &mut target),
            _ if word.ends_with("_REL") => self.relative(at, word, &mut target),
            _ => self.straight(at, word, &mut target),
        };
        let passage = passage(target.clone(), self.modal.blend);
        if let Some((motion, goal)) = made
            && self.ends_here(target)
        {
            self.push(at, motion, goal, passage);
        }
        self.modal = before;
    }

    fn push(&mut self, at: Token, motion: Motion, goal: KrlTarget, passage: Passage) {
        let (target, former) = match goal {
            KrlTarget::Pose(numbers, target) => {
                (target, Former::Pose(numbers, self.modal.base, self.modal.tool))
            }
            KrlTarget::Axes(axes) => {
                let joints = axes.iter().map(from_deg).collect();
                (Target::Joints(joints), Former::Axes(axes))
            }
            KrlTarget::PassedOver => {
                self.former = None;
                return;
            }
        };
        if self.modal.tool_is_stationary && matches!(target, Target::Pose { .. }) {
            let message = "the tool is stationary here and the workpiece is on the flange (`#TCP`)";
            let hint = "only programs with the tool on the flange are supported: IPO_FRAME #BASE";
            self.messages.problem(at.span(), message, hint);
            return;
        }
        let speed = match motion {
            Motion::Joint => Speed::Joints,
            Motion::Linear | Motion::Circular { .. } => self.modal.speed,
        };
        self.former = Some(former);
        self.moves.push(RobotMove {
            motion,
            target,
            frame: self.modal.base,
            tool: self.modal.tool,
            speed,
            passage,
            line: at.line,
        });
    }

    fn straight(&mut self, at: Token, word: &str, cursor: &mut Cursor<'a>) -> Option<(Motion, KrlTarget)> {
        let goal = self.goal(at, cursor)?;
        let motion = match word {
            "PTP" | "SPTP" => Motion::Joint,
            _ => Motion::Linear,
        };
        if matches!((&motion, &goal), (Motion::Linear, KrlTarget::Axes(_))) {
            let message = format!("`{word}` goes to axes, but needs a pose");
            self.messages
                .problem(at.span(), message, "only PTP can go to axes");
            return None;
        }
        Some((motion, goal))
    }

    fn circle(&mut self, at: Token, cursor: &mut Cursor<'a>) -> Option<(Motion, KrlTarget)> {
        let via = self.goal(at, cursor)?;
        let place = cursor.place();
        if !cursor.pass(',') {
            let message = "a circle needs a via point and an end point";
            self.messages.problem(place, message, "write `CIRC {via},{end}`");
            return None;
        }
        let end = self.goal(at, cursor)?;
        if cursor.pass(',') {
            let message = "the circle continues after its end point (`CA`), to an unknown position";
            let hint = "write the end position without CA";
            self.messages.problem(at.span(), message, hint);
            return None;
        }
        match (via, end) {
            (KrlTarget::Pose(_, via), end @ KrlTarget::Pose(..)) => Some((Motion::Circular { via }, end)),
            _ => {
                let message = "a circle needs poses, not axes";
                self.messages.problem(at.span(), message, HINT_TARGET);
                None
            }
        }
    }

    /// The target at the cursor.
    fn goal(&mut self, at: Token, cursor: &mut Cursor<'a>) -> Option<KrlTarget> {
        let place = cursor.place();
        let named = match cursor.peek().map(|token| token.kind) {
            Some(Kind::Mark('{')) => self.aggregate(cursor)?,
            Some(Kind::Word) => match self.named(cursor)? {
                Some(named) => named,
                None => return Some(KrlTarget::PassedOver),
            },
            _ => {
                self.messages
                    .problem(place, "a target is missing here", HINT_TARGET);
                return None;
            }
        };
        if named.aggregate.moves_external_axes() {
            let sentence = "external axes (E1, ...) are kept unchanged and are not joints in armill";
            self.messages.note(at.line, sentence);
        }
        let (is_pose, is_axes) = (named.aggregate.has_any(&POSE), named.aggregate.has_any(&AXES));
        if is_pose == is_axes {
            let message = "neither a pose (X, Y, Z, A, B, C) nor axes (A1 to A6)";
            self.messages.problem(place, message, HINT_TARGET);
            return None;
        }
        if is_axes {
            let former = match &self.former {
                Some(Former::Axes(axes)) => Some(*axes),
                _ => None,
            };
            let axes = self.complete(&named, AXES, former)?;
            return Some(KrlTarget::Axes(axes));
        }
        let former = match &self.former {
            Some(Former::Pose(numbers, base, tool))
                if (*base, *tool) == (self.modal.base, self.modal.tool) =>
            {
                Some(*numbers)
            }
            _ => None,
        };
        let mut numbers = self.complete(&named, POSE, former)?;
        let mut is_composed = false;
        while cursor.pass(':') {
            let place = cursor.place();
            let other = match cursor.peek().map(|token| token.kind) {
                Some(Kind::Word) => self.named(cursor)?,
                _ => Some(self.aggregate(cursor)?),
            };
            let by = other.and_then(|other| self.complete(&other, POSE, None))?;
            let Some(product) = composed(&numbers, &by) else {
                self.too_large(place);
                return None;
            };
            (numbers, is_composed) = (product, true);
        }
        if !is_composed {
            let bytes = named.aggregate.bytes.clone();
            let here = self.messages.go_to(named.text);
            let goal = self.posed(numbers, &named.aggregate, bytes);
            self.messages.go_to(here);
            return goal;
        }
        self.posed(numbers, &Aggregate::default(), place.start..cursor.before())
    }

    /// A pose of these numbers with the other components of the aggregate, written at these bytes of the text.
    pub fn posed(
        &mut self,
        numbers: [f64; 6],
        aggregate: &Aggregate,
        bytes: std::ops::Range<usize>,
    ) -> Option<KrlTarget> {
        let Ok(pose) = Convention::Kuka.pose(&numbers) else {
            self.too_large(bytes);
            return None;
        };
        let target = Target::Pose {
            pose,
            branch: aggregate.configuration().pattern(),
            turns: aggregate.turns(),
            spelled: Spelled {
                text: self.messages.index(),
                bytes,
            },
        };
        Some(KrlTarget::Pose(numbers, target))
    }

    fn too_large(&mut self, place: std::ops::Range<usize>) {
        let message = "a component exceeds 1e9 mm or deg";
        self.messages.problem(place, message, HINT_TARGET);
    }

    /// The components with these names; missing ones are reported.
    pub fn complete(
        &mut self,
        given: &LocatedAggregate,
        names: [&'static str; 6],
        former: Option<[f64; 6]>,
    ) -> Option<[f64; 6]> {
        match given.aggregate.numbers(names, former) {
            Ok(numbers) => Some(numbers),
            Err(missing) => {
                let message =
                    format!("{missing} of this target is given neither here nor by the previous move");
                let hint = "a missing component keeps the value of the previous move, in the same frame with the same \
                    tool";
                let here = self.messages.go_to(given.text);
                self.messages
                    .problem(given.aggregate.bytes.clone(), message, hint);
                self.messages.go_to(here);
                None
            }
        }
    }

    /// The aggregate at the cursor; errors in it are reported.
    pub fn aggregate(&mut self, cursor: &mut Cursor<'a>) -> Option<LocatedAggregate> {
        let text = self.messages.index();
        match Aggregate::read(cursor) {
            Ok(aggregate) => Some(LocatedAggregate { aggregate, text }),
            Err(wrong) => {
                self.messages.problem(wrong.bytes, wrong.message, HINT_TARGET);
                None
            }
        }
    }

    /// The value of a name; `Some(None)` is a position that only the controller knows, and is noted.
    fn named(&mut self, cursor: &mut Cursor<'a>) -> Option<Option<LocatedAggregate>> {
        let token = cursor.peek()?;
        let reference = Reference::read(cursor)?;
        let name = reference.name;
        let mut wrong = |message: String, hint: &str| {
            self.messages.problem(token.span(), message, hint);
            None
        };
        if reference.field.is_some() || cursor.peek().is_some_and(|next| next.is('(')) {
            return wrong(
                format!("`{name}` is computed while the program runs"),
                HINT_TARGET,
            );
        }
        match self.names.find(&self.module, &name) {
            Some(PointValue::Given(given)) => Some(Some(given.clone())),
            Some(PointValue::Computed { line }) => wrong(
                format!("`{name}` is computed while the program runs, in line {line}"),
                "write its components as numbers, or give the .dat file with the taught point",
            ),
            None if name.starts_with('$') || name.starts_with("XHOME") => {
                let sentence =
                    format!("the move to `{name}` is left out: only the controller knows its position");
                self.messages.note(token.line, sentence);
                Some(None)
            }
            None => wrong(
                format!("`{name}` is not defined: no given file declares it"),
                HINT_POINT,
            ),
        }
    }

    /// Whether only blends follow a target.
    fn ends_here(&mut self, mut cursor: Cursor<'a>) -> bool {
        let place = cursor.place();
        while cursor.peek_word().is_some_and(|word| word.starts_with("C_")) {
            cursor.next();
            cursor.pass(',');
        }
        let ends = cursor.peek().is_none();
        if !ends {
            while cursor.next().is_some() {}
            let message = "the words after the target are not understood";
            let hint = "after a target, C_DIS, C_ORI, C_VEL, C_PTP, C_SPL or WITH can follow";
            self.messages.problem(place.start..cursor.end, message, hint);
        }
        ends
    }
}

/// How a move with these words after its target ends: an exact stop without any; with `C_DIS` at the distance of `$APO.CDIS` (m) from it.
fn passage(mut cursor: Cursor<'_>, distance: Option<f64>) -> Passage {
    let mut words = Vec::new();
    while let Some(word) = cursor.peek_word().filter(|word| word.starts_with("C_")) {
        words.push(word);
        cursor.next();
        cursor.pass(',');
    }
    match (
        words.is_empty(),
        words.iter().any(|word| word == "C_DIS"),
        distance,
    ) {
        (true, ..) => Passage::Stop,
        (_, true, Some(distance)) if distance > 0.0 => Passage::Zone(distance),
        _ => Passage::Unknown,
    }
}

/// The components of one pose in another.
pub(super) fn composed(one: &[f64; 6], other: &[f64; 6]) -> Option<[f64; 6]> {
    let pose = |numbers: &[f64; 6]| -> Option<Isometry> { Convention::Kuka.pose(numbers).ok() };
    let product = pose(one)? * pose(other)?;
    Convention::Kuka.numbers_of(&product).try_into().ok()
}
