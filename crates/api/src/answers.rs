//! Answers to a text that is sent: the study on disk is neither read nor written.
//!
//! | path | answers |
//! |---|---|
//! | `POST /api/answer` | as `armill run --json` of one analysis, or of all |
//! | `POST /api/view` | answer, values, scene, colours and lines of an analysis and the arm in it at once, after values are changed |
//! | `POST /api/values` | the settings that an analysis resolves to |
//! | `POST /api/pose` | the arm at one place of an analysis |
//! | `POST /api/path-columns` | columns of the points of a path, as numbers of 4 bytes |
//! | `POST /api/part-surface` | the surface of a machined part, finished or in process, as numbers of 4 bytes |
//! | `POST /api/scene` | the geometry of an analysis for drawing |
//! | `POST /api/reachable` | the nearest placement that the robot reaches |
//! | `POST /api/spin-map` | a path over its length and the spin of the tool |
//! | `POST /api/spin-search` | the spins that a search finds |
//! | `POST /api/mesh` | the shape of a link, where the robot's file names one |
//! | `POST /api/body-mesh` | the mesh of a body of the cell |
//! | `POST /api/table` | the table of an analysis |
//! | `POST /api/pictures`, `POST /api/picture.png` | its pictures, and one in pixels |
//! | `GET /api/robots` | as `armill robots --json` |
//! | `GET /api/materials` | as `armill materials --json` |

use std::sync::OnceLock;

use armill_core::watch::Watch;
use armill_study::live::{
    ChangedValue, LayerRequest, LobesAnswer, LobesQuestion, PartSurfaceQuestion, PicturesAnswer, PoseRequest,
    PoseTarget, PostureQuestion, PosturesAnswer, ReachableAnswer, SceneAnswer, SpinMapAnswer,
    SpinSearchAnswer, StudyText, ValuesAnswer, ViewAnswer, ViewQuestion, answer_json, body_mesh,
    measured_csv, mesh_bytes, table_csv,
};
use armill_study::materials::MaterialRow;
use armill_study::robot_answers::library_rows;
use armill_study::{StudyError, live};
#[cfg(feature = "png")]
use armill_study::{live::picture_svg, output};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::context::Context;
use crate::error::ApiError;
use crate::study::check_text;

/// An analysis of a text.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AnalysisRequest {
    /// The text of the study.
    pub text: String,
    /// Name of its analysis; all of them, or the first, if left out.
    pub analysis: Option<String>,
}

/// An analysis of a text in which values are changed first.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ViewRequest {
    /// The text of the study.
    pub text: String,
    /// Name of its analysis, whose values are changed; the first if left out.
    pub analysis: Option<String>,
    /// The changes; none if left out.
    #[serde(default)]
    pub changes: Vec<ChangedValue>,
    /// The requested pose of the arm; none if left out.
    pub arm: Option<PoseRequest>,
    /// The levels of a fixed colour scale, rising; chosen for the deviations if left out.
    pub levels_um: Option<Vec<f64>>,
    /// Whether maps have lines of equal deviation at these levels, in addition to those at the tolerance.
    #[serde(default)]
    pub lines: bool,
    /// The quantity that colours show; the in-plane deviation, which is in the answer, if left out.
    pub layer: Option<LayerRequest>,
    /// Whether the points of a path are left out, to be requested as columns.
    #[serde(default)]
    pub columns: bool,
}

/// Columns of a path.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PathColumnsRequest {
    /// The text of the study.
    pub text: String,
    /// Name of its analysis; the first if left out.
    pub analysis: Option<String>,
    /// The keys of the columns.
    pub keys: Vec<String>,
}

/// The surface of the machined part of a path.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PartSurfaceRequest {
    /// The text of the study.
    pub text: String,
    /// Name of its analysis; the first if left out.
    pub analysis: Option<String>,
    /// Which of the frames, from 0 (the stock) to `frames` (the finished part with its deviations).
    pub frame: usize,
    /// In how many frames the path is divided evenly by its points.
    pub frames: usize,
}

/// A shape of the robot.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeshRequest {
    /// The text of the study.
    pub text: String,
    /// The file, as the robot's file names it.
    pub file: String,
}

