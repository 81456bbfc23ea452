//! The area below a level on a grid, and its boundary: linear between neighbouring points.
//!
//! Each cell of four points becomes the polygon where the values, linear along its sides, stay within the
//! level. A cell with a corner that has no value is left out: the region is never larger than what was reached. Saddles
//! are separated into their two corners.

use nalgebra::Point2;

use crate::workpiece::Grid;

/// What [`within_level`] finds.
pub(super) struct Within {
    /// m^2
    pub area: f64,
    /// Closed or open polylines, m, part x and y; the region is to their left.
    pub boundary: Vec<Vec<Point2<f64>>>,
}

/// A point of the boundary: on the side of a cell between two grid points, `from` within. Equal keys are equal
/// points, so pieces of neighbouring cells join exactly.
type Crossing = (usize, usize);

/// The part of the grid where `values` (by grid index) are at most `level`.
pub(super) fn within_level(grid: &Grid, values: &[Option<f64>], level: f64) -> Within {
    let mut area = 0.0;
    let mut pieces: Vec<(Crossing, Crossing)> = Vec::new();
    let place = |(a, b): Crossing| -> Point2<f64> {
        if a == b {
            return grid.point(a);
        }
        let (va, vb) = (values[a].unwrap_or(level), values[b].unwrap_or(level));
        // The sum over a cell's polygon must not depend on the direction of its sides.
        let t = if vb == va {
            0.5
        } else {
            ((level - va) / (vb - va)).clamp(0.0, 1.0)
        };
        grid.point(a) + (grid.point(b) - grid.point(a)) * t
    };
    let inside = |i: usize| values[i].is_some_and(|v| v <= level);
    for row in 0..grid.rows.saturating_sub(1) {
        for column in 0..grid.columns.saturating_sub(1) {
            let first = row * grid.columns + column;
            // Counter-clockwise from the corner with the least coordinates.
            let corners = [first, first + 1, first + 1 + grid.columns, first + grid.columns];
            if corners.iter().any(|c| values[*c].is_none()) {
                continue;
            }
            let within = corners.map(inside);
            match within.iter().filter(|w| **w).count() {
                0 => {}
                4 => area += grid.step * grid.step,
                2 if within[0] == within[2] => {
                    for corner in (0..4).filter(|corner| within[*corner]) {
                        area += cut(&corners, corner, corner, &place, &mut pieces);
                    }
                }
                _ => {
                    let start = (0..4).find(|c| within[*c] && !within[(c + 3) % 4]).unwrap_or(0);
                    let mut end = start;
                    while within[(end + 1) % 4] {
                        end = (end + 1) % 4;
                    }
                    area += cut(&corners, start, end, &place, &mut pieces);
                }
            }
        }
    }
    outline(grid, &inside, values, &mut pieces);
    Within {
        area,
        boundary: chains(pieces)
            .into_iter()
            .map(|c| c.into_iter().map(&place).collect())
            .collect(),
    }
}

/// The polygon of the corners `start..=end` (round the cell) with its two crossings: its area; its cut side is added to
/// `pieces`, region to the left.
fn cut(
    corners: &[usize; 4],
    start: usize,
    end: usize,
    place: &impl Fn(Crossing) -> Point2<f64>,
    pieces: &mut Vec<(Crossing, Crossing)>,
) -> f64 {
    let leave = (corners[end], corners[(end + 1) % 4]);
    let enter = (corners[start], corners[(start + 3) % 4]);
    pieces.push((leave, enter));
    let mut polygon = vec![place(enter)];
    let mut corner = start;
    loop {
        polygon.push(place((corners[corner], corners[corner])));
        if corner == end {
            break;
        }
        corner = (corner + 1) % 4;
    }
    polygon.push(place(leave));
    let next = polygon.iter().cycle().skip(1);
    0.5 * polygon
        .iter()
        .zip(next)
        .map(|(a, b)| a.x * b.y - b.x * a.y)
        .sum::<f64>()
}

