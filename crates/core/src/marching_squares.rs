//! Level lines and areas of a field on a rectilinear grid (marching squares).
//!
//! ```text
//! y[ny-1]  v[(ny-1) nx] ...        v[ny nx - 1]      x and y: the values of the columns and of the rows
//!   ...                                              v: the values of the field at their crossings
//! y[0]     v[0]         v[1]  ...  v[nx - 1]         all results: in the units of x and y
//!          x[0]         x[1]  ...  x[nx - 1]
//! ```
//!
//! Along each side of a cell of four points the field is linear; between the crossings of a level with the sides, lines
//! are straight. A saddle is separated into its two inner corners. A cell with a corner that has no value is omitted: no
//! area is larger than what is known.

use std::collections::BTreeSet;

/// Points that follow each other, in the units of the axes; a closed line repeats its first point.
pub type Polyline = Vec<[f64; 2]>;

/// A quantity at the points of a rectilinear grid. The values are `f64`, or `Option<f64>` with `None` for a point
/// without a value; a value that is not finite is none.
///
/// Below 2 x 2 points, or with a wrong number of values, it has no areas and no lines. Not checked: that each axis
/// rises or falls steadily.
#[derive(Clone, Copy, Debug)]
pub struct ScalarField<'a, V> {
    /// Values of the columns, rising or falling, with steps of any size.
    pub x: &'a [f64],
    /// Values of the rows.
    pub y: &'a [f64],
    /// Row by row, each from the first column to the last.
    pub values: &'a [V],
}

/// A point of a boundary: on the side of a cell, from its inner to its outer grid point, or twice the same grid point.
/// Equal keys are equal points, so that the pieces of neighbouring cells join exactly.
type Vertex = (usize, usize);

/// Two vertices that follow each other, the area to the left where both axes rise.
type Piece = (Vertex, Vertex);

