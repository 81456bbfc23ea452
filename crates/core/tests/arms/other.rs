//! Arms of other kinds than ortho-parallel, and close to it, typed from their sources.

use armill_core::robot::{Amount, Axis, Joint, Limits, Motion, Robot};

use Amount::{Constant, Joint as Var};
use Axis::{X, Y, Z};
use Motion::{About, Along};

const QUARTER: f64 = std::f64::consts::FRAC_PI_2;

/// A row of standard Denavit-Hartenberg parameters: d, a (m), alpha (rad).
pub type DhRow = [f64; 3];

/// UR10 (CB3), the rows of the maker's support page: they fit the measurements of Landgraf et al. 2021.
pub const UR10: [DhRow; 6] = [
    [0.1273, 0.0, QUARTER],
    [0.0, -0.612, 0.0],
    [0.0, -0.5723, 0.0],
    [0.163_941, 0.0, QUARTER],
    [0.1157, 0.0, -QUARTER],
    [0.0922, 0.0, 0.0],
];

/// UR10e, the rows of the maker's support page.
pub const UR10E: [DhRow; 6] = [
    [0.1807, 0.0, QUARTER],
    [0.0, -0.6127, 0.0],
    [0.0, -0.571_55, 0.0],
    [0.174_15, 0.0, QUARTER],
    [0.119_85, 0.0, -QUARTER],
    [0.116_55, 0.0, 0.0],
];

/// KUKA LBR iiwa 14 R820: 360, 420, 400, 126 mm, from its data sheet.
pub const IIWA14: [DhRow; 7] = [
    [0.36, 0.0, -QUARTER],
    [0.0, 0.0, QUARTER],
    [0.42, 0.0, QUARTER],
    [0.0, 0.0, -QUARTER],
    [0.40, 0.0, -QUARTER],
    [0.0, 0.0, QUARTER],
    [0.126, 0.0, 0.0],
];

/// The robot of these rows; limits in degrees about zero.
pub fn of_rows(name: &str, rows: &[DhRow], limits_deg: &[f64]) -> Robot {
    let mut motions = Vec::new();
    for (index, [d, a, alpha]) in rows.iter().enumerate() {
        motions.extend([
            About(Z, Var(index)),
            Along(Z, Constant(*d)),
            Along(X, Constant(*a)),
            About(X, Constant(*alpha)),
        ]);
    }
    let joints = limits_deg.iter().enumerate().map(|(i, half)| Joint {
        limits: Some(Limits {
            lower: -half.to_radians(),
            upper: half.to_radians(),
        }),
        ..Joint::plain(format!("A{}", i + 1))
    });
    let robot = Robot::new(name, motions, joints.collect()).unwrap();
    compliant(robot)
}

pub fn ur10() -> Robot {
    of_rows("ur/ur10", &UR10, &[360.0; 6])
}

pub fn ur10e() -> Robot {
    of_rows("ur/ur10e", &UR10E, &[360.0; 6])
}

pub fn iiwa14() -> Robot {
    of_rows(
        "kuka/iiwa14",
        &IIWA14,
        &[170.0, 120.0, 170.0, 120.0, 170.0, 120.0, 175.0],
    )
}

/// KUKA KR210 L150 with the noise of its CAD export: ros-industrial/kuka_experimental, Apache-2.0.
pub fn kr210_l150() -> Robot {
    let rows = [
        ([-0.00262, 0.000_975_86, 0.330_99], Z, [-185.0, 185.0]),
        ([0.352_77, -0.037_476, 0.4192], Y, [-45.0, 85.0]),
        ([-9.8483e-5, -0.1475, 1.2499], Y, [-210.0, 65.0]),
        ([0.957_95, 0.184, -0.055_059], X, [-350.0, 350.0]),
        ([0.542, 0.0, 0.0], Y, [-125.0, 125.0]),
        ([0.1925, 0.0, 0.0], X, [-350.0, 350.0]),
    ];
    let (mut motions, mut joints) = (Vec::new(), Vec::new());
    for (index, ([x, y, z], axis, [lower, upper])) in rows.into_iter().enumerate() {
        motions.extend([
            Along(X, Constant(x)),
            Along(Y, Constant(y)),
            Along(Z, Constant(z)),
        ]);
        motions.push(About(axis, Var(index)));
        joints.push(Joint {
            limits: Some(Limits {
                lower: f64::to_radians(lower),
                upper: f64::to_radians(upper),
            }),
            ..Joint::plain(format!("A{}", index + 1))
        });
    }
    motions.push(Along(X, Constant(0.0375)));
    compliant(Robot::new("kuka/kr210l150", motions, joints).unwrap())
}

/// `robot` with a small displacement after every joint: up to `most` m and rad along and about each axis.
pub fn calibrated(robot: &Robot, most: f64) -> Robot {
    let mut motions = Vec::new();
    let mut k = 0.0;
    for motion in robot.chain().motions() {
        motions.push(*motion);
        if matches!(motion.amount(), Amount::Joint(_)) {
            for axis in [X, Y, Z] {
                for along in [true, false] {
                    k += 1.0;
                    let value = Constant(most * f64::sin(12.9 * k));
                    motions.push(if along {
                        Along(axis, value)
                    } else {
                        About(axis, value)
                    });
                }
            }
        }
    }
    let name = format!("{}-calibrated", robot.name());
    compliant(Robot::new(name, motions, robot.joints().to_vec()).unwrap())
}

