//! The posture of the arm: a schematic drawing from joint origins and axes, seen from a chosen side.
//!
//! `view`: from which side; `body`: the posture as solids; `shapes`: solids on paper; `scene`: the whole drawing.
//!
//! | what | drawn as |
//! |---|---|
//! | posture | solids in full colour, a name in a badge next to each joint |
//! | ghosts | the same, faint, without foot and names |
//! | plate, path | a translucent quadrilateral, a red line on white |
//! | floor | a grid of nice steps with the arm's shadow; a line where it is seen from the side |
//! | base frame | three arrows at the lower left, x red, y green, z blue |
//!
//! All points are in the base frame, in mm. Nothing about the arm's shape is known but its joints: how thick it
//! is drawn follows from its length.

mod body;
mod scene;
mod shapes;
mod view;

pub use view::View;

use crate::font::SMALL_PX;
use crate::page::{BORDER_PX, Heading};
use crate::svg::{Rect, Text};
use scene::{Scene, draw_scene, wanted_height_px};

/// One joint of a posture, in the base frame, at the position that it has in this posture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmJoint {
    /// Its name, written next to it: `S`; empty for none.
    pub name: String,
    /// A point on its axis, in mm; links are drawn from origin to origin.
    pub origin_mm: [f64; 3],
    /// Direction of its axis, of any length; one of no length counts as z.
    pub axis: [f64; 3],
}

/// The arm in one posture, in the base frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmPosture {
    /// The position of the foot, in mm. The foot is drawn about the axis of the first joint.
    pub base_mm: [f64; 3],
    /// The joints from base to flange.
    pub joints: Vec<ArmJoint>,
    /// Centre of the flange, in mm.
    pub flange_mm: [f64; 3],
    /// Tool centre point, in mm; where it is the flange, no tool is drawn.
    pub tool_mm: [f64; 3],
}

/// What an arm drawing shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmDrawing {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// The posture drawn in full.
    pub posture: ArmPosture,
    /// Further postures, drawn faintly behind it; one without joints, or with a point that is not finite, is
    /// left out.
    pub ghosts: Vec<ArmPosture>,
    /// Corners of a plate in mm, in order around it. Not checked: that they are in one plane.
    pub plate_mm: Option<[[f64; 3]; 4]>,
    /// Path of the tool in mm; points that are not finite are left out.
    pub path_mm: Vec<[f64; 3]>,
    /// From where the arm is seen; `to_svg_views` takes its own.
    pub view: View,
}

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

/// Whether every point of a posture is a number.
fn is_finite(posture: &ArmPosture) -> bool {
    let points = posture.joints.iter().flat_map(|j| [j.origin_mm, j.axis]);
    points
        .chain([posture.base_mm, posture.flange_mm, posture.tool_mm])
        .flatten()
        .all(f64::is_finite)
}
