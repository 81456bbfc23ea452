//! A report as one HTML file: question, answer, pictures, tables, warnings and the sources of the inputs; nothing is
//! loaded from elsewhere.
//!
//! Order of the page, each part but the title left out where it is empty:
//!
//! ```text
//! title · question · answer · warnings · contents · sections, paragraphs, lists, figures, tables · inputs and their sources
//! ```
//!
//! Figures and tables are numbered in the order of adding, apart from each other; the table of inputs has no
//! number. All words are escaped; pictures are included unchanged, as SVG inside the page. Colours follow the
//! reader's light or dark setting.

use crate::svg::escape;

/// The style sheet, written into each report.
const STYLE: &str = include_str!("report.css");

/// Alignment of the cells of a column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Words: to the left.
    #[default]
    Left,
    /// Numbers: to the right, digits below digits.
    Number,
}

/// One column of a table: its head reads `name (unit)`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Column {
    /// What is in it.
    pub name: String,
    /// Its unit; empty for a column of words or pure numbers.
    pub unit: String,
    /// Alignment of its cells.
    pub align: Align,
}

/// A table. A row shorter than the columns is filled with empty cells, a longer one is cut.
///
/// Not checked: that numbers have the required decimals; cells are shown unchanged.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// What the table shows.
    pub caption: String,
    /// The columns.
    pub columns: Vec<Column>,
    /// The cells, row by row from the top, as they are to be read.
    pub rows: Vec<Vec<String>>,
}

/// One number that went into the result.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Input {
    /// What it is: `compliance of joint 2`.
    pub name: String,
    /// Its value as it was read.
    pub value: String,
    /// Its unit.
    pub unit: String,
    /// Where it comes from: paper, page; data sheet; measurement.
    pub source: String,
}

/// A report being written; what is added appears in the order of adding.
///
/// Each method takes the report and gives it back, so that a report reads as a chain that ends in `to_html`.
///
/// ```
/// use armill_report::html::Report;
///
/// let html = Report::new("Groove")
///     .question("Is the groove within 50 µm?")
///     .answer("Yes, by 12 µm.")
///     .section("How it was computed")
///     .paragraph("From the compliances of the joints.")
///     .to_html();
/// assert!(html.starts_with("<!doctype html>"));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Report {
    title: String,
    question: String,
    answer: String,
    warnings: Vec<String>,
    inputs: Vec<Input>,
    body: String,
    /// Heading of each section, with the captions of its figures.
    sections: Vec<(String, Vec<String>)>,
    figures: usize,
    tables: usize,
}

impl Report {
    /// An empty report with its title, which is also the name of the page.
    pub fn new(title: &str) -> Self {
        Self {
            title: title.to_owned(),
            ..Self::default()
        }
    }

    /// The question that the report answers; a second one replaces the first.
    #[must_use]
    pub fn question(mut self, text: &str) -> Self {
        text.clone_into(&mut self.question);
        self
    }

    /// The answer in one sentence; a second one replaces the first.
    #[must_use]
    pub fn answer(mut self, text: &str) -> Self {
        text.clone_into(&mut self.answer);
        self
    }

    /// Something the reader must know before using the answer; it is above everything but question and
    /// answer.
    #[must_use]
    pub fn warning(mut self, text: &str) -> Self {
        self.warnings.push(text.to_owned());
        self
    }

    /// Numbers that went in, listed with their sources at the end.
    #[must_use]
    pub fn inputs(mut self, inputs: impl IntoIterator<Item = Input>) -> Self {
        self.inputs.extend(inputs);
        self
    }

    /// A heading; what follows belongs to it.
    #[must_use]
    pub fn section(mut self, heading: &str) -> Self {
        self.sections.push((heading.to_owned(), Vec::new()));
        let number = self.sections.len();
        self.body
            .push_str(&format!("<h2 id=\"s{number}\">{}</h2>\n", escape(heading)));
        self
    }

    /// A paragraph of plain text; what is between backticks is code.
    #[must_use]
    pub fn paragraph(mut self, text: &str) -> Self {
        self.body.push_str(&format!("<p>{}</p>\n", prose(text)));
        self
    }

    /// A list, one item a line; nothing where there are no items.
    #[must_use]
    pub fn list(mut self, items: &[String]) -> Self {
        if !items.is_empty() {
            self.body.push_str(&list_html(items));
        }
        self
    }

    /// A picture of this crate with its caption. Not checked: that `svg` is one of ours; it is put in unchanged.
    #[must_use]
    pub fn picture(mut self, svg: &str, caption: &str) -> Self {
        self.figures += 1;
        if let Some((_, captions)) = self.sections.last_mut() {
            captions.push(format!(
                "<a href=\"#f{0}\">{0}. {1}</a>",
                self.figures,
                escape(&short(caption))
            ));
        }
        self.body.push_str(&format!(
            "<figure id=\"f{1}\">\n<div class=\"card\">{0}</div>\n<figcaption><b>Figure {1}.</b> {2}</figcaption>\n</figure>\n",
            svg.trim(),
            self.figures,
            prose(caption)
        ));
        self
    }

    /// A table with its number before its caption.
    #[must_use]
    pub fn table(mut self, table: &Table) -> Self {
        self.tables += 1;
        let number = self.tables;
        self.body
            .push_str(&table_html(table, &format!("<b>Table {number}.</b> ")));
        self
    }

