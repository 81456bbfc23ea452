//! Files of modal data: the reader under hostile input, and good files to begin with.

use armill_formats::modal;

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
