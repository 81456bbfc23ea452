//! Every picture of the crate from made-up data, as SVG and PNG, and one report with all of them.
//!
//! `cargo run -p armill-report --example gallery -- FOLDER` writes into FOLDER (`gallery` where none is given).

mod arms;
mod budget;
mod corner;
mod fields;
mod frf;
mod part;
mod paths;
mod torsion;

use std::error::Error;
use std::path::{Path, PathBuf};

use armill_report::html::{Align, Column, Input, Report, Table};
use armill_report::raster::png;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args()
        .nth(1)
        .map_or_else(|| PathBuf::from("gallery"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let pictures: Vec<(&str, String)> = fields::pictures()
        .into_iter()
        .chain(paths::pictures())
        .chain(frf::pictures())
        .chain(corner::pictures())
        .chain(budget::pictures())
        .chain(arms::pictures())
        .chain(torsion::pictures())
        .chain(part::pictures())
        .collect();
    for (name, svg) in &pictures {
        write(&folder, &format!("{name}.svg"), svg.as_bytes())?;
        write(&folder, &format!("{name}.png"), &png(svg, 1.5)?)?;
    }
    write(&folder, "report.html", report(&pictures).as_bytes())
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), Box<dyn Error>> {
    Ok(std::fs::write(folder.join(name), bytes)?)
}

/// The report with a table, inputs and all pictures.
fn report(pictures: &[(&str, String)]) -> String {
    let column = |name: &str, unit: &str, align| Column {
        name: name.into(),
        unit: unit.into(),
        align,
    };
    let table = Table {
        caption: "Largest in-plane deviation over the plate.".into(),
        columns: vec![
            column("distance", "mm", Align::Number),
            column("deviation", "µm", Align::Number),
            column("governing case", "", Align::Left),
        ],
        rows: vec![
            vec!["600".into(), "41.2".into(), "feed +y".into()],
            vec!["1000".into(), "118.9".into(), "feed −z".into()],
        ],
    };
    let input = Input {
        name: "compliance of joint 2".into(),
        value: "0.213".into(),
        unit: "µrad/(N m)".into(),
        source: "made up for this gallery".into(),
    };
    let mut report = Report::new("Can this arm mill a 300 mm circle to 50 µm?")
        .question("Plate 800 mm in front of the base, end mill of 8 mm, aluminium.")
        .answer("Yes, on 62 % of the plate; the largest part that fits is 420 × 260 mm.")
        .warning("The compliances are made up: this report shows the layout, not a robot.")
        .section("Numbers")
        .paragraph("Every picture below is drawn from synthetic values.")
        .table(&table)
        .inputs([input])
        .section("Pictures");
    for (name, svg) in pictures {
        report = report.picture(svg, &name.replace('_', " "));
    }
    report.to_html()
}
