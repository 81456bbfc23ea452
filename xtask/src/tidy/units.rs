//! Every number in a file, a result or an option has its unit in its name.
//!
//! ```text
//! depth_mm   feed_mm_per_min   compliance_rad_per_n_m       end in a unit
//! gear_ratio   jacobian   fraction_within_limit             known to have none
//! depth   force_per_mm                                      violations
//! ```
//!
//! Looked at are fields of floating-point numbers of the types that cross a boundary (`boundary_fields`), in
//! the crates whose types users see. Not checked: that the number is in the unit of its name.

use super::Rule;
use super::boundary_fields::{Field, boundary_fields};
use super::rust::{RustFile, find_word};
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "units in names",
    reason: "a length in m read as mm scraps a part; a name with its unit cannot be misread",
    check,
};

/// The crates whose types users see.
const BOUNDARY_FOLDERS: &[&str] = &["crates/formats/src/", "crates/study/src/", "crates/cli/src/"];

/// Last words of a name that are a unit. Compound units end in one of them: `_n_m`, `_rad_per_n_m`, `_mm_deg`
/// (a six-vector: three lengths, three angles).
pub const UNITS: &[&str] = &[
    "um", "mm", "m", "mm2", "mm3", "m2", // lengths, areas, volumes
    "deg", "rad", "urad", "rad2", "rpm", "hz", // angles, turning
    "n", "n2", "kg", // forces, torques, masses
    "s", "gpa", "percent", "k", // times, stresses, shares of a hundred, temperature differences
];

/// Last words that are a unit only after `per`: alone, `min` is the smallest, `tooth` a thing.
pub const UNITS_AFTER_PER: &[&str] = &["min", "tooth", "m3"];

/// Names of numbers without unit, and of the SI matrices.
const NO_UNIT: &[&str] = &[
    "jacobian",         // SI: m and rad per rad, the exception that the architecture names
    "compliance",       // SI: m and rad per N and N m, without a suffix
    "quaternion_wxyz",  // of length one; the name says the order
    "axis",             // a direction of length one
    "direction",        // unit vector
    "normal",           // unit vector
    "sign",             // +1 or -1
    "ratio",            // a value over another of the same unit
    "factor",           // a pure multiplier
    "fraction",         // 0 to 1
    "share",            // 0 to 1, of a whole that the type names
    "exponent",         // of a power law
    "coverage",         // a multiplier of a standard uncertainty
    "confidence",       // a probability
    "probability",      // 0 to 1
    "condition_number", // largest over smallest singular value
    "manipulability",   // a determinant; compared, never read as a length
];

/// Last words that mark a number without unit: `gear_ratio`, `spindle_axis`.
const NO_UNIT_ENDINGS: &[&str] = &[
    "ratio",
    "factor",
    "fraction",
    "share",
    "exponent",
    "axis",
    "direction",
    "normal",
    "sign",
    "wxyz",
];

/// First words that mark a number without unit: `fraction_within_limit`.
const NO_UNIT_BEGINNINGS: &[&str] = &["fraction_", "share_", "ratio_", "probability_"];

/// A comment that says the unit where a name cannot: `// unit: as the column it describes`.
const EXEMPTION: &str = "// unit:";

/// Looks at every floating-point field, also inside options, lists, arrays and maps.
fn check(tree: &Tree) -> Vec<Violation> {
    let files = BOUNDARY_FOLDERS.iter().flat_map(|folder| tree.rust_files(folder));
    files.flat_map(check_file).collect()
}

/// The fields of one file that do not say their unit.
fn check_file(file: &RustFile) -> Vec<Violation> {
    let fields = boundary_fields(file).into_iter();
    let unclear = fields.filter(|field| has_numbers(field) && !says_its_unit(&field.name));
    unclear
        .filter(|field| !is_exempt(file, field.line))
        .map(|field| {
            let what = format!("`{}: {}` does not say its unit", field.name, field.of_type);
            let hint = "end the name in one (_mm, _deg, _n_m, _rad_per_n_m), or write `// unit: ...` above";
            Violation::new(&file.path, field.line, what, hint)
        })
        .collect()
}

