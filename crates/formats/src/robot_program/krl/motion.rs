//! Moves: where they end, by components, by name, relative to the move before, or composed of frames.

use super::aggregate::{AXES, Aggregate, POSE};
use super::points::{Known, Reference};
use super::read::Reader;
use super::relative::composed;
use crate::convention::Convention;
use crate::robot_program::program::{Frame, Motion, RobotMove, Speed, Spelled, Target};
use crate::robot_program::tokens::{Cursor, Kind, Token};

/// Where a move ended: what is left out of the next target.
#[derive(Clone, Debug)]
pub(super) enum Former {
    /// Components of a pose, and what they count in.
    Pose([f64; 6], Frame, Frame),
    /// Axes, deg.
    Axes([f64; 6]),
}

/// Where a move goes to.
pub(super) enum Goal {
    Pose([f64; 6], Target),
    Axes([f64; 6]),
    /// A place that only the controller knows.
    PassedOver,
}

/// A target as it stands in a line, or as the line names it.
struct Named {
    aggregate: Aggregate,
    text: usize,
}

/// What is said of targets that cannot be found.
const HINT_POINT: &str = "give the .dat that declares it beside the .src";
const HINT_TARGET: &str = "a target is `{X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0}`, `{A1 0.0,...}` or a name";

impl<'a> Reader<'a> {
    /// The move that this word begins; its targets stand at the cursor.
    pub fn motion(&mut self, (at, word): (Token, &str), cursor: Cursor<'a>) {
        let before = self.modal.clone();
        self.with(&cursor);
        let with = cursor.tokens.iter().position(|token| {
            token.kind == Kind::Word && cursor.text[token.span()].eq_ignore_ascii_case("WITH")
        });
        let mut target = Cursor::new(cursor.text, &cursor.tokens[..with.unwrap_or(cursor.tokens.len())]);
        target.end = target.end.max(at.end);
        let made = match word {
            "CIRC" | "SCIRC" => self.circle(at, &mut target),
            _ if word.ends_with("_REL") => self.relative((at, word), &mut target),
            _ => self.straight((at, word), &mut target),
        };
        if let Some((motion, goal)) = made
            && self.ends_here(target)
        {
            self.push(at, motion, goal);
        }
        self.modal = before;
    }

