//! Process limits of a program, for arms that differ in one parameter.
// A panic is how a test reports a failed assertion; also in functions next to the tests.
#![allow(clippy::unwrap_used, clippy::panic)]

mod arms;

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, Question};
use armill_core::load::{
    Cutter, CuttingLaw, GreatestForce, Immersion, InputUncertainty, Mechanistic, PathLoad,
};
use armill_core::map::{Counts, CutDemand, Permitted, ProgramLimits, along_path, plane_map, program_limits};
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::path::{
    Course, Cutting, Move, Operation, Pace, PathBuilder, Placing, SampledPath, Sampling, Spin, Step, Track,
};
use armill_core::robot::{BranchPattern, JointCompliance, Robot};
use armill_core::source::{Arm, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::{Cancelled, Watch};
use armill_core::workpiece::{Grid, Plane};

const FRONT: BranchChoice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
const LIMIT: f64 = 30e-6;

/// Two lines of 60 mm across each other on a level part.
fn track() -> Track {
    let sampling = Sampling {
        chord_error: 1e-5,
        step: 3e-3,
    };
    let mut builder = PathBuilder::new(sampling, 10_000);
    for (x, y, pace) in [
        (-0.03, 0.0, Pace::Rapid),
        (0.03, 0.0, Pace::Feed(0.02)),
        (0.03, 0.06, Pace::Feed(0.02)),
    ] {
        let next = Move {
            end: Point3::new(x, y, 0.0),
            axis: None,
            spin: None,
            course: Course::Line,
            pace,
            line: 1,
        };
        builder.take(Step::Move(next));
    }
    let base_from_part = Isometry::translation(1.0, 0.1, 0.6);
    Track {
        path: builder.finish().unwrap(),
        placing: Placing {
            base_from_path: base_from_part,
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::Fixed(0.0),
        },
        base_from_part,
        spins: None,
        homes: None,
    }
}

fn cutting() -> Cutting {
    let law = Mechanistic::new(Vector3::new(796e6, 168e6, 222e6), Vector3::zeros()).unwrap();
    Cutting {
        cutter: Cutter::flat(10e-3, 2).unwrap(),
        law: CuttingLaw::Mechanistic(law),
        depth: 1e-3,
        immersion: Immersion::Slot,
        feed: None,
        spindle: Some(8000.0 * TAU / 60.0),
        greatest: GreatestForce::LeftOut,
    }
}

/// Limits of a program of such `operations` for an arm with these drive `compliances`.
fn limits(
    compliances: &[JointCompliance],
    operations: &[(usize, Operation)],
    watch: Watch<'_>,
) -> Result<ProgramLimits, Cancelled> {
    let (robot, track) = (arms::mh12(), track());
    let tool = arms::bent_tool();
    let question = Question {
        homes: None,
        arm: Arm {
            robot: &robot,
            compliance: compliances,
            model: StiffnessModel::DRIVES,
            flange_from_tool: &tool,
        },
        home: None,
        cases: &[],
        uncertainty: InputUncertainty::NONE,
        normal: Vector3::z_axis(),
        choice: FRONT,
        clearance: None,
    };
    let path = SampledPath {
        operations: operations.to_vec(),
        ..track.path.clone()
    };
    let forces = cutting().along(&path, &track.placing, None, Watch::NONE);
    let load = PathLoad::Cuts(forces.unwrap().cuts);
    let found = along_path(&question, &track, load, Watch::NONE).unwrap();
    Ok(program_limits(&question, &track, &found, CutDemand::of_tolerance(LIMIT), watch)?.unwrap())
}

fn softer(robot: &Robot, times: f64) -> Vec<JointCompliance> {
    let scaled = |joint: &JointCompliance| JointCompliance {
        value: joint.value * times,
        ..*joint
    };
    robot.compliance().unwrap().iter().map(scaled).collect()
}

fn up_to(permitted: Permitted) -> f64 {
    let Permitted::UpTo(value) = permitted else {
        panic!("{permitted:?}")
    };
    value
}

#[test]
fn an_arm_twice_as_compliant_permits_half_the_force_and_less_of_everything() {
    let robot = arms::mh12();
    let [stiff, soft] = [1.0, 2.0].map(|times| limits(&softer(&robot, times), &[], Watch::NONE).unwrap());
    assert_eq!(stiff.points.len(), soft.points.len());
    for (stiff, soft) in stiff.points.iter().zip(&soft.points) {
        let forces = [stiff.forces, soft.forces].map(|f| [f.along, f.across, f.normal, f.weakest]);
        for (one, half) in forces[0].iter().zip(forces[1]) {
            assert!((one / half - 2.0).abs() < 1e-9, "{one} {half}");
        }
        let (of_stiff, of_soft) = (stiff.cut.unwrap(), soft.cut.unwrap());
        assert_eq!(
            (of_stiff.width, of_soft.width),
            (None, None),
            "a slot is as wide as the tool"
        );
        // No edge forces: the force is proportional to the feed, and apart from the force-deflection coupling so is the
        // deviation.
        let ratio = up_to(of_stiff.feed_per_tooth) / up_to(of_soft.feed_per_tooth);
        assert!((ratio - 2.0).abs() < 0.1, "{ratio}");
        assert!(up_to(of_stiff.depth) > up_to(of_soft.depth));
    }
}

#[test]
fn a_stiff_arm_permits_all_examined_values() {
    let found = limits(&softer(&arms::mh12(), 1e-6), &[], Watch::NONE).unwrap();
    for point in &found.points {
        let cut = point.cut.unwrap();
        assert_eq!(cut.depth, Permitted::AtLeast(0.03));
        assert_eq!(cut.feed_per_tooth, Permitted::AtLeast(0.5e-3));
    }
    assert_eq!(
        found.least(|cut| Some(cut.depth)).unwrap().1,
        Permitted::AtLeast(0.03)
    );
}

#[test]
fn a_thinner_tool_on_a_part_of_the_way_permits_the_same_depth_of_a_slot() {
    let robot = arms::mh12();
    let thin = Operation {
        diameter: Some(5e-3),
        ..Operation::default()
    };
    let half = track().path.points.len() / 2;
    let found = limits(robot.compliance().unwrap(), &[(half, thin)], Watch::NONE).unwrap();
    let plain = limits(robot.compliance().unwrap(), &[], Watch::NONE).unwrap();
    for (both, wide) in found.points.iter().zip(&plain.points) {
        assert_eq!(both.index, wide.index);
        let [both, wide] = [both.cut.unwrap(), wide.cut.unwrap()];
        // Half the width is half the power at half the lever: the mean force of a slot does not know its width. The
        // scan begins elsewhere, and changes a thousandth.
        let ratio = up_to(both.depth) / up_to(wide.depth);
        assert!((ratio - 1.0).abs() < 2e-3, "{both:?} {wide:?}");
        let ratio = up_to(both.feed_per_tooth) / up_to(wide.feed_per_tooth);
        assert!((ratio - 1.0).abs() < 2e-3, "{both:?} {wide:?}");
    }
    let sheet = found.depth_by_feed.unwrap();
    assert!(sheet.deviations.iter().all(|deviation| *deviation > 0.0));
}

#[test]
fn the_computation_of_limits_can_be_cancelled() {
    let cancel = AtomicBool::new(true);
    let watch = Watch {
        cancel: &cancel,
        ..Watch::NONE
    };
    let robot = arms::mh12();
    assert_eq!(limits(robot.compliance().unwrap(), &[], watch), Err(Cancelled));
}

#[test]
#[should_panic(expected = "a load for each point of the track")]
fn a_load_for_fewer_points_than_the_track_is_refused() {
    let (robot, track, tool) = (arms::mh12(), track(), arms::bent_tool());
    let question = Question {
        homes: None,
        arm: Arm {
            robot: &robot,
            compliance: robot.compliance().unwrap(),
            model: StiffnessModel::DRIVES,
            flange_from_tool: &tool,
        },
        home: None,
        cases: &[],
        uncertainty: InputUncertainty::NONE,
        normal: Vector3::z_axis(),
        choice: FRONT,
        clearance: None,
    };
    let short = PathLoad::OfEach {
        cases: 1,
        frame: armill_core::load::LoadFrame::Feed,
        wrenches: vec![Wrench::from_force(Vector3::x()); track.path.points.len() - 1],
    };
    let _ = along_path(&question, &track, short, Watch::NONE);
}

#[test]
fn counts_of_a_plane_that_is_partly_out_of_reach_add_up_to_its_points() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(1.3, 0.0, 0.8), 0.4);
    let grid = Grid::within([0.8, 0.8], 0.05);
    let tool = Isometry::translation(0.0, 0.0, 0.1);
    let cases = [Wrench::from_force(Vector3::new(30.0, 40.0, -50.0))];
    let question = Question {
        homes: None,
        arm: Arm {
            robot: &robot,
            compliance: robot.compliance().unwrap(),
            model: StiffnessModel::DRIVES,
            flange_from_tool: &tool,
        },
        home: None,
        cases: &cases,
        uncertainty: InputUncertainty::NONE,
        normal: plane.normal(),
        choice: FRONT,
        clearance: None,
    };
    let map = plane_map(&question, plane, grid, Watch::NONE).unwrap();
    let reached = map.answers.evaluations().count();
    assert!(reached > 100 && reached < grid.len() - 100, "{reached}");
    let worst = map.answers.worst().unwrap().1.in_plane;
    let mut before = 0;
    for part in [0.0, 0.2, 0.5, 0.9, 1.0] {
        let counts = Counts::of(&map.answers, part * worst);
        assert_eq!(counts.points(), grid.len());
        assert_eq!(counts.within + counts.above_tolerance, reached);
        assert!(counts.within >= before && counts.within_and_inside_joint_limits <= counts.within);
        assert!((counts.fraction_within() - counts.within as f64 / grid.len() as f64).abs() < 1e-15);
        // Of points within a region at most four cells each.
        let area = map.region(part * worst).area;
        assert!(area <= counts.within as f64 * 4.0 * grid.step.powi(2));
        before = counts.within;
    }
    assert_eq!(before, reached);
    assert_eq!(Counts::default().fraction_within(), 0.0);
}
