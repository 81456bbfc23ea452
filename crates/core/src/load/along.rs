//! The load along a path: it may turn with the feed and change from point to point.

use nalgebra::Rotation3;

use super::cases::{LoadCases, LoadFrame};
use crate::frame::Isometry;
use crate::spatial::Wrench;

/// What pushes on the tool at the points of a path.
#[derive(Clone, Debug, PartialEq)]
pub enum PathLoad {
    /// The same cases everywhere, told in their frame.
    Cases(LoadCases),
    /// Each point has wrenches of its own: so many a point, point after point.
    OfEach {
        /// Wrenches a point.
        cases: usize,
        /// Axes that they are told in.
        frame: LoadFrame,
        /// All of them.
        wrenches: Vec<Wrench>,
    },
}

impl PathLoad {
    /// Load cases a point.
    pub fn case_count(&self) -> usize {
        match self {
            PathLoad::Cases(load) => load.cases.len(),
            PathLoad::OfEach { cases, .. } => *cases,
        }
    }

    /// Fills in the wrenches at point `index` in base axes.
    pub fn in_base(
        &self,
        index: usize,
        base_from_part: &Isometry,
        base_from_feed: &Rotation3<f64>,
        out: &mut [Wrench],
    ) {
        let (told, axes) = match self {
            PathLoad::Cases(load) => (&load.cases[..], load.frame),
            PathLoad::OfEach {
                cases,
                frame,
                wrenches,
            } => (&wrenches[index * cases..][..*cases], *frame),
        };
        let turned = match axes {
            LoadFrame::Base => Rotation3::identity(),
            LoadFrame::Part => base_from_part.rotation.to_rotation_matrix(),
            LoadFrame::Feed => *base_from_feed,
        };
        for (out, told) in out.iter_mut().zip(told) {
            *out = Wrench {
                force: turned * told.force,
                moment: turned * told.moment,
            };
        }
    }
}
