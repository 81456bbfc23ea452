//! Tables in HTML, for notebooks.

use crate::robot::Robot;

/// The joints of a robot.
pub(crate) fn robot(robot: &Robot) -> String {
    let arm = robot.arm();
    let rows = arm.joints().iter().enumerate().map(|(index, joint)| {
        let [lower, upper] = match joint.limits {
            Some(limits) => [limits.lower, limits.upper].map(|limit| format!("{limit:.4}")),
            None => [String::new(), String::new()],
        };
        let compliance = arm.compliance().and_then(|all| all.get(index));
        let compliance = compliance.map_or_else(String::new, |joint| format!("{:.4e}", joint.value));
        vec![joint.name.clone(), lower, upper, compliance]
    });
    let header = [
        "joint",
        "lower limit, rad (m)",
        "upper limit, rad (m)",
        "compliance, rad/(N m) (m/N)",
    ];
    let title = format!("{} ({})", robot.description.title, arm.name());
    table(&title, &header, rows)
}

/// A table with a caption and a header; texts are escaped.
pub(crate) fn table(
    caption: &str,
    header: &[impl AsRef<str>],
    rows: impl IntoIterator<Item = Vec<String>>,
) -> String {
    let cells = |tag: &str, texts: &mut dyn Iterator<Item = &str>| -> String {
        texts
            .map(|text| format!("<{tag}>{}</{tag}>", escaped(text)))
            .collect()
    };
    let header = cells("th", &mut header.iter().map(AsRef::as_ref));
    let rows: String = rows
        .into_iter()
        .map(|row| format!("<tr>{}</tr>", cells("td", &mut row.iter().map(String::as_str))))
        .collect();
    format!(
        "<table><caption>{}</caption><thead><tr>{header}</tr></thead><tbody>{rows}</tbody></table>",
        escaped(caption)
    )
}

/// A text without characters that HTML interprets.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
