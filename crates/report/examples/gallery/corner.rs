//! A made-up corner of a path.

use armill_report::{AxisLabels, NamedLine, PathDetail};

/// Name and SVG of the picture.
pub fn pictures() -> Vec<(&'static str, String)> {
    vec![("path_detail", path_detail().to_svg())]
}

/// A corner with a zone of 2 mm, and a tip that is late by 3 mm.
fn path_detail() -> PathDetail {
    let line = |name: &str, points_mm| NamedLine {
        name: name.to_owned(),
        points_mm,
    };
    let commanded: Vec<[f64; 2]> = (0..=400)
        .map(|k| f64::from(k) * 0.05 - 10.0)
        .map(|s| match 0.5 * (1.0 + s / 2.0) {
            w if w <= 0.0 => [s, 0.0],
            w if w >= 1.0 => [0.0, s],
            w => [-2.0 * (1.0 - w).powi(2), 2.0 * w * w],
        })
        .collect();
    let part = 1.0 - (-0.05_f64 / 3.0).exp();
    let follow = |tip: &mut [f64; 2], at: &[f64; 2]| {
        *tip = [0, 1].map(|k| tip[k] + part * (at[k] - tip[k]));
        Some(*tip)
    };
    let followed = commanded.iter().scan([-13.0, 0.0], follow).collect();
    PathDetail {
        title: "Corner of a pocket".to_owned(),
        subtitle: "zone of 2 mm, 200 mm/s, joints 15 ms late".to_owned(),
        axes: AxisLabels {
            horizontal: "along the feed (mm)".to_owned(),
            vertical: "in the direction of the displacement (mm)".to_owned(),
        },
        centre_mm: [-3.0, 3.0],
        half_size_mm: 5.0,
        lines: vec![
            line("programmed", vec![[-10.0, 0.0], [0.0, 0.0], [0.0, 10.0]]),
            line("commanded", commanded),
            line("followed", followed),
        ],
    }
}
