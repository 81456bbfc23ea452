//! Columns of paths, holes and cuts against closed forms and sums in time: components of the deviation along a circle and in a hole,
//! wrist bend, torque, chip, removal rate, scallop, speed and overshoot at breakthrough. See README.md.
//!
//! ```text
//! circle   t = -sin a y' + cos a z',  l = n x t          along = d.t,  cross = d.l,  axial = d.n
//! hole     x = part's x without its part along n, y = n x x             (d.x, d.y, d.n)
//! torque   N ap R/(2 pi) (Ktc c (cos p1 - cos p2) + Kte (p2 - p1))      chip  c sin p
//! ```
//!
//! Deviations `d` are those of the worst load case, as the sum of joint compliances moved to the TCP; m, N, N m.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Vector3, Vector6};

use armill_core::dynamics::{Mode, release};
use armill_core::load::{Cut, Cutter, CuttingLaw, Engagement, Immersion, LeanInCut, Mechanistic, Milling};
use armill_core::path::{Lean, RoundedEnd, scallop};
use armill_core::robot::Robot;

use crate::arms;
use crate::check::{Check, ErrorBound, worst};
use crate::compliance_two_ways::{joint_compliance_at_base, moved_to};
use crate::random::Random;
use crate::studies::answer_to;

const STUDY: &str = include_str!("study.toml");
/// Robot, x and z of the centre, mm.
const ARMS: [(&str, [f64; 2]); 2] = [
    ("yaskawa/mh12", [900.0, 700.0]),
    ("fanuc/r2000ic", [1700.0, 1100.0]),
];
/// Load cases of the study: force (N), moment (N m).
const CASES: [[f64; 6]; 3] = [
    [30.0, -50.0, 20.0, 1.0, 0.0, 2.0],
    [-25.0, 40.0, 45.0, 0.0, -2.0, 1.0],
    [10.0, 60.0, -30.0, 2.0, 1.0, 0.0],
];
/// Tilt of the plane of each path and of the holes, deg; centre and radius of the circles, mm.
const CIRCLES: [(&str, f64, f64); 3] = [
    ("vertical", 0.0, 90.0),
    ("inclined", 35.0, 60.0),
    ("horizontal", 90.0, 120.0),
];
const HOLES_TILT: f64 = 60.0;
/// Cuts, leans and releases.
const SAMPLES: usize = 200;
/// Steps of a period of the fastest mode.
const PER_PERIOD: f64 = 2000.0;

const PROJECTED: &str = "deviation of the joints, projected on the circle or the hole";
const TEXTBOOK: &str = "closed form of textbooks";
const IN_TIME: &str = "equations of motion, summed in time";

