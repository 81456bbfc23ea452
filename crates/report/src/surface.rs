//! A grid made fine enough to draw: monotone cubic between the points, so that no extremum appears that the points do
//! not have.
//!
//! Values: piecewise cubic Hermite along rows, then along columns, slopes after Fritsch and Butland (1984): exact at
//! the points, and on each lattice line never outside the two neighbouring values. Points without a value are filled
//! from their neighbours first and masked afterwards; what is reached is known bilinearly, half-way between a point
//! inside and a point outside.
//!
//! For a smooth field on a grid of equal steps h the error between the points goes with h^3, and with h^2 next to an
//! extremum, where the slope is set to zero.

use armill_core::marching_squares::ScalarField;

use crate::axis::extent;
use crate::grid::{Grid, PointState};

/// Fine steps along the longer side of a picture.
pub(crate) const FINE: usize = 180;

/// Samples on a fine lattice, row by row from the bottom; the given points are among them.
pub(crate) struct Surface {
    /// The axes, each step of the grid cut into equal parts.
    pub(crate) horizontal_mm: Vec<f64>,
    pub(crate) vertical_mm: Vec<f64>,
    /// A value everywhere: where nothing is reached, one carried on from the neighbours.
    pub(crate) value_um: Vec<f64>,
    /// 1 where reached, 0 where not; the zone ends at one half.
    pub(crate) reached: Vec<f64>,
}

impl Surface {
    /// A grid that passed [`Grid::obstacle`], refined to about `steps` steps along its longer side; each step
    /// of the grid is cut into 1 to 48.
    pub(crate) fn refine(grid: &Grid, steps: usize) -> Self {
        let (nx, ny) = (grid.horizontal_mm.len(), grid.vertical_mm.len());
        let factor = steps.div_ceil(nx.max(ny).saturating_sub(1).max(1)).clamp(1, 48);
        let state = |test: fn(PointState) -> bool| -> Vec<f64> {
            grid.points
                .iter()
                .map(|p| if test(*p) { 1.0 } else { 0.0 })
                .collect()
        };
        let values = filled(grid);
        Self {
            horizontal_mm: subdivided(&grid.horizontal_mm, factor),
            vertical_mm: subdivided(&grid.vertical_mm, factor),
            value_um: spread(&values, grid, factor, Between::Monotone),
            reached: spread(
                &state(|p| p.value_um().is_some()),
                grid,
                factor,
                Between::Straight,
            ),
        }
    }

    /// The values.
    pub(crate) fn field(&self) -> ScalarField<'_, f64> {
        ScalarField {
            x: &self.horizontal_mm,
            y: &self.vertical_mm,
            values: &self.value_um,
        }
    }

    /// Whether the sample nearest to a point in mm is reached; points outside are not.
    pub(crate) fn is_reached_at(&self, mm: [f64; 2]) -> bool {
        let nearest = |values: &[f64], v: f64| {
            let falling = values.first() > values.last();
            let after = values.partition_point(|x| if falling { *x > v } else { *x < v });
            (after > 0 || values.first() == Some(&v))
                .then_some(after)
                .filter(|k| *k < values.len())
        };
        match (
            nearest(&self.horizontal_mm, mm[0]),
            nearest(&self.vertical_mm, mm[1]),
        ) {
            (Some(i), Some(j)) => self.reached[j * self.horizontal_mm.len() + i] > 0.5,
            _ => false,
        }
    }
}

/// How values run between two points.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Between {
    Straight,
    Monotone,
}

