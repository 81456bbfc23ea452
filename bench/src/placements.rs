//! Rows of a placement search: placements of a path, evaluated exhaustively.
//!
//! | work | path | load |
//! |---|---|---|
//! | [`STEADY`] | one tool axis, one spin of the tool | four cases in the axes of the part |
//! | [`LEANING`] | the tool axis differs from point to point | four cases in the feed frame |
//!
//! The first also as a search: a placement is dropped where it is known to be no better than the best so far, at the
//! first point that shows it ([`SEARCH_WORST`]) or, for the mean, late ([`SEARCH_MEAN`]). One thread. Rates count
//! placement x point x case of all placements, dropped or not; one branch, its flip, limits and singularities are
//! evaluated.

use std::f64::consts::TAU;
use std::hint::black_box;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::kernel::{PartPlacement, PlacedPath, Question};
use armill_core::load::{LoadCases, LoadFrame, PathLoad};
use armill_core::nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};
use armill_core::optimize::{
    Component, Objective, Placeable, PlacementObjective, PostureSelection, RankBy, Score, ToolTurn, on_part,
};
use armill_core::path::{LoadedTrack, Pace, PathPoint, Placing, SampledPath, Spin, Track};
use armill_core::robot::BranchPattern;
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use rayon::ThreadPool;

use crate::armill::{Arm, Modelled, ONE_POSTURE};
use crate::clock::Candidate;
use crate::workload::FORCES;

/// Placements evaluated, one tool axis.
pub const STEADY: &str = "placement x point x case, one tool axis";
/// Placements evaluated, variable tool axis.
pub const LEANING: &str = "placement x point x case, five axes";
/// Placements evaluated with springs and gravity.
pub const WHOLE: &str = "placement x point x case, 18 springs and gravity";
/// A search for the smallest largest deviation.
pub const SEARCH_WORST: &str = "placement x point x case, search for the least largest";
/// A search for the smallest mean deviation.
pub const SEARCH_MEAN: &str = "placement x point x case, search for the least mean";

/// Points of the path.
const POINTS: usize = 20_000;
/// Placements evaluated in a run, and those of a search: the best of a grid of 10^6 is found among ever fewer that beat
/// it.
const PLACES: usize = 24;
const SEARCHED: usize = 480;

/// A path on a part, and its placements.
pub struct Places {
    path: PlacedPath,
    /// The first [`PLACES`] and all others of a search.
    placements: Vec<PartPlacement>,
}

impl Places {
    /// A path of one tool axis.
    pub fn steady() -> Places {
        Places::of(0.0, LoadFrame::Part)
    }

    /// A path of a tool that leans.
    pub fn leaning() -> Places {
        Places::of(0.15, LoadFrame::Feed)
    }

    fn of(lean: f64, frame: LoadFrame) -> Places {
        let load = PathLoad::Cases(LoadCases {
            frame,
            cases: FORCES.map(|force| Wrench::from_force(force.into())).to_vec(),
        });
        let track = track(lean);
        let all: Vec<usize> = (0..POINTS).collect();
        let turn = ToolTurn::of(&track);
        let part = |k: usize| (k as f64 * 0.618).fract() - 0.5;
        // All six degrees, near enough that every point is reachable.
        let placements = (0..SEARCHED).map(|k| {
            let at = Vector3::new(part(k), part(3 * k), part(7 * k)) * 0.1;
            let turned = Vector3::new(part(5 * k), part(11 * k), part(13 * k)) * 0.2;
            turn.placement(track.base_from_part * from_xyz_and_fixed_angles(at, turned), 0.0)
        });
        Places {
            placements: placements.collect(),
            path: on_part(
                LoadedTrack {
                    track: &track,
                    load: &load,
                },
                Component::InPlane,
                &all,
            ),
        }
    }
}

