//! FANUC R-2000iC: speed of a drill at breakthrough, at four places in five postures each. See README.md.

use nalgebra::Vector3;

use armill_core::dynamics::{Mode, release};
use armill_core::frame::Isometry;
use armill_core::robot::inverse::posture_at;
use armill_core::source::elastic::predict;
use armill_core::spatial::Wrench;

use crate::arms;
use crate::check::{Check, ErrorBound, worst};
use crate::fanuc_rows::TOOL_POINT;

const REFERENCE: &str = "independent computation";
const HELD: &str = "postures of one hole";

/// One hole.
pub(crate) struct Hole {
    /// Joint positions of the controller, deg.
    joints_deg: [f64; 6],
    /// Feed and greatest speed at breakthrough, mm/s.
    pub feed: f64,
    pub surge: f64,
    /// Diameter, mm; nominal 10 mm.
    pub diameter: f64,
}

/// Postures of each place, in order.
pub(crate) const POSTURES: usize = 5;

/// Places A, B, C, D.
#[rustfmt::skip]
pub(crate) const HOLES: [Hole; 20] = [
    Hole {
        joints_deg: [-122.981, -18.087, -26.965, 180.002, 63.046, -57.027],
        feed: 8.39,
        surge: 76.59,
        diameter: 10.9,
    },
    Hole {
        joints_deg: [-102.55, -23.78, -35.69, 64.55, -60.93, 65.12],
        feed: 15.85,
        surge: 27.51,
        diameter: 10.59,
    },
    Hole {
        joints_deg: [-112.706, -24.251, -27.421, -150.503, 55.641, -82.716],
        feed: 15.96,
        surge: 44.62,
        diameter: 10.59,
    },
    Hole {
        joints_deg: [-99.662, -21.186, -40.849, 256.617, 67.26, -126.046],
        feed: 17.75,
        surge: 58.12,
        diameter: 10.71,
    },
    Hole {
        joints_deg: [-131.97, -7.41, -32.07, 158.88, 78.59, -40.02],
        feed: 16.71,
        surge: 47.95,
        diameter: 10.79,
    },
    Hole {
        joints_deg: [-61.045, -15.15, -27.311, 179.997, 62.695, -118.954],
        feed: 15.51,
        surge: 65.08,
        diameter: 11.09,
    },
    Hole {
        joints_deg: [-77.89, -19.76, -33.75, 125.99, 58.98, 288.43],
        feed: 16.79,
        surge: 20.83,
        diameter: 10.47,
    },
    Hole {
        joints_deg: [-69.608, -19.56, -28.143, 334.756, -56.431, 82.728],
        feed: 15.83,
        surge: 60.96,
        diameter: 10.71,
    },
    Hole {
        joints_deg: [-81.087, -17.893, -38.263, -246.53, 63.557, -60.035],
        feed: 18.81,
        surge: 39.5,
        diameter: 10.53,
    },
    Hole {
        joints_deg: [-45.29, 8.8, -43.04, 40.55, -99.69, -328.19],
        feed: 12.13,
        surge: 32.1,
        diameter: 10.6,
    },
    Hole {
        joints_deg: [-63.384, 2.353, -31.556, 179.996, 58.453, -206.614],
        feed: 17.02,
        surge: 149.25,
        diameter: 10.44,
    },
    Hole {
        joints_deg: [-52.487, -10.396, -47.325, 295.293, 38.128, 41.955],
        feed: 20.28,
        surge: 111.91,
        diameter: 10.38,
    },
    Hole {
        joints_deg: [-59.173, -7.152, -33.707, 201.254, 36.491, -225.795],
        feed: 13.0,
        surge: 149.36,
        diameter: 10.49,
    },
    Hole {
        joints_deg: [-51.791, -8.164, -51.434, 305.055, 46.537, -327.909],
        feed: 16.73,
        surge: 143.16,
        diameter: 10.43,
    },
    Hole {
        joints_deg: [-67.449, 17.315, -33.095, 168.054, 87.482, -198.754],
        feed: 15.09,
        surge: 158.75,
        diameter: 10.61,
    },
    Hole {
        joints_deg: [-69.425, -14.458, -29.889, 180.001, 60.122, -20.575],
        feed: 16.21,
        surge: 94.95,
        diameter: 10.59,
    },
    Hole {
        joints_deg: [-55.94, -35.064, -42.179, -235.107, -41.79, -321.471],
        feed: 20.03,
        surge: 90.54,
        diameter: 10.41,
    },
    Hole {
        joints_deg: [-63.624, -30.449, -28.281, 204.835, 34.595, 316.442],
        feed: 18.11,
        surge: 98.87,
        diameter: 10.51,
    },
    Hole {
        joints_deg: [-55.642, -32.907, -45.322, 130.425, -47.142, 32.779],
        feed: 18.14,
        surge: 92.93,
        diameter: 11.37,
    },
    Hole {
        joints_deg: [-72.37, -1.743, -33.769, 172.865, 79.1, -14.872],
        feed: 17.11,
        surge: 99.59,
        diameter: 10.59,
    },
];

