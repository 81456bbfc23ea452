use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::{IsometryMatrix3, Point2, Vector3};

use super::*;
use crate::arms;
use crate::clearance::{self, Bounds, Capsule, CellState, PlacedCell, Role, Segment};
use crate::frame::from_xyz_and_fixed_angles;
use crate::load::{
    Cutter, CuttingLaw, GreatestForce, Immersion, LeaningForces, LoadCases, LoadFrame, Mechanistic, PathLoad,
};
use crate::map::{AlongPath, along_postures, measure_stock_clearances};
use crate::optimize::column_at::fill;
use crate::optimize::posture::tests::{search, track};
use crate::optimize::window::Window;
use crate::optimize::{
    LeanRange, Objective, PostureFound, PostureSearch, SearchedPath, Steps, postures_in_stock,
};
use crate::path::{Cutting, LoadedTrack, RoundedEnd, Shape as PathShape, Stock, Track};
use crate::robot::{Robot, Unreachable};
use crate::source::{Arm, StiffnessModel};
use crate::spatial::Wrench;

const MM: f64 = 1e-3;
/// Radius of the cutter, m.
const RADIUS: f64 = 10.0 * MM;
/// Side of a cell, m.
const SIDE: f64 = 10.0 * MM;
/// Half the side of the stock, m.
const HALF: f64 = 100.0 * MM;
/// Where the path is across the feed, m.
const ACROSS: f64 = -90.0 * MM;

/// An arm with a spindle across its flange, which cuts along an edge of a block: the cutter leaves a wall next to it.
struct Edge {
    robot: Robot,
    tool: Isometry,
    cell: clearance::Cell,
    track: Track,
    load: PathLoad,
    /// Top of the stock above the tip, m.
    top: f64,
    stock: Stock,
}

fn bodies() -> Vec<ArmBody> {
    let line = |from: [f64; 3], to: [f64; 3]| Segment {
        from: Point3::from(from),
        to: Point3::from(to),
    };
    let body = |name: &str, attachment: Attachment, shape: Shape, role: Role| ArmBody {
        name: name.to_owned(),
        attachment,
        attachment_from_body: Isometry::identity(),
        shape,
        role,
    };
    let forearm = Capsule {
        axis: line([0.2, 0.0, 0.0], [0.5, 0.0, 0.0]),
        radius: 60.0 * MM,
    };
    // The axis of the tool is along x of the flange, 0.15 m from it: this is on one side of it.
    let spindle = Bounds::of([[-0.08, -0.02, 0.02], [0.05, 0.02, 0.135]].map(Point3::from));
    vec![
        body(
            "forearm",
            Attachment::Joint(3),
            Shape::Capsule(forearm),
            Role::Link,
        ),
        body("spindle", Attachment::Flange, Shape::Box(spindle), Role::Holder),
        body(
            "holder",
            Attachment::Tool,
            Shape::Cylinder(line([0.0, 0.0, -0.02], [0.0, 0.0, -0.05]), 8.0 * MM),
            Role::Holder,
        ),
        body(
            "cutter",
            Attachment::Tool,
            Shape::Cylinder(line([0.0, 0.0, 0.0], [0.0, 0.0, -0.02]), RADIUS),
            Role::Cutter,
        ),
    ]
}

impl Edge {
    /// With the top of the stock at this height above the path, m.
    fn new(top: f64) -> Edge {
        let robot = arms::mh12();
        let tool = from_xyz_and_fixed_angles(Vector3::new(0.1, 0.0, 0.15), Vector3::new(0.0, PI / 2.0, 0.0));
        let points = [-90.0, 90.0].map(|along| Point2::new(ACROSS, along * MM));
        let path = PathShape::Polyline(points.to_vec()).sampled(30.0 * MM);
        let corners = [[-HALF, -HALF, -20.0 * MM], [HALF, HALF, top]].map(Point3::from);
        Edge {
            cell: clearance::Cell::new(&robot, &tool, bodies(), &[], &[]),
            track: track(path, Point3::new(0.85, 0.0, 0.3)),
            load: PathLoad::Cases(LoadCases {
                frame: LoadFrame::Feed,
                cases: vec![Wrench::from_force(Vector3::new(-80.0, 30.0, 10.0))],
            }),
            robot,
            tool,
            top,
            stock: Stock::new(corners, SIDE).unwrap(),
        }
    }

