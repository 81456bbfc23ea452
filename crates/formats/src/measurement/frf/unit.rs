//! Units of the labels of a universal file and of the columns of a table.

use armill_core::units::{from_mm, from_um};

use super::quantity::Quantity;

/// Standard acceleration of gravity, m/s^2 (ISO 80000-3).
const GRAVITY: f64 = 9.806_65;
/// Pound-force, N (exact: 0.45359237 kg times standard gravity).
const POUND_FORCE: f64 = 4.448_221_615_260_5;
/// Inch, m.
const INCH: f64 = 0.0254;

/// Quantity and factor to SI of a label such as `m/s^2`; `None` for an unknown one.
pub(super) fn motion(label: &str) -> Option<(Quantity, f64)> {
    let label = label
        .trim()
        .to_lowercase()
        .replace([' ', '*', '^'], "")
        .replace("sec", "s");
    if label == "g" {
        return Some((Quantity::Acceleration, GRAVITY));
    }
    let (length, quantity) = match label.split_once('/') {
        None => (label.as_str(), Quantity::Displacement),
        Some((length, "s")) => (length, Quantity::Velocity),
        Some((length, "s2" | "s/s")) => (length, Quantity::Acceleration),
        Some(_) => return None,
    };
    let factor = match length {
        "m" => 1.0,
        "mm" => from_mm(1.0),
        "um" | "\u{b5}m" | "\u{3bc}m" => from_um(1.0),
        "in" => INCH,
        _ => return None,
    };
    Some((quantity, factor))
}

/// Factor to N of a label; `None` for an unknown one.
pub(super) fn force(label: &str) -> Option<f64> {
    match label.trim().to_lowercase().as_str() {
        "n" => Some(1.0),
        "kn" => Some(1000.0),
        "lbf" | "lb" => Some(POUND_FORCE),
        _ => None,
    }
}
