//! The table of parsers: name, function that reads the bytes, samples.

use armill_formats::document::schema_json;
use armill_study::file::format::StudyFile;

use crate::dictionaries as words;
use crate::fixtures;
use crate::{edited, meshes, modal, scanned, tables, tracked, tracked_fixtures, verdicts};

/// One parser.
pub struct Target {
    /// What `cargo xtask fuzz` calls it.
    pub name: &'static str,
    /// Reads one input; a panic is a finding.
    pub read: fn(&[u8]),
    /// Good inputs to begin with.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Sample files with these endings are seeds too.
    pub endings: &'static [&'static str],
    /// Pieces of text that random bytes would not hit.
    words: &'static [&'static str],
    /// The JSON schema of the file: its keys and names are such pieces too.
    schema: Option<fn() -> String>,
}

const fn target(
    name: &'static str,
    read: fn(&[u8]),
    seeds: fn() -> Vec<Vec<u8>>,
    endings: &'static [&'static str],
    words: &'static [&'static str],
) -> Target {
    Target {
        name,
        read,
        seeds,
        endings,
        words,
        schema: None,
    }
}

impl Target {
    const fn of_schema(mut self, schema: fn() -> String) -> Target {
        self.schema = Some(schema);
        self
    }

    /// Every piece of text that random bytes would not hit.
    pub fn words(&self) -> Vec<String> {
        let listed = self.words.iter().map(|word| (*word).to_owned());
        let of_schema = self.schema.map(|schema| words::of_schema(&schema()));
        listed.chain(of_schema.into_iter().flatten()).collect()
    }
}

/// Every parser; a new one is a line here, its seeds in `fixtures`, and a function in `verdicts` if its result is of a
/// new kind.
#[rustfmt::skip]
pub const TARGETS: &[Target] = &[
    target("study", verdicts::study, fixtures::studies, &["toml"], words::STUDY).of_schema(schema_json::<StudyFile>),
    target("edit", edited::edit, fixtures::edits, &[], words::STUDY).of_schema(schema_json::<StudyFile>),
    target("robot", verdicts::armill, fixtures::robots, &["toml"], words::ROBOT),
    target("urdf", verdicts::urdf, fixtures::urdf, &["urdf"], words::URDF),
    target("meshes", edited::meshes, fixtures::meshes, &["urdf"], words::URDF),
    target("xacro", verdicts::xacro, fixtures::xacro, &["xacro"], words::XACRO),
    target("opw", verdicts::opw, fixtures::opw, &["yaml", "yml"], words::OPW),
    target("ur", verdicts::ur, fixtures::ur, &["yaml", "yml"], words::UR),
    target("dh", verdicts::dh, fixtures::dh, &["dh"], words::DH),
    target("chain", verdicts::chain, fixtures::chain, &["chain", "fsf"], words::CHAIN),
    target("format", verdicts::format, fixtures::named, &[], words::FORMAT),
    target("load-tests", verdicts::load_tests, fixtures::load_tests, &["csv"], words::LOAD_TESTS),
    target("pendant", verdicts::pendant, fixtures::pendant, &[], words::PENDANT),
    target("gcode", verdicts::gcode, fixtures::gcode, &["ngc", "nc"], words::GCODE),
    target("tool-table", verdicts::tool_table, fixtures::tool_tables, &["tbl"], words::TOOL_TABLE),
    target("apt", verdicts::apt, fixtures::apt, &["apt", "cls", "clsf", "cl"], words::APT),
    target("path-csv", verdicts::path_csv, fixtures::path_csv, &["csv"], words::PATH_CSV),
    target("program", verdicts::program, fixtures::program, &["ngc", "apt", "cls", "csv"], words::PROGRAM),
    target("robot-program", verdicts::robot_program, fixtures::robot_programs, &["src", "mod", "script", "jbi", "ls", "pgx"], words::ROBOT_PROGRAM),
    target("dynoware", verdicts::dynoware, fixtures::dynoware, &[], words::FORCES),
    target("force-csv", verdicts::force_csv, fixtures::force_csv, &[], words::FORCES),
    target("forces", verdicts::forces, fixtures::forces, &[], words::FORCES),
    target("profile", verdicts::profile, fixtures::profiles, &["ds", "csv", "qif"], words::PROFILE),
    target("scan", scanned::scan, scanned::scans, &["qif", "csv"], words::SCAN),
    target("scan-surface", scanned::surface, scanned::surfaces, &["ply"], words::SCAN),
    target("scan-dmis", scanned::dmis, scanned::reports, &[], words::SCAN),
    target("ballbar-csv", verdicts::ballbar_csv, fixtures::ballbar_csv, &[], words::BALLBAR),
    target("ballbar-results", verdicts::ballbar_results, fixtures::ballbar_results, &["b5r"], words::BALLBAR),
    target("poses", tracked::poses, fixtures::poses, &["csv", "txt"], words::POSES),
    target("trace", tracked::trace, fixtures::traces, &["txt", "csv"], words::TRACE),
    target("frf", tracked::frf, tracked_fixtures::frfs, &[], words::FRF),
    target("joint-log", tracked::joint_log, tracked_fixtures::joint_logs, &["csv", "txt"], words::JOINT_LOG),
    target("matlab", tracked::matlab, tracked_fixtures::matlab_files, &["mat"], words::MATLAB),
    target("journal", tables::journal, tables::journals, &[], words::JOURNAL),
    target("conditions", tables::conditions, tables::condition_tables, &[], words::CONDITIONS),
    target("bodies", tables::bodies, tables::body_tables, &[], words::BODIES),
    target("numbers", tables::numbers, tables::number_tables, &["xlsx"], words::NUMBERS),
    target("sheet", tables::sheet, tables::sheets, &[], words::SHEET),
    target("mesh-stl", meshes::stl, fixtures::mesh_stl, &["stl"], words::MESH_STL),
    target("mesh-obj", meshes::obj, fixtures::mesh_obj, &["obj"], words::MESH_OBJ),
    target("mesh-ply", meshes::ply, fixtures::mesh_ply, &["ply"], words::MESH_PLY),
    target("mesh-3mf", meshes::three_mf, fixtures::mesh_3mf, &["3mf"], words::MESH_3MF),
    target("mesh-model", meshes::three_mf_model, fixtures::mesh_3mf_model, &["model"], words::MESH_3MF),
    target("mesh-dae", meshes::dae, fixtures::mesh_dae, &["dae"], words::MESH_DAE),
    target("material", verdicts::material, fixtures::materials, &[], words::MATERIAL),
    target("modal", modal::modal_data, modal::seeds, &[], words::MODAL),
    target("tool-assembly", modal::tool_assembly_data, modal::tool_assemblies, &[], words::TOOL_ASSEMBLY),
];
