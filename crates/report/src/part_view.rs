//! A part in the colours of the deviation of its surface, from an angle and from above.
//!
//! Deviations have signs: red where material is left, blue where too much is removed, grey for what has no value. The range of the colours is symmetric and covers
//! 99.5 % of the values; those beyond have the colours of its ends. The surface itself is pixels, everything else is drawn.

use base64::Engine;

use crate::arm::Projection;
use crate::axis::extent;
use crate::colour::{ColourScale, INK, MUTED};
use crate::colour_bar::ColourBar;
use crate::font::SMALL_PX;
use crate::legend::{Entry, Key};
use crate::levels::Levels;
use crate::page::{BORDER_PX, Heading};
use crate::shaded::{Corner, Shaded};
use crate::svg::{Rect, Style, Svg, Text, num};
use crate::tolerance;

/// A place with a number.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceMark {
    /// Where, mm.
    pub at_mm: [f64; 3],
    /// Its label.
    pub label: String,
}

/// The input of a picture of a part; lists of vertices are of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartView {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// The quantity of the colours, with unit.
    pub quantity: String,
    /// Permissible size of the deviation.
    pub tolerance_um: Option<f64>,
    /// Vertices; z is up.
    pub vertices_mm: Vec<[f64; 3]>,
    /// Unit normals, outwards.
    pub normals: Vec<[f64; 3]>,
    /// Deviation at each vertex; not a number where there is none.
    pub values_um: Vec<f64>,
    /// Indices of the vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Size of the deviations that the colours cover; of these deviations if left out.
    pub range_um: Option<f64>,
    /// Places with numbers.
    pub marks: Vec<PlaceMark>,
}

/// Sides of both panels, and the gap between them.
const PANEL_PX: [f64; 2] = [440.0, 380.0];
const GAP_PX: f64 = 20.0;
/// Pixels of the surface to one of the picture.
const FINE: f64 = 2.0;
/// Part of the values that the colours cover.
const COVERED: f64 = 0.995;
/// A mark is seen if less than this part of the size of the part is in front of it.
const SLACK: f64 = 0.01;
const MARK_PX: f64 = 8.0;

/// Directions of the panels: azimuth and elevation of the viewer, deg.
const PANELS: [(&str, [f64; 2]); 2] = [
    ("from the front, above", [-65.0, 38.0]),
    ("from above (along −z)", [-90.0, 90.0]),
];

