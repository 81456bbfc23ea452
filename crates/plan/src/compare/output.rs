//! What a comparison leaves behind: `result.json`, a table, pictures and a report in one folder.
//!
//! ```text
//! result.json              the result
//! report.html              ranking, differences, tables, pictures, warnings
//! cells.csv                one row per analysis and cell
//! NAME-cells.svg, .png     mean, 95 % and largest deviation of each cell and the tolerance
//! NAME-along.svg, .png     for a path the deviation of each cell along it
//! ```

use std::path::PathBuf;

use armill_formats::file::ResultFolder;
use armill_formats::table::{Column, ColumnData, Table, csv};
use armill_report::html::{Report, Table as Rows};
use armill_report::{ComparedCell, Comparison, PathPlot, Series};
use armill_study::analysis::cells::{COUNT, columns, input, percent, um, without_empty_columns};
use armill_study::error::StudyError;
use armill_study::file_names::slug;
use armill_study::output::{Picture, Pictures, REPORT, RESULT, picture_files, replace, save_pictures};

use super::answer::{ComparedAnswer, ComparisonAnswer, ComparisonResult};
use super::curve::Curve;
use super::numbers::CellNumbers;
use super::traits::TraitAnswer;

/// The table.
const TABLE: &str = "cells.csv";

/// Writes all files into `out` and returns their paths; `note` receives each name as it is written, from any thread.
///
/// # Errors
/// A file cannot be written.
pub fn write(
    compared: &ComparisonResult,
    out: &ResultFolder,
    requested: Pictures,
    note: &(dyn Fn(&str) + Sync),
) -> Result<Vec<PathBuf>, StudyError> {
    let drawn = match requested {
        Pictures::Drawn => pictures(compared),
        Pictures::None => Vec::new(),
    };
    let report = (requested == Pictures::Drawn).then(|| REPORT.to_owned());
    let names: Vec<String> = [TABLE.to_owned()]
        .into_iter()
        .chain(drawn.iter().flat_map(picture_files))
        .chain(report)
        .chain([RESULT.to_owned()])
        .collect();
    replace(out, &names, &compared.answer, note, |files| {
        files.save(TABLE, &csv::write(&table(&compared.answer)?))?;
        save_pictures(&drawn, files)?;
        if requested == Pictures::Drawn {
            files.save(REPORT, html(&compared.answer, &drawn).as_bytes())?;
        }
        Ok(())
    })
}

