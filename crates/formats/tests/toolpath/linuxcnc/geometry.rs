//! What its programs must look like in space.

use std::f64::consts::PI;
use std::path::Path;

use armill_core::nalgebra::Vector3;
use armill_core::path::{Course, Move, Step};
use armill_formats::toolpath::gcode::{self, GcodeReadOptions, Rotaries};

use super::{bytes, linuxcnc};

fn moves(file: &Path, expected: &GcodeReadOptions<'_>) -> Vec<Move> {
    let mut moves = Vec::new();
    let summary = gcode::read("p", bytes(file).as_slice(), expected, &mut |step| {
        if let Step::Move(next) = step {
            moves.push(next);
        }
    });
    assert!(summary.unwrap_or_else(|problems| panic!("{problems}")).moves as usize == moves.len());
    moves
}

const FIVE_AXES: &str = "configs/sim/axis/vismach/5axis/table-rotary-tilting/demos";

/// Plunges and retracts along the tool axis: between a rapid and a cut, the rotary axes at rest and the tool tilted.
fn plunges_along_axis(path: &Path, rotaries: Rotaries) -> usize {
    let expected = GcodeReadOptions {
        rotaries: Some(rotaries),
        ..GcodeReadOptions::default()
    };
    let along = |pair: &&[Move]| {
        let [before, next] = pair else { return false };
        let (Some(from), Some(axis)) = (before.axis, next.axis) else {
            return false;
        };
        let way = next.end - before.end;
        // Coordinates and angles are written to 1 um and 0.001 deg: over 1.5 mm that is below 0.001 rad. 0.01 leaves
        // room for feet of plunges that were put on a surface, and is far less than the tilt.
        from == axis
            && axis.z < 0.9999
            && before.pace.cuts() != next.pace.cuts()
            && way.norm() > 1.5e-3
            && way.cross(&axis).norm() < 0.01 * way.norm()
    };
    moves(path, &expected).windows(2).filter(along).count()
}

#[test]
fn plunges_run_along_the_tool_axis_of_the_part() {
    let Some(folder) = linuxcnc() else { return };
    for (file, table, head, expected) in [
        (
            "impeller-7bl-xyzac.ngc",
            Rotaries::table_ac(),
            Rotaries::head_ca(),
            29,
        ),
        ("boat-xyzbc.ngc", Rotaries::table_bc(), Rotaries::head_cb(), 9),
    ] {
        let path = folder.join(FIVE_AXES).join(file);
        assert_eq!(plunges_along_axis(&path, table), expected, "{file}");
        assert_eq!(
            plunges_along_axis(&path, head),
            0,
            "{file}: on another machine they do not"
        );
    }
}

/// Quarters of a turn and axes, worked out by hand; the names and remarks of the files say otherwise.
#[test]
fn arcs_sweep_as_they_should_in_every_plane() {
    let Some(folder) = linuxcnc() else { return };
    let folder = folder.join("tests/trajectory-planner/circular-arcs/nc_files/arc-feed");
    for (file, expected) in [
        ("full_xy.ngc", &[(3.0, Vector3::z())][..]),
        ("full_xz.ngc", &[(1.0, -Vector3::x())]),
        ("full_yz.ngc", &[(3.0, -Vector3::y()), (1.0, Vector3::y())]),
    ] {
        let mut arcs = Vec::new();
        for next in moves(&folder.join(file), &GcodeReadOptions::default()) {
            if let Course::Arc(arc) = next.course {
                arcs.push(arc);
            }
        }
        assert_eq!(arcs.len(), expected.len(), "{file}");
        for (arc, (quarters, axis)) in arcs.iter().zip(expected) {
            // Ends in inches: a few roundings.
            assert!(
                (arc.sweep - quarters * PI / 2.0).abs() < 1e-14,
                "{file}: {}",
                arc.sweep
            );
            assert_eq!(arc.axis.into_inner(), *axis, "{file}");
        }
    }
}
