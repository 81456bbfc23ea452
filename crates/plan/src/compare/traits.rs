//! Properties of a cell, as text for a table: robot, compliances, placement, tool, posture, load, tolerance, model,
//! points.
//!
//! Cells are distinguished by this text only: two with the same text are the same.

use armill_core::frame::Isometry;
use armill_core::load::LoadFrame;
use armill_core::map::VolumeMap;
use armill_core::nalgebra::Vector3;
use armill_core::units::{to_deg, to_mm, to_um};
use armill_study::analysis::Sheet;
use armill_study::analysis::holes::HolesAnalysis;
use armill_study::analysis::path::PathAnalysis;
use armill_study::file::resolve::Study;
use armill_study::input::setting::Setting;
use armill_study::model_words::parts;
use armill_study::number::decimals;
use serde::Serialize;

/// One property of the cells.
#[derive(Clone, Debug, Serialize)]
pub struct TraitAnswer {
    /// Which: `robot`, `place`, `tool`, ...
    pub what: &'static str,
    /// Whether the cells differ in it.
    pub differs: bool,
    /// What it is in each cell, in the order of their numbers.
    pub of: Vec<String>,
}

/// Greatest number of load cases listed individually.
const MOST_CASES: usize = 4;

/// A plane.
pub(super) fn of_sheet(study: &Study, sheet: &Sheet) -> Vec<(&'static str, String)> {
    let setting = &sheet.setting;
    let place = place(setting, &setting.plane.base_from_part);
    let grid = &sheet.grid;
    let points = format!(
        "{} x {} points, {} mm apart",
        grid.columns,
        grid.rows,
        plain(to_mm(grid.step))
    );
    all(study, setting, [place, load(setting), points])
}

/// A box.
pub(super) fn of_volume(study: &Study, setting: &Setting, volume: &VolumeMap) -> Vec<(&'static str, String)> {
    let corner = setting.in_reference(&volume.grid.corner());
    let [x, y, z] = volume.grid.counts;
    let step = plain(to_mm(volume.grid.step));
    let place = format!(
        "corner at {} mm from {}",
        numbers(&corner.coords, 1e3),
        setting.base_name
    );
    all(
        study,
        setting,
        [
            place,
            load(setting),
            format!("{x} x {y} x {z} points, {step} mm apart"),
        ],
    )
}

/// A path.
pub(super) fn of_path(study: &Study, analysis: &PathAnalysis) -> Vec<(&'static str, String)> {
    let (count, mm) = (analysis.track.len(), to_mm(analysis.length()));
    along(study, analysis, format!("{count} points over {mm:.1} mm"))
}

/// Holes.
pub(super) fn of_holes(study: &Study, analysis: &HolesAnalysis) -> Vec<(&'static str, String)> {
    let (count, turns) = (analysis.path.track.len(), analysis.search.spins.count);
    along(
        study,
        &analysis.path,
        format!("{count} holes, {turns} spins tried at each"),
    )
}

fn along(study: &Study, analysis: &PathAnalysis, points: String) -> Vec<(&'static str, String)> {
    let pushes = match (&analysis.cut, &analysis.drill, &analysis.measured) {
        (_, _, Some(measured)) => format!("measured: {}", measured.table.file),
        (_, Some(drill), None) => format!("drilling {}", drill.material.name),
        (Some(cut), None, None) => {
            let (cutter, stock) = (to_mm(cut.cutting.cutter.diameter()), cut.stock.is_some());
            let out_of = if stock { ", out of a stock" } else { "" };
            format!("cutting {} with {} mm{out_of}", cut.material.name, plain(cutter))
        }
        (None, None, None) => load(&analysis.setting),
    };
    let place = place(&analysis.setting, &analysis.track.placing.base_from_path);
    all(study, &analysis.setting, [place, pushes, points])
}

fn all(study: &Study, setting: &Setting, [place, load, points]: [String; 3]) -> Vec<(&'static str, String)> {
    let robot = &study.robot.robot;
    let compliance = match &study.own_compliance {
        Some(own) if own.caution.is_some() => format!("assumed: {}", own.source),
        Some(own) => format!("of the study: {}", own.source),
        None => "of the robot".to_owned(),
    };
    let searched = setting
        .search
        .as_ref()
        .map_or("", |_| ", best spins and branches searched");
    vec![
        ("robot", format!("{} ({})", study.robot.title, robot.name())),
        ("compliance", compliance),
        ("place", place),
        ("tool", pose("TCP", "from the flange", &setting.flange_from_tool)),
        ("posture", setting.branch() + searched),
        ("load", load),
        ("tolerance", format!("{} µm", plain(to_um(setting.tolerance)))),
        ("stiffness model", parts(robot, &setting.model).join("; ")),
        ("points", points),
    ]
}

/// A frame of the part, relative to the reference frame of the study.
fn place(setting: &Setting, base_from: &Isometry) -> String {
    let counted = setting.base_from_reference.inverse() * base_from;
    pose("origin", &format!("from {}", setting.base_name), &counted)
}

/// A frame: its position and its rotation about the fixed axes x, y, z.
fn pose(what: &str, from: &str, at: &Isometry) -> String {
    let (x, y, z) = at.rotation.euler_angles();
    format!(
        "{what} at {} mm, rotated by {} deg {from}",
        numbers(&at.translation.vector, 1e3),
        numbers(&Vector3::new(x, y, z), to_deg(1f64))
    )
}

fn load(setting: &Setting) -> String {
    let (frame, cases) = match setting.load.frame {
        LoadFrame::Base => ("base", &setting.cases),
        LoadFrame::Part => ("the part", &setting.load.cases),
        LoadFrame::Feed => ("the feed", &setting.load.cases),
    };
    let of_case = |wrench: &armill_core::spatial::Wrench| {
        let moment = match wrench.moment.norm() > 0.0 {
            true => format!(" and {} N m", numbers(&wrench.moment, 1.0)),
            false => String::new(),
        };
        numbers(&wrench.force, 1.0) + &moment
    };
    let given: Vec<String> = cases.iter().take(MOST_CASES).map(of_case).collect();
    let more = match cases.len().saturating_sub(MOST_CASES) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{} N{more} in axes of {frame}", given.join(", "))
}

fn numbers(vector: &Vector3<f64>, scale: f64) -> String {
    let [x, y, z] = [vector.x, vector.y, vector.z].map(|value| plain(value * scale));
    format!("({x}, {y}, {z})")
}

/// A number to three decimals, without zeros at its end.
fn plain(value: f64) -> String {
    format!("{}", decimals(value, 3))
}
