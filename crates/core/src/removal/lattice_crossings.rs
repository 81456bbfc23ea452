//! Where the surface crosses the edges of the lattice.
//!
//! Along an edge runs a dexel: its end between both points is the place, exactly. Of several ends the one next to the point in material is
//! used, so that a thin wall beyond it is not seen. Dexels of two directions may differ about a point by rounding: an end is accepted up to [`SLACK`] outside of
//! the edge; where there is none the place is the middle, without an end and without a normal.
//!
//! A part with z dexels alone has no ends along x and y. Between two columns whose ends are less steep than [`STEEPEST`] the surface is a straight line from
//! end to end; otherwise it is a wall in the middle, and on the face of the box next to the outer layer.

use nalgebra::{Point3, Unit, Vector3};

use super::grid::MaterialSpan;
use super::lattice::{Lattice, set_bits};
use super::surface::SurfacePoint;
use super::swept::across;

/// A crossed edge of the lattice.
#[derive(Clone, Debug)]
pub(super) struct Crossing {
    /// Direction of the edge: 0, 1, 2 for x, y, z.
    pub(super) axis: usize,
    /// Column and place in it of the lower point of the edge.
    pub(super) at: [usize; 2],
    /// Whether material begins here, seen along the edge; else it ends.
    pub(super) begins: bool,
    /// Coordinate along the edge, m.
    pub(super) place: f64,
    /// Out of the material.
    pub(super) normal: Option<Unit<Vector3<f64>>>,
    /// The number of its end of a dexel, in the list of the layer.
    pub(super) end: Option<usize>,
}

/// The crossed edges of a layer and those to the next one, with their ends of dexels.
#[derive(Default)]
pub(super) struct LayerCrossings {
    pub(super) crossings: Vec<Crossing>,
    pub(super) ends: Vec<SurfacePoint>,
}

/// How far outside of its edge an end is accepted, of the length of the dexel: rounding to single precision and of the search on corners.
const SLACK: f64 = 1e-6;
/// Steepest slope between two z dexels that is not a wall, height per distance: 72 deg.
const STEEPEST: f64 = 3.0;

/// An edge whose points differ.
#[derive(Clone, Copy)]
struct Edge {
    axis: usize,
    /// Its lower point.
    low: [usize; 3],
    begins: bool,
}

impl Edge {
    /// Points in and out of material.
    fn points(&self) -> [[usize; 3]; 2] {
        let mut high = self.low;
        high[self.axis] += 1;
        if self.begins {
            [high, self.low]
        } else {
            [self.low, high]
        }
    }
}

/// Where an edge is crossed.
struct Found {
    place: f64,
    end: Option<SurfacePoint>,
    /// Of a wall whose end is not known.
    normal: Option<Unit<Vector3<f64>>>,
}

