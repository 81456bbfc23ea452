//! Witnesses: closed forms of Euler's beam, a finite element script for Timoshenko's, rigid bodies, and receptance coupling as it is usually written.
//!
//! The script (numpy, scipy) has elements of three nodes with deflection and rotation (quadratic), stiffness by two, masses by three Gauss points,
//! 40 and 80 elements a segment, extrapolated with the fourth order of its error; eigenvalues by `scipy.sparse.linalg.eigsh`.

use std::f64::consts::TAU;

use nalgebra::{Complex, Matrix2, Matrix3, Matrix4, Matrix6, Vector3, Vector6};

use super::joint::Spring;
use super::*;
use crate::dynamics::{Mode, receptance};

/// Steel of the script: G = E/(2 (1 + nu)).
const STEEL: Material = Material {
    modulus: 206e9,
    density: 7850.0,
    poisson: 0.3,
    loss_factor: 0.0,
};

fn rod(length: f64, outer: f64) -> Segment {
    Segment {
        length,
        section: Section { outer, bore: 0.0 },
        material: STEEL,
        theory: BeamTheory::Timoshenko,
        joint: None,
    }
}

fn euler(length: f64, outer: f64) -> Segment {
    Segment {
        theory: BeamTheory::Euler,
        ..rod(length, outer)
    }
}

