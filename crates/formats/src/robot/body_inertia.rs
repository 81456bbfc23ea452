//! Whether three by three numbers are the inertia of a body.
//!
//! Principal inertias `A <= B <= C` of a body are not negative, and `C <= A + B`: `A + B - C` is twice an integral of a square.
//! A thin plate has `C = A + B`, which printed digits miss by their rounding.

use armill_core::nalgebra::Matrix3;

/// Printed inertias of thin bodies miss `C = A + B` by less than this part of `C`: three digits and more.
const PRINTED: f64 = 1e-3;

/// An inertia that is not symmetric by more than this part of its largest number is refused.
const ROUNDING: f64 = 1e-9;

/// Greatest number of an inertia, kg m^2: as in robot files.
const GREATEST: f64 = 1e9;

/// What is wrong with an inertia (kg m^2), about the centre of mass in any axes; `None` for that of a body.
pub fn not_of_a_body(inertia: &Matrix3<f64>) -> Option<String> {
    let largest = inertia.amax();
    if !inertia.iter().all(|value| value.abs() <= GREATEST) {
        return Some(format!("an inertia contains a number beyond {GREATEST:e} kg m^2"));
    }
    if (inertia - inertia.transpose()).amax() > ROUNDING * largest {
        return Some("the inertia is not symmetric".to_owned());
    }
    let mut principal: [f64; 3] = inertia.symmetric_eigenvalues().into();
    principal.sort_by(f64::total_cmp);
    let [a, b, c] = principal;
    if a < -ROUNDING * largest {
        return Some(format!(
            "the inertia about one axis is {a:.3e} kg m^2: it must not be negative"
        ));
    }
    (c > (a + b) + PRINTED * c).then(|| {
        format!("principal inertias {a:.3e}, {b:.3e} and {c:.3e} kg m^2: of a body the largest is at most the sum of the others")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use armill_core::nalgebra::Vector3;

    #[test]
    fn plates_and_spheres_are_bodies_and_a_long_axis_without_width_is_none() {
        let of = |a, b, c| not_of_a_body(&Matrix3::from_diagonal(&Vector3::new(a, b, c)));
        assert_eq!(of(1.0, 1.0, 1.0), None);
        assert_eq!(of(1.0, 2.0, 3.0), None);
        assert_eq!(of(0.0, 0.0, 0.0), None);
        assert_eq!(of(1.0, 2.0, 3.002), None);
        assert!(
            of(1.0, 2.0, 3.1)
                .unwrap()
                .contains("at most the sum of the others")
        );
        assert!(of(-1.0, 2.0, 2.0).unwrap().contains("must not be negative"));
        assert!(of(f64::NAN, 2.0, 2.0).unwrap().contains("beyond 1e9"));
        let mut skew = Matrix3::identity();
        skew[(0, 1)] = 0.1;
        assert!(not_of_a_body(&skew).unwrap().contains("not symmetric"));
    }
}
