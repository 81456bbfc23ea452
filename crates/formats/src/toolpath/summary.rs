//! Summary of a program, counted while its steps are given.

use armill_core::path::{Course, Move, Step};

use super::format::Format;

/// Content of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    /// The format it is in.
    pub format: Format,
    /// Operations given.
    pub operations: u64,
    /// Moves given, those of cycles and holes included; the first gives the start position of the tip.
    pub moves: u64,
    /// Moves behind the first that cut.
    pub cuts: u64,
    /// Arcs among the moves.
    pub arcs: u64,
    /// Words that were not followed, and what was taken for granted: sentences with their counts and first lines.
    pub notes: Vec<String>,
}

impl Summary {
    /// Of a program of which no step was given yet.
    pub(super) fn new(format: Format) -> Summary {
        Summary {
            format,
            operations: 0,
            moves: 0,
            cuts: 0,
            arcs: 0,
            notes: Vec::new(),
        }
    }

    /// Of moves of a program in this format.
    pub fn of_moves<'a>(
        format: Format,
        moves: impl IntoIterator<Item = &'a Move>,
        notes: Vec<String>,
    ) -> Summary {
        let mut summary = Summary::new(format);
        for next in moves {
            summary.count(&Step::Move(*next));
        }
        summary.notes = notes;
        summary
    }

    /// Counts a step.
    ///
    /// An arc counts as an arc and as a move; the first move is not a cut, at any speed.
    pub(super) fn count(&mut self, step: &Step) {
        match step {
            Step::Operation(_) => self.operations += 1,
            Step::Command(_) => {}
            Step::Move(Move { course, pace, .. }) => {
                self.cuts += u64::from(self.moves > 0 && pace.cuts());
                self.moves += 1;
                self.arcs += u64::from(matches!(course, Course::Arc(_)));
            }
        }
    }
}
