//! What a program for a cut has to satisfy, checked on its events.
//!
//! The cut is given as commanded points in the frame of the part, z upwards from it. `follows` matches the moves of the
//! program with them; the other checks use this match.

use crate::event::{Action, Blend, Event, JointTarget, LinearMove, Speed};
use crate::pose::{Pose, distance};
use crate::source::ReplayError;

/// A point of the program may differ from the commanded one by what a controller's numbers round, mm.
pub const POSITION_MM: f64 = 0.002;
/// Largest angle between the axis of the tool and the commanded one, deg.
pub const ANGLE_DEG: f64 = 1e-3;
/// A retract or approach is along the tool within this, mm.
const LATERAL_MM: f64 = 0.01;

/// Cuts are moved by their corrections: on the way from one to the next above it the tool shifts by less than this, mm.
const SHIFT_MM: f64 = 0.6;

/// A point that the tool has to reach.
#[derive(Clone, Debug)]
pub struct CutPoint {
    pub position_mm: [f64; 3],
    /// From the tip towards the spindle.
    pub axis: [f64; 3],
    pub feed_mm_per_s: Option<f64>,
    /// The move to this point does not cut.
    pub rapid: bool,
}

/// What is cut, and how closely.
#[derive(Debug)]
pub struct Cut {
    pub points: Vec<CutPoint>,
    /// Frame of the part from the robot, if targets are not given in it.
    pub frame: Option<Pose>,
    /// Height above which the tool moves freely, mm.
    pub clearance_mm: f64,
    /// Largest distance of a commanded point from the lines of the program, mm.
    pub chord_mm: f64,
}

/// For each event the commanded point that it moves to.
pub type Matches = Vec<Option<usize>>;

impl Cut {
    /// A target in the frame of the part.
    fn pose(&self, base: Option<Pose>, to: &Pose) -> Option<Pose> {
        match &self.frame {
            None => Some(*to),
            Some(frame) => Some(frame.inverse().then(&base?).then(to)),
        }
    }

    fn of_linear(&self, linear: &LinearMove) -> Option<Pose> {
        self.pose(linear.base.pose, &linear.to)
    }

    /// Whether the tool cuts all the way from one commanded point to another.
    fn is_cut(&self, from: usize, to: usize) -> bool {
        from <= to && !self.points[from..=to].iter().skip(1).any(|point| point.rapid)
    }
}

/// Matches the lines of a program with the commanded points, in their order.
///
/// # Errors
/// A line below the clearance to no commanded point; a tool that is not along the axis; a commanded point that the
/// lines pass at a larger distance than the chord.
pub fn follows(events: &[Event], cut: &Cut) -> Result<Matches, ReplayError> {
    let mut matches = vec![None; events.len()];
    let mut covered = vec![false; cut.points.len()];
    let mut last: Option<(usize, Pose)> = None;
    // Where the last line ended, on the path or not.
    let mut ended: Option<Pose> = None;
    let mut first = 0;
    for (event, matched) in events.iter().zip(&mut matches) {
        let linear = match &event.action {
            Action::Linear(linear) => linear,
            Action::Circular { .. } => return Err(event.place.error("an arc is not compared with points")),
            Action::Joint(_) => {
                (last, ended) = (None, None);
                continue;
            }
            _ => continue,
        };
        let pose = cut
            .of_linear(linear)
            .ok_or_else(|| event.place.error("the base of the move is not known"))?;
        let from = ended.replace(pose);
        // Places on the way to and from a cut are checked by `clear`.
        let is_along_tool = from.is_some_and(|from| {
            along_tool(&from, &pose) || along_tool(&pose, &from) || is_shift(&from, &pose)
        });
        let near = |point: &CutPoint| distance(point.position_mm, pose.position_mm) <= POSITION_MM;
        let Some(mut index) = (first..cut.points.len()).find(|index| near(&cut.points[*index])) else {
            if pose.position_mm[2] < cut.clearance_mm && !is_along_tool {
                let nearest = cut.points[first.min(cut.points.len())..]
                    .iter()
                    .map(|point| distance(point.position_mm, pose.position_mm))
                    .fold(f64::INFINITY, f64::min);
                return Err(event.place.error(format!(
                    "a line to {:.3?} mm, {:.1} um from the nearest commanded point",
                    pose.position_mm,
                    nearest * 1e3
                )));
            }
            last = None;
            continue;
        };
        // A cut that begins where the last one ended begins with the rapid move there.
        while last.is_none()
            && cut
                .points
                .get(index + 1)
                .is_some_and(|next| next.rapid && near(next))
        {
            index += 1;
        }
        let off = angle_deg(pose.z_axis().map(|part| -part), cut.points[index].axis);
        if off > ANGLE_DEG {
            return Err(event
                .place
                .error(format!("the tool is {off:.4} deg off the commanded axis")));
        }
        covered[index] = true;
        if let Some((before, from)) = last
            && cut.is_cut(before, index)
        {
            for (between, done) in covered.iter_mut().enumerate().take(index).skip(before + 1) {
                let apart = to_segment(
                    cut.points[between].position_mm,
                    from.position_mm,
                    pose.position_mm,
                );
                if apart > cut.chord_mm {
                    return Err(event.place.error(format!(
                        "the line passes commanded point {between} at {:.1} um",
                        apart * 1e3
                    )));
                }
                *done = true;
            }
        }
        first = index;
        last = Some((index, pose));
        *matched = Some(index);
    }
    match (0..covered.len()).find(|index| !covered[*index] && !cut.points[*index].rapid) {
        Some(missed) => {
            let place = events.last().map(|event| event.place.clone());
            let place = place.unwrap_or_else(crate::source::Place::nowhere);
            let at = cut.points[missed].position_mm;
            Err(place.error(format!("no line goes to commanded point {missed} at {at:.3?} mm")))
        }
        None => Ok(matches),
    }
}

