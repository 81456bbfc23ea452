//! The description of paths for programs: OpenAPI 3.1, its schemas made from the types themselves.
//!
//! The page's own types come from it, so that none is typed by hand.

use std::sync::Arc;

use axum::handler::Handler;
use axum::http::StatusCode;
use axum::routing::{MethodFilter, MethodRouter, on};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

use crate::error::ErrorBody;
use crate::reply::JSON;
use crate::state::State;

/// Where schemas are in the document.
const SCHEMAS: &str = "/components/schemas";

/// A method, as OpenAPI and as axum name it.
type Method = (&'static str, MethodFilter);
pub(crate) const GET: Method = ("get", MethodFilter::GET);
pub(crate) const PUT: Method = ("put", MethodFilter::PUT);
pub(crate) const POST: Method = ("post", MethodFilter::POST);
pub(crate) const DELETE: Method = ("delete", MethodFilter::DELETE);

/// Makes the schema of a type.
type MakeSchema = fn(&mut SchemaGenerator) -> Value;

/// One path with one method.
pub(crate) struct Operation {
    /// Below `/api`, as axum writes it.
    pub path: &'static str,
    pub handler: MethodRouter<Arc<State>>,
    method: &'static str,
    /// What it does.
    about: &'static str,
    requested: Option<MakeSchema>,
    /// Status of success, its type and its schema.
    answered: (StatusCode, &'static str, MakeSchema),
}

impl Operation {
    /// One that takes nothing and answers with an object.
    pub(crate) fn new<H: Handler<T, Arc<State>>, T: 'static>(
        (method, filter): Method,
        path: &'static str,
        about: &'static str,
        handler: H,
    ) -> Operation {
        Operation {
            path,
            handler: on(filter, handler),
            method,
            about,
            requested: None,
            answered: (StatusCode::OK, JSON, |_| json!({ "type": "object" })),
        }
    }

    /// With a request of this type, in JSON.
    pub(crate) fn takes<T: JsonSchema>(mut self) -> Operation {
        self.requested = Some(|schemas| schemas.subschema_for::<T>().to_value());
        self
    }

    /// With an answer of this type, in JSON.
    pub(crate) fn answers<T: JsonSchema>(mut self) -> Operation {
        self.answered.2 = |schemas| schemas.subschema_for::<T>().to_value();
        self
    }

    /// With an answer that is no JSON.
    pub(crate) fn sends(mut self, kind: &'static str) -> Operation {
        self.answered.1 = kind;
        self.answered.2 = |_| json!({ "type": "string", "format": "binary" });
        self
    }

    /// With another status of success than 200.
    pub(crate) fn with(mut self, status: StatusCode) -> Operation {
        self.answered.0 = status;
        self
    }
}

/// The whole document.
pub(crate) fn describe(operations: &[Operation]) -> Value {
    let settings = || {
        SchemaSettings::draft2020_12().with(|settings| {
            settings.definitions_path = SCHEMAS.into();
            settings.meta_schema = None;
        })
    };
    // Requests and answers differ in which fields may be left out.
    let mut requested = settings().into_generator();
    let mut answered = settings().for_serialize().into_generator();
    let error = json!({ "$ref": format!("#{SCHEMAS}/ErrorBody") });
    let mut paths: Map<String, Value> = Map::new();
    for operation in operations {
        let (status, kind, schema) = operation.answered;
        let mut reported = json!({
            "summary": operation.about,
            "responses": {
                status.as_str(): { "description": "success", "content": { kind: { "schema": schema(&mut answered) } } },
                "default": { "description": "error", "content": { "application/json": { "schema": error } } },
            },
        });
        if let Some(schema) = operation.requested {
            let schema = schema(&mut requested);
            reported["requestBody"] =
                json!({ "required": true, "content": { "application/json": { "schema": schema } } });
        }
        let path = format!("/api{}", operation.path.replace("{*", "{"));
        let parameters = parameters(&path);
        if !parameters.is_empty() {
            reported["parameters"] = Value::from(parameters);
        }
        let of_path = paths.entry(path).or_insert_with(|| json!({}));
        of_path[operation.method] = reported;
    }
    answered.subschema_for::<ErrorBody>();
    let mut all = requested.take_definitions(true);
    all.append(&mut answered.take_definitions(true));
    json!({
        "openapi": "3.1.0",
        "info": {
            "title": "armill serve",
            "version": env!("CARGO_PKG_VERSION"),
            "description": "The live page of one study, on this machine alone.",
        },
        "security": [{ "bearer": [] }],
        "paths": paths,
        "components": {
            "securitySchemes": {
                "bearer": { "type": "http", "scheme": "bearer" },
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
