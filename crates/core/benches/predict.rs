//! Forward, inverse (8 postures), compliance, deviation and one map, of an MH12 on the plane x = 1000 mm.
//!
//! For people: `cargo xtask bench`. Throughput counts poses (points).
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../tests/arms/mod.rs"]
mod arms;

use std::hint::black_box;

use armill_core::compliance::compliance_at_tool;
use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, Question};
use armill_core::map::plane_map;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::predict::predict;
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use armill_core::workpiece::{Grid, Plane};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rs_opw_kinematics::kinematic_traits::Kinematics;
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;

fn cases() -> Vec<Wrench> {
    let force = |y: f64, z: f64| Wrench::from_force(Vector3::new(3.0, y, z));
    vec![
        force(-5.0, -5.0),
        force(-5.0, 5.0),
        force(5.0, -5.0),
        force(5.0, 5.0),
    ]
}

/// The MH12 as rs-opw-kinematics has it: opw_parameters_mh12.yaml of ros-industrial/motoman.
fn peer() -> OPWKinematics {
    use std::f64::consts::{FRAC_PI_2, PI};
    OPWKinematics::new(Parameters {
        a1: 0.155,
        a2: -0.200,
        b: 0.0,
        c1: 0.450,
        c2: 0.614,
        c3: 0.640,
        c4: 0.100,
        offsets: [0.0, 0.0, -FRAC_PI_2, 0.0, 0.0, PI],
        sign_corrections: [1, 1, -1, -1, -1, -1],
        dof: 6,
    })
}

fn one_pose(c: &mut Criterion) {
    let robot = arms::mh12();
    let (arm, compliance) = (robot.ortho_parallel().unwrap(), robot.compliance().unwrap());
    let tool = Isometry::translation(0.0, 0.0, 0.15);
    let q = [0.2, 0.3, -0.4, 0.5, 0.6, 0.7];
    let posture = posture_at(&robot, &q, &tool);
    let push = cases()[0];
    let mut group = c.benchmark_group("one pose");
    group.throughput(Throughput::Elements(1));
    group.bench_function("forward and screws", |b| {
        b.iter(|| posture_at(&robot, black_box(&q), &tool));
    });
    group.bench_function("inverse, 8 postures, verified", |b| {
        let at = ToolAt {
            flange_from_tool: &tool,
            near: None,
        };
        b.iter(|| postures(&robot, arm, black_box(&posture.base_from_tool), at));
    });
    // A peer on the same pose in the same run: absolute numbers mean nothing across machines.
    let peer = peer();
    let pose = peer.forward(&q);
    group.bench_function("inverse, all postures, rs-opw-kinematics 3.0", |b| {
        b.iter(|| peer.inverse(black_box(&pose)));
    });
    group.bench_function("compliance 6x6 of a posture", |b| {
        b.iter(|| compliance_at_tool(black_box(&posture.screws), compliance));
    });
    group.bench_function("deviation of a posture, with shares and covariance", |b| {
        b.iter(|| predict(black_box(&posture), compliance, &push));
    });
    group.finish();
}

fn one_map(c: &mut Criterion) {
    let robot = arms::mh12();
    let (tool, cases) = (Isometry::translation(0.0, 0.0, 0.15), cases());
    let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.0);
    let grid = Grid::within([0.4, 0.4], 0.008);
    let mut group = c.benchmark_group("map of 101 x 101 points, 4 cases, one thread");
    group.throughput(Throughput::Elements(grid.len() as u64));
    group.sample_size(20);
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let named = BranchChoice::Of("front elbow-up".parse().unwrap());
    let whole = BranchChoice::Of("front elbow-up flip".parse().unwrap());
    for (name, choice) in [
        ("one posture", whole),
        ("front elbow-up, either wrist", named),
        ("best of all", BranchChoice::Best),
    ] {
        let question = Question {
            robot: &robot,
            arm: robot.ortho_parallel().unwrap(),
            compliance: robot.compliance().unwrap(),
            flange_from_tool: &tool,
            cases: &cases,
            normal: plane.normal(),
            choice,
        };
        group.bench_function(name, |b| {
            one_thread.install(|| {
                b.iter(|| plane_map(&question, plane, grid, Watch::NONE));
            });
        });
    }
    group.finish();
}

criterion_group!(benches, one_pose, one_map);
criterion_main!(benches);