impl PartView {
    /// The picture as a complete SVG document; a part without triangles, or with coordinates that are not finite, gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        if self.triangles.is_empty() {
            return heading.notice("There is nothing to draw: no material is left.");
        }
        let counts = [self.normals.len(), self.values_um.len()];
        let count = self.vertices_mm.len();
        let is_known = |triangle: &[u32; 3]| triangle.iter().all(|vertex| (*vertex as usize) < count);
        let is_finite = self.vertices_mm.iter().flatten().all(|mm| mm.is_finite());
        if counts != [count; 2] || !self.triangles.iter().all(is_known) || !is_finite {
            return heading.notice("The part cannot be drawn: its surface is not complete.");
        }
        let Some(levels) = self.levels() else {
            return heading.notice("There is nothing to draw: no surface of the part is compared.");
        };
        let bar = ColourBar {
            levels: &levels,
            scale: ColourScale::BlueRed,
            quantity: &self.quantity,
            tolerance_um: self.tolerance_um,
        };
        let panels = PANELS.len() as f64;
        let drawing = Rect {
            x: BORDER_PX,
            y: 0.0,
            w: panels * PANEL_PX[0] + (panels - 1.0) * GAP_PX,
            h: PANEL_PX[1],
        };
        let width = bar.right_of(drawing).right() + BORDER_PX;
        let mut page = heading.page(width);
        let top = page.top_px + 14.0;
        for (place, (name, [azimuth, elevation])) in PANELS.iter().enumerate() {
            let area = Rect {
                x: BORDER_PX + place as f64 * (PANEL_PX[0] + GAP_PX),
                y: top,
                w: PANEL_PX[0],
                h: PANEL_PX[1],
            };
            let text = Text::new(SMALL_PX).colour(MUTED);
            page.svg.text([area.x, top - 2.0], name, &text);
            if self
                .draw(
                    &mut page.svg,
                    area,
                    &Projection::from(*azimuth, *elevation),
                    &levels,
                )
                .is_err()
            {
                return heading.notice("The part cannot be drawn: its pixels cannot be encoded.");
            }
        }
        let bar_area = bar.right_of(Rect { y: top, ..drawing });
        bar.draw(&mut page.svg, bar_area);
        let bottom = bar_area.bottom().max(top + PANEL_PX[1]) + 14.0;
        page.finish_with_legend(&self.entries(), [BORDER_PX, bottom])
    }

    /// Size of the deviations that the colours cover, um: that of 99.5 % of the values; `None` where none is finite.
    pub fn colour_limit(values_um: &[f64]) -> Option<f64> {
        let finite = values_um.iter().filter(|um| um.is_finite());
        let mut sizes: Vec<f64> = finite.map(|um| um.abs()).collect();
        let last = sizes.len().checked_sub(1)?;
        sizes.sort_by(f64::total_cmp);
        sizes
            .get(((sizes.len() as f64 * COVERED) as usize).min(last))
            .copied()
    }

    /// Bands of equal range on both sides of zero.
    fn levels(&self) -> Option<Levels> {
        let covered = PartView::colour_limit(&self.values_um)?;
        let covered = self
            .range_um
            .filter(|um| um.is_finite() && *um > 0.0)
            .unwrap_or(covered);
        Levels::covering([-covered, covered])
    }

    /// One panel: the surface, and the marks on it.
    fn draw(
        &self,
        svg: &mut Svg,
        area: Rect,
        projection: &Projection,
        levels: &Levels,
    ) -> Result<(), png::EncodingError> {
        let flat = |k: usize| extent(self.vertices_mm.iter().map(move |at| projection.flat(*at)[k]));
        let (Some((left, right)), Some((low, high))) = (flat(0), flat(1)) else {
            return Ok(());
        };
        let room = [area.w - 2.0 * MARK_PX, area.h - 2.0 * MARK_PX];
        let scale = (room[0] / (right - left).max(1e-9)).min(room[1] / (high - low).max(1e-9));
        let centre = [0.5 * (left + right), 0.5 * (low + high)];
        let within = |flat: [f64; 2]| {
            [
                0.5 * area.w + scale * (flat[0] - centre[0]),
                0.5 * area.h - scale * (flat[1] - centre[1]),
            ]
        };
        let mut shaded = Shaded::new([area.w, area.h].map(|side| (side * FINE) as usize));
        let corner = |vertex: u32| {
            let index = vertex as usize;
            let of = (self.vertices_mm[index], self.normals[index]);
            Corner::new(projection, of, self.values_um[index], |flat| {
                within(flat).map(|px| px * FINE)
            })
        };
        let bands: Vec<[u8; 3]> = (0..levels.bands()).map(|band| rgb(levels, band)).collect();
        let colour = |um: f64| {
            let band = levels.inner_um().iter().take_while(|edge| um > **edge).count();
            bands.get(band).copied().unwrap_or_default()
        };
        for triangle in &self.triangles {
            shaded.triangle(triangle.map(corner), &colour);
        }
        let data = base64::engine::general_purpose::STANDARD.encode(shaded.to_png()?);
        let [x, y, w, h] = [area.x, area.y, area.w, area.h].map(num);
        svg.image(&format!(
            "x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" href=\"data:image/png;base64,{data}\""
        ));
        let slack_mm = SLACK * (right - left).max(high - low);
        for mark in &self.marks {
            let at = within(projection.flat(mark.at_mm));
            let depth_mm = projection.depth(mark.at_mm);
            let is_visible = shaded.is_visible(at.map(|px| px * FINE), depth_mm, slack_mm);
            let at = [area.x + at[0], area.y + at[1]];
            let ground = Style::fill(if is_visible { "#ffffff" } else { "#e8e8e8" }).outlined(INK, 1.2);
            svg.circle(at, MARK_PX, &ground);
            let text = Text::new(SMALL_PX).bold().middle();
            let text = if is_visible { text } else { text.colour(MUTED) };
            svg.text([at[0], at[1] + 4.0], &mark.label, &text);
        }
        Ok(())
    }

    fn entries(&self) -> Vec<Entry> {
        let mut entries = Vec::new();
        if self.values_um.iter().any(|um| !um.is_finite()) {
            entries.push(Entry::new(
                Key::field("#cdcdcd"),
                "not made by the program, or not compared",
            ));
        }
        let sizes = self.values_um.iter().map(|um| um.abs());
        entries.extend(tolerance::entry_over(self.tolerance_um, sizes));
        if !self.marks.is_empty() {
            let ring = Key::Dot(Style::fill("#ffffff").outlined(INK, 1.2));
            entries.push(Entry::new(ring, "worst places; grey ones are behind"));
        }
        entries
    }
}

