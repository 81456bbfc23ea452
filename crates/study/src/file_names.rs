//! Names of result files, made from the names of analyses.

/// Suffixes of the names of pictures of an analysis.
const PICTURES: [&str; 17] = [
    "budget",
    "measured",
    "waves",
    "holes",
    "cells",
    "turns",
    "region",
    "shares",
    "ellipse",
    "arm",
    "vectors",
    "along",
    "polar",
    "track",
    "process",
    "forces",
    "clearance",
];

/// Whether files called `slug` could be pictures of the analysis called `analysis`.
pub fn is_picture_of(slug: &str, analysis: &str) -> bool {
    slug.strip_prefix(analysis)
        .and_then(|rest| rest.strip_prefix('-'))
        .is_some_and(|rest| PICTURES.contains(&rest))
}

/// A part of a file name that is valid on every system: letters (of any script), digits and hyphens.
///
/// Different names may give the same; a name without letters and digits gives nothing.
pub fn slug(name: &str) -> String {
    let mut slug = String::new();
    for c in name.chars() {
        if c.is_alphanumeric() {
            slug.extend(c.to_lowercase());
        } else if !slug.ends_with('-') {
            slug.push('-');
        }
    }
    slug.trim_matches('-').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slugs_are_plain_and_keep_different_names_apart() {
        assert_eq!(slug("Table 4: x = 600 mm"), "table-4-x-600-mm");
        assert_eq!(slug("--Ä--"), "ä");
        assert_ne!(slug("größe"), slug("grüße"));
        assert_eq!(slug("../?"), "");
    }
}
