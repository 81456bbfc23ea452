//! Torsion of a driven joint, from its motor encoder, its link encoder and the torque of its motor.
//!
//! ```text
//! l(t) = m(t - d) + o - c tau(t - d) + h s(t - d) + sum_k (a_k cos k u m + b_k sin k u m)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `l`, `m` | link encoder; motor encoder, reduced to the joint | rad |
//! | `d` | delay of the link encoder behind the motor encoder | s |
//! | `o` | offset of the zeros | rad |
//! | `tau` | torque of the motor, positive where it drives the joint forward | N m |
//! | `c` | compliance: torsion per torque of the motor | rad/(N m) |
//! | `s` | direction of the last motion, -1 or 1; 0 before the first | |
//! | `h` | half of the step of the torsion at a reversal | rad |
//! | `u`, `k` | gear ratio; order of the motor shaft | |
//!
//! With the friction `f` between motor and gear and the lost motion `b` of the gear, `h = c f - b/2`: a log gives their difference, never
//! both. A positive `h` is friction of at least `h/c`; a negative one is lost motion of at least `-2 h`. Viscous friction `n` there (N m s/rad of the joint)
//! shortens the delay that is found by `c n`. The torque of the motor is that
//! of the joint divided by the ratio, so that the stiffness at the joint is `u/c`. The torque `J u a` that accelerates the rotor (inertia `J`, kg m^2; acceleration `a` of the
//! joint, rad/s^2) does not pass the gear: [`without_rotor`] removes it.
//!
//! Estimation: the delay by Gauss and Newton (its derivative is the speed of the motor), all others linear. The
//! torque is noisy, which would attenuate `c`: its instrument is the mean of the torque some samples earlier and later, whose noise is independent.
//! Residuals are correlated in time: the covariance of independent residuals is multiplied by the number of samples that are as good as one,
//! `1 + 2 sum r_k` up to the first autocorrelation `r_k` that is not positive. This is too large where a signal changes fast; where residuals are
//! errors of the model rather than noise it is an approximation (docs/theory/torsion.md, checks).
//!
//! Valid for rotary joints with both encoders in one clock, delays up to [`MOST_DELAY`], torsions that are linear in the torque.
//! Sources: Söderström, Stoica, "Instrumental Variable Methods for System Identification" (1983), for the instrument; Sokal, "Monte Carlo Methods in
//! Statistical Mechanics" (1997), for the integrated autocorrelation.
//!
//! [`signals`]: signals and their values between samples. `linear`: estimation with instruments. [`fit`](mod@fit): the model.

pub mod fit;
pub(crate) mod linear;
pub mod signals;

pub(crate) use fit::INSEPARABLE;
pub use fit::{Estimate, Harmonic, MOST_DELAY, Torsion, fit};
pub use signals::{Signals, without_rotor};
