//! The path without load, in parts: the mean of both directions, the part that changes with the direction, and the
//! scatter.
//!
//! ```text
//! mean(a)     = (c(a) + o(a)) / 2        bias in the direction of the cut c, of the other o: means of their runs
//! reversal(a) = (c(a) - o(a)) / 2        mean + reversal = c
//! s^2         = sum over runs of <x_k - x_way, x_k - x_way> / (runs - ways)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x_k`, `x_way` | a run, and the mean of all runs in its direction, from the datum | m |
//! | `s` | standard deviation of a run about the mean of its direction | m |
//!
//! Backlash and other effects of the direction of motion make the reversal part; it is half of the difference between
//! the directions.

use crate::measure::ballbar::{CircularTest, Direction, Profile};

use super::datum::{Datum, Removed};
use super::turn::Turn;

/// The unloaded path at the angles of a turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Unloaded {
    /// The mean of both directions; with one direction only, that direction. m
    pub mean: Vec<f64>,
    /// Half the difference between the directions; none where only one was measured. m
    pub reversal: Option<Vec<f64>>,
    /// Standard deviation of one run; none where no direction has two. m
    pub scatter: Option<f64>,
    /// Standard uncertainty of `mean` and of `reversal`, from the scatter of runs. m
    pub u: Option<f64>,
    /// Whether the direction of the cut was measured.
    pub has_cut_way: bool,
}

/// The angles out of `angles` at which every run is known, rad.
pub fn known_angles(test: &CircularTest, angles: &[f64]) -> Vec<f64> {
    let profiles: Vec<Profile> = test.runs().iter().map(Profile::of).collect();
    let known = |angle: &f64| profiles.iter().all(|profile| profile.at(*angle).is_some());
    angles.iter().copied().filter(known).collect()
}

/// The parts of `test` at the angles of `turn`, where all its runs are known, for a cut in the direction `cut`; `None`
/// where a run is unknown at one of them.
pub fn unloaded(test: &CircularTest, turn: &Turn, cut: Direction, removed: Removed) -> Option<Unloaded> {
    let seen =
        |profile: Profile| -> Option<Vec<f64>> { turn.angle().iter().map(|a| profile.at(*a)).collect() };
    let of_way = |way: Direction| -> Option<Vec<Vec<f64>>> {
        test.of(way).map(|run| seen(Profile::of(run))).collect()
    };
    let other = Direction::BOTH[1 - cut.index()];
    let ways: Vec<Vec<Vec<f64>>> = [of_way(cut)?, of_way(other)?].into();
    let means: Vec<Vec<f64>> = ways.iter().map(|runs| mean(runs, turn.angle().len())).collect();
    let measured: Vec<usize> = (0..2).filter(|way| !ways[*way].is_empty()).collect();
    let runs: usize = ways.iter().map(Vec::len).sum();
    let freedom = runs - measured.len();
    let squares = |way| squares_of(&test.of(way).map(Profile::of).collect::<Vec<_>>(), turn, removed);
    let squares = squares(cut)? + squares(other)?;
    let scatter = (freedom > 0).then(|| (squares / freedom as f64).sqrt());
    let [c, o] = [&means[0], &means[1]];
    let share: f64 = measured.iter().map(|way| 1.0 / ways[*way].len() as f64).sum();
    let both = measured.len() == 2;
    let half = |sign: f64| -> Vec<f64> { c.iter().zip(o).map(|(c, o)| (c + sign * o) / 2.0).collect() };
    Some(Unloaded {
        mean: match both {
            true => half(1.0),
            false => means[*measured.first()?].clone(),
        },
        reversal: both.then(|| half(-1.0)),
        scatter,
        u: scatter.map(|s| s * share.sqrt() / measured.len() as f64),
        has_cut_way: measured.contains(&0),
    })
}

/// Sum of the mean square differences (m^2) of these runs from their mean: at the angles of the first, since between
/// samples a curve is a mean of two that scatters less; where those are not a valid turn, at the angles of `turn`.
/// `None` where a run is unknown there.
fn squares_of(runs: &[Profile], turn: &Turn, removed: Removed) -> Option<f64> {
    let known = |angle: &f64| runs.iter().all(|run| run.at(*angle).is_some());
    let samples = runs.first().into_iter().flat_map(Profile::samples);
    let own = Turn::new(samples.map(|(angle, _)| angle).filter(known).collect());
    let turn = own.as_ref().unwrap_or(turn);
    let seen = |run: &Profile| turn.angle().iter().map(|angle| run.at(*angle)).collect();
    let curves: Vec<Vec<f64>> = runs.iter().map(seen).collect::<Option<_>>()?;
    let mean = mean(&curves, turn.angle().len());
    let form = |curve: &Vec<f64>| Datum::remove(turn, &minus(curve, &mean), removed).1;
    Some(curves.iter().map(|curve| turn.rms(&form(curve)).powi(2)).sum())
}