    fn question(&self, least: Option<f64>) -> Question<'_> {
        let arm = Arm {
            robot: &self.robot,
            compliance: self.robot.compliance().unwrap(),
            flange_from_tool: &self.tool,
            model: StiffnessModel::DRIVES,
        };
        let placed = PlacedCell {
            cell: &self.cell,
            base_from_part: &self.track.base_from_part,
        };
        Question {
            clearance: least.map(|least| DemandedClearance { placed, least }),
            ..Question::unloaded(arm, None)
        }
    }

    fn cut_stock(&self) -> CutStock<'_> {
        let law = Mechanistic::new(Vector3::new(1930.4e6, 1159.6e6, 200.6e6), Vector3::zeros()).unwrap();
        let cutting = Cutting {
            cutter: Cutter::flat(2.0 * RADIUS, 4).unwrap(),
            law: CuttingLaw::Mechanistic(law),
            depth: MM,
            immersion: Immersion::Slot,
            feed: Some(40e-3),
            spindle: Some(300.0),
            greatest: GreatestForce::LeftOut,
        };
        CutStock::new(&cutting, (&self.track.path, &self.track.placing), &self.stock).unwrap()
    }

    fn loaded(&self) -> LoadedTrack<'_> {
        LoadedTrack {
            track: &self.track,
            load: &self.load,
        }
    }

    /// The columns of all points, before the stock is taken into account.
    fn columns(&self, search: &PostureSearch, window: &Window) -> Vec<Column> {
        let question = self.question(None);
        let mut maker = crate::kernel::Columns::new(question.arm, None, search.wrist);
        let forces = LeaningForces::of(&self.load);
        let mut fill = |index: usize| {
            let mut column = Column::default();
            fill(
                (&mut maker, &forces),
                self.loaded(),
                index,
                (search, window),
                &mut column,
            );
            column
        };
        (0..self.track.len()).map(&mut fill).collect()
    }

    /// Boxes of all columns of the stock after the step to a point, base frame of the path: those whose middle the
    /// upright cutter has passed over end at its tip.
    fn boxes(&self, point: usize) -> Vec<Shape> {
        let along = |index: usize| self.track.path.points[index].at.y;
        let count = (2.0 * HALF / SIDE).round() as usize;
        let middle = |index: usize| -HALF + (index as f64 + 0.5) * SIDE;
        let cells = (0..count).flat_map(|x| (0..count).map(move |y| [middle(x), middle(y)]));
        let column = |[x, y]: [f64; 2]| {
            let passed = y.clamp(along(0), along(point));
            let is_cut = (x - ACROSS).hypot(y - passed) < RADIUS;
            let top = if is_cut { 0.0 } else { self.top };
            let corner = |by: f64, z: f64| Point3::new(x + by, y + by, z);
            Shape::Box(Bounds::of([
                corner(-SIDE / 2.0, -20.0 * MM),
                corner(SIDE / 2.0, top),
            ]))
        };
        cells.map(column).collect()
    }

    fn found(
        &self,
        search: &PostureSearch,
        least: Option<f64>,
        stock: Option<&CutStock<'_>>,
    ) -> PostureFound {
        let path = SearchedPath::new(self.loaded(), stock);
        postures_in_stock(&self.question(least), path, search, Watch::NONE).unwrap()
    }

    /// The answers along the path with what was found, with the clearances from the stock.
    fn measured(&self, found: &PostureFound, least: f64) -> AlongPath {
        let question = self.question(Some(least));
        let (turned, load) = (found.turned(&self.track), found.load(&self.load));
        let mut along = along_postures(&question, &turned, load, found.choices(), Watch::NONE).unwrap();
        measure_stock_clearances(&question, &self.cut_stock(), &mut along, Watch::NONE).unwrap();
        along
    }
}

/// Spins alone, or with a lean.
fn searches() -> [PostureSearch; 2] {
    let spins = search(Objective::Mean);
    let angles = Steps {
        first: -0.3,
        step: 0.3,
        count: 3,
    };
    let leaning = PostureSearch {
        spins: Steps {
            step: PI / 6.0,
            count: 12,
            ..spins.spins
        },
        lean: Some(LeanRange {
            leads: angles,
            tilts: angles,
            rate: 20.0,
            end: RoundedEnd {
                radius: RADIUS,
                corner: RADIUS,
            },
            stepover: None,
        }),
        ..spins.clone()
    };
    [spins, leaning]
}