/// Whether its type has a floating-point number anywhere in it.
fn has_numbers(field: &Field) -> bool {
    find_word(&field.of_type, "f64").is_some() || find_word(&field.of_type, "f32").is_some()
}

/// Whether `name` ends in a unit or is known to have none.
fn says_its_unit(name: &str) -> bool {
    if NO_UNIT.contains(&name)
        || NO_UNIT_BEGINNINGS
            .iter()
            .any(|beginning| name.starts_with(beginning))
    {
        return true;
    }
    let words: Vec<&str> = name.split('_').collect();
    match words.as_slice() {
        [.., unit, "per", last] if UNITS_AFTER_PER.contains(last) => UNITS.contains(unit),
        // `force_per_mm` does not say force in what; an expansion is relative.
        [.., unit, "per", last] if UNITS.contains(last) => {
            UNITS.contains(unit) || *unit == "one" || *unit == "expansion"
        }
        [.., last] => UNITS.contains(last) || (words.len() > 1 && NO_UNIT_ENDINGS.contains(last)),
        [] => false,
    }
}

/// Whether the line, or the comments and attributes right above it, say the unit in words.
pub(super) fn is_exempt(file: &RustFile, line: usize) -> bool {
    let lines = &file.lines[..line.min(file.lines.len())];
    let Some((own, above)) = lines.split_last() else {
        return false;
    };
    let comments = above.iter().rev().map(|line| line.trim());
    let mut comments = comments.take_while(|line| line.starts_with("//") || line.starts_with("#["));
    own.contains(EXEMPTION) || comments.any(|line| line.contains(EXEMPTION))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(fields: &str) -> Vec<usize> {
        let text = format!("#[derive(Deserialize)]\nstruct A {{\n{fields}}}\n");
        check(&Tree::of(&[("crates/study/src/a.rs", &text)]))
            .iter()
            .map(|violation| violation.line)
            .collect()
    }

    #[test]
    fn numbers_without_unit_are_reported() {
        assert_eq!(
            lines("depth: f64,\nreach: Option<f64>,\nwrench: [[f64; 6]; 2],\nname: String,\n"),
            [3, 4, 5]
        );
    }

    #[test]
    fn units_and_known_numbers_without_unit_pass() {
        for name in [
            "depth_mm",
            "feed_mm_per_min",
            "torque_n_m",
            "stiffness_n_m_per_rad",
            "compliance_rad_per_n_m",
            "error_um",
            "pose_mm_deg",
            "spindle_rpm",
            "kc_n_per_mm2",
            "feed_mm_per_tooth",
            "fraction_within",
            "gear_ratio",
            "jacobian",
            "spindle_axis",
            "mm",
        ] {
            assert!(says_its_unit(name), "{name}");
        }
    }

    #[test]
    fn words_that_only_look_like_units_are_reported() {
        for name in [
            "angle_min",
            "force_per_mm",
            "length_per_tooth",
            "teeth",
            "comm",
            "wrench",
        ] {
            assert!(!says_its_unit(name), "{name}");
        }
    }

    #[test]
    fn accepts_the_unit_in_a_comment() {
        assert_eq!(
            lines("a: f64, // unit: as the column\n/// Doc.\n// unit: SI\n#[serde(default)]\nb: f64,\n"),
            []
        );
        assert_eq!(lines("// unit: SI\na: f64,\nb: f64,\n"), [5]);
    }

    #[test]
    fn the_core_has_no_boundary() {
        let text = "#[derive(Deserialize)]\nstruct A {\n    depth: f64,\n}\n";
        assert!(check(&Tree::of(&[("crates/core/src/a.rs", text)])).is_empty());
    }
}