/// The mean of curves of `count` angles; zeros of none.
fn mean(curves: &[Vec<f64>], count: usize) -> Vec<f64> {
    let of = curves.len().max(1) as f64;
    (0..count)
        .map(|k| curves.iter().map(|curve| curve[k]).sum::<f64>() / of)
        .collect()
}

fn minus(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter().zip(other).map(|(a, b)| a - b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::ballbar::Run;

    const NONE: Removed = Removed {
        centre: false,
        radius: false,
    };

    fn angles() -> Vec<f64> {
        (0..360).map(|deg| f64::from(deg).to_radians()).collect()
    }

    fn run(way: Direction, of: impl Fn(f64) -> f64) -> Run {
        Run::new(way, angles(), angles().into_iter().map(of).collect()).unwrap()
    }

    fn form(a: f64) -> f64 {
        8e-5 * (2.0 * a).cos()
    }

    fn gap(a: f64) -> f64 {
        5e-5 * a.sin().signum()
    }

    #[test]
    fn form_and_reversal_are_separated_and_add_up_to_the_direction_of_the_cut() {
        let turn = Turn::new(angles()).unwrap();
        let runs = Direction::BOTH.map(|way| run(way, |a| form(a) + way.sign() * gap(a)));
        let test = CircularTest::new(0.1, runs.to_vec()).unwrap();
        for cut in Direction::BOTH {
            let parts = unloaded(&test, &turn, cut, NONE).unwrap();
            let reversal = parts.reversal.clone().unwrap();
            for (k, a) in angles().into_iter().enumerate() {
                assert!((parts.mean[k] - form(a)).abs() < 1e-18);
                assert!((reversal[k] - cut.sign() * gap(a)).abs() < 1e-18);
            }
            assert_eq!((parts.scatter, parts.u, parts.has_cut_way), (None, None, true));
        }
    }

    #[test]
    fn runs_that_differ_by_a_wave_scatter_by_it_and_the_mean_has_less_uncertainty() {
        let turn = Turn::new(angles()).unwrap();
        let wave = |sign: f64| move |a: f64| form(a) + sign * 1e-5 * (4.0 * a).cos();
        let cw = [1.0, -1.0].map(|sign| run(Direction::Clockwise, wave(sign)));
        let ccw = [1.0, -1.0].map(|sign| run(Direction::Anticlockwise, wave(sign)));
        let test = CircularTest::new(0.1, [cw, ccw].concat()).unwrap();
        let parts = unloaded(&test, &turn, Direction::Clockwise, NONE).unwrap();
        // Four runs of mean square 1e-10 / 2 about two means: two degrees of freedom.
        assert!((parts.scatter.unwrap() - 1e-5).abs() < 1e-12);
        assert!((parts.u.unwrap() - 0.5e-5).abs() < 1e-12);
    }

    #[test]
    fn a_centre_that_drifts_between_runs_does_not_add_to_the_scatter_of_form() {
        let turn = Turn::new(angles()).unwrap();
        let runs = [0.0, 4e-5].map(|by| run(Direction::Clockwise, move |a| form(a) + by * a.cos() + by));
        let test = CircularTest::new(0.1, runs.to_vec()).unwrap();
        let both = Removed {
            centre: true,
            radius: true,
        };
        let kept = unloaded(&test, &turn, Direction::Clockwise, NONE).unwrap();
        let removed = unloaded(&test, &turn, Direction::Clockwise, both).unwrap();
        assert!(kept.scatter.unwrap() > 1e-5 && removed.scatter.unwrap() < 1e-15);
    }

    #[test]
    fn one_direction_has_no_reversal_and_gaps_are_not_filled() {
        let turn = Turn::new(angles()).unwrap();
        let test = CircularTest::new(0.1, vec![run(Direction::Clockwise, form)]).unwrap();
        let parts = unloaded(&test, &turn, Direction::Anticlockwise, NONE).unwrap();
        assert_eq!((parts.reversal, parts.has_cut_way), (None, false));
        assert!((parts.mean[0] - 8e-5).abs() < 1e-18);
        let half = angles()[..180].to_vec();
        let short = Run::new(Direction::Clockwise, half, vec![0.0; 180]).unwrap();
        let test = CircularTest::new(0.1, vec![short]).unwrap();
        assert_eq!(known_angles(&test, &angles()).len(), 180);
        assert_eq!(unloaded(&test, &turn, Direction::Clockwise, NONE), None);
    }
}
