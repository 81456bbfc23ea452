//! Effect of each error on the radius along the circle.
//!
//! With `a` the angle, `s` the direction (+1 anticlockwise, -1 clockwise), `(x, y) = R (cos a, sin a)` and small
//! errors:
//!
//! | term | effect on the radius | its value, m |
//! |---|---|---|
//! | radius | `1` | mean of both scales, `R (alpha + beta)/2` |
//! | offset along A, B | `cos a`, `sin a` | position of the circle |
//! | scale mismatch | `cos 2a` | `R (alpha - beta)/2`: A long, B short where positive |
//! | squareness | `-sin 2a` | `R sigma/2`: the angle between +A and +B is 90 deg + `sigma` |
//! | direction radius | `s/2` | radius anticlockwise minus clockwise |
//! | servo mismatch | `s sin 2a` | `v (tau_A - tau_B)/2`: A lags behind B where positive |
//! | reversal | see below | height of the step outwards, in the direction of motion |
//! | lobes | `cos n a`, `sin n a` | amplitude, n from 3 |
//! | cyclic | `cos a` or `sin a` times a wave over `x` or `y` | amplitude along the axis |
//!
//! A drive with the backlash `b` lags behind by half of it, so an axis that reverses at `a_k` leaves
//! `s/2 sign(sin(a - a_k)) cos(a - a_k)` of `b`: at `a_k` the radius steps outwards by `b`, on the other side of the
//! circle too. Each side is a separate step, since few axes have the same backlash on both:
//!
//! ```text
//! h/2 s sign(sin(a - a_k)) max(0, cos(a - a_k))
//! ```
//!
//! `alpha`, `beta`: scale errors of the axes; `v`: speed along the path; `tau`: lag of a drive.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::run::Direction;

/// First or second axis of the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// At 0 degrees.
    A,
    /// At 90 degrees.
    B,
}

/// Phase of a wave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wave {
    /// Even.
    Cosine,
    /// Odd.
    Sine,
}

/// A reversal of a drive along the circle: one backlash, with its steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Reversal {
    /// Its name in results.
    pub name: String,
    /// Every angle where it has an effect.
    pub steps: Vec<Step>,
}

/// One angle where a drive reverses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// rad
    pub angle: f64,
    /// Outward step of the radius there per unit of backlash, in the direction of motion: clockwise, anticlockwise.
    pub outwards: [f64; 2],
}

/// One unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Term {
    /// Mean radius.
    Radius,
    /// Position of the circle.
    Offset(Axis),
    /// Ellipse along the axes.
    ScaleMismatch,
    /// Ellipse between the axes.
    Squareness,
    /// Radius anticlockwise minus clockwise.
    DirectionRadius,
    /// Ellipse between the axes that turns with the direction.
    ServoMismatch,
    /// Backlash of a reversal, by its index in the list.
    Reversal(usize),
    /// This number of lobes, 3 or more.
    Lobes(usize, Wave),
    /// Error of an axis that repeats along it.
    Cyclic(Axis, Wave),
}

/// The reversals of two machine axes called `names`: each axis at both its ends.
pub fn of_axes(names: [&str; 2]) -> Vec<Reversal> {
    let ends = [
        (0, "+", 0.0),
        (0, "-", PI),
        (1, "+", FRAC_PI_2),
        (1, "-", PI + FRAC_PI_2),
    ];
    let reversal = |(axis, side, angle): (usize, &str, f64)| Reversal {
        name: format!("{}{side}", names[axis]),
        steps: vec![Step {
            angle,
            outwards: [1.0; 2],
        }],
    };
    ends.map(reversal).to_vec()
}

impl Step {
    /// Effect of the step of one unit, at an angle (rad) in a direction.
    pub fn at(&self, angle: f64, direction: Direction) -> f64 {
        let (sine, cosine) = (angle - self.angle).sin_cos();
        let side = if sine == 0.0 { 0.0 } else { sine.signum() };
        0.5 * self.outwards[direction.index()] * direction.sign() * side * cosine.max(0.0)
    }

    /// Whether an angle is that of the step, on neither side of it.
    pub fn is_at(&self, angle: f64) -> bool {
        let apart = (angle - self.angle).rem_euclid(TAU);
        apart.min(TAU - apart) < ON_STEP
    }
}

/// Nearer than this an angle is that of a step, rad.
pub(super) const ON_STEP: f64 = 1e-6;

impl Axis {
    /// Along the radius at an angle.
    fn radial(self, angle: f64) -> f64 {
        match self {
            Axis::A => angle.cos(),
            Axis::B => angle.sin(),
        }
    }
}

