//! The report: question, answer, pictures, tables, inputs with their sources, warnings; one HTML file.

use armill_report::html::{Align, Column, Input, Report, Table};

use super::pictures::Picture;
use crate::answer::StudyAnswer;
use crate::file::resolve::Study;

pub(super) fn html(study: &Study, answer: &StudyAnswer, pictures: &[Picture]) -> String {
    let mut report = Report::new(&answer.title).answer(&answer.answer);
    if let Some(question) = &answer.question {
        report = report.question(question);
    }
    for warning in &answer.warnings {
        report = report.warning(warning);
    }
    report = report.inputs(inputs(study, answer));
    if !answer.statements.is_empty() {
        report = report.section("What others state, and what was found here").paragraph(
            "A reading is consistent with a statement if its largest in-plane deviation is within the stated bound. \
             That is not a confirmation: where the source leaves tool length, plate angle, branch and base frame open, \
             several readings may be consistent.",
        );
        for table in statements(answer) {
            report = report.table(&table);
        }
    }
    if !answer.maps.is_empty() {
        report = report.section("Planes").table(&maps(answer));
    }
    if !answer.paths.is_empty() {
        report = report.section("Paths").table(&paths(answer));
    }
    if !answer.volumes.is_empty() {
        report = report.section("Volumes").table(&volumes(answer));
    }
    report = report.section("Pictures");
    for picture in pictures {
        report = report.picture(&picture.svg, &picture.caption);
    }
    report.to_html()
}

fn inputs(study: &Study, answer: &StudyAnswer) -> Vec<Input> {
    let input = |name: &str, value: String, unit: &str, source: &str| Input {
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
        source: source.to_owned(),
    };
    let place = |key: &str| {
        let found = answer.sources.iter().find(|source| source.key == key);
        found.map_or_else(
            || key.to_owned(),
            |source| format!("{} ({})", source.what, source.place),
        )
    };
    let chain = study
        .robot
        .joints
        .first()
        .and_then(|joint| joint.source.clone())
        .unwrap_or_default();
    let mut inputs = vec![input(
        "robot",
        format!("{} ({})", answer.robot.title, answer.robot.name),
        "",
        &place(&chain),
    )];
    for joint in &answer.robot.joints {
        let value = format!(
            "{:.3e} ± {:.1e}",
            joint.compliance_rad_per_n_m, joint.compliance_u_rad_per_n_m
        );
        let assumed = if answer.robot.compliance_assumed {
            ", assumed"
        } else {
            ""
        };
        let name = format!("compliance of joint {}{assumed}", joint.name);
        inputs.push(input(&name, value, "rad/(N m)", &place(&joint.compliance_source)));
    }
    let settings = answer
        .maps
        .iter()
        .map(|map| &map.setting)
        .chain(answer.paths.iter().map(|path| &path.setting));
    if let Some(setting) = settings.into_iter().next() {
        let load_source = study
            .load_source
            .clone()
            .unwrap_or_else(|| "the study".to_owned());
        for (i, force) in setting.cases_n.iter().enumerate() {
            let value = format!("({}, {}, {})", force[0], force[1], force[2]);
            inputs.push(input(
                &format!("force on the tool, case {}", i + 1),
                value,
                "N",
                &load_source,
            ));
        }
        inputs.push(input(
            "tolerance, in plane",
            format!("{}", setting.limit_um),
            "µm",
            "the study",
        ));
        inputs.push(input(
            "tool centre point from the flange",
            format!("{:.1}", setting.tool_length_mm),
            "mm",
            "the study",
        ));
        inputs.push(input(
            "stiffness model",
            setting.model.join("; "),
            "",
            "robot and study",
        ));
        inputs.push(input("heights count from", setting.base.clone(), "", "the study"));
    }
    inputs
}

fn columns(names: &[(&str, &str)]) -> Vec<Column> {
    let column = |(i, (name, unit)): (usize, &(&str, &str))| Column {
        name: (*name).to_owned(),
        unit: (*unit).to_owned(),
        align: if i == 0 || unit.is_empty() {
            Align::Left
        } else {
            Align::Number
        },
    };
    names.iter().enumerate().map(column).collect()
}

fn um(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.1}"))
}

