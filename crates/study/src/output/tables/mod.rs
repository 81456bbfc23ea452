//! Tables of an analysis: Parquet and CSV with one row a point, VTK for planes, paths and boxes.
//!
//! Positions are relative to the reference frame of the study; deviations are in base axes, micrometres.
//!
//! | column | meaning |
//! |---|---|
//! | `section` | label, of sections only |
//! | `x_mm`, `y_mm`, `z_mm` | TCP |
//! | `state` | `within`, `above_tolerance`, or why there is no posture |
//! | `branch`, `singularity` | the posture, and a singularity that is near |
//! | `line` to `axial_um` | of paths only: see `track` |
//! | `hole` to `depth_um` | of holes only: see `holes` |
//! | `limit_margin_deg` | least distance of a joint to its limit, deg (mm) |
//! | `worst_case` | the case with the largest in-plane deviation, from 1 |
//! | `in_plane_um`, `in_plane_u_um`, `probability_within` | its deviation, u, probability to be within the tolerance |
//! | `normal_um`, `full_um` | along the normal, whole length |
//! | `joint_NAME_deg` (`_mm`) | joint positions in the convention of the robot file |
//! | `share_NAME_um` | shares of joints, base, flange, tool in the in-plane deviation |
//! | `deviation_x_case_1_um`, ... | the deviation under each case |
//!
//! A point without posture has its position and state alone. Uncertainty, probability and shares are left out if the
//! core does not compute them: along a path whose load differs from point to point, or with a tilted tool. VTK has the
//! envelopes, and the deviation of each case as an array of vectors.

mod holes;
mod track;

use std::fmt::Display;
use std::ops::Range;

use armill_core::kernel::{Answers, Evaluation};
use armill_core::map::{PlaneMap, probability_within};
use armill_formats::table::vtk::{Image, PointArray, PointValues, PolyData, write_image, write_poly_data};
use armill_formats::table::{Column, ColumnData, Table, csv};
use rayon::prelude::*;