/// Sides of the region along the edge of the grid, or along cells that were left out.
fn outline(
    grid: &Grid,
    inside: &impl Fn(usize) -> bool,
    values: &[Option<f64>],
    pieces: &mut Vec<(Crossing, Crossing)>,
) {
    let (columns, rows) = (grid.columns, grid.rows);
    let cell = |row: isize, column: isize| -> bool {
        if row < 0 || column < 0 || row as usize + 1 >= rows || column as usize + 1 >= columns {
            return false;
        }
        let first = row as usize * columns + column as usize;
        [first, first + 1, first + columns, first + columns + 1]
            .iter()
            .all(|c| values[*c].is_some())
    };
    let mut side = |a: usize, b: usize| match (inside(a), inside(b)) {
        (true, true) => pieces.push(((a, a), (b, b))),
        (true, false) => pieces.push(((a, a), (a, b))),
        (false, true) => pieces.push(((b, a), (b, b))),
        (false, false) => {}
    };
    for row in 0..rows as isize {
        for column in 0..columns as isize {
            let at = row as usize * columns + column as usize;
            if column as usize + 1 < columns {
                match (cell(row, column), cell(row - 1, column)) {
                    (true, false) => side(at, at + 1),
                    (false, true) => side(at + 1, at),
                    _ => {}
                }
            }
            if (row as usize) + 1 < rows {
                match (cell(row, column), cell(row, column - 1)) {
                    (true, false) => side(at + columns, at),
                    (false, true) => side(at, at + columns),
                    _ => {}
                }
            }
        }
    }
}

