//! Tables of an analysis: Parquet and CSV with one row a point ([`crate::analysis::columns`]), VTK for planes, paths and
//! boxes: the envelopes, and the deviation of each case as an array of vectors.

use armill_core::kernel::Evaluation;
use armill_core::units::to_um;
use armill_formats::table::vtk::{Image, PointArray, PointValues, PolyData, write_image, write_poly_data};
use armill_formats::table::{Table, csv};
use rayon::prelude::*;

use super::options::Csv;
use crate::analysis::path::to_measure::NominalPath;
use crate::analysis::path::{machined_part, process_limits};
use crate::analysis::rows::{Layout, Rows, of_points, of_reached};
use crate::analysis::{Analysis, AnalysisData, AnalysisResult, Subject, columns};
use crate::error::StudyError;
use crate::file::resolve::Study;

/// The file of an analysis for ParaView.
const IMAGE: &str = "vti";
/// The same of a plane or path.
const POLY_DATA: &str = "vtp";

/// File extensions of the results of an analysis.
pub(super) fn extensions(analysis: &Analysis, csv: Csv) -> Vec<&'static str> {
    let mut extensions = Vec::new();
    if has_csv(analysis, csv) {
        extensions.push("csv");
    }
    if cfg!(feature = "parquet") {
        extensions.push("parquet");
    }
    if let Subject::Path(path) = &analysis.subject
        && path.reports_limits()
    {
        extensions.push(process_limits::EXTENSION);
    }
    if let Subject::Path(path) = &analysis.subject
        && let Some(machined) = &path.machined_part
    {
        extensions.extend(machined_part::files::EXTENSIONS.map(|(extension, _)| extension));
        extensions.extend(
            machined
                .scan
                .as_ref()
                .map(|_| machined_part::files::SCAN_EXTENSION),
        );
    }
    extensions.push(match &analysis.subject {
        Subject::Volume(..) => IMAGE,
        Subject::Map(_) | Subject::Sections(_) | Subject::Path(_) | Subject::Holes(_) => POLY_DATA,
    });
    extensions
}

/// A spreadsheet can show so many points of a path.
const FEW: usize = 100_000;

/// Many points are for programs; without Parquet they have no other format to read.
fn has_csv(analysis: &Analysis, csv: Csv) -> bool {
    let few = match &analysis.subject {
        Subject::Map(_) => true,
        Subject::Path(path) => path.track.len() <= FEW,
        Subject::Holes(holes) => holes.path.track.len() <= FEW,
        Subject::Sections(_) | Subject::Volume(..) => false,
    };
    few || csv == Csv::Every || cfg!(not(feature = "parquet"))
}

/// Accepts the bytes of a file with this extension.
type Save<'a> = dyn Fn(&str, &[u8]) -> Result<(), StudyError> + Sync + 'a;

