//! All paths under `/api`: for each the handler that answers it, and its description.
//!
//! To add a path: a handler in the file of its subject, and a row in [`operations`].

use std::sync::{Arc, LazyLock};

use armill_study::answer::StudyAnswer;
use armill_study::live::{
    ChangedAnswer, LobesAnswer, OutlineAnswer, PicturesAnswer, PosturesAnswer, ReachableAnswer, SceneAnswer,
    SpinMapAnswer, SpinSearchAnswer, TablesAnswer, ValuesAnswer, ViewAnswer,
};
use armill_study::materials::MaterialRow;
use armill_study::robot_answers::RobotRow;
use axum::Router;
use axum::body::Bytes;
use axum::http::StatusCode;
use axum::response::Response;
use serde_json::Value;

use crate::answers::{
    AnalysisRequest, BodyMeshRequest, LobesRequest, MeshRequest, PartSurfaceRequest, PathColumnsRequest,
    PictureRequest, PosturesRequest, TableRequest, ViewRequest,
};
use crate::files::{Files, TicketAnswer, TicketRequest, UploadedFile};
use crate::job::JobAnswer;
use crate::jobs::{JobBegun, JobList};
use crate::openapi::{DELETE, GET, Operation, POST, PUT, describe};
use crate::reply::{JSON, typed};
use crate::state::State;
use crate::study::{ChangeRequest, CheckRequest, StudyOnDisk, StudyUpdate, StudyVersion};
use crate::task::Task;
use crate::{answers, error, files, jobs, study};

/// Every path, in the order of the files that answer them.
fn operations() -> Vec<Operation> {
    vec![
        Operation::new(GET, "/study", "The study on disk", study::read).answers::<StudyOnDisk>(),
        Operation::new(PUT, "/study", "Writes the study", study::write)
            .takes::<StudyUpdate>()
            .answers::<StudyOnDisk>(),
        Operation::new(GET, "/study/version", "The state of its file", study::version)
            .answers::<StudyVersion>(),
        Operation::new(POST, "/check", "What is in a text", study::check)
            .takes::<CheckRequest>()
            .answers::<OutlineAnswer>(),
        Operation::new(POST, "/change", "A text with values changed", study::change)
            .takes::<ChangeRequest>()
            .answers::<ChangedAnswer>(),
        Operation::new(
            POST,
            "/tables",
            "The values of a text, each with its place",
            study::of_tables,
        )
        .takes::<CheckRequest>()
        .answers::<TablesAnswer>(),
        Operation::new(GET, "/schema", "JSON schema of a study", study::schema),
        Operation::new(
            POST,
            "/view",
            "Answer, values and scene of an analysis after values are changed",
            answers::of_view,
        )
        .takes::<ViewRequest>()
        .answers::<ViewAnswer>(),
        Operation::new(POST, "/mesh", "A shape of the robot", answers::mesh)
            .takes::<MeshRequest>()
            .sends("model/stl"),
        Operation::new(
            POST,
            "/body-mesh",
            "The mesh of a body of the cell",
            answers::mesh_of_body,
        )
        .takes::<BodyMeshRequest>()
        .sends("model/stl"),
        Operation::new(POST, "/answer", "The answer to an analysis", answers::answer)
            .takes::<AnalysisRequest>()
            .answers::<StudyAnswer>(),
        Operation::new(POST, "/values", "The settings of an analysis", answers::of_values)
            .takes::<AnalysisRequest>()
            .answers::<ValuesAnswer>(),
        Operation::new(POST, "/pose", "The arm at one place", answers::pose)
            .takes::<PosturesRequest>()
            .answers::<PosturesAnswer>(),
        Operation::new(
            POST,
            "/lobes",
            "The stability of the cut at one place",
            answers::lobes,
        )
        .takes::<LobesRequest>()
        .answers::<LobesAnswer>(),
        Operation::new(
            POST,
            "/path-columns",
            "Columns of a path as numbers of 4 bytes, little-endian",
            answers::path_columns,
        )
        .takes::<PathColumnsRequest>()
        .sends("application/octet-stream"),
        Operation::new(
            POST,
            "/part-surface",
            "The surface of the machined part of a path: a header and numbers of 4 bytes, little-endian",
            answers::part_surface,
        )
        .takes::<PartSurfaceRequest>()
        .sends("application/octet-stream"),
        Operation::new(
            POST,
            "/reachable",
            "The nearest placement that the robot reaches",
            answers::of_reachable,
        )
        .takes::<AnalysisRequest>()
        .answers::<ReachableAnswer>(),
        Operation::new(
            POST,
            "/spin-map",
            "A path over its length and the spin of the tool",
            answers::of_spin_map,
        )
        .takes::<AnalysisRequest>()
        .answers::<SpinMapAnswer>(),
        Operation::new(
            POST,
            "/spin-search",
            "The spins that a search finds along a path",
            answers::of_spin_search,
        )
        .takes::<AnalysisRequest>()
        .answers::<SpinSearchAnswer>(),
        Operation::new(
            POST,
            "/scene",
            "The geometry of an analysis for drawing",
            answers::of_scene,
        )
        .takes::<AnalysisRequest>()
        .answers::<SceneAnswer>(),
        Operation::new(POST, "/table", "The table of an analysis", answers::table)
            .takes::<TableRequest>()
            .sends("text/csv"),
        Operation::new(
            POST,
            "/pictures",
            "The pictures of an analysis",
            answers::of_pictures,
        )
        .takes::<AnalysisRequest>()
        .answers::<PicturesAnswer>(),
        Operation::new(POST, "/picture.png", "A picture in pixels", answers::picture_png)
            .takes::<PictureRequest>()
            .sends("image/png"),
        Operation::new(GET, "/robots", "The robot library", answers::robots).answers::<Vec<RobotRow>>(),
        Operation::new(GET, "/materials", "The material library", answers::materials)
            .answers::<Vec<MaterialRow>>(),
        Operation::new(POST, "/jobs", "Begins a job", jobs::begin)
            .takes::<Task>()
            .answers::<JobBegun>()
            .with(StatusCode::ACCEPTED),
        Operation::new(GET, "/jobs", "All jobs", jobs::list).answers::<JobList>(),
        Operation::new(GET, "/jobs/{id}", "One job with its answer", jobs::one).answers::<JobAnswer>(),
        Operation::new(DELETE, "/jobs/{id}", "Cancels a job", jobs::cancel).answers::<JobAnswer>(),
        Operation::new(
            GET,
            "/jobs/{id}/events",
            "Progress of a job: events `job`",
            jobs::events,
        )
        .sends("text/event-stream"),
        Operation::new(GET, "/files", "Files of the folder", files::list).answers::<Files>(),
        Operation::new(GET, "/files/{*path}", "One file", files::read).sends("application/octet-stream"),
        Operation::new(PUT, "/files/{*path}", "Uploads a file", files::take)
            .answers::<UploadedFile>()
            .with(StatusCode::CREATED),
        Operation::new(
            POST,
            "/tickets",
            "An address that opens one file once",
            files::ticket,
        )
        .takes::<TicketRequest>()
        .answers::<TicketAnswer>(),
        Operation::new(GET, "/openapi.json", "This document", openapi),
    ]
}

