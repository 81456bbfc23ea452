//! ABB IRB 6640: joint logs of a real and a virtual controller, predicted from one of them. See README.md.

use crate::irb6640_logs::logs::predictions;
use crate::measured::{Comparison, Samples, Stated};

/// Cycle time, speed and corners of the other logs, learnt from a log of the virtual controller.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    let folder = samples.path("abb-irb6640-logs");
    let kinds = ["virtual", "real"].map(|kind| {
        let (_, stretches) = predictions(&folder, ["virtual", kind]);
        let row = |quantity: &str, unit, errors: Vec<f64>| Comparison {
            quantity: format!("{quantity}, {kind} controller"),
            model: "learnt from one virtual log".to_owned(),
            unit,
            errors,
            stated: Stated::Nothing,
        };
        // The first log of the virtual controller is the one that is learnt from.
        let others = stretches.iter().skip(usize::from(kind == "virtual"));
        let stretches = others.map(|(_, stretch)| stretch);
        let time = stretches
            .clone()
            .filter_map(|stretch| stretch.cycle_time_error_percent);
        let corners = stretches.clone().flat_map(|stretch| &stretch.corners);
        vec![
            row("cycle time", "%", time.collect()),
            row(
                "speed (rms of a log)",
                "%",
                stretches
                    .clone()
                    .map(|stretch| stretch.feed_rms_percent)
                    .collect(),
            ),
            row(
                "distance of the path from the corner",
                "mm",
                corners.map(|corner| corner.distance_error_mm).collect(),
            ),
        ]
    });
    kinds.concat()
}
