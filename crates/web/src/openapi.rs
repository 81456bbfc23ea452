//! The description of everything under `/api` for programs: OpenAPI 3.1, its schemas made from the types themselves.
//!
//! The page's own types come from it, so that none is typed by hand.

use std::sync::{Arc, LazyLock};

use armill_study::answer::StudyAnswer;
use armill_study::live::{
    ChangedAnswer, OutlineAnswer, PicturesAnswer, PosturesAnswer, SceneAnswer, TablesAnswer, ValuesAnswer,
    ViewAnswer,
};
use armill_study::robot_answers::RobotRow;
use axum::Router;
use axum::body::Bytes;
use axum::response::Response;
use axum::routing::get;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

use crate::answers::{
    AnalysisRequest, MeshRequest, PictureRequest, PosturesRequest, TableRequest, ViewRequest,
};
use crate::error::ErrorBody;
use crate::files::{Files, UploadedFile};
use crate::job::JobAnswer;
use crate::jobs::{JobBegun, JobList};
use crate::server::State;
use crate::study::{ChangeRequest, CheckRequest, StudyOnDisk, StudyUpdate};
use crate::task::Task;

/// Where schemas are in the document.
const SCHEMAS: &str = "/components/schemas";

/// One path with one method.
struct Operation {
    method: &'static str,
    path: &'static str,
    /// What it does.
    about: &'static str,
    requested: Option<Value>,
    /// Status of success, its type and its schema.
    answered: (u16, &'static str, Value),
}

/// Schemas of requests and of answers; they differ in which fields may be left out.
struct Schemas {
    requested: SchemaGenerator,
    answered: SchemaGenerator,
}

impl Schemas {
    fn new() -> Schemas {
        let settings = || {
            SchemaSettings::draft2020_12().with(|settings| {
                settings.definitions_path = SCHEMAS.into();
                settings.meta_schema = None;
            })
        };
        Schemas {
            requested: settings().into_generator(),
            answered: settings().for_serialize().into_generator(),
        }
    }

    fn requested<T: JsonSchema>(&mut self) -> Option<Value> {
        Some(self.requested.subschema_for::<T>().to_value())
    }

