use armill_core::frame::from_xyz_and_fixed_angles;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;

/// The product of all screws with every joint at zero.
fn product(screws: &Screws) -> Isometry {
    let mut here = Isometry::identity();
    for (index, z) in screws.z.iter().enumerate() {
        let x = screws.x.get(index).copied().unwrap_or_default();
        here = here * z.displacement() * x.displacement();
    }
    here
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, rng_seed: RngSeed::Fixed(5), ..ProptestConfig::default() })]

    #[test]
    fn screws_lead_to_the_flange_and_are_on_the_axes(
        numbers in prop::collection::vec(prop::array::uniform6(-2.0..2.0_f64), 2..7),
        hayati in any::<bool>(),
    ) {
        let pose = |[x, y, z, a, b, c]: [f64; 6]| {
            from_xyz_and_fixed_angles(Vector3::new(x, y, z), Vector3::new(a, b, c))
        };
        let frames: Vec<Isometry> = numbers.iter().map(|six| pose(*six)).collect();
        let (flange, joints) = frames.split_last().unwrap();
        if let Ok(found) = screws(joints, flange, hayati) {
            let apart = product(&found).inverse() * flange;
            prop_assert!(apart.translation.vector.norm() < 1e-11 && apart.rotation.angle() < 1e-12);
            // Behind X_0 z is along the axis of joint 1.
            let mut here = found.z[0].displacement() * found.x[0].displacement();
            for (index, joint) in joints.iter().enumerate() {
                let local = here.inverse() * joint;
                prop_assert!((local.rotation * Vector3::z() - Vector3::z()).norm() < 1e-12);
                prop_assert!(local.translation.vector.xy().norm() < 1e-11);
                here = here * found.z[index + 1].displacement() * found.x[index + 1].displacement();
            }
        }
    }
}

#[test]
fn angles_are_within_half_a_turn() {
    for (angle, expected) in [
        (0.1, 0.1),
        (PI, PI),
        (-PI, PI),
        (3.5, 3.5 - TAU),
        (-6.0, TAU - 6.0),
    ] {
        assert!((within_half_turn(angle) - expected).abs() < 1e-15, "{angle}");
    }
}