/// Colour of a band.
fn rgb(levels: &Levels, band: usize) -> [u8; 3] {
    let text = levels.colour(band, ColourScale::BlueRed);
    [1, 3, 5].map(|from| u8::from_str_radix(text.get(from..from + 2).unwrap_or("00"), 16).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 10 mm at z = 0, and one at z = 5 over its right half.
    fn two_squares() -> PartView {
        let square = |x: f64, z: f64| [[x, 0.0, z], [10.0, 0.0, z], [10.0, 10.0, z], [x, 10.0, z]];
        PartView {
            title: "part".to_owned(),
            quantity: "deviation, µm".to_owned(),
            vertices_mm: square(0.0, 0.0).into_iter().chain(square(5.0, 5.0)).collect(),
            normals: vec![[0.0, 0.0, 1.0]; 8],
            values_um: [[-50.0; 4], [50.0; 4]].concat(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
            ..PartView::default()
        }
    }

    /// The colour of a picture's own pixels at this place of a panel, from 0 to 1.
    fn colour_at(view: &PartView, [u, v]: [f64; 2]) -> [u8; 3] {
        let levels = view.levels().expect("values");
        let mut shaded = Shaded::new([100, 100]);
        let projection = Projection::from(-90.0, 90.0);
        for triangle in &view.triangles {
            let corner = |vertex: u32| {
                let of = (view.vertices_mm[vertex as usize], view.normals[vertex as usize]);
                let pixels = |flat: [f64; 2]| [10.0 * flat[0], 100.0 - 10.0 * flat[1]];
                Corner::new(&projection, of, view.values_um[vertex as usize], pixels)
            };
            shaded.triangle(triangle.map(corner), &|um| {
                if um > 0.0 {
                    rgb(&levels, levels.bands() - 1)
                } else {
                    rgb(&levels, 0)
                }
            });
        }
        let pixel = (v * 100.0) as usize * 100 + (u * 100.0) as usize;
        [0, 1, 2].map(|k| shaded.rgb[3 * pixel + k])
    }

    #[test]
    fn from_above_the_higher_surface_covers_the_lower_one() {
        let view = two_squares();
        let ([r, _, b], [r_, _, b_]) = (colour_at(&view, [0.25, 0.5]), colour_at(&view, [0.75, 0.5]));
        assert!(b > r, "too much removed is blue: {r} {b}");
        assert!(r_ > b_, "material left is red: {r_} {b_}");
        let svg = view.to_svg();
        assert!(svg.contains("data:image/png;base64,") && svg.contains("from above"));
    }

    #[test]
    fn what_cannot_be_drawn_says_so() {
        let mut view = two_squares();
        view.triangles.push([0, 1, 8]);
        assert!(view.to_svg().contains("not complete"));
        assert!(PartView::default().to_svg().contains("no material is left"));
        let mut view = two_squares();
        view.values_um = vec![f64::NAN; 8];
        assert!(view.to_svg().contains("no surface of the part is compared"));
    }
}
