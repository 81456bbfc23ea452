//! Tables of an ask: CSV and Parquet with one row a point, VTK for planes, paths and boxes.
//!
//! Positions count from the frame that the study names; deviations are in base axes, micrometres.

use armill_core::robot::Singularity;
use armill_formats::table::vtk::{Image, PointArray, PointValues, PolyData, write_image, write_poly_data};
use armill_formats::table::{Column, ColumnData, Table, csv};

use super::rows::{Rows, rows};
use crate::error::StudyError;
use crate::file::resolve::{Ask, Study, Subject};
use crate::run::Found;

/// The files of one ask: extension and bytes.
pub(super) fn files(
    study: &Study,
    ask: &Ask,
    found: &Found,
) -> Result<Vec<(&'static str, Vec<u8>)>, StudyError> {
    let series = rows(ask, found);
    let table = table(study, &ask.name, &series)?;
    let mut files = vec![("csv", csv::write(&table))];
    #[cfg(feature = "parquet")]
    files.push((
        "parquet",
        armill_formats::table::parquet::write(&table, &metadata(study, ask))?,
    ));
    files.push(match (&ask.subject, found) {
        (Subject::Volume(setting, _), Found::Volume(volume)) => {
            let mm = |v: armill_core::nalgebra::Point3<f64>| v.coords.map(|c| c * 1e3).into();
            let step = volume.grid.step * 1e3;
            let origin = mm(setting.counted(&volume.grid.origin));
            let image = Image::new(origin, [step; 3], volume.grid.counts, arrays(&series))?;
            ("vti", write_image(&image))
        }
        (_, Found::Path(_)) => {
            let paths: Vec<Vec<[f64; 3]>> = series.iter().map(points_mm).collect();
            ("vtp", write_poly_data(&PolyData::paths(&paths, arrays(&series))?))
        }
        (_, found) => ("vtp", write_poly_data(&sheets(found, &series)?)),
    });
    Ok(files)
}

#[cfg(feature = "parquet")]
fn metadata(study: &Study, ask: &Ask) -> armill_formats::table::parquet::Metadata {
    let entries = [
        ("armill", env!("CARGO_PKG_VERSION").to_owned()),
        ("study", study.title.clone()),
        ("ask", ask.name.clone()),
        ("robot", study.robot.robot.name().to_owned()),
    ];
    entries
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect()
}