    /// Where what is, of a report that takes more than a look to find it.
    fn contents(&self) -> String {
        if self.figures < MANY_FIGURES {
            return String::new();
        }
        let sections = self.sections.iter().enumerate().map(|(k, (heading, captions))| {
            let figures: String = captions.iter().map(|link| format!("<li>{link}</li>")).collect();
            let inner = match captions.len() {
                0 => String::new(),
                count => {
                    let noun = if count == 1 { "figure" } else { "figures" };
                    format!("<details><summary>{count} {noun}</summary><ul>{figures}</ul></details>")
                }
            };
            format!(
                "<li><a href=\"#s{}\">{}</a>{inner}</li>\n",
                k + 1,
                escape(heading)
            )
        });
        format!("<ul class=\"contents\">\n{}</ul>\n", sections.collect::<String>())
    }

    /// The report as a complete HTML document in one string, without anything to load: no script, font, picture
    /// or style from elsewhere.
    pub fn to_html(&self) -> String {
        let title = escape(&self.title);
        let mut main = format!("<h1>{title}</h1>\n");
        if !self.question.is_empty() {
            main.push_str(&format!("<p class=\"question\">{}</p>\n", prose(&self.question)));
        }
        if !self.answer.is_empty() {
            main.push_str(&format!("<p class=\"answer\">{}</p>\n", prose(&self.answer)));
        }
        if !self.warnings.is_empty() {
            let items = list_html(&self.warnings);
            main.push_str(&format!(
                "<aside class=\"warnings\" role=\"note\">\n<b>Warnings</b>\n{items}</aside>\n"
            ));
        }
        main.push_str(&self.contents());
        main.push_str(&self.body);
        if !self.inputs.is_empty() {
            main.push_str("<h2>Inputs and their sources</h2>\n");
            main.push_str(&table_html(&inputs_table(&self.inputs), ""));
        }
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n{main}</main>\n</body>\n</html>\n"
        )
    }
}

/// As much of a caption as fits a line of the contents.
fn short(caption: &str) -> String {
    let mut line = String::new();
    for word in caption.trim_end_matches('.').split_whitespace() {
        if line.chars().count() + word.chars().count() > LINE {
            return line.trim_end_matches([',', ':', ';']).to_owned() + " …";
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    line
}

/// Characters of a caption in the contents.
const LINE: usize = 52;

/// Text of the terminal as a page shows it: escaped, code between backticks, and a sign for `+-`.
fn prose(text: &str) -> String {
    let text = escape(text).replace("+-", "±");
    let parts: Vec<&str> = text.split('`').collect();
    if parts.len().is_multiple_of(2) {
        return text;
    }
    let shown = parts.iter().enumerate().map(|(k, part)| match k % 2 {
        0 => (*part).to_owned(),
        _ => format!("<code>{part}</code>"),
    });
    shown.collect()
}

/// Figures from which on a report has a list of what is in it.
const MANY_FIGURES: usize = 8;

/// Items as an unordered list, escaped.
fn list_html(items: &[String]) -> String {
    let items = items.iter().map(|item| format!("<li>{}</li>\n", prose(item)));
    format!("<ul>\n{}</ul>\n", items.collect::<String>())
}

/// Inputs as a table of four columns, the value to the right.
fn inputs_table(inputs: &[Input]) -> Table {
    let column = |name: &str, align| Column {
        name: name.to_owned(),
        unit: String::new(),
        align,
    };
    Table {
        caption: String::new(),
        columns: vec![
            column("input", Align::Left),
            column("value", Align::Number),
            column("unit", Align::Left),
            column("source", Align::Left),
        ],
        rows: inputs
            .iter()
            .map(|i| vec![i.name.clone(), i.value.clone(), i.unit.clone(), i.source.clone()])
            .collect(),
    }
}

/// A table that scrolls sideways where the page is too narrow. `number` is HTML before the caption,
/// not escaped; without number and caption there is no caption.
fn table_html(table: &Table, number: &str) -> String {
    let class = |align| {
        if align == Align::Number {
            " class=\"n\""
        } else {
            ""
        }
    };
    let mut out = String::from("<div class=\"scroll\">\n<table>\n");
    if !(table.caption.is_empty() && number.is_empty()) {
        out.push_str(&format!(
            "<caption><span>{number}{}</span></caption>\n",
            escape(&table.caption)
        ));
    }
    out.push_str("<thead><tr>");
    for c in &table.columns {
        let unit = if c.unit.is_empty() {
            String::new()
        } else {
            format!(" <span class=\"unit\">({})</span>", escape(&c.unit))
        };
        out.push_str(&format!(
            "<th scope=\"col\"{}>{}{unit}</th>",
            class(c.align),
            escape(&c.name)
        ));
    }
    out.push_str("</tr></thead>\n<tbody>\n");
    for row in &table.rows {
        out.push_str("<tr>");
        for (k, c) in table.columns.iter().enumerate() {
            let cell = row.get(k).map_or("", String::as_str);
            out.push_str(&format!("<td{}>{}</td>", class(c.align), escape(cell)));
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody>\n</table>\n</div>\n");
    out
}