/// Where the tool is between two moves.
#[derive(Clone, Copy, PartialEq)]
enum At {
    /// At this commanded point.
    Cut(usize),
    /// Below the clearance, on its way up from a cut.
    Leaving,
    /// Below the clearance, on its way down to a cut.
    Arriving,
    /// Above the clearance.
    Free,
}

/// No move below the clearance, except along the cut, and along the tool to its begin and from its end.
pub fn clear(events: &[Event], cut: &Cut, matches: &Matches) -> Result<(), ReplayError> {
    let mut last: Option<(Pose, At)> = None;
    for (event, matched) in events.iter().zip(matches) {
        let low = |pose: &Pose| pose.position_mm[2] < cut.clearance_mm;
        match &event.action {
            Action::Joint(joint) => {
                let to = match &joint.to {
                    JointTarget::Pose { pose, .. } => cut.pose(joint.base.pose, pose),
                    _ => None,
                };
                let from = last.map(|(pose, _)| pose);
                if from.iter().chain(&to).any(low) {
                    return Err(event
                        .place
                        .error("a joint move begins or ends below the clearance"));
                }
                last = to.map(|pose| (pose, At::Free));
            }
            Action::Linear(linear) => {
                let Some(to) = cut.of_linear(linear) else { continue };
                let mut at = match *matched {
                    Some(index) => At::Cut(index),
                    None => At::Free,
                };
                if let Some((from, before)) = last
                    && (low(&from) || low(&to))
                {
                    let up = before != At::Arriving && along_tool(&from, &to);
                    // Also after a way up, as in pecks: along the way that the tool came.
                    let down = along_tool(&to, &from);
                    let shift = before == At::Leaving && is_shift(&from, &to);
                    let allowed = match (before, at) {
                        (At::Cut(before), At::Cut(now)) => cut.is_cut(before, now),
                        (At::Cut(_), _) => up,
                        (_, At::Cut(_)) => down,
                        _ => up || down || shift,
                    };
                    if !allowed {
                        return Err(event.place.error(format!(
                            "a line from {:.3?} to {:.3?} mm is below the clearance of {} mm and not along the cut",
                            from.position_mm, to.position_mm, cut.clearance_mm
                        )));
                    }
                    if at == At::Free && low(&to) {
                        at = if up && !down { At::Leaving } else { At::Arriving };
                    }
                }
                last = Some((to, at));
            }
            _ => {}
        }
    }
    Ok(())
}

/// All axes that the program gives are within the limits of the robot, deg.
pub fn within_limits(events: &[Event], limits: &[(f64, f64)]) -> Result<(), ReplayError> {
    for event in events {
        let Action::Joint(joint) = &event.action else {
            continue;
        };
        let JointTarget::Axes(axes) = &joint.to else {
            continue;
        };
        if axes.len() != limits.len() {
            return Err(event
                .place
                .error(format!("{} axes, the robot has {}", axes.len(), limits.len())));
        }
        for (index, (axis, (from, to))) in axes.iter().zip(limits).enumerate() {
            if axis < from || axis > to {
                let number = index + 1;
                return Err(event.place.error(format!(
                    "axis {number} at {axis} deg exceeds its limits of {from} to {to} deg"
                )));
            }
        }
    }
    Ok(())
}