/// The mesh of a body of the cell.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct BodyMeshRequest {
    /// The text of the study.
    pub text: String,
    /// Name of its analysis; the first if left out.
    pub analysis: Option<String>,
    /// The key of the mesh, from the scene.
    pub key: String,
}

/// A place of an analysis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PosturesRequest {
    /// The text of the study.
    pub text: String,
    /// Name of its analysis; the first if left out.
    pub analysis: Option<String>,
    /// The target position of the tool.
    pub at: PoseTarget,
    /// Load case, from 1.
    #[serde(default = "first")]
    pub case: usize,
}

fn first() -> usize {
    1
}

/// A place of an analysis, and a posture there.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LobesRequest {
    /// The text of the study.
    pub text: String,
    /// Name of its analysis; the first if left out.
    pub analysis: Option<String>,
    /// The target position of the tool.
    pub at: PoseTarget,
    /// The posture of the arm: joint positions in the convention of the robot file, mm for prismatic joints.
    pub joints_deg: Vec<f64>,
}

/// The table of an analysis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TableRequest {
    /// The text of the study.
    pub text: String,
    /// Name of its analysis; the first if left out.
    pub analysis: Option<String>,
    /// Its format.
    #[serde(default)]
    pub format: TableFormat,
    /// Instead, the table of the error budget of the measurements.
    #[serde(default)]
    pub measured: bool,
}

/// Formats of a table.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum TableFormat {
    /// Comma-separated values.
    #[default]
    Csv,
}

/// One picture of an analysis.
#[cfg(feature = "png")]
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PictureRequest {
    /// The text of the study.
    pub text: String,
    /// Name of its analysis; all of them if left out.
    pub analysis: Option<String>,
    /// The name of the picture.
    pub name: String,
}

/// The text of a request as a study of the folder.
///
/// # Errors
/// A text longer than any study.
fn study<'a>(context: &'a Context, text: &'a str) -> Result<StudyText<'a>, ApiError> {
    check_text(text)?;
    Ok(context.cell.text(text))
}

pub(crate) fn answer(context: &Context, of: AnalysisRequest, watch: Watch<'_>) -> Result<Vec<u8>, ApiError> {
    let json = answer_json(study(context, &of.text)?, of.analysis.as_deref(), watch)?;
    Ok(json.into_bytes())
}

pub(crate) fn view(context: &Context, of: ViewRequest, watch: Watch<'_>) -> Result<ViewAnswer, ApiError> {
    let question = ViewQuestion {
        analysis: of.analysis.as_deref(),
        changes: &of.changes,
        arm: of.arm.as_ref(),
        levels_um: of.levels_um.as_deref(),
        lines: of.lines,
        layer: of.layer.as_ref(),
        paths: of.columns.then_some(&context.paths),
    };
    Ok(live::view(study(context, &of.text)?, &question, watch)?)
}

pub(crate) fn mesh(context: &Context, of: MeshRequest, _: Watch<'_>) -> Result<Vec<u8>, ApiError> {
    Ok(mesh_bytes(study(context, &of.text)?, &of.file)?)
}

pub(crate) fn mesh_of_body(
    context: &Context,
    of: BodyMeshRequest,
    _: Watch<'_>,
) -> Result<Vec<u8>, ApiError> {
    Ok(body_mesh(
        study(context, &of.text)?,
        of.analysis.as_deref(),
        &of.key,
    )?)
}

pub(crate) fn values(context: &Context, of: AnalysisRequest, _: Watch<'_>) -> Result<ValuesAnswer, ApiError> {
    Ok(live::values(study(context, &of.text)?, of.analysis.as_deref())?)
}

pub(crate) fn pose(
    context: &Context,
    of: PosturesRequest,
    watch: Watch<'_>,
) -> Result<PosturesAnswer, ApiError> {
    let question = PostureQuestion {
        analysis: of.analysis.as_deref(),
        at: of.at,
        case: of.case,
    };
    Ok(context
        .paths
        .postures(study(context, &of.text)?, &question, watch)?)
}

pub(crate) fn lobes(context: &Context, of: LobesRequest, watch: Watch<'_>) -> Result<LobesAnswer, ApiError> {
    let question = LobesQuestion {
        analysis: of.analysis.as_deref(),
        at: of.at,
        joints_deg: of.joints_deg,
    };
    Ok(context.paths.lobes(study(context, &of.text)?, &question, watch)?)
}

