//! How the tool turns about its axis where its part is moved.

use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::frame::{Isometry, tool_orientation};
use crate::kernel::PartPlacement;
use crate::path::{GivenSpin, Spin, Track};

/// How the tool is turned about its axis if its part is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToolTurn {
    /// With the part: along the feed, where whole orientations are given, and where the points have no common axis.
    WithPart,
    /// As by [`tool_orientation`] in base, plus this angle (rad).
    InBase {
        /// The tool relative to the part in the evaluation.
        part_from_tool: UnitQuaternion<f64>,
        /// That angle.
        spin: f64,
    },
}

impl ToolTurn {
    /// The turn of the tool along `track`.
    pub fn of(track: &Track) -> ToolTurn {
        let first = track
            .path
            .points
            .first()
            .filter(|_| track.steady_normal().is_some());
        // With a common axis all points turn equally: the first point represents all.
        let spin = first.and_then(|first| match track.placing.spin {
            Spin::Fixed(angle) => Some(angle),
            Spin::Given(angle) => match first.spin {
                Some(GivenSpin::Angle(given)) => Some(angle + given),
                // A whole orientation is given relative to the part.
                Some(GivenSpin::Orientation(_)) => None,
                None => Some(angle),
            },
            Spin::AlongFeed(_) => None,
        });
        match spin {
            Some(spin) => ToolTurn::InBase {
                part_from_tool: (track.base_from_part.inverse() * track.stop(0).base_from_tool).rotation,
                spin: spin + track.spins.as_ref().map_or(0.0, |spins| spins[0]),
            },
            None => ToolTurn::WithPart,
        }
    }

    /// The placement with this pose of the part, and the tool turned by `spin` (rad) in addition.
    pub fn placement(&self, base_from_part: Isometry, spin: f64) -> PartPlacement {
        let more = match self {
            ToolTurn::WithPart => 0.0,
            ToolTurn::InBase { part_from_tool, spin } => {
                let tool = base_from_part.rotation * part_from_tool;
                let axis = Unit::new_normalize(tool * Vector3::z());
                let turn = tool.inverse() * tool_orientation(axis, *spin);
                2.0 * turn.k.atan2(turn.w)
            }
        };
        PartPlacement {
            base_from_part,
            spin: spin + more,
            rail: None,
        }
    }
}
