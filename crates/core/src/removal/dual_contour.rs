//! The surface of a part as a closed mesh of triangles: dual contouring of the crossings of the lattice.
//!
//! Each piece of surface in a cell of the lattice has a vertex, and each crossed edge of the lattice a quadrilateral through the vertices of the four cells around it, in
//! two triangles. Since the outer layer of the lattice is empty, each crossed edge has four cells: the mesh is closed. Places and normals of crossings are those of
//! ends of dexels, so that planes and sharp edges are exact, and other surfaces are met with an error of the order of the square of the lattice.
//!
//! Of the two diagonals of a quadrilateral the one is used whose triangles are nearer to the place of the crossing, measured along its edge, and do not turn back.
//!
//! Not in the mesh: what is between two points of the lattice, such as walls and gaps thinner than a cell (or `stride` cells); details of edges within a cell that has more than one.
//! Triangles may be slivers, or without area where vertices of neighbouring cells are clamped to the same place; they may cross each other
//! where two surfaces are in one cell.
//!
//! Layers of cells are computed in parallel and joined in their order: any number of threads gives the same mesh.
//!
//! Source: Ju, Losasso, Schaefer & Warren 2002, *Dual contouring of Hermite data* \[recalled\]; the choice of the diagonal is derived.

use nalgebra::{Point3, Unit, Vector3};
use rayon::prelude::*;

use super::cell_cycles::Cycles;
use super::error::RemovalError;
use super::lattice::Lattice;
use super::lattice_crossings::{Crossing, LayerCrossings};
use super::part::DexelPart;
use super::quadratic_error::{Tangent, vertex};
use super::quadrilateral::{AROUND, triangles};
use super::surface::SurfacePoint;
use super::surface_mesh::SurfaceMesh;
use super::swept::across;

/// Most triangles of a mesh: about 4 GB while it is made.
const MOST_TRIANGLES: usize = 20_000_000;

impl DexelPart {
    /// Triangles of the mesh with this stride, without creating it.
    ///
    /// # Errors
    /// A stride of 0, too many points in a layer of the lattice.
    pub fn mesh_triangles(&self, stride: usize) -> Result<usize, RemovalError> {
        Ok(Lattice::new(self, stride)?.triangles())
    }

    /// The least stride whose mesh has at most this many triangles. With fewer than 12, those of one point of the lattice, it may be exceeded.
    ///
    /// # Errors
    /// Too many points in a layer of the lattice.
    pub fn mesh_stride(&self, most_triangles: usize) -> Result<usize, RemovalError> {
        let most = self.counts.into_iter().fold(1, usize::max);
        let mut stride = 1;
        while stride < most && self.mesh_triangles(stride)? > most_triangles {
            stride += 1;
        }
        Ok(stride)
    }

    /// The surface as triangles, with every `stride`-th dexel. `normal` gives the direction out of the material at an end of a dexel; where it is not
    /// known, the place alone is used.
    ///
    /// With z dexels alone, steep surfaces (above 72 deg) between columns are walls in the middle, and vertices there have no points.
    ///
    /// # Errors
    /// A stride of 0, too many points in a layer of the lattice, too many triangles.
    pub fn surface_mesh(
        &self,
        stride: usize,
        normal: impl Fn(&SurfacePoint) -> Option<Unit<Vector3<f64>>> + Sync,
    ) -> Result<SurfaceMesh, RemovalError> {
        let lattice = Lattice::new(self, stride)?;
        let (triangles, most) = (lattice.triangles(), MOST_TRIANGLES);
        if triangles > most {
            return Err(RemovalError::MeshTooLarge { triangles, most });
        }
        let [_, rows, _] = lattice.cells();
        let layers: Vec<LayerCrossings> = (0..rows)
            .into_par_iter()
            .map(|row| lattice.crossings(row, &normal))
            .collect();
        let contour = Contour {
            lattice: &lattice,
            layers: &layers,
            cycles: Cycles::of_all(),
        };
        let slabs: Vec<Slab> = (0..rows).into_par_iter().map(|row| contour.slab(row)).collect();
        Ok(contour.joined(slabs))
    }
}

/// A lattice and its crossings.
struct Contour<'a> {
    lattice: &'a Lattice<'a>,
    layers: &'a [LayerCrossings],
    /// Of cells, by their corners in material.
    cycles: Vec<Cycles>,
}

/// The vertices of the cells between two layers.
#[derive(Default)]
struct Slab {
    vertices: Vec<Point3<f64>>,
    normals: Vec<Vector3<f64>>,
    /// By vertex.
    corners: Vec<Corner>,
    /// For each vertex the end of its corners.
    corner_ends: Vec<usize>,
}

/// A crossed edge of a cell: a corner of the quadrilateral of the edge.
#[derive(Clone, Copy)]
struct Corner {
    /// Lower corner of the cell in the layer: column and place in it.
    cell: [usize; 2],
    /// Number of the edge in the cell.
    edge: u8,
    /// Layer and number of the crossing.
    crossing: [usize; 2],
}

