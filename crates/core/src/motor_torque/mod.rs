//! Torque of the motor of a driven joint against its motion: friction, load, inertia.
//!
//! ```text
//! tau(t) = f s(t) + n v(t) + J a(t) + sum_k w_k g_k(q(t)) + o
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `tau` | torque of the motor, positive where it drives the joint forward | N m |
//! | `s`, `v`, `a` | direction (-1, 1), speed and acceleration of the joint | 1, rad/s, rad/s^2 |
//! | `f`, `n` | Coulomb friction; viscous friction | N m; N m s/rad |
//! | `J` | inertia: torque of the motor per acceleration of the joint | kg m^2 (joint inertia over the ratio, plus rotor inertia times the ratio) |
//! | `g_k`, `w_k` | functions of the positions that describe the load; their coefficients | see [`load`] |
//! | `o` | constant part: friction that differs between the directions, or an offset of the measured torque | N m |
//!
//! `v` and `a` are those of a parabola through the positions within 20 ms before and after each instant (at least three samples). Instants at rest are left out: there friction
//! has any value up to `f`. The estimation is linear, with the covariance of residuals that are correlated in time, as of the [torsion](crate::torsion).
//!
//! Terms that a log does not determine are left out, in this order: the constant part, then the loads from the last. A term is not determined if other terms describe it, or if its coefficient has a
//! correlation above 0.95 with that of a term before it. The friction, the inertia and the first load are always used; pairs of them with such a correlation are named. The values of the friction are those of the temperature and
//! lubrication of the log.
//!
//! Not modelled: friction that falls with the speed (Stribeck) or depends on the load; torques that couple the joints (Coriolis, inertia of other joints). Valid for rotary joints.
//! Source: Swevers, Verdonck, De Schutter, "Dynamic model identification for industrial robots", IEEE Control Systems Magazine 27 (2007) 58-71.
//!
//! [`load`]: functions of the positions. [`fit`](mod@fit): the estimation.

pub mod fit;
pub mod load;

pub use fit::{LoadEstimate, MotorSignals, MotorTorque, fit};
pub use load::{LoadTerm, LoadUnit};
