use nalgebra::{Point3, Unit, Vector3};

use super::*;
use crate::frame::Isometry;
use crate::load::{Cutter, CuttingLaw, GreatestForce, Immersion, Mechanistic};
use crate::path::{Operation, Pace, PathPoint, Spin};
use crate::watch::Watch;

const MM: f64 = 1e-3;

fn cutting() -> Cutting {
    let law = Mechanistic::new(Vector3::new(1930.4e6, 1159.6e6, 200.6e6), Vector3::zeros()).unwrap();
    Cutting {
        cutter: Cutter::flat(8.0 * MM, 4).unwrap(),
        law: CuttingLaw::Mechanistic(law),
        depth: MM,
        immersion: Immersion::Slot,
        feed: Some(40e-3),
        spindle: Some(300.0),
        greatest: GreatestForce::LeftOut,
    }
}

/// Points along x at these positions, 1 mm deep; a position that repeats begins a cut.
fn path(positions: &[f64], axis: Vector3<f64>) -> SampledPath {
    let mut along = 0.0;
    let mut before: Option<f64> = None;
    let points = positions.iter().map(|x| {
        along += before.map_or(0.0, |before: f64| (x - before).abs() * MM);
        before = Some(*x);
        PathPoint {
            at: Point3::new(*x, 0.0, -1.0) * MM,
            axis: Some(Unit::new_normalize(axis)),
            normal: None,
            spin: None,
            direction: Vector3::x_axis(),
            along,
            pace: Pace::Unknown,
            line: 1,
        }
    });
    SampledPath {
        points: points.collect(),
        ..SampledPath::default()
    }
}

fn placing() -> Placing {
    Placing {
        base_from_path: Isometry::identity(),
        axis: Vector3::z_axis(),
        keeps_axis: false,
        spin: Spin::Fixed(0.0),
    }
}

fn stock() -> Stock {
    let corners = [[-20.0, -10.0, -5.0], [20.0, 10.0, 0.0]].map(|corner| Point3::from(corner) * MM);
    Stock::new(corners, 0.5 * MM).unwrap()
}

/// The heights after each point.
fn replayed(path: &SampledPath) -> Vec<Vec<f32>> {
    let (cutting, placing) = (cutting(), placing());
    let uncut = stock();
    let cut = CutStock::new(&cutting, (path, &placing), &uncut).unwrap();
    let mut replay = cut.replay();
    let mut all = Vec::new();
    while let Some(remaining) = replay.next_point() {
        all.push(remaining.stock().heights().to_vec());
    }
    all
}

#[test]
fn the_stock_at_each_point_is_that_of_the_engagement_up_to_it() {
    let mut whole = path(&[-15.0, -10.0, -4.0, -4.0, 3.0, 9.0], Vector3::z());
    let wider = Operation {
        diameter: Some(12.0 * MM),
        ..Operation::default()
    };
    whole.operations = vec![(0, Operation::default()), (4, wider)];
    let found = replayed(&whole);
    assert_eq!(found.len(), whole.points.len());
    for (index, heights) in found.iter().enumerate() {
        let mut cut = stock();
        let until = SampledPath {
            points: whole.points[..=index].to_vec(),
            ..whole.clone()
        };
        cutting()
            .along(&until, &placing(), Some(&mut cut), Watch::NONE)
            .unwrap();
        assert_eq!(heights, cut.heights(), "point {index}");
        assert!(index == 0 || index == 3 || *heights != found[index - 1]);
    }
}

#[test]
fn what_a_tilted_tool_cuts_remains() {
    let found = replayed(&path(&[-15.0, -10.0, -4.0], Vector3::new(0.1, 0.0, 1.0)));
    assert!(found.iter().all(|heights| heights == stock().heights()));
}

#[test]
fn points_may_be_left_out_but_the_stock_is_cut_at_all_of_them() {
    let whole = path(&[-15.0, -10.0, -4.0, -4.0, 3.0, 9.0], Vector3::z());
    let found = replayed(&whole);
    let (cutting, placing, uncut) = (cutting(), placing(), stock());
    let cut = CutStock::new(&cutting, (&whole, &placing), &uncut).unwrap();
    let mut replay = cut.replay();
    for index in [1, 1, 4, 5] {
        assert_eq!(
            replay.at_point(index).unwrap().stock().heights(),
            found[index],
            "{index}"
        );
    }
    assert!(replay.at_point(6).is_none() && replay.next_point().is_none());
}
