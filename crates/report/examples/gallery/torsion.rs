//! Made-up torsion of two joints against the torque of their motors.

use armill_report::{TorsionPanel, TorsionPlot};

/// Name and SVG of each picture.
pub fn pictures() -> Vec<(&'static str, String)> {
    let plot = TorsionPlot {
        title: "Torsion of the joints".into(),
        subtitle: "link encoder less motor encoder".into(),
        panels: vec![panel("A2", 20.0, 60.0), panel("A3", 40.0, 30.0)],
    };
    vec![("torsion_plot", plot.to_svg())]
}

/// A joint that twists by `slope` urad/(N m), with this step at a reversal.
fn panel(joint: &str, slope: f64, step_urad: f64) -> TorsionPanel {
    let samples = (0..800).map(|k| {
        let phase = f64::from(k) * 0.031;
        let side = if phase.cos() > 0.0 { 0.5 } else { -0.5 };
        let torque = 30.0 * phase.sin() + 4.0 * (phase * 7.3).sin();
        let noise = 8.0 * (f64::from(k) * 12.9898).sin();
        (torque, slope * torque + side * step_urad + noise)
    });
    let (torques_nm, torsions_urad) = samples.unzip();
    let line = |side: f64| [-32.0, 32.0].map(|torque| [torque, slope * torque + side * step_urad]);
    TorsionPanel {
        joint: joint.into(),
        torques_nm,
        torsions_urad,
        lines: vec![line(0.5), line(-0.5)],
    }
}
