//! Points joined to quadrilaterals, triangles and lines, or alone, as VTK poly data, `.vtp`.
//!
//! | element | content |
//! |---|---|
//! | `Points` | positions, mm, 64 bits |
//! | `Verts`, `Lines`, `Polys` | `connectivity`: points of all cells in a row; `offsets`: where in that row each cell ends |
//! | `PointData` | the arrays |

use super::{PointArray, VtkError, check_arrays, check_positions, data_array, file, point_data};

/// Points, the lines, quadrilaterals and triangles that join them, and values at the points.
///
/// Checked when it is made: finite positions, indices, lengths of the lines, and lengths and names of the arrays.
/// Not checked: whether quadrilaterals are flat.
#[derive(Debug, Clone, PartialEq)]
pub struct PolyData {
    /// In any one frame, which the file does not name.
    points_mm: Vec<[f64; 3]>,
    /// Points that are shown separately.
    vertices: Vec<usize>,
    /// Each joins its points in order.
    lines: Vec<Vec<usize>>,
    /// Corners, once round.
    quads: Vec<[usize; 4]>,
    /// Corners, counter-clockwise seen from outside.
    triangles: Vec<[usize; 3]>,
    /// One value a point in each.
    arrays: Vec<PointArray>,
}

impl PolyData {
    /// Any points, lines and quadrilaterals; cells name their points by index, from 0.
    ///
    /// # Errors
    /// Positions that are not finite, indices of no point, lines of fewer than two points, and arrays of the wrong
    /// length, of the same name or with numbers that are not finite.
    pub fn new(
        points_mm: Vec<[f64; 3]>,
        lines: Vec<Vec<usize>>,
        quads: Vec<[usize; 4]>,
        arrays: Vec<PointArray>,
    ) -> Result<Self, VtkError> {
        let points = points_mm.len();
        check_positions(&points_mm)?;
        if let Some(index) = lines.iter().position(|line| line.len() < 2) {
            return Err(VtkError::ShortLine {
                index,
                points: lines[index].len(),
            });
        }
        if let Some(index) = lines
            .iter()
            .flatten()
            .chain(quads.iter().flatten())
            .find(|index| **index >= points)
        {
            return Err(VtkError::PointIndex {
                index: *index,
                points,
            });
        }
        check_arrays(&arrays, points)?;
        Ok(Self {
            points_mm,
            vertices: Vec::new(),
            lines,
            quads,
            triangles: Vec::new(),
            arrays,
        })
    }

    /// Points that nothing joins.
    ///
    /// # Errors
    /// Those of [`PolyData::new`].
    pub fn points(points_mm: Vec<[f64; 3]>, arrays: Vec<PointArray>) -> Result<Self, VtkError> {
        let vertices = (0..points_mm.len()).collect();
        let alone = Self::new(points_mm, Vec::new(), Vec::new(), arrays)?;
        Ok(Self { vertices, ..alone })
    }

    /// A surface of triangles.
    ///
    /// # Errors
    /// Those of [`PolyData::new`].
    pub fn triangles(
        points_mm: Vec<[f64; 3]>,
        triangles: Vec<[usize; 3]>,
        arrays: Vec<PointArray>,
    ) -> Result<Self, VtkError> {
        let points = points_mm.len();
        if let Some(&index) = triangles.iter().flatten().find(|index| **index >= points) {
            return Err(VtkError::PointIndex { index, points });
        }
        let alone = Self::new(points_mm, Vec::new(), Vec::new(), arrays)?;
        Ok(Self { triangles, ..alone })
    }

    /// A surface through the points of each grid, one grid after the other; `counts` are its points along its first and
    /// second direction, and the first runs fastest.
    ///
    /// Quadrilaterals go from corner (i, j) over (i + 1, j) and (i + 1, j + 1) to (i, j + 1). A grid of one row of
    /// points has none.
    ///
    /// # Errors
    /// A number of points that does not fit `counts`, and those of [`PolyData::new`].
    pub fn plane_grids(
        points_mm: Vec<[f64; 3]>,
        counts: &[[usize; 2]],
        arrays: Vec<PointArray>,
    ) -> Result<Self, VtkError> {
        let sizes = counts.iter().map(|[first, second]| first.saturating_mul(*second));
        let expected = sizes.fold(0, usize::saturating_add);
        if expected != points_mm.len() {
            return Err(VtkError::GridPoints {
                points: points_mm.len(),
                expected,
            });
        }
        let mut quads = Vec::new();
        let mut start = 0;
        for [first, second] in counts {
            for j in 1..*second {
                for i in 1..*first {
                    let corner = start + (i - 1) + (j - 1) * first;
                    quads.push([corner, corner + 1, corner + 1 + first, corner + first]);
                }
            }
            start += first * second;
        }
        Self::new(points_mm, Vec::new(), quads, arrays)
    }

    /// One line for each path; the arrays run through the points of all paths, one path after the other.
    ///
    /// # Errors
    /// Those of [`PolyData::new`].
    pub fn paths(paths_mm: &[Vec<[f64; 3]>], arrays: Vec<PointArray>) -> Result<Self, VtkError> {
        let mut next = 0;
        let lines = paths_mm.iter().map(|path| {
            let start = next;
            next += path.len();
            (start..next).collect()
        });
        let lines = lines.collect();
        Self::new(paths_mm.concat(), lines, Vec::new(), arrays)
    }
}

/// The points and cells as the bytes of a `.vtp` file. Positions keep all their digits.
pub fn write_poly_data(data: &PolyData) -> Vec<u8> {
    file("PolyData", |out| {
        *out += &format!(
            "<PolyData>\n\
             <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
            data.points_mm.len(),
            data.vertices.len(),
            data.lines.len(),
            data.quads.len() + data.triangles.len(),
        );
        point_data(out, &data.arrays);
        *out += "<Points>\n";
        let positions = data.points_mm.iter().flatten().map(|at| at.to_le_bytes());
        data_array(out, "Float64", "points_mm", 3, positions);
        *out += "</Points>\n";
        if !data.vertices.is_empty() {
            cells(out, "Verts", data.vertices.chunks(1));
        }
        cells(out, "Lines", data.lines.iter().map(Vec::as_slice));
        let quads = data.quads.iter().map(<[usize; 4]>::as_slice);
        let triangles = data.triangles.iter().map(<[usize; 3]>::as_slice);
        cells(out, "Polys", quads.chain(triangles));
        *out += "</Piece>\n</PolyData>\n";
    })
}

/// The points of all cells in a row, and where in that row each cell ends.
///
/// As 32 bits where the last offset fits into them, else as 64.
fn cells<'a>(out: &mut String, element: &str, cells: impl Iterator<Item = &'a [usize]> + Clone) {
    *out += &format!("<{element}>\n");
    let ends = cells.clone().scan(0, |end, cell| {
        *end += cell.len();
        Some(*end)
    });
    let last = ends.clone().last().unwrap_or_default();
    let connectivity = cells.flatten().copied();
    // Indices are far below 2^63, where signed and unsigned bytes are the same.
    if i32::try_from(last).is_ok() {
        let bytes = |index: usize| (index as u32).to_le_bytes();
        data_array(out, "Int32", "connectivity", 1, connectivity.map(bytes));
        data_array(out, "Int32", "offsets", 1, ends.map(bytes));
    } else {
        let bytes = |index: usize| (index as u64).to_le_bytes();
        data_array(out, "Int64", "connectivity", 1, connectivity.map(bytes));
        data_array(out, "Int64", "offsets", 1, ends.map(bytes));
    }
    *out += &format!("</{element}>\n");
}
