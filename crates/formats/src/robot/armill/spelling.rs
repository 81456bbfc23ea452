//! How numbers and texts of a robot file are spelled.

use armill_core::units::{from_deg, from_mm, to_deg, to_mm};

use super::super::description::RobotDescription;

/// Adds a line; writing to a text cannot fail.
pub(super) fn line(text: &mut String, content: &str) {
    text.push_str(content);
    text.push('\n');
}

/// Adds the tables of all sources.
pub(super) fn sources(text: &mut String, found: &RobotDescription) {
    for source in &found.sources {
        line(text, &format!("\n[sources.{}]", quoted(&source.key)));
        line(text, &format!("what = {}", quoted(&source.what)));
        line(text, &format!("where = {}", quoted(&source.place)));
        line(text, &format!("licence = {}", quoted(&source.licence)));
    }
}

/// The key of the one source.
pub(super) fn source(found: &RobotDescription) -> &str {
    found.sources.first().map_or("", |source| source.key.as_str())
}

/// A length in m as mm.
pub(super) fn millimetres(m: f64, within: f64) -> String {
    shortest(m, to_mm(m), within, from_mm)
}

/// An angle in rad as deg.
pub(super) fn degrees(rad: f64, within: f64) -> String {
    shortest(rad, to_deg(rad), within, from_deg)
}

/// The shortest decimal of `shown` that `to_si` takes back to `si`.
///
/// Up to 15 digits behind the point; where none of these is near enough, all digits that distinguish the number from
/// its neighbours.
fn shortest(si: f64, shown: f64, within: f64, to_si: fn(f64) -> f64) -> String {
    // Of the decimals that come back near enough the shortest has the fewest digits.
    let decimals = (0..=15).map(|digits| format!("{shown:.digits$}"));
    let found = decimals
        .filter(|text| {
            text.parse::<f64>()
                .is_ok_and(|value| (to_si(value) - si).abs() <= within)
        })
        .min_by_key(String::len);
    match found.unwrap_or_else(|| format!("{shown:?}")) {
        text if text == "-0" => "0".to_owned(),
        text => text,
    }
}

/// A TOML string.
pub(super) fn quoted(text: &str) -> String {
    toml_edit::Value::from(text).to_string()
}
