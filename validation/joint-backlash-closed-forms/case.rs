//! Joints of an MH12 on horizontal circles against two bars in a plane. See README.md.
//!
//! | symbol | meaning |
//! |---|---|
//! | `phi` | bearing of the tool seen from the centre of the circle, rad |
//! | `rho` | distance of the tool from the first axis, m |
//! | `rates` | how L, U and B turn as `rho` grows, rad/m |
//! | `levers` | how each moves the tool along `e_rho`, m/rad |

use std::f64::consts::{FRAC_PI_2, TAU};

use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, Question};
use armill_core::measure::ballbar::Direction;
use armill_core::measure::ballbar::joints::circle::STATIONS;
use armill_core::measure::ballbar::joints::{Circle, Followed, follow};
use armill_core::nalgebra::{Point2, Point3, Vector2};
use armill_core::path::Placing;
use armill_core::robot::BranchPattern;
use armill_core::source::{Arm, StiffnessModel};
use armill_core::watch::Watch;
use armill_core::workpiece::Plane;

use crate::arms::mh12;
use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const GEOMETRY: &str = "closed form";
const SEED: u64 = 31;
const CIRCLES: usize = 20;
/// Base to shoulder: along the first axis, and away from it, m.
const SHOULDER: [f64; 2] = [0.450, 0.155];
/// Upper arm; forearm: along itself, and its offset, m.
const UPPER: f64 = 0.614;
const FOREARM: [f64; 2] = [0.640, 0.200];
/// Wrist centre above the tool, m: 100 mm to the flange, 150 mm of tool.
const WRIST: f64 = 0.250;
/// Angles closer to a reversal are looked at on neither side, rad.
const ASIDE: f64 = 0.05;

/// Rates and lever arms of L, U and B with the tool at the distance `rho` from the first axis and at this height.
fn two_bars(rho: f64, height: f64) -> [[f64; 3]; 2] {
    let wrist = Vector2::new(rho - SHOULDER[1], height + WRIST - SHOULDER[0]);
    let (upper, fore) = (UPPER, FOREARM[0].hypot(FOREARM[1]));
    let distance = wrist.norm();
    let inner = (upper * upper + distance * distance - fore * fore) / (2.0 * upper * distance);
    let elevation = wrist.y.atan2(wrist.x) + inner.acos();
    let elbow = Vector2::new(elevation.cos(), elevation.sin()) * upper;
    let forearm = wrist - elbow;
    // A turn forwards and down moves a point by (height, -reach); L and U together move the wrist by (1, 0).
    let determinant = -wrist.y * forearm.x + wrist.x * forearm.y;
    let shoulder_rate = -forearm.x / determinant;
    let elbow_rate = wrist.x / determinant;
    // The tool keeps its direction.
    let rates = [shoulder_rate, elbow_rate, -shoulder_rate - elbow_rate];
    let above = [SHOULDER[0], SHOULDER[0] + elbow.y, height + WRIST];
    [rates, above.map(|joint| height - joint)]
}

/// The arm along a horizontal circle, with the tool straight down.
fn followed(centre: Point3<f64>, radius: f64) -> Option<Followed> {
    let robot = mh12();
    let tool = Isometry::translation(0.0, 0.0, 0.150);
    let arm = Arm {
        robot: &robot,
        compliance: robot.compliance()?,
        model: StiffnessModel::DRIVES,
        flange_from_tool: &tool,
    };
    let question = Question {
        choice: BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP),
        ..Question::unloaded(arm, None)
    };
    let circle = Circle {
        placing: Placing::on_plane(&Plane::tilted(centre, FRAC_PI_2)),
        centre: Point2::origin(),
        radius,
    };
    follow(&question, &circle, STATIONS, Watch::NONE).ok()
}

/// Number of reversals: at both ends of `rho`, and two more if its rate has another sign at the far one: L if
/// the forearm is vertical.
fn expected(joint: usize, ends: [f64; 2], height: f64) -> usize {
    let place = match joint {
        0 => return 2,
        1 => 0,
        2 => 1,
        _ => 2,
    };
    let [near, far] = ends.map(|rho| two_bars(rho, height)[0][place]);
    if near * far < 0.0 { 4 } else { 2 }
}

