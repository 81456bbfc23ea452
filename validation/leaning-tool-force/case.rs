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
    /// Whether the side of the material is what the pass before left.
    is_next_to_pass: bool,
    cutter: Cutter,
    cut: Cut,
    /// Along the feed, to its left, along the normal, N.
    force: Vector3<f64>,
}

/// The checks.
pub fn checks() -> Vec<Check> {
    let rows: Vec<Row> = FORCES.lines().skip(1).filter_map(row).collect();
    let upright = |row: &&Row| row.cut.lean.lean == Lean::NONE;
    let (next_to_pass, between_walls): (Vec<&Row>, Vec<&Row>) =
        rows.iter().partition(|row| row.is_next_to_pass);
    let of = |rows: Vec<&Row>| worst(rows.into_iter().map(of_force));
    let (count, next) = (rows.len(), next_to_pass.len());
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
            format!("mean forces in slots and next to walls, over their length ({count} cuts in all)"),
            REFERENCE,
            bound(of(between_walls), TOLERANCE),
            4,
        ),
        Check::printed(
            format!("mean forces next to a pass before, over their length ({next} of these)"),
            REFERENCE,
            bound(of(next_to_pass), TOLERANCE),
            4,
        ),
        Check::printed(
            "volume of the chips of a slot of a ball nose in nine leans, relative",
            "section of the material times the feed",
            bound(worst(leans().map(of_volume)), OF_VOLUME),
            4,
        ),
        Check::printed(
            "volume of the chips of a ball nose next to a pass before in nine leans, relative",
            "section between two circles times the feed",
            bound(worst(leans().map(of_volume_next_to_pass)), OF_VOLUME),
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
    let kind = *fields.get(4)?;
    let immersion = match kind.trim_start_matches("wall-") {
        "slot" => Immersion::Slot,
        "up" => Immersion::Up(mm(5)?),
        "down" => Immersion::Down(mm(5)?),
        _ => return None,
    };
    let upright = cut(&cutter, immersion, mm(3)?)?;
    let upright = match kind.starts_with("wall-") {
        true => at_wall(&cutter, upright)?,
        false => upright,
    };
    let lean = Lean {
        lead: from_deg(number(6)?),
        tilt: from_deg(number(7)?),
    };
    Some(Row {
        cutter,
        is_next_to_pass: upright.engagement.pass_before().is_some(),
        cut: upright.leaning(lean, cutter.body()),
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

/// The cut with a wall where the pass before was, at the radial depth from the widest circle that cuts.
fn at_wall(cutter: &Cutter, cut: Cut) -> Option<Cut> {
    let (displaced, radius) = (cut.engagement.pass_before()?, cutter.radius());
    let widest = cutter.at_height(cut.depth).radius;
    let edges = match displaced < 0.0 {
        true => [widest + displaced, radius],
        false => [-radius, displaced - widest],
    };
    let engagement = Engagement::strip(edges, cutter.diameter()).ok()?;
    Some(Cut { engagement, ..cut })
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

/// Radius of a ball nose, its depth and the distance of the pass before, m.
const BALL: [f64; 3] = [6e-3, 1e-3, 2.5e-3];

/// Relative difference of the volume that the teeth of a ball nose remove in a slot from a segment of a circle times the
/// feed.
fn of_volume(lean: Lean) -> f64 {
    removed(Immersion::Slot, lean).map_or(f64::NAN, |removed| removed / (segment() * FEED) - 1.0)
}

/// The same next to a pass before: the segment less what both circles have in common below the surface.
fn of_volume_next_to_pass(lean: Lean) -> f64 {
    let [radius, depth, stepover] = BALL;
    let half = (1.0 - depth / radius).acos();
    // Half the width of the common part is that of the segment less half the stepover; it ends at the ridge.
    let (wide, ridge) = (radius * half.sin(), 0.5 * stepover);
    let under = |y: f64| 0.5 * (y * (radius * radius - y * y).sqrt() + radius * radius * (y / radius).asin());
    let common = 2.0 * (under(wide) - under(ridge) - (wide - ridge) * (radius - depth));
    let expected = (segment() - common) * FEED;
    let up = removed(Immersion::Up(stepover), lean);
    let down = removed(Immersion::Down(stepover), lean);
    match (up, down) {
        (Some(up), Some(down)) => worst([up, down].map(|removed| removed / expected - 1.0)),
        _ => f64::NAN,
    }
}

/// Section of the track of the ball, m2.
fn segment() -> f64 {
    let [radius, depth, _] = BALL;
    let half = (1.0 - depth / radius).acos();
    radius * radius * (half - half.sin() * half.cos())
}

/// Volume that a tooth of the ball removes in a turn, m3: with a tangential force of 1 N for 1 m2 of chip the torque is the
/// volume per radian.
fn removed(immersion: Immersion, lean: Lean) -> Option<f64> {
    let ([radius, depth, _], flutes) = (BALL, 2);
    let cutter = Cutter::ball(2.0 * radius, flutes).ok()?;
    let law = CuttingLaw::Mechanistic(Mechanistic::new(Vector3::x(), Vector3::zeros()).ok()?);
    let cut = cut(&cutter, immersion, depth)?.leaning(lean, cutter.body());
    let torque = Milling::new(cutter, law, cut).ok()?.mean_torque();
    Some(torque * std::f64::consts::TAU / f64::from(flutes))
}
