//! Placement of an object in the model: a matrix of 3 rows and 4 columns on column vectors.
//!
//! ```text
//! p' = L p + t      L: the left three columns, t: the last
//! ```

/// `[[l11, l12, l13, t1], ...]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Affine(pub [[f64; 4]; 3]);

impl Affine {
    /// Changes nothing.
    pub const IDENTITY: Affine = Affine([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);

    /// First `inner`, then this one.
    pub fn after(&self, inner: &Affine) -> Affine {
        let mut product = [[0.0; 4]; 3];
        for (row, left) in product.iter_mut().zip(&self.0) {
            for (column, value) in row.iter_mut().enumerate() {
                let sum: f64 = (0..3).map(|k| left[k] * inner.0[k][column]).sum();
                *value = if column == 3 { sum + left[3] } else { sum };
            }
        }
        Affine(product)
    }

    /// Where a point is placed.
    pub fn place(&self, point: [f64; 3]) -> [f64; 3] {
        self.0
            .map(|row| row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3])
    }

    /// Whether it mirrors, so that the order of corners must be reversed.
    pub fn mirrors(&self) -> bool {
        let [a, b, c] = self.0;
        let determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        determinant < 0.0
    }

    /// Whether it is all finite numbers.
    pub fn is_finite(&self) -> bool {
        self.0.as_flattened().iter().all(|value| value.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_places_as_its_factors_one_after_the_other() {
        let turn = Affine([[0.0, -1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 2.0], [0.0, 0.0, 1.0, 3.0]]);
        let scale = Affine([[2.0, 0.0, 0.0, 5.0], [0.0, 3.0, 0.0, 6.0], [0.0, 0.0, 4.0, 7.0]]);
        let point = [1.0, 10.0, 100.0];
        assert_eq!(turn.after(&scale).place(point), turn.place(scale.place(point)));
        assert_eq!(turn.after(&scale).place(point), [-35.0, 9.0, 410.0]);
        assert_eq!(Affine::IDENTITY.after(&turn), turn);
    }

    #[test]
    fn a_negative_scale_mirrors() {
        let mut scale = Affine::IDENTITY;
        assert!(!scale.mirrors());
        scale.0[1][1] = -1.0;
        assert!(scale.mirrors());
    }
}
