//! Mean cutting forces of leaning end mills against those from a map of heights of the material. See README.md.

use armill_core::load::{
    Cut, Cutter, CuttingLaw, Engagement, Hand, Immersion, Lean, LeanInCut, Mechanistic, Milling,
};
use armill_core::units::{from_deg, from_mm};
use nalgebra::{Matrix3, Vector3};

use crate::check::{Check, ErrorBound, worst};

const REFERENCE: &str = "map of heights";
/// Written by `record.py`.
const FORCES: &str = include_str!("forces.tsv");
/// Feed per tooth, m.
const FEED: f64 = 0.1e-3;
/// Permitted difference over the length of the force: that of the map.
const TOLERANCE: f64 = 0.01;
/// Slices of the edge, each with steps of its arcs, leave this much of a volume.
const OF_VOLUME: f64 = 1e-3;

/// A row of the record.
struct Row {
    cutter: Cutter,
    cut: Cut,
    /// Along the feed, to its left, along the normal, N.
    force: Vector3<f64>,
}

/// The checks.
pub fn checks() -> Vec<Check> {
    let rows: Vec<Row> = FORCES.lines().skip(1).filter_map(row).collect();
    let upright = |row: &&Row| row.cut.lean.lean == Lean::NONE;
    let of = |rows: Vec<&Row>| worst(rows.into_iter().map(of_force));
    let count = rows.len();
    let bound = |worst: f64, tolerance: f64| ErrorBound {
        worst,
        tolerance,
        unit: "",
    };
    vec![
        Check::printed(
            "mean forces of upright tools, over their length",
            REFERENCE,
            bound(of(rows.iter().filter(upright).collect()), TOLERANCE),
            4,
        ),
        Check::printed(
            format!("mean forces of leaning tools, over their length ({count} cuts with the upright ones)"),
            REFERENCE,
            bound(of(rows.iter().filter(|row| !upright(row)).collect()), TOLERANCE),
            4,
        ),
        Check::printed(
            "volume of the chips of a slot of a ball nose in nine leans, relative",
            "section of the material times the feed",
            bound(worst(leans().map(of_volume)), OF_VOLUME),
            4,
        ),
    ]
}

/// A row; `None` where it is not one.
fn row(line: &str) -> Option<Row> {
    let fields: Vec<&str> = line.split('\t').collect();
    let number = |index: usize| fields.get(index)?.parse::<f64>().ok();
    let mm = |index: usize| number(index).map(from_mm);
    let cutter = Cutter::bull_nose(mm(0)?, mm(1)?, fields.get(2)?.parse().ok()?).ok()?;
    let immersion = match *fields.get(4)? {
        "slot" => Immersion::Slot,
        "up" => Immersion::Up(mm(5)?),
        "down" => Immersion::Down(mm(5)?),
        _ => return None,
    };
    let lean = Lean {
        lead: from_deg(number(6)?),
        tilt: from_deg(number(7)?),
    };
    Some(Row {
        cutter,
        cut: cut(&cutter, immersion, mm(3)?)?.leaning(lean, cutter.body()),
        force: Vector3::new(number(8)?, number(9)?, number(10)?),
    })
}

fn cut(cutter: &Cutter, immersion: Immersion, depth: f64) -> Option<Cut> {
    Some(Cut {
        depth,
        engagement: Engagement::at_depth(immersion, cutter, depth).ok()?,
        feed: FEED,
        rise: 0.0,
        lean: LeanInCut::default(),
    })
}

/// Difference of a mean force, over its length.
fn of_force(row: &Row) -> f64 {
    let law = Mechanistic::new(Vector3::new(631e6, 99e6, 273e6), Vector3::new(13e3, 10e3, 2.8e3));
    let cutter = row.cutter.with_helix(0.0, Hand::Right);
    let (Ok(law), Ok(cutter)) = (law, cutter) else {
        return f64::NAN;
    };
    let Ok(milling) = Milling::new(cutter, CuttingLaw::Mechanistic(law), row.cut) else {
        return f64::NAN;
    };
    // Feed frame of the leaning tool: x along the feed across its axis.
    let axis = row.cut.lean.lean.axis();
    let x = (Vector3::x() - axis * axis.x).normalize();
    let axes = Matrix3::from_columns(&[x, axis.cross(&x), axis]);
    (axes * milling.mean_force() - row.force).norm() / row.force.norm()
}

fn leans() -> impl Iterator<Item = Lean> {
    let angles = [-25.0, 0.0, 25.0].map(from_deg);
    angles
        .into_iter()
        .flat_map(move |lead| angles.map(|tilt| Lean { lead, tilt }))
}

/// Relative difference of the volume that the teeth of a ball nose remove from that of its track: a segment of a circle times
/// the feed. With a tangential force of 1 N for 1 m2 of chip the torque is the volume per radian.
fn of_volume(lean: Lean) -> f64 {
    let (radius, depth, flutes) = (6e-3, 1e-3, 2);
    let of_lean = || {
        let cutter = Cutter::ball(2.0 * radius, flutes).ok()?;
        let law = CuttingLaw::Mechanistic(Mechanistic::new(Vector3::x(), Vector3::zeros()).ok()?);
        let cut = cut(&cutter, Immersion::Slot, depth)?.leaning(lean, cutter.body());
        let torque = Milling::new(cutter, law, cut).ok()?.mean_torque();
        Some(torque * std::f64::consts::TAU / f64::from(flutes))
    };
    let half = (1.0 - depth / radius).acos();
    let segment = radius * radius * (half - half.sin() * half.cos());
    of_lean().map_or(f64::NAN, |removed| removed / (segment * FEED) - 1.0)
}