/// Values with the gaps closed ring by ring from the known neighbours: two rings carried on straight, the rest by their
/// mean.
fn filled(grid: &Grid) -> Vec<f64> {
    const STRAIGHT_RINGS: usize = 2;
    let (nx, ny) = (grid.horizontal_mm.len(), grid.vertical_mm.len());
    let mut known: Vec<Option<f64>> = grid.points.iter().map(|p| p.value_um()).collect();
    for ring in 0..nx.max(ny) {
        if known.iter().all(Option::is_some) {
            break;
        }
        let before = known.clone();
        let at = |i: isize, j: isize| {
            let inside = (0..nx as isize).contains(&i) && (0..ny as isize).contains(&j);
            if inside {
                before[j as usize * nx + i as usize]
            } else {
                None
            }
        };
        for (k, value) in known.iter_mut().enumerate().filter(|(_, v)| v.is_none()) {
            let (i, j) = ((k % nx) as isize, (k / nx) as isize);
            let around = [
                (1, 0),
                (-1, 0),
                (0, 1),
                (0, -1),
                (1, 1),
                (1, -1),
                (-1, 1),
                (-1, -1),
            ];
            let straight = around.iter().filter_map(|(a, b)| {
                Some(2.0 * at(i + a, j + b)? - at(i + 2 * a, j + 2 * b)?).filter(|_| ring < STRAIGHT_RINGS)
            });
            let next = around.iter().filter_map(|(a, b)| at(i + a, j + b));
            // Carried on, but not beyond the neighbours: no tolerance is crossed where no point crosses it.
            let (low, high) = extent(next.clone()).unwrap_or((0.0, 0.0));
            *value = mean(straight).map(|v| v.clamp(low, high)).or_else(|| mean(next));
        }
    }
    known.into_iter().map(|v| v.unwrap_or(0.0)).collect()
}

/// The mean; `None` of nothing.
fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (count, sum) = values.fold((0, 0.0), |(n, s), v| (n + 1, s + v));
    (count > 0).then(|| sum / f64::from(count))
}

/// An axis with each of its steps cut into `factor` equal parts.
fn subdivided(values: &[f64], factor: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(values.len() * factor);
    for w in values.windows(2) {
        out.extend((0..factor).map(|k| w[0] + (w[1] - w[0]) * k as f64 / factor as f64));
    }
    out.extend(values.last());
    out
}

/// Samples of the points on the fine lattice: along each row first, then along each fine column.
fn spread(values: &[f64], grid: &Grid, factor: usize, between: Between) -> Vec<f64> {
    let nx = grid.horizontal_mm.len();
    let rows: Vec<Vec<f64>> = values
        .chunks(nx)
        .map(|row| interpolated(&grid.horizontal_mm, row, factor, between))
        .collect();
    let fine_nx = rows.first().map_or(0, Vec::len);
    let columns: Vec<Vec<f64>> = (0..fine_nx)
        .map(|i| {
            let column: Vec<f64> = rows.iter().map(|row| row[i]).collect();
            interpolated(&grid.vertical_mm, &column, factor, between)
        })
        .collect();
    let fine_ny = columns.first().map_or(0, Vec::len);
    (0..fine_ny)
        .flat_map(|j| columns.iter().map(move |c| c[j]))
        .collect()
}

/// Values `y` at `x`, filled up to `factor` parts a step:
/// `y(t) = (2 t³ - 3 t² + 1) y₀ + (3 t² - 2 t³) y₁ + h ((t³ - 2 t² + t) m₀ + (t³ - t²) m₁)` with the slopes
/// `m`, or straight.
fn interpolated(x: &[f64], y: &[f64], factor: usize, between: Between) -> Vec<f64> {
    let slopes = match between {
        Between::Straight => Vec::new(),
        Between::Monotone => monotone_slopes(x, y),
    };
    let mut out = Vec::with_capacity(y.len() * factor);
    for k in 0..y.len().saturating_sub(1) {
        let h = x[k + 1] - x[k];
        for m in 0..factor {
            let t = m as f64 / factor as f64;
            out.push(match between {
                Between::Straight => y[k] + (y[k + 1] - y[k]) * t,
                Between::Monotone => {
                    let (t2, t3) = (t * t, t * t * t);
                    let from_values = (2.0 * t3 - 3.0 * t2 + 1.0) * y[k] + (3.0 * t2 - 2.0 * t3) * y[k + 1];
                    from_values + h * ((t3 - 2.0 * t2 + t) * slopes[k] + (t3 - t2) * slopes[k + 1])
                }
            });
        }
    }
    out.extend(y.last());
    out
}