impl Contour<'_> {
    /// The corners of all cells between a layer and the next one, by cell and edge.
    fn corners(&self, row: usize) -> Vec<Corner> {
        let mut corners = Vec::new();
        for (upper, layer) in [row, row + 1].into_iter().enumerate() {
            let crossings = self.layers.get(layer).map(|layer| &layer.crossings);
            for (number, crossing) in crossings.into_iter().flatten().enumerate() {
                let axes = across(crossing.axis);
                if crossing.axis == 1 && upper == 1 {
                    continue;
                }
                for offset in 0..4 {
                    let mut cell = [crossing.at[0], row, crossing.at[1]];
                    let sides = [offset & 1, offset >> 1];
                    // Along y the slab decides on which side of the edge its cell is.
                    if (0..2).any(|n| axes[n] == 1 && sides[n] != upper) {
                        continue;
                    }
                    for n in (0..2).filter(|n| axes[*n] != 1) {
                        cell[axes[n]] -= sides[n];
                    }
                    corners.push(Corner {
                        cell: [cell[0], cell[2]],
                        edge: (4 * crossing.axis + offset) as u8,
                        crossing: [layer, number],
                    });
                }
            }
        }
        corners.sort_unstable_by_key(|corner| (corner.cell, corner.edge));
        corners
    }

    /// The vertices between a layer and the next one.
    fn slab(&self, row: usize) -> Slab {
        let layers = [row, row + 1].map(|row| self.lattice.layer(row));
        let corners = self.corners(row);
        let mut slab = Slab::default();
        let mut tangents = Vec::new();
        for of_cell in corners.chunk_by(|one, next| one.cell == next.cell) {
            let Some(&Corner { cell, .. }) = of_cell.first() else {
                continue;
            };
            let is_inside = |n: usize| layers[n >> 1 & 1].is_inside(cell[0] + (n & 1), cell[1] + (n >> 2));
            let mask = mask(is_inside);
            let cell = [cell[0], row, cell[1]];
            let cycles = self.cycles_of(mask, cell);
            for cycle in 0..cycles.count {
                let of_cycle = of_cell
                    .iter()
                    .filter(|corner| cycles.of_edge[usize::from(corner.edge)] == cycle);
                tangents.clear();
                let mut normal = Vector3::zeros();
                for corner in of_cycle {
                    let (row, crossing) = self.crossing(corner);
                    tangents.push(Tangent {
                        place: self.lattice.position(row, crossing),
                        normal: crossing.normal,
                    });
                    normal += crossing.normal.map_or(Vector3::zeros(), Unit::into_inner);
                    slab.corners.push(*corner);
                }
                let ends = [0, 1].map(|side| {
                    let place = |k: usize| self.lattice.places[k][cell[k] + side];
                    Point3::new(place(0), place(1), place(2))
                });
                slab.vertices.push(vertex(&tangents, ends));
                slab.normals.push(unit_or_outwards(normal, mask));
                slab.corner_ends.push(slab.corners.len());
            }
        }
        slab
    }

    /// The crossing of a corner, and its layer.
    fn crossing(&self, corner: &Corner) -> (usize, &Crossing) {
        let [row, number] = corner.crossing;
        (row, &self.layers[row].crossings[number])
    }

    /// The cycles of a cell; its neighbour decides with it about a face with one cycle twice.
    fn cycles_of(&self, mask_of_cell: u8, cell: [usize; 3]) -> Cycles {
        let cycles = self.cycles[usize::from(mask_of_cell)];
        let Some(face) = cycles.doubled_face else {
            return cycles;
        };
        let (axis, is_upper) = (usize::from(face / 2), face % 2 == 1);
        let mut neighbour = cell;
        // A face of an outer cell has corners in the outer layer, which are never in material: it has not four crossed edges.
        neighbour[axis] = if is_upper { cell[axis] + 1 } else { cell[axis] - 1 };
        let is_inside = |n: usize| {
            self.lattice
                .is_inside([0, 1, 2].map(|k| neighbour[k] + (n >> k & 1)))
        };
        let of_neighbour = &self.cycles[usize::from(mask(is_inside))];
        if of_neighbour.doubled_face == Some(face ^ 1) {
            return Cycles::new(mask_of_cell, Some(face));
        }
        cycles
    }

    /// The mesh of all slabs.
    fn joined(&self, slabs: Vec<Slab>) -> SurfaceMesh {
        let mut mesh = SurfaceMesh::default();
        // For each crossing of each layer the vertices around it.
        let mut around: Vec<Vec<[u32; 4]>> = self
            .layers
            .iter()
            .map(|layer| vec![[0; 4]; layer.crossings.len()])
            .collect();
        let mut first_ends = Vec::new();
        for layer in self.layers {
            first_ends.push(mesh.points.len());
            mesh.points.extend_from_slice(&layer.ends);
        }
        mesh.point_starts.push(0);
        for slab in slabs {
            let mut corners = slab.corners.iter();
            let mut start = 0;
            for end in slab.corner_ends {
                let number = (mesh.point_starts.len() - 1) as u32;
                for corner in corners.by_ref().take(end - start) {
                    let [row, crossing] = corner.crossing;
                    around[row][crossing][usize::from(corner.edge % 4)] = number;
                    let end = self.crossing(corner).1.end;
                    mesh.point_numbers
                        .extend(end.map(|end| (first_ends[row] + end) as u32));
                }
                start = end;
                mesh.point_starts.push(mesh.point_numbers.len() as u32);
            }
            mesh.vertices.extend(slab.vertices);
            mesh.normals.extend(slab.normals);
        }
        let of_layer = |row: usize| {
            let crossings = self.layers[row].crossings.iter().zip(&around[row]);
            crossings
                .flat_map(|(crossing, around)| {
                    let corners = AROUND.map(|offset| around[offset]);
                    let position = self.lattice.position(row, crossing);
                    triangles(crossing, &position, corners, &mesh.vertices)
                })
                .collect::<Vec<[u32; 3]>>()
        };
        let triangles: Vec<Vec<[u32; 3]>> = (0..self.layers.len()).into_par_iter().map(of_layer).collect();
        mesh.triangles = triangles.concat();
        mesh
    }
}