impl Lattice<'_> {
    /// The crossed edges of a layer, in the order of columns and directions, and their normals.
    pub(super) fn crossings(
        &self,
        row: usize,
        normal: impl Fn(&SurfacePoint) -> Option<Unit<Vector3<f64>>>,
    ) -> LayerCrossings {
        let [layer, next] = [row, row + 1].map(|row| self.layer(row));
        let mut found = LayerCrossings::default();
        for column in 0..self.cells()[0] {
            let mut add = |axis: usize, points: &mut dyn Iterator<Item = usize>| {
                for point in points {
                    let edge = Edge {
                        axis,
                        low: [column, row, point],
                        begins: !layer.is_inside(column, point),
                    };
                    found.push(edge, self.on(&edge), &normal);
                }
            };
            add(0, &mut set_bits(layer.changes(column, &layer, column + 1)));
            add(1, &mut set_bits(layer.changes(column, &next, column)));
            add(2, &mut set_bits(layer.changes_along(column)));
        }
        found
    }

    /// Position of a crossing of a layer.
    pub(super) fn position(&self, row: usize, crossing: &Crossing) -> Point3<f64> {
        let [column, point] = crossing.at;
        let mut position = Point3::new(self.places[0][column], self.places[1][row], self.places[2][point]);
        position[crossing.axis] = crossing.place;
        position
    }

    fn on(&self, edge: &Edge) -> Found {
        if self.part.grids().len() == 1 && edge.axis != 2 {
            return self.between_columns(edge);
        }
        self.along_dexel(edge).unwrap_or_else(|| Found {
            place: self.middle(edge),
            end: None,
            normal: None,
        })
    }

    fn middle(&self, edge: &Edge) -> f64 {
        let (places, low) = (&self.places[edge.axis], edge.low[edge.axis]);
        0.5 * (places[low] + places[low + 1])
    }

    /// The material of the dexel along `axis` through a point.
    fn material(&self, axis: usize, point: [usize; 3]) -> impl Iterator<Item = MaterialSpan> {
        let [i, j] = across(axis);
        let grid = self.part.grids().iter().find(|grid| grid.direction() == axis);
        let cell = self.cell(i, point[i]).zip(self.cell(j, point[j]));
        let found = grid.zip(cell);
        found
            .into_iter()
            .flat_map(|(grid, (first, second))| grid.material([first, second]))
    }

    /// The end of the dexel along an edge.
    fn along_dexel(&self, edge: &Edge) -> Option<Found> {
        let (axis, places) = (edge.axis, &self.places[edge.axis]);
        let low = edge.low[axis];
        let [least, most] = [places[low], places[low + 1]];
        let slack = SLACK * (places[places.len() - 1] - places[0]);
        let side = usize::from(!edge.begins);
        let mut inside = self
            .material(axis, edge.low)
            .filter(|span| (least - slack..=most + slack).contains(&span.ends[side]));
        let span = if edge.begins { inside.last() } else { inside.next() }?;
        let end = self.end(axis, edge.low, edge.begins, &span);
        Some(Found {
            place: span.ends[side].clamp(least, most),
            end: Some(end),
            normal: None,
        })
    }

    /// An end of the dexel along `axis` through a point.
    fn end(&self, axis: usize, point: [usize; 3], begins: bool, span: &MaterialSpan) -> SurfacePoint {
        let mut position = Point3::new(
            self.places[0][point[0]],
            self.places[1][point[1]],
            self.places[2][point[2]],
        );
        let side = usize::from(!begins);
        position[axis] = span.ends[side];
        SurfacePoint {
            position,
            direction: axis,
            begins,
            origin: span.origins[side],
        }
    }

    /// An edge across z dexels without dexels along it.
    fn between_columns(&self, edge: &Edge) -> Found {
        let [inside, outside] = edge.points();
        let [from, to] = [inside, outside].map(|point| self.places[edge.axis][point[edge.axis]]);
        let z = self.places[2][edge.low[2]];
        let of_inside = self
            .material(2, inside)
            .find(|span| span.ends[0] <= z && z < span.ends[1]);
        let below = self.material(2, outside).map(|span| span.ends[1]);
        let below = below.filter(|end| *end <= z).last();
        let above = self.material(2, outside).map(|span| span.ends[0]);
        let above = above.filter(|end| *end > z).min_by(f64::total_cmp);
        let slopes = of_inside.and_then(|span| {
            let up = below.map(|end| (span.ends[1] - end, span.ends[1] - z, false));
            let down = above.map(|end| (end - span.ends[0], z - span.ends[0], true));
            let least = up.into_iter().chain(down).min_by(|a, b| a.0.total_cmp(&b.0))?;
            (least.0 <= STEEPEST * (to - from).abs()).then_some((span, least))
        });
        match slopes {
            Some((span, (rise, part, begins))) if rise > 0.0 => Found {
                place: from + (to - from) * (part / rise).clamp(0.0, 1.0),
                end: Some(self.end(2, inside, begins, &span)),
                normal: None,
            },
            _ => {
                let is_outer = self.cell(edge.axis, outside[edge.axis]).is_none();
                Found {
                    place: if is_outer { to } else { self.middle(edge) },
                    end: None,
                    normal: Some(Unit::new_unchecked(Vector3::ith(edge.axis, (to - from).signum()))),
                }
            }
        }
    }
}

impl LayerCrossings {
    fn push(
        &mut self,
        edge: Edge,
        found: Found,
        normal: impl Fn(&SurfacePoint) -> Option<Unit<Vector3<f64>>>,
    ) {
        // The normal of an end of another dexel is not that of this place.
        let own = found.end.filter(|end| end.direction == edge.axis);
        let given = own.and_then(|end| normal(&end));
        let is_finite = |normal: &Unit<Vector3<f64>>| normal.iter().all(|value| value.is_finite());
        let number = found.end.map(|_| self.ends.len());
        self.ends.extend(found.end);
        self.crossings.push(Crossing {
            axis: edge.axis,
            at: [edge.low[0], edge.low[2]],
            begins: edge.begins,
            place: found.place,
            normal: given.filter(is_finite).or(found.normal),
            end: number,
        });
    }
}