impl Term {
    /// Effect of one metre of this term on the radius at an angle; `turns` is the phase of a cyclic error at the end of
    /// an axis: `2 pi R` over its period.
    pub fn at(&self, angle: f64, direction: Direction, reversals: &[Reversal], turns: f64) -> f64 {
        let sign = direction.sign();
        match self {
            Term::Radius => 1.0,
            Term::Offset(axis) => axis.radial(angle),
            Term::ScaleMismatch => (2.0 * angle).cos(),
            Term::Squareness => -(2.0 * angle).sin(),
            Term::DirectionRadius => 0.5 * sign,
            Term::ServoMismatch => sign * (2.0 * angle).sin(),
            Term::Reversal(index) => {
                let steps = reversals.get(*index).map_or(&[][..], |reversal| &reversal.steps);
                steps.iter().map(|step| step.at(angle, direction)).sum()
            }
            Term::Lobes(order, wave) => wave.at(*order as f64 * angle),
            Term::Cyclic(axis, wave) => axis.radial(angle) * wave.at(turns * axis.radial(angle)),
        }
    }
}

impl Wave {
    fn at(self, phase: f64) -> f64 {
        match self {
            Wave::Cosine => phase.cos(),
            Wave::Sine => phase.sin(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const R: f64 = 0.1;

    /// Radius of a machine on the circle: `act` turns the commanded position into the actual one.
    fn radial(angle: f64, act: impl Fn(f64, f64) -> (f64, f64)) -> f64 {
        let (x, y) = act(R * angle.cos(), R * angle.sin());
        x.hypot(y) - R
    }

    fn at(term: Term, angle: f64, direction: Direction) -> f64 {
        term.at(angle, direction, &of_axes(["X", "Y"]), TAU * R / 0.01)
    }

    /// Compared with the geometry itself; the difference is the square of the error over the radius.
    fn same(term: Term, value: f64, act: impl Fn(f64, f64, f64) -> (f64, f64)) {
        for direction in Direction::BOTH {
            for deg in 0..360 {
                let a = f64::from(deg).to_radians() + 0.003;
                let expected = radial(a, |x, y| act(x, y, direction.sign()));
                let given = value * at(term, a, direction);
                assert!(
                    (given - expected).abs() < 1e-9,
                    "{term:?} {deg}: {given} {expected}"
                );
            }
        }
    }

    #[test]
    fn scale_and_squareness_are_those_of_axes_with_length_and_angle_errors() {
        same(Term::Radius, R * 50e-6, |x, y, _| {
            (x * (1.0 + 50e-6), y * (1.0 + 50e-6))
        });
        same(Term::ScaleMismatch, R * 30e-6, |x, y, _| {
            (x * (1.0 + 30e-6), y * (1.0 - 30e-6))
        });
        // +B leans away from +A: the angle between them is larger than 90 degrees.
        same(Term::Squareness, R * 80e-6 / 2.0, |x, y, _| (x - 80e-6 * y, y));
    }

    #[test]
    fn a_drive_with_lag_makes_an_ellipse_that_depends_on_the_direction() {
        // At 100 mm/s A is 40 us late.
        let (v, late) = (0.1, 40e-6);
        same(Term::ServoMismatch, v * late / 2.0, |x, y, sign| {
            let a = y.atan2(x) - sign * v / R * late;
            (R * a.cos(), y)
        });
    }

    #[test]
    fn an_axis_with_backlash_lags_behind_by_half_of_it_in_both_directions() {
        let gap = 10e-6;
        for (axis, ends) in [(Axis::A, [0, 1]), (Axis::B, [2, 3])] {
            for direction in Direction::BOTH {
                for deg in 0..360 {
                    let a = f64::from(deg).to_radians() + 0.003;
                    let speed = match axis {
                        Axis::A => -direction.sign() * a.sin(),
                        Axis::B => direction.sign() * a.cos(),
                    };
                    let behind = -0.5 * gap * speed.signum();
                    let expected = radial(a, |x, y| match axis {
                        Axis::A => (x + behind, y),
                        Axis::B => (x, y + behind),
                    });
                    let given: f64 = ends
                        .map(|end| gap * at(Term::Reversal(end), a, direction))
                        .iter()
                        .sum();
                    assert!((given - expected).abs() < 1e-9, "{axis:?} {direction:?} {deg}");
                }
            }
        }
    }

    #[test]
    fn the_radius_steps_outwards_by_the_backlash_in_either_direction() {
        for (end, angle) in [0.0, PI, FRAC_PI_2, -FRAC_PI_2].into_iter().enumerate() {
            for direction in Direction::BOTH {
                let radius_at = |side: f64| {
                    at(
                        Term::Reversal(end),
                        angle + side * direction.sign() * 1e-7,
                        direction,
                    )
                };
                assert!((radius_at(1.0) - radius_at(-1.0) - 1.0).abs() < 1e-6);
            }
        }
        let across = Step {
            angle: 0.0,
            outwards: [1.0; 2],
        };
        assert!(across.is_at(TAU) && across.is_at(-1e-9) && !across.is_at(1e-4));
    }

    #[test]
    fn a_cyclic_error_moves_its_axis_by_a_wave_over_its_position() {
        let wave = |x: f64| 2e-6 * (TAU * x / 0.01).cos();
        same(Term::Cyclic(Axis::A, Wave::Cosine), 2e-6, |x, y, _| {
            (x + wave(x), y)
        });
        same(Term::Cyclic(Axis::B, Wave::Cosine), 2e-6, |x, y, _| {
            (x, y + wave(y))
        });
    }
}