/// Both arms; cuts, scallops and releases at random.
pub fn checks() -> Vec<Check> {
    let (mut along, mut holes, mut bends) = (Vec::new(), Vec::new(), Vec::new());
    for (name, [x, z]) in ARMS {
        let robot = arms::library(name);
        let text = STUDY
            .replace("[X, 150, Z]", &format!("[{x}, 150, {z}]"))
            .replace("ROBOT", name);
        let answer = answer_to("validation/path-and-hole-columns/study.toml", &text);
        let centre = Vector3::new(x, 150.0, z);
        for path in &answer.paths {
            let (_, tilt, radius) = CIRCLES[CIRCLES
                .iter()
                .position(|(name, ..)| *name == path.name)
                .unwrap_or(0)];
            let plane = Plane::tilted(tilt);
            for worst in &path.worst_points {
                let point = &worst.point;
                let d = deviations(&robot, &point.joints_deg, point.xyz_mm)[point.worst_case - 1];
                // The place on the circle: from y' towards z'.
                let at = (Vector3::from(point.xyz_mm) - centre) / radius;
                let forward = plane.z * at.dot(&plane.y) - plane.y * at.dot(&plane.z);
                let left = plane.normal.cross(&forward);
                let found = [worst.along_um, worst.cross_um, worst.axial_um];
                let expected = [forward, left, plane.normal].map(|axis| d.dot(&axis) * 1e6);
                along.extend((0..3).map(|k| (found[k] - expected[k]) / (d.norm() * 1e6)));
            }
        }
        let plane = Plane::tilted(HOLES_TILT);
        for hole in answer.holes.iter().flat_map(|holes| &holes.each) {
            let n = Vector3::from(hole.normal_axis);
            // x of the part is -y' of its plane.
            let x = (-plane.y + n * plane.y.dot(&n)).normalize();
            let all = deviations(&robot, &hole.joints_deg, hole.xyz_mm);
            let across = |d: &Vector3<f64>| (d - n * d.dot(&n)).norm();
            let d = all
                .iter()
                .max_by(|a, b| across(a).total_cmp(&across(b)))
                .expect("three cases");
            let found = [hole.x_um, hole.y_um, hole.depth_um].map(|um| um.unwrap_or(f64::NAN));
            let expected = [x, n.cross(&x), n].map(|axis| d.dot(&axis) * 1e6);
            holes.extend((0..3).map(|k| (found[k] - expected[k]) / (d.norm() * 1e6)));
            // Axes 4 and 6 of both arms are in line at joint 5 = 0.
            bends.push(hole.wrist_bend_deg.unwrap_or(f64::NAN) - hole.joints_deg[4].abs());
        }
    }
    let relative = |what: String, reference, errors: Vec<f64>, tolerance| {
        let worst = worst(errors);
        Check::computed(
            what,
            reference,
            ErrorBound {
                worst,
                tolerance,
                unit: "",
            },
        )
    };
    let mut checks = vec![
        relative(
            format!(
                "components along, across and out of {} worst points of six circles, over the deviation",
                along.len() / 3
            ),
            PROJECTED,
            along,
            1e-8,
        ),
        relative(
            format!(
                "components in the axes of {} holes, over the deviation",
                holes.len() / 3
            ),
            PROJECTED,
            holes,
            1e-8,
        ),
        Check::computed(
            format!(
                "angle between axes 4 and 6 of {} postures: that of joint 5",
                bends.len()
            ),
            TEXTBOOK,
            ErrorBound {
                worst: worst(bends),
                tolerance: 1e-6,
                unit: "deg",
            },
        ),
    ];
    let mut random = Random::seeded(11);
    let cuts: Vec<[f64; 3]> = (0..SAMPLES).map(|_| cut(&mut random)).collect();
    for (index, what) in ["mean torque", "largest chip", "removal rate"]
        .into_iter()
        .enumerate()
    {
        let errors = cuts.iter().map(|errors| errors[index]).collect();
        checks.push(relative(
            format!("{what} of {SAMPLES} cuts of straight flutes, relative"),
            TEXTBOOK,
            errors,
            [1e-4, 1e-9, 1e-12][index],
        ));
    }
    let balls = (0..SAMPLES).map(|_| ball(&mut random)).collect();
    checks.push(relative(
        format!("scallop of {SAMPLES} leaning ball noses, over the stepover"),
        TEXTBOOK,
        balls,
        1e-9,
    ));
    let releases: Vec<[f64; 2]> = (0..SAMPLES).map(|_| released(&mut random)).collect();
    for (index, what) in ["greatest speed", "overshoot"].into_iter().enumerate() {
        let errors = releases.iter().map(|errors| errors[index]).collect();
        checks.push(relative(
            format!("{what} after a force has stopped, {SAMPLES} sets of three modes, relative"),
            IN_TIME,
            errors,
            1e-3,
        ));
    }
    checks
}

/// Axes of a plane in base: see docs/notation.md.
struct Plane {
    y: Vector3<f64>,
    z: Vector3<f64>,
    normal: Vector3<f64>,
}

impl Plane {
    fn tilted(deg: f64) -> Plane {
        let (sin, cos) = deg.to_radians().sin_cos();
        Plane {
            y: Vector3::y(),
            z: Vector3::new(sin, 0.0, cos),
            normal: Vector3::new(-cos, 0.0, sin),
        }
    }
}

/// Deviation of the TCP under each load case, base, m.
fn deviations(robot: &Robot, joints_deg: &[f64], xyz_mm: [f64; 3]) -> [Vector3<f64>; 3] {
    let q: Vec<f64> = joints_deg.iter().map(|deg| deg.to_radians()).collect();
    let theta: Vec<f64> = (0..q.len()).map(|joint| robot.theta(joint, &q)).collect();
    let joints = robot.compliance().expect("both arms have compliances").iter();
    let at_base = joints
        .enumerate()
        .map(|joint| joint_compliance_at_base(robot.chain(), &theta, joint))
        .sum();
    let at_tcp = moved_to(&(Vector3::from(xyz_mm) * 1e-3), &at_base);
    CASES.map(|wrench| (at_tcp * Vector6::from(wrench)).fixed_rows::<3>(0).into())
}

