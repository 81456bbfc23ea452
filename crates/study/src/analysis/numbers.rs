//! A column of numbers of the points of an analysis, filled later.

use std::ops::Range;

use armill_core::kernel::Evaluation;
use armill_formats::table::{Column, ColumnData};

use crate::analysis::quantity::Quantity;
use crate::analysis::rows::{Rows, of_reached};

/// A column of numbers that is not filled yet.
pub struct Numbers<'a> {
    /// What its numbers are.
    pub quantity: &'static Quantity,
    /// Its name: the key of the quantity, with its capitals replaced.
    pub name: String,
    /// Appends its values at these points.
    pub fill: Fill<'a>,
}

/// Accepts a series, a range of its points, and the list to append to: `None` where the value is not known.
pub type Fill<'a> = Box<dyn Fn(&Rows<'_>, Range<usize>, &mut Vec<Option<f64>>) + Send + Sync + 'a>;

impl<'a> Numbers<'a> {
    /// The column of a quantity: `value` gives it at a point with a posture, in the unit of the quantity; none where it
    /// is not known.
    pub fn of<V: Into<Option<f64>>>(
        quantity: &'static Quantity,
        value: impl Fn(&Rows<'_>, usize, &Evaluation) -> V + Send + Sync + 'a,
    ) -> Numbers<'a> {
        Numbers {
            quantity,
            name: quantity.key.to_owned(),
            fill: Box::new(move |rows, points, values| values.extend(of_reached(rows, points, &value))),
        }
    }

    /// The column of an input: `value` gives it at every point, with or without a posture; none where it is not given.
    pub fn given<V: Into<Option<f64>>>(
        quantity: &'static Quantity,
        value: impl Fn(usize) -> V + Send + Sync + 'a,
    ) -> Numbers<'a> {
        Numbers {
            quantity,
            name: quantity.key.to_owned(),
            fill: Box::new(move |_, points, values| values.extend(points.map(|index| value(index).into()))),
        }
    }

    /// One of several columns of a quantity: `capitals` in its key stand for `name`.
    pub fn named(mut self, capitals: &str, name: &str) -> Numbers<'a> {
        self.name = self.name.replace(capitals, name);
        self
    }

    /// The column with its values.
    pub fn column(&self, values: Vec<Option<f64>>) -> Column {
        Column {
            name: self.name.clone(),
            unit: self.quantity.unit.map(str::to_owned),
            description: self.quantity.words.to_owned(),
            decimals: Some(self.quantity.decimals),
            data: ColumnData::of_decimals(values, self.quantity.decimals),
        }
    }
}
