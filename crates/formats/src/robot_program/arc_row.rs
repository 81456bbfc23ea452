//! Arcs told as a row of moves, each to one point: straight to the first, then through the second to the third.
//!
//! A fourth point in a row is not certain: controllers differ in which three make the next arc.

use std::ops::Range;

/// The points of a row as they come.
#[derive(Debug)]
pub(super) struct ArcRow<P> {
    /// Where the row began; nothing outside of one.
    begin: Option<Range<usize>>,
    via: Option<P>,
    state: State,
}

#[derive(Debug, PartialEq)]
enum State {
    /// Points are missing.
    Open,
    /// An arc is done, and another may begin at its end.
    Between,
    /// An arc is done.
    Closed,
}

/// What one more point of a row means.
#[derive(Debug, PartialEq)]
pub(super) enum Next<P> {
    /// The first: the tip goes straight there.
    Straight(P),
    /// The second: nothing moves yet.
    Waits,
    /// The third: an arc.
    Arc {
        /// Through this.
        via: P,
        /// To this.
        end: P,
    },
    /// A fourth.
    Uncertain,
}

/// Whether the arc that ends at a point is told to end there, so that the next one begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ArcEnd {
    /// It is told.
    Told,
    /// It is not.
    EvaluateError,
}

impl<P> Default for ArcRow<P> {
    fn default() -> ArcRow<P> {
        ArcRow {
            begin: None,
            via: None,
            state: State::Open,
        }
    }
}

impl<P> ArcRow<P> {
    /// One more point, told at these bytes.
    pub fn next(&mut self, point: P, end: ArcEnd, span: Range<usize>) -> Next<P> {
        if self.begin.is_none() {
            self.begin = Some(span);
            return Next::Straight(point);
        }
        match (self.via.take(), &self.state) {
            (Some(via), _) => {
                self.state = match end {
                    ArcEnd::Told => State::Between,
                    ArcEnd::EvaluateError => State::Closed,
                };
                self.begin = Some(span);
                Next::Arc { via, end: point }
            }
            (None, State::Closed) => Next::Uncertain,
            (None, _) => {
                self.via = Some(point);
                Next::Waits
            }
        }
    }

    /// The row is over: where it stands, if points are missing.
    pub fn end(&mut self) -> Option<Range<usize>> {
        let row = std::mem::take(self);
        row.begin
            .filter(|_| row.via.is_some() || row.state == State::Open)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_points_make_an_arc_and_two_more_another_where_the_first_is_told_to_end() {
        let mut row = ArcRow::default();
        let mut next = |point: u32, end| row.next(point, end, 0..1);
        assert_eq!(next(1, ArcEnd::EvaluateError), Next::Straight(1));
        assert_eq!(next(2, ArcEnd::EvaluateError), Next::Waits);
        assert_eq!(next(3, ArcEnd::Told), Next::Arc { via: 2, end: 3 });
        assert_eq!(next(4, ArcEnd::EvaluateError), Next::Waits);
        assert_eq!(next(5, ArcEnd::EvaluateError), Next::Arc { via: 4, end: 5 });
        assert_eq!(next(6, ArcEnd::EvaluateError), Next::Uncertain);
        assert_eq!(row.end(), None);
        assert_eq!(row.end(), None);
    }

    #[test]
    fn a_row_without_three_points_is_told() {
        for points in [1, 2] {
            let mut row = ArcRow::default();
            for point in 0..points {
                row.next(point, ArcEnd::EvaluateError, 7..9);
            }
            assert_eq!(row.end(), Some(7..9));
        }
    }
}