/// The bits of the corners that are in material.
fn mask(is_inside: impl Fn(usize) -> bool) -> u8 {
    (0..8)
        .filter(|corner| is_inside(*corner))
        .map(|corner| 1 << corner)
        .sum()
}

/// The direction of a vector, or that from the corners in material to the others, or up.
fn unit_or_outwards(normal: Vector3<f64>, mask: u8) -> Vector3<f64> {
    let unit = |vector: Vector3<f64>| Unit::try_new(vector, 1e-6).map(Unit::into_inner);
    let sign = |n: usize, k: usize| if n >> k & 1 == 1 { 1.0 } else { -1.0 };
    let inside = (0..8).filter(|n| mask >> n & 1 == 1);
    let outwards = inside.map(|n| -Vector3::new(sign(n, 0), sign(n, 1), sign(n, 2)));
    unit(normal)
        .or_else(|| unit(outwards.sum()))
        .unwrap_or_else(Vector3::z)
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::super::part::DexelDirections;
    use super::super::stock_solid::StockSolid;
    use super::*;

    /// Cells of 1 mm that are removed where a number from this start is small.
    fn random_cells(seed: u64, size: usize, removed_percent: u64) -> DexelPart {
        let corner = Point3::new(1.0, 1.0, 1.0) * (1e-3 * size as f64);
        let stock = StockSolid::Box([Point3::origin(), corner]);
        let mut part = DexelPart::new(&stock, 1e-3, DexelDirections::Z).unwrap();
        let mut state = seed;
        for tile in &mut part.grids[0].tiles {
            for dexel in 0..tile.size[0] * tile.size[1] {
                for cell in 0..size {
                    // The generator of Lehmer with the constants of Knuth; its upper bits.
                    state = state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    if (state >> 33) % 100 < removed_percent {
                        let ends = [cell, cell + 1].map(|end| 1e-3 * end as f32);
                        tile.remove(dexel, ends, 0);
                    }
                }
            }
        }
        part
    }

    #[test]
    fn random_cells_have_a_mesh_with_two_triangles_at_each_edge() {
        let mut doubled = 0;
        for (seed, removed) in [(1, 20), (2, 40), (3, 50), (4, 60), (5, 80)] {
            let part = random_cells(seed, 20, removed);
            for stride in [1, 2, 3] {
                let mesh = part.surface_mesh(stride, |_| None).unwrap();
                assert!(mesh.triangles.len() > 100);
                let mut edges: HashMap<[u32; 2], usize> = HashMap::new();
                for [a, b, c] in mesh.triangles.iter().copied() {
                    for edge in [[a, b], [b, c], [c, a]] {
                        *edges.entry(edge).or_default() += 1;
                    }
                }
                for ([from, to], count) in &edges {
                    assert_eq!(
                        (*count, edges.get(&[*to, *from])),
                        (1, Some(&1)),
                        "{seed} {stride}"
                    );
                }
            }
            let lattice = Lattice::new(&part, 1).unwrap();
            let layers = [];
            let contour = Contour {
                lattice: &lattice,
                layers: &layers,
                cycles: Cycles::of_all(),
            };
            let [columns, rows, points] = lattice.cells();
            for cell in
                (0..columns * rows * points).map(|n| [n % columns, n / columns % rows, n / columns / rows])
            {
                let mask = mask(|n| lattice.is_inside([0, 1, 2].map(|k| cell[k] + (n >> k & 1))));
                doubled += usize::from(contour.cycles_of(mask, cell) != contour.cycles[usize::from(mask)]);
            }
        }
        // The rule for faces with one cycle twice was needed.
        assert!(doubled > 10, "{doubled}");
    }
}
