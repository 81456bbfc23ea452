//! Equation (11) of the paper, with its arctangent, against our split. See README.md.
//!
//! | symbol | meaning |
//! |---|---|
//! | `v` | deviation in base, of any unit |
//! | `alpha` | tilt of the plane about base y; at 0 it is upright and faces the robot |
//! | `x'` | along the normal of the plane, `y, z'` in it |
//!
//! The paper takes `arctan[dz/dx]`, which does not know the quadrant: signs along the normal are right with two
//! arguments only.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Point3, Vector3};

use armill_core::workpiece::{Plane, Split};

use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const PAPER: &str = "equation (11), Shneor & Chapsky 2021";
const SEED: u64 = 4;
const VECTORS: usize = 100_000;

/// `delta x'` and the length of `devPlane` by equation (11), from `arctan[delta z / delta x]`.
fn equation_11(v: &Vector3<f64>, alpha: f64, arctan: f64) -> (f64, f64) {
    // arctan[dz/dx] = beta + 90 - alpha
    let beta = arctan - FRAC_PI_2 + alpha;
    let v_xz = (v.x * v.x + v.z * v.z).sqrt();
    let (x, y, z) = (v_xz * beta.sin(), v.y, v_xz * beta.cos());
    (x, (y * y + z * z).sqrt())
}

/// Parts of a deviation on a plane against those by turning the frame.
pub fn checks() -> Vec<Check> {
    let mut random = Random::seeded(SEED);
    let (mut in_plane, mut normal, mut signed) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..VECTORS {
        // Components of up to 1; tilts as the paper allows, -90 to 90 deg.
        let (v, alpha) = (random.vector(1.0), random.between(-0.5 * PI, 0.5 * PI));
        let split = Split::of(&v, Plane::tilted(Point3::origin(), alpha).normal());
        let (x, plane) = equation_11(&v, alpha, (v.z / v.x).atan());
        in_plane.push(split.in_plane - plane);
        normal.push(split.normal.abs() - x.abs());
        let (x, _) = equation_11(&v, alpha, v.z.atan2(v.x));
        signed.push(split.normal - x);
    }
    let row = |what: &str, errors: Vec<f64>| {
        // A dozen roundings of numbers of size 1; the in-plane root of a small sum of squares keeps that size.
        let gap = ErrorBound {
            worst: worst(errors),
            tolerance: 1e-14,
            unit: "of length 1",
        };
        Check::computed(format!("{what}, {VECTORS} random vectors and tilts"), PAPER, gap)
    };
    vec![
        row("in-plane length, arctangent as printed", in_plane),
        row("length along the normal, arctangent as printed", normal),
        row(
            "signed length along the normal, arctangent of two arguments",
            signed,
        ),
    ]
}
