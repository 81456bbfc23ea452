//! The most likely compliances: Gauss-Newton with robust weights, a prior, and the scatter estimated from the data.
//!
//! Least over the unknowns `x` (logarithms of sizes with a prior, sizes not below zero without; shifts of points):
//!
//! ```text
//! sum over tests rho(|r_t| / sigma) + sum over priors ((p . x - m) / u)^2        r = (predicted - measured) / u_reading
//! ```
//!
//! `rho(n) = n^2` up to 1.5 and `2 * 1.5 n - 1.5^2` beyond (Huber 1964): the influence of an outlying test is
//! limited. `sigma` makes the tests' residuals as large as their weights expect (Huber's proposal 2), with the
//! effective number of unknowns determined by the tests instead of the prior (MacKay 1992). Both are iterated to
//! convergence.

use nalgebra::{DMatrix, DVector, Vector3};

use super::bounded;
use super::effect::{Effects, State, predicted};
use super::load_test::LoadTest;
use super::prior::{LogPrior, Prior, typical, typical_sizes};
use super::spread::Spread;
use super::unknown::Unknown;

/// Method of identification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Prior knowledge.
    pub prior: Prior,
    /// Whether force and displacement act and are measured at the stated points.
    pub points: Points,
    /// Weighting of outlying tests.
    pub loss: Loss,
    /// Whether the standard uncertainties of the readings are known, or only their ratios.
    pub scatter: Scatter,
}

/// Positions of the force point and of the measured point.
///
/// The standard uncertainties are used with [`Prior::Typical`] only: without a prior shifts are free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Points {
    /// As stated by the tests.
    Known,
    /// Both shifted by the same vector in the flange frame, by about this standard uncertainty, m.
    Common(f64),
    /// Each shifted independently, by about this, m.
    Separate(f64),
}

impl Points {
    /// Unknown coordinates.
    pub fn count(self) -> usize {
        match self {
            Points::Known => 0,
            Points::Common(_) => 3,
            Points::Separate(_) => 6,
        }
    }
}

/// Weighting of residuals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// By their squares.
    Squares,
    /// By their squares up to 1.5 sigma, linearly beyond.
    Huber,
}

/// Knowledge of the scatter of readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scatter {
    /// Only ratios: the scale is estimated from the residuals.
    Found,
    /// Standard uncertainties are known: larger residuals enlarge them, smaller ones do not.
    Stated,
}

/// Beyond this multiple of sigma a test is weighted linearly.
const BEND: f64 = 1.5;
const MOST_STEPS: usize = 60;
const MOST_SCALES: usize = 25;
/// A scale that changes by less than this share has converged: its own uncertainty is some ten per cent.
const SAME_SCALE: f64 = 1e-4;
/// A step in a logarithm longer than this leaves the range of the linearisation.
const LONGEST_LOG_STEP: f64 = 2.0;

/// Tests, unknowns and method as one least-squares problem.
#[derive(Clone, Debug)]
pub(super) struct Problem<'a> {
    pub unknowns: &'a [Unknown],
    pub tests: &'a [LoadTest],
    pub effects: Vec<Effects>,
    pub method: Method,
    prior: Vec<LogPrior>,
    /// Mean of the bent square of a residual, by the number of readings of its test.
    expected_squares: Vec<f64>,
}

/// The most likely unknowns, and the linearisation there.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub x: DVector<f64>,
    pub scale: f64,
    pub spread: Spread,
}

/// Residuals and their derivatives at one `x`, readings over their uncertainties.
struct Linear {
    residual: DVector<f64>,
    jacobian: DMatrix<f64>,
    /// First row of each test, and the end.
    first_row: Vec<usize>,
}

impl Linear {
    /// Length of the residual of each test.
    fn lengths(&self) -> impl Iterator<Item = f64> {
        let rows = self.first_row.windows(2);
        rows.map(|rows| self.residual.rows(rows[0], rows[1] - rows[0]).norm())
    }
}