/// The frequency near `guess` at which the receptance along `axis` is infinite, by bisection of its inverse.
fn resonance(base: &Base<'_>, segments: &[Segment], axis: usize, guess: f64) -> f64 {
    // Exactly at the resonance there is no receptance.
    let inverse =
        |w: f64| tip_receptance(base, segments, w).map_or(0.0, |found| 1.0 / found[(axis, axis)].re);
    let [mut low, mut high] = [0.995 * guess, 1.005 * guess];
    let side = inverse(low).signum();
    assert_ne!(side, inverse(high).signum(), "no resonance near {guess}");
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match inverse(middle).signum() == side {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

fn is_near(found: f64, expected: f64, relative: f64) {
    let deviation = (found / expected - 1.0).abs();
    assert!(deviation < relative, "{found} is not {expected}: {deviation:.1e}");
}

#[test]
fn frequencies_of_eulers_beam_are_those_of_the_closed_form() {
    let (length, outer) = (0.3, 0.012);
    // sqrt(E I/(rho A)) = sqrt(E/rho) D/4.
    let scale = (206e9_f64 / 7850.0).sqrt() * outer / 4.0 / (length * length);
    let one = [euler(length, outer)];
    let three = [euler(0.1, outer), euler(0.15, outer), euler(0.05, outer)];
    // cosh b cos b = -1, +1: the digits are those of any table of beams.
    let fixed = [
        1.875_104_068_711_961,
        4.694_091_132_974_175,
        7.854_757_438_237_613,
        10.995_540_734_875_467,
    ];
    let free = [
        4.730_040_744_862_704,
        7.853_204_624_095_838,
        10.995_607_838_001_671,
    ];
    for segments in [&one[..], &three[..]] {
        for axis in [0, 1] {
            for b in fixed {
                is_near(
                    resonance(&Base::Rigid, segments, axis, scale * b * b),
                    scale * b * b,
                    1e-9,
                );
            }
            for b in free {
                is_near(
                    resonance(&Base::Free, segments, axis, scale * b * b),
                    scale * b * b,
                    1e-9,
                );
            }
        }
    }
}

#[test]
fn high_modes_of_a_long_slender_beam_are_those_of_the_closed_form() {
    // b L = (n - 1/2) pi from the fifth mode on, to 1e-12: here 39.5 pi = 124, where exp(124) = 1e54.
    let (length, outer) = (1.0, 0.004);
    let scale = (206e9_f64 / 7850.0).sqrt() * outer / 4.0 / (length * length);
    let b = 39.5 * std::f64::consts::PI;
    is_near(
        resonance(&Base::Rigid, &[euler(length, outer)], 0, scale * b * b),
        scale * b * b,
        1e-9,
    );
}

#[test]
fn frequencies_of_timoshenkos_beam_are_those_of_finite_elements() {
    // The last digits of the script: its change from 40 to 80 elements is up to 9e-6, of which about a hundredth remains.
    let cases: [(Base<'_>, Vec<Segment>, &[f64]); 3] = [
        (
            Base::Rigid,
            vec![rod(0.1, 0.02)],
            &[8_808.004_370, 49_209.857_233, 120_534.273_009, 204_765.349_842],
        ),
        (
            Base::Rigid,
            vec![rod(0.04, 0.05), rod(0.06, 0.02), rod(0.03, 0.016)],
            &[12_260.214_954, 52_776.894_905, 87_388.455_813, 140_113.038_809],
        ),
        (
            Base::Free,
            vec![rod(0.2, 0.03)],
            &[20_330.379_270, 51_415.937_016, 91_224.927_589],
        ),
    ];
    for (base, segments, frequencies) in cases {
        for w in frequencies {
            is_near(resonance(&base, &segments, 0, *w), *w, 1e-7);
        }
    }
}

#[test]
fn rods_have_the_frequencies_of_the_wave_equation() {
    let (length, segments) = (0.25, [rod(0.1, 0.02), rod(0.15, 0.02)]);
    let along = (206e9_f64 / 7850.0).sqrt();
    let about = along / 2.6_f64.sqrt();
    for (axis, speed) in [(2, along), (5, about)] {
        let quarter = std::f64::consts::FRAC_PI_2 * speed / length;
        is_near(resonance(&Base::Rigid, &segments, axis, quarter), quarter, 1e-11);
        is_near(
            resonance(&Base::Rigid, &segments, axis, 3.0 * quarter),
            3.0 * quarter,
            1e-11,
        );
        is_near(
            resonance(&Base::Free, &segments, axis, 2.0 * quarter),
            2.0 * quarter,
            1e-11,
        );
    }
}

#[test]
fn at_rest_the_receptance_is_the_compliance_of_the_cantilever() {
    let (length, outer) = (0.12, 0.025);
    let (area, moment) = (TAU / 8.0 * outer * outer, TAU / 128.0 * outer.powi(4));
    let bending = 206e9 * moment;
    let shear = 7.8 / 8.8 * 206e9 / 2.6 * area;
    for pieces in [1, 4] {
        let segments = vec![rod(length / f64::from(pieces), outer); usize::try_from(pieces).unwrap()];
        let found = tip_receptance(&Base::Rigid, &segments, 0.0)
            .unwrap()
            .map(|z| z.re);
        let across = length.powi(3) / (3.0 * bending) + length / shear;
        let turn = length * length / (2.0 * bending);
        is_near(found[(0, 0)], across, 1e-12);
        is_near(found[(1, 1)], across, 1e-12);
        is_near(found[(2, 2)], length / (206e9 * area), 1e-12);
        is_near(found[(3, 3)], length / bending, 1e-12);
        is_near(found[(4, 4)], length / bending, 1e-12);
        is_near(found[(5, 5)], length * 2.6 / (206e9 * 2.0 * moment), 1e-12);
        // A force along x turns the tip about +y, one along y about -x.
        is_near(found[(4, 0)], turn, 1e-12);
        is_near(found[(3, 1)], -turn, 1e-12);
    }
    let slender = tip_receptance(&Base::Rigid, &[euler(length, outer)], 0.0).unwrap();
    is_near(slender[(0, 0)].re, length.powi(3) / (3.0 * bending), 1e-12);
}

/// A machine with three modes in oblique directions.
fn machine() -> Vec<Mode> {
    let shapes = [
        Vector6::new(0.1, 0.02, -0.03, 0.2, -0.1, 0.05),
        Vector6::new(-0.05, 0.2, 0.06, 0.1, 0.3, -0.1),
        Vector6::new(0.3, -0.1, 0.2, -0.6, 0.4, 0.9),
    ];
    let of = |(k, shape): (usize, Vector6<f64>)| Mode {
        angular_frequency: [60.0, 900.0, 5000.0][k],
        damping_ratio: 0.03,
        shape,
    };
    shapes.into_iter().enumerate().map(of).collect()
}

fn damped() -> Vec<Segment> {
    let material = Material {
        loss_factor: 0.004,
        ..STEEL
    };
    let joint = Joint {
        lateral: Spring {
            stiffness: Some(8e7),
            damping: 30.0,
        },
        bending: Spring {
            stiffness: Some(3e5),
            damping: 2.0,
        },
        loss_factor: 0.02,
        ..Joint::default()
    };
    let holder = Segment {
        section: Section {
            outer: 0.04,
            bore: 0.016,
        },
        material,
        ..rod(0.06, 0.04)
    };
    let shank = Segment {
        material,
        joint: Some(joint),
        ..rod(0.05, 0.016)
    };
    vec![
        holder,
        shank,
        Segment {
            material,
            ..rod(0.03, 0.0128)
        },
    ]
}

fn relative(one: &Matrix6<Complex<f64>>, other: &Matrix6<Complex<f64>>) -> f64 {
    // Each part relative to the geometric mean of its diagonal, so that metres and radians compare.
    let size = |i: usize| one[(i, i)].norm();
    let mut most = 0.0_f64;
    for i in 0..6 {
        for j in 0..6 {
            most = most.max((one[(i, j)] - other[(i, j)]).norm() / (size(i) * size(j)).sqrt());
        }
    }
    most
}

#[test]
fn two_halves_of_a_beam_are_the_whole() {
    let at = |segments: &[Segment], w: f64| {
        tip_receptance(&Base::Receptance(&receptance(&machine(), w)), segments, w).unwrap()
    };
    let whole = Segment {
        material: Material {
            loss_factor: 0.004,
            ..STEEL
        },
        ..rod(0.2, 0.016)
    };
    let part = |share: f64| Segment {
        length: 0.2 * share,
        ..whole
    };
    for w in [0.0, 55.0, 900.0, 5e3, 4e4, 2e5] {
        let found = relative(&at(&[whole], w), &at(&[part(0.3), part(0.7)], w));
        assert!(found < 1e-9, "{w}: {found:.1e}");
    }
}

#[test]
fn the_receptance_is_symmetric() {
    for w in [0.0, 58.0, 900.0, 6e3, 3e4, 2e5] {
        let found = tip_receptance(&Base::Receptance(&receptance(&machine(), w)), &damped(), w).unwrap();
        let deviation = relative(&found, &found.transpose());
        assert!(deviation < 1e-10, "{w}: {deviation:.1e}");
    }
}

/// Free-free receptances of Euler's beam in the plane x z: `[v_1, p_1, v_2, p_2]` by forces and moments on both ends, by
/// `v = a cos(bz) + b sin(bz) + c cosh(bz) + d sinh(bz)`.
fn free_free(segment: &Segment, w: f64) -> Matrix4<Complex<f64>> {
    let modulus = Complex::new(1.0, segment.material.loss_factor) * segment.material.modulus;
    let bending = modulus * segment.section.second_moment();
    let mass = segment.material.density * segment.section.area();
    let b = (Complex::new(w * w * mass, 0.0) / bending).powf(0.25);
    // The derivative of order n of the four functions at z.
    let derivative = |n: usize, z: f64| {
        let x = b * z;
        let circular = [x.cos(), -x.sin(), -x.cos(), x.sin()];
        let hyperbolic = [x.cosh(), x.sinh()];
        let scale = (0..n).fold(Complex::new(1.0, 0.0), |product, _| product * b);
        [
            circular[n % 4],
            circular[(n + 3) % 4],
            hyperbolic[n % 2],
            hyperbolic[(n + 1) % 2],
        ]
        .map(|part| part * scale)
    };
    let rows = |all: [[Complex<f64>; 4]; 4]| Matrix4::from_fn(|i, j| all[i][j]);
    let length = segment.length;
    let moved = rows([
        derivative(0, 0.0),
        derivative(1, 0.0),
        derivative(0, length),
        derivative(1, length),
    ]);
    let signed = |sign: f64, row: [Complex<f64>; 4]| row.map(|part| part * bending * sign);
    // On the end of larger z: force -E I times the third, moment E I times the second derivative; on the other the opposite.
    let forces = rows([
        signed(1.0, derivative(3, 0.0)),
        signed(-1.0, derivative(2, 0.0)),
        signed(-1.0, derivative(3, length)),
        signed(1.0, derivative(2, length)),
    ]);
    moved * forces.try_inverse().unwrap()
}

#[test]
fn it_is_receptance_coupling_as_it_is_usually_written() {
    let joint = damped()[1].joint;
    let material = Material {
        loss_factor: 0.004,
        ..STEEL
    };
    let holder = Segment {
        material,
        ..euler(0.06, 0.03)
    };
    let cutter = Segment {
        material,
        joint,
        ..euler(0.08, 0.012)
    };
    // Of x and the turn about y.
    let plane = |m: &Matrix6<Complex<f64>>| Matrix2::new(m[(0, 0)], m[(0, 4)], m[(4, 0)], m[(4, 4)]);
    for w in [200.0, 900.0, 6e3, 3e4, 8e4] {
        let machine = receptance(&machine(), w).map_with_location(|i, j, part| {
            let is_in_plane = |k: usize| k == 0 || k == 4;
            if is_in_plane(i) == is_in_plane(j) {
                part
            } else {
                Complex::new(0.0, 0.0)
            }
        });
        let mut expected = plane(&machine);
        for segment in [holder, cutter] {
            let free = free_free(&segment, w);
            let block = |i: usize, j: usize| free.fixed_view::<2, 2>(i, j).into_owned();
            let joint = segment
                .joint
                .map_or_else(Matrix6::zeros, |joint| joint.compliance(w));
            let inner = (block(0, 0) + expected + plane(&joint)).try_inverse().unwrap();
            expected = block(2, 2) - block(2, 0) * inner * block(0, 2);
        }
        let found = plane(&tip_receptance(&Base::Receptance(&machine), &[holder, cutter], w).unwrap());
        let deviation = (found - expected)
            .map(Complex::norm)
            .component_div(&expected.map(Complex::norm))
            .max();
        assert!(deviation < 1e-8, "{w}: {deviation:.1e}");
    }
}

#[test]
fn damping_takes_energy() {
    for w in [58.0, 900.0, 6e3, 3e4] {
        let found = tip_receptance(&Base::Receptance(&receptance(&machine(), w)), &damped(), w).unwrap();
        let lost = found.map(|z| -z.im).symmetric_eigenvalues();
        assert!(lost.min() > 0.0, "{w}: {lost}");
    }
}

#[test]
fn a_joint_adds_its_compliance() {
    let joint = Joint {
        lateral: Spring {
            stiffness: Some(2e7),
            damping: 0.0,
        },
        ..Joint::default()
    };
    let stiff = Segment {
        joint: Some(joint),
        ..rod(0.1, 0.02)
    };
    let at = |segment| tip_receptance(&Base::Rigid, &[segment], 0.0).unwrap();
    let added = at(stiff) - at(rod(0.1, 0.02));
    is_near(added[(0, 0)].re, 5e-8, 1e-9);
    assert!(added[(4, 4)].norm() < 1e-18 && added[(2, 2)].norm() < 1e-18);
    let damped = Spring {
        stiffness: Some(2e7),
        damping: 100.0,
    };
    let found = Joint {
        axial: damped,
        loss_factor: 0.1,
        ..joint
    }
    .compliance(1e4)[(2, 2)];
    assert!((found - Complex::new(2e7, 3e6).inv()).norm() < 1e-20);
}

#[test]
fn a_rigid_beam_is_a_rigid_body() {
    let (length, outer, w) = (0.1, 0.03, 500.0);
    let rigid = Segment {
        material: Material {
            modulus: 1e19,
            ..STEEL
        },
        ..rod(length, outer)
    };
    let mass = 7850.0 * TAU / 8.0 * outer * outer * length;
    // Cylinder: m r^2/2 about its axis, m (3 r^2 + L^2)/12 across.
    let across = mass * (3.0 * outer * outer / 4.0 + length * length) / 12.0;
    let body = Body {
        mass,
        centre: Vector3::new(0.0, 0.0, -length / 2.0),
        inertia: Matrix3::from_diagonal(&Vector3::new(across, across, mass * outer * outer / 8.0)),
    };
    let expected = body
        .mass_matrix()
        .try_inverse()
        .unwrap()
        .map(|part| Complex::new(-part / (w * w), 0.0));
    let found = tip_receptance(&Base::Free, &[rigid], w).unwrap();
    // What is left is the compliance of the beam: 1e-8 of its inertia.
    assert!(
        relative(&found, &expected) < 1e-6,
        "{:.1e}",
        relative(&found, &expected)
    );
}

#[test]
fn a_body_lowers_the_frequency_of_a_spring() {
    // k = 2e7 N/m, m = 5 + 3 kg: displacement by a unit force 1/(k - 8 w^2).
    let mode = Mode {
        angular_frequency: 2000.0,
        damping_ratio: 0.0,
        shape: Vector6::new(1.0 / 5.0_f64.sqrt(), 0.0, 0.0, 0.0, 0.0, 0.0),
    };
    let body = Body {
        mass: 3.0,
        centre: Vector3::zeros(),
        inertia: Matrix3::zeros(),
    };
    let w = 1000.0;
    let found = body.added_to(&receptance(&[mode], w), w).unwrap();
    is_near(found[(0, 0)].re, 1.0 / (2e7 - 8e6), 1e-12);
}

#[test]
fn what_has_no_receptance_is_an_error() {
    assert!(tip_receptance(&Base::Free, &[], 10.0).is_err());
    assert!(
        tip_receptance(&Base::Free, &[rod(0.1, 0.02)], 0.0).is_err(),
        "free at rest"
    );
    let endless = Segment {
        length: f64::INFINITY,
        ..rod(0.1, 0.02)
    };
    assert!(tip_receptance(&Base::Rigid, &[endless], 10.0).is_err());
}

fn swept(machine: &[Mode], segments: &[Segment], band_hz: [f64; 2]) -> Vec<Swept> {
    let [low, high] = band_hz.map(|hz| hz * TAU);
    let frequencies = Frequencies {
        low,
        high,
        count: 1200,
    }
    .all();
    sweep(|w| receptance(machine, w), None, segments, &frequencies).unwrap()
}

#[test]
fn modes_of_a_machine_without_segments_are_its_own() {
    let own: Vec<Mode> = [
        (300.0, [0.1, 0.0, 0.0]),
        (300.0, [0.0, 0.1, 0.0]),
        (900.0, [0.05, 0.02, 0.3]),
    ]
    .into_iter()
    .map(|(hz, [x, y, z])| Mode {
        angular_frequency: hz * TAU,
        damping_ratio: 0.02,
        shape: Vector6::new(x, y, z, 0.0, 0.0, 0.0),
    })
    .collect();
    let found = tip_modes(&swept(&own, &[], [100.0, 2000.0]), None).unwrap();
    assert_eq!(found.modes.len(), 3, "{:?}", found.modes);
    for (found, own) in found.modes.iter().zip(&own) {
        is_near(found.angular_frequency, own.angular_frequency, 1e-8);
        is_near(found.damping_ratio, 0.02, 1e-6);
    }
    // Two modes of one frequency in x and y: any two perpendicular directions describe them.
    let by = receptance(&found.modes, 1000.0) - receptance(&own, 1000.0);
    assert!(by.norm() < 1e-6 * receptance(&own, 1000.0).norm());
    assert!(
        found.deviation.iter().all(|part| *part < 1e-6),
        "{:?}",
        found.deviation
    );
}

#[test]
fn the_first_mode_of_a_cantilever_has_a_quarter_of_its_mass() {
    let (length, outer) = (0.1, 0.01);
    let material = Material {
        loss_factor: 0.02,
        ..STEEL
    };
    let segment = Segment {
        material,
        ..euler(length, outer)
    };
    let b = 1.875_104_068_711_961_f64;
    let omega = (206e9_f64 / 7850.0).sqrt() * outer / 4.0 * (b / length).powi(2);
    let found = tip_modes(&swept(&[], &[segment], [100.0, 3000.0]), None).unwrap();
    let first = &found.modes[0];
    // Structural damping is fitted as viscous: the frequency differs by eta^2.
    is_near(first.angular_frequency, omega, 4e-4);
    is_near(first.damping_ratio, 0.01, 0.02);
    let mass = 7850.0 * TAU / 8.0 * outer * outer * length / 4.0;
    is_near(1.0 / first.shape.norm_squared(), mass, 0.01);
    assert_eq!(found.modes.len(), 2, "in x and y: {:?}", found.modes);
}

#[test]
fn no_frequency_has_no_mode() {
    assert!(tip_modes(&[], None).is_err());
    assert!(tip_modes(&swept(&[], &[rod(0.1, 0.02)], [10.0, 20.0])[..10], None).is_err());
}

/// Holder and cutter on a nose with a low mode in an oblique direction: two pairs of bending modes nearer to each other than their widths.
#[test]
fn modes_of_a_tool_on_an_arm_describe_its_receptance() {
    let nose = [
        (17.0, 160.0, [1.0, 1.0, 0.0]),
        (310.0, 12.0, [1.0, 0.0, 0.0]),
        (360.0, 11.0, [0.0, 1.0, 0.0]),
    ]
    .map(|(hz, mass, [x, y, z]): (f64, f64, [f64; 3])| Mode {
        angular_frequency: hz * TAU,
        damping_ratio: 0.03,
        shape: Vector6::new(x, y, z, 0.0, 0.0, 0.0) / (mass * (x * x + y * y + z * z)).sqrt(),
    });
    let low = Joint {
        lateral: Spring {
            stiffness: Some(2e8),
            damping: 0.0,
        },
        bending: Spring {
            stiffness: Some(6e5),
            damping: 0.0,
        },
        loss_factor: 0.04,
        ..Joint::default()
    };
    let high = Joint {
        lateral: Spring {
            stiffness: Some(8e7),
            damping: 0.0,
        },
        bending: Spring {
            stiffness: Some(1.2e4),
            damping: 0.0,
        },
        loss_factor: 0.03,
        ..Joint::default()
    };
    let carbide = Material {
        modulus: 580e9,
        density: 14_400.0,
        poisson: 0.22,
        loss_factor: 0.0015,
    };
    let steel = Material {
        loss_factor: 0.0015,
        ..STEEL
    };
    let segments = [
        Segment {
            joint: Some(low),
            material: steel,
            ..rod(0.08, 0.036)
        },
        Segment {
            joint: Some(high),
            material: carbide,
            ..rod(0.03, 0.01)
        },
        Segment {
            material: carbide,
            ..rod(0.025, 0.008)
        },
    ];
    let found = tip_modes(&swept(&nose, &segments, [5.0, 4000.0]), None).unwrap();
    assert_eq!(found.modes.len(), 7, "{:?}", found.modes);
    // What remains is the difference of structural from viscous damping, and modes above the band.
    assert!(
        found.deviation.iter().all(|part| *part < 0.01),
        "{:?}",
        found.deviation
    );
}
