//! How numbers, names and comments of exported files are spelled.

use armill_core::frame::{Isometry, fixed_angles};
use armill_core::nalgebra::Vector3;

/// Adds a line; writing to a text cannot fail.
pub(super) fn line(text: &mut String, content: &str) {
    text.push_str(content);
    text.push('\n');
}

/// Adds a comment of YAML or CSV, on one line.
pub(super) fn comment_line(text: &mut String, content: &str) {
    line(text, &format!("# {}", on_one_line(content)));
}

/// A text with blanks in place of line ends and other control characters.
pub(super) fn on_one_line(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

/// A length, an angle or a part of a unit vector: within 1e-15 (m, rad).
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.15}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" | "" => "0".to_owned(),
        text => text.to_owned(),
    }
}

/// A number of any size, with all its digits.
pub(super) fn exact(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if value.abs() >= 1e-4 && value.abs() < 1e15 => {
            let text = format!("{value:?}");
            text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
        }
        value => format!("{value:e}"),
    }
}

/// Three numbers with blanks between them.
pub(super) fn vector(v: &Vector3<f64>) -> String {
    [v.x, v.y, v.z].map(number).join(" ")
}

/// Position, and turns about the fixed axes x, y, z.
pub(super) fn xyz_rpy(pose: &Isometry) -> [String; 2] {
    [
        vector(&pose.translation.vector),
        vector(&fixed_angles(&pose.rotation)),
    ]
}

/// Position, and unit quaternion with w first or last.
pub(super) fn xyz_and_quaternion(pose: &Isometry, w_first: bool) -> [String; 2] {
    let q = pose.rotation;
    let parts = match w_first {
        true => [q.w, q.i, q.j, q.k],
        false => [q.i, q.j, q.k, q.w],
    };
    [vector(&pose.translation.vector), parts.map(number).join(" ")]
}

/// A text as the value of an XML attribute.
pub(super) fn attribute(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// A text inside an XML comment, on one line.
pub(super) fn comment(text: &str) -> String {
    // Two hyphens end a comment.
    let text = on_one_line(text).replace("--", "- -");
    match text.ends_with('-') {
        true => text + " ",
        false => text,
    }
}

/// An XML comment on the origin of a file, a line each.
pub(super) fn head(lines: &[String]) -> String {
    let mut text = String::from("<!--\n");
    for content in lines {
        line(&mut text, &format!("  {}", comment(content)));
    }
    text.push_str("-->\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_within_1e_15() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1e-17, "0"),
            (-3e-16, "0"),
            (0.1 + 0.2, "0.3"),
            (-1.0, "-1"),
            (120.0, "120"),
            (1.0 / 3.0, "0.333333333333333"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn exact_numbers_come_back() {
        for value in [0.0, 1e-9, -2.1e-6, 1.0 / 3.0, 120.0, 476_190.476_190_476_2, 1e300] {
            assert_eq!(exact(value).parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
        assert_eq!(exact(120.0), "120");
    }

    #[test]
    fn comments_and_attributes_cannot_be_left() {
        assert_eq!(comment("a --> b\n--"), "a - -> b - - ");
        assert_eq!(attribute("a\"<b>&\n"), "a&quot;&lt;b&gt;&amp; ");
    }
}
