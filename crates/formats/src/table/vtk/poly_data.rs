//! Points joined to quadrilaterals and lines as VTK poly data, `.vtp`.

use super::{PointArray, VtkError, check_arrays, check_positions, data_array, file, floats, point_data};

/// Points, the lines and quadrilaterals that join them, and values at the points.
///
/// Checked when it is made: finite positions, indices, lengths of the lines, and lengths and names of the arrays.
/// Not checked: whether quadrilaterals are flat.
#[derive(Debug, Clone, PartialEq)]
pub struct PolyData {
    points_mm: Vec<[f64; 3]>,
    lines: Vec<Vec<usize>>,
    quads: Vec<[usize; 4]>,
    arrays: Vec<PointArray>,
}

impl PolyData {
    /// Any points, lines and quadrilaterals; cells name their points by index, from 0.
    ///
    /// # Errors
    /// Positions that are not finite, indices of no point, lines of fewer than two points, and arrays of the wrong length,
    /// of the same name or with numbers that are not finite.
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
            lines,
            quads,
            arrays,
        })
    }

    /// A surface through the points of a grid, `counts` along its first and second direction; the first runs fastest.
    ///
    /// # Errors
    /// A number of points that does not fit `counts`, and those of [`PolyData::new`].
    pub fn plane_grid(
        points_mm: Vec<[f64; 3]>,
        counts: [usize; 2],
        arrays: Vec<PointArray>,
    ) -> Result<Self, VtkError> {
        let [first, second] = counts;
        if first.checked_mul(second) != Some(points_mm.len()) {
            return Err(VtkError::GridPoints {
                points: points_mm.len(),
                counts,
            });
        }
        let quad = |i: usize, j: usize| {
            let corner = i + j * first;
            [corner, corner + 1, corner + 1 + first, corner + first]
        };
        let quads = (1..second)
            .flat_map(|j| (1..first).map(move |i| quad(i - 1, j - 1)))
            .collect();
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

/// The points and cells as the bytes of a `.vtp` file.
pub fn write_poly_data(data: &PolyData) -> Vec<u8> {
    let body = format!(
        "<PolyData>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n\
         {}<Points>\n{}</Points>\n{}{}</Piece>\n</PolyData>\n",
        data.points_mm.len(),
        data.lines.len(),
        data.quads.len(),
        point_data(&data.arrays),
        floats("points_mm", 3, data.points_mm.iter().flatten().copied()),
        cells("Lines", data.lines.iter().map(Vec::as_slice)),
        cells("Polys", data.quads.iter().map(<[usize; 4]>::as_slice)),
    );
    file("PolyData", &body)
}

/// The points of all cells in a row, and where in that row each cell ends.
fn cells<'a>(element: &str, cells: impl Iterator<Item = &'a [usize]>) -> String {
    let mut connectivity: Vec<u8> = Vec::new();
    let mut offsets: Vec<u8> = Vec::new();
    let mut end = 0_u64;
    for cell in cells {
        connectivity.extend(cell.iter().flat_map(|index| (*index as u64).to_le_bytes()));
        end += cell.len() as u64;
        offsets.extend(end.to_le_bytes());
    }
    // Indices are far below 2^63, where signed and unsigned bytes are the same.
    let connectivity = data_array("Int64", "connectivity", 1, connectivity);
    let offsets = data_array("Int64", "offsets", 1, offsets);
    format!("<{element}>\n{connectivity}{offsets}</{element}>\n")
}
