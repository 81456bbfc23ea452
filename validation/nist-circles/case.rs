//! Circles of NIST's Algorithm Testing System: points to the four reference circles. See README.md.
//!
//! Lengths in the unit of the files, used as metres: the comparisons do not depend on it.

use nalgebra::Point3;

use armill_core::roundness::{Plane, Profile};

use crate::check::{Check, ErrorBound};

#[cfg(test)]
mod tests;

/// Least-squares circles of NIST.
const NIST: &str = "published numbers";
/// Minimum zone by trying all centres of two and two or three and one points; the others by another program.
const COMPUTED: &str = "independent computation";
/// Half of the last digit that the independent computation printed, and rounding of the mean of hundreds of lengths.
const PRINTED: f64 = 0.6e-9;
/// Half of the last digit of a printed centre.
const PRINTED_CENTRE: f64 = 0.6e-7;
/// Part of the radius within which a least-squares circle must be that of NIST.
const LEAST_SQUARES: f64 = 1e-9;

/// One set with what others found.
struct Set {
    /// `cir2dN.ds`.
    points: &'static [[f64; 3]],
    /// `cir2dN.fit`: centre, and last of all the diameter.
    centre: [f64; 3],
    diameter: f64,
    /// Peak to valley about the least-squares and the minimum zone circle.
    ront_lsci: f64,
    ront_mzci: f64,
    /// The axes of the centre of the latter, and that centre.
    in_plane: [usize; 2],
    mzci_centre: [f64; 2],
    /// Radii of the minimum circumscribed and the maximum inscribed circle.
    mcci_radius: f64,
    mici_radius: f64,
}

/// How far our circles are off.
struct Off {
    /// Centre and radius of the least-squares circle, over the radius.
    least_squares: f64,
    /// The largest of both peaks to valley and both radii.
    printed: f64,
    /// Centre of the minimum zone.
    centre: f64,
}

impl Set {
    /// Our circles of `points` compared with the reference; infinite without a circle.
    fn off(&self, points: &[Point3<f64>]) -> Off {
        let none = Off {
            least_squares: f64::INFINITY,
            printed: f64::INFINITY,
            centre: f64::INFINITY,
        };
        let Some(plane) = Plane::nearest(points) else {
            return none;
        };
        let Ok(profile) = Profile::new(points.iter().map(|p| plane.seen(p)).collect()) else {
            return none;
        };
        let (Ok(zone), Ok(inscribed)) = (profile.minimum_zone(), profile.maximum_inscribed()) else {
            return none;
        };
        let least = profile.least_squares();
        let away = (plane.at(&least.centre) - Point3::from(self.centre)).norm();
        let radius = self.diameter / 2.0;
        let zone_centre = plane.at(&zone.centre);
        let printed = [
            least.peak_to_valley - self.ront_lsci,
            zone.peak_to_valley() - self.ront_mzci,
            profile.minimum_circumscribed().radius - self.mcci_radius,
            inscribed.radius - self.mici_radius,
        ];
        Off {
            least_squares: away.max((least.radius - radius).abs()) / radius,
            printed: printed.into_iter().fold(0.0, |worst, off| off.abs().max(worst)),
            centre: (0..2)
                .map(|k| (zone_centre[self.in_plane[k]] - self.mzci_centre[k]).abs())
                .fold(0.0, f64::max),
        }
    }
}

/// The sets that are typed here: all full circles of at most ten points.
pub fn checks() -> Vec<Check> {
    let off: Vec<Off> = SETS
        .iter()
        .map(|set| {
            let points: Vec<_> = set.points.iter().map(|p| Point3::from(*p)).collect();
            set.off(&points)
        })
        .collect();
    let worst = |of: fn(&Off) -> f64| off.iter().map(of).fold(0.0, f64::max);
    let gap = |worst: f64, tolerance: f64| ErrorBound {
        worst,
        tolerance,
        unit: "",
    };
    vec![
        Check::computed(
            "least-squares centre and radius of 8 sets, over the radius",
            NIST,
            gap(worst(|off| off.least_squares), LEAST_SQUARES),
        ),
        Check::printed(
            "RONt of LSCI and MZCI, radius of MCCI and MICI, unit of the files",
            COMPUTED,
            gap(worst(|off| off.printed), PRINTED),
            11,
        ),
        Check::printed(
            "centre of MZCI, unit of the files",
            COMPUTED,
            gap(worst(|off| off.centre), PRINTED_CENTRE),
            9,
        ),
    ]
}

