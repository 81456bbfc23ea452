//! The parts of an analysis that can be drawn in space: everything in base, mm.
//!
//! A map is drawn on its plate with the numbers of the answer's grid; along a path, at holes and in a box the points
//! come with theirs.

use armill_core::map::BoxGrid;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::units::{from_mm, to_mm, to_um};
use armill_core::watch::Watch;
use armill_formats::table::ColumnData;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

use crate::analysis::resolve::plane_of;
use crate::analysis::{AnalysisData, AnalysisResult, Sheet, Subject};
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::input::setting::Setting;
use crate::input::tables::{HalfSize, PlaneTable};
use crate::live::bodies::{BodyPose, CellInScene, cell_in_scene, pose_of_part};
use crate::live::posture::axes;
use crate::live::{EditedAnalysis, StudyText};
use crate::number::{decimals, without_rounding};
use crate::output;
use crate::run::run_without_parts;

/// The parts of one analysis that can be drawn, base.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SceneAnswer {
    /// Name of the robot.
    pub robot: String,
    /// The reference frame of coordinates.
    pub base_mm: [f64; 3],
    /// Its axes x, y, z, base.
    // unit: directions, length 1
    pub base_axes: [[f64; 3]; 3],
    /// The plane; of sections the first.
    pub plate: PlateInScene,
    /// Sections: each with its plane.
    pub sections: Vec<SectionInScene>,
    /// Points of a path, of holes or of a box.
    pub points: Option<PointsInScene>,
    /// The box of a volume.
    #[serde(rename = "box")]
    pub in_box: Option<BoxInScene>,
    /// The bodies of its cell; `null` without any.
    pub cell: Option<CellInScene>,
}

/// A plane with its sides.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PlateInScene {
    /// Its corners, in order round it: least y' and z', greatest y', greatest both, greatest z'.
    pub corners_mm: [[f64; 3]; 4],
    /// Outward normal.
    pub normal_axis: [f64; 3],
    /// Axis y'.
    pub y_axis: [f64; 3],
    /// Axis z'.
    pub z_axis: [f64; 3],
    /// Origin of y' and z'.
    pub centre_mm: [f64; 3],
}

/// One of several planes.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SectionInScene {
    /// Its label.
    pub label: String,
    /// Its plane.
    pub plate: PlateInScene,
    /// Where the part is that the cell has; `null` without one.
    pub part: Option<BodyPose>,
}

/// Points with some columns of their table: each column has as many values as there are points, `null` if one has none.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PointsInScene {
    /// Where they are.
    pub xyz_mm: Vec<[f64; 3]>,
    /// Deviation under the worst case, base.
    pub deviation_um: Vec<Option<[f64; 3]>>,
    /// Points with a posture outside joint limits, from 0.
    pub outside_joint_limits: Vec<usize>,
    /// `state`, `branch`, `in_plane_um`, `normal_um`, `full_um`, of a path `along_um`, `cross_um`, `axial_um`, `line`,
    /// `distance_mm` and `turn_deg`: see the table of the analysis.
    pub columns: Map<String, Value>,
}

/// A box.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BoxInScene {
    /// Its corner with the least coordinates.
    pub corner_mm: [f64; 3],
    /// Its sides from there.
    pub sides_mm: [[f64; 3]; 3],
    /// Points along each side.
    pub counts: [usize; 3],
}

/// The columns that are drawn, if the table of the analysis has them.
const COLUMNS: [&str; 12] = [
    "state",
    "branch",
    "in_plane_um",
    "normal_um",
    "full_um",
    "along_um",
    "cross_um",
    "axial_um",
    "line",
    "hole",
    "distance_mm",
    "turn_deg",
];

/// What can be drawn of this analysis, or of the first; a path, holes or a box are evaluated for it.
///
/// # Errors
/// Every problem of the text that concerns the analysis; no analysis of that name; cancelled by the watch.
pub fn scene(
    text: StudyText<'_>,
    analysis: Option<&str>,
    watch: Watch<'_>,
) -> Result<SceneAnswer, StudyError> {
    let edited = text.one_analysis(analysis)?;
    let done = match has_points(&edited.study) {
        true => run_without_parts(&edited.study, watch)?,
        false => Vec::new(),
    };
    scene_of(&edited, &done)
}

/// Whether the points of the only analysis of this study are drawn one by one.
fn has_points(study: &Study) -> bool {
    let subject = study.analyses.first().map(|analysis| &analysis.subject);
    !matches!(subject, Some(Subject::Map(_) | Subject::Sections(_)))
}

