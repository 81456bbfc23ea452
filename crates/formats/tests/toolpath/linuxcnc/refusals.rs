//! What its interpreter refuses, and why.

use std::collections::BTreeSet;

use armill_formats::toolpath::LengthUnit;
use armill_formats::toolpath::gcode::{GcodeReadOptions, Refusal, interpret};

use super::{bytes, linuxcnc, simulated};
use crate::samples_folder::files_below;

type Reason = fn(&Refusal) -> bool;

/// What must be refused, and the reason in our words.
const BAD: &[(&str, Reason)] = &[
    ("a-in-canned-cycle.ngc", |it| {
        matches!(it, Refusal::RotaryInCycle { word: 'A' })
    }),
    ("a-in-canned-cycle2.ngc", |it| {
        matches!(it, Refusal::RotaryInCycle { word: 'A' })
    }),
    ("bad-arc.big.imperial.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.big.metric.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.medium.imperial.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.medium.metric.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.small.imperial.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.small.metric.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("ccomp-arcexit.ngc", |it| {
        matches!(it, Refusal::ArcAfterCompensation)
    }),
    ("ccomp-gouging.ngc", |it| matches!(it, Refusal::Gouging { .. })),
    ("exists-1.ngc", |it| matches!(it, Refusal::ExpectedParameter)),
    ("exists-2.ngc", |it| matches!(it, Refusal::Expected(']'))),
    (
        "exists-3.ngc",
        |it| matches!(it, Refusal::ParameterOutOfRange(value, _) if *value == 99999.0),
    ),
    (
        "exists-4.ngc",
        |it| matches!(it, Refusal::UnknownFunction(name) if name == "foo"),
    ),
    ("exists-5.ngc", |it| matches!(it, Refusal::NameOpen)),
    ("exists-6.ngc", |it| matches!(it, Refusal::NotANumber(_))),
    ("exists-7.ngc", |it| matches!(it, Refusal::Expected(']'))),
    ("g64-m19-r-ambiguous.ngc", |it| {
        matches!(it, Refusal::WordAmbiguous('R'))
    }),
    ("g64-r-on-g61.ngc", |it| matches!(it, Refusal::WordUnused('R'))),
    ("nested.ngc", |it| matches!(it, Refusal::NestedSubroutine)),
    (
        "no-feed-rate.ngc",
        |it| matches!(it, Refusal::NoFeed(code) if code == "G1"),
    ),
    ("no-ijr.ngc", |it| matches!(it, Refusal::ArcWithoutCentre)),
    (
        "probe-no-axes.ngc",
        |it| matches!(it, Refusal::AxesMissing(code) if code == "G38.2"),
    ),
];

#[test]
fn what_the_other_interpreter_refuses_is_refused_for_the_same_reason() {
    let Some(folder) = linuxcnc() else { return };
    let folder = folder.join("tests/interp/bad");
    let expected = GcodeReadOptions {
        unit: LengthUnit::Inch,
        ..simulated(None)
    };
    let mut wrong = Vec::new();
    for (file, reason) in BAD {
        let found = interpret(
            &mut bytes(&folder.join(file)).as_slice(),
            &expected,
            &mut |_, _| Ok(()),
        );
        match found.faults.first() {
            Some(fault) if reason(&fault.refusal) => {}
            Some(fault) => wrong.push(format!("{file}:{}: {}", fault.line, fault.refusal)),
            None => wrong.push(format!("{file}: accepted")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let known: BTreeSet<&str> = BAD.iter().map(|(file, _)| *file).collect();
    for file in files_below(&folder) {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        assert!(
            !name.ends_with(".ngc") || known.contains(name.as_str()),
            "{name} is not in the table"
        );
    }
}
