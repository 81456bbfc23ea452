//! Rows of a placement search in a cell: a part of triangles behind a wall of triangles with a hole, through which the arm reaches.
//!
//! | work | arm | wall, part |
//! |---|---|---|
//! | [`COARSE`] | MH12, eight capsules | 1000 triangles each |
//! | [`FINE`] | the same | 20 000 triangles each |
//! | [`MESHES`] | eight meshes of 2500 triangles | 20 000 triangles each |
//!
//! The part is a bowl open to the robot; its path is a circle of 360 points near its bottom, the tool along its axis. Placements are a grid of
//! position and turn. In the search a placement no better than the best so far is given up; `all points` counts the lost points of every
//! placement. The first run of a row also calculates the fields of distances. 10 mm are demanded. One thread. Rates count
//! placement x point, given up or not; one branch.

use std::f64::consts::TAU;
use std::hint::black_box;
use std::sync::Arc;

use armill_core::clearance::{Capsule, Cell, DemandedClearance, FixedBody, Mesh, PlacedCell, Shape};
use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::kernel::{PartPlacement, PathWrenches, PlacedPath, PlacedPoint, Question, WrenchAxes};
use armill_core::nalgebra::{Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use armill_core::optimize::{
    Component, Objective, Placeable, PlacementObjective, PostureSelection, RankBy, Score,
};
use armill_core::robot::BranchPattern;
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use rayon::ThreadPool;

use crate::armill::{Arm, ONE_POSTURE};
use crate::clearance::{cell, tessellated};
use crate::clock::Candidate;
use crate::workload::FORCES;

/// Search, arm of capsules, meshes of 1000 triangles.
pub const COARSE: &str = "placement x point, cell of capsules and meshes of 1000";
/// The same without giving up.
pub const COARSE_ALL: &str = "placement x point, cell of capsules and meshes of 1000, all points";
/// Search, arm of capsules, meshes of 20 000 triangles.
pub const FINE: &str = "placement x point, cell of capsules and meshes of 20 000";
/// The same without giving up.
pub const FINE_ALL: &str = "placement x point, cell of capsules and meshes of 20 000, all points";
/// Search, arm of meshes, meshes of 20 000 triangles.
pub const MESHES: &str = "placement x point, cell of meshes";
/// The same without giving up.
pub const MESHES_ALL: &str = "placement x point, cell of meshes, all points";

/// Points of the path.
const POINTS: usize = 360;
/// Placements: along x, y and z, and turns.
const GRID: [usize; 4] = [6, 6, 6, 4];
/// Placements of a call; one that is no better than the best before is given up.
const CALL: usize = 108;
/// The demanded clearance, m.
const LEAST: f64 = 0.01;
/// Tool of the cell, m.
const TOOL: f64 = 0.28;

/// A cell, the path on its part, and placements.
pub struct PlacedCells {
    cell: Cell,
    tool: Isometry,
    path: PlacedPath,
    placements: Vec<PartPlacement>,
    work: [&'static str; 2],
}

impl PlacedCells {
    /// Every cell.
    pub fn all(arm: &Arm) -> [PlacedCells; 3] {
        [
            PlacedCells::of(arm, Shape::Capsule, 1000, [COARSE, COARSE_ALL]),
            PlacedCells::of(arm, Shape::Capsule, 20_000, [FINE, FINE_ALL]),
            PlacedCells::of(arm, tessellated, 20_000, [MESHES, MESHES_ALL]),
        ]
    }

    fn of(arm: &Arm, shape: fn(Capsule) -> Shape, triangles: usize, work: [&'static str; 2]) -> PlacedCells {
        let body =
            |name: &str, corners: Vec<[Point3<f64>; 3]>, frame_from_body: Isometry, is_part| FixedBody {
                name: name.to_owned(),
                shape: Shape::Mesh(Arc::new(
                    Mesh::new(corners, true).expect("the body has triangles"),
                )),
                frame_from_body,
                is_part,
            };
        let wall = body(
            "wall",
            wall(triangles),
            Isometry::translation(0.62, 0.0, 0.95),
            false,
        );
        let part = body("part", bowl(triangles), Isometry::identity(), true);
        PlacedCells {
            cell: cell(arm.robot(), shape, LEAST, &[wall, part]),
            tool: Isometry::translation(0.0, 0.0, TOOL),
            path: path(),
            placements: placements(),
            work,
        }
    }

    /// The best score of all placements; with `gives_up` those that are no better than the best so far are left.
    pub fn search(&self, arm: &Arm, gives_up: bool) -> Score {
        let here = Isometry::identity();
        let mut question: Question<'_> = arm.question(ONE_POSTURE);
        question.arm.flange_from_tool = &self.tool;
        question.clearance = Some(DemandedClearance {
            placed: PlacedCell {
                cell: &self.cell,
                base_from_part: &here,
            },
            least: LEAST,
        });
        let placeable = Placeable {
            question: &question,
            path: &self.path,
            objective: PlacementObjective {
                component: Component::InPlane,
                objective: Objective::Worst,
                branches: BranchPattern::FRONT_ELBOW_UP,
                margin: 0.0,
                wrist: 0.0,
                rank_by: RankBy::Nominal,
                selection: PostureSelection::ForPath,
            },
        };
        let mut best = Score::NONE;
        for places in self.placements.chunks(CALL) {
            let bar = gives_up.then_some(&best);
            let scores = placeable.scores(places, bar, Watch::NONE);
            for score in scores.expect("not cancelled").into_iter().flatten() {
                if score.beats(&best) {
                    best = score;
                }
            }
        }
        best
    }
}

/// A winding order of the grid, so that neighbours are not evaluated one after the other, as in a search.
fn placements() -> Vec<PartPlacement> {
    let count: usize = GRID.iter().product();
    let axes = Matrix3::from_columns(&[Vector3::y(), -Vector3::z(), -Vector3::x()]);
    let turned = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let of = |index: usize| {
        let mut rest = (index * 367) % count;
        let [x, y, z, turn] = GRID.map(|steps| {
            let step = rest % steps;
            rest /= steps;
            step as f64 / (steps - 1) as f64 - 0.5
        });
        let by = from_xyz_and_fixed_angles(
            Vector3::new(0.95 + 0.3 * x, 0.5 * y, 0.95 + 0.5 * z),
            Vector3::new(0.0, 0.0, 0.6 * turn),
        );
        PartPlacement {
            base_from_part: by * turned,
            spin: 0.0,
            rail: None,
        }
    };
    (0..count).map(of).collect()
}

/// A circle of radius 50 mm, the tool against +z of the part.
fn path() -> PlacedPath {
    let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    let point = |k: usize| {
        let angle = TAU * k as f64 / POINTS as f64;
        PlacedPoint {
            part_from_tool: Isometry::from_parts(
                Translation3::new(0.05 * angle.cos(), 0.05 * angle.sin(), 0.0),
                down,
            ),
            along: [Vector3::x(), Vector3::y()],
        }
    };
    PlacedPath::new(
        (0..POINTS).map(point).collect(),
        PathWrenches {
            wrench_axes: WrenchAxes::Part,
            cases: FORCES.len(),
            wrenches: FORCES.map(|force| Wrench::from_force(force.into())).to_vec(),
        },
    )
}

/// A plate across x of 1.6 x 1.6 m, 20 mm thick, with a round hole of radius 0.25 m: rings of squares around the hole.
fn wall(triangles: usize) -> Vec<[Point3<f64>; 3]> {
    let around = (triangles as f64 / 5.0).sqrt().round() as usize * 2;
    let section = |s: f64, angle: f64| {
        // Around the cross-section: front, outer edge, back, inner edge.
        let outer = 0.8 / angle.cos().abs().max(angle.sin().abs());
        let (x, part) = match s {
            s if s < 0.4 => (-0.01, s / 0.4),
            s if s < 0.5 => (-0.01 + 0.02 * (s - 0.4) / 0.1, 1.0),
            s if s < 0.9 => (0.01, 1.0 - (s - 0.5) / 0.4),
            s => (0.01 - 0.02 * (s - 0.9) / 0.1, 0.0),
        };
        let radius = 0.25 + part * (outer - 0.25);
        Point3::new(x, radius * angle.cos(), radius * angle.sin())
    };
    ring(triangles, [around, 10], section)
}

/// A bowl about z, open to +z: radius 0.15 m, 0.12 m deep, its wall 10 mm thick, around a bottom with a hole of radius 20 mm.
fn bowl(triangles: usize) -> Vec<[Point3<f64>; 3]> {
    let around = (triangles as f64 / 5.0).sqrt().round() as usize * 2;
    // Radius and height of the corners of the cross-section.
    const CORNERS: [[f64; 2]; 7] = [
        [0.02, -0.01],
        [0.12, -0.01],
        [0.15, 0.10],
        [0.16, 0.10],
        [0.13, -0.02],
        [0.02, -0.02],
        [0.02, -0.01],
    ];
    let section = |s: f64, angle: f64| {
        let at = s * (CORNERS.len() - 1) as f64;
        let (index, part) = (at as usize, at.fract());
        let [from, to] = [CORNERS[index], CORNERS[index + 1]];
        let [radius, z] = [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]));
        Point3::new(radius * angle.cos(), radius * angle.sin(), z)
    };
    ring(triangles, [around, CORNERS.len() - 1], section)
}

/// About so many triangles of a closed section turned about an axis: `around` steps in a circle, and a multiple of `steps` along the
/// section; `section`: the point at a part of its length and an angle, rad.
fn ring(
    triangles: usize,
    [around, steps]: [usize; 2],
    section: impl Fn(f64, f64) -> Point3<f64>,
) -> Vec<[Point3<f64>; 3]> {
    let across = (triangles / 2 / around).next_multiple_of(steps);
    let at = |i: usize, j: usize| {
        section(
            (i % across) as f64 / across as f64,
            TAU * (j % around) as f64 / around as f64,
        )
    };
    let squares = (0..across).flat_map(|i| (0..around).map(move |j| (i, j)));
    squares
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// Every row.
pub fn candidates<'a>(
    arm: &'a Arm,
    cells: &'a [PlacedCells],
    one_thread: &'a ThreadPool,
) -> Vec<Candidate<'a>> {
    let rows = cells
        .iter()
        .flat_map(|cell| [(cell, cell.work[0], true), (cell, cell.work[1], false)]);
    rows.map(|(cell, work, gives_up)| {
        let count = cell.placements.len() * POINTS;
        Candidate::new("armill placement", work, count, move || {
            one_thread.install(|| black_box(cell.search(arm, gives_up)));
        })
    })
    .collect()
}