/// What can be drawn of this analysis, and of its result if it has points.
pub(super) fn scene_of(
    edited: &EditedAnalysis<'_>,
    done: &[AnalysisResult<'_>],
) -> Result<SceneAnswer, StudyError> {
    let study = &edited.study;
    let plane = plane_of(&edited.parsed.file.plane, &edited.table);
    let setting = edited.setting(0)?;
    let (mut sections, mut in_box) = (Vec::new(), None);
    let of_sheet = |sheet: &Sheet| {
        let half = |count: usize| 0.5 * (count as f64 - 1.0) * sheet.grid.step;
        PlateInScene::of(&sheet.setting, [half(sheet.grid.columns), half(sheet.grid.rows)])
    };
    let mut plate = PlateInScene::of(setting, half_of(&plane));
    match &study.analyses[0].subject {
        Subject::Map(sheet) => plate = of_sheet(sheet),
        Subject::Sections(all) => {
            let section = |(label, sheet): &(String, Sheet)| SectionInScene {
                label: label.clone(),
                plate: of_sheet(sheet),
                part: sheet.setting.cell.as_ref().and_then(pose_of_part),
            };
            sections = all.iter().map(section).collect();
        }
        Subject::Volume(_, grid) => in_box = Some(BoxInScene::of(grid)),
        Subject::Path(_) | Subject::Holes(_) => {}
    }
    let points = match done.first().filter(|_| has_points(study)) {
        Some(done) => Some(points(study, done)?),
        None => None,
    };
    Ok(SceneAnswer {
        robot: study.robot.robot.name().to_owned(),
        base_mm: mm(&setting.base_from_reference.translation.vector),
        base_axes: axes(&setting.base_from_reference.rotation.to_rotation_matrix()),
        plate,
        sections,
        points,
        in_box,
        cell: setting.cell.as_ref().map(cell_in_scene),
    })
}

/// Half the sides of a plane, m.
pub(super) fn half_of(plane: &PlaneTable) -> [f64; 2] {
    match plane.half_size_mm {
        HalfSize::Square(half) => [from_mm(half); 2],
        HalfSize::Oblong(halves) => halves.map(from_mm),
    }
}

impl PlateInScene {
    /// The plane of this setting with half its sides (m) along y' and z'.
    pub(super) fn of(setting: &Setting, [y, z]: [f64; 2]) -> PlateInScene {
        let base_from_part = setting.plane.base_from_part;
        // y' is opposite to x of the part.
        let corner =
            |along: f64, up: f64| mm(&(base_from_part * Point3::new(-along * y, up * z, 0.0)).coords);
        PlateInScene {
            corners_mm: [
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ],
            normal_axis: clean(setting.plane.normal().into_inner()),
            y_axis: clean(base_from_part * -Vector3::x()),
            z_axis: clean(base_from_part * Vector3::y()),
            centre_mm: mm(&base_from_part.translation.vector),
        }
    }
}

impl BoxInScene {
    fn of(grid: &BoxGrid) -> BoxInScene {
        let side = |axis: Vector3<f64>, count: usize| {
            mm(&(grid.base_from_box * axis * ((count as f64 - 1.0) * grid.step)))
        };
        let [x, y, z] = grid.counts;
        BoxInScene {
            corner_mm: mm(&grid.corner().coords),
            sides_mm: [
                side(Vector3::x(), x),
                side(Vector3::y(), y),
                side(Vector3::z(), z),
            ],
            counts: grid.counts,
        }
    }
}

/// The points of the result, with the drawn columns of their table.
fn points(study: &Study, done: &AnalysisResult<'_>) -> Result<PointsInScene, StudyError> {
    let (setting, answers) = match &done.found {
        AnalysisData::Volume(setting, volume) => (*setting, &volume.answers),
        AnalysisData::Path(analysis, found) => (&analysis.setting, &found.along.answers),
        AnalysisData::Holes(analysis, found) => (&analysis.path.setting, &found.answers),
        AnalysisData::Map(..) | AnalysisData::Sections(_) => {
            return Err(StudyError::value(
                "the points of a map are in the answer",
                "request the answer",
            ));
        }
    };
    let table = output::points_table(study, done)?;
    let place = |name: &str| match table.columns().iter().find(|column| column.name == name) {
        Some(armill_formats::table::Column {
            data: ColumnData::Float(values),
            ..
        }) => values.as_slice(),
        _ => &[],
    };
    let counted = place("x_mm").iter().zip(place("y_mm")).zip(place("z_mm"));
    let in_base = counted
        .map(|((x, y), z)| mm(&(setting.base_from_reference * (from_mm(Point3::new(*x, *y, *z)))).coords));
    let deviation = |index: usize| {
        let evaluation = answers.points[index].as_ref().ok()?;
        let deviation = answers.deviations_at(index)[evaluation.worst_case];
        Some(deviation.map(|m| decimals(to_um(m), 3)).into())
    };
    let drawn = table
        .columns()
        .iter()
        .filter(|column| COLUMNS.contains(&column.name.as_str()));
    Ok(PointsInScene {
        xyz_mm: in_base.collect(),
        deviation_um: (0..answers.points.len()).map(deviation).collect(),
        outside_joint_limits: answers
            .evaluations()
            .filter(|(_, evaluation)| !evaluation.within_limits())
            .map(|(index, _)| index)
            .collect(),
        columns: drawn
            .map(|column| (column.name.clone(), column_values(&column.data)))
            .collect(),
    })
}

/// The values of a column, one a point.
fn column_values(data: &ColumnData) -> Value {
    match data {
        ColumnData::Float(values) => values.iter().copied().map(number).collect(),
        ColumnData::OptionalFloat(values) => {
            let values = values.iter().copied();
            values.map(|value| value.map_or(Value::Null, number)).collect()
        }
        ColumnData::Category { codes, labels } => {
            let word = |code: &u32| labels.get(*code as usize).filter(|word| !word.is_empty());
            codes
                .iter()
                .map(|code| word(code).cloned().map_or(Value::Null, Value::from))
                .collect()
        }
        ColumnData::Integer(values) => values.iter().copied().collect(),
        ColumnData::OptionalInteger(values) => values.iter().copied().map(Value::from).collect(),
        ColumnData::Flag(values) => values.iter().copied().collect(),
        ColumnData::Text(values) => values.iter().map(String::as_str).collect(),
    }
}

/// A number to a nanometre.
fn number(value: f64) -> Value {
    Value::from(decimals(value, 6))
}

/// Metres as mm, without the rounding of frame changes.
fn mm(v: &Vector3<f64>) -> [f64; 3] {
    clean(to_mm(v))
}

fn clean(v: Vector3<f64>) -> [f64; 3] {
    v.map(without_rounding).into()
}