#[test]
fn free_postures_are_those_of_which_every_body_is_measured_against_every_column() {
    const LEAST: f64 = MM;
    let edge = Edge::new(60.0 * MM);
    let stock = edge.cut_stock();
    let question = edge.question(Some(LEAST));
    let demanded = question.clearance.unwrap();
    let mut state = CellState::new(demanded.placed, &edge.robot, &edge.tool);
    let path_from_base: IsometryMatrix3<f64> = nalgebra::convert(edge.track.placing.base_from_path.inverse());
    for search in searches() {
        let window = Window::all(&search);
        let before = edge.columns(&search, &window);
        let points: Vec<usize> = (0..before.len()).collect();
        let decided = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                let mut columns = before.clone();
                let mut clear = ClearOfStock::new(&question, demanded, &stock, LEAST);
                let spins = window.grid().spins();
                // In two calls, as in a search.
                let (first, rest) = columns.split_at_mut(3);
                clear.exclude(&points[..3], first, spins, Watch::NONE).unwrap();
                clear.exclude(&points[3..], rest, spins, Watch::NONE).unwrap();
                columns
            })
        };
        let after = decided(1);
        for (point, (before, after)) in before.iter().zip(&after).enumerate() {
            let boxes: Vec<_> = (edge.boxes(point).iter())
                .map(|shape| shape.placed(&IsometryMatrix3::identity()))
                .collect();
            let (mut kept, mut lost) = (0, 0);
            for slot in 0..before.statuses.len() {
                if before.statuses[slot] != PostureStatus::Usable {
                    assert_eq!(after.statuses[slot], before.statuses[slot]);
                    continue;
                }
                state.set_joints(before.joints_of(slot, 6));
                // All but the cutter.
                let is_free = (0..3).all(|body| {
                    let frame = path_from_base * state.base_from_body()[body];
                    let own = edge.cell.arm()[body].shape.placed(&frame);
                    let is_near = |other| {
                        own.nearest(other, LEAST)
                            .is_some_and(|found| found.distance < LEAST)
                    };
                    !boxes.iter().any(is_near)
                });
                let expected = match is_free {
                    true => PostureStatus::Usable,
                    false => PostureStatus::InCollision,
                };
                assert_eq!(after.statuses[slot], expected, "point {point}, slot {slot}");
                assert_eq!(after.deviations[slot].is_finite(), is_free);
                (kept, lost) = (kept + usize::from(is_free), lost + usize::from(!is_free));
            }
            assert!(kept > 10 && lost > 10, "point {point}: {kept} {lost}");
        }
        for threads in [2, 3, 16] {
            let others = decided(threads);
            assert!(after.iter().zip(&others).all(|(a, b)| a.statuses == b.statuses));
        }
    }
}

#[test]
fn a_search_that_sees_the_stock_keeps_the_clearance_at_all_points_where_one_without_it_does_not() {
    const LEAST: f64 = 1.5 * MM;
    let edge = Edge::new(60.0 * MM);
    let stock = edge.cut_stock();
    for search in searches() {
        let blind = edge.measured(&edge.found(&search, Some(LEAST), None), LEAST);
        let is_lost = |point: &Result<_, Unreachable>| matches!(point, Err(Unreachable::InCollision { .. }));
        let lost = blind.answers.points.iter().filter(|point| is_lost(point)).count();
        assert!(lost > 0, "a case without need of the stock");
        let found = edge.found(&search, Some(LEAST), Some(&stock));
        assert_eq!((&found.unreachable, &found.breaks), (&Vec::new(), &Vec::new()));
        let along = edge.measured(&found, LEAST);
        for (index, point) in along.answers.points.iter().enumerate() {
            assert!(point.is_ok(), "point {index}: {point:?}");
            let clearance = along.answers.clearances[index].unwrap().nearest.distance;
            assert!(clearance >= LEAST, "point {index}: {clearance}");
        }
    }
}

