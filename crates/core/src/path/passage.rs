//! How the tip passes the end of a move: with a stop, or through a zone in which it may leave the programmed path.

/// How the tip passes the end of a move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Passage {
    /// The program does not say.
    #[default]
    Unknown,
    /// It stops there.
    Stop,
    /// It leaves the programmed path at this distance before the end, and returns to it at this distance after it, m.
    Zone(f64),
    /// It leaves the programmed path no farther than `error` at the corner, in a zone of at most `most`, m.
    Within {
        /// Distance from the corner, m.
        error: f64,
        /// Largest radius of the zone, m.
        most: f64,
    },
}

/// The end of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoveEnd {
    /// Index of the point of the path there.
    pub point: usize,
    /// How the tip passes it.
    pub passage: Passage,
}
