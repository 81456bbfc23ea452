//! The load along a path: it may turn with the feed, change from point to point, and give way with the tool.

use nalgebra::{Rotation3, Vector3};

use super::cases::{LoadCases, LoadFrame};
use super::cutter::Cutter;
use super::law::CuttingLaw;
use super::milling::Cut;
use crate::frame::Isometry;
use crate::spatial::Wrench;

/// What pushes on the tool at the points of a path.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one for a whole path")]
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
    /// A tool cuts on its way.
    Cuts(CutsAlong),
}

/// What is cut along a path, and what that pushes with.
#[derive(Clone, Debug, PartialEq)]
pub struct CutsAlong {
    /// The tools.
    pub cutters: Vec<Cutter>,
    /// Force of a chip.
    pub law: CuttingLaw,
    /// Whether the greatest force of a revolution is a second load case.
    pub with_greatest: bool,
    /// The cut at every point.
    pub points: Vec<CutHere>,
}

/// The cut at a point, as drawn; forces in the feed frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutHere {
    /// Which of the tools.
    pub cutter: usize,
    /// What is cut; `None` in the air, and where no force is known.
    pub cut: Option<Cut>,
    /// Mean force over a revolution, N.
    pub mean: Vector3<f64>,
    /// Greatest force of a revolution, N; zero where nobody asks for it.
    pub greatest: Vector3<f64>,
}

impl CutHere {
    /// Nothing is cut.
    pub const NOTHING: CutHere = CutHere {
        cutter: 0,
        cut: None,
        mean: Vector3::new(0.0, 0.0, 0.0),
        greatest: Vector3::new(0.0, 0.0, 0.0),
    };

    /// Its forces where the mean one has become `mean` (N): the greatest goes with it.
    pub fn under(&self, mean: Vector3<f64>) -> [Vector3<f64>; 2] {
        let share = mean.norm() / self.mean.norm().max(f64::MIN_POSITIVE);
        [mean, self.greatest * share]
    }
}

impl PathLoad {
    /// Load cases a point.
    pub fn case_count(&self) -> usize {
        match self {
            PathLoad::Cases(load) => load.cases.len(),
            PathLoad::OfEach { cases, .. } => *cases,
            PathLoad::Cuts(cuts) if cuts.with_greatest => 2,
            PathLoad::Cuts(_) => 1,
        }
    }

    /// Whether it is the same at every point of a path, whatever way that goes.
    pub fn is_steady(&self) -> bool {
        matches!(self, PathLoad::Cases(load) if load.frame != LoadFrame::Feed)
    }

    /// Fills in the wrenches at point `index` in base axes; of cuts those of the path as drawn.
    pub fn in_base(
        &self,
        index: usize,
        base_from_part: &Isometry,
        base_from_feed: &Rotation3<f64>,
        out: &mut [Wrench],
    ) {
        let of_cut;
        let (told, axes) = match self {
            PathLoad::Cases(load) => (&load.cases[..], load.frame),
            PathLoad::OfEach {
                cases,
                frame,
                wrenches,
            } => (&wrenches[index * cases..][..*cases], *frame),
            PathLoad::Cuts(cuts) => {
                let here = &cuts.points[index];
                of_cut = [here.mean, here.greatest].map(Wrench::from_force);
                (&of_cut[..], LoadFrame::Feed)
            }
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