impl<'a> Problem<'a> {
    pub fn new(
        unknowns: &'a [Unknown],
        tests: &'a [LoadTest],
        effects: Vec<Effects>,
        method: Method,
    ) -> Problem<'a> {
        let prior = match method.prior {
            Prior::Typical => typical(unknowns),
            Prior::None => Vec::new(),
        };
        let most = tests.iter().map(|test| test.readings.len()).max().unwrap_or(0);
        let expected = |readings| match method.loss {
            Loss::Squares => readings as f64,
            Loss::Huber => expected_bent_square(readings),
        };
        Problem {
            unknowns,
            tests,
            effects,
            method,
            prior,
            expected_squares: (0..=most).map(expected).collect(),
        }
    }

    /// Start of the search without any knowledge.
    pub fn start(&self) -> Fitted {
        let sizes = typical_sizes(self.unknowns);
        let count = sizes.len() + self.method.points.count();
        let value = |size: f64| if self.in_logs() { size.ln() } else { size };
        Fitted {
            x: DVector::from_fn(count, |j, _| sizes.get(j).copied().map_or(0.0, value)),
            scale: 1.0,
            spread: Spread::default(),
        }
    }

    fn in_logs(&self) -> bool {
        self.method.prior == Prior::Typical
    }

    /// The sizes and shifts given by `x`.
    pub fn state(&self, x: &DVector<f64>) -> State {
        let count = self.unknowns.len();
        let sizes = x.iter().take(count);
        let shift = |at: usize| Vector3::new(x[at], x[at + 1], x[at + 2]);
        let (force_shift, measured_shift) = match self.method.points {
            Points::Known => (Vector3::zeros(), Vector3::zeros()),
            Points::Common(_) => (shift(count), shift(count)),
            Points::Separate(_) => (shift(count), shift(count) + shift(count + 3)),
        };
        State {
            sizes: sizes.map(|v| if self.in_logs() { v.exp() } else { *v }).collect(),
            force_shift,
            measured_shift,
        }
    }

    /// The most likely `x` for the tests with these indices, searched from `start`.
    pub fn at_rest(&self, used: &[usize], start: &Fitted) -> Fitted {
        let mut rest = start.clone();
        let readings: usize = used.iter().map(|t| self.tests[*t].readings.len()).sum();
        // Readings have about nine significant digits; less scatter than that is rounding.
        let sizes = used.iter().flat_map(|t| &self.tests[*t].readings);
        let largest = sizes
            .map(|r| (r.value / r.standard_uncertainty).abs())
            .fold(0.0, f64::max);
        for _ in 0..MOST_SCALES {
            rest.x = self.descend(used, rest.x, rest.scale);
            let linear = self.linear(used, &rest.x);
            rest.spread = self.spread(&linear, &rest);
            let decided = rest.spread.known.iter().sum::<f64>().min(readings as f64 - 1.0);
            let bend = self.bend();
            let (mut found, mut expected) = (0.0, 0.0);
            for (test, length) in used.iter().zip(linear.lengths()) {
                found += length.min(bend * rest.scale).powi(2);
                expected += self.expected_squares[self.tests[*test].readings.len()];
            }
            let share = (1.0 - decided / readings as f64).max(1.0 / readings as f64);
            let mut scale = (found / (expected * share)).sqrt().max(largest * 1e-9);
            if self.method.scatter == Scatter::Stated {
                scale = scale.max(1.0);
            }
            let change = (scale / rest.scale - 1.0).abs();
            rest.scale = scale;
            if change < SAME_SCALE {
                break;
            }
        }
        rest
    }

    fn bend(&self) -> f64 {
        match self.method.loss {
            Loss::Squares => f64::INFINITY,
            Loss::Huber => BEND,
        }
    }

    /// Weight of a test whose residual is `length` times sigma.
    pub fn weight(&self, length: f64) -> f64 {
        (self.bend() / length).min(1.0)
    }

    fn linear(&self, used: &[usize], x: &DVector<f64>) -> Linear {
        let state = self.state(x);
        let count = self.unknowns.len();
        let mut first_row = vec![0];
        for test in used {
            let last = first_row.last().copied().unwrap_or(0);
            first_row.push(last + self.tests[*test].readings.len());
        }
        let rows = first_row.last().copied().unwrap_or(0);
        let mut linear = Linear {
            residual: DVector::zeros(rows),
            jacobian: DMatrix::zeros(rows, x.len()),
            first_row,
        };
        for (place, test) in used.iter().enumerate() {
            let effect = self.effects[*test].jacobian(self.unknowns, &state);
            for (r, reading) in self.tests[*test].readings.iter().enumerate() {
                let row = linear.first_row[place] + r;
                let u = reading.standard_uncertainty;
                linear.residual[row] = (predicted(&effect, r, &state) - reading.value) / u;
                for k in 0..count {
                    let by_log = if self.in_logs() { state.sizes[k] } else { 1.0 };
                    linear.jacobian[(row, k)] = effect[(r, k)] * by_log / u;
                }
                for j in 0..3 {
                    let (force, measured) = (effect[(r, count + j)] / u, effect[(r, count + 3 + j)] / u);
                    match self.method.points {
                        Points::Known => {}
                        Points::Common(_) => linear.jacobian[(row, count + j)] = force + measured,
                        Points::Separate(_) => {
                            linear.jacobian[(row, count + j)] = force + measured;
                            linear.jacobian[(row, count + 3 + j)] = measured;
                        }
                    }
                }
            }
        }
        linear
    }

    fn objective(&self, linear: &Linear, x: &DVector<f64>, scale: f64) -> f64 {
        let bend = self.bend();
        let tests: f64 = linear
            .lengths()
            .map(|length| length / scale)
            .map(|n| if n <= bend { n * n } else { (2.0 * n - bend) * bend })
            .sum();
        let (prior, requested) = self.prior_rows(x.len());
        tests + (prior * x - requested).norm_squared()
    }

    /// Rows of the prior and their expected values, over their standard uncertainties; for points that they are not
    /// shifted.
    fn prior_rows(&self, count: usize) -> (DMatrix<f64>, DVector<f64>) {
        let (of_sizes, requested) = LogPrior::rows(&self.prior, count);
        let (Points::Common(u) | Points::Separate(u)) = self.method.points else {
            return (of_sizes, requested);
        };
        if !self.in_logs() {
            return (of_sizes, requested);
        }
        let (first, more) = (self.prior.len(), self.method.points.count());
        let mut rows = of_sizes.resize_vertically(first + more, 0.0);
        for k in 0..more {
            rows[(first + k, self.unknowns.len() + k)] = 1.0 / u;
        }
        (rows, requested.resize_vertically(first + more, 0.0))
    }

    /// Derivatives of the sizes, then shifts, by `x`, on a diagonal.
    pub fn slopes(&self, x: &DVector<f64>) -> DMatrix<f64> {
        let mut slopes = DVector::from_element(x.len(), 1.0);
        if self.in_logs() {
            let sizes = self.unknowns.len();
            slopes
                .rows_mut(0, sizes)
                .copy_from(&x.rows(0, sizes).map(f64::exp));
        }
        DMatrix::from_diagonal(&slopes)
    }

    /// The rows of the tests, weighted, over sigma.
    fn weighed(&self, linear: &Linear, scale: f64) -> (DMatrix<f64>, DVector<f64>) {
        let (mut jacobian, mut residual) = (linear.jacobian.clone(), linear.residual.clone());
        for (rows, length) in linear.first_row.windows(2).zip(linear.lengths()) {
            let factor = self.weight(length / scale).sqrt() / scale;
            jacobian.rows_mut(rows[0], rows[1] - rows[0]).scale_mut(factor);
            residual.rows_mut(rows[0], rows[1] - rows[0]).scale_mut(factor);
        }
        (jacobian, residual)
    }

    fn spread(&self, linear: &Linear, rest: &Fitted) -> Spread {
        let (tests, _) = self.weighed(linear, rest.scale);
        let (prior, _) = self.prior_rows(rest.x.len());
        let at_bound = |j: usize| !self.in_logs() && j < self.unknowns.len() && rest.x[j] <= 0.0;
        let active: Vec<bool> = (0..rest.x.len()).map(|j| !at_bound(j)).collect();
        Spread::of(&tests, &prior, &active)
    }

    /// Gauss-Newton, with Levenberg's damping only where a full step does not reduce the objective.
    fn descend(&self, used: &[usize], mut x: DVector<f64>, scale: f64) -> DVector<f64> {
        let count = x.len();
        let bounded: Vec<bool> = (0..count)
            .map(|j| !self.in_logs() && j < self.unknowns.len())
            .collect();
        let mut linear = self.linear(used, &x);
        let mut least = self.objective(&linear, &x, scale);
        let mut damping = 0.0;
        for _ in 0..MOST_STEPS {
            let (tests, residual) = self.weighed(&linear, scale);
            let (prior, requested) = self.prior_rows(count);
            let right = &tests * &x - residual;
            let lengths: Vec<f64> = tests.column_iter().map(|column| column.norm()).collect();
            let (rows, more) = (tests.nrows(), prior.nrows());
            let mut a = DMatrix::zeros(rows + more + count, count);
            a.rows_mut(0, rows).copy_from(&tests);
            a.rows_mut(rows, more).copy_from(&prior);
            let mut b = DVector::zeros(rows + more + count);
            b.rows_mut(0, rows).copy_from(&right);
            b.rows_mut(rows, more).copy_from(&requested);
            for j in 0..count {
                let damping_weight = lengths[j] * f64::sqrt(damping);
                a[(rows + more + j, j)] = damping_weight;
                b[rows + more + j] = damping_weight * x[j];
            }
            let tried = bounded::solve(&a, &b, &bounded).map(|target| {
                let mut next = target;
                for j in 0..self.unknowns.len() {
                    if self.in_logs() {
                        next[j] = x[j] + (next[j] - x[j]).clamp(-LONGEST_LOG_STEP, LONGEST_LOG_STEP);
                    }
                }
                let there = self.linear(used, &next);
                let value = self.objective(&there, &next, scale);
                (next, there, value)
            });
            match tried {
                Some((next, there, value)) if value < least => {
                    let gain = least - value;
                    (x, linear, least) = (next, there, value);
                    damping = if damping > 1e-6 { damping * 0.1 } else { 0.0 };
                    if gain < 1e-10 * least {
                        break;
                    }
                }
                _ if damping > 1e6 => break,
                // A full step from the minimum gains nothing: a shorter one would not either.
                Some((next, _, _)) if (&next - &x).amax() <= 1e-9 * x.amax() => break,
                _ => damping = if damping == 0.0 { 1e-4 } else { damping * 10.0 },
            }
        }
        x
    }
}

