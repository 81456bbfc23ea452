//! A field drawn by its levels, wherever its grid is on the picture: bands, iso-lines, the line of the tolerance,
//! and the labels of these lines.
//!
//! The field has the values of its axes, drawing uses pixels: this module connects
//! the two by a function from values to the picture. Maps and charts of any scale share it.

use armill_core::marching_squares::{Polyline, ScalarField};

use crate::colour::ColourScale;
use crate::levels::Levels;
use crate::line::without_straight;
use crate::line_label::Labelled;
use crate::svg::{Ends, Point, Rect, Style, Svg, Text, trace};
use crate::tolerance;

/// A line that coincides with the tolerance, within this part of a step, carries the tolerance's label alone.
const COINCIDES: f64 = 0.05;

/// A field, and where it is on the picture.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub(crate) field: ScalarField<'a, f64>,
    /// Where a point of the field, in the values of its axes, is on the picture.
    pub(crate) at: &'a dyn Fn([f64; 2]) -> Point,
    /// What the field covers, px.
    pub(crate) area: Rect,
}

impl<'a> Placed<'a> {
    /// Another field in the same place.
    pub(crate) fn with(&self, field: ScalarField<'a, f64>) -> Placed<'a> {
        Placed { field, ..*self }
    }

    /// One colour a band: the lowest covers the whole area, each further one is painted over it from its lower
    /// edge up.
    pub(crate) fn draw_bands(&self, svg: &mut Svg, levels: &Levels, scale: ColourScale) {
        svg.rect(self.area, &Style::fill(levels.colour(0, scale)));
        for (band, level) in levels.inner_um().iter().enumerate() {
            self.fill_from(svg, *level, &levels.colour(band + 1, scale));
        }
    }

    /// Fills where the samples are at least `level`; `colour` is any value of a `fill`.
    pub(crate) fn fill_from(&self, svg: &mut Svg, level: f64, colour: &str) {
        let data: String = self
            .field
            .area_from(level)
            .iter()
            .map(|ring| trace(&self.on_picture(ring), Ends::Closed))
            .collect();
        svg.path(&data, &Style::fill(colour));
    }

    /// The lines along which the samples equal `level`, px.
    pub(crate) fn lines_at(&self, level: f64) -> Vec<Vec<Point>> {
        let lines = self.field.lines_at(level);
        lines.iter().map(|line| self.on_picture(line)).collect()
    }

    /// A line in pixels, without the points that would not be seen.
    fn on_picture(&self, line: &Polyline) -> Vec<Point> {
        let line: Vec<Point> = line.iter().map(|values| (self.at)(*values)).collect();
        without_straight(&line)
    }
}

/// The lines between the bands, and the line of the tolerance.
pub(crate) struct LevelLines<'a> {
    levels: &'a Levels,
    tolerance_um: Option<f64>,
    /// One list of lines for each inner level, px.
    iso: Vec<Vec<Vec<Point>>>,
    /// The lines of the tolerance, px; none where the field does not cross it.
    tolerance: Vec<Vec<Point>>,
}

impl<'a> LevelLines<'a> {
    /// The lines of a field. A tolerance that is not finite has no line.
    pub(crate) fn of(placed: &Placed<'_>, levels: &'a Levels, tolerance_um: Option<f64>) -> Self {
        let tolerance_um = tolerance_um.filter(|tolerance| tolerance.is_finite());
        Self {
            levels,
            tolerance_um,
            iso: levels.inner_um().iter().map(|um| placed.lines_at(*um)).collect(),
            tolerance: tolerance_um.map_or_else(Vec::new, |um| placed.lines_at(um)),
        }
    }

    /// All iso-lines in one style; the tolerance is not among them.
    pub(crate) fn draw_iso(&self, svg: &mut Svg, style: &Style) {
        for line in self.iso.iter().flatten() {
            svg.polyline(line, style);
        }
    }

    /// Each of `styles` along the whole tolerance before the next.
    pub(crate) fn draw_tolerance(&self, svg: &mut Svg, styles: &[Style]) {
        for style in styles {
            for line in &self.tolerance {
                svg.polyline(line, style);
            }
        }
    }

    /// What is written on the lines, the tolerance first, so that it chooses its place before the others. An
    /// iso-line that coincides with the tolerance has no label of its own.
    pub(crate) fn labels(&self) -> Vec<Labelled> {
        let on_tolerance = self.tolerance.iter().map(|points| Labelled {
            points: points.clone(),
            text: self.tolerance_um.map(tolerance::label).unwrap_or_default(),
            look: tolerance::text(),
        });
        let step_um = self.levels.step_um;
        let is_apart = |level: f64| {
            self.tolerance_um
                .is_none_or(|tolerance| (level - tolerance).abs() >= COINCIDES * step_um)
        };
        let iso = self.iso.iter().zip(self.levels.inner_um());
        let on_iso = iso
            .filter(|(_, level)| is_apart(**level))
            .flat_map(|(lines, level)| {
                lines.iter().map(|points| Labelled {
                    points: points.clone(),
                    text: self.levels.label(*level),
                    look: Text::new(10.0).halo(3.0),
                })
            });
        on_tolerance.chain(on_iso).collect()
    }
}
