//! Backlash of a joint between its motor and its link.

/// A joint that has moved by less than this since its last reversal is at standstill, rad (m): far above rounding and
/// the resolution of a controller, far below any relevant backlash.
pub const STANDSTILL: f64 = 1e-6;

/// Backlash of a joint: the link is anywhere within it, relative to the motor that the controller moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backlash {
    /// The whole backlash, from one side to the other, rad (m).
    pub gap: f64,
    /// Its standard uncertainty, same unit.
    pub standard_uncertainty: f64,
    /// What decides the side of the backlash.
    pub side: BacklashSide,
}

/// What decides on which side of the backlash a link is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BacklashSide {
    /// Friction: the link lags behind the motor, and changes sides where the joint reverses.
    Motion,
    /// The torque on the link, of load and gravity: the side changes with the sign of the torque; without any torque as
    /// with friction.
    Torque,
}