/// All planes of an ask as one surface.
fn sheets(found: &Found, series: &[Rows<'_>]) -> Result<PolyData, StudyError> {
    let maps: &[armill_core::map::PlaneMap] = match found {
        Found::Map(map) => std::slice::from_ref(map),
        Found::Sections(maps) => maps,
        Found::Volume(_) | Found::Path(_) => &[],
    };
    let mut quads = Vec::new();
    let mut first = 0;
    for map in maps {
        let (columns, rows) = (map.grid.columns, map.grid.rows);
        for row in 1..rows {
            for column in 1..columns {
                let corner = first + (row - 1) * columns + column - 1;
                quads.push([corner, corner + 1, corner + 1 + columns, corner + columns]);
            }
        }
        first += map.grid.len();
    }
    let points = series.iter().flat_map(points_mm).collect();
    Ok(PolyData::new(points, Vec::new(), quads, arrays(series))?)
}

fn points_mm(rows: &Rows<'_>) -> Vec<[f64; 3]> {
    rows.tcp
        .iter()
        .map(|tcp| rows.setting.counted(tcp).coords.map(|c| rounded(c * 1e3)).into())
        .collect()
}

/// Values for VTK: the envelope, and the deviation vector of each case.
fn arrays(series: &[Rows<'_>]) -> Vec<PointArray> {
    let scalar = |name: &str, value: &dyn Fn(&Rows<'_>) -> Vec<Option<f64>>| PointArray {
        name: name.to_owned(),
        values: PointValues::OptionalScalar(series.iter().flat_map(value).collect()),
    };
    let mut arrays = vec![
        scalar("in_plane_um", &|rows| rows.of_held(|_, held| held.in_plane * 1e6)),
        scalar("in_plane_u_um", &|rows| {
            rows.of_held(|_, held| held.in_plane_uncertainty * 1e6)
        }),
        scalar("normal_um", &|rows| rows.of_held(|_, held| held.normal * 1e6)),
        scalar("full_um", &|rows| rows.of_held(|_, held| held.full * 1e6)),
    ];
    let cases = series.first().map_or(0, |rows| rows.answers.case_count);
    arrays.extend((0..cases).map(|case| {
        let vector = |rows: &Rows<'_>, index: usize| {
            let reached = rows.answers.points[index].is_ok();
            reached.then(|| rows.answers.deviations_at(index)[case].map(|c| c * 1e6).into())
        };
        let values = series
            .iter()
            .flat_map(|rows| (0..rows.tcp.len()).map(move |i| vector(rows, i)))
            .collect();
        PointArray {
            name: format!("deviation_case_{}_um", case + 1),
            values: PointValues::OptionalVector(values),
        }
    }));
    arrays
}

/// One row a point.
fn table(study: &Study, name: &str, series: &[Rows<'_>]) -> Result<Table, StudyError> {
    let robot = &study.robot.robot;
    let mut columns = Vec::new();
    if series.len() > 1 {
        let labels: Vec<String> = series.iter().map(|rows| rows.label.clone()).collect();
        let codes = series
            .iter()
            .zip(0..)
            .flat_map(|(rows, code)| std::iter::repeat_n(code, rows.tcp.len()))
            .collect();
        columns.push(column(
            "section",
            None,
            "which section",
            ColumnData::Category { codes, labels },
        ));
    }
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        let values = series
            .iter()
            .flat_map(|rows| points_mm(rows).into_iter().map(move |p| p[axis]))
            .collect();
        let text = format!("{letter} of the TCP in the frame that the study counts from");
        columns.push(column(
            &format!("{letter}_mm"),
            Some("mm"),
            &text,
            ColumnData::Float(values),
        ));
    }
    columns.push(words(
        "state",
        "within the limit, over it, or why there is no posture",
        series,
        |rows, i| Some(rows.state(i).to_owned()),
    ));
    columns.push(words("branch", "branch of the posture", series, |rows, i| {
        rows.answers.points[i]
            .as_ref()
            .ok()
            .map(|held| held.branch.to_string())
    }));
    columns.push(words(
        "singularity",
        "near which singularity the posture stands",
        series,
        |rows, i| {
            let near = rows.answers.points[i].as_ref().ok()?.singularity?;
            Some(match near {
                Singularity::Shoulder => "shoulder".to_owned(),
                Singularity::Elbow => "elbow".to_owned(),
                Singularity::Wrist => "wrist".to_owned(),
            })
        },
    ));
    let mut number =
        |name: &str, unit: Option<&str>, text: &str, value: &dyn Fn(&Rows<'_>) -> Vec<Option<f64>>| {
            let values = series
                .iter()
                .flat_map(value)
                .map(|value| value.map(rounded))
                .collect();
            columns.push(column(name, unit, text, ColumnData::OptionalFloat(values)));
        };
    number(
        "limit_margin_deg",
        Some("deg"),
        "least distance of a joint to its limit, negative outside",
        &|rows| rows.of_held(|_, held| held.limit_margin.to_degrees()),
    );
    number(
        "deciding_case",
        None,
        "load case with the largest in-plane deviation, from 1",
        &|rows| rows.of_held(|_, held| held.deciding_case as f64 + 1.0),
    );
    number(
        "in_plane_um",
        Some("um"),
        "largest in-plane deviation of all cases",
        &|rows| rows.of_held(|_, held| held.in_plane * 1e6),
    );
    number(
        "in_plane_u_um",
        Some("um"),
        "its standard uncertainty from the compliances",
        &|rows| rows.of_held(|_, held| held.in_plane_uncertainty * 1e6),
    );
    number(
        "normal_um",
        Some("um"),
        "deviation along the outward normal, of the case where it is largest",
        &|rows| rows.of_held(|_, held| held.normal * 1e6),
    );
    number(
        "full_um",
        Some("um"),
        "largest length of the deviation of all cases",
        &|rows| rows.of_held(|_, held| held.full * 1e6),
    );
    for (i, joint) in robot.joints().iter().enumerate() {
        let name = &joint.name;
        number(
            &format!("joint_{name}_deg"),
            Some("deg"),
            "joint position in the robot file's counting",
            &|rows| rows.of_held(|index, _| rows.answers.joints_at(index)[i].to_degrees()),
        );
    }
    for (i, joint) in robot.joints().iter().enumerate() {
        let text = "share of the joint in the in-plane deviation; the shares add up to it";
        number(&format!("share_{}_um", joint.name), Some("um"), text, &|rows| {
            rows.of_held(|index, _| rows.answers.shares_at(index)[i] * 1e6)
        });
    }
    for case in 0..series.first().map_or(0, |rows| rows.answers.case_count) {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let name = format!("deviation_{letter}_case_{}_um", case + 1);
            number(
                &name,
                Some("um"),
                "deviation under this load case, base axes",
                &|rows| rows.of_held(|index, _| rows.answers.deviations_at(index)[case][axis] * 1e6),
            );
        }
    }
    Ok(Table::new(name, columns)?)
}

/// To the digits that mean something: 1e-6 um, mm or deg; the rest is rounding.
fn rounded(value: f64) -> f64 {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == 0.0 { 0.0 } else { rounded }
}

fn column(name: &str, unit: Option<&str>, description: &str, data: ColumnData) -> Column {
    Column {
        name: name.to_owned(),
        unit: unit.map(str::to_owned),
        description: description.to_owned(),
        data,
    }
}

/// A column of few words; points without one get an empty word.
fn words(
    name: &str,
    description: &str,
    series: &[Rows<'_>],
    word: impl Fn(&Rows<'_>, usize) -> Option<String>,
) -> Column {
    let mut labels: Vec<String> = Vec::new();
    let mut codes = Vec::new();
    for rows in series {
        for index in 0..rows.tcp.len() {
            let word = word(rows, index).unwrap_or_default();
            let code = labels.iter().position(|label| *label == word).unwrap_or_else(|| {
                labels.push(word);
                labels.len() - 1
            });
            codes.push(code as u32);
        }
    }
    column(name, None, description, ColumnData::Category { codes, labels })
}
