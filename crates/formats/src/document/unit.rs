//! The unit a field's name ends with, and the name a misspelled field was meant to be.
//!
//! ```text
//! step_mm                step        mm
//! feed_mm_per_min        feed        mm/min
//! compliance_rad_per_n_m compliance  rad/(N m)
//! per_mm, mm             -           no unit: no name would be left
//! ```
//!
//! Suffixes and their meaning: `docs/notation.md`.

/// What the name of a pose ends with: three lengths and three angles.
const POSE_SUFFIX: &str = "mm_deg";
/// Its units together.
const POSE: &str = "mm and deg";
/// How many of its numbers are lengths.
const POSE_LENGTHS: usize = 3;

/// A unit as names carry it and as people read it.
///
/// | name ends with | shown | kind of quantity |
/// |---|---|---|
/// | `_mm` | mm | lengths |
/// | `_n_m` | N m | torques |
/// | `_rad_per_n_m` | rad/(N m) | |
///
/// The first that fits counts, so units of several words come first.
const ATOMS: &[(&str, &str, Option<&str>)] = &[
    (POSE_SUFFIX, POSE, None),
    ("per_k", "1/K", None),
    ("kg_m2", "kg m^2", Some("inertias")),
    ("n_m_s", "N m s", None),
    ("n_s", "N s", None),
    ("n_m", "N m", Some("torques")),
    ("m", "m", Some("lengths")),
    ("mm", "mm", Some("lengths")),
    ("um", "um", Some("lengths")),
    ("mm2", "mm^2", Some("areas")),
    ("mm3", "mm^3", Some("volumes")),
    ("m2", "m^2", Some("areas")),
    ("m3", "m^3", Some("volumes")),
    ("deg", "deg", Some("angles")),
    ("rad", "rad", Some("angles")),
    ("n", "N", Some("forces")),
    ("kn", "kN", Some("forces")),
    ("kg", "kg", Some("masses")),
    ("kgm2", "kg m^2", Some("inertias")),
    ("s", "s", Some("times")),
    ("ms", "ms", Some("times")),
    ("min", "min", Some("times")),
    ("rpm", "rpm", Some("speeds")),
    ("hz", "Hz", Some("frequencies")),
    ("kw", "kW", Some("powers")),
    ("pa", "Pa", None),
    ("mpa", "MPa", None),
    ("gpa", "GPa", None),
    ("k", "K", Some("temperature differences")),
    ("percent", "%", Some("shares")),
    ("tooth", "tooth", None),
    ("rev", "rev", None),
];

/// A unit with the name it was cut from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Unit {
    /// As people read it: `mm/min`.
    pub(super) shown: String,
    /// What it measures, in the plural, if there is one word for it.
    pub(super) quantity: Option<&'static str>,
}

/// A field's name without its unit, and the unit; `None` if the name ends with no unit.
///
/// A quotient has as its lower part the last unit, as its upper one what precedes `_per`, which may be a quotient
/// itself; a name that ends in `_per_mm` without a unit before it has none.
pub(super) fn split(name: &str) -> Option<(&str, Unit)> {
    let cut = |suffix: &str| name.strip_suffix(suffix)?.strip_suffix('_');
    let (before, shown, quantity) = ATOMS
        .iter()
        .find_map(|(suffix, shown, quantity)| Some((cut(suffix)?, shown, quantity)))?;
    if let Some((above, top)) = before.strip_suffix("_per").and_then(split) {
        let below = if shown.contains(' ') {
            format!("({shown})")
        } else {
            (*shown).to_owned()
        };
        return Some((
            above,
            Unit {
                shown: format!("{}/{below}", top.shown),
                quantity: None,
            },
        ));
    }
    let whole = !before.is_empty() && before != "per" && !before.ends_with("_per");
    whole.then(|| {
        (
            before,
            Unit {
                shown: (*shown).to_owned(),
                quantity: *quantity,
            },
        )
    })
}