use super::Csv;
use super::rows::{MM_DECIMALS, Rows, of_points, of_reached, rows};
use crate::error::StudyError;
use crate::file::resolve::{Analysis, Study, Subject};
use crate::run::{AnalysisData, AnalysisResult};

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
        extensions.push(super::limits::EXTENSION);
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
    (analysis, done): (&Analysis, &AnalysisResult<'_>),
    csv: Csv,
    save: &Save<'_>,
) -> Result<(), StudyError> {
    let series = rows(&done.found);
    let rows_of_table = || {
        let table = table(study, &analysis.name, &series)?;
        #[cfg(feature = "parquet")]
        save(
            "parquet",
            &armill_formats::table::parquet::write(&table, &metadata(study, analysis))?,
        )?;
        if has_csv(analysis, csv) {
            save("csv", &csv::write(&table))?;
        }
        if let AnalysisData::Path(path, found) = &done.found
            && let Some(table) = super::limits::table(&analysis.name, path, found)?
        {
            save(super::limits::EXTENSION, &csv::write(&table))?;
        }
        Ok(())
    };
    let field = || match &done.found {
        AnalysisData::Volume(setting, volume) => {
            let mm = |v: armill_core::nalgebra::Point3<f64>| v.coords.map(|c| c * 1e3).into();
            let step = volume.grid.step * 1e3;
            let origin = mm(setting.in_reference(&volume.grid.corner()));
            let image = Image::new(origin, [step; 3], volume.grid.counts, arrays(&series))?;
            save(IMAGE, &write_image(&image))
        }
        AnalysisData::Holes(..) => {
            let points = series.iter().flat_map(|rows| rows.at_mm.iter().copied());
            let holes = PolyData::points(points.collect(), arrays(&series))?;
            save(POLY_DATA, &write_poly_data(&holes))
        }
        AnalysisData::Path(..) => {
            let paths: Vec<Vec<[f64; 3]>> = series.iter().flat_map(stretches).collect();
            save(
                POLY_DATA,
                &write_poly_data(&PolyData::paths(&paths, arrays(&series))?),
            )
        }
        AnalysisData::Map(_, map) => save(POLY_DATA, &write_poly_data(&sheets(&[map], &series)?)),
        AnalysisData::Sections(sections) => {
            let maps: Vec<&PlaneMap> = sections.iter().map(|section| &section.map).collect();
            save(POLY_DATA, &write_poly_data(&sheets(&maps, &series)?))
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
    table(study, done.name, &rows(&done.found))
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

/// The points of a path, interval by interval between rapids.
fn stretches(rows: &Rows<'_>) -> Vec<Vec<[f64; 3]>> {
    let stretches = rows.path.iter().flat_map(|(path, _)| path.track.path.stretches());
    stretches.map(|stretch| rows.at_mm[stretch].to_vec()).collect()
}

/// All planes of an analysis as one surface.
fn sheets(maps: &[&PlaneMap], series: &[Rows<'_>]) -> Result<PolyData, StudyError> {
    let counts: Vec<[usize; 2]> = maps.iter().map(|map| [map.grid.columns, map.grid.rows]).collect();
    let points = series
        .iter()
        .flat_map(|rows| rows.at_mm.iter().copied())
        .collect();
    Ok(PolyData::plane_grids(points, &counts, arrays(series))?)
}

/// Values for VTK: the envelope, and the deviation vector of each case.
fn arrays(series: &[Rows<'_>]) -> Vec<PointArray> {
    let scalar = |name: &str, um: fn(&Evaluation) -> f64| PointArray {
        name: name.to_owned(),
        values: PointValues::Scalar(
            series
                .iter()
                .flat_map(|rows| {
                    of_reached(rows, 0..rows.at_mm.len(), |_, _, evaluation| um(evaluation) * 1e6)
                })
                .collect(),
        ),
    };
    let mut arrays = vec![
        scalar("in_plane_um", |evaluation| evaluation.in_plane),
        scalar("in_plane_u_um", |evaluation| evaluation.in_plane_uncertainty),
        scalar("normal_um", |evaluation| evaluation.normal),
        scalar("full_um", |evaluation| evaluation.full),
    ];
    let cases = series.first().map_or(0, |rows| rows.answers.case_count);
    arrays.par_extend((0..cases).into_par_iter().map(|case| {
        let vector = |rows: &Rows<'_>, index: usize| {
            let reached = rows.answers.points[index].is_ok();
            reached.then(|| rows.answers.deviations_at(index)[case].map(|c| c * 1e6).into())
        };
        PointArray {
            name: format!("deviation_case_{}_um", case + 1),
            values: PointValues::Vector(of_points(series, vector)),
        }
    }));
    arrays
}

/// Significant decimals: a nanometre of deviation, a degree of 1e-6 (some 0.02 um at an arm's length), a
/// position as given.
const UM_DECIMALS: u8 = 3;
/// Of angles.
const DEG_DECIMALS: u8 = 6;

/// A column of numbers that is not filled yet.
struct Numbers<'a> {
    name: String,
    unit: Option<&'static str>,
    decimals: u8,
    description: &'static str,
    /// Appends its values at these points.
    fill: Fill<'a>,
}

/// Accepts a series, a range of its points, and the list to append to: `None` for a point without posture.
type Fill<'a> = Box<dyn Fn(&Rows<'_>, Range<usize>, &mut Vec<Option<f64>>) + Send + Sync + 'a>;

impl<'a> Numbers<'a> {
    /// A column of micrometres: `um` gives the value of a point with a posture.
    fn um(
        name: String,
        description: &'static str,
        um: impl Fn(&Rows<'_>, usize, &Evaluation) -> f64 + Send + Sync + 'a,
    ) -> Numbers<'a> {
        Numbers {
            name,
            unit: Some("um"),
            decimals: UM_DECIMALS,
            description,
            fill: Box::new(move |rows, points, values| values.extend(of_reached(rows, points, &um))),
        }
    }

    /// The same of degrees.
    fn deg(
        name: String,
        description: &'static str,
        deg: impl Fn(&Rows<'_>, usize, &Evaluation) -> f64 + Send + Sync + 'a,
    ) -> Numbers<'a> {
        Numbers {
            unit: Some("deg"),
            decimals: DEG_DECIMALS,
            ..Numbers::um(name, description, deg)
        }
    }

    /// The column with its values.
    fn column(&self, values: Vec<Option<f64>>) -> Column {
        Column {
            name: self.name.clone(),
            unit: self.unit.map(str::to_owned),
            description: self.description.to_owned(),
            decimals: Some(self.decimals),
            data: ColumnData::OptionalFloat(values),
        }
    }
}

/// Points whose answers stay in the cache while all columns read them.
const POINTS_AT_ONCE: usize = 512;

/// The columns of these numbers, filled on all threads.
fn filled(numbers: &[Numbers<'_>], series: &[Rows<'_>]) -> Vec<Column> {
    let count = series.iter().map(|rows| rows.at_mm.len()).sum();
    let fill = |numbers: &[Numbers<'_>]| -> Vec<Column> {
        let mut values = vec![Vec::with_capacity(count); numbers.len()];
        for rows in series {
            for first in (0..rows.at_mm.len()).step_by(POINTS_AT_ONCE) {
                let points = first..rows.at_mm.len().min(first + POINTS_AT_ONCE);
                for (numbers, values) in numbers.iter().zip(&mut values) {
                    (numbers.fill)(rows, points.clone(), values);
                }
            }
        }
        numbers
            .iter()
            .zip(values)
            .map(|(numbers, values)| numbers.column(values))
            .collect()
    };
    // Each thread fills some columns, all of them point after point: what a point needs is then near.
    let share = numbers.len().div_ceil(rayon::current_num_threads());
    numbers.par_chunks(share).flat_map_iter(fill).collect()
}

/// One row a point.
fn table(study: &Study, name: &str, series: &[Rows<'_>]) -> Result<Table, StudyError> {
    let mut columns = Vec::new();
    if series.len() > 1 {
        columns.push(section(series));
    }
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        columns.push(Column {
            name: format!("{letter}_mm"),
            unit: Some("mm".to_owned()),
            description: format!("{letter} of the TCP in the reference frame of the study"),
            decimals: Some(MM_DECIMALS),
            data: ColumnData::Float(of_points(series, |rows, index| rows.at_mm[index][axis])),
        });
    }
    columns.push(words(
        (
            "state",
            "within the tolerance, above it, or why there is no posture",
        ),
        series,
        |rows, i| Some(rows.state(i)),
    ));
    columns.push(words(("branch", "name of the posture"), series, |rows, i| {
        rows.answers.points[i]
            .as_ref()
            .ok()
            .map(|evaluation| evaluation.name)
    }));
    columns.push(words(
        ("singularity", "a singularity near the posture"),
        series,
        |rows, i| Some(rows.answers.points[i].as_ref().ok()?.singularity?.word()),
    ));
    // All series of an analysis have the same columns.
    let numbers = series.first().map_or_else(Vec::new, |rows| {
        let contributors = rows.setting.model.contributor_names(study.robot.robot.joints());
        let mut columns = rows
            .path
            .map_or_else(Vec::new, |(path, found)| track::columns(&path.track, found));
        let of_holes = rows
            .holes
            .map(|(analysis, found)| holes::columns(study, analysis, found));
        columns.extend(of_holes.into_iter().flatten());
        columns.extend(numbers(study, contributors, rows.answers));
        columns
    });
    columns.extend(filled(&numbers, series));
    Ok(Table::new(name, columns)?)
}

/// Columns without values at points where shares are not computed.
const WITH_SHARES: [&str; 2] = ["in_plane_u_um", "probability_within"];

/// The columns of numbers that every analysis has; `contributors` are those that have shares.
fn numbers<'a>(study: &'a Study, contributors: Vec<String>, answers: &Answers) -> Vec<Numbers<'a>> {
    let (cases, shared) = (answers.case_count, answers.share_count > 0);
    let mut columns = vec![
        Numbers::deg(
            "limit_margin_deg".to_owned(),
            "least distance of a joint to its limit (mm for a prismatic joint), negative outside",
            |_, _, evaluation| {
                let slides = study.robot.robot.slides(evaluation.limit_joint);
                evaluation.limit_margin * if slides { 1e3 } else { 1f64.to_degrees() }
            },
        ),
        Numbers {
            unit: None,
            decimals: 0,
            ..Numbers::um(
                "worst_case".to_owned(),
                "load case with the largest in-plane deviation, from 1",
                |_, _, evaluation| evaluation.worst_case as f64 + 1.0,
            )
        },
        Numbers::um(
            "in_plane_um".to_owned(),
            "largest in-plane deviation of all cases",
            |_, _, evaluation| evaluation.in_plane * 1e6,
        ),
        Numbers::um(
            "in_plane_u_um".to_owned(),
            "its standard uncertainty",
            |_, _, evaluation| evaluation.in_plane_uncertainty * 1e6,
        ),
        Numbers {
            unit: None,
            decimals: 4,
            ..Numbers::um(
                "probability_within".to_owned(),
                "probability that the in-plane deviation is within the tolerance",
                |rows, _, evaluation| probability_within(evaluation, rows.setting.tolerance),
            )
        },
        Numbers::um(
            "normal_um".to_owned(),
            "deviation along the outward normal, of the case where it is largest",
            |_, _, evaluation| evaluation.normal * 1e6,
        ),
        Numbers::um(
            "full_um".to_owned(),
            "largest length of the deviation of all cases",
            |_, _, evaluation| evaluation.full * 1e6,
        ),
    ];
    if !shared {
        columns.retain(|column| !WITH_SHARES.contains(&column.name.as_str()));
    }
    let joints = study.robot.robot.joints();
    columns.extend(joints.iter().enumerate().map(|(i, joint)| {
        let what = "joint position in the convention of the robot file";
        if study.robot.robot.slides(i) {
            Numbers {
                unit: Some("mm"),
                decimals: MM_DECIMALS,
                ..Numbers::um(format!("joint_{}_mm", joint.name), what, move |rows, index, _| {
                    rows.answers.joints_at(index)[i] * 1e3
                })
            }
        } else {
            Numbers::deg(
                format!("joint_{}_deg", joint.name),
                what,
                move |rows, index, _| rows.answers.joints_at(index)[i].to_degrees(),
            )
        }
    }));
    let contributors = contributors.into_iter().filter(|_| shared);
    columns.extend(contributors.enumerate().map(|(i, contributor)| {
        let name = format!("share_{contributor}_um");
        Numbers::um(
            name,
            "share of the joint (base, flange, tool) in the in-plane deviation; the sum of the shares is the deviation",
            move |rows, index, _| rows.answers.shares_at(index)[i] * 1e6,
        )
    }));
    for case in 0..cases {
        columns.extend(["x", "y", "z"].into_iter().enumerate().map(|(axis, letter)| {
            let name = format!("deviation_{letter}_case_{}_um", case + 1);
            Numbers::um(
                name,
                "deviation under this load case, base axes",
                move |rows, index, _| rows.answers.deviations_at(index)[case][axis] * 1e6,
            )
        }));
    }
    columns
}