impl<V: Copy + Into<Option<f64>>> ScalarField<'_, V> {
    /// The closed boundaries of the area where the field is at most `level`. Where both axes rise, the area is to their
    /// left: counter-clockwise around it, clockwise around its holes.
    pub fn area_up_to(&self, level: f64) -> Vec<Polyline> {
        self.area(level, |value| value <= level)
    }

    /// The closed boundaries of the area where the field is at least `level`, in the same directions.
    pub fn area_from(&self, level: f64) -> Vec<Polyline> {
        self.area(level, |value| value >= level)
    }

    /// The lines along which the field equals `level`, lower values to the left where both axes rise. Open ones end at
    /// the edge of the grid or at an omitted cell. A saddle is separated as by [`area_from`](Self::area_from).
    pub fn lines_at(&self, level: f64) -> Vec<Polyline> {
        let cuts = self.cuts(|value| value >= level).into_iter();
        self.joined(cuts.map(|(from, to)| (to, from)).collect(), level)
    }

    fn area(&self, level: f64, is_inside: impl Fn(f64) -> bool) -> Vec<Polyline> {
        let mut boundary = self.cuts(&is_inside);
        boundary.append(&mut self.edges(&is_inside));
        self.joined(boundary, level)
    }

    /// The boundary of the values that are inside, across cells: where the field equals the level.
    fn cuts(&self, is_inside: impl Fn(f64) -> bool) -> Vec<Piece> {
        let mut cuts = Vec::new();
        for (_, _, corners) in self.cells() {
            let inside = self.inside(corners, &is_inside);
            // Each run of corners inside, around the cell, is cut off from the others: a saddle has two.
            for start in (0..4).filter(|k| inside[*k] && !inside[(k + 3) % 4]) {
                let mut end = start;
                while inside[(end + 1) % 4] {
                    end = (end + 1) % 4;
                }
                let leave = (corners[end], corners[(end + 1) % 4]);
                let enter = (corners[start], corners[(start + 3) % 4]);
                cuts.push((leave, enter));
            }
        }
        cuts
    }

    /// The boundary of the values that are inside, along the edge of the grid and along omitted cells.
    fn edges(&self, is_inside: impl Fn(f64) -> bool) -> Vec<Piece> {
        let mut edges = Vec::new();
        for (row, column, corners) in self.cells() {
            let inside = self.inside(corners, &is_inside);
            let neighbours = [
                (row.wrapping_sub(1), column),
                (row, column + 1),
                (row + 1, column),
                (row, column.wrapping_sub(1)),
            ];
            for (k, (row, column)) in neighbours.into_iter().enumerate() {
                let next = (k + 1) % 4;
                let (a, b) = (corners[k], corners[next]);
                if !(inside[k] || inside[next]) || self.cell(row, column).is_some() {
                    continue;
                }
                let from = if inside[k] { (a, a) } else { (b, a) };
                let to = if inside[next] { (b, b) } else { (a, b) };
                edges.push((from, to));
            }
        }
        edges
    }

    fn inside(&self, corners: [usize; 4], is_inside: impl Fn(f64) -> bool) -> [bool; 4] {
        corners.map(|point| self.value(point).is_some_and(&is_inside))
    }

    /// The row, the column and the corners of each cell that is not omitted.
    fn cells(&self) -> impl Iterator<Item = (usize, usize, [usize; 4])> {
        let rows = 0..self.y.len();
        let places = rows.flat_map(|row| (0..self.x.len()).map(move |column| (row, column)));
        places.filter_map(|(row, column)| Some((row, column, self.cell(row, column)?)))
    }

    /// The corners of a cell, counter-clockwise from its first column and row; `None` outside the grid and where a
    /// corner has no value.
    fn cell(&self, row: usize, column: usize) -> Option<[usize; 4]> {
        let (nx, ny) = (self.x.len(), self.y.len());
        if column >= nx.saturating_sub(1) || row >= ny.saturating_sub(1) || self.values.len() != nx * ny {
            return None;
        }
        let first = row * nx + column;
        let corners = [first, first + 1, first + 1 + nx, first + nx];
        corners
            .iter()
            .all(|corner| self.value(*corner).is_some())
            .then_some(corners)
    }

    fn value(&self, point: usize) -> Option<f64> {
        self.values[point].into().filter(|value| value.is_finite())
    }

    /// Where a vertex of the boundary at `level` is.
    fn position(&self, (a, b): Vertex, level: f64) -> [f64; 2] {
        let at = |point: usize| [self.x[point % self.x.len()], self.y[point / self.x.len()]];
        let (from, to) = (at(a), at(b));
        let t = match (self.value(a), self.value(b)) {
            (Some(va), Some(vb)) if va != vb => ((level - va) / (vb - va)).clamp(0.0, 1.0),
            _ => 0.0,
        };
        [0, 1].map(|k| from[k] + (to[k] - from[k]) * t)
    }

    /// Joins pieces end to start: open lines first, then closed ones.
    fn joined(&self, pieces: Vec<Piece>, level: f64) -> Vec<Polyline> {
        let ends: BTreeSet<Vertex> = pieces.iter().map(|piece| piece.1).collect();
        let mut remaining: BTreeSet<Piece> = pieces.into_iter().collect();
        let starts: Vec<Vertex> = remaining.iter().map(|piece| piece.0).collect();
        let mut open = starts.into_iter().filter(|start| !ends.contains(start));
        let mut lines = Vec::new();
        while let Some(start) = open.next().or_else(|| Some(remaining.first()?.0)) {
            let mut line = vec![self.position(start, level)];
            let mut here = start;
            while let Some(piece) = remaining.range((here, (0, 0))..).next().copied() {
                if piece.0 != here {
                    break;
                }
                remaining.remove(&piece);
                here = piece.1;
                line.push(self.position(here, level));
                if here == start {
                    break;
                }
            }
            // A level that only touches a single point has no line there.
            if line.iter().any(|at| *at != line[0]) {
                lines.push(line);
            }
        }
        lines
    }
}

