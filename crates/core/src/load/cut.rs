//! What a tool cuts: depth, strip of material, feed per tooth, lean of the tool.
//!
//! Depth and feed are along and across the programmed axis, the normal of the surface; the axes of a leaning tool are
//!
//! ```text
//! x = (F - (F.a) a)/|F - (F.a) a|        y = a x x        z = a
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `F` | feed per tooth | m |
//! | `a` | tool axis from the tip to the spindle ([`Lean::axis`]) | - |

use nalgebra::{Matrix3, Vector3};

use super::end_mill_body::EndMillBody;
use super::engagement::Engagement;
use super::lean::{Lean, LeanInCut};

/// What is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Depth along the programmed axis, m.
    pub depth: f64,
    /// Where round the tool.
    pub engagement: Engagement,
    /// Feed per tooth across the programmed axis, m.
    pub feed: f64,
    /// Feed per tooth along the programmed axis to the spindle, m; negative on a ramp down.
    pub rise: f64,
    /// Lean of the tool from the programmed axis.
    pub lean: LeanInCut,
}

/// Below this length, m, the feed across the tool axis has no direction.
const NO_FEED: f64 = 1e-12;

impl Cut {
    /// The same cut with the tool leaning by `lean` from the normal of the surface; its strip keeps its width and its side,
    /// and a strip inside the tool keeps its distance from the middle of the tool.
    #[must_use]
    pub fn leaning(&self, lean: Lean, body: &EndMillBody) -> Cut {
        if lean == Lean::NONE {
            return Cut {
                lean: LeanInCut::default(),
                ..*self
            };
        }
        if self.engagement.pass_before().is_some() {
            // The tool leaned in the same way there: its distance is the same.
            let moved = [0.0; 2];
            return Cut {
                lean: LeanInCut { lean, moved },
                ..*self
            };
        }
        let [upright, leaning] = [Lean::NONE, lean].map(|lean| body.extent(lean, self.depth));
        let moved = [0, 1].map(|side| leaning[side] - upright[side]);
        let [right, left] = self.engagement.edges();
        let moved = if left >= body.radius() {
            [moved[1]; 2]
        } else if right <= -body.radius() {
            [moved[0]; 2]
        } else {
            [0.5 * (moved[0] + moved[1]); 2]
        };
        Cut {
            lean: LeanInCut { lean, moved },
            ..*self
        }
    }

    /// The same with depth and edges of the engagement rounded to multiples of `part` of the `diameter` (m).
    #[must_use]
    pub(super) fn rounded(&self, part: f64, diameter: f64) -> Cut {
        let step = part * diameter;
        Cut {
            depth: (self.depth / step).round().max(1.0) * step,
            engagement: self.engagement.rounded(step, diameter / 2.0),
            ..*self
        }
    }

    /// Axes of the feed frame of the leaning tool, along the feed, to its left and along the normal of the surface.
    pub(super) fn tool_axes(&self) -> Matrix3<f64> {
        let axis = self.lean.lean.axis();
        let feed = Vector3::new(self.feed, 0.0, self.rise);
        let across = feed - axis * feed.dot(&axis);
        // A tool that is fed along its axis has no direction across it: any will do, its edges cut alike all round.
        let x = across
            .try_normalize(NO_FEED)
            .unwrap_or_else(|| axis.cross(&Vector3::y()).normalize());
        Matrix3::from_columns(&[x, axis.cross(&x), axis])
    }

    /// Part of a deviation (m, feed frame of the tool) across the normal of the surface, m.
    pub(crate) fn in_plane(&self, deviation: &Vector3<f64>) -> f64 {
        if self.lean.lean == Lean::NONE {
            return deviation.xy().norm();
        }
        let [_, normal] = self.left_and_normal();
        (deviation - normal * normal.dot(deviation)).norm()
    }

    /// The directions to the left of the feed and along the normal of the surface, in the feed frame of the tool.
    pub(super) fn left_and_normal(&self) -> [Vector3<f64>; 2] {
        if self.lean.lean == Lean::NONE {
            return [Vector3::y(), Vector3::z()];
        }
        let axes = self.tool_axes();
        [1, 2].map(|row| axes.row(row).transpose())
    }
}
