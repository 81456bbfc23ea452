//! A made-up frequency response function.

use armill_report::{FrfCurve, FrfPlot, FrfStyle};

/// Name and SVG of each picture.
pub fn pictures() -> Vec<(&'static str, String)> {
    vec![("frf_plot", frf_plot().to_svg())]
}

/// Two modes, measured with noise, and their fit.
fn frf_plot() -> FrfPlot {
    let hz: Vec<f64> = (0..600).map(|k| 300.0 + 3.0 * f64::from(k)).collect();
    let at = |hz: f64| {
        let parts = [(620.0, 0.02, 0.05), (1150.0, 0.03, 0.03)].map(|(own, ratio, size): (f64, f64, f64)| {
            let (a, b) = (1.0 - (hz / own).powi(2), 2.0 * ratio * hz / own);
            [size * a / (a * a + b * b), -size * b / (a * a + b * b)]
        });
        [parts[0][0] + parts[1][0], parts[0][1] + parts[1][1]]
    };
    let curve = |noise: f64| {
        let values: Vec<[f64; 2]> = hz
            .iter()
            .map(|hz| {
                let [re, im] = at(*hz);
                [
                    re + noise * (hz * 12.9898).sin(),
                    im + noise * (hz * 78.233).sin(),
                ]
            })
            .collect();
        FrfCurve {
            frequencies_hz: hz.clone(),
            magnitudes_um_per_n: values.iter().map(|[re, im]| re.hypot(*im)).collect(),
            phases_deg: values.iter().map(|[re, im]| im.atan2(*re).to_degrees()).collect(),
            ..FrfCurve::default()
        }
    };
    FrfPlot {
        title: "Receptance of a tool tip".into(),
        subtitle: "Impact test along X, two modes".into(),
        curves: vec![
            FrfCurve {
                name: "1X/1X measured".into(),
                style: FrfStyle::Points,
                coherences: hz
                    .iter()
                    .map(|hz| 0.99 - 0.04 * (hz * 0.37).sin().abs())
                    .collect(),
                ..curve(0.006)
            },
            FrfCurve {
                name: "1X/1X fitted".into(),
                ..curve(0.0)
            },
        ],
        modes_hz: vec![620.0, 1150.0],
    }
}
