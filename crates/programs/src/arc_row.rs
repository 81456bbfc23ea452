//! Arcs given as a row of moves to one point each: straight to the first point, then through the second to the third.
//!
//! A fourth point in a row is ambiguous: controllers differ in which three points form the next arc.

use std::ops::Range;

/// The points of a row in order.
#[derive(Debug)]
pub(super) struct ArcRow<P> {
    /// First point of the row; `None` outside a row.
    begin: Option<Range<usize>>,
    via: Option<P>,
    state: State,
}

#[derive(Debug, PartialEq)]
enum State {
    /// More points are needed.
    Open,
    /// An arc is complete; another may begin at its end.
    Between,
    /// An arc is complete.
    Closed,
}

/// Meaning of the next point of a row.
#[derive(Debug, PartialEq)]
pub(super) enum Next<P> {
    /// The first: the tip moves straight to it.
    Straight(P),
    /// The second: no move yet.
    Waits,
    /// The third: an arc.
    Arc {
        /// Via point.
        via: P,
        /// End point.
        end: P,
    },
    /// A fourth.
    Uncertain,
}

/// Whether the program marks the end of an arc, so that the next arc begins there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ArcEnd {
    /// Marked.
    Marked,
    /// Not marked.
    Unmarked,
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
    /// Adds a point, given at these bytes.
    pub fn next(&mut self, point: P, end: ArcEnd, span: Range<usize>) -> Next<P> {
        if self.begin.is_none() {
            self.begin = Some(span);
            return Next::Straight(point);
        }
        match (self.via.take(), &self.state) {
            (Some(via), _) => {
                self.state = match end {
                    ArcEnd::Marked => State::Between,
                    ArcEnd::Unmarked => State::Closed,
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

    /// Ends the row. Returns its position if points are missing.
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
    fn three_points_make_an_arc_and_two_more_make_another_if_its_end_is_marked() {
        let mut row = ArcRow::default();
        let mut next = |point: u32, end| row.next(point, end, 0..1);
        assert_eq!(next(1, ArcEnd::Unmarked), Next::Straight(1));
        assert_eq!(next(2, ArcEnd::Unmarked), Next::Waits);
        assert_eq!(next(3, ArcEnd::Marked), Next::Arc { via: 2, end: 3 });
        assert_eq!(next(4, ArcEnd::Unmarked), Next::Waits);
        assert_eq!(next(5, ArcEnd::Unmarked), Next::Arc { via: 4, end: 5 });
        assert_eq!(next(6, ArcEnd::Unmarked), Next::Uncertain);
        assert_eq!(row.end(), None);
        assert_eq!(row.end(), None);
    }

    #[test]
    fn reports_a_row_with_fewer_than_three_points() {
        for points in [1, 2] {
            let mut row = ArcRow::default();
            for point in 0..points {
                row.next(point, ArcEnd::Unmarked, 7..9);
            }
            assert_eq!(row.end(), Some(7..9));
        }
    }
}
