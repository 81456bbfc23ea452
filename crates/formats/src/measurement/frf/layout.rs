//! Layout of the data of a function: how many numbers, and how wide.

/// Layout of the data.
pub(super) struct Shape {
    /// Whether ordinates have double precision.
    pub is_double: bool,
    /// Numbers of an ordinate.
    pub parts: usize,
    /// Whether each value has its abscissa.
    pub is_uneven: bool,
    /// Number of values.
    pub count: usize,
}

impl Shape {
    /// Numbers of a value with its abscissa.
    pub(super) fn per_value(&self) -> usize {
        self.parts + usize::from(self.is_uneven)
    }

    /// Width of the number at this place of the data.
    pub(super) fn width(&self, index: usize) -> usize {
        let is_abscissa = self.is_uneven && index.is_multiple_of(self.per_value());
        if self.is_double && !is_abscissa { 20 } else { 13 }
    }
}
