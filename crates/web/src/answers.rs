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

use std::sync::{Arc, OnceLock};

use armill_core::watch::Watch;
use armill_study::live::{
    ChangedValue, LayerRequest, LobesQuestion, PartSurfaceQuestion, PoseRequest, PoseTarget, PostureQuestion,
    StudyText, ViewQuestion, answer_json, body_mesh, measured_csv, mesh_bytes, picture_svg, pictures,
    reachable, scene, spin_map, spin_search, table_csv, values, view,
};
use armill_study::materials::MaterialRow;
use armill_study::robot_answers::library_rows;
use armill_study::{StudyError, output};
use axum::body::Bytes;
use axum::extract::State as Shared;
use axum::http::HeaderMap;
use axum::response::Response;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::body::{JsonBody, check_text};
use crate::error::{Answered, ApiError};
use crate::reply::{JSON, typed};
use crate::state::State;

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

/// The result of `work` on this text, as an answer of this type.
async fn answered<T: Into<axum::body::Body> + Send + 'static>(
    state: Arc<State>,
    (text, headers, kind): (String, HeaderMap, &'static str),
    work: impl FnOnce(StudyText<'_>, Watch<'_>) -> Result<T, StudyError> + Send + 'static,
) -> Answered {
    check_text(&text)?;
    let shared = Arc::clone(&state);
    let bytes = state
        .work
        .done_in_tab(&headers, move |watch| work(shared.cell.text(&text), watch))
        .await?;
    Ok(typed(kind, bytes))
}

fn as_json(value: &impl Serialize) -> Result<Vec<u8>, StudyError> {
    Ok(serde_json::to_vec(value)?)
}

pub(crate) async fn answer(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<AnalysisRequest>,
) -> Answered {
    answered(state, (of.text, headers, JSON), move |text, watch| {
        answer_json(text, of.analysis.as_deref(), watch)
    })
    .await
}

pub(crate) async fn of_view(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<ViewRequest>,
) -> Answered {
    let headers = for_itself(&headers, "view");
    let kept = Arc::clone(&state);
    answered(state, (of.text, headers, JSON), move |text, watch| {
        let question = ViewQuestion {
            analysis: of.analysis.as_deref(),
            changes: &of.changes,
            arm: of.arm.as_ref(),
            levels_um: of.levels_um.as_deref(),
            lines: of.lines,
            layer: of.layer.as_ref(),
            paths: of.columns.then_some(&kept.paths),
        };
        as_json(&view(text, &question, watch)?)
    })
    .await
}

pub(crate) async fn mesh(Shared(state): Shared<Arc<State>>, JsonBody(of): JsonBody<MeshRequest>) -> Answered {
    answered(state, (of.text, HeaderMap::new(), "model/stl"), move |text, _| {
        mesh_bytes(text, &of.file)
    })
    .await
}

pub(crate) async fn mesh_of_body(
    Shared(state): Shared<Arc<State>>,
    JsonBody(of): JsonBody<BodyMeshRequest>,
) -> Answered {
    answered(state, (of.text, HeaderMap::new(), "model/stl"), move |text, _| {
        body_mesh(text, of.analysis.as_deref(), &of.key)
    })
    .await
}

pub(crate) async fn of_values(
    Shared(state): Shared<Arc<State>>,
    JsonBody(of): JsonBody<AnalysisRequest>,
) -> Answered {
    answered(state, (of.text, HeaderMap::new(), JSON), move |text, _| {
        as_json(&values(text, of.analysis.as_deref())?)
    })
    .await
}

pub(crate) async fn pose(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<PosturesRequest>,
) -> Answered {
    let headers = for_itself(&headers, "pose");
    let kept = Arc::clone(&state);
    answered(state, (of.text, headers, JSON), move |text, watch| {
        let question = PostureQuestion {
            analysis: of.analysis.as_deref(),
            at: of.at,
            case: of.case,
        };
        as_json(&kept.paths.postures(text, &question, watch)?)
    })
    .await
}

pub(crate) async fn lobes(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<LobesRequest>,
) -> Answered {
    let headers = for_itself(&headers, "lobes");
    let kept = Arc::clone(&state);
    answered(state, (of.text, headers, JSON), move |text, watch| {
        let question = LobesQuestion {
            analysis: of.analysis.as_deref(),
            at: of.at,
            joints_deg: of.joints_deg,
        };
        as_json(&kept.paths.lobes(text, &question, watch)?)
    })
    .await
}

pub(crate) async fn path_columns(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<PathColumnsRequest>,
) -> Answered {
    let headers = for_itself(&headers, "path-columns");
    let kept = Arc::clone(&state);
    let kind = "application/octet-stream";
    answered(state, (of.text, headers, kind), move |text, watch| {
        kept.paths
            .columns(text, (of.analysis.as_deref(), &of.keys), watch)
    })
    .await
}