/// A winding line on a plate before the arm.
fn track(lean: f64) -> Track {
    let points = (0..POINTS).map(|k| {
        let angle = TAU * k as f64 / 2000.0;
        let at = Vector3::new(0.1 * angle.cos(), 0.1 * (0.7 * angle).sin(), 1e-3 * angle.sin());
        PathPoint {
            at: at.into(),
            axis: (lean > 0.0).then(|| {
                Unit::new_normalize(Vector3::new(lean * (3.0 * angle).cos(), lean * angle.sin(), 1.0))
            }),
            normal: None,
            spin: None,
            direction: Unit::new_normalize(Vector3::new(-angle.sin(), angle.cos(), 0.01)),
            along: k as f64 * 1e-3,
            pace: Pace::Feed(0.02),
            line: k as u32 + 1,
        }
    });
    let axes = Matrix3::from_columns(&[Vector3::y(), -Vector3::z(), -Vector3::x()]);
    let turned = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let base_from_part = Isometry::from_parts(Vector3::new(0.95, 0.0, 0.8).into(), turned);
    Track {
        path: SampledPath {
            points: points.collect(),
            ..SampledPath::default()
        },
        placing: Placing {
            base_from_path: base_from_part,
            axis: Vector3::z_axis(),
            keeps_axis: lean == 0.0,
            spin: if lean > 0.0 {
                Spin::AlongFeed(0.0)
            } else {
                Spin::Fixed(0.0)
            },
        },
        base_from_part,
        spins: None,
        homes: None,
    }
}

/// The score of the best of these placements on the calling thread; a search drops those that are no better.
fn best(
    arm: &Arm,
    modelled: Modelled,
    (path, placements): (&PlacedPath, &[PartPlacement]),
    search: Option<Objective>,
) -> Score {
    let question: Question<'_> = arm.question_with(modelled, ONE_POSTURE);
    let placeable = Placeable {
        question: &question,
        path,
        objective: PlacementObjective {
            component: Component::InPlane,
            objective: search.unwrap_or(Objective::Worst),
            branches: BranchPattern::FRONT_ELBOW_UP,
            margin: 0.0,
            wrist: 0.0,
            rank_by: RankBy::Nominal,
            selection: PostureSelection::ForPath,
        },
    };
    let mut best = Score::NONE;
    for chunk in placements.chunks(4) {
        let bar = search.is_some().then_some(&best);
        let scores = placeable.scores(chunk, bar, Watch::NONE);
        for score in scores.expect("not cancelled").into_iter().flatten() {
            assert!(
                search.is_some() || score.unreachable == 0,
                "{} points unreachable",
                score.unreachable
            );
            if score.beats(&best) {
                best = score;
            }
        }
    }
    best
}

impl Places {
    /// Evaluates the first `count` placements, none dropped; the score of the best.
    pub fn evaluate(&self, arm: &Arm, modelled: Modelled, count: usize) -> Score {
        best(arm, modelled, (&self.path, &self.placements[..count]), None)
    }

    /// Points x cases of a placement.
    pub fn size(&self) -> usize {
        POINTS * self.path.case_count()
    }

    fn search(&self, arm: &Arm, objective: Objective) -> Score {
        let all = (&self.path, &self.placements[..]);
        best(arm, Modelled::Drives, all, Some(objective))
    }
}

/// Every row.
pub fn candidates<'a>(
    arm: &'a Arm,
    [steady, leaning]: [&'a Places; 2],
    one_thread: &'a ThreadPool,
) -> Vec<Candidate<'a>> {
    const WHO: &str = "armill placement";
    let evaluated = move |places: &Places, modelled: Modelled, count: usize| {
        one_thread.install(|| black_box(places.evaluate(arm, modelled, count)));
    };
    let searched = move |objective: Objective| {
        one_thread.install(|| black_box(steady.search(arm, objective)));
    };
    let count = |places: usize| places * steady.size();
    vec![
        Candidate::new(WHO, STEADY, count(PLACES), move || {
            evaluated(steady, Modelled::Drives, PLACES);
        })
        .note("MH12, 20 000 points, four cases; six free degrees"),
        Candidate::new(WHO, LEANING, count(PLACES), move || {
            evaluated(leaning, Modelled::Drives, PLACES);
        })
        .note("the same, with a rotation, directions and wrenches of its own at each point"),
        Candidate::new(WHO, WHOLE, count(PLACES / 8), move || {
            evaluated(steady, Modelled::Springs, PLACES / 8);
        })
        .note("as with one tool axis"),
        Candidate::new(WHO, SEARCH_WORST, count(SEARCHED), move || {
            searched(Objective::Worst);
        })
        .note("480 places; one no better than the best so far is given up, seen in single precision first"),
        Candidate::new(WHO, SEARCH_MEAN, count(SEARCHED), move || {
            searched(Objective::Mean);
        })
        .note("the same, where the mean counts"),
    ]
}