/// Passes the files of one analysis to `save`, extension and bytes.
///
/// # Errors
/// That of `save`; a table or field that cannot be made, which would be a fault of armill.
pub(super) fn files(
    study: &Study,
    analysis: &Analysis,
    done: &AnalysisResult<'_>,
    csv: Csv,
    save: &Save<'_>,
) -> Result<(), StudyError> {
    let series = done.rows();
    let rows_of_table = || {
        let table = columns::table(&study.robot.robot, &analysis.name, &done.found, &series)?;
        #[cfg(feature = "parquet")]
        save(
            "parquet",
            &armill_formats::table::parquet::write(&table, &metadata(study, analysis))?,
        )?;
        if has_csv(analysis, csv) {
            save("csv", &csv::write(&table))?;
        }
        if let AnalysisData::Path(path, found) = &done.found
            && let Some(table) = process_limits::table(&analysis.name, path, found)?
        {
            save(process_limits::EXTENSION, &csv::write(&table))?;
        }
        if let AnalysisData::Path(path, found) = &done.found
            && let Some(part) = &found.machined_part
        {
            let path = NominalPath {
                robot: &study.robot.robot,
                nominal: &path.track,
                along: &found.along,
            };
            machined_part::files::files(&analysis.name, part, &path, save)?;
        }
        Ok(())
    };
    let field = || {
        let Some(first) = series.first() else {
            return Ok(());
        };
        match &first.layout {
            Layout::Box {
                origin_mm,
                step_mm,
                counts,
            } => {
                let image = Image::new(*origin_mm, [*step_mm; 3], *counts, arrays(&series))?;
                save(IMAGE, &write_image(&image))
            }
            Layout::Points => {
                let points = series.iter().flat_map(|rows| rows.at_mm.iter().copied());
                let points = PolyData::points(points.collect(), arrays(&series))?;
                save(POLY_DATA, &write_poly_data(&points))
            }
            Layout::Lines(_) => {
                let lines: Vec<Vec<[f64; 3]>> = series.iter().flat_map(Rows::lines).collect();
                save(
                    POLY_DATA,
                    &write_poly_data(&PolyData::paths(&lines, arrays(&series))?),
                )
            }
            Layout::Plane { .. } => save(POLY_DATA, &write_poly_data(&sheets(&series)?)),
        }
    };
    let (of_table, of_field) = rayon::join(rows_of_table, field);
    of_table.and(of_field)
}

/// The points of one analysis with their columns.
///
/// # Errors
/// A table that cannot be made, which would be a fault of armill.
pub(super) fn rows_of(study: &Study, done: &AnalysisResult<'_>) -> Result<Table, StudyError> {
    columns::table(&study.robot.robot, done.name, &done.found, &done.rows())
}

/// The metadata of a Parquet file: version, study, analysis, robot.
#[cfg(feature = "parquet")]
fn metadata(study: &Study, analysis: &Analysis) -> armill_formats::table::parquet::Metadata {
    let entries = [
        ("armill", env!("CARGO_PKG_VERSION").to_owned()),
        ("study", study.title.clone()),
        ("analysis", analysis.name.clone()),
        ("robot", study.robot.robot.name().to_owned()),
    ];
    entries
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect()
}

/// All planes of an analysis as one surface.
fn sheets(series: &[Rows<'_>]) -> Result<PolyData, StudyError> {
    let counts = series.iter().filter_map(|rows| match rows.layout {
        Layout::Plane { columns, rows } => Some([columns, rows]),
        _ => None,
    });
    let counts: Vec<[usize; 2]> = counts.collect();
    let points = series
        .iter()
        .flat_map(|rows| rows.at_mm.iter().copied())
        .collect();
    Ok(PolyData::plane_grids(points, &counts, arrays(series))?)
}

/// Values for VTK: the envelope, and the deviation vector of each case.
fn arrays(series: &[Rows<'_>]) -> Vec<PointArray> {
    let scalar = |name: &str, um: fn(&Evaluation) -> Option<f64>| PointArray {
        name: name.to_owned(),
        values: PointValues::Scalar(
            series
                .iter()
                .flat_map(|rows| of_reached(rows, 0..rows.at_mm.len(), |_, _, evaluation| um(evaluation)))
                .collect(),
        ),
    };
    let mut arrays: Vec<PointArray> = columns::ENVELOPE
        .iter()
        .map(|(quantity, of)| scalar(quantity.key, *of))
        .collect();
    let cases = series.first().map_or(0, |rows| rows.answers.case_count);
    arrays.par_extend((0..cases).into_par_iter().map(|case| {
        let vector = |rows: &Rows<'_>, index: usize| {
            let reached = rows.answers.points[index].is_ok();
            reached.then(|| rows.answers.deviations_at(index)[case].map(to_um).into())
        };
        PointArray {
            name: format!("deviation_case_{}_um", case + 1),
            values: PointValues::Vector(of_points(series, vector)),
        }
    }));
    arrays
}
