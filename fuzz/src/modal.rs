//! Files of modal data and of tool assemblies: the readers under hostile input, and good files to begin with.

use armill_core::dynamics::coupling::{Base, tip_receptance};
use armill_formats::{modal, tool_assembly};

use crate::verdicts::refused;

/// A file of modal data.
pub fn modal_data(bytes: &[u8]) {
    match modal::read("tool.toml", &String::from_utf8_lossy(bytes)) {
        Err(problems) => refused(&problems),
        Ok(found) => {
            let is_finite = |shape: &[f64]| shape.iter().all(|part| part.is_finite());
            assert!(!found.modes.is_empty());
            assert!(
                found
                    .modes
                    .iter()
                    .all(|named| is_finite(named.mode.shape.as_slice()))
            );
        }
    }
}

/// Two modes of a cutter, by mass and by stiffness.
pub fn seeds() -> Vec<Vec<u8>> {
    let head = "format = 1\nname = \"cutter\"\nsource = \"impact test\"\n";
    let modes = "[[mode]]\nfrequency_hz = 922\ndamping_percent = 1.1\ndirection = [1, 0, 0]\nmodal_mass_kg = 0.04\n\
                 [[mode]]\nname = \"b\"\nfrequency_hz = 700\nfrequency_u_hz = 5\ndamping_ratio = 0.02\ndamping_u_percent = 0.3\n\
                 direction = [0, 1, 0]\nstiffness_n_per_um = 8\nstiffness_u_percent = 5\n";
    vec![format!("{head}{modes}").into_bytes()]
}

/// A file of a tool assembly; what can be read has a receptance, or none.
pub fn tool_assembly_data(bytes: &[u8]) {
    match tool_assembly::read("tool.toml", &String::from_utf8_lossy(bytes)) {
        Err(problems) => refused(&problems),
        Ok(found) => {
            assert!(!found.segments.is_empty() && found.names.len() == found.segments.len());
            for w in [0.0, 100.0, 3e4] {
                if let Ok(tip) = tip_receptance(&Base::Rigid, &found.segments, w) {
                    assert!(tip.iter().all(|part| part.re.is_finite() && part.im.is_finite()));
                }
            }
        }
    }
}

/// Holder and cutter with a joint, and a spindle.
pub fn tool_assemblies() -> Vec<Vec<u8>> {
    let head = "format = 1\nname = \"cutter\"\nsource = \"drawing\"\nbeam = \"euler\"\n[spindle]\nmass_kg = 8\ncentre_mm = [0, 0, -120]\n";
    let segments = "[[segment]]\nname = \"holder\"\nlength_mm = 60\ndiameter_mm = 40\nbore_mm = 12\nmaterial = \"steel\"\n\
                    joint = { lateral_n_per_um = 80, bending_n_m_per_rad = 4e5, loss_factor = 0.02 }\n\
                    [[segment]]\nlength_mm = 25\ndiameter_mm = 12\nfluted = true\nmodulus_gpa = 600\ndensity_kg_per_m3 = 14500\n";
    vec![format!("{head}{segments}").into_bytes()]
}
