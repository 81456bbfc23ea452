//! Marked points of a plane: their signs, the text next to them, and their entries in a legend.
//!
//! A marker is a place in the plane, not a measure: its sign has the same size at every scale.

use crate::colour::INK;
use crate::font::SMALL_PX;
use crate::legend::{Entry, Key, diamond};
use crate::plane::Plane;
use crate::svg::{Point, Style, Svg, Text};

/// From a point up to the baseline of its name.
const NAME_ABOVE_PX: f64 = 8.0;

/// What a marked point represents; decides its sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MarkerKind {
    /// A point of interest: a ring.
    #[default]
    Point,
    /// The best point: a filled diamond.
    Best,
}

/// A marked point on a map or track.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marker {
    /// Horizontal and vertical value in mm; a marker that is not finite is left out.
    pub at_mm: [f64; 2],
    /// What is marked, for the legend; markers with the same label share an entry, an empty one has none.
    pub label: String,
    /// Its sign.
    pub kind: MarkerKind,
    /// What is written above the sign, such as a number; empty for nothing.
    pub name: String,
}

impl Marker {
    /// Whether both coordinates are numbers.
    fn is_somewhere(&self) -> bool {
        self.at_mm.iter().all(|v| v.is_finite())
    }
}

/// Draws the sign of a marker, and its name above it; nothing for a marker that is not finite.
pub(crate) fn draw_marker(svg: &mut Svg, plane: &Plane, marker: &Marker) {
    if !marker.is_somewhere() {
        return;
    }
    let at = plane.at(marker.at_mm);
    draw_sign(svg, at, marker.kind);
    if !marker.name.is_empty() {
        write_on_map(svg, [at[0], at[1] - NAME_ABOVE_PX], &marker.name);
    }
}

/// Draws the sign of a place that is marked.
pub(crate) fn draw_sign(svg: &mut Svg, at: Point, kind: MarkerKind) {
    match kind {
        MarkerKind::Point => svg.circle(at, 3.5, &style(kind)),
        MarkerKind::Best => svg.polygon(&diamond(at, 7.0), &style(kind)),
    }
}

/// One entry for each label, in the order of the markers; the sign is that of the first with this label.
pub(crate) fn marker_entries(markers: &[Marker]) -> Vec<Entry> {
    let mut named: Vec<&str> = Vec::new();
    let mut entries = Vec::new();
    for marker in markers.iter().filter(|m| !m.label.is_empty() && m.is_somewhere()) {
        if !named.contains(&marker.label.as_str()) {
            named.push(&marker.label);
            let key = match marker.kind {
                MarkerKind::Point => Key::Dot(style(marker.kind)),
                MarkerKind::Best => Key::Diamond(style(marker.kind)),
            };
            entries.push(Entry::new(key, marker.label.clone()));
        }
    }
    entries
}

/// A small text at a place on a map, readable on any band.
pub(crate) fn write_on_map(svg: &mut Svg, at: Point, content: &str) {
    svg.text(at, content, &Text::new(SMALL_PX).bold().middle().halo(3.5));
}

/// Fill and edge of a sign.
fn style(kind: MarkerKind) -> Style {
    match kind {
        MarkerKind::Point => Style::fill("#fff").outlined(INK, 1.6),
        MarkerKind::Best => Style::fill("#E69F00").outlined(INK, 1.2),
    }
}