/// An event that switches the spindle on, by the rule given, is before the first line of the cut.
pub fn spindle_on(
    events: &[Event],
    matches: &Matches,
    is_spindle: impl Fn(&Action) -> bool,
) -> Result<(), ReplayError> {
    for (event, matched) in events.iter().zip(matches) {
        if is_spindle(&event.action) {
            return Ok(());
        }
        if matched.is_some() {
            return Err(event.place.error("the cut begins, and the spindle is not on"));
        }
    }
    Ok(())
}

/// Inside of a cut the tool does not come to rest.
pub fn no_stop_in_cut(events: &[Event], cut: &Cut, matches: &Matches) -> Result<(), ReplayError> {
    // The last line of the cut, and whether the tool cuts towards it.
    let mut last: Option<(usize, usize, bool)> = None;
    let mut rest: Option<usize> = None;
    for (at, (event, matched)) in events.iter().zip(matches).enumerate() {
        match &event.action {
            Action::Linear(_) | Action::Joint(_) | Action::Circular { .. } => {}
            Action::Dwell { .. } | Action::Stop { .. } | Action::Wait { .. } => {
                rest = Some(at);
                continue;
            }
            _ => continue,
        }
        if let (Some((before, index, cutting)), Some(now)) = (last, *matched)
            && cutting
            && cut.is_cut(index, now)
        {
            let exact =
                matches!(&events[before].action, Action::Linear(linear) if linear.blend == Blend::Exact);
            if exact {
                return Err(events[before].place.error("an exact stop inside of a cut"));
            }
            if let Some(rest) = rest {
                return Err(events[rest].place.error("the program waits inside of a cut"));
            }
        }
        last = matched.map(|now| {
            let cutting = last.is_some_and(|(_, index, _)| cut.is_cut(index, now));
            (at, now, cutting)
        });
        rest = None;
    }
    Ok(())
}

/// The tool moves with the commanded feed, within what the numbers of the language round, mm/s.
pub fn feeds(events: &[Event], cut: &Cut, matches: &Matches, rounding: f64) -> Result<(), ReplayError> {
    for (event, matched) in events.iter().zip(matches) {
        let (Some(linear), Some(index)) = (event.action.linear(), *matched) else {
            continue;
        };
        let point = &cut.points[index];
        if let (Some(feed), Speed::MmPerS(speed), false) = (point.feed_mm_per_s, linear.speed, point.rapid)
            && (speed - feed).abs() > rounding
        {
            return Err(event
                .place
                .error(format!("{speed} mm/s, commanded are {feed} mm/s")));
        }
    }
    Ok(())
}

/// Blends of two targets in succession do not overlap: the controllers of Universal Robots refuse that.
///
/// Source: Universal Robots UR5 user manual, version 3.4.5, section 14.6, blend parameters.
pub fn blends_apart(events: &[Event]) -> Result<(), ReplayError> {
    let radius = |linear: &LinearMove| match linear.blend {
        Blend::DistanceMm(radius) => radius,
        _ => 0.0,
    };
    let mut last: Option<&LinearMove> = None;
    for event in events {
        match &event.action {
            Action::Linear(linear) => {
                if let Some(before) = last {
                    let (sum, apart) = (radius(before) + radius(linear), before.to.distance_mm(&linear.to));
                    if sum > apart {
                        return Err(event.place.error(format!(
                            "the blends of this target and the one before it overlap: {sum:.3} mm, {apart:.3} mm apart"
                        )));
                    }
                }
                last = Some(linear);
            }
            Action::Joint(_) | Action::Circular { .. } => last = None,
            _ => {}
        }
    }
    Ok(())
}

/// Whether `away` is on the axis of the tool at `at`, on the side of the spindle.
fn along_tool(at: &Pose, away: &Pose) -> bool {
    let [x, y, z] = at.inverse().point(away.position_mm);
    x.hypot(y) <= LATERAL_MM && z <= LATERAL_MM
}

/// Whether the move is a small one across the tool, at one height.
fn is_shift(from: &Pose, to: &Pose) -> bool {
    let [x, y, z] = from.inverse().point(to.position_mm);
    x.hypot(y) <= SHIFT_MM && z.abs() <= LATERAL_MM
}

fn to_segment(point: [f64; 3], from: [f64; 3], to: [f64; 3]) -> f64 {
    let along: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
    let square: f64 = along.iter().map(|part| part * part).sum();
    let dot: f64 = (0..3).map(|axis| (point[axis] - from[axis]) * along[axis]).sum();
    let share = if square > 0.0 {
        (dot / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    distance(
        point,
        std::array::from_fn(|axis| from[axis] + share * along[axis]),
    )
}

fn angle_deg(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ];
    let dot: f64 = (0..3).map(|axis| a[axis] * b[axis]).sum();
    (x * x + y * y + z * z).sqrt().atan2(dot).to_degrees()
}

#[cfg(test)]
mod tests;