/// Points and least-squares circles: NIST. The rest: an independent computation.
#[rustfmt::skip]
const SETS: &[Set] = &[
    Set {
        points: &[
            [-289.2632, 624.68116, 326.52149],
            [-289.2632, 625.68271, 324.58693],
            [-289.2632, 627.82036, 324.21363],
            [-289.2632, 629.44968, 325.62746],
            [-289.2632, 629.39723, 327.79681],
            [-289.2632, 627.63651, 329.08331],
            [-289.2632, 625.56132, 328.49019],
        ],
        centre: [-289.2632, 627.176654427197, 326.6166704860534],
        diameter: 4.99481456455949,
        ront_lsci: 0.046522976,
        ront_mzci: 0.039595139,
        in_plane: [1, 2],
        mzci_centre: [627.1767101, 326.6122396],
        mcci_radius: 2.515882557,
        mici_radius: 2.478814405,
    },
    Set {
        points: &[
            [-124.61539, 147.25256, 794.45169],
            [-127.82836, 150.27059, 794.45169],
            [-132.22919, 150.51569, 794.45169],
            [-135.75873, 147.87686, 794.45169],
            [-136.76179, 143.58694, 794.45169],
            [-134.77699, 139.65512, 794.45169],
            [-130.72708, 137.91441, 794.45169],
            [-126.50977, 139.1895, 794.45169],
            [-124.09859, 142.87694, 794.45169],
        ],
        centre: [-130.3670158388263, 144.34923095984897, 794.45169],
        diameter: 12.883766377668422,
        ront_lsci: 0.005880507,
        ront_mzci: 0.004498527,
        in_plane: [0, 1],
        mzci_centre: [-130.3676024, 144.3482202],
        mcci_radius: 6.443724924,
        mici_radius: 6.439807053,
    },
    Set {
        points: &[
            [-0.26182, 0.71022, -0.53523],
            [0.44656, -0.01363, -0.53523],
            [1.35388, 0.4364, -0.53523],
            [1.20625, 1.43838, -0.53523],
            [0.20769, 1.60761, -0.53523],
        ],
        centre: [0.590512691763497, 0.8357957525306455, -0.53523],
        diameter: 1.7230726141346298,
        ront_lsci: 0.000005942,
        ront_mzci: 0.000005075,
        in_plane: [0, 1],
        mzci_centre: [0.5905121, 0.8357968],
        mcci_radius: 0.861538329,
        mici_radius: 0.861534657,
    },
    Set {
        points: &[
            [15.1397, -129.72597, -3.6404],
            [15.1397, -41.46951, -134.86389],
            [15.1397, 88.86212, -45.37],
            [15.1397, 0.32312, 83.50213],
        ],
        centre: [15.1397, -20.653367571511815, -25.664945094397115],
        diameter: 222.4387940522604,
        ront_lsci: 0.109998577,
        ront_mzci: 0.109383974,
        in_plane: [1, 2],
        mzci_centre: [-20.6534366, -25.6655227],
        mcci_radius: 111.272995195,
        mici_radius: 111.164842088,
    },
    Set {
        points: &[
            [-68.96646, -495.10298, -256.71324],
            [-68.96646, -482.0437, -269.48596],
            [-68.96646, -463.91281, -267.23694],
            [-68.96646, -454.37411, -251.65384],
            [-68.96646, -460.60945, -234.48887],
            [-68.96646, -477.90962, -228.66262],
            [-68.96646, -493.26078, -238.55044],
        ],
        centre: [-68.96646, -475.3143729117457, -249.54625026080407],
        diameter: 42.09190901332554,
        ront_lsci: 0.002852135,
        ront_mzci: 0.002552022,
        in_plane: [1, 2],
        mzci_centre: [-475.3146903, -249.5463963],
        mcci_radius: 21.046782717,
        mici_radius: 21.044737375,
    },
    Set {
        points: &[
            [-83.08709, -38.0873, 273.17073],
            [-125.51215, -38.0873, 246.13144],
            [-173.10488, -38.0873, 262.43964],
            [-190.07646, -38.0873, 309.8175],
            [-163.55485, -38.0873, 352.63748],
            [-113.54877, -38.0873, 358.60251],
            [-77.71665, -38.0873, 323.2219],
        ],
        centre: [-132.3733721504987, -38.0873, 303.7367968796689],
        diameter: 116.01774960018443,
        ront_lsci: 0.031067341,
        ront_mzci: 0.028847185,
        in_plane: [0, 2],
        mzci_centre: [-132.3718566, 303.7392081],
        mcci_radius: 58.022195185,
        mici_radius: 57.997215481,
    },
    Set {
        points: &[
            [-13.93285, -1.97183, 6.62144],
            [-10.04374, -1.97183, 9.34289],
            [-5.3716, -1.97183, 8.5062],
            [-2.64147, -1.97183, 4.61692],
            [-3.37999, -1.97183, -0.12926],
            [-7.34141, -1.97183, -2.90926],
            [-12.11852, -1.97183, -2.06743],
            [-14.8844, -1.97183, 1.92115],
        ],
        centre: [-8.721504339348526, -1.97183, 3.1956625712744184],
        diameter: 12.538840171297162,
        ront_lsci: 0.056791793,
        ront_mzci: 0.052282545,
        in_plane: [0, 2],
        mzci_centre: [-8.7185639, 3.1890994],
        mcci_radius: 6.291115474,
        mici_radius: 6.245383149,
    },
    Set {
        points: &[
            [17.77819, 12.79763, -144.44361],
            [17.77819, 44.83319, -59.75112],
            [17.77819, 20.82923, 27.58819],
            [17.77819, -49.84359, 84.17328],
            [17.77819, -140.30751, 88.55055],
            [17.77819, -215.95825, 38.72926],
            [17.77819, -247.88297, -45.98986],
            [17.77819, -224.07559, -133.3724],
            [17.77819, -153.3626, -189.98327],
            [17.77819, -62.9, -194.14204],
        ],
        centre: [17.77819, -101.59070092949369, -52.864818296596106],
        diameter: 293.06155637977724,
        ront_lsci: 0.165844706,
        ront_mzci: 0.138029051,
        in_plane: [1, 2],
        mzci_centre: [-101.5873972, -52.8371518],
        mcci_radius: 146.591390720,
        mici_radius: 146.473656434,
    },
];