/// The unit of the value at `path` in a field of this name, as people read it: of a number of a pose its own.
pub(super) fn of_value(field: &str, path: &str) -> Option<String> {
    let unit = match split(field) {
        Some((_, unit)) => unit,
        // A name that is a quotient of units alone, such as `rad_per_n_m`.
        None if field.contains("_per_") => split(&format!("value_{field}"))?.1,
        None => return None,
    };
    let index = path.strip_suffix(']').and_then(|path| path.rsplit_once('['));
    let index = index.and_then(|(_, index)| index.parse::<usize>().ok());
    Some(match index {
        Some(index) if unit.shown == POSE => {
            let is_length = index < POSE_LENGTHS;
            if is_length { "mm" } else { "deg" }.to_owned()
        }
        _ => unit.shown,
    })
}

/// Fields and choices of earlier versions, and their present names.
const RENAMED: &[(&str, &str)] = &[
    ("ask", "analysis"),
    ("backlash_flank", "backlash_side"),
    ("limit_um", "tolerance_um"),
    ("actual_robot", "calibrated_robot"),
    ("counts", "component"),
    ("goal", "objective"),
    ("sure", "rank_by"),
    ("above-limit", "above-tolerance"),
    ("within-limit", "within-tolerance"),
    ("greatest", "peak"),
    ("value", "peak"),
    ("start", "threshold"),
    ("u_length_mm", "length_u_mm"),
    ("feed_mm_min", "feed_mm_per_min"),
    ("rapid_mm_min", "rapid_mm_per_min"),
    ("program", "path"),
];

/// The present name of a field or choice that was renamed, and the advice; `None` if the table has no such name.
pub(super) fn renamed<'a>(old: &str, mut known: impl Iterator<Item = &'a str>) -> Option<(&'a str, String)> {
    let (_, new) = RENAMED.iter().find(|(former, _)| *former == old)?;
    let name = known.find(|name| name == new)?;
    Some((name, format!("`{old}` was renamed: write `{name}`")))
}

/// What to write instead of an unknown field, if one of the known ones comes close: its name and the advice.
///
/// First the same quantity, given without its unit (`step` for `step_mm`) or in another (`step_m`); then a typing
/// error (`stepp_mm`): one change for every three letters of the known name, and one at least. Capitals are ignored,
/// and a hyphen equals `_`.
pub(crate) fn suggestion<'a>(unknown: &str, known: &[&'a str]) -> Option<(&'a str, String)> {
    let plain = |name: &str| name.to_lowercase().replace('-', "_");
    let requested = plain(unknown);
    if let Some(inverse) = inverse_of_stiffness(&requested, known) {
        return Some(inverse);
    }
    let base = split(&requested).map_or(requested.as_str(), |(base, _)| base);
    for name in known {
        let Some((known_base, unit)) = split(name) else {
            continue;
        };
        if known_base == requested {
            let rule = match unit.quantity {
                Some(quantity) => format!("{quantity} carry their unit"),
                None => "numbers carry their unit".to_owned(),
            };
            return Some((name, format!("{rule}: write `{name}`")));
        }
        if known_base == base && *name != requested {
            return Some((name, format!("give the value in {}: write `{name}`", unit.shown)));
        }
    }
    // One slip in a short name, a third of a long one.
    let allowed = |name: &str| (name.chars().count() / 3).max(1);
    known
        .iter()
        .map(|name| (strsim::damerau_levenshtein(&requested, &plain(name)), *name))
        .filter(|(distance, name)| *distance <= allowed(name))
        .min()
        .map(|(_, name)| (name, format!("did you mean `{name}`?")))
}

/// Units of stiffness, each with that of the compliance.
const INVERSE: [(&str, &str); 2] = [("n_m_per_rad", "rad_per_n_m"), ("n_per_um", "um_per_n")];

