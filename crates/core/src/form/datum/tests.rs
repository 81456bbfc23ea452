use super::*;

fn normals() -> DatumNormals {
    DatumNormals {
        primary: -Vector3::z(),
        secondary: -Vector3::y(),
        tertiary: -Vector3::x(),
    }
}

const PRIMARY: [[f64; 3]; 3] = [[0.02, 0.01, 0.0], [0.09, 0.015, 0.0], [0.05, 0.06, 0.0]];
const SECONDARY: [[f64; 3]; 2] = [[0.01, 0.0, 0.02], [0.08, 0.0, 0.03]];
const TERTIARY: [f64; 3] = [0.0, 0.03, 0.01];

#[test]
fn the_frame_is_on_all_three_planes() {
    let (primary, secondary) = (PRIMARY.map(Point3::from), SECONDARY.map(Point3::from));
    let targets = DatumTargets {
        primary: &primary,
        secondary: &secondary,
        tertiary: TERTIARY.into(),
    };
    let frame = datum_frame(&targets, &normals()).unwrap();
    assert!(frame.translation.vector.norm() < 1e-16, "{frame}");
    assert!((frame * Vector3::z() + Vector3::z()).norm() < 1e-15);
    assert!((frame * Vector3::x() + Vector3::y()).norm() < 1e-15);
    // z x x = y
    assert!((frame * Vector3::y() - Vector3::z().cross(&Vector3::y())).norm() < 1e-15);
}

#[test]
fn a_motion_of_the_part_is_recovered_exactly() {
    let motion = Isometry::new(Vector3::new(0.1, -0.3, 0.7), Vector3::new(0.2, -0.1, 0.3));
    let (primary, secondary) = (PRIMARY.map(Point3::from), SECONDARY.map(Point3::from));
    let nominal = DatumTargets {
        primary: &primary,
        secondary: &secondary,
        tertiary: TERTIARY.into(),
    };
    // The probe touches the same planes at other places.
    let other = [[0.03, 0.05, 0.0], [0.07, 0.02, 0.0], [0.01, 0.01, 0.0]].map(|p| motion * Point3::from(p));
    let sides = [[0.02, 0.0, 0.011], [0.06, 0.0, 0.05]].map(|p| motion * Point3::from(p));
    let turned = DatumNormals {
        primary: motion * normals().primary,
        secondary: motion * normals().secondary,
        tertiary: motion * normals().tertiary,
    };
    let measured = DatumTargets {
        primary: &other,
        secondary: &sides,
        tertiary: motion * Point3::new(0.0, 0.01, 0.03),
    };
    let nominal_frame = datum_frame(&nominal, &normals()).unwrap();
    let measured_frame = datum_frame(&measured, &turned).unwrap();
    let left = nominal_frame * measured_frame.inverse() * motion;
    assert!(
        left.translation.vector.norm() < 1e-15 && left.rotation.angle() < 1e-14,
        "{left}"
    );
    // With a small motion the same normals serve both.
    let small = Isometry::new(Vector3::new(1e-3, 0.0, 0.0), Vector3::new(0.0, 1e-3, 2e-3));
    let moved = (primary.map(|p| small * p), secondary.map(|p| small * p));
    let targets = DatumTargets {
        primary: &moved.0,
        secondary: &moved.1,
        tertiary: small * Point3::from(TERTIARY),
    };
    let left = datum_motion(&targets, &nominal, &normals()).unwrap() * small;
    // The tertiary point is the same: only the rotation about it by 1e-3 is exact too.
    assert!(
        left.translation.vector.norm() < 1e-15 && left.rotation.angle() < 1e-14,
        "{left}"
    );
}

#[test]
fn targets_that_give_no_frame_are_refused() {
    let (primary, secondary) = (PRIMARY.map(Point3::from), SECONDARY.map(Point3::from));
    let with = |primary: &[Point3<f64>], secondary: &[Point3<f64>]| {
        datum_frame(
            &DatumTargets {
                primary,
                secondary,
                tertiary: TERTIARY.into(),
            },
            &normals(),
        )
        .unwrap_err()
    };
    assert_eq!(
        with(&primary[..2], &secondary),
        FormError::TooFew { needed: 3, given: 2 }
    );
    assert_eq!(
        with(&primary, &secondary[..1]),
        FormError::TooFew { needed: 2, given: 1 }
    );
    assert_eq!(with(&primary, &[secondary[0]; 2]), FormError::Undetermined);
    assert_eq!(with(&[primary[0]; 3], &secondary), FormError::Undetermined);
    let along_normal = [Point3::new(0.01, 0.0, 0.0), Point3::new(0.01, 0.0, 0.05)];
    assert_eq!(with(&primary, &along_normal), FormError::Undetermined);
}
