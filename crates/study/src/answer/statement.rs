//! Published statements, compared with these results: consistent or not, never confirmed.
//!
//! A reading is consistent if its largest in-plane deviation is at most the stated bound. A source may leave tool,
//! plane or branch open: then several readings can be.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::map::answer::MapAnswer;
use crate::analysis::path::answer::PathAnswer;
use crate::file::resolve::Study;

/// A statement and every reading of it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StatementAnswer {
    /// The statement in words.
    pub text: String,
    /// Where it was published.
    pub source: String,
    /// The stated bound of the in-plane deviation.
    pub at_most_um: f64,
    /// The result of each reading.
    pub readings: Vec<Reading>,
}

/// One reading of a statement.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Reading {
    /// Name of the map or path.
    pub name: String,
    /// Requested posture.
    pub branch: String,
    /// Least and largest in-plane deviation; none if nothing was reached.
    pub in_plane_um: Option<[f64; 2]>,
    /// Whether every point is inside joint limits.
    pub inside_joint_limits: bool,
    /// Whether the largest is within the stated bound.
    pub consistent: bool,
}

/// Every statement with a reading for each name it gives: of the path that is called so, else of the map or section.
pub(super) fn answers(study: &Study, maps: &[MapAnswer], paths: &[PathAnswer]) -> Vec<StatementAnswer> {
    let of_map = |map: &MapAnswer| {
        (
            map.branch.clone(),
            map.min_in_plane_um.zip(map.max_in_plane_um),
            map.outside_joint_limits == 0,
        )
    };
    let of_path = |path: &PathAnswer| {
        (
            path.branch.clone(),
            path.min_in_plane_um.zip(path.max_in_plane_um),
            path.outside_joint_limits == 0,
        )
    };
    let reading = |name: &String, bound: f64| {
        let found = paths.iter().find(|path| path.name == *name).map(of_path);
        let found = found.or_else(|| maps.iter().find(|map| map.name == *name).map(of_map))?;
        let (branch, range, inside_joint_limits) = found;
        let consistent = range.is_some_and(|(_, most)| most <= bound);
        let in_plane_um = range.map(|(least, most)| [least, most]);
        Some(Reading {
            name: name.clone(),
            branch,
            in_plane_um,
            inside_joint_limits,
            consistent,
        })
    };
    let answer = |statement: &crate::file::format::StatementTable| StatementAnswer {
        text: statement.text.clone(),
        source: statement.source.clone(),
        at_most_um: statement.at_most_um,
        readings: statement
            .of
            .iter()
            .filter_map(|name| reading(name, statement.at_most_um))
            .collect(),
    };
    study.statements.iter().map(answer).collect()
}