/// The compliance to write for an unknown field that is a stiffness, and the advice.
fn inverse_of_stiffness<'a>(requested: &str, known: &[&'a str]) -> Option<(&'a str, String)> {
    let (_, compliance) = INVERSE
        .iter()
        .find(|(stiffness, _)| requested.ends_with(stiffness))?;
    let is_it = |name: &&&str| name.ends_with(compliance) && !name.starts_with("u_") && !name.contains("_u_");
    let name = known.iter().find(is_it)?;
    Some((
        name,
        format!("a compliance is 1/stiffness: write `{name}` with 1/k for each stiffness k"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stiffness_is_given_as_its_inverse() {
        let known = ["u_rad_per_n_m", "rad_per_n_m", "class"];
        let advice = suggestion("stiffness_n_m_per_rad", &known).unwrap();
        assert_eq!(advice.0, "rad_per_n_m");
        assert!(advice.1.contains("1/k"), "{}", advice.1);
        // A field that exists is no inverse of another.
        assert_eq!(suggestion("stiffness_n_per_um", &["class"]), None);
    }

    fn shown(name: &str) -> Option<(&str, String)> {
        split(name).map(|(base, unit)| (base, unit.shown))
    }

    #[test]
    fn a_number_of_a_pose_has_the_unit_of_its_place() {
        let unit = |path: &str| of_value("flange_from_tool_mm_deg", path).unwrap();
        let place = |index: usize| unit(&format!("analysis[4].tool.flange_from_tool_mm_deg[{index}]"));
        assert_eq!([0, 2, 3, 5].map(place), ["mm", "mm", "deg", "deg"]);
        assert_eq!(unit("analysis[4].tool.flange_from_tool_mm_deg"), "mm and deg");
        assert_eq!(of_value("x_mm", "analysis[4].x_mm[5]").unwrap(), "mm");
    }

    #[test]
    fn a_name_ends_with_its_unit() {
        assert_eq!(shown("step_mm"), Some(("step", "mm".to_owned())));
        assert_eq!(shown("feed_mm_per_min"), Some(("feed", "mm/min".to_owned())));
        assert_eq!(
            shown("compliance_rad_per_n_m"),
            Some(("compliance", "rad/(N m)".to_owned()))
        );
        assert_eq!(shown("blend_radius_m"), Some(("blend_radius", "m".to_owned())));
    }

    #[test]
    fn a_name_that_is_only_a_unit_has_none() {
        for name in ["mm", "_mm", "per_mm", "_per_mm", "n", "steps_per_mm", "name", ""] {
            assert_eq!(shown(name), None, "{name}");
        }
    }

    #[test]
    fn a_field_without_its_unit_is_reported_to_carry_it() {
        let known = ["step_mm", "tilt_deg", "stiffness_n_per_um"];
        assert_eq!(
            suggestion("step", &known).unwrap().1,
            "lengths carry their unit: write `step_mm`"
        );
        assert_eq!(
            suggestion("tilt", &known).unwrap().1,
            "angles carry their unit: write `tilt_deg`"
        );
        assert_eq!(
            suggestion("stiffness", &known).unwrap().1,
            "numbers carry their unit: write `stiffness_n_per_um`"
        );
    }

    #[test]
    fn a_field_in_another_unit_is_not_just_renamed() {
        let advice = suggestion("step_m", &["step_mm"]).unwrap().1;
        assert_eq!(advice, "give the value in mm: write `step_mm`");
    }

    #[test]
    fn a_typing_error_is_recognised_and_a_different_word_is_not() {
        assert_eq!(
            suggestion("toleranec", &["tool", "tolerance"]).unwrap().0,
            "tolerance"
        );
        assert_eq!(suggestion("Tool", &["tool", "tolerance"]).unwrap().0, "tool");
        assert_eq!(suggestion("banana", &["tool", "tolerance"]), None);
        assert_eq!(suggestion("x", &[]), None);
    }
}
