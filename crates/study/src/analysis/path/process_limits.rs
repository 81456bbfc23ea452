//! The process limits along a path: a table of its points, and a picture of depth over feed.
//!
//! | column | unit | meaning |
//! |---|---|---|
//! | `line`, `distance_mm`, `in_plane_um` | -, mm, um | the point, and its deviation with the cut of the study |
//! | `permitted_along_n`, `_cross_n`, `_axial_n` | N | force along the feed, across it, along the tool, each alone |
//! | `permitted_any_direction_n` | N | force in the least favourable direction |
//! | `permitted_axial_depth_mm`, `_radial_depth_mm`, `_feed_per_tooth_mm` | mm | of the cut, everything else unchanged |
//! | these with `_verdict` for `_mm` | - | `up to`, `at least` (larger values were not evaluated), `nothing` |
//!
//! Columns of the cut exist only if some point has them.

use armill_core::load::PathLoad;
use armill_core::map::{CutLimits, Permitted, PermittedForces, PointLimits};
use armill_core::units::{to_mm, to_um};
use armill_formats::table::{Column, ColumnData, Table};
use armill_report::{AxisLabels, ProcessMap};

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::answer::limits::verdict;
use crate::analysis::path::run::PathResult;
use crate::analysis::picture::Picture;
use crate::error::StudyError;

/// Suffix of the name of the table.
pub const EXTENSION: &str = "limits.csv";
/// Decimals of forces (N) in the table.
const N_DECIMALS: u8 = 2;
/// Of lengths; the deviation has them too, in um.
const MM_DECIMALS: u8 = 4;

/// One row for each point; `None` if process limits were not requested.
///
/// # Errors
/// Never in practice: columns of one length with unique names.
pub fn table(name: &str, analysis: &PathAnalysis, found: &PathResult) -> Result<Option<Table>, StudyError> {
    let Some(limits) = &found.limits else {
        return Ok(None);
    };
    let points = &limits.points;
    let at = |point: &PointLimits| &analysis.track.path.points[point.index];
    let column = |name: &str, unit: Option<&str>, description: &str, decimals: Option<u8>, data| Column {
        name: name.to_owned(),
        unit: unit.map(str::to_owned),
        description: description.to_owned(),
        decimals,
        data,
    };
    let numbers =
        |of: &dyn Fn(&PointLimits) -> Option<f64>| ColumnData::OptionalFloat(points.iter().map(of).collect());
    let force = |name: &str, description: &str, of: fn(&PermittedForces) -> f64| {
        let data = numbers(&|point| Some(of(&point.forces)).filter(|force| force.is_finite()));
        column(name, Some("N"), description, Some(N_DECIMALS), data)
    };
    let mut columns = vec![
        column(
            "line",
            None,
            "line of the program",
            None,
            ColumnData::Integer(points.iter().map(|point| i64::from(at(point).line)).collect()),
        ),
        column(
            "distance_mm",
            Some("mm"),
            "distance along all cuts before",
            Some(MM_DECIMALS),
            numbers(&|point| Some(to_mm(at(point).along))),
        ),
        column(
            "in_plane_um",
            Some("um"),
            "deviation across the tool with the cut of the study",
            Some(MM_DECIMALS),
            numbers(&|point| {
                let evaluation = found.along.answers.points[point.index].as_ref().ok()?;
                Some(to_um(evaluation.in_plane))
            }),
        ),
        force(
            "permitted_along_n",
            "force along the feed that the tolerance permits",
            |forces| forces.along,
        ),
        force(
            "permitted_cross_n",
            "force across the feed that the tolerance permits",
            |forces| forces.across,
        ),
        force(
            "permitted_axial_n",
            "force along the tool that the tolerance permits",
            |forces| forces.normal,
        ),
        force(
            "permitted_any_direction_n",
            "force that the tolerance permits in every direction",
            |forces| forces.weakest,
        ),
    ];
    type Part = fn(&CutLimits) -> Option<Permitted>;
    let parts: [(&str, &str, Part); 3] = [
        ("axial_depth", "axial depth that the tolerance permits", |cut| {
            Some(cut.depth)
        }),
        ("radial_depth", "radial depth that the tolerance permits", |cut| {
            cut.width
        }),
        (
            "feed_per_tooth",
            "feed per tooth that the tolerance permits",
            |cut| Some(cut.feed_per_tooth),
        ),
    ];
    let given = |part: Part| move |point: &PointLimits| point.cut.as_ref().and_then(part);
    // Parts of the cut that no point has get no column.
    for (name, description, part) in parts
        .into_iter()
        .filter(|(.., part)| points.iter().any(|p| given(*part)(p).is_some()))
    {
        columns.push(column(
            &format!("permitted_{name}_mm"),
            Some("mm"),
            &format!("{description}, everything else as in the study"),
            Some(MM_DECIMALS),
            numbers(&|point| given(part)(point).map(|permitted| to_mm(permitted.value()))),
        ));
        columns.push(column(
            &format!("permitted_{name}_verdict"),
            None,
            "whether it is up to this, at least this (larger values were not evaluated), or nothing",
            None,
            ColumnData::Text(
                points
                    .iter()
                    .map(|point| given(part)(point).map_or("", verdict).to_owned())
                    .collect(),
            ),
        ));
    }
    Ok(Some(Table::new(name, columns)?))
}

/// Depth over feed with the line of the tolerance; `None` without a cut.
pub fn picture(name: &str, subtitle: String, analysis: &PathAnalysis, found: &PathResult) -> Option<Picture> {
    let sheet = found.limits.as_ref()?.depth_by_feed.as_ref()?;
    let mm = |values: &[f64]| values.iter().map(to_mm).collect();
    let drawing = ProcessMap {
        title: format!("{name}: depth and feed within the tolerance"),
        subtitle,
        axes: AxisLabels {
            horizontal: "feed per tooth (mm)".to_owned(),
            vertical: "axial depth (mm)".to_owned(),
        },
        quantity: "largest deviation across the tool (µm)".to_owned(),
        horizontal: mm(&sheet.feeds_per_tooth),
        vertical: mm(&sheet.depths),
        deviation_um: sheet.deviations.iter().map(to_um).collect(),
        tolerance_um: to_um(analysis.setting.tolerance),
        drawn: drawn(found),
    };
    Some(Picture {
        name: format!("{}-process", crate::file_names::slug(name)),
        caption: format!(
            "{name}: largest deviation of the program over axial depth and feed per tooth, everything else as in the study."
        ),
        svg: drawing.to_svg(),
    })
}

/// Feed per tooth and depth (mm) where the tool deviates most, if it cuts there.
fn drawn(found: &PathResult) -> Option<[f64; 2]> {
    let PathLoad::Cuts(cuts) = &found.along.load else {
        return None;
    };
    let (worst, _) = found.along.answers.worst()?;
    let cut = cuts.points[worst].cut?;
    Some([to_mm(cut.feed.hypot(cut.rise)), to_mm(cut.depth)])
}