    fn answered<T: JsonSchema>(&mut self, status: u16) -> (u16, &'static str, Value) {
        (
            status,
            "application/json",
            self.answered.subschema_for::<T>().to_value(),
        )
    }
}

pub(crate) fn routes() -> Router<Arc<State>> {
    Router::new().route("/openapi.json", get(reported))
}

/// The document as it is sent: made once.
static DOCUMENT: LazyLock<Bytes> = LazyLock::new(|| document().to_string().into());

async fn reported() -> Response {
    crate::body::typed("application/json", DOCUMENT.clone())
}

/// The whole document.
pub fn document() -> Value {
    let mut schemas = Schemas::new();
    let operations = operations(&mut schemas);
    let error = schemas.answered.subschema_for::<ErrorBody>().to_value();
    let mut paths: Map<String, Value> = Map::new();
    for Operation {
        method,
        path,
        about,
        requested,
        answered: (status, kind, schema),
    } in operations
    {
        let mut reported = json!({
            "summary": about,
            "responses": {
                status.to_string(): { "description": "success", "content": { kind: { "schema": schema } } },
                "default": { "description": "error", "content": { "application/json": { "schema": error } } },
            },
        });
        if let Some(schema) = requested {
            reported["requestBody"] =
                json!({ "required": true, "content": { "application/json": { "schema": schema } } });
        }
        let parameters = parameters(path);
        if !parameters.is_empty() {
            reported["parameters"] = Value::from(parameters);
        }
        let of_path = paths.entry(path).or_insert_with(|| json!({}));
        of_path[method] = reported;
    }
    let mut all = schemas.requested.take_definitions(true);
    all.append(&mut schemas.answered.take_definitions(true));
    json!({
        "openapi": "3.1.0",
        "info": {
            "title": "armill serve",
            "version": env!("CARGO_PKG_VERSION"),
            "description": "The live page of one study, on this machine alone.",
        },
        "security": [{ "bearer": [] }, { "query": [] }],
        "paths": paths,
        "components": {
            "securitySchemes": {
                "bearer": { "type": "http", "scheme": "bearer" },
                "query": { "type": "apiKey", "in": "query", "name": "token" },
            },
            "schemas": all,
        },
    })
}

/// The parameters that are in a path.
fn parameters(path: &str) -> Vec<Value> {
    let names = path
        .split('/')
        .filter_map(|part| part.strip_prefix('{')?.strip_suffix('}'));
    let reported =
        |name| json!({ "name": name, "in": "path", "required": true, "schema": { "type": "string" } });
    names.map(reported).collect()
}

/// Every path, in the order of the files that answer them.
fn operations(s: &mut Schemas) -> Vec<Operation> {
    let of = |method, path, about, requested, answered| Operation {
        method,
        path,
        about,
        requested,
        answered,
    };
    let bytes = |status, kind| (status, kind, json!({ "type": "string", "format": "binary" }));
    vec![
        of(
            "get",
            "/api/study",
            "The study on disk",
            None,
            s.answered::<StudyOnDisk>(200),
        ),
        of(
            "put",
            "/api/study",
            "Writes the study",
            s.requested::<StudyUpdate>(),
            s.answered::<StudyOnDisk>(200),
        ),
        of(
            "post",
            "/api/check",
            "What is in a text",
            s.requested::<CheckRequest>(),
            s.answered::<OutlineAnswer>(200),
        ),
        of(
            "post",
            "/api/change",
            "A text with values changed",
            s.requested::<ChangeRequest>(),
            s.answered::<ChangedAnswer>(200),
        ),
        of(
            "post",
            "/api/tables",
            "The values of a text, each with its place",
            s.requested::<CheckRequest>(),
            s.answered::<TablesAnswer>(200),
        ),
        of(
            "get",
            "/api/schema",
            "JSON schema of a study",
            None,
            (200, "application/json", json!({ "type": "object" })),
        ),
        of(
            "post",
            "/api/view",
            "Answer, values and scene of an analysis after values are changed",
            s.requested::<ViewRequest>(),
            s.answered::<ViewAnswer>(200),
        ),
        of(
            "post",
            "/api/mesh",
            "A shape of the robot",
            s.requested::<MeshRequest>(),
            bytes(200, "model/stl"),
        ),
        of(
            "post",
            "/api/answer",
            "The answer to an analysis",
            s.requested::<AnalysisRequest>(),
            s.answered::<StudyAnswer>(200),
        ),
        of(
            "post",
            "/api/values",
            "The settings of an analysis",
            s.requested::<AnalysisRequest>(),
            s.answered::<ValuesAnswer>(200),
        ),
        of(
            "post",
            "/api/pose",
            "The arm at one place",
            s.requested::<PosturesRequest>(),
            s.answered::<PosturesAnswer>(200),
        ),
        of(
            "post",
            "/api/scene",
            "The geometry of an analysis for drawing",
            s.requested::<AnalysisRequest>(),
            s.answered::<SceneAnswer>(200),
        ),
        of(
            "post",
            "/api/table",
            "The table of an analysis",
            s.requested::<TableRequest>(),
            bytes(200, "text/csv"),
        ),
        of(
            "post",
            "/api/pictures",
            "The pictures of an analysis",
            s.requested::<AnalysisRequest>(),
            s.answered::<PicturesAnswer>(200),
        ),
        of(
            "post",
            "/api/picture.png",
            "A picture in pixels",
            s.requested::<PictureRequest>(),
            bytes(200, "image/png"),
        ),
        of(
            "get",
            "/api/robots",
            "The robot library",
            None,
            s.answered::<Vec<RobotRow>>(200),
        ),
        of(
            "post",
            "/api/jobs",
            "Begins a job",
            s.requested::<Task>(),
            s.answered::<JobBegun>(202),
        ),
        of("get", "/api/jobs", "All jobs", None, s.answered::<JobList>(200)),
        of(
            "get",
            "/api/jobs/{id}",
            "One job with its answer",
            None,
            s.answered::<JobAnswer>(200),
        ),
        of(
            "delete",
            "/api/jobs/{id}",
            "Cancels a job",
            None,
            s.answered::<JobAnswer>(200),
        ),
        of(
            "get",
            "/api/jobs/{id}/events",
            "Progress of a job: events `job`",
            None,
            bytes(200, "text/event-stream"),
        ),
        of(
            "get",
            "/api/files",
            "Files of the folder",
            None,
            s.answered::<Files>(200),
        ),
        of(
            "get",
            "/api/files/{path}",
            "One file",
            None,
            bytes(200, "application/octet-stream"),
        ),
        of(
            "put",
            "/api/files/{path}",
            "Uploads a file",
            None,
            s.answered::<UploadedFile>(201),
        ),
        of(
            "get",
            "/api/openapi.json",
            "This document",
            None,
            (200, "application/json", json!({ "type": "object" })),
        ),
    ]
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
