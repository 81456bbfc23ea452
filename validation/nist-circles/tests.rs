//! All 30 sets of the data set, where it is at hand.

use armill_core::roundness::RoundnessError;

use super::*;

/// RONt of LSCI and MZCI, centre of MZCI (axes as the files have them), radii of MCCI and MICI, of the full circles.
///
/// The inscribed radius of set 19 from all triples; a first computation with another method gave 22.864515118.
#[rustfmt::skip]
const FULL: &[(usize, [f64; 6])] = &[
    (1, [0.266197023, 0.262769892, -560.3201249, 34.2417191, 13.419031134, 13.160359917]),
    (4, [0.046522976, 0.039595139, 627.1767101, 326.6122396, 2.515882557, 2.478814405]),
    (6, [0.097716398, 0.094798987, -104.5354682, -202.3639931, 79.893617235, 79.799359572]),
    (8, [0.005880507, 0.004498527, -130.3676024, 144.3482202, 6.443724924, 6.439807053]),
    (10, [0.003268785, 0.002903867, -360.4094805, 271.3005978, 2.702479832, 2.699705979]),
    (11, [0.000005942, 0.000005075, 0.5905121, 0.8357968, 0.861538329, 0.861534657]),
    (12, [0.694828859, 0.681787749, -144.7554873, -451.3698963, 34.163615666, 33.492916323]),
    (13, [0.109998577, 0.109383974, -20.6534366, -25.6655227, 111.272995195, 111.164842088]),
    (16, [0.002852135, 0.002552022, -475.3146903, -249.5463963, 21.046782717, 21.044737375]),
    (17, [0.014235357, 0.013953657, -0.2328178, 0.7881531, 0.715512614, 0.703139214]),
    (18, [0.035954366, 0.035295794, -0.0768974, 0.0024226, 1.663205314, 1.628689784]),
    (19, [0.025468724, 0.023461627, 167.3563616, -600.3649059, 22.887225968, 22.864516155]),
    (22, [0.000012004, 0.000011870, -600.5093622, -428.7134351, 169.462372040, 169.462360212]),
    (23, [0.031067341, 0.028847185, -132.3718566, 303.7392081, 58.022195185, 57.997215481]),
    (25, [0.056791793, 0.052282545, -8.7185639, 3.1890994, 6.291115474, 6.245383149]),
    (27, [0.165844706, 0.138029051, -101.5873972, -52.8371518, 146.591390720, 146.473656434]),
    (29, [0.002477794, 0.002423154, -924.0902382, 354.0523179, 1.985670811, 1.983438146]),
];

/// RONt of LSCI and MZCI of the arcs.
#[rustfmt::skip]
const ARCS: &[(usize, [f64; 2])] = &[
    (2, [0.003456043, 0.003387555]),
    (3, [2.231375944, 2.053445680]),
    (5, [0.075184555, 0.068183023]),
    (7, [0.000360568, 0.000330650]),
    (14, [0.027730202, 0.025908488]),
    (15, [0.239599936, 0.212123762]),
    (20, [0.272540181, 0.239532403]),
    (21, [3.727297583, 3.294092138]),
    (24, [0.077334446, 0.072454055]),
    (26, [0.022092129, 0.018067253]),
    (28, [1.167252341, 1.029891578]),
    (30, [0.665404352, 0.640129029]),
];

/// Between two computations of the peak to valley about least-squares circles.
const TWICE_COMPUTED: f64 = 1.1e-9;

/// Numbers of the typed sets, as in the NIST files.
const TYPED: [usize; 8] = [4, 8, 11, 13, 16, 23, 25, 27];

/// The numbers of a file of a set; none if the samples are not available.
fn numbers(set: usize, ending: &str) -> Option<Vec<f64>> {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return None;
    };
    let file = std::path::Path::new(&samples).join(format!("datasets/nist-circles/cir2d{set}.{ending}"));
    let text = std::fs::read_to_string(&file).expect("a set of NIST");
    Some(
        text.split_whitespace()
            .map(|word| word.parse().unwrap())
            .collect(),
    )
}