/// The handlers of all paths.
pub(crate) fn router() -> Router<Arc<State>> {
    let add =
        |router: Router<Arc<State>>, operation: Operation| router.route(operation.path, operation.handler);
    let paths = operations().into_iter().fold(Router::new(), add);
    paths
        .fallback(error::no_such_path)
        .method_not_allowed_fallback(error::wrong_method)
}

/// The description of all paths for programs, OpenAPI 3.1.
pub fn document() -> Value {
    describe(&operations())
}

/// The document as it is sent: made once.
static DOCUMENT: LazyLock<Bytes> = LazyLock::new(|| document().to_string().into());

async fn openapi() -> Response {
    typed(JSON, DOCUMENT.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every `$ref` below `value`.
    fn references(value: &Value, found: &mut Vec<String>) {
        match value {
            Value::Object(fields) => {
                if let Some(Value::String(to)) = fields.get("$ref") {
                    found.push(to.clone());
                }
                fields.values().for_each(|value| references(value, found));
            }
            Value::Array(entries) => entries.iter().for_each(|value| references(value, found)),
            _ => {}
        }
    }

    #[test]
    fn every_reference_leads_to_a_schema() {
        let document = document();
        let mut found = Vec::new();
        references(&document, &mut found);
        assert!(found.len() > 50);
        for to in found {
            let there = document.pointer(to.strip_prefix('#').unwrap());
            assert!(there.is_some(), "{to}");
        }
    }

    #[test]
    fn an_answer_always_has_all_its_fields() {
        let document = document();
        let map = &document["components"]["schemas"]["MapAnswer"];
        let required: Vec<&str> = map["required"]
            .as_array()
            .unwrap()
            .iter()
            .filter_map(Value::as_str)
            .collect();
        assert!(
            required.contains(&"worst") && required.contains(&"grid"),
            "{required:?}"
        );
    }
}
