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

use super::moves::{PathTool, Stage};
use super::nearest::{NearestEnd, ends_within, nearest_end};
use crate::clearance::Triangle;
use crate::removal::{DexelGrid, DexelPart, EndOrigin, MaterialSpan, ToolMove};
use crate::watch::{Cancelled, Watch};

/// A part and what made its surface.
#[derive(Clone, Copy, Debug)]
pub struct MadePart<'a> {
    /// Its dexels.
    pub dexels: &'a DexelPart,
    /// What made them.
    pub made_by: MadeBy<'a>,
}

/// What a part is made by.
#[derive(Clone, Copy, Debug)]
pub enum MadeBy<'a> {
    /// These stages of these tools, with the tolerance of turning axes (m).
    Moves(&'a [Stage], &'a [PathTool], f64),
    /// The triangles around it.
    Mesh(&'a [Triangle]),
}

/// A point of the nominal surface, and the part there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceDeviation {
    /// On the nominal surface, m.
    pub position: Point3<f64>,
    /// Nominal normal, out of the material.
    pub normal: Unit<Vector3<f64>>,
    /// Distance of the part from it along the normal, m; positive where material is left.
    pub deviation: f64,
    /// The surface of the part on the same dexel, m.
    pub on_part: Point3<f64>,
    /// Direction of the dexel: 0, 1, 2 for x, y, z.
    pub direction: usize,
    /// Area that it stands for, m^2.
    pub area: f64,
    /// What made the surface of the part: the number of a move, or the stock.
    pub made_by: EndOrigin,
    /// What made the nominal surface there.
    pub nominal_by: EndOrigin,
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

/// Compares a part with the nominal one on the same raster. Of a nominal part that moves make, only what they make is compared; of a mesh all of
/// its surface.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the two have different directions of dexels.
pub fn compare(
    part: MadePart<'_>,
    nominal: MadePart<'_>,
    reach: SearchReach,
    watch: Watch<'_>,
) -> Result<SurfaceComparison, Cancelled> {
    let grids = [part, nominal].map(|made| made.dexels.grids());
    assert_eq!(grids[0].len(), grids[1].len(), "the same directions");
    let faces = [part, nominal].map(|made| Faces::of(made.made_by));
    let mut found = SurfaceComparison::default();
    for (grid, nominal) in grids[0].iter().zip(grids[1]) {
        let search = Search {
            part: part.dexels,
            grid,
            nominal,
            faces: &faces,
            reach,
        };
        let rows = (0..nominal.cells()[1]).into_par_iter();
        let rows: Result<Vec<SurfaceComparison>, Cancelled> = rows
            .map(|row| match watch.is_cancelled() {
                true => Err(Cancelled),
                false => Ok(search.row(row)),
            })
            .collect();
        for row in rows? {
            found.points.extend(row.points);
            found.missing_area += row.missing_area;
        }
    }
    Ok(found)
}

/// Half the diagonal of a cell, and a little more for steep surfaces; in cells.
const ASIDE: f64 = 0.9;

/// What gives the normal of an end.
enum Faces<'a> {
    Moves {
        by_number: Vec<Option<(usize, ToolMove)>>,
        tools: &'a [PathTool],
        turn_tolerance: f64,
    },
    Triangles(&'a [Triangle]),
}

impl<'a> Faces<'a> {
    fn of(made_by: MadeBy<'a>) -> Faces<'a> {
        match made_by {
            MadeBy::Mesh(triangles) => Faces::Triangles(triangles),
            MadeBy::Moves(stages, tools, turn_tolerance) => {
                let of_stage = |stage: &'a Stage| stage.moves.iter().map(move |at| (stage.tool, *at));
                let all = || stages.iter().flat_map(of_stage);
                let count = all().map(|(_, at)| at.index as usize + 1).max().unwrap_or(0);
                let mut by_number = vec![None; count];
                for (tool, at) in all() {
                    by_number[at.index as usize] = Some((tool, at));
                }
                Faces::Moves {
                    by_number,
                    tools,
                    turn_tolerance,
                }
            }
        }
    }

    /// The normal at an end of this origin; `None` on the stock of moves.
    fn normal(&self, origin: EndOrigin, position: &Point3<f64>) -> Option<Unit<Vector3<f64>>> {
        match (self, origin) {
            (Faces::Triangles(triangles), EndOrigin::Stock(number)) => {
                let [a, b, c] = triangles.get(number as usize)?.0;
                Unit::try_new((b - a).cross(&(c - a)), 0.0)
            }
            (
                Faces::Moves {
                    by_number,
                    tools,
                    turn_tolerance,
                },
                EndOrigin::Move(number),
            ) => {
                let (tool, of) = by_number.get(number as usize)?.as_ref()?;
                of.surface_normal(&tools[*tool].cutting, *turn_tolerance, position)
            }
            _ => None,
        }
    }
}

/// The comparison along the dexels of one direction.
struct Search<'a> {
    part: &'a DexelPart,
    grid: &'a DexelGrid,
    nominal: &'a DexelGrid,
    /// Those of the part and of the nominal part.
    faces: &'a [Faces<'a>; 2],
    reach: SearchReach,
}

