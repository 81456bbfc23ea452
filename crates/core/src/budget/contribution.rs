//! One part of the error: its bias, a signed function of the angle, and its scatter; and the sums of several.
//!
//! ```text
//! as functions     max over a of |sum of b_i(a)|             with known signs and angles
//!   with scatter   max over a of |sum of b_i(a)| + 2 s(a)    s^2 = sum of s_i^2: covers 95 of 100 cuts
//! plain            sum over origins of max |b_o|             as if all had their worst angle and sign together
//! squares          root of the sum of (max |b_o|)^2          as if angles and signs were unknown
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `b_i`, `s_i` | bias and standard deviation of a contribution | m |
//! | `b_o` | the biases of one origin together: of the load, of the unloaded path | m |
//!
//! The plain sum is that of the paper on which this work is based: 60 um of the load and 140 um of the unloaded path
//! are 200 um.

use super::turn::largest;

/// Origin of a contribution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The load on the tool: predicted.
    Load,
    /// The path without load: measured, or predicted where it was not.
    Unloaded,
}

impl Origin {
    /// Both, in the order of the results.
    pub const BOTH: [Origin; 2] = [Origin::Load, Origin::Unloaded];
}

/// One part of the error at the angles of a turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Contribution {
    /// Its name.
    pub name: String,
    /// Its origin.
    pub origin: Origin,
    /// Signed, outwards positive, m.
    pub bias: Vec<f64>,
    /// Standard deviation of one cut about the bias, m.
    pub scatter: Vec<f64>,
    /// Standard uncertainty of the bias itself, root mean square round the circle, where it is known, m.
    pub u: Option<f64>,
}

/// Sums of contributions.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    /// Sum of the biases, m.
    pub bias: Vec<f64>,
    /// Standard deviation of one cut, m.
    pub scatter: Vec<f64>,
    /// Standard uncertainty of the bias round the circle, of the parts for which it is known, m.
    pub u: f64,
    /// Largest bias of each origin, m.
    pub of_origin: [f64; 2],
    /// Largest bias, m.
    pub largest: f64,
    /// Largest bias and twice the scatter there, m.
    pub largest_with_scatter: f64,
    /// Sum of the largest of each origin, m.
    pub plain: f64,
    /// Root sum of their squares, m.
    pub root_sum_square: f64,
}

/// Coverage factor for 95 %.
const COVERAGE: f64 = 2.0;

impl Sums {
    /// Of these contributions, all at `count` angles.
    pub fn of(contributions: &[Contribution], count: usize) -> Sums {
        let bias = bias_of(contributions.iter(), count);
        let variance = |k: usize| {
            contributions
                .iter()
                .map(|one| one.scatter[k].powi(2))
                .sum::<f64>()
        };
        let scatter: Vec<f64> = (0..count).map(|k| variance(k).sqrt()).collect();
        let of_origin = Origin::BOTH.map(|origin| {
            let own = contributions.iter().filter(|one| one.origin == origin);
            largest(&bias_of(own, count)).1
        });
        let with_scatter = bias.iter().zip(&scatter).map(|(b, s)| b.abs() + COVERAGE * s);
        Sums {
            largest: largest(&bias).1,
            largest_with_scatter: with_scatter.fold(0.0, f64::max),
            plain: of_origin.iter().sum(),
            root_sum_square: of_origin[0].hypot(of_origin[1]),
            u: contributions.iter().filter_map(|one| one.u).fold(0.0, f64::hypot),
            bias,
            scatter,
            of_origin,
        }
    }
}

/// Biases added at every angle.
pub(super) fn bias_of<'a>(of: impl Iterator<Item = &'a Contribution>, count: usize) -> Vec<f64> {
    of.fold(vec![0.0; count], |mut sum, one| {
        sum.iter_mut().zip(&one.bias).for_each(|(sum, b)| *sum += b);
        sum
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(origin: Origin, bias: impl Fn(f64) -> f64, scatter: f64) -> Contribution {
        Contribution {
            name: String::new(),
            origin,
            bias: (0..360).map(|deg| bias(f64::from(deg).to_radians())).collect(),
            scatter: vec![scatter; 360],
            u: None,
        }
    }

    #[test]
    fn the_plain_sum_is_that_of_the_paper_and_the_others_are_below_it() {
        // Section 5 of the paper: 60 um of the joints' compliance, 140 um of positioning, 200 um together.
        let load = one(Origin::Load, |a| 60e-6 * (2.0 * a).cos(), 0.0);
        let unloaded = one(Origin::Unloaded, |a| 140e-6 * (2.0 * a).sin(), 10e-6);
        let sums = Sums::of(&[load, unloaded], 360);
        assert!((sums.plain - 200e-6).abs() < 1e-12);
        // Two waves a quarter of a wave apart: the root of the squares.
        let squares = (60.0_f64.hypot(140.0)) * 1e-6;
        assert!((sums.root_sum_square - squares).abs() < 1e-12 && (squares - 152.3e-6).abs() < 0.05e-6);
        assert!((sums.largest - squares).abs() < 0.1e-6);
        assert!((sums.largest_with_scatter - sums.largest - 20e-6).abs() < 1e-12);
    }

    #[test]
    fn biases_of_opposite_sign_cancel_and_scatter_never_does() {
        let [there, back] = [1.0, -1.0].map(|sign| one(Origin::Load, move |a| sign * 1e-5 * a.sin(), 3e-6));
        let sums = Sums::of(&[there, back], 360);
        assert_eq!((sums.largest, sums.plain), (0.0, 0.0));
        assert!((sums.largest_with_scatter - 2.0 * 3e-6 * 2.0_f64.sqrt()).abs() < 1e-18);
    }

    #[test]
    fn parts_of_one_origin_are_added_as_functions_before_the_plain_sum() {
        let parts = [
            one(Origin::Unloaded, |a| 1e-5 * a.cos(), 0.0),
            one(Origin::Unloaded, |a| 1e-5 * a.sin(), 0.0),
        ];
        let sums = Sums::of(&parts, 360);
        assert!((sums.plain - 2.0_f64.sqrt() * 1e-5).abs() < 1e-8);
    }
}
