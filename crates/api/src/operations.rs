//! All requests that are answered at once.
//!
//! To add one: its answer in the file of its subject, and a row in [`operations`].

use std::sync::LazyLock;

use armill_study::answer::StudyAnswer;
use armill_study::materials::MaterialRow;
use armill_study::robot_answers::RobotRow;

use crate::openapi::{Description, Method};
use crate::operation::Operation;
use crate::{answers, files, study};

use Method::{Get, Post, Put};

/// The type of columns of numbers.
const NUMBERS: &str = "application/octet-stream";
/// The type of meshes.
const STL: &str = "model/stl";

static OPERATIONS: LazyLock<Vec<Operation>> = LazyLock::new(all);

/// All of them, in the order of the files that answer them.
pub fn operations() -> &'static [Operation] {
    &OPERATIONS
}

/// The one with this method, as HTTP names it, and this path below `/api`.
pub fn find(method: &str, path: &str) -> Option<&'static Operation> {
    operations()
        .iter()
        .find(|operation| operation.description.path == path && operation.description.method.name() == method)
}

fn all() -> Vec<Operation> {
    let post = |path, about| Description::new(Post, path, about);
    let get = |path, about| Description::new(Get, path, about);
    vec![
        Operation::get("/study", "The study on disk", study::read),
        Operation::json(Put, "/study", "Writes the study", study::write),
        Operation::get("/study/version", "The state of its file", study::version),
        Operation::json(Post, "/check", "What is in a text", study::check),
        Operation::json(Post, "/change", "A text with values changed", study::change),
        Operation::json(
            Post,
            "/tables",
            "The values of a text, each with its place",
            study::tables,
        ),
        Operation::constant(get("/schema", "JSON schema of a study"), study::schema),
        Operation::json(
            Post,
            "/view",
            "Answer, values and scene of an analysis after values are changed",
            answers::view,
        )
        .replaced_as("view"),
        Operation::bytes(post("/mesh", "A shape of the robot").sends(STL), answers::mesh),
        Operation::bytes(
            post("/body-mesh", "The mesh of a body of the cell").sends(STL),
            answers::mesh_of_body,
        ),
        Operation::bytes(
            post("/answer", "The answer to an analysis").answers::<StudyAnswer>(),
            answers::answer,
        )
        .replaced_as("answer"),
        Operation::json(Post, "/values", "The settings of an analysis", answers::values),
        Operation::json(Post, "/pose", "The arm at one place", answers::pose).replaced_as("pose"),
        Operation::json(
            Post,
            "/lobes",
            "The stability of the cut at one place",
            answers::lobes,
        )
        .replaced_as("lobes"),
        Operation::bytes(
            post(
                "/path-columns",
                "Columns of a path as numbers of 4 bytes, little-endian",
            )
            .sends(NUMBERS),
            answers::path_columns,
        )
        .replaced_as("path-columns"),
        Operation::bytes(
            post(
                "/part-surface",
                "The surface of the machined part of a path: a header and numbers of 4 bytes, little-endian",
            )
            .sends(NUMBERS),
            answers::part_surface,
        )
        .replaced_as("part-surface"),
        Operation::json(
            Post,
            "/reachable",
            "The nearest placement that the robot reaches",
            answers::reachable,
        )
        .replaced_as("reachable"),
        Operation::json(
            Post,
            "/spin-map",
            "A path over its length and the spin of the tool",
            answers::spin_map,
        )
        .replaced_as("spin-map"),
        Operation::json(
            Post,
            "/spin-search",
            "The spins that a search finds along a path",
            answers::spin_search,
        )
        .replaced_as("spin-search"),
        Operation::json(
            Post,
            "/scene",
            "The geometry of an analysis for drawing",
            answers::scene,
        )
        .replaced_as("scene"),
        Operation::bytes(
            post("/table", "The table of an analysis").sends("text/csv; charset=utf-8"),
            answers::table,
        ),
        Operation::json(
            Post,
            "/pictures",
            "The pictures of an analysis",
            answers::pictures,
        )
        .replaced_as("pictures"),
        #[cfg(feature = "png")]
        Operation::bytes(
            post("/picture.png", "A picture in pixels").sends("image/png"),
            answers::picture_png,
        ),
        Operation::constant(
            get("/robots", "The robot library").answers::<Vec<RobotRow>>(),
            answers::robots,
        ),
        Operation::constant(
            get("/materials", "The material library").answers::<Vec<MaterialRow>>(),
            answers::materials,
        ),
        Operation::get("/files", "Files of the folder", files::list),
    ]
}
