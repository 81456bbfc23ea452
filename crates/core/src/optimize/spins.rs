//! The spins of the tool that a search tries at each point.

/// Spins of the tool about its axis, in addition to that of the placing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spins {
    /// The first, rad.
    pub first: f64,
    /// Step, rad; above zero.
    pub step: f64,
    /// Number of spins, at least one.
    pub count: usize,
}

impl Spins {
    /// Spin number `index`, rad.
    pub fn at(&self, index: usize) -> f64 {
        self.first + self.step * index as f64
    }
}
