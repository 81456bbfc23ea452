use std::f64::consts::PI;

use nalgebra::{Point3, UnitQuaternion, Vector3};

use super::*;
use crate::arms;
use crate::clearance::{Bounds, Capsule, Cell, PlacedCell, Segment};
use crate::frame::Isometry;
use crate::load::{Cutter, CuttingLaw, GreatestForce, Immersion, Mechanistic};
use crate::path::{Cutting, Placing, SampledPath, Spin, Stock};
use crate::robot::Attachment;
use crate::source::{Arm, StiffnessModel};

/// A ball on the link next to the hand, about the axis of the flange.
fn ball(name: &str, radius: f64, role: Role) -> ArmBody {
    let axis = Segment {
        from: Point3::origin(),
        to: Point3::origin(),
    };
    ArmBody {
        name: name.to_owned(),
        attachment: Attachment::Joint(0),
        attachment_from_body: Isometry::identity(),
        shape: Shape::Capsule(Capsule { axis, radius }),
        role,
    }
}

#[test]
fn a_link_that_is_always_near_a_stock_in_the_hand_only_must_not_touch_it() {
    const LEAST: f64 = 0.5;
    let arm = arms::mh12();
    let mount = Isometry::from_parts(
        Vector3::new(1.0, 0.0, 0.8).into(),
        UnitQuaternion::from_axis_angle(&Vector3::y_axis(), PI),
    );
    let hand = arm.holding_part(&mount).unwrap();
    let tool = Isometry::identity();
    let bodies = vec![
        ball("wrist", 0.05, Role::Link),
        ball("large wrist", 0.4, Role::Link),
        ball("holder", 0.05, Role::Holder),
        ball("cutter", 0.4, Role::Cutter),
    ];
    let cell = Cell::new(&hand, &tool, bodies, &[], &[]);
    let here = Isometry::identity();
    let demanded = DemandedClearance {
        placed: PlacedCell {
            cell: &cell,
            base_from_part: &here,
        },
        least: LEAST,
    };
    let question = Question::unloaded(
        Arm {
            robot: &hand,
            compliance: arm.compliance().unwrap(),
            flange_from_tool: &tool,
            model: StiffnessModel::DRIVES,
        },
        None,
    );
    let law = Mechanistic::new(Vector3::new(1e9, 1e9, 1e8), Vector3::zeros()).unwrap();
    let cutting = Cutting {
        cutter: Cutter::flat(0.01, 2).unwrap(),
        law: CuttingLaw::Mechanistic(law),
        depth: 1e-3,
        immersion: Immersion::Slot,
        feed: Some(0.01),
        spindle: Some(300.0),
        greatest: GreatestForce::LeftOut,
    };
    let (path, placing) = (
        SampledPath::default(),
        Placing {
            base_from_path: here,
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::Fixed(0.0),
        },
    );
    // A block from 0.2 to 0.3 m in front of the axis of the flange, in every direction of the arm.
    let corners = [[0.2, -0.1, -0.1], [0.3, 0.1, 0.1]].map(Point3::from);
    let stock = Stock::new(corners, 0.01).unwrap();
    let cut_stock = CutStock::new(&cutting, (&path, &placing), &stock).unwrap();
    assert_eq!(cut_stock.extent(), Bounds::of(corners));
    let remaining = RemainingStock::new(stock.clone());
    let mut near = ArmNearStock::new(&question, demanded, &cut_stock);
    near.set_joints(&[0.1; 6]);
    // Not the cutter; the last body first.
    assert_eq!(near.bodies(), [2, 1, 0]);
    let mut of = |body: usize| near.is_in_conflict(body, &remaining, LEAST);
    assert_eq!([of(0), of(1), of(2)], [false, true, true]);
    let distance = |found: Option<Clearance>| found.map(|found| (found.nearest.distance, found.bodies));
    let by_design = distance(near.nearest(&remaining, f64::INFINITY, true));
    assert_eq!(by_design, Some((0.0, [1, cell.stock_index()])));
    let (holder, bodies) = distance(near.nearest(&remaining, f64::INFINITY, false)).unwrap();
    assert_eq!(bodies, [2, cell.stock_index()]);
    assert!(holder > 0.0 && holder < LEAST, "{holder}");
}