/// Slopes at the points: zero at an extremum, else a weighted harmonic mean of the two secants; one-sided and
/// limited at the ends. Two points make a straight line.
fn monotone_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = y.len();
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let secant: Vec<f64> = (0..n - 1).map(|k| (y[k + 1] - y[k]) / h[k]).collect();
    if n == 2 {
        return vec![secant[0]; 2];
    }
    let mut slope = vec![0.0; n];
    for k in 1..n - 1 {
        if secant[k - 1] * secant[k] > 0.0 {
            let (a, b) = (2.0 * h[k] + h[k - 1], h[k] + 2.0 * h[k - 1]);
            slope[k] = (a + b) / (a / secant[k - 1] + b / secant[k]);
        }
    }
    slope[0] = end_slope([h[0], h[1]], [secant[0], secant[1]]);
    slope[n - 1] = end_slope([h[n - 2], h[n - 3]], [secant[n - 2], secant[n - 3]]);
    slope
}

/// Slope at an end from the two steps and secants next to it, the nearer first: that of the parabola through
/// three points, zero where it would turn the wrong way, and at most three times the nearer secant where the two
/// differ in sign.
fn end_slope(h: [f64; 2], secant: [f64; 2]) -> f64 {
    let slope = ((2.0 * h[0] + h[1]) * secant[0] - h[0] * secant[1]) / (h[0] + h[1]);
    if slope * secant[0] <= 0.0 {
        0.0
    } else if secant[0] * secant[1] < 0.0 && slope.abs() > 3.0 * secant[0].abs() {
        3.0 * secant[0]
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(values: [f64; 9]) -> Grid {
        Grid {
            horizontal_mm: vec![200.0, 0.0, -150.0],
            vertical_mm: vec![0.0, 100.0, 300.0],
            points: values
                .into_iter()
                .map(|v| {
                    if v.is_nan() {
                        PointState::Unreachable
                    } else {
                        PointState::Reached(v)
                    }
                })
                .collect(),
        }
    }

    #[test]
    fn grid_points_keep_their_values() {
        let values = [1.0, 5.0, 2.0, 7.0, 3.0, 9.0, 4.0, 4.0, 8.0];
        let s = Surface::refine(&grid(values), 8);
        let n = s.horizontal_mm.len();
        assert_eq!(n, 9);
        for (k, v) in values.into_iter().enumerate() {
            let fine = (k / 3) * 4 * n + (k % 3) * 4;
            assert!((s.value_um[fine] - v).abs() < 1e-12);
        }
    }

    #[test]
    fn no_extremum_is_invented() {
        let values = [0.0, 0.0, 10.0, 0.0, 10.0, 10.0, 0.0, 0.0, 10.0];
        let s = Surface::refine(&grid(values), 60);
        assert!(s.value_um.iter().all(|v| (-1e-9..=10.0 + 1e-9).contains(v)));
    }

    #[test]
    fn a_plane_stays_a_plane() {
        let mut g = grid([0.0; 9]);
        for j in 0..3 {
            for i in 0..3 {
                g.points[3 * j + i] = PointState::Reached(0.1 * g.horizontal_mm[i] - 0.3 * g.vertical_mm[j]);
            }
        }
        let s = Surface::refine(&g, 20);
        let n = s.horizontal_mm.len();
        for (k, v) in s.value_um.iter().enumerate() {
            let expected = 0.1 * s.horizontal_mm[k % n] - 0.3 * s.vertical_mm[k / n];
            assert!((v - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn filling_a_gap_does_not_leave_the_range_of_the_points() {
        let values = [9.0, 6.0, 3.0, 9.0, 6.0, f64::NAN, 9.0, f64::NAN, f64::NAN];
        let s = Surface::refine(&grid(values), 60);
        assert!(s.value_um.iter().all(|v| (3.0 - 1e-9..=9.0 + 1e-9).contains(v)));
    }

    #[test]
    fn a_gap_is_filled_but_marked() {
        let s = Surface::refine(&grid([2.0, 2.0, 2.0, 2.0, f64::NAN, 2.0, 2.0, 2.0, 2.0]), 8);
        assert!(s.value_um.iter().all(|v| (v - 2.0).abs() < 1e-12));
        assert!(s.reached.iter().any(|r| *r < 0.5));
    }
}
