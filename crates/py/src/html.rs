//! Tables in HTML, for notebooks.

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