/// Correlation of the increase of the speed with the root of the compliance along the drill: of all holes, and within the places A to D.
const EXPECTED: [f64; 5] = [0.908, -0.07, -0.51, 0.50, 0.53];

/// Tip (m) and compliance along the drill (m/N) of a hole.
pub(crate) fn at(hole: &Hole) -> (Vector3<f64>, f64) {
    let robot = arms::r2000ic();
    let joints = robot.compliance().expect("the arm was made with springs");
    let flange_from_tool = Isometry::translation(TOOL_POINT.x, TOOL_POINT.y, TOOL_POINT.z);
    let posture = posture_at(&robot, &hole.joints_deg.map(f64::to_radians), &flange_from_tool);
    // The drill is along y of the flange: only this axis is the same in all postures of a place.
    let along = posture.base_from_tool.rotation * Vector3::y();
    let moved = predict(&posture, joints, &Wrench::from_force(along)).twist.linear;
    (posture.base_from_tool.translation.vector, moved.dot(&along))
}

/// Increase of the speed by the release of 1 N from this compliance by a mass of 1 kg, m/s: one mode without damping.
fn increase(compliance: f64) -> f64 {
    let mode = Mode {
        angular_frequency: compliance.recip().sqrt(),
        damping_ratio: 0.0,
        shape: nalgebra::Vector6::new(1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };
    release(&[mode], &Vector3::x(), 1.0).peak_speed
}

fn correlation(pairs: &[(f64, f64)]) -> f64 {
    let count = pairs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (a, b) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let sum = |of: &dyn Fn(f64, f64) -> f64| pairs.iter().map(|(x, y)| of(x - a, y - b)).sum::<f64>();
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

/// Correlations as in [`EXPECTED`], and that of the increase of the speed with the diameter.
fn correlations() -> ([f64; 5], f64) {
    let pair = |hole: &Hole| (increase(at(hole).1), hole.surge - hole.feed);
    let all: Vec<(f64, f64)> = HOLES.iter().map(pair).collect();
    let mut found = [correlation(&all); 5];
    for (k, place) in all.chunks_exact(POSTURES).enumerate() {
        found[k + 1] = correlation(place);
    }
    let diameters: Vec<(f64, f64)> = HOLES
        .iter()
        .map(|hole| (hole.surge - hole.feed, hole.diameter))
        .collect();
    (found, correlation(&diameters))
}

/// Tips of one place against each other, and correlations against a script.
pub fn checks() -> Vec<Check> {
    let tips: Vec<Vector3<f64>> = HOLES.iter().map(|hole| at(hole).0).collect();
    let apart = tips.chunks_exact(POSTURES).flat_map(|place| {
        let mean = place.iter().sum::<Vector3<f64>>() / POSTURES as f64;
        place.iter().map(move |tip| (tip - mean).norm() * 1e3)
    });
    let (found, _) = correlations();
    let differences = found
        .iter()
        .zip(EXPECTED)
        .map(|(found, expected)| (found - expected).abs());
    vec![
        Check::printed(
            "tip of the drill in five postures at each of four places, from their mean",
            HELD,
            ErrorBound {
                worst: worst(apart),
                tolerance: 10.0,
                unit: "mm",
            },
            1,
        ),
        Check::printed(
            "correlation of measured increase of the speed at breakthrough and predicted one: 0.91 of all holes, -0.51 to 0.53 within a place",
            REFERENCE,
            ErrorBound {
                worst: worst(differences),
                tolerance: 0.005,
                unit: "",
            },
            3,
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_typed_holes_are_those_of_the_data_set() {
        let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
            println!("skipped: ARMILL_SAMPLES is not set");
            return;
        };
        let path =
            std::path::Path::new(&samples).join("datasets/fanuc-drilled-holes/diameter_error_data.csv");
        let text = std::fs::read_to_string(path).unwrap();
        let rows: Vec<Vec<f64>> = text
            .lines()
            .skip(1)
            .map(|row| {
                row.split(',')
                    .skip(1)
                    .map(|cell| cell.trim().parse().unwrap())
                    .collect()
            })
            .collect();
        assert_eq!(rows.len(), HOLES.len());
        for (row, hole) in rows.iter().zip(&HOLES) {
            assert_eq!(row[..6], hole.joints_deg);
            assert_eq!(row[6..], [hole.feed, hole.surge, hole.diameter]);
        }
    }

    #[test]
    fn the_speed_does_not_explain_the_diameters() {
        let (_, with_diameter) = correlations();
        assert!(with_diameter.abs() < 0.5, "{with_diameter}");
    }
}