/// Mean of `min(n^2, 1.5^2)` for `n^2` chi-squared with `readings` degrees of freedom, by the midpoint rule.
fn expected_bent_square(readings: usize) -> f64 {
    if readings == 0 {
        return 0.0;
    }
    const CELLS: usize = 2000;
    // Beyond this the density is below 1e-17 of its peak for up to six readings.
    const END: f64 = 12.0;
    let density = |n: f64| n.powi(readings as i32 - 1) * (-0.5 * n * n).exp();
    let (mut mean, mut mass) = (0.0, 0.0);
    for cell in 0..CELLS {
        let n = (cell as f64 + 0.5) * END / CELLS as f64;
        mean += density(n) * n.min(BEND).powi(2);
        mass += density(n);
    }
    mean / mass
}

#[cfg(test)]
mod tests {
    use super::super::small_arm::{arm, numbers, tests};
    use super::super::unknown::{bending, drives, lost_motion};
    use super::*;

    #[test]
    fn bent_squares_of_one_reading_have_the_mean_of_the_normal_distribution() {
        // E min(n^2, k^2) = 1 - 2 k phi(k) - 2 (1 - k^2)(1 - Phi(k)), k = 1.5: phi 0.1295176, 1 - Phi 0.0668072.
        let expected = 1.0 - 2.0 * 1.5 * 0.129_517_6 - 2.0 * (1.0 - 2.25) * 0.066_807_2;
        assert!((expected_bent_square(1) - expected).abs() < 1e-5);
    }

