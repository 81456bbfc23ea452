//! The picture of measured and fitted torsions.

use armill_core::torsion::{Estimate, Torsion};
use armill_core::units::to_urad;
use armill_report::{TorsionPanel, TorsionPlot};

use super::answer::Evaluated;

/// Measured torsion against torque, and a fitted line for each direction of motion, of each joint.
pub fn picture(evaluated: &Evaluated) -> TorsionPlot {
    TorsionPlot {
        title: "Torsion of the joints, link minus motor".to_owned(),
        subtitle: format!(
            "{}; without delay, offset and transmission error",
            evaluated.answer.file
        ),
        panels: evaluated
            .torsions
            .iter()
            .map(|(joint, torsion)| panel(*joint, torsion))
            .collect(),
    }
}

fn panel(joint: usize, torsion: &Torsion) -> TorsionPanel {
    let torques: Vec<f64> = torsion.curve.iter().map(|row| row[0]).collect();
    let [low, high] = torques
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], torque| {
            [low.min(*torque), high.max(*torque)]
        });
    let value = |estimate: Option<Estimate>| estimate.map_or(0.0, |estimate| estimate.value);
    let at = |torque: f64, direction: f64| {
        let fitted = direction * value(torsion.reversal) - value(torsion.compliance) * torque;
        [torque, to_urad(fitted)]
    };
    TorsionPanel {
        joint: format!("joint {joint}"),
        torsions_urad: torsion.curve.iter().map(|row| to_urad(row[1])).collect(),
        lines: [-1.0, 1.0]
            .map(|direction| [at(low, direction), at(high, direction)])
            .to_vec(),
        torques_nm: torques,
    }
}
