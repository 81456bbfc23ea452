//! The report: question, answer, tables, pictures, warnings, inputs with their sources; one HTML file.
//!
//! A file for each chapter: `statements`, `planes`, `volumes`, `paths`, `program` with `cut`, `inputs`; `cells`: numbers in tables.

mod cells;
mod cut;
mod inputs;
mod paths;
mod planes;
mod program;
mod statements;
mod volumes;

use armill_report::html::Report;

use super::pictures::Picture;
use crate::answer::{PathResult, StudyAnswer};
use crate::file::resolve::Study;

pub(super) fn html(study: &Study, answer: &StudyAnswer, pictures: &[Picture]) -> String {
    let mut report = Report::new(&answer.title).answer(&answer.answer);
    if let Some(question) = &answer.question {
        report = report.question(question);
    }
    for warning in &answer.warnings {
        report = report.warning(warning);
    }
    report = report.inputs(inputs::rows(study, answer));
    if !answer.statements.is_empty() {
        report = report.section("What others state, and what was found here").paragraph(
            "A reading is consistent with a statement if its largest in-plane deviation is within the stated bound. \
             That is not a confirmation: where the source leaves tool length, plate angle, branch and base frame open, \
             several readings may be consistent.",
        );
        for table in statements::tables(answer) {
            report = report.table(&table);
        }
    }
    if !answer.maps.is_empty() {
        report = report.section("Planes").table(&planes::table(answer));
    }
    let (programs, shapes): (Vec<&PathResult>, Vec<&PathResult>) =
        answer.paths.iter().partition(|path| path.program.is_some());
    if !shapes.is_empty() {
        report = report.section("Paths").table(&paths::table(&shapes));
    }
    if !programs.is_empty() {
        report = program::tell(report, &programs);
    }
    if !answer.volumes.is_empty() {
        report = report.section("Volumes").table(&volumes::table(answer));
    }
    if !pictures.is_empty() {
        report = report.section("Pictures");
    }
    for picture in pictures {
        report = report.picture(&picture.svg, &picture.caption);
    }
    report.to_html()
}
