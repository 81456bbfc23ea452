//! Arms for tests and benches, typed from their sources.
#![allow(dead_code, missing_docs, clippy::unwrap_used)]

pub mod circles;
pub mod other;

use std::sync::LazyLock;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::kernel::{Answers, Evaluation};
use armill_core::nalgebra::Vector3;
use armill_core::predict::{Deviation, predict};
use armill_core::robot::joint::Sign;
use armill_core::robot::{
    Amount, Axis, Branch, Compensator, Joint, JointCompliance, JointCurve, Limits, Motion, PostureName,
    Robot, TorqueCurve,
};
use armill_core::source::{Arm, ArmState, Links, Unstable};
use armill_core::spatial::Wrench;

use Amount::{Constant, Joint as Var};
use Axis::{X, Y, Z};
use Motion::{About, Along};

/// Energy of the spring of `compensator` at chain position `theta` (rad) of its joint, J.
pub fn spring_energy(compensator: &Compensator, theta: f64) -> f64 {
    let (a, l) = (compensator.fixed_radius, compensator.arm_radius);
    let s = (a * a + l * l + 2.0 * a * l * (compensator.angle + theta).cos()).sqrt();
    0.5 * compensator.stiffness * (s - compensator.free_length).powi(2)
}

/// Curves of a joint with knots at torques of some hundred N m; of most joints the falling one differs.
pub fn curves(joint: usize) -> JointCurve {
    let at = 7.0 * joint as f64;
    let curve = |torques: &[f64], slopes: &[f64]| {
        let mut angle = -4e-4;
        let mut points = vec![[torques[0] - at, angle]];
        for (ends, slope) in torques.windows(2).zip(slopes) {
            angle += slope * (ends[1] - ends[0]);
            points.push([ends[1] - at, angle]);
        }
        TorqueCurve::new(points).unwrap()
    };
    let rising = curve(
        &[-300.0, -90.0, -15.0, 0.5, 30.0, 120.0, 400.0],
        &[1e-6, 2e-6, 5e-6, 6e-6, 0.0, 1e-6],
    );
    let falling = match joint % 3 {
        0 => None,
        1 => Some(curve(&[-200.0, 100.0], &[3e-6])),
        _ => Some(curve(&[-60.0, 10.0, 80.0], &[4e-6, 1.5e-6])),
    };
    JointCurve { rising, falling }
}

/// A soft spring against gravity, so that its joint changes by a fifth of its compliance.
pub fn compensator(joint: usize) -> Compensator {
    Compensator {
        joint,
        fixed_radius: 0.69,
        arm_radius: 0.185,
        angle: 0.17,
        free_length: 0.458,
        stiffness: 7e5,
    }
}

/// A stream of numbers in 0..1 (SplitMix64), the same on every machine; the seed is part of the test.
pub struct Stream(pub u64);

impl Stream {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * self.next()
    }

    /// Normal, of mean 0 and standard deviation 1, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.next()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.next()).cos()
    }

    /// Joint positions within the limits.
    pub fn joints(&mut self, robot: &Robot) -> Vec<f64> {
        self.joints_beyond(robot, 0.0)
    }

    /// Joint positions up to `beyond` (rad, m) outside the limits.
    pub fn joints_beyond(&mut self, robot: &Robot, beyond: f64) -> Vec<f64> {
        let within = |joint: &Joint| {
            let limits = joint.limits.unwrap();
            self.between(limits.lower - beyond, limits.upper + beyond)
        };
        robot.joints().iter().map(within).collect()
    }

    /// A vector of at most this length in each direction.
    pub fn vector(&mut self, most: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.between(-most, most))
    }
}

/// Noise of first order, as in the signals of a sensor: each value contains 0.9 of the one before.
pub struct CorrelatedNoise {
    stream: Stream,
    last: f64,
}

impl CorrelatedNoise {
    pub fn new(seed: u64) -> CorrelatedNoise {
        CorrelatedNoise {
            stream: Stream(seed),
            last: 0.0,
        }
    }

