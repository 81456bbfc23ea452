//! Columns that only a path has: line, point of the program, distance and feed, the spin of a search or a curve, the lean of a search, and the components of the
//! deviation of the worst case relative to the track, with their part due to backlash and geometry; force, torque, chip and removal rate of a cut.

use armill_core::path::{Pace, Parts, Track, scallop};
use armill_core::units::{to_deg, to_mm, to_um};

use crate::analysis::numbers::Numbers;
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::motion_columns;
use crate::analysis::path::process_loads::ProcessPoint;
use crate::analysis::path::run::PathResult;
use crate::analysis::quantity::{self, Quantity};

/// Line, distance and feed, and the deviation relative to the track.
pub fn columns<'a>(analysis: &'a PathAnalysis, found: &'a PathResult) -> Vec<Numbers<'a>> {
    let track = &analysis.track;
    let points = &track.path.points;
    let part = |quantity: &'static Quantity, of: fn(Parts) -> f64| {
        Numbers::of(quantity, move |rows, index, evaluation| {
            let deviation = rows.answers.deviations_at(index)[evaluation.worst_case];
            to_um(of(track.parts(index, &deviation)))
        })
    };
    let mut columns = vec![
        Numbers::given(&quantity::LINE, |index| f64::from(points[index].line)),
        Numbers::given(&quantity::PATH_X, |index| to_mm(points[index].at.x)),
        Numbers::given(&quantity::PATH_Y, |index| to_mm(points[index].at.y)),
        Numbers::given(&quantity::PATH_Z, |index| to_mm(points[index].at.z)),
        Numbers::given(&quantity::DISTANCE, |index| to_mm(points[index].along)),
        Numbers::given(&quantity::FEED, |index| match points[index].pace {
            Pace::Feed(speed) => Some(to_mm(speed)),
            _ => None,
        }),
        part(&quantity::ALONG, |parts| parts.along),
        part(&quantity::CROSS, |parts| parts.cross),
        part(&quantity::AXIAL, |parts| parts.axial),
    ];
    let searched = found.searched.as_ref().map(|searched| &searched.posture.spins);
    let of_curve = track.spins.as_ref().filter(|_| analysis.spin_curve.is_some());
    columns.extend(
        searched
            .or(of_curve)
            .map(|spins| Numbers::of(&quantity::TURN, move |_, index, _| to_deg(spins[index]))),
    );
    let leans = found
        .searched
        .as_ref()
        .and_then(|searched| searched.posture.leans.as_ref());
    if let Some((leans, end)) = leans {
        let search = analysis.setting.search.as_ref();
        let stepover = search.and_then(|search| search.lean?.stepover);
        columns.extend(stepover.map(|stepover| {
            Numbers::of(&quantity::SCALLOP, move |_, index, _| {
                scallop(*end, leans[index], stepover).map_or(f64::NAN, to_um)
            })
        }));
        columns.extend([
            Numbers::of(&quantity::LEAD, move |_, index, _| to_deg(leans[index].lead)),
            Numbers::of(&quantity::TILT, move |_, index, _| to_deg(leans[index].tilt)),
        ]);
    }
    columns.extend(process(found));
    columns.extend(unloaded(track, found));
    columns.extend(motion_columns::columns(found));
    columns
}

/// Force, torque, chip thickness and removal rate; none if the load is not from a cut.
fn process(found: &PathResult) -> Vec<Numbers<'_>> {
    let Some(process) = &found.process else {
        return Vec::new();
    };
    let value = |quantity: &'static Quantity, of: fn(&ProcessPoint) -> f64| {
        Numbers::of(quantity, move |_, index, _| of(&process.points[index]))
    };
    vec![
        value(&quantity::FORCE, |point| point.force),
        value(&quantity::TORQUE, |point| point.torque),
        value(&quantity::CHIP, |point| to_um(point.chip)),
        value(&quantity::REMOVAL, |point| point.removal_rate * 1e9),
    ]
}

/// The part of the deviation without load; none if all of it is due to the load.
fn unloaded<'a>(track: &'a Track, found: &'a PathResult) -> Vec<Numbers<'a>> {
    let Some(unloaded) = &found.along.backlash_geometry else {
        return Vec::new();
    };
    let part = |quantity: &'static Quantity, of: fn(Parts) -> f64| {
        Numbers::of(quantity, move |rows, index, evaluation| {
            let moved = unloaded.displacements[index * rows.answers.case_count + evaluation.worst_case];
            to_um(of(track.parts(index, &moved)))
        })
    };
    vec![
        part(&quantity::UNLOADED_ALONG, |parts| parts.along),
        part(&quantity::UNLOADED_CROSS, |parts| parts.cross),
        part(&quantity::UNLOADED_AXIAL, |parts| parts.axial),
    ]
}