/// A cut: relative errors of torque, chip and removal rate.
fn cut(random: &mut Random) -> [f64; 3] {
    let mut between = |lower, upper| random.between(lower, upper);
    let (radius, flutes) = (between(2e-3, 25e-3), between(1.0, 7.0).floor());
    let (ktc, kte) = (between(4e8, 3e9), between(0.0, 4e4));
    let (depth, c) = (between(0.2e-3, 10e-3), between(0.01e-3, 0.3e-3));
    let width = radius * between(0.05, 1.9);
    // Angles from the left of the feed, clockwise; at a quarter turn a tooth is ahead.
    let edge = (1.0 - width / radius).acos();
    let (immersion, entry, exit) = match between(0.0, 1.0) < 0.5 {
        true => (Immersion::Up(width), 0.0, edge),
        false => (Immersion::Down(width), PI - edge, PI),
    };
    let law = Mechanistic::new(
        Vector3::new(ktc, 0.3 * ktc, 0.1 * ktc),
        Vector3::new(kte, kte, 0.0),
    );
    let cut = Cut {
        depth,
        engagement: Engagement::of(immersion, 2.0 * radius).expect("a cut narrower than the cutter"),
        feed: c,
        rise: 0.0,
        lean: LeanInCut::default(),
    };
    let cutter = Cutter::flat(2.0 * radius, flutes as u32).expect("a cutter of usual size");
    let milling =
        Milling::new(cutter, CuttingLaw::Mechanistic(law.expect("finite")), cut).expect("a usual cut");
    let torque =
        flutes * depth * radius / TAU * (ktc * c * (entry.cos() - exit.cos()) + kte * (exit - entry));
    let chip = c * if (entry..=exit).contains(&FRAC_PI_2) {
        1.0
    } else {
        edge.sin()
    };
    let feed = 0.02;
    [
        milling.mean_torque() / torque - 1.0,
        milling.largest_chip() / chip - 1.0,
        cut.removal_rate(feed) / (depth * width * feed) - 1.0,
    ]
}

/// A ball nose in any lean: error of its scallop over the stepover.
fn ball(random: &mut Random) -> f64 {
    let radius = random.between(1e-3, 10e-3);
    let stepover = radius * random.between(0.01, 1.5);
    let end = RoundedEnd {
        radius,
        corner: radius,
    };
    let lean = Lean {
        lead: random.between(-0.8, 0.8),
        tilt: random.between(-0.8, 0.8),
    };
    let expected = radius - (radius * radius - 0.25 * stepover * stepover).sqrt();
    (scallop(end, lean, stepover).unwrap_or(f64::NAN) - expected) / stepover
}

/// Three modes: relative errors of the greatest speed and, over the deflection, of the overshoot.
fn released(random: &mut Random) -> [f64; 2] {
    let mut mode = || {
        let direction = random.vector(0.1);
        Mode {
            angular_frequency: TAU * random.between(5.0, 60.0),
            damping_ratio: random.between(0.01, 0.1),
            shape: Vector6::new(direction.x, direction.y, direction.z, 0.0, 0.0, 0.0),
        }
    };
    let modes = [mode(), mode(), mode()];
    let (n, force) = (Vector3::x(), 300.0);
    let found = release(&modes, &n, force);

    let fastest = modes
        .iter()
        .map(|mode| mode.angular_frequency)
        .fold(0.0, f64::max);
    let slowest = modes
        .iter()
        .map(|mode| mode.angular_frequency)
        .fold(f64::INFINITY, f64::min);
    let step = TAU / fastest / PER_PERIOD;
    // Each mode from its deflection under the force, by the middle of each step: x'' = -omega^2 x - 2 zeta omega x'.
    let part = |mode: &Mode| mode.shape.x;
    let deflection = |mode: &Mode| -part(mode) * force / mode.angular_frequency.powi(2);
    let mut states = modes.map(|mode| (mode, deflection(&mode), 0.0));
    let loaded: f64 = states.iter().map(|(mode, x, _)| part(mode) * x).sum();
    let (mut time, mut speed, mut beyond) = (0.0, 0.0f64, 0.0f64);
    while time < 2.0 * TAU / slowest {
        for (mode, x, v) in &mut states {
            let (omega, zeta) = (mode.angular_frequency, mode.damping_ratio);
            let rate = |x: f64, v: f64| -omega * omega * x - 2.0 * zeta * omega * v;
            let (x_middle, v_middle) = (*x + 0.5 * step * *v, *v + 0.5 * step * rate(*x, *v));
            *x += step * v_middle;
            *v += step * rate(x_middle, v_middle);
        }
        time += step;
        speed = speed.max(states.iter().map(|(mode, _, v)| part(mode) * v).sum());
        beyond = beyond.max(states.iter().map(|(mode, x, _)| part(mode) * x).sum());
    }
    [
        found.peak_speed / speed - 1.0,
        (found.overshoot - beyond) / loaded,
    ]
}