    /// The next value; `scatter` is the standard deviation of what is new in it.
    pub fn next(&mut self, scatter: f64) -> f64 {
        self.last = 0.9 * self.last + scatter * self.stream.normal();
        self.last
    }
}

/// Times of a log of `count` instants, every 4 ms, s.
pub fn log_times(count: u32) -> Vec<f64> {
    (0..count).map(|k| f64::from(k) * 0.004).collect()
}

/// Joint positions at these parts of the ranges of their joints.
pub fn positions(robot: &Robot, unit: &[f64; 6]) -> Vec<f64> {
    let at = |(joint, part): (&Joint, &f64)| {
        let limits = joint.limits.unwrap();
        limits.lower + part * (limits.upper - limits.lower)
    };
    robot.joints().iter().zip(unit).map(at).collect()
}

/// A joint with positive direction against the right hand, with limits in degrees.
fn joint(name: &str, sign: Sign, limits_deg: [f64; 2]) -> Joint {
    let [lower, upper] = limits_deg.map(f64::to_radians);
    Joint {
        sign,
        limits: Some(Limits { lower, upper }),
        ..Joint::plain(name)
    }
}

pub fn compliance(values: [f64; 6]) -> Vec<JointCompliance> {
    values
        .map(|value| JointCompliance {
            value,
            standard_uncertainty: 0.2 * value,
        })
        .to_vec()
}

/// Yaskawa MH12: ros-industrial/motoman, Apache-2.0; compliances of Shneor & Chapsky 2021, section 3.4.
pub fn mh12() -> Robot {
    use Sign::{Negative, Positive};
    let motions = vec![
        Along(Z, Constant(0.450)),
        About(Z, Var(0)),
        Along(X, Constant(0.155)),
        About(Y, Var(1)),
        Along(Z, Constant(0.614)),
        About(Y, Var(2)),
        Along(Z, Constant(0.200)),
        About(X, Var(3)),
        Along(X, Constant(0.640)),
        About(Y, Var(4)),
        Along(X, Constant(0.100)),
        About(X, Var(5)),
        About(Y, Constant(-std::f64::consts::FRAC_PI_2)),
        About(X, Constant(std::f64::consts::PI)),
    ];
    let joints = vec![
        joint("S", Positive, [-170.0, 170.0]),
        joint("L", Positive, [-90.0, 155.0]),
        joint("U", Negative, [-85.0, 150.0]),
        joint("R", Negative, [-180.0, 180.0]),
        joint("B", Negative, [-135.0, 135.0]),
        joint("T", Negative, [-360.0, 360.0]),
    ];
    let robot = Robot::new("yaskawa/mh12", motions, joints).unwrap();
    robot
        .with_compliance(compliance([2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5]))
        .unwrap()
}

/// KUKA KR120 R2500 pro, with downward positive direction of axis 1: ros-industrial/kuka_experimental, Apache-2.0.
pub fn kr120() -> Robot {
    use Sign::{Negative, Positive};
    let motions = vec![
        Along(Z, Constant(0.675)),
        About(Z, Var(0)),
        Along(X, Constant(0.350)),
        About(Y, Var(1)),
        Along(X, Constant(1.150)),
        About(Y, Var(2)),
        Along(X, Constant(1.000)),
        Along(Z, Constant(-0.041)),
        About(X, Var(3)),
        About(Y, Var(4)),
        About(X, Var(5)),
        Along(X, Constant(0.215)),
        About(Y, Constant(std::f64::consts::FRAC_PI_2)),
    ];
    let joints = vec![
        joint("A1", Negative, [-185.0, 185.0]),
        joint("A2", Positive, [-140.0, -5.0]),
        joint("A3", Positive, [-120.0, 155.0]),
        joint("A4", Negative, [-350.0, 350.0]),
        joint("A5", Positive, [-125.0, 125.0]),
        joint("A6", Negative, [-350.0, 350.0]),
    ];
    Robot::new("kuka/kr120r2500pro", motions, joints)
        .unwrap()
        .with_compliance(compliance([4.5e-7, 3.0e-7, 3.6e-7, 4.3e-7, 4.6e-7, 2.1e-6]))
        .unwrap()
}

