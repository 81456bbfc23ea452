//! How much play a joint has between its motor and its link.

/// A joint that has moved by less than this since it last turned back has not moved, rad (m): far above rounding and what a
/// controller tells apart, far below any gap that matters.
pub const STANDSTILL: f64 = 1e-6;

/// Backlash of a joint: the link lies anywhere within a gap, seen from the motor that the controller moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backlash {
    /// The whole gap, from one flank to the other, rad (m).
    pub gap: f64,
    /// Its standard uncertainty, same unit.
    pub standard_uncertainty: f64,
    /// What decides on which flank the link lies.
    pub side: BacklashSide,
}

/// What decides on which flank of its gap a link lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BacklashSide {
    /// Friction: the link lags behind the motor, and changes its flank where the joint turns back.
    Motion,
    /// The torque on the link, of load and gravity: the flank changes where the torque does; without any torque as friction
    /// has it.
    Torque,
}