fn points(set: usize) -> Option<Vec<Point3<f64>>> {
    let numbers = numbers(set, "ds")?;
    let rows = numbers[1..].chunks_exact(3);
    assert_eq!(rows.len(), numbers[0] as usize);
    Some(rows.map(|row| Point3::new(row[0], row[1], row[2])).collect())
}

fn profile(points: &[Point3<f64>]) -> (Plane, Profile) {
    let plane = Plane::nearest(points).unwrap();
    let seen = points.iter().map(|p| plane.seen(p)).collect();
    (plane, Profile::new(seen).unwrap())
}

#[test]
fn typed_sets_are_those_of_the_data_set() {
    for (number, set) in TYPED.into_iter().zip(SETS) {
        let Some(points) = points(number) else { return };
        assert!(points.iter().zip(set.points).all(|(a, b)| *a == Point3::from(*b)));
        assert_eq!(points.len(), set.points.len());
        let fit = numbers(number, "fit").unwrap();
        assert_eq!((&fit[..3], fit[6]), (&set.centre[..], set.diameter));
    }
}

#[test]
fn least_squares_circles_of_all_sets_are_those_of_nist() {
    for set in 1..=30 {
        let Some(points) = points(set) else { return };
        let fit = numbers(set, "fit").unwrap();
        let (plane, profile) = profile(&points);
        let (circle, radius) = (profile.least_squares(), fit[6] / 2.0);
        let away = (plane.at(&circle.centre) - Point3::new(fit[0], fit[1], fit[2])).norm();
        assert!(
            away < LEAST_SQUARES * radius && (circle.radius - radius).abs() < LEAST_SQUARES * radius,
            "{set}"
        );
    }
}

#[test]
fn full_circles_have_the_zone_and_radii_that_were_computed() {
    for (set, [lsci, mzci, first, second, mcci, mici]) in FULL {
        let Some(points) = points(*set) else { return };
        let (plane, profile) = profile(&points);
        let zone = profile.minimum_zone().unwrap();
        let near = |ours: f64, given: f64| (ours - given).abs() < PRINTED;
        let given = profile.least_squares().peak_to_valley;
        assert!((given - lsci).abs() < TWICE_COMPUTED, "{set}: {given} {lsci}");
        assert!(near(zone.peak_to_valley(), *mzci), "{set}: {zone:?}");
        assert!(near(profile.minimum_circumscribed().radius, *mcci), "{set}");
        assert!(near(profile.maximum_inscribed().unwrap().radius, *mici), "{set}");
        let centre = plane.at(&zone.centre);
        let mut across = (0..3).filter(|axis| *axis != plane.normal.iamax());
        for given in [first, second] {
            let axis = across.next().unwrap();
            assert!((centre[axis] - given).abs() < PRINTED_CENTRE, "{set}: {centre}");
        }
    }
}

#[test]
fn arcs_have_the_zone_that_was_computed_and_no_inscribed_circle() {
    for (set, [lsci, mzci]) in ARCS {
        let Some(points) = points(*set) else { return };
        let (_, profile) = profile(&points);
        assert!(
            (profile.least_squares().peak_to_valley - lsci).abs() < TWICE_COMPUTED,
            "{set}"
        );
        assert!(
            (profile.minimum_zone().unwrap().peak_to_valley() - mzci).abs() < PRINTED,
            "{set}"
        );
        let refused = profile.maximum_inscribed().unwrap_err();
        assert!(matches!(refused, RoundnessError::Open { .. }), "{set}: {refused}");
    }
}

#[test]
fn three_points_have_no_form_error() {
    let Some(points) = points(9) else { return };
    let (_, profile) = profile(&points);
    let zone = profile.minimum_zone().unwrap();
    assert!(zone.peak_to_valley() < 1e-12 && (zone.inner - 20.905_861_052).abs() < PRINTED);
    for circle in [
        profile.minimum_circumscribed(),
        profile.maximum_inscribed().unwrap(),
    ] {
        assert!((circle.radius - 20.905_861_052).abs() < PRINTED && circle.peak_to_valley < 1e-12);
    }
}