pub(crate) async fn part_surface(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<PartSurfaceRequest>,
) -> Answered {
    let headers = for_itself(&headers, "part-surface");
    let kept = Arc::clone(&state);
    let kind = "application/octet-stream";
    answered(state, (of.text, headers, kind), move |text, watch| {
        let question = PartSurfaceQuestion {
            analysis: of.analysis.as_deref(),
            frame: of.frame,
            frames: of.frames,
        };
        kept.parts.surface(text, &question, &kept.paths, watch)
    })
    .await
}

pub(crate) async fn of_reachable(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<AnalysisRequest>,
) -> Answered {
    let headers = for_itself(&headers, "reachable");
    answered(state, (of.text, headers, JSON), move |text, watch| {
        as_json(&reachable(text, of.analysis.as_deref(), watch)?)
    })
    .await
}

pub(crate) async fn of_spin_map(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<AnalysisRequest>,
) -> Answered {
    let headers = for_itself(&headers, "spin-map");
    answered(state, (of.text, headers, JSON), move |text, watch| {
        as_json(&spin_map(text, of.analysis.as_deref(), watch)?)
    })
    .await
}

pub(crate) async fn of_spin_search(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<AnalysisRequest>,
) -> Answered {
    let headers = for_itself(&headers, "spin-search");
    answered(state, (of.text, headers, JSON), move |text, watch| {
        as_json(&spin_search(text, of.analysis.as_deref(), watch)?)
    })
    .await
}

pub(crate) async fn of_scene(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<AnalysisRequest>,
) -> Answered {
    let headers = for_itself(&headers, "scene");
    answered(state, (of.text, headers, JSON), move |text, watch| {
        as_json(&scene(text, of.analysis.as_deref(), watch)?)
    })
    .await
}

pub(crate) async fn table(
    Shared(state): Shared<Arc<State>>,
    JsonBody(of): JsonBody<TableRequest>,
) -> Answered {
    let TableFormat::Csv = of.format;
    answered(
        state,
        (of.text, HeaderMap::new(), "text/csv; charset=utf-8"),
        move |text, watch| match of.measured {
            true => measured_csv(text, watch),
            false => table_csv(text, of.analysis.as_deref(), watch),
        },
    )
    .await
}

pub(crate) async fn of_pictures(
    Shared(state): Shared<Arc<State>>,
    headers: HeaderMap,
    JsonBody(of): JsonBody<AnalysisRequest>,
) -> Answered {
    let headers = for_itself(&headers, "pictures");
    answered(state, (of.text, headers, JSON), move |text, watch| {
        as_json(&pictures(text, of.analysis.as_deref(), watch)?)
    })
    .await
}

pub(crate) async fn picture_png(
    Shared(state): Shared<Arc<State>>,
    JsonBody(of): JsonBody<PictureRequest>,
) -> Answered {
    answered(
        state,
        (of.text, HeaderMap::new(), "image/png"),
        move |text, watch| output::png(&picture_svg(text, of.analysis.as_deref(), &of.name, watch)?),
    )
    .await
}

/// The libraries are built in: their lists are made once.
static ROBOTS: OnceLock<Bytes> = OnceLock::new();
static MATERIALS: OnceLock<Bytes> = OnceLock::new();

pub(crate) async fn robots(Shared(state): Shared<Arc<State>>) -> Result<Response, ApiError> {
    made_once(&ROBOTS, &state, || as_json(&library_rows()?)).await
}

pub(crate) async fn materials(Shared(state): Shared<Arc<State>>) -> Result<Response, ApiError> {
    made_once(&MATERIALS, &state, || as_json(&MaterialRow::all()?)).await
}

async fn made_once(
    kept: &OnceLock<Bytes>,
    state: &State,
    make: fn() -> Result<Vec<u8>, StudyError>,
) -> Result<Response, ApiError> {
    let bytes = match kept.get() {
        Some(bytes) => bytes.clone(),
        None => {
            let made = state.work.done(move |_| make()).await?;
            kept.get_or_init(|| made.into()).clone()
        }
    };
    Ok(typed(JSON, bytes))
}

/// The headers of a request that replaces only those of its own kind in the tab.
fn for_itself(headers: &HeaderMap, kind: &str) -> HeaderMap {
    let mut own = HeaderMap::new();
    let name = headers.get("x-tab").and_then(|name| name.to_str().ok());
    let name = name.and_then(|name| format!("{kind}:{name}").parse().ok());
    own.extend(name.map(|name| (axum::http::HeaderName::from_static("x-tab"), name)));
    own
}