/// Staubli TX2-90, with a lateral offset of 50 mm: ros-industrial/staubli_experimental, Apache-2.0.
pub fn tx2_90() -> Robot {
    use Sign::Positive;
    let motions = vec![
        Along(Z, Constant(0.478)),
        About(Z, Var(0)),
        Along(X, Constant(0.050)),
        Along(Y, Constant(0.050)),
        About(Y, Var(1)),
        Along(Z, Constant(0.425)),
        About(Y, Var(2)),
        Along(Z, Constant(0.425)),
        About(Z, Var(3)),
        About(Y, Var(4)),
        About(Z, Var(5)),
        Along(Z, Constant(0.100)),
    ];
    let joints = vec![
        joint("1", Positive, [-180.0, 180.0]),
        joint("2", Positive, [-130.0, 147.5]),
        joint("3", Positive, [-145.0, 145.0]),
        joint("4", Positive, [-270.0, 270.0]),
        joint("5", Positive, [-115.0, 140.0]),
        joint("6", Positive, [-270.0, 270.0]),
    ];
    Robot::new("staubli/tx2-90", motions, joints)
        .unwrap()
        .with_compliance(compliance([1e-6, 1.2e-6, 2e-6, 1e-5, 1.5e-5, 3e-5]))
        .unwrap()
}

/// FANUC R-2000iC, with joint 3 measured from the horizontal: Liu et al. 2026, MIT.
pub fn r2000ic() -> Robot {
    use Sign::{Negative, Positive};
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut motions = Vec::new();
    let rows = [
        (0.0, 0.0, 0.0, 0.670),
        (-quarter, 0.312, -quarter, 0.0),
        (0.0, 1.075, 0.0, 0.0),
        (-quarter, 0.225, 0.0, 1.280),
        (quarter, 0.0, 0.0, 0.0),
        (-quarter, 0.0, 0.0, 0.215),
    ];
    for (index, (alpha, a, theta0, d)) in rows.into_iter().enumerate() {
        motions.extend([
            About(X, Constant(alpha)),
            Along(X, Constant(a)),
            About(Z, Constant(theta0)),
            About(Z, Var(index)),
            Along(Z, Constant(d)),
        ]);
    }
    let mut joints = vec![
        joint("J1", Positive, [-183.0, 183.0]),
        joint("J2", Positive, [-57.0, 74.0]),
        joint("J3", Negative, [-131.0, 171.0]),
        joint("J4", Negative, [-355.0, 355.0]),
        joint("J5", Negative, [-114.0, 114.0]),
        joint("J6", Negative, [-355.0, 355.0]),
    ];
    joints[2].coupling = vec![armill_core::robot::joint::Coupling {
        joint: 1,
        factor: 1.0,
    }];
    let stiffness = [
        9.339417645122126e5,
        4.129256136278849e6,
        1.907534091464657e6,
        2.3320460264753376e5,
        4.04358827532960e5,
        7.961815940385307e4,
    ];
    Robot::new("fanuc/r2000ic", motions, joints)
        .unwrap()
        .with_compliance(compliance(stiffness.map(|k| 1.0 / k)))
        .unwrap()
}

/// ABB IRB 2400: ros-industrial/abb, Apache-2.0.
pub fn irb2400() -> Robot {
    use Sign::Positive;
    let motions = vec![
        Along(Z, Constant(0.615)),
        About(Z, Var(0)),
        Along(X, Constant(0.100)),
        About(Y, Var(1)),
        Along(Z, Constant(0.705)),
        About(Y, Var(2)),
        Along(Z, Constant(0.135)),
        About(X, Var(3)),
        Along(X, Constant(0.755)),
        About(Y, Var(4)),
        About(X, Var(5)),
        Along(X, Constant(0.085)),
        About(Y, Constant(std::f64::consts::FRAC_PI_2)),
    ];
    let joints = vec![
        joint("1", Positive, [-180.0, 180.0]),
        joint("2", Positive, [-100.0, 110.0]),
        joint("3", Positive, [-60.0, 65.0]),
        joint("4", Positive, [-200.0, 200.0]),
        joint("5", Positive, [-120.0, 120.0]),
        joint("6", Positive, [-400.0, 400.0]),
    ];
    Robot::new("abb/irb2400", motions, joints)
        .unwrap()
        .with_compliance(compliance([8e-7, 9e-7, 1.1e-6, 6e-6, 7e-6, 1.5e-5]))
        .unwrap()
}

