//! Deviation of the surface of a part from the nominal surface, along its normal.
//!
//! ```text
//! e = (s_part - s_nominal) n_k          the distance of the nominal point from the part, where |e| is above half a cell
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s_nominal`, `s_part` | end of material of the nominal part and of the part on one dexel: the nearest on the same side of material | m |
//! | `k` | direction of the dexel | - |
//! | `n` | nominal normal, out of the material | - |
//! | `e` | deviation: positive where material is left, negative where too much is removed | m |
//!
//! Each piece of surface is seen by the dexels that meet it most steeply (`|n_k|` is the largest component), so every point stands for an area of a cell over `|n_k|`. Dexels
//! along z alone see what is at most 54.7 deg from horizontal.
//!
//! On a plane `e` is exact. On a surface with the radius of curvature `R` its error is `e^2 tan^2(54.7 deg) / (2 R)` at most. Near an edge, where the edge of the part is on the other side of a dexel, it is the least distance from the planes of the ends near it.
//!
//! Normals: of a path that of the tool that made the point, of a mesh that of its triangle.
//!
//! Source: \[derived\].

use nalgebra::{Point3, Unit, Vector3};
use rayon::prelude::*;

use super::faces::{Faces, MadePart};
use super::nearest::{NearEnd, ends_within, nearest_end};
use crate::removal::{EndOrigin, MaterialSpan, SurfacePoint};
use crate::watch::{Cancelled, Watch};

/// Least steepness of a dexel for the deviation at its end: `|n_k|` of the steepest of three is 0.577 at least.
const LEAST_STEEPNESS: f64 = 0.35;

/// A point of the nominal surface, and the part there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceDeviation {
    /// On the nominal surface, m.
    pub position: Point3<f64>,
    /// Nominal normal, out of the material.
    pub normal: Unit<Vector3<f64>>,
    /// Distance of the part from it along the normal, m; positive where material is left.
    pub deviation: f64,
    /// The surface of the part: on the same dexel, or at the deviation along the normal where that is above half a cell; m.
    pub on_part: Point3<f64>,
    /// Whether the surface of the part there is of the same face: not the wall that covers an edge of a floor.
    pub is_same_face: bool,
    /// Direction of the dexel: 0, 1, 2 for x, y, z.
    pub direction: usize,
    /// Area that it stands for, m^2.
    pub area: f64,
    /// What made the surface of the part: the number of a move, or the stock.
    pub made_by: EndOrigin,
    /// What made the nominal surface there.
    pub nominal_by: EndOrigin,
}

/// The part at a point of the nominal surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointDeviation {
    /// Distance of the part from the point along the normal, m; positive where material is left.
    pub deviation: f64,
    /// What made the surface of the part: the number of a move, or the stock.
    pub made_by: EndOrigin,
}

/// The surface of a part, compared with the nominal one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceComparison {
    /// By grid, row and cell.
    pub points: Vec<SurfaceDeviation>,
    /// Nominal area without a surface of the part within reach, m^2.
    pub missing_area: f64,
}

/// How far from the nominal surface the part is searched, and the cell; m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchReach {
    /// Farther away the surface is missing.
    pub most: f64,
    /// Size of a cell.
    pub cell: f64,
}

/// A part and the nominal one on the same raster.
#[derive(Clone, Debug)]
pub struct PartComparison<'a> {
    part: MadePart<'a>,
    nominal: MadePart<'a>,
    /// Those of the part and of the nominal part.
    faces: [Faces<'a>; 2],
    reach: SearchReach,
}

/// What was found at a point of the nominal surface.
struct Found {
    /// m
    deviation: f64,
    /// The end of the part on the dexel, m; `None` where the deviation is not that along the dexel.
    on_dexel: Option<f64>,
    /// What made the surface of the part.
    made_by: EndOrigin,
    is_same_face: bool,
}

/// Least cosine between the normals of one face.
const SAME_FACE: f64 = 0.87;

/// Half the diagonal of a cell, and a little more for steep surfaces; in cells.
const ASIDE: f64 = 0.9;

impl<'a> PartComparison<'a> {
    /// # Panics
    /// If the two have different directions of dexels.
    pub fn new(part: MadePart<'a>, nominal: MadePart<'a>, reach: SearchReach) -> PartComparison<'a> {
        let grids = [part, nominal].map(|made| made.dexels.grids().len());
        assert_eq!(grids[0], grids[1], "the same directions");
        PartComparison {
            faces: [part, nominal].map(|made| Faces::of(&made)),
            part,
            nominal,
            reach,
        }
    }

    /// All points of the nominal surface. Of a nominal part that moves make, only what they make is compared; of a solid all of its surface.
    ///
    /// # Errors
    /// [`Cancelled`] if the watch cancels.
    pub fn surface(&self, watch: Watch<'_>) -> Result<SurfaceComparison, Cancelled> {
        let mut found = SurfaceComparison::default();
        for (number, grid) in self.nominal.dexels.grids().iter().enumerate() {
            let rows = (0..grid.cells()[1]).into_par_iter();
            let rows: Result<Vec<SurfaceComparison>, Cancelled> = rows
                .map(|row| match watch.is_cancelled() {
                    true => Err(Cancelled),
                    false => Ok(self.row(number, row)),
                })
                .collect();
            for row in rows? {
                found.points.extend(row.points);
                found.missing_area += row.missing_area;
            }
        }
        Ok(found)
    }

    /// The normal of the nominal surface at one of its points; `None` where there is none.
    pub fn nominal_normal(&self, point: &SurfacePoint) -> Option<Unit<Vector3<f64>>> {
        self.faces[1].normal(point)
    }

    /// The deviation at a point of the nominal surface; `None` where the surface is not made, its dexel meets it too flatly, or no surface of the part is within reach.
    pub fn deviation_at(&self, point: &SurfacePoint) -> Option<PointDeviation> {
        if !self.faces[1].is_made(point.origin) {
            return None;
        }
        let normal = self.faces[1].normal(point)?;
        if normal[point.direction].abs() < LEAST_STEEPNESS {
            return None;
        }
        let grids = self.nominal.dexels.grids();
        let number = grids
            .iter()
            .position(|grid| grid.direction() == point.direction)?;
        let grid = &self.part.dexels.grids()[number];
        let cell = grid.cell_at(&point.position)?;
        let spans: Vec<MaterialSpan> = grid.material(cell).collect();
        let found = self.deviation(&spans, point, &normal)?;
        Some(PointDeviation {
            deviation: found.deviation,
            made_by: found.made_by,
        })
    }

    fn row(&self, number: usize, row: usize) -> SurfaceComparison {
        let mut found = SurfaceComparison::default();
        let (grid, of_part) = (
            &self.nominal.dexels.grids()[number],
            &self.part.dexels.grids()[number],
        );
        for column in 0..grid.cells()[0] {
            let cell = [column, row];
            let mut spans: Option<Vec<MaterialSpan>> = None;
            for point in grid.surface_at(cell) {
                let normal = self.faces[1].is_made(point.origin);
                let normal = normal.then(|| self.faces[1].normal(&point)).flatten();
                let Some(normal) = normal.filter(|normal| is_steepest(normal, &point)) else {
                    continue;
                };
                let spans = spans.get_or_insert_with(|| of_part.material(cell).collect());
                let area = grid.cell_area() / normal[point.direction].abs();
                match self.deviation(spans, &point, &normal) {
                    Some(Found {
                        deviation,
                        on_dexel,
                        made_by,
                        is_same_face,
                    }) => found.points.push(SurfaceDeviation {
                        position: point.position,
                        normal,
                        deviation,
                        on_part: match on_dexel {
                            Some(at) => grid.position(cell, at),
                            None => point.position + normal.into_inner() * deviation,
                        },
                        is_same_face,
                        direction: point.direction,
                        area,
                        made_by,
                        nominal_by: point.origin,
                    }),
                    None => found.missing_area += area,
                }
            }
        }
        found
    }

    /// The deviation at a point of the nominal surface.
    fn deviation(
        &self,
        spans: &[MaterialSpan],
        point: &SurfacePoint,
        normal: &Unit<Vector3<f64>>,
    ) -> Option<Found> {
        let (nominal, end) = (point.position[point.direction], usize::from(!point.begins));
        let ends = spans.iter().map(|span| (span.ends[end], span.origins[end]));
        let off = |at: f64| (at - nominal).abs();
        let on_dexel = ends.min_by(|one, other| off(one.0).total_cmp(&off(other.0)));
        let steep = normal[point.direction];
        let along = on_dexel.map(|(at, made_by)| Found {
            deviation: (at - nominal) * steep,
            on_dexel: Some(at),
            made_by,
            is_same_face: true,
        });
        if let Some(near) = &along
            && near.deviation.abs() <= 0.5 * self.reach.cell
        {
            return along;
        }
        let most = self.reach.most;
        let limit = along
            .as_ref()
            .map_or(most, |found| found.deviation.abs().min(most));
        let nearest = nearest_end(self.part.dexels, &point.position, limit);
        match (along, nearest) {
            (Some(along), Some(nearest)) => Some(self.nearest(&along, &nearest, (point, normal))),
            (Some(along), None) if along.deviation.abs() <= most => Some(Found {
                on_dexel: None,
                ..along
            }),
            _ => None,
        }
    }

    /// The deviation from the planes of the ends near a point, with the sign of that along its dexel.
    fn nearest(
        &self,
        along: &Found,
        nearest: &NearEnd,
        (point, normal): (&SurfacePoint, &Unit<Vector3<f64>>),
    ) -> Found {
        let within = nearest.distance + self.reach.cell;
        let near = ends_within(self.part.dexels, &point.position, within).into_iter();
        let near = near.map(|end| (self.distance(&end, &point.position), end.point));
        let least = near.min_by(|one, other| one.0.total_cmp(&other.0));
        let (distance, end) = least.unwrap_or((nearest.distance, nearest.point));
        let face = self.faces[0].normal(&end);
        Found {
            deviation: distance.copysign(along.deviation),
            on_dexel: None,
            made_by: end.origin,
            is_same_face: face.is_none_or(|face| face.dot(normal) > SAME_FACE),
        }
    }

    /// The distance of a point from the surface at a near end: from the plane there, where its foot is within the cell.
    fn distance(&self, near: &NearEnd, point: &Point3<f64>) -> f64 {
        let Some(normal) = self.faces[0].normal(&near.point) else {
            return near.distance;
        };
        let from_plane = (point - near.point.position).dot(&normal).abs();
        let aside = (near.distance.powi(2) - from_plane.powi(2)).max(0.0).sqrt();
        if aside <= ASIDE * self.reach.cell {
            from_plane
        } else {
            near.distance
        }
    }
}

/// Whether the dexel of a point meets a surface most steeply, of equal ones the first, and material is on the side that the end has.
fn is_steepest(normal: &Unit<Vector3<f64>>, point: &SurfacePoint) -> bool {
    let k = point.direction;
    let is_outward = (normal[k] > 0.0) != point.begins;
    let steepest = |(axis, component): (usize, &f64)| match axis < k {
        true => component.abs() < normal[k].abs(),
        false => component.abs() <= normal[k].abs(),
    };
    is_outward && normal.iter().enumerate().all(steepest)
}
