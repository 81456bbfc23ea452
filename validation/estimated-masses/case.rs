//! Masses estimated from the mass of an arm and the bodies of its links, against published masses of links. See README.md.

use nalgebra::{Matrix3, Point3};

use armill_core::clearance::solid::{LINK_UNCERTAINTY, estimated_masses};
use armill_core::frame::Isometry;
use armill_core::robot::{Attachment, Mass, Robot, Structure};
use armill_core::source::{Arm, ArmState, StiffnessModel};

use crate::check::{Check, ErrorBound};
use crate::random::Random;

const SEED: u64 = 32;
/// Postures of each arm.
const POSTURES: usize = 100;
/// Modes of each posture.
const MODES: usize = 3;

/// An arm of the library, the mass of the whole arm (kg), and the published masses of its first five links (kg).
const ARMS: [(&str, f64, [f64; 5]); 5] = [
    ("staubli/tx200", 1000.0, [364.0, 256.1, 98.7, 40.8, 13.6]),
    (
        "fanuc/r2000ic",
        1090.0,
        [262.614, 156.154, 149.341, 10.19, 17.698],
    ),
    (
        "kuka/kr210r2700extra",
        1068.0,
        [259.85, 334.71, 217.46, 12.17, 29.53],
    ),
    ("universal-robots/ur10", 28.9, [7.1, 12.7, 4.27, 2.0, 2.0]),
    ("universal-robots/ur10e", 33.5, [7.369, 13.051, 3.989, 2.1, 1.98]),
];

/// Masses of links, and the frequencies that follow from them.
pub fn checks() -> Vec<Check> {
    let mut random = Random::seeded(SEED);
    let mut logarithms = Vec::new();
    let mut errors = Vec::new();
    for (name, total, published) in ARMS {
        let found = armill_study::library::robot(name).expect("the library has it");
        let found = found.expect("every robot of the library reads");
        let estimated = estimated_masses(&found.bodies, total, &[]).expect("its links have bodies");
        let links = &estimated[1..=published.len()];
        logarithms.extend(
            links
                .iter()
                .zip(published)
                .map(|(link, published)| (published / link.mass).ln()),
        );
        // Only these three have compliances, and centres and inertias that are not estimated as well.
        if ["staubli/tx200", "fanuc/r2000ic"].contains(&name) {
            errors.extend(frequency_errors(&found.robot, estimated, &mut random));
        }
    }
    vec![
        Check::printed(
            "standard uncertainty of the estimated mass of a link, against the root mean square of ln(published/estimated) of 25 links",
            "published masses",
            ErrorBound {
                worst: (root_mean_square(&logarithms) - LINK_UNCERTAINTY).abs(),
                tolerance: 0.06,
                unit: "",
            },
            2,
        ),
        Check::printed(
            "three lowest frequencies of a TX200 and an R-2000iC in 100 postures each, with estimated and with published masses, root mean square of the relative difference",
            "frequencies with published masses",
            ErrorBound {
                worst: root_mean_square(&errors),
                tolerance: 0.5 * LINK_UNCERTAINTY,
                unit: "",
            },
            2,
        ),
    ]
}

fn root_mean_square(values: &[f64]) -> f64 {
    let squares: f64 = values.iter().map(|value| value * value).sum();
    (squares / values.len() as f64).sqrt()
}

/// Relative errors of the lowest frequencies with these masses in place of those of the library.
fn frequency_errors(robot: &Robot, estimated: Vec<Mass>, random: &mut Random) -> Vec<f64> {
    let model = |masses: Vec<Mass>| StiffnessModel {
        structure: Structure {
            masses,
            ..robot.structure().clone()
        },
        ..StiffnessModel::DRIVES.clone()
    };
    // A spindle of 60 kg on the flange, the same in both.
    let spindle = Mass {
        attachment: Attachment::Flange,
        mass: 60.0,
        centre: Point3::new(0.0, 0.0, 0.15),
        inertia: Some(Matrix3::identity()),
        relative_uncertainty: 0.0,
    };
    let with_spindle = |masses: &[Mass]| model(masses.iter().copied().chain([spindle]).collect());
    let models = [with_spindle(&robot.structure().masses), with_spindle(&estimated)];
    let mut errors = Vec::new();
    for _ in 0..POSTURES {
        let q: Vec<f64> = robot.joints().iter().map(|_| random.between(-1.2, 1.2)).collect();
        let [published, estimated] = models.each_ref().map(|model| frequencies(robot, model, &q));
        errors.extend(published.iter().zip(&estimated).map(|(p, e)| e / p - 1.0));
    }
    errors
}

fn frequencies(robot: &Robot, model: &StiffnessModel, q: &[f64]) -> Vec<f64> {
    let tool = Isometry::identity();
    let mut state = ArmState::new(Arm {
        robot,
        compliance: robot.compliance().expect("the library gives it"),
        model,
        flange_from_tool: &tool,
    });
    state.set_joints(q);
    let found = state.modes().expect("the arm has no compensator");
    let lowest = found.modes.iter().take(MODES);
    lowest.map(|mode| mode.at_tool.frequency_hz()).collect()
}
