//! The process of a path or of holes: cut or drill with the values that the study gives, and those that the program gives
//! in their place.

use armill_core::path::{Operation, Pace, SampledPath};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::Subject;
use crate::analysis::path::cut::CutTable;
use crate::analysis::path::drill::DrillTable;
use crate::analysis::path::{LoadSource, PathAnalysis};
use crate::analysis::table::AnalysisTable;
use crate::error::StudyError;
use crate::file::format::StudyFile;
use crate::file::resolve::Study;
use crate::live::StudyText;

/// A cut or a drill: every value is `null` where the study does not give it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ProcessValues {
    /// Its table: `cut`, `program.drill` or `holes.drill`.
    pub key: &'static str,
    /// Whether the table is one of the study, not of the analysis.
    pub whole: bool,
    /// Name of the material.
    pub material: String,
    /// Axial depth of cut.
    pub axial_depth_mm: Option<f64>,
    /// Radial depth of cut.
    pub radial_depth_mm: Option<f64>,
    /// Side of the feed on which the part is.
    pub side: Option<&'static str>,
    /// Feed.
    pub feed_mm_per_min: Option<f64>,
    /// Spindle speed.
    pub spindle_rpm: Option<f64>,
    /// Diameter of the cutter or drill.
    pub diameter_mm: f64,
    /// Number of flutes; of a cutter.
    pub flutes: Option<u32>,
    /// Radius of the corner of a cutter.
    pub corner_radius_mm: Option<f64>,
    /// Key of the table that gives the cutter: `cutter.` or nothing.
    pub cutter_key: &'static str,
    /// Values that are not used, because the program or the stock gives them at every point that cuts.
    pub given_elsewhere: GivenElsewhere,
}

/// What gives a value in place of the table; `null` where the table does.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct GivenElsewhere {
    /// The feed.
    pub feed: Option<&'static str>,
    /// The spindle speed.
    pub spindle: Option<&'static str>,
    /// Both depths.
    pub depths: Option<&'static str>,
    /// The diameter of the cutter.
    pub diameter: Option<&'static str>,
}

/// Those of this analysis of a text, or of its first.
///
/// # Errors
/// Every problem of the text that concerns the analysis; no analysis of that name.
pub fn process_values(
    text: StudyText<'_>,
    analysis: Option<&str>,
) -> Result<Option<ProcessValues>, StudyError> {
    let edited = text.one_analysis(analysis)?;
    Ok(ProcessValues::of(
        &edited.parsed.file,
        &edited.table,
        &edited.study,
    ))
}

impl ProcessValues {
    /// Those of this analysis; none where its load is given otherwise.
    pub(super) fn of(file: &StudyFile, table: &AnalysisTable, study: &Study) -> Option<ProcessValues> {
        let common = file.common();
        let analysis = study.analyses.first().map(|analysis| &analysis.subject);
        let path = match analysis {
            Some(Subject::Path(path)) => Some(&**path),
            Some(Subject::Holes(holes)) => Some(&holes.path),
            _ => None,
        };
        let given_elsewhere = path.map_or_else(GivenElsewhere::default, GivenElsewhere::on);
        match LoadSource::of(&common, table)? {
            LoadSource::Cut(cut) => Some(ProcessValues {
                given_elsewhere,
                ..of_cut(cut, table.cut.is_none())
            }),
            LoadSource::Drill(key, drill) => Some(ProcessValues {
                given_elsewhere,
                ..of_drill(drill, key)
            }),
            LoadSource::Load(_) | LoadSource::Measured(..) => None,
        }
    }
}

fn of_cut(cut: &CutTable, whole: bool) -> ProcessValues {
    ProcessValues {
        key: "cut",
        whole,
        material: cut.material.clone(),
        axial_depth_mm: Some(cut.axial_depth_mm),
        radial_depth_mm: cut.radial_depth_mm,
        side: Some(cut.side.word()),
        feed_mm_per_min: cut.feed_mm_per_min,
        spindle_rpm: cut.spindle_rpm,
        diameter_mm: cut.cutter.diameter_mm,
        flutes: Some(cut.cutter.flutes),
        corner_radius_mm: cut.cutter.corner_radius_mm,
        cutter_key: "cutter.",
        given_elsewhere: GivenElsewhere::default(),
    }
}

fn of_drill(drill: &DrillTable, key: &'static str) -> ProcessValues {
    ProcessValues {
        key,
        whole: false,
        material: drill.material.clone(),
        axial_depth_mm: None,
        radial_depth_mm: None,
        side: None,
        feed_mm_per_min: drill.feed_mm_per_min,
        spindle_rpm: drill.spindle_rpm,
        diameter_mm: drill.diameter_mm,
        flutes: None,
        corner_radius_mm: None,
        cutter_key: "",
        given_elsewhere: GivenElsewhere::default(),
    }
}

impl GivenElsewhere {
    fn on(path: &PathAnalysis) -> GivenElsewhere {
        let points = &path.track.path;
        if cuts(points).next().is_none() {
            return GivenElsewhere::default();
        }
        let program = |given: bool| given.then_some("the program");
        let of_operation = |of: fn(&Operation) -> bool| {
            program(cuts(points).all(|(_, operation)| operation.is_some_and(of)))
        };
        let feed = cuts(points).all(|(pace, _)| matches!(pace, Pace::Feed(feed) if feed > 0.0));
        let depths = of_operation(|operation| operation.depths.is_some());
        GivenElsewhere {
            feed: program(feed),
            spindle: of_operation(|operation| operation.spindle.is_some_and(|speed| speed != 0.0)),
            depths: path.has_stock().then_some("the stock").or(depths),
            diameter: of_operation(|operation| operation.diameter.is_some()),
        }
    }
}

/// The points that no rapid leads to, and their operations.
fn cuts(path: &SampledPath) -> impl Iterator<Item = (Pace, Option<&Operation>)> {
    let points = path.with_operations().filter(|(index, ..)| !path.begins(*index));
    points.map(|(_, point, operation)| (point.pace, operation))
}
