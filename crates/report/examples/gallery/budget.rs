//! A made-up budget of a circle.

use armill_report::{
    BudgetBar, BudgetBars, BudgetGroup, ErrorDistribution, ErrorSet, ModelErrors, WaveBar, WaveBars,
};

/// Name and SVG of each picture.
pub fn pictures() -> Vec<(&'static str, String)> {
    vec![
        ("budget", budget().to_svg()),
        ("waves", waves().to_svg()),
        ("errors", errors().to_svg()),
    ]
}

fn budget() -> BudgetBars {
    let bar = |label: &str, group, largest_um, scatter_um| BudgetBar {
        label: label.to_owned(),
        group,
        largest_um,
        scatter_um,
    };
    BudgetBars {
        title: "Groove: error budget".to_owned(),
        subtitle: "circle of 100 mm; from the least-squares centre and radius of each".to_owned(),
        quantity: "largest radial deviation (µm)".to_owned(),
        bars: vec![
            bar("deviation under load", BudgetGroup::Contribution, 60.0, 4.0),
            bar(
                "path without load, both ways",
                BudgetGroup::Contribution,
                110.0,
                0.0,
            ),
            bar("reversal", BudgetGroup::Contribution, 48.0, 0.0),
            bar("repeatability", BudgetGroup::Contribution, 0.0, 9.0),
            bar("added with their signs", BudgetGroup::Sum, 171.0, 9.8),
            bar("root of the squares", BudgetGroup::Sum, 152.3, 0.0),
            bar("plain sum", BudgetGroup::Sum, 200.0, 0.0),
            bar("part", BudgetGroup::Measured, 183.0, 0.0),
            bar("not explained", BudgetGroup::Measured, 34.0, 0.0),
        ],
    }
}

fn errors() -> ErrorDistribution {
    let poses = |count: u32, size: f64| -> Vec<f64> {
        (1..=count)
            .map(|k| size * (-(1.0 - f64::from(k) / f64::from(count + 1)).ln()).sqrt())
            .collect()
    };
    let set = |name: &str, count: u32, [before, after]: [f64; 2]| ErrorSet {
        name: name.to_owned(),
        models: [("before", before), ("after", after)]
            .map(|(name, size)| ModelErrors {
                name: name.to_owned(),
                errors_mm: poses(count, size),
            })
            .to_vec(),
    };
    ErrorDistribution {
        title: "Arm: errors of position".to_owned(),
        subtitle: "90 poses for identification, 30 for validation".to_owned(),
        quantity: "position error (mm)".to_owned(),
        sets: vec![
            set("found from", 90, [0.9, 0.15]),
            set("validation", 30, [0.95, 0.22]),
        ],
    }
}

fn waves() -> WaveBars {
    let wave = |waves, measured_um, predicted_um, phase_difference_deg| WaveBar {
        waves,
        measured_um,
        predicted_um,
        phase_difference_deg: Some(phase_difference_deg),
    };
    WaveBars {
        title: "Groove: undulations".to_owned(),
        subtitle: "91.0 % explained".to_owned(),
        names: ["part".to_owned(), "predicted".to_owned()],
        waves: vec![
            wave(1, 0.2, 0.1, 40.0),
            wave(2, 92.0, 84.0, -6.0),
            wave(3, 31.0, 28.0, 14.0),
            wave(4, 9.0, 6.0, 88.0),
            wave(5, 12.0, 11.0, -3.0),
            wave(6, 2.0, 1.0, 120.0),
        ],
    }
}