    fn push(&mut self, at: Token, motion: Motion, goal: Goal) {
        let (target, former) = match goal {
            Goal::Pose(numbers, target) => (target, Former::Pose(numbers, self.modal.base, self.modal.tool)),
            Goal::Axes(axes) => {
                let joints = axes.iter().map(|deg| deg.to_radians()).collect();
                (Target::Joints(joints), Former::Axes(axes))
            }
            Goal::PassedOver => {
                self.former = None;
                return;
            }
        };
        if self.modal.tool_stands && matches!(target, Target::Pose { .. }) {
            let message = "the tool stands still here and the workpiece is on the flange (`#TCP`)".to_owned();
            let hint = "only programs whose tool is on the flange are read: IPO_FRAME #BASE";
            self.given.problem(self.here(), at.span(), message, hint);
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
            line: at.line,
        });
    }

    fn straight(&mut self, (at, word): (Token, &str), cursor: &mut Cursor<'a>) -> Option<(Motion, Goal)> {
        let goal = self.goal(at, cursor)?;
        let motion = match word {
            "PTP" | "SPTP" => Motion::Joint,
            _ => Motion::Linear,
        };
        if matches!((&motion, &goal), (Motion::Linear, Goal::Axes(_))) {
            let message = format!("`{word}` goes to axes, where a pose is wanted");
            self.given
                .problem(self.here(), at.span(), message, "only PTP goes to axes");
            return None;
        }
        Some((motion, goal))
    }

    fn circle(&mut self, at: Token, cursor: &mut Cursor<'a>) -> Option<(Motion, Goal)> {
        let via = self.goal(at, cursor)?;
        let place = cursor.place();
        if !cursor.pass(',') {
            let message = "a circle needs a point on its way and its end".to_owned();
            self.given
                .problem(self.here(), place, message, "`CIRC {via},{end}`");
            return None;
        }
        let end = self.goal(at, cursor)?;
        if cursor.pass(',') {
            let message = "the circle goes on behind its end (`CA`), to a place that is not told".to_owned();
            let hint = "write the place where it ends, without CA";
            self.given.problem(self.here(), at.span(), message, hint);
            return None;
        }
        match (via, end) {
            (Goal::Pose(_, via), end @ Goal::Pose(..)) => Some((Motion::Circular { via }, end)),
            _ => {
                let message = "a circle goes through poses, not axes".to_owned();
                self.given.problem(self.here(), at.span(), message, HINT_TARGET);
                None
            }
        }
    }

    /// The target that stands at the cursor.
    fn goal(&mut self, at: Token, cursor: &mut Cursor<'a>) -> Option<Goal> {
        let place = cursor.place();
        let named = match cursor.peek().map(|token| token.kind) {
            Some(Kind::Mark('{')) => Named {
                aggregate: self.aggregate(cursor)?,
                text: self.text,
            },
            Some(Kind::Word) => match self.named(cursor)? {
                Some(named) => named,
                None => return Some(Goal::PassedOver),
            },
            _ => {
                let message = "a target is missing here".to_owned();
                self.given.problem(self.here(), place, message, HINT_TARGET);
                return None;
            }
        };
        if named.aggregate.moves_external_axes() {
            self.note(
                at,
                "external axes (E1, ...) stay as they are and are no joints here".to_owned(),
            );
        }
        let (is_pose, is_axes) = (named.aggregate.has_any(&POSE), named.aggregate.has_any(&AXES));
        if is_pose == is_axes {
            let message = "neither a pose (X, Y, Z, A, B, C) nor axes (A1 to A6)".to_owned();
            self.given.problem(self.here(), place, message, HINT_TARGET);
            return None;
        }
        if is_axes {
            let former = match &self.former {
                Some(Former::Axes(axes)) => Some(*axes),
                _ => None,
            };
            let axes = self.complete((&named.aggregate, named.text), AXES, former)?;
            return Some(Goal::Axes(axes));
        }
        let former = match &self.former {
            Some(Former::Pose(numbers, base, tool))
                if (*base, *tool) == (self.modal.base, self.modal.tool) =>
            {
                Some(*numbers)
            }
            _ => None,
        };
        let mut numbers = self.complete((&named.aggregate, named.text), POSE, former)?;
        let mut is_composed = false;
        while cursor.pass(':') {
            let place = cursor.place();
            let other = match cursor.peek().map(|token| token.kind) {
                Some(Kind::Word) => self.named(cursor)?,
                _ => Some(Named {
                    aggregate: self.aggregate(cursor)?,
                    text: self.text,
                }),
            };
            let by = other.and_then(|other| self.complete((&other.aggregate, other.text), POSE, None))?;
            let Some(product) = composed(&numbers, &by) else {
                self.too_large(place);
                return None;
            };
            (numbers, is_composed) = (product, true);
        }
        if !is_composed {
            let bytes = named.aggregate.bytes.clone();
            let text = std::mem::replace(&mut self.text, named.text);
            let goal = self.posed(numbers, &named.aggregate, bytes);
            self.text = text;
            return goal;
        }
        self.posed(numbers, &Aggregate::default(), place.start..cursor.before())
    }

    /// A pose of these numbers with what the aggregate says beside, spelled at these bytes of the text that is read.
    pub fn posed(
        &mut self,
        numbers: [f64; 6],
        beside: &Aggregate,
        bytes: std::ops::Range<usize>,
    ) -> Option<Goal> {
        let Ok(pose) = Convention::Kuka.pose(&numbers) else {
            self.too_large(bytes);
            return None;
        };
        let target = Target::Pose {
            pose,
            branch: beside.configuration().pattern(),
            turns: beside.turns(),
            spelled: Spelled {
                text: self.text,
                bytes,
            },
        };
        Some(Goal::Pose(numbers, target))
    }

    fn too_large(&mut self, place: std::ops::Range<usize>) {
        let message = "a component beyond 1e9 mm or deg is no pose".to_owned();
        self.given.problem(self.here(), place, message, HINT_TARGET);
    }

    /// The components of these names; those that are missing are told.
    pub fn complete(
        &mut self,
        (aggregate, text): (&Aggregate, usize),
        names: [&'static str; 6],
        former: Option<[f64; 6]>,
    ) -> Option<[f64; 6]> {
        match aggregate.numbers(names, former) {
            Ok(numbers) => Some(numbers),
            Err(missing) => {
                let message = format!("{missing} of this target is not told, nor by the move before");
                let hint = "a component left out keeps the value of the move before, in the same frame with the same tool";
                let text = &self.texts[text];
                self.given.problem(text, aggregate.bytes.clone(), message, hint);
                None
            }
        }
    }

    /// The aggregate that stands at the cursor; what is broken in it is told.
    pub fn aggregate(&mut self, cursor: &mut Cursor<'a>) -> Option<Aggregate> {
        let read = Aggregate::read(cursor);
        read.map_err(|wrong| {
            self.given
                .problem(self.here(), wrong.bytes, wrong.message, HINT_TARGET);
        })
        .ok()
    }

    /// What a name stands for; `Some(None)` is a place that only the controller knows, and was noted.
    fn named(&mut self, cursor: &mut Cursor<'a>) -> Option<Option<Named>> {
        let token = cursor.peek()?;
        let reference = Reference::read(cursor)?;
        let name = reference.name;
        let mut wrong = |message: String, hint: &str| {
            self.given
                .problem(&self.texts[self.text], token.span(), message, hint);
            None
        };
        if reference.field.is_some() || cursor.peek().is_some_and(|next| next.is('(')) {
            return wrong(
                format!("`{name}` is computed while the program runs"),
                HINT_TARGET,
            );
        }
        match self.names.find(&self.module, &name) {
            Some(Known::Told { aggregate, text }) => Some(Some(Named {
                aggregate: aggregate.clone(),
                text: *text,
            })),
            Some(Known::Computed { line }) => wrong(
                format!("`{name}` is computed while the program runs, in line {line}"),
                "write its components as numbers, or give the .dat with the point as it was taught",
            ),
            None if name.starts_with('$') || name.starts_with("XHOME") => {
                let sentence =
                    format!("the move to `{name}` is left out: only the controller knows where it lies");
                self.note(token, sentence);
                Some(None)
            }
            None => wrong(
                format!("`{name}` is not told: no file given declares it"),
                HINT_POINT,
            ),
        }
    }

    /// Whether nothing but blends follows a target.
    fn ends_here(&mut self, mut cursor: Cursor<'a>) -> bool {
        let place = cursor.place();
        while cursor.peek_word().is_some_and(|word| word.starts_with("C_")) {
            cursor.next();
            cursor.pass(',');
        }
        let ends = cursor.peek().is_none();
        if !ends {
            while cursor.next().is_some() {}
            let message = "what stands behind the target is not understood".to_owned();
            let hint = "behind a target stand C_DIS, C_ORI, C_VEL, C_PTP, C_SPL or WITH";
            self.given
                .problem(self.here(), place.start..cursor.end, message, hint);
        }
        ends
    }
}