fn percent(fraction: f64) -> String {
    format!("{:.1}", fraction * 100.0)
}

fn statements(answer: &StudyAnswer) -> Vec<Table> {
    let table = |statement: &crate::answer::StatementAnswer| Table {
        caption: format!(
            "{} ({}): at most {} µm.",
            statement.text, statement.source, statement.at_most_um
        ),
        columns: columns(&[
            ("reading", ""),
            ("branch", ""),
            ("in-plane deviation", "µm"),
            ("inside joint limits", ""),
            ("verdict", ""),
        ]),
        rows: statement
            .readings
            .iter()
            .map(|reading| {
                let range = reading
                    .in_plane_um
                    .map_or("–".to_owned(), |[a, b]| format!("{a:.1} … {b:.1}"));
                vec![
                    reading.name.clone(),
                    reading.branch.clone(),
                    range,
                    if reading.inside_joint_limits { "yes" } else { "no" }.to_owned(),
                    if reading.consistent {
                        "consistent"
                    } else {
                        "not consistent"
                    }
                    .to_owned(),
                ]
            })
            .collect(),
    };
    answer.statements.iter().map(table).collect()
}

fn maps(answer: &StudyAnswer) -> Table {
    Table {
        caption: "Fractions are of all points; named branches are judged whether their joints stand inside their limits or not. Surely and possibly: with twice the standard uncertainty added and taken away.".to_owned(),
        columns: columns(&[
            ("plane", ""),
            ("branch", ""),
            ("within the limit", "%"),
            ("… and inside joint limits", "%"),
            ("surely … possibly within", "%"),
            ("least", "µm"),
            ("largest", "µm"),
            ("force permitted there, any direction", "N"),
            ("out of reach", "points"),
            ("points", "points"),
        ]),
        rows: answer
            .maps
            .iter()
            .map(|map| {
                vec![
                    map.name.clone(),
                    map.branch.clone(),
                    percent(map.fraction_within),
                    percent(map.fraction_within_and_inside_joint_limits),
                    format!(
                        "{} … {}",
                        percent(map.certainty.fraction_surely_within),
                        percent(map.certainty.fraction_possibly_within)
                    ),
                    um(map.min_in_plane_um),
                    um(map.max_in_plane_um),
                    um(map.worst.as_ref().and_then(|p| p.permissible_any_direction_n)),
                    (map.counts.out_of_reach + map.counts.no_posture_inside_limits).to_string(),
                    map.grid.points.to_string(),
                ]
            })
            .collect(),
    }
}

fn paths(answer: &StudyAnswer) -> Table {
    Table {
        caption: "Roundness: largest of all load cases, peak to valley about the least-squares circle."
            .to_owned(),
        columns: columns(&[
            ("path", ""),
            ("branch", ""),
            ("least in plane", "µm"),
            ("largest in plane", "µm"),
            ("largest in space", "µm"),
            ("roundness", "µm"),
            ("outside joint limits", "points"),
            ("points", "points"),
        ]),
        rows: answer
            .paths
            .iter()
            .map(|path| {
                vec![
                    path.name.clone(),
                    path.branch.clone(),
                    um(path.min_in_plane_um),
                    um(path.max_in_plane_um),
                    um(path.max_full_um),
                    um(path.roundness_um),
                    path.outside_joint_limits.to_string(),
                    path.points.to_string(),
                ]
            })
            .collect(),
    }
}

fn volumes(answer: &StudyAnswer) -> Table {
    Table {
        caption: "Each point within stands for one cell of the pitch.".to_owned(),
        columns: columns(&[
            ("box", ""),
            ("branch", ""),
            ("within the limit", "%"),
            ("… and inside joint limits", "%"),
            ("volume within", "dm³"),
            ("points", "points"),
        ]),
        rows: answer
            .volumes
            .iter()
            .map(|volume| {
                vec![
                    volume.name.clone(),
                    volume.branch.clone(),
                    percent(volume.fraction_within),
                    percent(volume.fraction_within_and_inside_joint_limits),
                    format!("{:.1}", volume.volume_within_mm3 * 1e-6),
                    volume.point_counts.iter().product::<usize>().to_string(),
                ]
            })
            .collect(),
    }
}
