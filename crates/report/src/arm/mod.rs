//! The posture of the arm: a schematic drawing from joint origins and axes, seen from a chosen side.
//!
//! `view`: from which side; `drawing`: what is shown; `body`: the posture as solids; `shapes`: solids on paper;
//! `scene`: the whole drawing; `bodies`: the bodies of its cell.
//!
//! | what | drawn as |
//! |---|---|
//! | posture | solids in full colour, a name in a badge next to each joint |
//! | ghosts | the same, faint, without foot and names |
//! | plate, path | a translucent quadrilateral, a red line on white |
//! | standing tool | a tool without an arm |
//! | floor | a grid of nice steps with the arm's shadow; a line where it is seen from the side |
//! | frame of the ground | three arrows at the lower left, x red, y green, z blue |
//!
//! All points are in the frame of the ground, in mm: that of the base, unless what the arm is drawn relative to moves. Nothing about the arm's shape is known but its joints: how thick it
//! is drawn follows from its length.

mod bodies;
mod body;
mod drawing;
mod scene;
mod shapes;
mod view;

pub use bodies::{BodyKind, CellBody, CellView, NearestPair};
pub use drawing::{ArmDrawing, ArmJoint, ArmPosture};
pub(crate) use view::Projection;
pub use view::View;

use crate::font::SMALL_PX;
use crate::page::{BORDER_PX, Heading};
use crate::svg::{Rect, Text};
use drawing::is_finite;
use scene::{Scene, draw_scene, wanted_height_px};

/// Largest drawing of one view, and each of several panels: width, height.
const SINGLE_PX: [f64; 2] = [600.0, 520.0];
const PANEL_PX: [f64; 2] = [390.0, 340.0];

impl ArmDrawing {
    /// The drawing as a complete SVG document, as high as it needs; an arm without joints, or with a point that
    /// is not finite, gives a picture that says so.
    pub fn to_svg(&self) -> String {
        self.drawn(&[self.view], SINGLE_PX)
    }

    /// The same arm from several sides, two panels in a row, each with the name of its view; a notice without
    /// views.
    pub fn to_svg_views(&self, views: &[View]) -> String {
        self.drawn(views, PANEL_PX)
    }

    /// Title block and one panel for each view.
    fn drawn(&self, views: &[View], panel_px: [f64; 2]) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        if self.posture.joints.is_empty() || views.is_empty() {
            return heading.notice("There is nothing to draw: the arm has no joints.");
        }
        if !is_finite(&self.posture) {
            return heading.notice("The arm cannot be drawn: the position of a joint is not finite.");
        }
        let scene = Scene::of(self);
        let panel_px = match views {
            [view] => [
                panel_px[0],
                wanted_height_px(&scene, *view, panel_px[0], [260.0, panel_px[1]]),
            ],
            _ => panel_px,
        };
        let columns = views.len().min(2);
        let gap = 16.0;
        let width = 2.0 * BORDER_PX + columns as f64 * (panel_px[0] + gap) - gap;
        let mut page = heading.page(width);
        let top = page.top_px;
        let title_row = if views.len() > 1 { 20.0 } else { 0.0 };
        for (k, view) in views.iter().enumerate() {
            let x = BORDER_PX + (k % columns) as f64 * (panel_px[0] + gap);
            let y = top + (k / columns) as f64 * (panel_px[1] + title_row + gap) + title_row;
            if views.len() > 1 {
                page.svg
                    .text([x, y - 7.0], view.name(), &Text::new(SMALL_PX).bold());
            }
            let area = Rect {
                x,
                y,
                w: panel_px[0],
                h: panel_px[1],
            };
            draw_scene(&mut page.svg, &scene, *view, area);
        }
        let rows = views.len().div_ceil(columns) as f64;
        page.finish(top + rows * (panel_px[1] + title_row + gap) - gap)
    }
}