impl Search<'_> {
    fn row(&self, row: usize) -> SurfaceComparison {
        let mut found = SurfaceComparison::default();
        for column in 0..self.nominal.cells()[0] {
            let cell = [column, row];
            let mut here: Option<Vec<MaterialSpan>> = None;
            for span in self.nominal.material(cell) {
                for end in 0..2 {
                    let position = self.nominal.position(cell, span.ends[end]);
                    let Some(normal) = self.faces[1].normal(span.origins[end], &position) else {
                        continue;
                    };
                    if !self.is_steepest(&normal, end) {
                        continue;
                    }
                    let spans = here.get_or_insert_with(|| self.grid.material(cell).collect());
                    let area = self.nominal.cell_area() / normal[self.nominal.direction()].abs();
                    match self.deviation(spans, (end, span), &position, &normal) {
                        Some((deviation, at, made_by)) => found.points.push(SurfaceDeviation {
                            position,
                            normal,
                            deviation,
                            on_part: self.nominal.position(cell, at),
                            direction: self.nominal.direction(),
                            area,
                            made_by,
                            nominal_by: span.origins[end],
                        }),
                        None => found.missing_area += area,
                    }
                }
            }
        }
        found
    }

    /// Whether this direction meets a surface most steeply, of equal ones the first, and material is on the side that the end has.
    fn is_steepest(&self, normal: &Unit<Vector3<f64>>, end: usize) -> bool {
        let k = self.nominal.direction();
        let is_outward = (normal[k] > 0.0) == (end == 1);
        is_outward
            && normal.iter().enumerate().all(|(axis, component)| match axis < k {
                true => component.abs() < normal[k].abs(),
                false => component.abs() <= normal[k].abs(),
            })
    }

    /// The deviation at an end of the nominal part, the end of the part on the dexel, and what made the surface.
    fn deviation(
        &self,
        spans: &[MaterialSpan],
        (end, of): (usize, MaterialSpan),
        position: &Point3<f64>,
        normal: &Unit<Vector3<f64>>,
    ) -> Option<(f64, f64, EndOrigin)> {
        let nominal = of.ends[end];
        let ends = spans.iter().map(|span| (span.ends[end], span.origins[end]));
        let on_dexel =
            ends.min_by(|one, other| (one.0 - nominal).abs().total_cmp(&(other.0 - nominal).abs()));
        let steep = normal[self.nominal.direction()];
        let along = on_dexel.map(|(at, origin)| ((at - nominal) * steep, at, origin));
        let near = along.filter(|(deviation, ..)| deviation.abs() <= 0.5 * self.reach.cell);
        if near.is_some() {
            return near;
        }
        let limit = along.map_or(self.reach.most, |(deviation, ..)| {
            deviation.abs().min(self.reach.most)
        });
        let nearest = nearest_end(self.part, position, limit);
        match (along, nearest) {
            (Some((deviation, at, _)), Some(nearest)) => {
                let near = ends_within(self.part, position, nearest.distance + self.reach.cell).into_iter();
                let near = near.map(|end| (self.distance(&end, position), end.origin));
                let least = near.min_by(|one, other| one.0.total_cmp(&other.0));
                let (distance, origin) = least.unwrap_or((nearest.distance, nearest.origin));
                Some((distance.copysign(deviation), at, origin))
            }
            (Some(along), None) if along.0.abs() <= self.reach.most => Some(along),
            _ => None,
        }
    }

    /// The distance of a point from the surface at a near end: from the plane there, where its foot is within the cell.
    fn distance(&self, nearest: &NearestEnd, point: &Point3<f64>) -> f64 {
        let normal = self.faces[0].normal(nearest.origin, &nearest.position);
        // The stock of moves is a box, mostly: its faces are across the dexels.
        let normal = normal.unwrap_or(Unit::new_unchecked(Vector3::ith(nearest.direction, 1.0)));
        let from_plane = (point - nearest.position).dot(&normal).abs();
        let aside = (nearest.distance.powi(2) - from_plane.powi(2)).max(0.0).sqrt();
        if aside <= ASIDE * self.reach.cell {
            from_plane
        } else {
            nearest.distance
        }
    }
}