pub(crate) fn path_columns(
    context: &Context,
    of: PathColumnsRequest,
    watch: Watch<'_>,
) -> Result<Vec<u8>, ApiError> {
    let text = study(context, &of.text)?;
    Ok(context
        .paths
        .columns(text, (of.analysis.as_deref(), &of.keys), watch)?)
}

pub(crate) fn part_surface(
    context: &Context,
    of: PartSurfaceRequest,
    watch: Watch<'_>,
) -> Result<Vec<u8>, ApiError> {
    let question = PartSurfaceQuestion {
        analysis: of.analysis.as_deref(),
        frame: of.frame,
        frames: of.frames,
    };
    let text = study(context, &of.text)?;
    Ok(context.parts.surface(text, &question, &context.paths, watch)?)
}

pub(crate) fn reachable(
    context: &Context,
    of: AnalysisRequest,
    watch: Watch<'_>,
) -> Result<ReachableAnswer, ApiError> {
    Ok(live::reachable(
        study(context, &of.text)?,
        of.analysis.as_deref(),
        watch,
    )?)
}

pub(crate) fn spin_map(
    context: &Context,
    of: AnalysisRequest,
    watch: Watch<'_>,
) -> Result<SpinMapAnswer, ApiError> {
    Ok(live::spin_map(
        study(context, &of.text)?,
        of.analysis.as_deref(),
        watch,
    )?)
}

pub(crate) fn spin_search(
    context: &Context,
    of: AnalysisRequest,
    watch: Watch<'_>,
) -> Result<SpinSearchAnswer, ApiError> {
    Ok(live::spin_search(
        study(context, &of.text)?,
        of.analysis.as_deref(),
        watch,
    )?)
}

pub(crate) fn scene(
    context: &Context,
    of: AnalysisRequest,
    watch: Watch<'_>,
) -> Result<SceneAnswer, ApiError> {
    Ok(live::scene(
        study(context, &of.text)?,
        of.analysis.as_deref(),
        watch,
    )?)
}

pub(crate) fn table(context: &Context, of: TableRequest, watch: Watch<'_>) -> Result<Vec<u8>, ApiError> {
    let TableFormat::Csv = of.format;
    let text = study(context, &of.text)?;
    let csv = match of.measured {
        true => measured_csv(text, watch)?,
        false => table_csv(text, of.analysis.as_deref(), watch)?,
    };
    Ok(csv)
}

pub(crate) fn pictures(
    context: &Context,
    of: AnalysisRequest,
    watch: Watch<'_>,
) -> Result<PicturesAnswer, ApiError> {
    Ok(live::pictures(
        study(context, &of.text)?,
        of.analysis.as_deref(),
        watch,
    )?)
}

#[cfg(feature = "png")]
pub(crate) fn picture_png(
    context: &Context,
    of: PictureRequest,
    watch: Watch<'_>,
) -> Result<Vec<u8>, ApiError> {
    let svg = picture_svg(study(context, &of.text)?, of.analysis.as_deref(), &of.name, watch)?;
    Ok(output::png(&svg)?)
}

/// The libraries are built in: their lists are made once.
static ROBOTS: OnceLock<Vec<u8>> = OnceLock::new();
static MATERIALS: OnceLock<Vec<u8>> = OnceLock::new();

pub(crate) fn robots() -> Result<Vec<u8>, ApiError> {
    made_once(&ROBOTS, || Ok(serde_json::to_vec(&library_rows()?)?))
}

pub(crate) fn materials() -> Result<Vec<u8>, ApiError> {
    made_once(&MATERIALS, || Ok(serde_json::to_vec(&MaterialRow::all()?)?))
}

fn made_once(
    kept: &OnceLock<Vec<u8>>,
    make: impl FnOnce() -> Result<Vec<u8>, StudyError>,
) -> Result<Vec<u8>, ApiError> {
    match kept.get() {
        Some(bytes) => Ok(bytes.clone()),
        None => Ok(kept
            .get_or_init({
                let made = make()?;
                || made
            })
            .clone()),
    }
}
