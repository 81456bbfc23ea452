//! A regular grid in three dimensions as VTK image data, `.vti`.
//!
//! The geometry is in the element itself, as origin, spacing and counts (`WholeExtent`, which names the last point, not
//! their number); the file contains no positions.

use super::{PointArray, VtkError, check_arrays, check_positions, file, point_data};

/// Values on a regular grid along the axes of its frame; x runs fastest, then y, then z.
///
/// Checked when it is made: counts, spacing, finite numbers, and lengths and names of the arrays.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Where point (0, 0, 0) is.
    origin_mm: [f64; 3],
    /// Distances of neighbours in x, y, z; above 0.
    spacing_mm: [f64; 3],
    /// In x, y, z; each at least 1.
    point_counts: [usize; 3],
    /// One value a point in each.
    arrays: Vec<PointArray>,
}

impl Image {
    /// A grid whose first point is at `origin_mm`, with `point_counts` points in x, y and z at distances `spacing_mm`.
    ///
    /// Point (i, j, k) has the index i + nx (j + ny k) in every array. A direction of one point still needs a spacing.
    ///
    /// # Errors
    /// A direction without points, a spacing not above 0 mm, an origin that is not finite, and arrays of the wrong
    /// length, of the same name or with numbers that are not finite.
    pub fn new(
        origin_mm: [f64; 3],
        spacing_mm: [f64; 3],
        point_counts: [usize; 3],
        arrays: Vec<PointArray>,
    ) -> Result<Self, VtkError> {
        if spacing_mm
            .iter()
            .any(|spacing| !spacing.is_finite() || *spacing <= 0.0)
        {
            return Err(VtkError::Spacing { spacing_mm });
        }
        check_positions(&[origin_mm])?;
        if point_counts.contains(&0) {
            return Err(VtkError::NoPoints { counts: point_counts });
        }
        // A count that overflows can only disagree with the arrays.
        let points = point_counts
            .iter()
            .fold(1_usize, |points, count| points.saturating_mul(*count));
        check_arrays(&arrays, points)?;
        Ok(Self {
            origin_mm,
            spacing_mm,
            point_counts,
            arrays,
        })
    }
}

/// The grid as the bytes of a `.vti` file.
pub fn write_image(image: &Image) -> Vec<u8> {
    let [nx, ny, nz] = image.point_counts.map(|count| count - 1);
    let extent = format!("0 {nx} 0 {ny} 0 {nz}");
    let three = |values: [f64; 3]| format!("{:?} {:?} {:?}", values[0], values[1], values[2]);
    file("ImageData", |out| {
        *out += &format!(
            "<ImageData WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{}\">\n<Piece Extent=\"{extent}\">\n",
            three(image.origin_mm),
            three(image.spacing_mm),
        );
        point_data(out, &image.arrays);
        *out += "</Piece>\n</ImageData>\n";
    })
}
