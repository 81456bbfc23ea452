//! Columns that only a path has.
//!
//! | column | unit | meaning |
//! |---|---|---|
//! | `line` | - | line of the program, or piece of the shape |
//! | `distance_mm` | mm | along all cuts before |
//! | `feed_mm_per_s` | mm/s | speed of the tip; empty if the program does not specify it |
//! | `turn_deg` | deg | spin of the tool that a search found |
//! | `along_um`, `cross_um`, `axial_um` | um | components of the deviation of the worst case relative to the track |
//! | `unloaded_along_um`, `unloaded_cross_um`, `unloaded_axial_um` | um | their part due to backlash and geometry |

use armill_core::path::{Pace, Parts, Track};

use super::{MM_DECIMALS, Numbers};
use crate::run::PathResult;

/// Line, distance and feed, and the deviation relative to the track.
pub(super) fn columns<'a>(track: &'a Track, found: &'a PathResult) -> Vec<Numbers<'a>> {
    let points = &track.path.points;
    let part = |name: &str, description: &'static str, of: fn(Parts) -> f64| {
        Numbers::um(name.to_owned(), description, move |rows, index, evaluation| {
            let deviation = rows.answers.deviations_at(index)[evaluation.worst_case];
            of(track.parts(index, &deviation)) * 1e6
        })
    };
    let turned = found.searched.as_ref().map(|searched| {
        let spins = &searched.posture.spins;
        Numbers::deg(
            "turn_deg".to_owned(),
            "spin of the tool about its axis that was found, relative to the one without the search",
            move |_, index, _| spins[index].to_degrees(),
        )
    });
    let mut columns = vec![
        Numbers {
            unit: None,
            decimals: 0,
            ..Numbers::um(
                "line".to_owned(),
                "line of the program, or piece of the shape",
                move |_, index, _| f64::from(points[index].line),
            )
        },
        Numbers {
            unit: Some("mm"),
            decimals: MM_DECIMALS,
            ..Numbers::um(
                "distance_mm".to_owned(),
                "distance along all cuts before",
                move |_, index, _| points[index].along * 1e3,
            )
        },
        Numbers {
            unit: Some("mm/s"),
            decimals: MM_DECIMALS,
            ..Numbers::um(
                "feed_mm_per_s".to_owned(),
                "speed of the tip, if the program specifies it",
                move |_, index, _| match points[index].pace {
                    Pace::Feed(speed) => speed * 1e3,
                    _ => f64::NAN,
                },
            )
        },
        part(
            "along_um",
            "deviation of the worst case along the track",
            |parts| parts.along,
        ),
        part(
            "cross_um",
            "deviation of the worst case across the track, to the left",
            |parts| parts.cross,
        ),
        part(
            "axial_um",
            "deviation of the worst case along the tool, away from the part",
            |parts| parts.axial,
        ),
    ];
    columns.extend(turned);
    columns.extend(unloaded(track, found));
    columns
}

/// The part of the deviation without load; none if all of it is due to the load.
fn unloaded<'a>(track: &'a Track, found: &'a PathResult) -> Vec<Numbers<'a>> {
    let Some(unloaded) = &found.along.backlash_geometry else {
        return Vec::new();
    };
    let part = |name: &str, description: &'static str, of: fn(Parts) -> f64| {
        Numbers::um(name.to_owned(), description, move |rows, index, evaluation| {
            let moved = unloaded.displacements[index * rows.answers.case_count + evaluation.worst_case];
            of(track.parts(index, &moved)) * 1e6
        })
    };
    vec![
        part(
            "unloaded_along_um",
            "part of along_um due to backlash and geometry",
            |parts| parts.along,
        ),
        part(
            "unloaded_cross_um",
            "part of cross_um due to backlash and geometry",
            |parts| parts.cross,
        ),
        part(
            "unloaded_axial_um",
            "part of axial_um due to backlash and geometry",
            |parts| parts.axial,
        ),
    ]
}
