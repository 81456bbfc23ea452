//! Differences between two runs over the angle, and between the two directions.
//!
//! Two runs in one direction should be equal: their difference is repeatability. Clockwise and anticlockwise differ by
//! effects of the direction: backlash, lag, friction.

use super::profile::{Profile, mean, station};
use super::run::{CircularTest, Direction};

/// A difference of radii at every station of a turn, m; `None` within a gap of one of both.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// One per station.
    pub stations: Vec<Option<f64>>,
}

/// Size of a difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The one that is largest by size, m.
    pub largest: f64,
    /// Where it is, rad.
    pub angle: f64,
    /// Root of the mean square, m.
    pub rms: f64,
}

impl Difference {
    /// Largest and root mean square; `None` where no angle has both.
    pub fn span(&self) -> Option<Span> {
        let known = || {
            let stations = self.stations.iter().enumerate();
            stations.filter_map(|(index, value)| value.map(|value| (index, value)))
        };
        let (index, largest) = known().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        let squares: f64 = known().map(|(_, value)| value * value).sum();
        Some(Span {
            largest,
            angle: station(index),
            rms: (squares / known().count() as f64).sqrt(),
        })
    }

    /// Of these radii, first minus second.
    fn of(first: &[Option<f64>], second: &[Option<f64>]) -> Difference {
        let pairs = first.iter().zip(second);
        Difference {
            stations: pairs.map(|(one, other)| Some((*one)? - (*other)?)).collect(),
        }
    }
}

/// Every pair of runs of one direction by their indices, with the first minus the second.
pub fn repeats(test: &CircularTest) -> Vec<([usize; 2], Difference)> {
    let runs = test.runs();
    let stations: Vec<_> = runs.iter().map(|run| Profile::of(run).stations()).collect();
    let pairs = (0..runs.len()).flat_map(|second| (0..second).map(move |first| [first, second]));
    pairs
        .filter(|[first, second]| runs[*first].direction() == runs[*second].direction())
        .map(|pair| (pair, Difference::of(&stations[pair[0]], &stations[pair[1]])))
        .collect()
}

/// Mean of the clockwise runs minus mean of the anticlockwise ones.
pub fn between_directions(test: &CircularTest) -> Difference {
    let [clockwise, anticlockwise] = Direction::BOTH.map(|direction| mean_of(test, direction));
    Difference::of(&clockwise, &anticlockwise)
}

/// The mean of all runs of a direction at every station, m.
pub fn mean_of(test: &CircularTest, direction: Direction) -> Vec<Option<f64>> {
    let profiles: Vec<Profile> = test.of(direction).map(Profile::of).collect();
    mean(&profiles)
}

#[cfg(test)]
mod tests {
    use super::super::run::Run;
    use super::*;

    fn run(direction: Direction, of: impl Fn(f64) -> f64) -> Run {
        let angle: Vec<f64> = (0..360).map(|deg| f64::from(deg).to_radians()).collect();
        let deviation = angle.iter().map(|a| of(*a)).collect();
        Run::new(direction, angle, deviation).unwrap()
    }

    #[test]
    fn a_difference_reports_its_largest_value_with_sign_its_angle_and_its_root_mean_square() {
        let flat = || run(Direction::Clockwise, |_| 3e-6);
        let wave = || run(Direction::Clockwise, |a| 3e-6 - 5e-6 * a.sin());
        let back = run(Direction::Anticlockwise, |_| 0.0);
        let of = |runs: Vec<Run>| {
            let found = repeats(&CircularTest::new(0.1, runs).unwrap());
            assert!(found.len() == 1 && found[0].0 == [0, 2]);
            found[0].1.span().unwrap()
        };
        let span = of(vec![wave(), back.clone(), flat()]);
        assert!((span.largest.abs() - 5e-6).abs() < 1e-12);
        assert!((span.largest + 5e-6 * span.angle.sin()).abs() < 1e-12);
        // Straight lines between samples are within (1 deg)^2/12 of the wave.
        assert!((span.rms - 5e-6 / 2_f64.sqrt()).abs() < 1e-9);
        let back = of(vec![flat(), back, wave()]);
        assert_eq!((back.largest.abs(), back.rms), (span.largest.abs(), span.rms));
    }

    #[test]
    fn directions_are_compared_by_their_means() {
        let runs = vec![
            run(Direction::Clockwise, |_| 1e-6),
            run(Direction::Anticlockwise, |_| -5e-6),
            run(Direction::Clockwise, |_| 3e-6),
        ];
        let test = CircularTest::new(0.1, runs).unwrap();
        let span = between_directions(&test).span().unwrap();
        assert!((span.largest - 7e-6).abs() < 1e-15);
        let one = CircularTest::new(0.1, vec![run(Direction::Clockwise, |_| 0.0)]).unwrap();
        assert_eq!(between_directions(&one).span(), None);
    }
}
