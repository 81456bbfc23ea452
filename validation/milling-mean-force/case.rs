//! From a published cut to its mean milling force, and on to the deflection of a TX200. See README.md.
//!
//! | symbol | value | unit |
//! |---|---|---|
//! | diameter, teeth, helix | 16, 4, 45 | mm, -, deg |
//! | axial, radial depth | 1, 5 | mm |
//! | spindle, feed | 3333, 40 | rpm, mm/s |
//! | Ktc, Krc, Kac | 1930.4, 1159.6, 200.6 | N/mm2, no edge terms |
//!
//! Forces act on the tool: x along its feed, y to its left, z from part to spindle. The helix is left-handed,
//! as required by the sign of the printed z.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use armill_core::load::process::Advance;
use armill_core::load::{Cutter, CuttingLaw, Engagement, Hand, Immersion, Mechanistic, Process};
use armill_core::source::elastic::predict;
use armill_core::spatial::Wrench;

use crate::arms;
use crate::check::{Check, ErrorBound, worst_difference};
use crate::tx200_compliance::{OLDER_SPRINGS, posture, workpiece};

/// Who published the cut and the length of its force.
const PUBLISHED: &str = "rafisondi/sensitivity_milling_analysis";
/// The averaged equations evaluated separately, with more digits.
const REFERENCE: &str = "independent computation";

/// Length of the mean force of the averaged model, N, as published.
const LENGTH_PUBLISHED_N: f64 = 155.6;
/// The same from the averaged equations, N.
const LENGTH_N: f64 = 155.6207;
/// Components of the mean force, up-milling and down-milling, N.
const UP_N: [f64; 3] = [-150.7929, 35.6771, 14.3684];
const DOWN_N: [f64; 3] = [39.3263, 149.8826, 14.3684];
/// Deflection of the arm under the force of up-milling, um.
const LENGTH_UM: f64 = 169.19;

/// How far the cutter reaches into the part, m.
const RADIAL_DEPTH: f64 = 5e-3;
/// Angles of the spindle at which the force is summed.
const STEPS_OF_A_TURN: u32 = 7200;

/// The published cut, on the side that `immersion` says.
fn process(immersion: Immersion) -> Process {
    // N/mm2 in the source, Pa here: tangential, radial, axial.
    let shear = Vector3::new(1930.4e6, 1159.6e6, 200.6e6);
    let law = Mechanistic::new(shear, Vector3::zeros()).expect("published numbers are finite");
    let cutter = Cutter::flat(16e-3, 4)
        .and_then(|flat| flat.with_helix(45_f64.to_radians(), Hand::Left))
        .expect("a published tool exists");
    let engagement = Engagement::of(immersion, cutter.diameter());
    Process {
        cutter,
        law: CuttingLaw::Mechanistic(law),
        depth: 1e-3,
        engagement: engagement.expect("a published cut can be made"),
        feed: 40e-3,
        spindle: 3333.0 * TAU / 60.0,
    }
}

/// Its mean force on the tool, N.
fn mean(immersion: Immersion) -> Vector3<f64> {
    let milling = process(immersion).milling(Advance::Level);
    milling.expect("a published cut can be made").mean().force
}

/// Mean forces of a cut against the published ones.
pub fn checks() -> Vec<Check> {
    let up = mean(Immersion::Up(RADIAL_DEPTH));
    let down = mean(Immersion::Down(RADIAL_DEPTH));
    let gap = |worst: f64, tolerance: f64| ErrorBound {
        worst,
        tolerance,
        unit: "N",
    };
    let mut checks = vec![
        Check::printed(
            "length of the mean force, published cut: 155.6 N",
            PUBLISHED,
            gap((up.norm() - LENGTH_PUBLISHED_N).abs(), 0.05),
            3,
        ),
        Check::printed(
            "the same to four decimals: 155.6207 N",
            REFERENCE,
            gap(
                (up.norm() - LENGTH_N).abs().max((down.norm() - LENGTH_N).abs()),
                5e-5,
            ),
            6,
        ),
        Check::printed(
            "components, up-milling",
            REFERENCE,
            gap(worst_difference(up.as_slice(), &UP_N), 5e-5),
            6,
        ),
        Check::printed(
            "components, down-milling",
            REFERENCE,
            gap(worst_difference(down.as_slice(), &DOWN_N), 5e-5),
            6,
        ),
    ];
    checks.push(mean_of_a_turn(up));
    checks.push(deflection(up));
    checks
}

/// The mean in closed form against the sum of the force at even angles: two ways through the same model.
fn mean_of_a_turn(closed: Vector3<f64>) -> Check {
    let milling = process(Immersion::Up(RADIAL_DEPTH)).milling(Advance::Level);
    let milling = milling.expect("a published cut can be made");
    let sum: Vector3<f64> = milling.revolution(STEPS_OF_A_TURN).iter().sum();
    let error = (sum / f64::from(STEPS_OF_A_TURN) - closed).norm();
    Check::computed(
        "mean force of up-milling, relative, over 7200 angles of the spindle",
        "force summed over a revolution",
        ErrorBound {
            worst: error / closed.norm(),
            tolerance: 1e-6,
            unit: "",
        },
    )
}

/// The static deflection of the arm under this mean force: the end of the way from cut to offset.
fn deflection(force: Vector3<f64>) -> Check {
    let robot = arms::tx200(OLDER_SPRINGS);
    let joints = robot.compliance().expect("the arm was made with springs");
    let load = Wrench::from_force(workpiece() * force);
    let deviation = predict(&posture(&robot), joints, &load).twist.linear;
    Check::printed(
        "deflection of a TX200 under the computed force: 169.19 um",
        REFERENCE,
        ErrorBound {
            worst: (deviation.norm() * 1e6 - LENGTH_UM).abs(),
            tolerance: 0.01,
            unit: "um",
        },
        4,
    )
}
