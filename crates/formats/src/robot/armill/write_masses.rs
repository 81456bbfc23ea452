//! Masses of a robot, written: `[[mass]]`.
//!
//! Centres are the shortest decimals that come back within 1e-12 m; masses and inertias come back as the same numbers.

use super::super::description::RobotDescription;
use super::spelling::{line, millimetres, quoted, source, sources};
use armill_core::robot::Attachment;

/// How far a coordinate may be from its decimal, m.
const WITHIN: f64 = 1e-12;

/// The masses alone, with their sources: tables that can be appended to a robot file.
pub fn mass_tables(found: &RobotDescription) -> String {
    let mut text = String::new();
    masses(&mut text, found);
    sources(&mut text, found);
    text
}

/// Adds the tables of all masses.
pub(super) fn masses(text: &mut String, found: &RobotDescription) {
    for mass in &found.robot.structure().masses {
        let at = match mass.attachment {
            Attachment::Base => "base",
            Attachment::Joint(joint) => &found.robot.joints()[joint].name,
            Attachment::Flange => "flange",
            Attachment::Tool => "tool",
        };
        let three = |values: [String; 3]| format!("[{}]", values.join(", "));
        line(text, "\n[[mass]]");
        line(text, &format!("at = {}", quoted(at)));
        line(text, &format!("mass_kg = {:?}", mass.mass));
        if mass.relative_uncertainty > 0.0 {
            line(
                text,
                &format!("mass_u_percent = {:?}", 100.0 * mass.relative_uncertainty),
            );
        }
        let centre: [f64; 3] = mass.centre.coords.into();
        line(
            text,
            &format!("centre_mm = {}", three(centre.map(|m| millimetres(m, WITHIN)))),
        );
        if let Some(inertia) = mass.inertia {
            // The mean of both halves: rounding of a rotation makes them differ by their last digit.
            let symmetric = (inertia + inertia.transpose()) * 0.5;
            let row = |i: usize| three([0, 1, 2].map(|j| format!("{:?}", symmetric[(i, j)])));
            line(text, &format!("inertia_kg_m2 = {}", three([0, 1, 2].map(row))));
        }
        line(text, &format!("source = {}", quoted(source(found))));
    }
}
