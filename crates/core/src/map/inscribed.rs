//! The largest axis-parallel rectangle and the largest circle whose grid points are all within.

use nalgebra::Point2;

use crate::workpiece::Grid;

/// An axis-parallel rectangle in part x and y, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Corner with the least coordinates.
    pub lower: Point2<f64>,
    /// Corner with the greatest coordinates.
    pub upper: Point2<f64>,
}

impl Rectangle {
    /// m^2
    pub fn area(&self) -> f64 {
        (self.upper.x - self.lower.x) * (self.upper.y - self.lower.y)
    }
}

/// A circle in part x and y, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its centre, a grid point.
    pub centre: Point2<f64>,
    /// Its radius.
    pub radius: f64,
}

/// The rectangle of largest area whose grid points, corners included, are all `within`; `None` without a point
/// within. Histogram method: linear in the number of points.
pub(super) fn largest_rectangle(grid: &Grid, within: &[bool]) -> Option<Rectangle> {
    let mut best: Option<Rectangle> = None;
    let mut heights = vec![0usize; grid.columns];
    for row in 0..grid.rows {
        for (column, height) in heights.iter_mut().enumerate() {
            *height = if within[row * grid.columns + column] {
                *height + 1
            } else {
                0
            };
        }
        // Stack of (first column, height) with growing heights.
        let mut stack: Vec<(usize, usize)> = Vec::new();
        for column in 0..=grid.columns {
            let height = heights.get(column).copied().unwrap_or(0);
            let mut first = column;
            while let Some(&(start, tall)) = stack.last().filter(|(_, tall)| *tall > height) {
                stack.pop();
                first = start;
                let rectangle = Rectangle {
                    lower: grid.point((row + 1 - tall) * grid.columns + start),
                    upper: grid.point(row * grid.columns + column - 1),
                };
                if best.is_none_or(|b| rectangle.area() > b.area()) {
                    best = Some(rectangle);
                }
            }
            if height > 0 && stack.last().is_none_or(|(_, tall)| *tall < height) {
                stack.push((first, height));
            }
        }
    }
    best
}

/// The largest circle about a grid point that stays on the grid and one pitch away from every grid point outside, so
/// that the boundary between them is outside the circle; `None` without a point within. Exact distance transform
/// (Felzenszwalb & Huttenlocher 2012), linear in the points.
pub(super) fn largest_disc(grid: &Grid, within: &[bool]) -> Option<Disc> {
    let (columns, rows) = (grid.columns, grid.rows);
    let far = ((columns + rows) as f64).powi(2) * 4.0;
    let mut squared: Vec<f64> = within.iter().map(|w| if *w { far } else { 0.0 }).collect();
    let mut line = vec![0.0; columns.max(rows)];
    for column in 0..columns {
        for row in 0..rows {
            line[row] = squared[row * columns + column];
        }
        let transformed = distance_transform(&line[..rows]);
        for (row, value) in transformed.into_iter().enumerate() {
            squared[row * columns + column] = value;
        }
    }
    for row in 0..rows {
        let transformed = distance_transform(&squared[row * columns..(row + 1) * columns]);
        squared[row * columns..(row + 1) * columns].copy_from_slice(&transformed);
    }
    let steps = |index: usize| {
        let (column, row) = (index % columns, index / columns);
        let edge = column.min(columns - 1 - column).min(row).min(rows - 1 - row);
        (squared[index].sqrt() - 1.0).max(0.0).min(edge as f64)
    };
    let best = (0..grid.len())
        .filter(|i| within[*i])
        .max_by(|a, b| steps(*a).total_cmp(&steps(*b)))?;
    Some(Disc {
        centre: grid.point(best),
        radius: steps(best) * grid.step,
    })
}

/// `d(p) = min_q (p - q)^2 + f(q)` in one dimension: lower envelope of parabolas.
fn distance_transform(f: &[f64]) -> Vec<f64> {
    let mut vertices = vec![0usize];
    let mut starts = vec![f64::NEG_INFINITY];
    let meet = |p: usize, q: usize| {
        let (pf, qf) = (p as f64, q as f64);
        ((f[q] + qf * qf) - (f[p] + pf * pf)) / (2.0 * (qf - pf))
    };
    for q in 1..f.len() {
        while vertices.len() > 1 && meet(vertices[vertices.len() - 1], q) <= starts[starts.len() - 1] {
            vertices.pop();
            starts.pop();
        }
        starts.push(meet(vertices[vertices.len() - 1], q));
        vertices.push(q);
    }
    let mut k = 0;
    (0..f.len())
        .map(|p| {
            while k + 1 < starts.len() && starts[k + 1] < p as f64 {
                k += 1;
            }
            let away = p as f64 - vertices[k] as f64;
            away * away + f[vertices[k]]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pseudo-random field of within/outside.
    fn speckled(grid: &Grid, seed: usize) -> Vec<bool> {
        (0..grid.len())
            .map(|i| (i * 7919 + seed * 104_729) % 23 > 3)
            .collect()
    }

    #[test]
    fn rectangle_agrees_with_exhaustive_search() {
        let grid = Grid {
            columns: 9,
            rows: 7,
            step: 0.1,
        };
        for seed in 0..50 {
            let within = speckled(&grid, seed);
            let mut most = 0.0_f64;
            for (i, j) in (0..grid.len()).flat_map(|i| (0..grid.len()).map(move |j| (i, j))) {
                let (c0, r0, c1, r1) = (
                    i % grid.columns,
                    i / grid.columns,
                    j % grid.columns,
                    j / grid.columns,
                );
                if c0 <= c1 && r0 <= r1 && (r0..=r1).all(|r| (c0..=c1).all(|c| within[r * grid.columns + c]))
                {
                    most = most.max((c1 - c0) as f64 * (r1 - r0) as f64 * 0.01);
                }
            }
            let found = largest_rectangle(&grid, &within).unwrap().area();
            assert!(
                (found - most).abs() < 1e-12,
                "seed {seed}: {found} against {most}"
            );
        }
    }

    #[test]
    fn disc_agrees_with_exhaustive_search() {
        let grid = Grid {
            columns: 17,
            rows: 13,
            step: 0.1,
        };
        for seed in 0..50 {
            let mut within = speckled(&grid, seed);
            for i in [100, 101, 117, 118, 119, 135] {
                within[i] = true;
            }
            let room = |i: usize| {
                let p = grid.point(i);
                let edge = (0.8 - p.x.abs()).min(0.6 - p.y.abs());
                let outside = (0..grid.len()).filter(|j| !within[*j]);
                let nearest = outside.map(|j| ((grid.point(j) - p).norm() - 0.1).max(0.0));
                nearest.fold(edge, f64::min)
            };
            let most = (0..grid.len())
                .filter(|i| within[*i])
                .map(room)
                .fold(0.0, f64::max);
            let found = largest_disc(&grid, &within).unwrap().radius;
            assert!((found - most).abs() < 1e-9, "seed {seed}: {found} against {most}");
        }
    }

    #[test]
    fn without_a_point_within_there_is_no_inscribed_shape() {
        let grid = Grid {
            columns: 4,
            rows: 4,
            step: 0.1,
        };
        assert!(largest_rectangle(&grid, &[false; 16]).is_none());
        assert!(largest_disc(&grid, &[false; 16]).is_none());
    }
}
