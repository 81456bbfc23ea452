//! Moves relative to the end of the previous move.

use super::aggregate::{AXES, Aggregate, POSE};
use super::motion::{KrlTarget, composed};
use super::state::{Former, Reader};
use crate::program::Motion;
use crate::tokens::{Cursor, Token};

impl<'a> Reader<'a> {
    /// A move relative to the end of the previous move: in the frame or, after `#TOOL`, in the tool.
    pub fn relative(
        &mut self,
        at: Token,
        word: &str,
        cursor: &mut Cursor<'a>,
    ) -> Option<(Motion, KrlTarget)> {
        let aggregate = self.aggregate(cursor)?.aggregate;
        let in_tool = cursor.pass('#') && cursor.word().is_some_and(|word| word == "TOOL");
        let span = at.start..cursor.before();
        let motion = match word.starts_with("PTP") || word.starts_with("SPTP") {
            true => Motion::Joint,
            false => Motion::Linear,
        };
        let axes = aggregate.has_any(&AXES);
        let by = aggregate.numbers(if axes { AXES } else { POSE }, Some([0.0; 6]));
        let turns = !axes
            && !in_tool
            && ["A", "B", "C"]
                .iter()
                .any(|name| aggregate.number(name).is_some_and(|by| by != 0.0));
        let goal = match (self.former.clone(), by) {
            (Some(Former::Axes(former)), Ok(by)) if axes && motion == Motion::Joint => {
                Some(KrlTarget::Axes(std::array::from_fn(|axis| {
                    former[axis] + by[axis]
                })))
            }
            (Some(Former::Pose(former, base, tool)), Ok(by))
                if !axes && !turns && (base, tool) == (self.modal.base, self.modal.tool) =>
            {
                let numbers = match in_tool {
                    false => Some(std::array::from_fn(|index| former[index] + by[index])),
                    true => composed(&former, &by),
                };
                numbers.and_then(|numbers| self.posed(numbers, &Aggregate::default(), span))
            }
            _ => None,
        };
        if goal.is_none() {
            let message = format!("the target of `{word}` is not known");
            let hint = "it must follow a move to a pose with the same frame and tool (to axes for axes), and can \
                rotate only in #TOOL";
            self.messages.problem(at.span(), message, hint);
        }
        goal.map(|goal| (motion, goal))
    }
}