#[test]
fn where_no_posture_is_free_the_body_and_what_is_missing_are_known() {
    // The holder, 16 mm wide, is 2 mm from the wall that a cutter of 20 mm leaves: whatever the spin, 3 mm are missing.
    const LEAST: f64 = 5.0 * MM;
    let edge = Edge::new(35.0 * MM);
    let stock = edge.cut_stock();
    let [search, _] = searches();
    let found = edge.found(&search, Some(LEAST), Some(&stock));
    assert_eq!(found.unreachable.len(), edge.track.len());
    let along = edge.measured(&found, LEAST);
    for point in &along.answers.points {
        let Err(Unreachable::InCollision { missing, bodies }) = point else {
            panic!("{point:?}")
        };
        // The map has single precision.
        assert!((missing - 3.0 * MM).abs() < 1e-8, "{missing}");
        assert_eq!(bodies.map(|body| edge.cell.name(body)), ["holder", "stock"]);
    }
}

#[test]
fn a_stock_that_is_far_away_or_no_demanded_clearance_changes_nothing() {
    let edge = Edge::new(60.0 * MM);
    let stock = edge.cut_stock();
    // Below the path: nothing of the arm is near.
    let low = Edge::new(-10.0 * MM);
    let far = low.cut_stock();
    for search in searches() {
        let same = |least: Option<f64>, stock: &CutStock<'_>| {
            let found = [None, Some(stock)].map(|stock| edge.found(&search, least, stock));
            let [without, with] = found;
            assert_eq!(with.spins, without.spins);
            assert_eq!(with.branches, without.branches);
            assert_eq!(
                with.leans.map(|leans| leans.0),
                without.leans.map(|leans| leans.0)
            );
            assert_eq!(with.reached, without.reached);
            assert_eq!(with.lattice.deviations, without.lattice.deviations);
        };
        same(None, &stock);
        same(Some(MM), &far);
    }
}

#[test]
fn it_stops_when_cancelled() {
    let edge = Edge::new(60.0 * MM);
    let stock = edge.cut_stock();
    let [search, _] = searches();
    let question = edge.question(Some(MM));
    let path = SearchedPath::new(edge.loaded(), Some(&stock));
    let cancel = AtomicBool::new(true);
    let watch = Watch {
        cancel: &cancel,
        ..Watch::NONE
    };
    let mut clear = ClearOfStock::new(&question, question.clearance.unwrap(), &stock, MM);
    let window = Window::all(&search);
    let mut columns = edge.columns(&search, &window);
    assert!(clear.exclude(&[0], &mut columns[..1], 36, watch).is_err());
    assert!(postures_in_stock(&question, path, &search, watch).is_err());
    // In the middle: after the first columns are finished.
    cancel.store(false, Ordering::Relaxed);
    let stopping = Watch {
        finished: &|_| cancel.store(true, Ordering::Relaxed),
        cancel: &cancel,
    };
    assert!(postures_in_stock(&question, path, &search, stopping).is_err());
}

/// Rows across the block, with its top this far above them, in cells of half a millimetre.
fn rows(top: f64, step: f64) -> Edge {
    let mut edge = Edge::new(top);
    let corners = (0..50).flat_map(|row| {
        let across = -95.0 + 190.0 * f64::from(row) / 49.0;
        let ends = if row % 2 == 0 {
            [-100.0, 100.0]
        } else {
            [100.0, -100.0]
        };
        ends.map(|along| Point2::new(across, along) * MM)
    });
    let path = PathShape::Polyline(corners.collect()).sampled(step);
    edge.track = track(path, Point3::new(0.85, 0.0, 0.3));
    edge.stock = Stock::new(edge.stock.corners(), 0.5 * MM).unwrap();
    edge
}

#[test]
fn a_round_holder_near_the_walls_of_a_slot_loses_no_point_to_the_room_that_other_bodies_need() {
    // The holder is 2 mm from the walls of the first slot. Smoothed spins bring the spindle nearer than demanded, so that
    // the search is repeated with more than 2 mm for it.
    const LEAST: f64 = 1.5 * MM;
    let edge = rows(48.0 * MM, 4.0 * MM);
    let [search, _] = searches();
    let found = edge.found(&search, Some(LEAST), Some(&edge.cut_stock()));
    let without: Vec<usize> = found.unreachable.iter().map(|(index, _)| *index).collect();
    assert!(without.len() * 50 < edge.track.len(), "{without:?}");
    let along = edge.measured(&found, LEAST);
    let lost = |index: &usize| along.answers.points[*index].is_err() && !without.contains(index);
    let lost: Vec<usize> = (0..edge.track.len()).filter(lost).collect();
    assert!(lost.is_empty(), "{lost:?} and {without:?}");
}