/// How far two angles are apart.
fn apart(a: f64, b: f64) -> f64 {
    let apart = (a - b).rem_euclid(TAU);
    apart.min(TAU - apart)
}

/// Reversals and effects of circles at random places.
pub fn checks() -> Vec<Check> {
    let mut random = Random::seeded(SEED);
    let (mut first, mut others, mut effects) = (Vec::new(), Vec::new(), Vec::new());
    let mut wrong = 0;
    for _ in 0..CIRCLES {
        let centre = Point3::new(
            random.between(0.7, 0.95),
            random.between(-0.3, 0.3),
            random.between(0.1, 0.5),
        );
        let radius = random.between(0.05, 0.15);
        let Some(along) = followed(centre, radius) else {
            wrong += 1;
            continue;
        };
        let (d, psi) = (centre.coords.xy().norm(), centre.y.atan2(centre.x));
        let touches = (-radius / d).acos();
        let of = |joint: usize| along.reversals.iter().filter(move |at| at.joint == joint);
        for (joint, bearings) in [
            (0, [psi + touches, psi - touches]),
            (1, [psi, psi + TAU / 2.0]),
            (2, [psi, psi + TAU / 2.0]),
            (4, [psi, psi + TAU / 2.0]),
        ] {
            wrong += usize::from(of(joint).count() != expected(joint, [d - radius, d + radius], centre.z));
            for bearing in bearings {
                let nearest = of(joint).map(|at| apart(at.angle, FRAC_PI_2 - bearing));
                let off = nearest.fold(f64::INFINITY, f64::min);
                if joint == 0 { &mut first } else { &mut others }.push(off);
            }
        }
        for way in Direction::BOTH {
            for k in 0..180 {
                let phi = TAU * (f64::from(k) + 0.37) / 180.0;
                let angle = FRAC_PI_2 - phi;
                if along.reversals.iter().any(|at| apart(at.angle, angle) < ASIDE) {
                    continue;
                }
                let outwards = Vector2::new(phi.cos(), phi.sin());
                let tool = centre.coords.xy() + outwards * radius;
                let (rho, away) = (tool.norm(), tool.normalize());
                let about = Vector2::new(-away.y, away.x);
                // The angle of the circle falls as the bearing grows.
                let speed = Vector2::new(phi.sin(), -phi.cos()) * way.sign();
                let [rates, levers] = two_bars(rho, centre.z);
                let lag = |rate: f64| -0.5 * rate.signum();
                let mut given = vec![(0, lag(about.dot(&speed)) * rho * outwards.dot(&about))];
                for (k, joint) in [1, 2, 4].into_iter().enumerate() {
                    let rate = rates[k] * away.dot(&speed);
                    given.push((joint, lag(rate) * levers[k] * outwards.dot(&away)));
                }
                for (joint, expected) in given {
                    effects.push(along.slope(joint, 0.0, way, &[angle])[0] - expected);
                }
            }
        }
    }
    let gap = |errors: Vec<f64>, (tolerance, unit)| ErrorBound {
        worst: worst(errors),
        tolerance,
        unit,
    };
    vec![
        Check::none_wrong(
            format!("joints with more or fewer reversals than the bars, {CIRCLES} circles"),
            GEOMETRY,
            wrong,
        ),
        Check::computed(
            format!("reversals of S, {CIRCLES} circles"),
            GEOMETRY,
            gap(first, (1e-6, "rad")),
        ),
        Check::computed(
            format!("reversals of L, U and B, {CIRCLES} circles"),
            GEOMETRY,
            gap(others, (1e-6, "rad")),
        ),
        Check::computed(
            format!("effect of a small backlash on the radius, {CIRCLES} circles"),
            GEOMETRY,
            gap(effects, (1e-8, "m/rad")),
        ),
    ]
}
