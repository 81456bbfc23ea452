//! The description of paths for programs: OpenAPI 3.1, its schemas made from the types themselves.
//!
//! The page's own types come from it, so that none is typed by hand.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

use crate::error::ErrorBody;

/// The type of JSON.
pub const JSON: &str = "application/json";
/// Where schemas are in the document.
const SCHEMAS: &str = "/components/schemas";

/// A method of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Reads.
    Get,
    /// Writes.
    Put,
    /// Evaluates what is sent.
    Post,
    /// Ends.
    Delete,
}

impl Method {
    /// As HTTP names it.
    pub fn name(self) -> &'static str {
        match self {
            Method::Get => "GET",
            Method::Put => "PUT",
            Method::Post => "POST",
            Method::Delete => "DELETE",
        }
    }
}

/// Makes the schema of a type.
type MakeSchema = fn(&mut SchemaGenerator) -> Value;

/// One path with one method, as it is described.
#[derive(Clone, Copy, Debug)]
pub struct Description {
    /// Below `/api`; a name in braces stands for any part of a path, with a star for several.
    pub path: &'static str,
    /// Its method.
    pub method: Method,
    /// What it does.
    pub about: &'static str,
    /// Status of success.
    pub status: u16,
    /// Type of the answer, such as `application/json`.
    pub kind: &'static str,
    requested: Option<MakeSchema>,
    answered: MakeSchema,
}

impl Description {
    /// One that takes nothing and answers with an object.
    pub fn new(method: Method, path: &'static str, about: &'static str) -> Description {
        Description {
            path,
            method,
            about,
            status: 200,
            kind: JSON,
            requested: None,
            answered: |_| json!({ "type": "object" }),
        }
    }

    /// With a request of this type, in JSON.
    #[must_use]
    pub fn takes<T: JsonSchema>(mut self) -> Description {
        self.requested = Some(|schemas| schemas.subschema_for::<T>().to_value());
        self
    }

    /// With an answer of this type, in JSON.
    #[must_use]
    pub fn answers<T: JsonSchema>(mut self) -> Description {
        self.answered = |schemas| schemas.subschema_for::<T>().to_value();
        self
    }

    /// With an answer that is no JSON.
    #[must_use]
    pub fn sends(mut self, kind: &'static str) -> Description {
        self.kind = kind;
        self.answered = |_| json!({ "type": "string", "format": "binary" });
        self
    }

    /// With another status of success than 200.
    #[must_use]
    pub fn with(mut self, status: u16) -> Description {
        self.status = status;
        self
    }
}

/// The whole document.
pub fn describe<'a>(paths_in_order: impl IntoIterator<Item = &'a Description>) -> Value {
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
    for operation in paths_in_order {
        let mut reported = json!({
            "summary": operation.about,
            "responses": {
                operation.status.to_string(): { "description": "success", "content": { operation.kind: { "schema": (operation.answered)(&mut answered) } } },
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
        of_path[operation.method.name().to_lowercase()] = reported;
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
