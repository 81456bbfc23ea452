use nalgebra::{UnitVector3, Vector3};

use super::*;

#[test]
fn slices_of_a_cone_with_lobes_have_their_radius_and_roundness() {
    let cylinder = Cylinder {
        at: Point3::new(0.1, 0.2, 0.3),
        axis: UnitVector3::new_normalize(Vector3::new(0.3, -0.2, 1.0)),
        radius: 0.02,
    };
    let [x, y] = cylinder.directions();
    let mut points = Vec::new();
    for a in -5..=5 {
        for k in 0..72 {
            let (z, phi) = (0.004 * f64::from(a), f64::from(5 * k).to_radians());
            let r = 0.02 + 1e-3 * z + 5e-6 * (4.0 * phi).cos();
            points.push(cylinder.at + cylinder.axis.as_ref() * z + x * (r * phi.cos()) + y * (r * phi.sin()));
        }
    }
    let found = slice_roundness(&points, &cylinder, &[-0.02, 0.0, 0.0185, 0.5], 0.004).unwrap();
    for (slice, z) in found.iter().zip([-0.02, 0.0, 0.02]) {
        let slice = slice.as_ref().unwrap();
        assert_eq!(slice.points, 72);
        assert!(
            (slice.least_squares.radius - 0.02 - 1e-3 * z).abs() < 1e-9,
            "{slice:?}"
        );
        let zone = slice.minimum_zone.unwrap();
        assert!((zone.outer - zone.inner - 10e-6).abs() < 1e-12, "{slice:?}");
        assert!((slice.inscribed.unwrap().radius - 0.02 - 1e-3 * z + 5e-6).abs() < 1e-12);
        assert!((slice.circumscribed.radius - 0.02 - 1e-3 * z - 5e-6).abs() < 1e-12);
    }
    assert_eq!(found[3], None);
    assert_eq!(
        slice_roundness(&points, &cylinder, &[0.0], 0.0),
        Err(FormError::Length { value: 0.0 })
    );
}