/// One row per analysis and cell.
fn table(answer: &ComparisonAnswer) -> Result<Table, StudyError> {
    let rows: Vec<(&ComparedAnswer, &CellNumbers)> = answer
        .analyses
        .iter()
        .flat_map(|analysis| analysis.cells.iter().map(move |cell| (analysis, cell)))
        .collect();
    let column = |name: &str, description: &str, data: ColumnData| Column {
        name: name.to_owned(),
        unit: name.ends_with("_um").then(|| "um".to_owned()),
        description: description.to_owned(),
        decimals: name.ends_with("_um").then_some(6),
        data,
    };
    type Row<'a> = (&'a ComparedAnswer, &'a CellNumbers);
    let text = |of: &dyn Fn(&Row<'_>) -> String| ColumnData::Text(rows.iter().map(of).collect());
    let count = |of: &dyn Fn(&CellNumbers) -> usize| {
        ColumnData::Integer(rows.iter().map(|(_, cell)| of(cell) as i64).collect())
    };
    let number = |of: &dyn Fn(&CellNumbers) -> Option<f64>| {
        ColumnData::OptionalFloat(rows.iter().map(|(_, cell)| of(cell)).collect())
    };
    let columns = vec![
        column(
            "analysis",
            "name of the analysis",
            text(&|(analysis, _)| analysis.name.clone()),
        ),
        column(
            "kind",
            "path, holes, map or volume",
            text(&|(analysis, _)| analysis.kind.to_owned()),
        ),
        column("cell", "best first", text(&|(_, cell)| cell.cell.clone())),
        column("robot", "its robot", text(&|(_, cell)| cell.robot.clone())),
        column(
            "compliance_assumed",
            "whether its joint compliances are assumed, not measured",
            ColumnData::Flag(rows.iter().map(|(_, cell)| cell.compliance_assumed).collect()),
        ),
        column(
            "branch",
            "followed, or requested",
            text(&|(_, cell)| cell.branch.clone()),
        ),
        column("points", "all points", count(&|cell| cell.points)),
        column("reached", "points with a posture", count(&|cell| cell.reached)),
        column(
            "inside_joint_limits",
            "points with a posture inside joint limits",
            count(&|cell| cell.inside_joint_limits),
        ),
        column(
            "tolerance_um",
            "the tolerance",
            number(&|cell| Some(cell.tolerance_um)),
        ),
        column(
            "mean_in_plane_um",
            "of reached points",
            number(&|cell| cell.mean_in_plane_um),
        ),
        column(
            "p95_in_plane_um",
            "deviation that 95 of 100 reached points do not exceed",
            number(&|cell| cell.p95_in_plane_um),
        ),
        column("max_in_plane_um", "largest", number(&|cell| cell.max_in_plane_um)),
        column(
            "max_in_plane_u_um",
            "its standard uncertainty",
            number(&|cell| cell.max_in_plane_u_um),
        ),
        column(
            "max_normal_um",
            "largest along the normal, by size",
            number(&|cell| cell.max_normal_um),
        ),
        column(
            "fraction_within",
            "points within the tolerance over all points",
            number(&|cell| Some(cell.fraction_within)),
        ),
        column(
            "fraction_within_and_inside_joint_limits",
            "the same, of points inside joint limits only",
            number(&|cell| Some(cell.fraction_within_and_inside_joint_limits)),
        ),
        column(
            "mostly_by",
            "largest contributor where the deviation is largest",
            text(&|(_, cell)| cell.mostly_by.clone().unwrap_or_default()),
        ),
        column(
            "mostly_by_percent",
            "its share",
            number(&|cell| cell.mostly_by_percent),
        ),
    ];
    Ok(Table::new("cells", columns)?)
}

/// Two pictures for a path, one for other analyses.
fn pictures(compared: &ComparisonResult) -> Vec<Picture> {
    let analyses = compared.answer.analyses.iter().zip(&compared.curves);
    analyses
        .flat_map(|(analysis, curves)| {
            let along = (!curves.is_empty()).then(|| along(analysis, curves));
            [ranges(analysis)].into_iter().chain(along)
        })
        .collect()
}

/// Mean, 95 % and largest of each cell.
fn ranges(analysis: &ComparedAnswer) -> Picture {
    let cell = |cell: &CellNumbers| ComparedCell {
        label: cell.cell.clone(),
        note: note(cell),
        mean_um: cell.mean_in_plane_um,
        p95_um: cell.p95_in_plane_um,
        largest_um: cell.max_in_plane_um,
        largest_uncertainty_um: cell.max_in_plane_u_um,
        tolerance_um: Some(cell.tolerance_um),
        result: format!("{} %", percent(cell.fraction_within_and_inside_joint_limits)),
    };
    let picture = Comparison {
        title: format!("{}: deviation and tolerance of each cell", analysis.name),
        subtitle: "mean, 95 % and largest deviation of the points that are reached".to_owned(),
        quantity: "in-plane deviation (µm)".to_owned(),
        result: "within".to_owned(),
        cells: analysis.cells.iter().map(cell).collect(),
    };
    Picture {
        name: format!("{}-cells", slug(&analysis.name)),
        caption: format!(
            "{}: deviation of each cell against its tolerance; at the right the points within it and inside joint limits, of all points.",
            analysis.name
        ),
        svg: picture.to_svg(),
    }
}

/// Limitations of a cell, in a few words.
fn note(cell: &CellNumbers) -> String {
    let of_all = |points: usize, what: &str| {
        (points > 0).then(|| format!("{points} of {} points {what}", cell.points))
    };
    let given = [
        cell.compliance_assumed.then(|| "compliance assumed".to_owned()),
        of_all(cell.points - cell.reached, "out of reach"),
        of_all(cell.reached - cell.inside_joint_limits, "outside joint limits"),
    ];
    given.into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// The deviation along a path, a line a cell.
fn along(analysis: &ComparedAnswer, curves: &[Curve]) -> Picture {
    let series = analysis.cells.iter().zip(curves).map(|(cell, curve)| Series {
        name: cell.cell.clone(),
        position: curve.position_mm.clone(),
        deviation_um: curve.in_plane_um.clone(),
    });
    let limit = analysis.cells.first().map(|cell| cell.tolerance_um);
    let one_limit = analysis.cells.iter().all(|cell| Some(cell.tolerance_um) == limit);
    let picture = PathPlot {
        title: format!("{}: the same path in each cell", analysis.name),
        subtitle: "in-plane deviation, the largest of the load cases; no line: out of reach".to_owned(),
        position_label: "along the path (mm)".to_owned(),
        quantity: "in-plane deviation (µm)".to_owned(),
        series: series.collect(),
        envelope: None,
        tolerance_um: limit.filter(|_| one_limit),
    };
    Picture {
        name: format!("{}-along", slug(&analysis.name)),
        caption: format!(
            "{}: the deviation along the path, one line per cell.",
            analysis.name
        ),
        svg: picture.to_svg(),
    }
}

/// The page: ranking, then for each analysis its numbers and differences, then pictures.
fn html(answer: &ComparisonAnswer, drawn: &[Picture]) -> String {
    let names: Vec<&str> = answer.cells.iter().map(|cell| cell.name.as_str()).collect();
    let mut report = Report::new(&format!("Compared: {}", names.join(", ")))
        .question("Which cell meets the tolerance?")
        .answer(&answer.answer);
    for warning in &answer.warnings {
        report = report.warning(warning);
    }
    for analysis in &answer.analyses {
        report = report
            .section(&format!("{} ({})", analysis.name, analysis.kind))
            .paragraph(&analysis.answer)
            .list(&analysis.notes)
            .table(&numbers(analysis))
            .table(&traits(analysis));
        for picture in drawn.iter().filter(|picture| is_of(picture, analysis)) {
            report = report.picture(&picture.svg, &picture.caption);
        }
    }
    if !answer.left_out.is_empty() {
        report = report.section("Not compared").list(&answer.left_out);
    }
    let source =
        |source: &armill_formats::sources::Source| input(&source.what, String::new(), "", &source.place);
    report.inputs(answer.sources.iter().map(source)).to_html()
}

/// Whether a picture belongs to this analysis.
fn is_of(picture: &Picture, analysis: &ComparedAnswer) -> bool {
    let slug = slug(&analysis.name);
    [format!("{slug}-cells"), format!("{slug}-along")].contains(&picture.name)
}

/// The cells of one analysis in numbers.
fn numbers(analysis: &ComparedAnswer) -> Rows {
    // What all cells have in common needs no column, which would make the table wider than a page.
    let tolerance = analysis.cells.first().map_or(0.0, |cell| cell.tolerance_um);
    let one_tolerance = analysis.cells.iter().all(|cell| cell.tolerance_um == tolerance);
    let of_all = |points: usize, cell: &CellNumbers| format!("{points}/{}", cell.points);
    let row = |cell: &CellNumbers| {
        let assumed = if cell.compliance_assumed {
            "assumed"
        } else {
            "given"
        };
        let by = cell.mostly_by.clone().zip(cell.mostly_by_percent);
        vec![
            cell.cell.clone(),
            Some(cell.robot.clone())
                .filter(|robot| *robot != cell.cell)
                .unwrap_or_default(),
            cell.branch.clone(),
            assumed.to_owned(),
            of_all(cell.reached, cell),
            of_all(cell.inside_joint_limits, cell),
            um(cell.mean_in_plane_um),
            um(cell.p95_in_plane_um),
            um(cell.max_in_plane_um),
            um(cell.max_in_plane_u_um.map(|u| armill_core::map::COVERAGE * u)),
            um(cell.max_normal_um),
            um(Some(cell.tolerance_um).filter(|_| !one_tolerance)),
            percent(cell.fraction_within_and_inside_joint_limits),
            by.map_or_else(String::new, |(by, part)| format!("{by} ({part:.0} %)")),
        ]
    };
    without_empty_columns(Rows {
        caption: format!(
            "{}: {}. Mean, 95 % and largest in-plane deviation are of the points that are reached, ± is twice the standard \
             uncertainty; normal: largest deviation along the normal, or along the tool of a path; within: points within the \
             tolerance{} and inside joint limits, of all points.",
            analysis.name,
            match analysis.is_ranked {
                true => "best first",
                false => "in the order of the nominal numbers, which is no ranking",
            },
            match one_tolerance {
                true => format!(" of {} µm", um(Some(tolerance))),
                false => String::new(),
            }
        ),
        columns: columns(&[
            ("cell", ""),
            ("robot", ""),
            ("branch", ""),
            ("compliance", ""),
            ("reached", COUNT),
            ("in limits", COUNT),
            ("mean", "µm"),
            ("95 %", "µm"),
            ("largest", "µm"),
            ("±", "µm"),
            ("normal", "µm"),
            ("tolerance", "µm"),
            ("within", "%"),
            ("largest share", ""),
        ]),
        rows: analysis.cells.iter().map(row).collect(),
    })
}

/// Properties of the cells; common values have one cell in the table.
fn traits(analysis: &ComparedAnswer) -> Rows {
    let names = analysis.cells.iter().map(|cell| (cell.cell.as_str(), ""));
    let heads: Vec<(&str, &str)> = [("", "")].into_iter().chain(names).collect();
    let row = |of: &TraitAnswer| {
        let given = of.of.iter().enumerate().map(|(index, given)| match of.differs {
            false if index > 0 => "the same".to_owned(),
            _ => given.clone(),
        });
        [of.what.to_owned()].into_iter().chain(given).collect()
    };
    Rows {
        caption: format!("{}: properties of the cells.", analysis.name),
        columns: columns(&heads),
        rows: analysis.traits.iter().map(row).collect(),
    }
}
