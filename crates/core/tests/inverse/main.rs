//! Every kind of inverse compared with forward kinematics, on common arms.
//!
//! `round_trips`: joints, pose, joints; `spherical_wrist`, `search`: the kinds without named branches; `branches`:
//! meaning of the names; `redundant_joints`: rails and seven axes; `out_of_reach`: no posture, or infinitely many;
//! `kernel`: the same inverses in maps and paths.

// A panic is how a test fails; in helper functions too.
#![allow(clippy::unwrap_used)]

#[path = "../arms/mod.rs"]
mod arms;
mod branches;
mod kernel;
mod out_of_reach;
mod redundant_joints;
mod round_trips;
mod search;
mod spherical_wrist;

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::nalgebra::Matrix4;
use armill_core::robot::Robot;
use armill_core::robot::inverse::{ToolAt, posture_at, postures};

use arms::Stream;
use arms::other::DhRow;

/// The tool on its flange, without previous joint positions and home.
fn at(tool: &Isometry) -> ToolAt<'_> {
    ToolAt::on(tool)
}

/// Largest difference of two joint positions, modulo whole turns, rad (m).
fn apart(robot: &Robot, a: &[f64], b: &[f64]) -> f64 {
    let of = |i: usize| {
        let away = a[i] - b[i];
        if robot.slides(i) {
            away.abs()
        } else {
            (away - TAU * (away / TAU).round()).abs()
        }
    };
    (0..a.len()).map(of).fold(0.0, f64::max)
}

/// The flange of the standard Denavit-Hartenberg rows, by independent matrices.
fn flange_of_rows(rows: &[DhRow], q: &[f64]) -> Matrix4<f64> {
    rows.iter()
        .zip(q)
        .fold(Matrix4::identity(), |before, ([d, a, alpha], q)| {
            let ((s, c), (sa, ca)) = (q.sin_cos(), alpha.sin_cos());
            before
                * Matrix4::new(
                    c,
                    -s * ca,
                    s * sa,
                    a * c, //
                    s,
                    c * ca,
                    -c * sa,
                    a * s, //
                    0.0,
                    sa,
                    ca,
                    *d, //
                    0.0,
                    0.0,
                    0.0,
                    1.0,
                )
        })
}

/// Result of the round trips from random joint positions.
#[derive(Debug, Default)]
struct Trips {
    /// Poses, without those near a singularity.
    poses: usize,
    /// Of them, those with any posture.
    reached: usize,
    /// Of them, those with the original joint positions among their postures.
    returned: usize,
    /// Number of postures.
    postures: usize,
}

/// Random round trips, each posture checked by the product of elementary motions. A rail or a redundant joint keeps its
/// position.
// For the output of the test.
#[allow(clippy::print_stdout)]
fn round_trips(robot: &Robot, count: usize) -> Trips {
    let tool = arms::bent_tool();
    let mut stream = Stream(20);
    let mut trips = Trips::default();
    for _ in 0..count {
        let q = stream.joints(robot);
        let made = posture_at(robot, &q, &tool);
        if made.singularity.is_some() {
            continue;
        }
        let home = (robot.joints().len() > 6).then_some(&q[..]);
        let found = postures(robot, &made.base_from_tool, ToolAt { home, ..at(&tool) }).unwrap_or_default();
        trips.poses += 1;
        trips.reached += usize::from(!found.is_empty());
        trips.postures += found.len();
        // A pose is accurate to 1e-12; near the end of a branch joints are accurate to its root.
        trips.returned += usize::from(found.iter().any(|p| apart(robot, &p.joints, &q) < 1e-6));
        for posture in &found {
            let theta: Vec<f64> = (0..q.len()).map(|i| robot.theta(i, &posture.joints)).collect();
            let reached = robot.chain().base_from_flange(&theta) * tool;
            let away = reached.translation.vector - made.base_from_tool.translation.vector;
            // The angle between two quaternions is accurate to the root of rounding.
            let turned = reached.rotation.angle_to(&made.base_from_tool.rotation);
            assert!(away.norm() < 1e-9 && turned < 3e-8, "{}", robot.name());
        }
    }
    println!("{}: {trips:?}", robot.name());
    trips
}
