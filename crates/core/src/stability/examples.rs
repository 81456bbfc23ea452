//! Cuts and modes of published examples, for the tests of this module.

use nalgebra::{Vector3, Vector6};

use super::cut_of_any_depth::CutOfAnyDepth;
use crate::dynamics::Mode;
use crate::load::{Cut, Cutter, CuttingLaw, Engagement, Immersion, LeanInCut, Mechanistic, Milling};

pub(super) const DIAMETER: f64 = 0.02;

/// The benchmark of Insperger, Stepan and others: 922 Hz, damping 0.011, 0.03993 kg, along the feed. \[recalled\]
pub(super) fn benchmark_mode() -> Mode {
    mode([922.0, 0.011], Vector3::x() / 0.03993_f64.sqrt())
}

/// A mode of this frequency (Hz) and damping ratio, with this shape of the tip (1/sqrt(kg)).
pub(super) fn mode([hertz, damping_ratio]: [f64; 2], shape: Vector3<f64>) -> Mode {
    Mode {
        angular_frequency: std::f64::consts::TAU * hertz,
        damping_ratio,
        shape: Vector6::new(shape.x, shape.y, shape.z, 0.0, 0.0, 0.0),
    }
}

/// The benchmark cut: two straight teeth, Kt 6e8 Pa, Kn 2e8 Pa; this depth is 1 mm.
pub(super) fn benchmark(immersion: Immersion) -> CutOfAnyDepth {
    cutting(Cutter::flat(DIAMETER, 2).unwrap(), immersion, [600e6, 200e6, 0.0])
}

/// This cutter under a linear law with these shear coefficients (Pa), 1 mm deep, 0.1 mm per tooth.
pub(super) fn cutting(cutter: Cutter, immersion: Immersion, shear: [f64; 3]) -> CutOfAnyDepth {
    let law = Mechanistic::new(Vector3::from(shear), Vector3::zeros()).unwrap();
    let depth = 1e-3;
    let cut = Cut {
        depth,
        engagement: Engagement::at_depth(immersion, &cutter, depth).unwrap(),
        feed: 0.1e-3,
        rise: 0.0,
        lean: LeanInCut::default(),
    };
    CutOfAnyDepth::new(&Milling::new(cutter, CuttingLaw::Mechanistic(law), cut).unwrap())
}

/// rpm in rad/s.
pub(super) fn rpm(value: f64) -> f64 {
    value * std::f64::consts::TAU / 60.0
}

/// Six modes of an arm between 8 and 60 Hz and three of a cutter, in directions of no symmetry.
pub(super) fn arm_and_cutter() -> Vec<Mode> {
    [
        ([8.0, 0.02], [0.02, 0.05, 0.01]),
        ([11.5, 0.025], [0.06, -0.02, 0.03]),
        ([18.0, 0.03], [0.03, 0.04, -0.05]),
        ([27.0, 0.03], [-0.05, 0.03, 0.06]),
        ([43.0, 0.04], [0.07, 0.05, 0.02]),
        ([61.0, 0.04], [0.03, -0.08, 0.04]),
        ([640.0, 0.03], [1.1, 0.2, 0.0]),
        ([705.0, 0.025], [-0.3, 1.2, 0.1]),
        ([1890.0, 0.015], [2.0, 1.5, 0.3]),
    ]
    .map(|(parameters, shape)| mode(parameters, Vector3::from(shape)))
    .to_vec()
}