/// The area inside closed boundaries, holes left out, in the product of the units of the axes.
pub fn enclosed_area(boundaries: &[Polyline]) -> f64 {
    let sides = boundaries.iter().flat_map(|ring| ring.windows(2));
    let twice: f64 = sides.map(|w| w[0][0] * w[1][1] - w[1][0] * w[0][1]).sum();
    0.5 * twice.abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A grid with its origin at its centre.
    struct Axes {
        x: Vec<f64>,
        y: Vec<f64>,
    }

    impl Axes {
        fn new(columns: usize, rows: usize, step: f64) -> Self {
            let axis = |count: usize| {
                (0..count)
                    .map(|k| (k as f64 - 0.5 * (count as f64 - 1.0)) * step)
                    .collect()
            };
            Self {
                x: axis(columns),
                y: axis(rows),
            }
        }

        fn sampled(&self, f: impl Fn(f64, f64) -> Option<f64>) -> Vec<Option<f64>> {
            let row = |y: &f64| self.x.iter().map(|x| f(*x, *y)).collect::<Vec<_>>();
            self.y.iter().flat_map(row).collect()
        }

        fn field<'a, V>(&'a self, values: &'a [V]) -> ScalarField<'a, V> {
            ScalarField {
                x: &self.x,
                y: &self.y,
                values,
            }
        }

        fn area_up_to(&self, level: f64, f: impl Fn(f64, f64) -> Option<f64>) -> Vec<Polyline> {
            self.field(&self.sampled(f)).area_up_to(level)
        }
    }

    /// 0.8 by 0.6.
    fn axes() -> Axes {
        Axes::new(81, 61, 0.01)
    }

    /// Counter-clockwise positive.
    fn signed_area(ring: &[[f64; 2]]) -> f64 {
        0.5 * ring
            .windows(2)
            .map(|w| w[0][0] * w[1][1] - w[1][0] * w[0][1])
            .sum::<f64>()
    }

    /// The area cell by cell, without the boundary.
    fn area_of_cells(axes: &Axes, values: &[Option<f64>], level: f64) -> f64 {
        let field = axes.field(values);
        let mut area = 0.0;
        for row in 0..axes.y.len() {
            for column in 0..axes.x.len() {
                let Some(corners) = field.cell(row, column) else {
                    continue;
                };
                let cell = Axes {
                    x: axes.x[column..column + 2].to_vec(),
                    y: axes.y[row..row + 2].to_vec(),
                };
                let [a, b, c, d] = corners.map(|corner| values[corner]);
                area += enclosed_area(&cell.field(&[a, b, d, c]).area_up_to(level));
            }
        }
        area
    }

    #[test]
    fn a_disc_has_the_area_of_a_disc_and_one_closed_boundary() {
        let disc = axes().area_up_to(0.2, |x, y| Some(x.hypot(y)));
        // Chords and linear interpolation each pull the boundary in by at most h^2 / 8 r.
        let exact = PI * 0.04;
        let area = enclosed_area(&disc);
        assert!(
            (area / exact - 1.0).abs() < 2.0 * 2.0 * 1e-4 / (8.0 * 0.04),
            "{area} against {exact}"
        );
        assert_eq!(disc.len(), 1);
        assert_eq!(disc[0].first(), disc[0].last());
        assert!(disc[0].iter().all(|[x, y]| (x.hypot(*y) - 0.2).abs() < 1e-3));
    }

    #[test]
    fn the_boundary_is_counter_clockwise_and_encloses_the_areas_of_the_cells() {
        let values = axes().sampled(|x, y| Some(x.abs() + 0.5 * y.abs()));
        let rings = axes().field(&values).area_up_to(0.13);
        assert!((signed_area(&rings[0]) - area_of_cells(&axes(), &values, 0.13)).abs() < 1e-12);
    }

    #[test]
    fn an_area_everywhere_ends_at_the_edge_of_the_grid_and_has_no_line() {
        let values = axes().sampled(|_, _| Some(1.0));
        let all = axes().field(&values).area_up_to(2.0);
        assert!((enclosed_area(&all) - 0.8 * 0.6).abs() < 1e-12);
        assert_eq!(all.len(), 1);
        assert_eq!(all[0].first(), all[0].last());
        assert!(axes().field(&values).lines_at(2.0).is_empty());
        assert!(axes().field(&values).area_from(2.0).is_empty());
    }

    #[test]
    fn points_without_value_are_never_inside() {
        for missing in [None, Some(f64::NAN), Some(f64::INFINITY)] {
            let value = |x: f64| if x > -1e-9 { Some(1.0) } else { missing };
            let half = axes().area_up_to(2.0, |x, _| value(x));
            assert!((enclosed_area(&half) - 0.4 * 0.6).abs() < 1e-12);
        }
        let none = axes().area_up_to(2.0, |_, _| None);
        assert_eq!((enclosed_area(&none), none.len()), (0.0, 0));
    }

    #[test]
    fn a_single_row_and_a_wrong_number_of_values_have_no_area_and_no_line() {
        let row = Axes::new(5, 1, 0.1);
        assert!(row.field(&[1.0; 5]).area_up_to(2.0).is_empty());
        for count in [0, 1, 81, 81 * 61 + 1] {
            let values = vec![1.0; count];
            assert!(axes().field(&values).area_up_to(2.0).is_empty());
            assert!(axes().field(&values).lines_at(1.0).is_empty());
        }
        assert!(Axes::new(0, 0, 0.1).field::<f64>(&[]).area_from(0.0).is_empty());
    }

    #[test]
    fn the_area_of_a_disc_converges_with_the_square_of_the_pitch() {
        let error = |columns: usize| {
            let axes = Axes::new(columns, columns, 1.0 / (columns - 1) as f64);
            // Off the centre of the grid, so that no symmetry helps.
            let disc = axes.area_up_to(0.37, |x, y| Some((x - 0.013).hypot(y + 0.027)));
            (enclosed_area(&disc) / (PI * 0.37 * 0.37) - 1.0).abs()
        };
        let errors = [26, 51, 101, 201].map(error);
        for (k, error) in errors.iter().enumerate() {
            // Chords and linear interpolation: h^2/(8 r^2) each, at h = 0.04 some 3e-3 together.
            assert!(*error < 3e-3 * 0.25_f64.powi(k as i32), "{errors:?}");
        }
    }

    #[test]
    fn a_ring_has_a_boundary_outside_and_one_round_its_hole_the_other_way() {
        let values = axes().sampled(|x, y| Some((x.hypot(y) - 0.2).abs()));
        let ring = axes().field(&values).area_up_to(0.05);
        let (area, exact) = (enclosed_area(&ring), PI * (0.25 * 0.25 - 0.15 * 0.15));
        assert!((area / exact - 1.0).abs() < 5e-3, "{area} {exact}");
        let enclosed: Vec<f64> = ring.iter().map(|ring| signed_area(ring)).collect();
        assert_eq!(enclosed.len(), 2, "{enclosed:?}");
        assert!(enclosed.iter().any(|area| *area > 0.19) && enclosed.iter().any(|area| *area < -0.06));
        assert!((area - area_of_cells(&axes(), &values, 0.05)).abs() < 1e-12);
    }

    #[test]
    fn turned_and_mirrored_fields_have_the_same_area() {
        let axes = Axes::new(41, 41, 0.02);
        let uneven = |x: f64, y: f64| (3.0 * x + 0.4).sin() + (5.0 * y * x - y).cos();
        let area = |turn: fn(f64, f64) -> [f64; 2]| {
            let turned = |x, y| {
                let [x, y] = turn(x, y);
                Some(uneven(x, y))
            };
            enclosed_area(&axes.area_up_to(0.9, turned))
        };
        let here = area(|x, y| [x, y]);
        assert!(here > 0.1);
        for there in [area(|x, y| [-y, x]), area(|x, y| [-x, -y]), area(|x, y| [x, -y])] {
            // Saddles are separated in both orientations.
            assert!((there - here).abs() < 1e-12, "{here} {there}");
        }
    }

    #[test]
    fn areas_up_to_and_from_a_level_add_up_to_the_grid_without_saddles() {
        let values = axes().sampled(|x, y| Some(x + 0.3 * y));
        let (axes, values) = (axes(), values);
        let field = axes.field(&values);
        for level in [-0.3, 0.0, 0.111] {
            let both = enclosed_area(&field.area_up_to(level)) + enclosed_area(&field.area_from(level));
            assert!((both - 0.8 * 0.6).abs() < 1e-12, "{level}: {both}");
        }
        let areas = [-0.5, -0.2, 0.0, 0.2, 0.5].map(|level| enclosed_area(&field.area_up_to(level)));
        assert!(areas.windows(2).all(|pair| pair[0] <= pair[1]), "{areas:?}");
    }

    #[test]
    fn a_line_passes_where_the_field_equals_the_level() {
        // 0, 1, 3 at 0, 10, 30: level 2 is half-way between 10 and 30.
        for falling in [false, true] {
            let mut axes = Axes {
                x: vec![0.0, 10.0, 30.0],
                y: vec![0.0, 5.0],
            };
            let mut values = [0.0, 1.0, 3.0, 0.0, 1.0, 3.0];
            if falling {
                axes.x.reverse();
                values.reverse();
            }
            let lines = axes.field(&values).lines_at(2.0);
            assert_eq!(lines.len(), 1);
            assert!(lines[0].iter().all(|p| (p[0] - 20.0).abs() < 1e-12), "{lines:?}");
            let ends = [lines[0][0][1], lines[0][lines[0].len() - 1][1]];
            assert!(
                ends == [0.0, 5.0] || ends == [5.0, 0.0],
                "from edge to edge: {ends:?}"
            );
            assert!((enclosed_area(&axes.field(&values).area_from(2.0)) - 50.0).abs() < 1e-12);
        }
    }

    #[test]
    fn lines_close_around_a_summit_and_end_where_values_are_missing() {
        let summit = |x: f64, y: f64| Some(-x.hypot(y));
        let lines = axes().field(&axes().sampled(summit)).lines_at(-0.2);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        assert!(
            (signed_area(&lines[0]) + PI * 0.04).abs() < 1e-3,
            "lower values to the left"
        );
        let half = axes().sampled(|x, y| summit(x, y).filter(|_| y > -1e-9));
        let lines = axes().field(&half).lines_at(-0.2);
        assert_eq!(lines.len(), 1);
        let ends = [lines[0][0], lines[0][lines[0].len() - 1]];
        assert!(ends.iter().all(|end| end[1].abs() < 1e-9), "{ends:?}");
    }

    #[test]
    fn the_lines_of_a_saddle_do_not_cross() {
        // The saddle is the middle of the cell in the middle.
        let axes = Axes::new(22, 22, 200.0 / 21.0);
        let lines = axes.field(&axes.sampled(|x, y| Some(x * y))).lines_at(1.0);
        assert_eq!(lines.len(), 2);
        for line in lines {
            let side = line[0][0].signum();
            assert!(
                line.iter().all(|[x, y]| x * side > 0.0 && y * side > 0.0),
                "{line:?}"
            );
        }
    }
}
