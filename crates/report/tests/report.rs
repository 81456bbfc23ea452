//! The HTML report: complete, escaped, and alone.

use armill_report::html::{Align, Column, Input, Report, Table};

fn report() -> Report {
    let column = |name: &str, unit: &str, align| Column {
        name: name.into(),
        unit: unit.into(),
        align,
    };
    let table = Table {
        caption: "<caption>".into(),
        columns: vec![column("a & b", "mm", Align::Left), column("n", "", Align::Number)],
        rows: vec![
            vec!["<td>".into()],
            vec!["1".into(), "2".into(), "too many".into()],
        ],
    };
    let input = Input {
        name: "k <2>".into(),
        value: "3".into(),
        unit: "µm".into(),
        source: "paper & page".into(),
    };
    Report::new("T <script>")
        .question("q \"?\"")
        .answer("a < b")
        .warning("w & w")
        .section("s <h2>")
        .paragraph("p > p")
        .list(&["l & l".into()])
        .table(&table)
        .picture("<svg xmlns=\"http://www.w3.org/2000/svg\"/>", "c & d")
        .inputs([input])
}

#[test]
fn every_text_is_escaped() {
    let html = report().to_html();
    for raw in [
        "<script>",
        "a < b",
        "w & w",
        "s <h2>",
        "p > p",
        "l & l",
        "<2>",
        "c & d",
        "<td><td>",
        "paper & page",
    ] {
        assert!(!html.contains(raw), "{raw}");
    }
    assert!(html.contains("T &lt;script&gt;") && html.contains("a &amp; b"));
}

#[test]
fn nothing_is_loaded_from_elsewhere() {
    let html = report().to_html().replace("http://www.w3.org/2000/svg", "");
    for outside in ["http:", "https:", "src=", "href=", "@import", "<script", "url("] {
        assert!(!html.contains(outside), "{outside}");
    }
}

#[test]
fn rows_have_as_many_cells_as_there_are_columns() {
    let html = report().to_html();
    assert!(!html.contains("too many"));
    assert!(html.contains("<td>&lt;td&gt;</td><td class=\"n\"></td>"));
}

#[test]
fn figures_and_tables_are_numbered() {
    let html = report().picture("<svg/>", "second").to_html();
    assert!(html.contains("<b>Figure 2.</b> second") && html.contains("<b>Table 1.</b>"));
}

#[test]
fn a_long_report_lists_its_sections_and_figures_and_a_short_one_does_not() {
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>";
    let with = |figures: usize| {
        let report = Report::new("r")
            .section("Planes & paths")
            .paragraph("none")
            .section("Pictures");
        let caption =
            "Fig. 6, elbow down: where the deviation is <largest> of all that were requested in the study.";
        (0..figures)
            .fold(report, |report, _| report.picture(svg, caption))
            .to_html()
    };
    assert!(!with(7).contains("class=\"contents\""));
    let long = with(8);
    assert!(
        long.contains("<a href=\"#s1\">Planes &amp; paths</a>")
            && long.contains("<summary>8 figures</summary>")
    );
    for number in 1..=8 {
        assert!(long.contains(&format!("<figure id=\"f{number}\">")), "{number}");
        let line = format!(
            "<a href=\"#f{number}\">{number}. Fig. 6, elbow down: where the deviation is &lt;largest&gt; …</a>"
        );
        assert!(long.contains(&line), "{line} in {long}");
    }
}

#[test]
fn text_of_the_terminal_is_shown_with_code_and_signs() {
    let html = Report::new("r")
        .warning("use `armill place` <now>: 3 +- 1 um")
        .paragraph("an odd ` stays")
        .to_html();
    assert!(
        html.contains("use <code>armill place</code> &lt;now&gt;: 3 ± 1 um"),
        "{html}"
    );
    assert!(html.contains("<p>an odd ` stays</p>"));
}