/// A made-up difficult case: hung from a tilted beam, lateral offset, mixed senses, arbitrary zeros, coupled wrist.
pub fn hung() -> Robot {
    use Sign::{Negative, Positive};
    let motions = vec![
        Along(X, Constant(0.3)),
        About(X, Constant(std::f64::consts::PI)),
        About(Y, Constant(0.4)),
        About(Z, Var(0)),
        Along(X, Constant(-0.08)),
        Along(Y, Constant(0.12)),
        About(Y, Var(1)),
        Along(X, Constant(0.55)),
        About(Y, Var(2)),
        Along(X, Constant(0.60)),
        Along(Z, Constant(0.1)),
        About(X, Var(3)),
        About(Z, Var(4)),
        About(X, Var(5)),
        Along(X, Constant(0.13)),
        About(Y, Constant(std::f64::consts::FRAC_PI_2)),
    ];
    let mut joints = vec![
        joint("a", Negative, [-100.0, 200.0]),
        joint("b", Positive, [-170.0, 80.0]),
        joint("c", Negative, [-200.0, 150.0]),
        joint("d", Negative, [-150.0, 170.0]),
        joint("e", Positive, [-110.0, 120.0]),
        joint("f", Negative, [-300.0, 200.0]),
    ];
    for (index, offset) in [0.3, -0.7, 1.1, 0.2, 0.0, -2.0].into_iter().enumerate() {
        joints[index].zero_offset = offset;
    }
    joints[5].coupling = vec![armill_core::robot::joint::Coupling {
        joint: 4,
        factor: -0.5,
    }];
    Robot::new("made-up/hung", motions, joints)
        .unwrap()
        .with_compliance(compliance([1e-6, 2e-6, 3e-6, 2e-5, 3e-5, 5e-5]))
        .unwrap()
}

/// All of them.
pub fn all() -> [Robot; 6] {
    ALL.clone()
}

/// All of them, made once.
pub static ALL: LazyLock<[Robot; 6]> =
    LazyLock::new(|| [mh12(), kr120(), tx2_90(), r2000ic(), irb2400(), hung()]);

/// The deviation of the tool of `arm` at joint positions `q` under `wrench`.
pub fn predicted(arm: &Arm<'_>, q: &[f64], wrench: &Wrench) -> Result<Deviation, Unstable> {
    let mut arm_state = ArmState::new(*arm);
    arm_state.set_joints(q);
    predict(&mut arm_state, wrench, &mut Links::Neglected)
}

/// A tool that is bent and rotated relative to the flange.
pub fn bent_tool() -> Isometry {
    from_xyz_and_fixed_angles(Vector3::new(0.03, -0.02, 0.21), Vector3::new(0.2, -0.5, 0.9))
}

/// Answers of an arm of two joints at these positions, point after point, without deviation.
pub fn answers_at(joints: &[[f64; 2]]) -> Answers {
    let evaluation = Evaluation {
        name: PostureName::Branch(Branch::ALL[0]),
        limit_margin: 1.0,
        limit_joint: 0,
        singularity: None,
        worst_case: 0,
        in_plane: 0.0,
        in_plane_uncertainty: None,
        normal: 0.0,
        full: 0.0,
    };
    Answers {
        points: vec![Ok(evaluation); joints.len()],
        joints: joints.concat(),
        deviations: Vec::new(),
        shares: Vec::new(),
        clearances: Vec::new(),
        joint_count: 2,
        case_count: 0,
        share_count: 0,
    }
}