/// The column with the section of a point.
fn section(series: &[Rows<'_>]) -> Column {
    let codes = series
        .iter()
        .zip(0..)
        .flat_map(|(rows, code)| std::iter::repeat_n(code, rows.at_mm.len()));
    Column {
        name: "section".to_owned(),
        unit: None,
        description: "which section".to_owned(),
        decimals: None,
        data: ColumnData::Category {
            codes: codes.collect(),
            labels: series.iter().map(|rows| rows.label.clone()).collect(),
        },
    }
}

/// A column of few words, by name and description; points without one get an empty text.
fn words<W: PartialEq + Display>(
    (name, description): (&str, &str),
    series: &[Rows<'_>],
    word: impl Fn(&Rows<'_>, usize) -> Option<W>,
) -> Column {
    let mut words: Vec<Option<W>> = Vec::new();
    let mut codes = Vec::new();
    for rows in series {
        for index in 0..rows.at_mm.len() {
            let word = word(rows, index);
            let code = words.iter().position(|known| *known == word).unwrap_or_else(|| {
                words.push(word);
                words.len() - 1
            });
            codes.push(code as u32);
        }
    }
    let label = |word: &Option<W>| word.as_ref().map_or(String::new(), W::to_string);
    Column {
        name: name.to_owned(),
        unit: None,
        description: description.to_owned(),
        decimals: None,
        data: ColumnData::Category {
            codes,
            labels: words.iter().map(label).collect(),
        },
    }
}