/// `robot` on a rail of 6 m along base y.
pub fn on_rail(robot: &Robot) -> Robot {
    let mut motions = vec![Along(Y, Var(0)), Along(Z, Constant(0.25))];
    motions.extend(robot.chain().motions().iter().map(|motion| match *motion {
        Along(axis, Var(joint)) => Along(axis, Var(joint + 1)),
        About(axis, Var(joint)) => About(axis, Var(joint + 1)),
        constant => constant,
    }));
    let rail = Joint {
        limits: Some(Limits {
            lower: -1.0,
            upper: 5.0,
        }),
        ..Joint::plain("rail")
    };
    let mut joints = vec![rail];
    joints.extend(robot.joints().iter().cloned().map(|mut joint| {
        for coupling in &mut joint.coupling {
            coupling.joint += 1;
        }
        joint
    }));
    compliant(Robot::new(format!("{}-on-rail", robot.name()), motions, joints).unwrap())
}

/// Made up, without parallel, perpendicular or intersecting axes: no closed form, not even approximately.
pub fn oblique() -> Robot {
    let rows = [
        [0.4, 0.15, 1.2],
        [0.1, 0.6, 0.4],
        [-0.08, 0.12, -1.1],
        [0.55, 0.07, 1.3],
        [0.06, -0.05, -1.4],
        [0.12, 0.0, 0.0],
    ];
    of_rows("made-up/oblique", &rows, &[180.0; 6])
}

/// Unimation Puma 560, whose wrist has an offset from axis 1, with axis 3 turned by 0.05 rad: without it the arm is
/// ortho-parallel. B. Armstrong, O. Khatib, J. Burdick 1986, rows after P. Corke.
pub const PUMA_LIKE: [DhRow; 6] = [
    [0.0, 0.0, QUARTER],
    [0.0, 0.4318, 0.05],
    [0.150_05, 0.0203, -QUARTER],
    [0.4318, 0.0, QUARTER],
    [0.0, 0.0, -QUARTER],
    [0.0, 0.0, 0.0],
];

/// Made up: three general axes, and three through one point.
pub const SKEWED: [DhRow; 6] = [
    [0.4, 0.15, 1.2],
    [0.1, 0.6, 0.4],
    [-0.08, 0.12, -1.1],
    [0.55, 0.0, 1.3],
    [0.0, 0.0, -1.4],
    [0.12, 0.0, 0.0],
];

/// [`SKEWED`] with a wrist of 60 degrees twice, as painting robots have.
pub const TILTED_WRIST: [DhRow; 6] = [
    SKEWED[0],
    SKEWED[1],
    SKEWED[2],
    [0.55, 0.0, QUARTER * 2.0 / 3.0],
    [0.0, 0.0, -QUARTER * 2.0 / 3.0],
    [0.12, 0.0, 0.0],
];

/// Made up: the first three axes meet, the others are general.
pub const SPHERICAL_SHOULDER: [DhRow; 6] = [
    [0.4, 0.0, -1.3],
    [0.0, 0.0, 1.5],
    [0.5, 0.1, 0.4],
    [0.08, 0.45, -0.3],
    [-0.06, 0.07, 1.2],
    [0.12, 0.0, 0.0],
];

/// The arm of these rows, whose joints have a range of a whole turn.
pub fn free(name: &str, rows: &[DhRow; 6]) -> Robot {
    of_rows(name, rows, &[180.0; 6])
}

/// MH12 with its axis 5 30 mm off axis 4: no closed form.
pub fn open_wrist() -> Robot {
    let mh12 = super::mh12();
    let mut motions = Vec::new();
    for motion in mh12.chain().motions() {
        if motion.amount() == Var(4) {
            motions.push(Along(Z, Constant(0.03)));
        }
        motions.push(*motion);
    }
    compliant(Robot::new("made-up/open-wrist", motions, mh12.joints().to_vec()).unwrap())
}

/// [`oblique`] without its last joint.
pub fn five_joints() -> Robot {
    let oblique = oblique();
    let mut motions = oblique.chain().motions().to_vec();
    motions.retain(|motion| motion.amount() != Var(5));
    compliant(Robot::new("made-up/five-joints", motions, oblique.joints()[..5].to_vec()).unwrap())
}

/// [`oblique`] with a joint 3 that slides.
pub fn sliding() -> Robot {
    let oblique = oblique();
    let slides = |motion: &Motion| match *motion {
        About(_, Var(2)) => Along(X, Var(2)),
        other => other,
    };
    let motions = oblique.chain().motions().iter().map(slides).collect();
    let mut joints = oblique.joints().to_vec();
    joints[2].limits = Some(Limits {
        lower: -0.3,
        upper: 0.5,
    });
    compliant(Robot::new("made-up/sliding", motions, joints).unwrap())
}

fn compliant(robot: Robot) -> Robot {
    let values = (0..robot.joints().len()).map(|i| armill_core::robot::JointCompliance {
        value: 1e-6 * (1.0 + i as f64),
        standard_uncertainty: 0.0,
    });
    let values = values.collect();
    robot.with_compliance(values).unwrap()
}