/// Joins pieces end to start into polylines; a closed one repeats its first point.
fn chains(pieces: Vec<(Crossing, Crossing)>) -> Vec<Vec<Crossing>> {
    use std::collections::BTreeMap;
    let mut from: BTreeMap<Crossing, Vec<Crossing>> = BTreeMap::new();
    let mut arriving: BTreeMap<Crossing, usize> = BTreeMap::new();
    for (a, b) in pieces {
        from.entry(a).or_default().push(b);
        *arriving.entry(b).or_default() += 1;
    }
    let mut chains = Vec::new();
    let open: Vec<Crossing> = from
        .keys()
        .filter(|k| !arriving.contains_key(k))
        .copied()
        .collect();
    let mut starts = open.into_iter();
    while let Some(start) = starts.next().or_else(|| from.keys().next().copied()) {
        let mut chain = vec![start];
        let mut here = start;
        while let Some(nexts) = from.get_mut(&here) {
            let Some(next) = nexts.pop() else { break };
            if nexts.is_empty() {
                from.remove(&here);
            }
            chain.push(next);
            here = next;
            if here == start {
                break;
            }
        }
        chains.push(chain);
    }
    chains
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid {
            columns: 81,
            rows: 61,
            step: 0.01,
        }
    }

    fn field(f: impl Fn(Point2<f64>) -> Option<f64>) -> Vec<Option<f64>> {
        (0..grid().len()).map(|i| f(grid().point(i))).collect()
    }

    #[test]
    fn a_disc_has_the_area_of_a_disc_and_one_closed_boundary() {
        let within = within_level(&grid(), &field(|p| Some(p.coords.norm())), 0.2);
        // Chords and linear interpolation each pull the boundary in by at most h^2 / 8 r.
        let exact = std::f64::consts::PI * 0.04;
        assert!(
            (within.area / exact - 1.0).abs() < 2.0 * 2.0 * 1e-4 / (8.0 * 0.04),
            "{} against {exact}",
            within.area
        );
        assert_eq!(within.boundary.len(), 1);
        let ring = &within.boundary[0];
        assert_eq!(ring.first(), ring.last());
        assert!(ring.iter().all(|p| (p.coords.norm() - 0.2).abs() < 1e-3));
    }

    #[test]
    fn boundary_encloses_the_area_counter_clockwise() {
        let within = within_level(&grid(), &field(|p| Some(p.x.abs() + 0.5 * p.y.abs())), 0.13);
        let ring = &within.boundary[0];
        let enclosed = 0.5
            * ring
                .windows(2)
                .map(|w| w[0].x * w[1].y - w[1].x * w[0].y)
                .sum::<f64>();
        assert!((enclosed - within.area).abs() < 1e-12);
    }

    #[test]
    fn everything_within_gives_the_edge_of_the_grid() {
        let within = within_level(&grid(), &field(|_| Some(1.0)), 2.0);
        assert!((within.area - 0.8 * 0.6).abs() < 1e-12);
        assert_eq!(within.boundary.len(), 1);
        assert_eq!(within.boundary[0].first(), within.boundary[0].last());
    }

    #[test]
    fn points_without_value_are_never_inside() {
        let half = within_level(&grid(), &field(|p| (p.x > -1e-9).then_some(1.0)), 2.0);
        assert!((half.area - 0.4 * 0.6).abs() < 1e-12);
        let none = within_level(&grid(), &field(|_| None), 2.0);
        assert_eq!((none.area, none.boundary.len()), (0.0, 0));
    }

    #[test]
    fn a_single_row_of_points_has_no_area() {
        let line = Grid {
            columns: 5,
            rows: 1,
            step: 0.1,
        };
        assert_eq!(within_level(&line, &[Some(1.0); 5], 2.0).area, 0.0);
    }

    #[test]
    fn the_area_of_a_disc_converges_with_the_square_of_the_pitch() {
        let error = |columns: usize| {
            let grid = Grid {
                columns,
                rows: columns,
                step: 1.0 / (columns - 1) as f64,
            };
            // Off the centre of the grid, so that no symmetry helps.
            let away = |p: Point2<f64>| (p - Point2::new(0.013, -0.027)).norm();
            let values: Vec<_> = (0..grid.len()).map(|i| Some(away(grid.point(i)))).collect();
            let exact = std::f64::consts::PI * 0.37 * 0.37;
            (within_level(&grid, &values, 0.37).area / exact - 1.0).abs()
        };
        let errors = [26, 51, 101, 201].map(error);
        for (k, error) in errors.iter().enumerate() {
            // Chords and linear interpolation: h^2/(8 r^2) each, at h = 0.04 some 3e-3 together.
            assert!(*error < 3e-3 * 0.25_f64.powi(k as i32), "{errors:?}");
        }
    }

    #[test]
    fn a_ring_has_a_boundary_outside_and_one_round_its_hole_the_other_way() {
        let ring = within_level(&grid(), &field(|p| Some((p.coords.norm() - 0.2).abs())), 0.05);
        let exact = std::f64::consts::PI * (0.25 * 0.25 - 0.15 * 0.15);
        assert!((ring.area / exact - 1.0).abs() < 5e-3, "{} {exact}", ring.area);
        let enclosed: Vec<f64> = ring
            .boundary
            .iter()
            .map(|ring| {
                0.5 * ring
                    .windows(2)
                    .map(|w| w[0].x * w[1].y - w[1].x * w[0].y)
                    .sum::<f64>()
            })
            .collect();
        assert_eq!(enclosed.len(), 2, "{enclosed:?}");
        assert!(enclosed.iter().any(|area| *area > 0.19) && enclosed.iter().any(|area| *area < -0.06));
        assert!((enclosed.iter().sum::<f64>() - ring.area).abs() < 1e-12);
    }

    #[test]
    fn turned_and_mirrored_fields_have_the_same_area() {
        let grid = Grid {
            columns: 41,
            rows: 41,
            step: 0.02,
        };
        let uneven = |p: Point2<f64>| (3.0 * p.x + 0.4).sin() + (5.0 * p.y * p.x - p.y).cos();
        let area = |turn: fn(Point2<f64>) -> Point2<f64>| {
            let values: Vec<_> = (0..grid.len())
                .map(|i| Some(uneven(turn(grid.point(i)))))
                .collect();
            within_level(&grid, &values, 0.9).area
        };
        let here = area(|p| p);
        assert!(here > 0.1);
        for there in [
            area(|p| Point2::new(-p.y, p.x)),
            area(|p| Point2::new(-p.x, -p.y)),
            area(|p| Point2::new(p.x, -p.y)),
        ] {
            // Saddles are separated in both orientations.
            assert!((there - here).abs() < 1e-12, "{here} {there}");
        }
    }

    #[test]
    fn areas_within_and_beyond_a_level_add_up_to_the_grid_without_saddles() {
        let values = field(|p| Some(p.x + 0.3 * p.y));
        let beyond: Vec<_> = values.iter().map(|v| v.map(|v| -v)).collect();
        for level in [-0.3, 0.0, 0.111] {
            let both =
                within_level(&grid(), &values, level).area + within_level(&grid(), &beyond, -level).area;
            assert!((both - 0.8 * 0.6).abs() < 1e-12, "{level}: {both}");
        }
        let areas = [-0.5, -0.2, 0.0, 0.2, 0.5].map(|level| within_level(&grid(), &values, level).area);
        assert!(areas.windows(2).all(|pair| pair[0] <= pair[1]), "{areas:?}");
    }
}