    fn problem<'a>(unknowns: &'a [Unknown], tests: &'a [LoadTest], method: Method) -> Problem<'a> {
        let robot = arm(1.0);
        let effects = tests.iter().map(|test| Effects::of(&robot, unknowns, test));
        Problem::new(unknowns, tests, effects.collect(), method)
    }

    fn plain() -> Method {
        Method {
            prior: Prior::None,
            points: Points::Known,
            loss: Loss::Squares,
            scatter: Scatter::Found,
        }
    }

    /// Of the objective, from the weighed rows.
    fn gradient(problem: &Problem<'_>, used: &[usize], x: &DVector<f64>, scale: f64) -> DVector<f64> {
        let (tests, residual) = problem.weighed(&problem.linear(used, x), scale);
        let (prior, requested) = problem.prior_rows(x.len());
        (tests.tr_mul(&residual) + prior.tr_mul(&(&prior * x - requested))) * 2.0
    }

    #[test]
    fn the_gradient_of_the_objective_matches_differences_whatever_the_method() {
        let robot = arm(1.0);
        let unknowns = [drives(&robot), bending(&robot), lost_motion(&robot, &[20.0; 3])].concat();
        let tests = tests(&unknowns, &State::typical(&unknowns), 9, 2e-4);
        let used: Vec<usize> = (0..tests.len()).collect();
        let mut next = numbers(5);
        for prior in [Prior::Typical, Prior::None] {
            for points in [Points::Known, Points::Common(0.1), Points::Separate(0.1)] {
                for loss in [Loss::Squares, Loss::Huber] {
                    let method = Method {
                        prior,
                        points,
                        loss,
                        ..plain()
                    };
                    let problem = problem(&unknowns, &tests, method);
                    let sizes = unknowns.len();
                    // Away from the middle, points shifted by centimetres.
                    let x = problem.start().x.map_with_location(|j, _, value| match prior {
                        _ if j >= sizes => 0.03 * next(),
                        Prior::Typical => value + 0.5 * next(),
                        Prior::None => value * (1.0 + 0.5 * next()),
                    });
                    let value = |x: &DVector<f64>| problem.objective(&problem.linear(&used, x), x, 2.0);
                    let (here, exact) = (value(&x), gradient(&problem, &used, &x, 2.0));
                    for j in 0..x.len() {
                        let step = 1e-5 * if j < sizes { x[j].abs().min(1.0) } else { 1.0 };
                        let (mut more, mut less) = (x.clone(), x.clone());
                        more[j] += step;
                        less[j] -= step;
                        let difference = (value(&more) - value(&less)) / (2.0 * step);
                        // The square of the step, and rounding of the objective.
                        let tolerance = 1e-5 * exact[j].abs() + 1e-13 * here / step;
                        assert!(
                            (difference - exact[j]).abs() < tolerance,
                            "{method:?} {j}: {difference} {}",
                            exact[j]
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn without_a_prior_no_change_of_a_size_improves_the_solution() {
        let robot = arm(1.0);
        let unknowns = [drives(&robot), bending(&robot)].concat();
        // Half of the springs are rigid: noise makes some of them negative, if they may be.
        let sizes = (0..unknowns.len()).map(|k| if k % 2 == 0 { 2e-6 } else { 0.0 });
        let tests = tests(&unknowns, &State::of_sizes(sizes.collect()), 12, 5e-5);
        let used: Vec<usize> = (0..tests.len()).collect();
        let problem = problem(&unknowns, &tests, plain());
        let rest = problem.at_rest(&used, &problem.start());
        let slope = gradient(&problem, &used, &rest.x, rest.scale);
        let least = problem.objective(&problem.linear(&used, &rest.x), &rest.x, rest.scale);
        let mut at_bound = 0;
        for (size, slope) in rest.x.iter().zip(slope.iter()) {
            // A typical spring more or less would change the objective by this.
            let by = slope * 2e-6;
            if *size == 0.0 {
                at_bound += 1;
                assert!(by > -1e-6 * least, "{by} of {least}");
            } else {
                assert!(*size > 0.0 && by.abs() < 1e-6 * least, "{by} of {least}");
            }
        }
        assert!(at_bound > 0 && at_bound < unknowns.len(), "{}", rest.x);
    }

    #[test]
    fn readings_without_information_leave_the_middle_of_the_prior() {
        let robot = arm(1.0);
        let unknowns = [drives(&robot), bending(&robot)].concat();
        let mut tests = tests(&unknowns, &State::typical(&unknowns), 12, 1e-3);
        for reading in tests.iter_mut().flat_map(|test| &mut test.readings) {
            reading.standard_uncertainty = 1e3;
        }
        let method = Method {
            prior: Prior::Typical,
            points: Points::Separate(0.1),
            scatter: Scatter::Stated,
            ..plain()
        };
        let problem = problem(&unknowns, &tests, method);
        let used: Vec<usize> = (0..tests.len()).collect();
        let mut start = problem.start();
        start.x.add_scalar_mut(0.7);
        let found = problem.state(&problem.at_rest(&used, &start).x);
        let typical = State::typical(&unknowns);
        for (found, typical) in found.sizes.iter().zip(&typical.sizes) {
            assert!((found / typical - 1.0).abs() < 1e-6, "{found} {typical}");
        }
        assert!(found.force_shift.norm() < 1e-7 && found.measured_shift.norm() < 1e-7);
    }

    #[test]
    fn slopes_are_those_of_the_sizes_by_the_variables_of_the_fit() {
        let robot = arm(1.0);
        let unknowns = drives(&robot);
        let tests = tests(&unknowns, &State::typical(&unknowns), 4, 0.0);
        for prior in [Prior::Typical, Prior::None] {
            let method = Method {
                prior,
                points: Points::Common(0.1),
                ..plain()
            };
            let problem = problem(&unknowns, &tests, method);
            let x = problem.start().x;
            let slopes = problem.slopes(&x);
            for j in 0..x.len() {
                let step = 1e-6 * x[j].abs().max(1e-3);
                let mut more = x.clone();
                more[j] += step;
                let (here, there) = (problem.state(&x), problem.state(&more));
                let change = match j {
                    0..=2 => there.sizes[j] - here.sizes[j],
                    _ => (there.force_shift - here.force_shift)[j - 3],
                };
                assert!(
                    (change / step / slopes[(j, j)] - 1.0).abs() < 1e-4,
                    "{prior:?} {j}"
                );
            }
            assert_eq!(slopes.nrows(), 6);
        }
    }

    #[test]
    fn the_weight_of_an_outlying_test_decreases_with_its_distance() {
        let unknowns = drives(&arm(1.0));
        let tests = tests(&unknowns, &State::typical(&unknowns), 2, 0.0);
        let huber = problem(
            &unknowns,
            &tests,
            Method {
                loss: Loss::Huber,
                ..plain()
            },
        );
        for (length, weight) in [(0.0, 1.0), (1.5, 1.0), (3.0, 0.5), (15.0, 0.1)] {
            assert!((huber.weight(length) - weight).abs() < 1e-15, "{length}");
            assert_eq!(problem(&unknowns, &tests, plain()).weight(length), 1.0);
        }
    }

    #[test]
    fn bent_squares_of_several_readings_are_between_none_and_all_of_their_square() {
        // E min(n^2, k^2) of chi-squared with two degrees of freedom: 2 (1 - exp(-k^2/2)).
        let expected = 2.0 * (1.0 - f64::exp(-1.5 * 1.5 / 2.0));
        assert!((expected_bent_square(2) - expected).abs() < 1e-5);
        assert_eq!(expected_bent_square(0), 0.0);
        let all: Vec<f64> = (1..=6).map(expected_bent_square).collect();
        assert!(
            all.windows(2).all(|pair| pair[0] < pair[1]) && all[5] < BEND * BEND,
            "{all:?}"
        );
    }
}
