//! The report: question, answer, tables, pictures, warnings, inputs with their sources; one HTML file.
//!
//! It contains its pictures and needs no other file.
//!
//! The chapters of the kinds of analysis are theirs; those of the study: `statements`, `clearance`, `inputs` with `cut`
//! (`sources`: where their numbers come from).

mod clearance;
mod cut;
mod inputs;
mod sources;
mod statements;

use armill_report::html::Report;

use crate::analysis;
use crate::analysis::picture::Picture;
use crate::answer::StudyAnswer;
use crate::file::resolve::Study;
use crate::output::options::Opening;

/// The whole page: chapters only for the analyses of the study, pictures in the order given.
pub(super) fn html(
    study: &Study,
    answer: &StudyAnswer,
    pictures: &[Picture],
    opening: Option<&Opening>,
) -> String {
    let mut report = Report::new(&answer.title).answer(&answer.answer);
    if let Some(question) = &answer.question {
        report = report.question(question);
    }
    for warning in &answer.warnings {
        report = report.warning(warning);
    }
    report = report.inputs(inputs::rows(study, answer));
    if let Some(opening) = opening {
        report = report.section(opening.heading).list(&opening.sentences);
        for picture in &opening.pictures {
            report = report.picture(&picture.svg, &picture.caption);
        }
    }
    if !answer.statements.is_empty() {
        report = report.section("Published statements").paragraph(
            "A reading is consistent with a statement if its largest in-plane deviation is within the stated bound. \
             Consistent does not mean confirmed: if the source does not state tool length, plate angle, branch and base frame, \
             several readings may be consistent.",
        );
        for table in statements::tables(answer) {
            report = report.table(&table);
        }
    }
    if !answer.maps.is_empty() {
        report = report
            .section("Planes")
            .table(&analysis::map::report::table(&answer.maps));
    }
    if !answer.paths.is_empty() {
        report = analysis::path::report::add_section(report, &answer.paths);
    }
    for set in &answer.holes {
        report = analysis::holes::report::add_section(report, set);
    }
    if !answer.volumes.is_empty() {
        report = report
            .section("Volumes")
            .table(&analysis::volume::report::table(&answer.volumes));
    }
    report = analysis::vibration::report::add_section(report, &answer.vibrations());
    report = clearance::add_section(report, &study.robot.robot, answer);
    if let Some(given) = &answer.measured {
        report = report.section("Measurement and prediction");
        report = report.paragraph(&crate::output::budget::in_words(given));
        for table in crate::output::budget::tables(given) {
            report = report.table(&table);
        }
    }
    if !pictures.is_empty() {
        report = report.section("Pictures");
    }
    for picture in pictures {
        report = report.picture(&picture.svg, &picture.caption);
    }
    report.to_html()
}
