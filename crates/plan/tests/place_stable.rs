//! Placement where the cut must be stable: an arm with one soft joint, whose only mode is known by hand, and a spindle speed that suits it on
//! one side of the range alone.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::TAU;
use std::path::Path;

use armill_core::dynamics::Mode;
use armill_core::nalgebra::Vector6;
use armill_core::stability::{CutOfAnyDepth, StabilityLobes};
use armill_core::watch::Watch;
use armill_plan::place::{Journal, PlacementAnswer, PlacementSearch};
use armill_study::analysis::Subject;
use armill_study::file::placement::PlaceTable;
use armill_study::file::resolve::{Study, read};

#[path = "../../study/tests/shared/without_masses.rs"]
mod without_masses;
use without_masses::without_masses;

/// Range of the part in x, mm: the distance from the first axis, the only one that deflects.
const RANGE_MM: [f64; 2] = [850.0, 1100.0];
/// Compliance of the first joint (rad/(N m)), mass at the tip (kg), damping ratio.
const COMPLIANCE: f64 = 1e-6;
const MASS: f64 = 40.0;
const DAMPING: f64 = 0.03;

/// Frequency of the mode at this distance from the first axis (m): `J = m r^2`, `f = 1/(2 pi sqrt(J c))`, Hz.
fn frequency(r: f64) -> f64 {
    1.0 / (TAU * r * (MASS * COMPLIANCE).sqrt())
}

/// A short slot along y, along which the mode moves the tip; the teeth pass at the frequency of the mode at the far end of the range.
fn study(depth_mm: f64, vibration: &str) -> Study {
    let rpm = frequency(RANGE_MM[1] / 1e3) * 60.0 / 2.0;
    let feed = 0.05 * 2.0 * rpm;
    let text = format!(
        r#"
format = 1
robot = "yaskawa/mh12"
tolerance_um = 100000
plane = {{ centre_mm = [900, 0, 500], tilt_deg = 90, half_size_mm = 50, step_mm = 50 }}
posture = {{ branch = "front elbow-up no-flip" }}
compliance = {{ rad_per_n_m = [{COMPLIANCE}, 0, 0, 0, 0, 0], source = "own" }}
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
[[tool.mass]]
at = "tool"
mass_kg = {MASS}
centre_mm = [0, 0, 0]
source = "own"
[cut]
material = "aluminium-7075-t6"
axial_depth_mm = {depth_mm}
side = "slot"
spindle_rpm = {rpm}
feed_mm_per_min = {feed}
cutter = {{ diameter_mm = 10, flutes = 2 }}
[vibration]
damping_ratio = {DAMPING}
{vibration}
[[analysis]]
kind = "path"
name = "slot"
line = {{ from_mm = [-10, 0], to_mm = [10, 0] }}
step_mm = 10
"#
    );
    let text = without_masses(&text);
    read("study.toml", Path::new("."), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// Stable depth at this distance from the first axis, m: one mode along the feed with the modal mass `m`.
fn stable_depth(study: &Study, r: f64) -> f64 {
    let Subject::Path(path) = &study.analyses[0].subject else {
        panic!("a path")
    };
    let cut = path.cut.as_ref().unwrap();
    let (spindle, feed) = (cut.cutting.spindle.unwrap(), cut.cutting.feed.unwrap());
    let milling = cut.milling([spindle, feed], None).unwrap();
    let mode = Mode {
        angular_frequency: TAU * frequency(r),
        damping_ratio: DAMPING,
        shape: Vector6::new(1.0 / MASS.sqrt(), 0.0, 0.0, 0.0, 0.0, 0.0),
    };
    let deepest = 20e-3;
    let lobes = StabilityLobes::new(&[mode], &CutOfAnyDepth::new(&milling), deepest).unwrap();
    lobes.at_speed(spindle).map_or(deepest, |limit| limit.depth)
}

fn placed(study: &Study) -> PlacementAnswer {
    let table = PlaceTable {
        x_mm: Some(RANGE_MM),
        ..PlaceTable::default()
    };
    let search = PlacementSearch::new(study, table, 0).unwrap().brief();
    search
        .search(&mut Journal::none(), Watch::NONE, &|_| ())
        .unwrap()
        .answer
}

#[test]
fn a_placement_whose_cut_is_not_stable_is_not_preferred_over_a_stable_one() {
    let any = study(1.0, "");
    let [near, far] = RANGE_MM.map(|mm| stable_depth(&any, mm / 1e3));
    assert!(far > 1.5 * near, "{near} {far}");
    let depth_mm = (near * far).sqrt() * 1e3;
    // The deflection grows with the square of the distance: without the demand the part is near.
    let free = placed(&study(depth_mm, ""));
    assert!(free.place.centre_mm[0] < RANGE_MM[0] + 1.0, "{:?}", free.place);
    assert_eq!(free.recommended.unreachable_points, 0);
    assert_eq!(free.recommended.unstable_points, Some(free.points));
    let limit = free.recommended.stable_depth_mm.unwrap();
    assert!((limit / (near * 1e3) - 1.0).abs() < 2e-2, "{limit} {near}");
    let demanded = study(depth_mm, "must_be_stable = true");
    let found = placed(&demanded);
    assert_eq!(found.recommended.unstable_points, Some(0));
    assert_eq!(found.recommended.unreachable_points, 0);
    let x = found.place.centre_mm[0];
    assert!(stable_depth(&demanded, x / 1e3) * 1e3 > 0.98 * depth_mm, "{x}");
    // The nearest stable place: a little nearer it chatters.
    assert!(
        stable_depth(&demanded, x / 1e3 - 5e-3) * 1e3 < 1.02 * depth_mm,
        "{x}"
    );
    assert!(found.nominal.unstable_points > Some(0) && found.is_improvement);
    let lines = found.sentences().join(" ");
    assert!(lines.contains("Least stable depth"), "{lines}");
}
