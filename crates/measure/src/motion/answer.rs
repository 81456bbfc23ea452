//! What was learnt of a log, and how it predicts others, as one JSON value.
//!
//! Keys and units are a public contract: mm, deg, ms and s. `u` is a standard uncertainty.

use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm, to_ms};
use armill_study::StudyError;
use armill_study::number::decimals;
use serde::Serialize;

use super::course::Shape;
use super::learned::{Compared, ComparedStretch, Learned, MOST_U, compare, compared};
use super::observed::LEFT;
use super::question::{NamedLog, Question};
use super::reached::HALF_OF_ACCELERATION;
use super::stretches::HALF_WINDOW;

/// Decimals of the numbers.
const DECIMALS: i32 = 4;
/// Decimals of leads.
const LEAD_DECIMALS: i32 = 7;
/// A coordinate of the tip that is less certain is said to be, m.
const KNOWN: f64 = 5e-3;
/// Window and lag are hardly distinguished where their correlation is beyond this.
const NOT_APART: f64 = 0.9;

/// What logs say of the motion of an arm.
#[derive(Clone, Debug, Serialize)]
pub struct MotionAnswer {
    /// The robot.
    pub robot: String,
    /// The log that was learnt from.
    pub file: String,
    /// Instants in it.
    pub instants: usize,
    /// Usual step of time.
    pub step_ms: f64,
    /// Window of the parabolas whose slopes are the speeds.
    pub speed_window_ms: f64,
    /// Window of the parabolas whose curvatures are the accelerations.
    pub acceleration_window_ms: f64,
    /// The tip of the tool.
    pub tool: ToolAnswer,
    /// Moves of the log.
    pub moves: Vec<MoveAnswer>,
    /// What the joints reached, and how late they follow.
    pub joints: Vec<JointAnswer>,
    /// Acceleration along the path.
    pub path_acceleration_mm_per_s2: ValueAnswer,
    /// Window of the average.
    pub smoothing_ms: ValueAnswer,
    /// Lag of all joints, from starts and stops.
    pub lag_ms: ValueAnswer,
    /// Time that the controller waits at a stop.
    pub settling_ms: ValueAnswer,
    /// Correlation of window and lag.
    pub correlation_of_smoothing_and_lag: f64,
    /// Root mean square of predicted less logged speed with these values, per cent of the feed.
    pub feed_rms_percent: f64,
    /// The log itself, then the compared ones, with their predictions.
    pub compared: Vec<ComparedAnswer>,
    /// Ignored columns, each with its file.
    pub unused: Vec<String>,
    /// Values that are assumed, since neither log nor robot file gives them.
    pub assumed: Vec<String>,
    /// What to know of these numbers.
    pub notes: Vec<String>,
}

/// The tip of the tool.
#[derive(Clone, Debug, Serialize)]
pub struct ToolAnswer {
    /// From the flange, flange axes.
    pub tip_mm: [f64; 3],
    /// Standard uncertainty of its coordinates, if it was fitted.
    pub tip_u_mm: Option<[f64; 3]>,
    /// Distance of the moves from lines, root mean square, if it was fitted.
    pub straightness_rms_mm: Option<f64>,
}

/// A move.
#[derive(Clone, Debug, Serialize)]
pub struct MoveAnswer {
    /// `line`, `arc`, `curve` or `joint move`.
    pub shape: &'static str,
    /// Radius of an arc.
    pub radius_mm: Option<f64>,
    /// Line of the log where it begins.
    pub line: usize,
    /// Time from the first instant.
    pub start_s: f64,
    /// Duration.
    pub time_s: f64,
    /// Way of the tip.
    pub length_mm: f64,
    /// Largest speed of the tip.
    pub largest_speed_mm_per_s: f64,
}

/// A joint.
#[derive(Clone, Debug, Serialize)]
pub struct JointAnswer {
    /// Its name.
    pub name: String,
    /// Largest speed.
    pub speed_deg_per_s: f64,
    /// Largest acceleration: it can do this at least.
    pub acceleration_deg_per_s2: f64,
    /// Standard deviation of the acceleration at rest.
    pub acceleration_noise_deg_per_s2: Option<f64>,
    /// Delay of the actual behind the commanded position.
    pub delay_ms: Option<ValueAnswer>,
    /// Lag of the actual behind the commanded position.
    pub lag_ms: Option<ValueAnswer>,
    /// Lead of its motor over its acceleration, from how far the tip leaves its lines; none of the wrist, or where leads explain nothing.
    pub motor_lead_s2: Option<ValueAnswer>,
}

/// A value with its standard uncertainty.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ValueAnswer {
    /// The value.
    pub value: f64,
    /// Its standard uncertainty; none where the log does not determine it.
    pub u: Option<f64>,
}

/// A log and its prediction.
#[derive(Clone, Debug, Serialize)]
pub struct ComparedAnswer {
    /// Its file.
    pub file: String,
    /// Its stretches of straight moves from rest to rest.
    pub stretches: Vec<StretchAnswer>,
}

/// A stretch and its prediction.
#[derive(Clone, Debug, Serialize)]
pub struct StretchAnswer {
    /// When it starts.
    pub start_s: f64,
    /// Speed that the tip has most of the time: the feed of the prediction.
    pub feed_mm_per_s: f64,
    /// Time from start to end.
    pub cycle_time_s: Option<f64>,
    /// The same, predicted.
    pub predicted_cycle_time_s: Option<f64>,
    /// Predicted less logged.
    pub cycle_time_error_percent: Option<f64>,
    /// Root mean square of predicted less logged speed, per cent of the feed.
    pub feed_rms_percent: f64,
    /// Largest distance of the tip from the lines, away from corners that are passed.
    pub off_line_mm: f64,
    /// The same, predicted.
    pub predicted_off_line_mm: f64,
    /// Its corners.
    pub corners: Vec<CornerAnswer>,
}

/// A corner and its prediction.
#[derive(Clone, Debug, Serialize)]
pub struct CornerAnswer {
    /// Angle by which the path turns.
    pub turn_deg: f64,
    /// Least speed near it.
    pub least_speed_mm_per_s: f64,
    /// Radius of its zone; none for a stop.
    pub zone_mm: Option<f64>,
    /// Whether the zone is fitted to the distance of this corner, which is no prediction then.
    pub zone_is_fitted: bool,
    /// Standard uncertainty of a fitted zone.
    pub zone_u_mm: Option<f64>,
    /// Least distance of the tip from it.
    pub distance_mm: f64,
    /// Standard uncertainty of it.
    pub distance_u_mm: f64,
    /// The same, predicted.
    pub predicted_distance_mm: f64,
    /// Predicted less logged.
    pub distance_error_mm: f64,
}

/// The result of a log, with the predictions of others.
///
/// # Errors
/// A number of zones that does not belong to the logs.
pub fn answer(
    robot: &Robot,
    learned: &Learned,
    others: &[NamedLog],
    question: &Question,
) -> Result<MotionAnswer, StudyError> {
    if !question.zones.is_empty() && question.zones.len() != 1 && question.zones.len() != others.len() {
        return Err(StudyError::value(
            format!(
                "--zone-mm: {} radii for {} compared logs",
                question.zones.len(),
                others.len()
            ),
            "one radius for each --compare, in the same order, or one for all",
        ));
    }
    let zone = |k: usize| {
        question
            .zones
            .get(k)
            .or(question.zones.first().filter(|_| question.zones.len() == 1))
            .copied()
    };
    let own = Compared {
        file: learned.file.clone(),
        notes: Vec::new(),
        stretches: (learned.divided.observed.iter())
            .map(|(_, observed)| compared(robot, learned, observed, None))
            .collect(),
    };
    let others_compared: Vec<Compared> = others
        .iter()
        .enumerate()
        .map(|(k, named)| compare(robot, learned, named, zone(k)))
        .collect();
    let feed = learned.fitted.feeds.iter().copied().fold(0.0, f64::max);
    let [acceleration, smoothing, lag, settling] = learned.fitted.values;
    let [acceleration_u, smoothing_u, lag_u, settling_u] = learned.fitted.u;
    let step = learned.log.usual_step();
    let unused = |file: &str, unused: &[String]| -> Vec<String> {
        unused.iter().map(|name| format!("{name} ({file})")).collect()
    };
    let mut all_unused = unused(&learned.file, &learned.log.unused);
    all_unused.extend(
        others
            .iter()
            .flat_map(|named| unused(&named.file, &named.log.unused)),
    );
    Ok(MotionAnswer {
        robot: robot.name().to_owned(),
        file: learned.file.clone(),
        instants: learned.log.times.len(),
        step_ms: number(to_ms(step)),
        speed_window_ms: number(to_ms(2.0 * HALF_WINDOW * step)),
        acceleration_window_ms: number(to_ms(2.0 * HALF_OF_ACCELERATION * step)),
        tool: tool(learned),
        moves: moves(learned),
        joints: joints(robot, learned),
        path_acceleration_mm_per_s2: value(to_mm(acceleration), to_mm(acceleration_u)),
        smoothing_ms: value(to_ms(smoothing), to_ms(smoothing_u)),
        lag_ms: value(to_ms(lag), to_ms(lag_u)),
        settling_ms: value(to_ms(settling), to_ms(settling_u)),
        correlation_of_smoothing_and_lag: number(learned.fitted.window_and_lag),
        feed_rms_percent: number(100.0 * learned.fitted.rms / feed),
        notes: notes(learned, &others_compared),
        compared: std::iter::once(&own)
            .chain(&others_compared)
            .map(compared_answer)
            .collect(),
        unused: all_unused,
        assumed: learned.setting.assumed.clone(),
    })
}

fn number(value: f64) -> f64 {
    decimals(value, DECIMALS)
}

fn value(value: f64, u: f64) -> ValueAnswer {
    ValueAnswer {
        value: number(value),
        u: u.is_finite().then(|| number(u)),
    }
}

fn tool(learned: &Learned) -> ToolAnswer {
    let three = |values: [f64; 3]| values.map(|value| number(to_mm(value)));
    ToolAnswer {
        tip_mm: three([learned.tool.tip.x, learned.tool.tip.y, learned.tool.tip.z]),
        tip_u_mm: learned
            .tool
            .fitted
            .map(|(u, _)| u)
            .filter(|u| u.iter().all(|u| u.is_finite()))
            .map(three),
        straightness_rms_mm: learned.tool.fitted.map(|(_, distance)| number(to_mm(distance))),
    }
}

fn moves(learned: &Learned) -> Vec<MoveAnswer> {
    let (log, divided) = (&learned.log, &learned.divided);
    let all = divided.moves.iter().flatten();
    all.map(|part| {
        let range = part.range.clone();
        let last = range.end.min(log.times.len()) - 1;
        let of_stretch = divided.observed.iter().find_map(|(k, observed)| {
            let stretch = &divided.stretches[*k];
            stretch.range.contains(&range.start).then(|| {
                let speeds = &observed.speeds[range.start - stretch.range.start..=last - stretch.range.start];
                speeds.iter().copied().fold(0.0, f64::max)
            })
        });
        let largest = of_stretch.unwrap_or_else(|| {
            // Over some instants, as no speeds of the tip are determined there.
            let tips = &divided.tips[range.clone()];
            let times = &log.times[range.clone()];
            let over = 5.min(tips.len() - 1).max(1);
            (over..tips.len())
                .map(|k| (tips[k] - tips[k - over]).norm() / (times[k] - times[k - over]))
                .fold(0.0, f64::max)
        });
        MoveAnswer {
            shape: match part.shape {
                Shape::Line => "line",
                Shape::Arc(_) => "arc",
                Shape::Curve => "curve",
                Shape::JointMove => "joint move",
            },
            radius_mm: match part.shape {
                Shape::Arc(radius) => Some(number(to_mm(radius))),
                _ => None,
            },
            line: log.lines[range.start],
            start_s: number(log.times[range.start]),
            time_s: number(log.times[last] - log.times[range.start]),
            length_mm: number(to_mm(part.length)),
            largest_speed_mm_per_s: number(to_mm(largest)),
        }
    })
    .collect()
}

fn joints(robot: &Robot, learned: &Learned) -> Vec<JointAnswer> {
    let lag = |joint: usize| learned.lags.get(joint).copied().flatten();
    let lead = |joint: usize| {
        let leads = learned.fitted.leads.as_ref()?;
        let u = leads.u[joint]?;
        Some(ValueAnswer {
            value: decimals(leads.values[joint], LEAD_DECIMALS),
            u: u.is_finite().then(|| decimals(u, LEAD_DECIMALS)),
        })
    };
    let all = robot.joints().iter().zip(&learned.reached).enumerate();
    all.map(|(k, (joint, reached))| JointAnswer {
        name: joint.name.clone(),
        speed_deg_per_s: number(to_deg(reached.speed)),
        acceleration_deg_per_s2: number(to_deg(reached.acceleration)),
        acceleration_noise_deg_per_s2: reached.noise.map(|noise| number(to_deg(noise))),
        delay_ms: lag(k).map(|own| value(to_ms(own.delay), to_ms(own.delay_u))),
        lag_ms: lag(k).map(|own| value(to_ms(own.lag), to_ms(own.lag_u))),
        motor_lead_s2: lead(k),
    })
    .collect()
}

fn compared_answer(compared: &Compared) -> ComparedAnswer {
    ComparedAnswer {
        file: compared.file.clone(),
        stretches: compared.stretches.iter().map(stretch_answer).collect(),
    }
}

fn stretch_answer(stretch: &ComparedStretch) -> StretchAnswer {
    let [logged, predicted] = stretch.cycle;
    let corners = stretch.corners.iter().map(|corner| CornerAnswer {
        turn_deg: number(to_deg(corner.measured.turn)),
        least_speed_mm_per_s: number(to_mm(corner.measured.least_speed)),
        zone_mm: corner.zone.map(|zone| number(to_mm(zone))),
        zone_is_fitted: corner.is_fitted && corner.zone.is_some(),
        zone_u_mm: corner.zone_u.map(|u| number(to_mm(u))),
        distance_mm: number(to_mm(corner.measured.closest)),
        distance_u_mm: number(to_mm(corner.measured.closest_u)),
        predicted_distance_mm: number(to_mm(corner.closest)),
        distance_error_mm: number(to_mm(corner.closest - corner.measured.closest)),
    });
    StretchAnswer {
        start_s: number(stretch.start),
        feed_mm_per_s: number(to_mm(stretch.feed)),
        cycle_time_s: logged.map(number),
        predicted_cycle_time_s: predicted.map(number),
        cycle_time_error_percent: logged
            .zip(predicted)
            .map(|(logged, predicted)| number(100.0 * (predicted - logged) / logged)),
        feed_rms_percent: number(100.0 * stretch.feed_rms / stretch.feed),
        off_line_mm: number(to_mm(stretch.off_line[0])),
        predicted_off_line_mm: number(to_mm(stretch.off_line[1])),
        corners: corners.collect(),
    }
}

fn notes(learned: &Learned, others: &[Compared]) -> Vec<String> {
    let mut notes: Vec<String> = learned
        .log
        .notes
        .iter()
        .map(|note| format!("{}: {note}", learned.file))
        .collect();
    for other in others {
        // What is concluded of all logs alike is said once.
        let new = other
            .notes
            .iter()
            .filter(|note| !learned.log.notes.contains(note));
        notes.extend(new.map(|note| format!("{}: {note}", other.file)));
        if other.stretches.is_empty() {
            notes.push(format!(
                "{}: no straight moves between rests: not compared",
                other.file
            ));
        }
    }
    if let Some((u, _)) = learned.tool.fitted {
        notes.push("the tip is fitted: it is the point of the flange whose moves are straightest".to_owned());
        let largest = u.iter().copied().fold(0.0, f64::max);
        if largest > KNOWN {
            notes.push(format!(
                "a coordinate of the tip is known to {:.0} mm only, as the moves hardly turn the tool about it: lengths and speeds depend on it; give --tool-mm",
                to_mm(largest)
            ));
        }
    }
    let [acceleration, ..] = learned.fitted.values;
    let [acceleration_u, smoothing_u, lag_u, _] = learned.fitted.u;
    if acceleration_u >= MOST_U * acceleration {
        notes.push(
            "the acceleration along the path is not determined: the feed is reached within the smoothing"
                .to_owned(),
        );
    }
    if learned.table.smoothing_ms.is_none() {
        notes.push(format!(
            "window and lag are not determined (standard uncertainties {:.1} and {:.1} ms)",
            to_ms(smoothing_u),
            to_ms(lag_u)
        ));
    } else if learned.fitted.window_and_lag.abs() > NOT_APART {
        notes.push("window and lag can hardly be distinguished: only their sum is known well".to_owned());
    }
    if let Some(leads) = &learned.fitted.leads {
        let [before, after] = leads.off_line.map(to_mm);
        notes.push(format!(
            "the logged tip leaves its lines where it accelerates; motors that are ahead of the arm by the elastic deflection of their drives explain it ({before:.2} mm rms without, {after:.2} mm with leads): logs are predicted with leads, the tip of a study is where the arm is"
        ));
    }
    notes.push("accelerations of the joints are those that were reached: lower bounds, no limits".to_owned());
    if learned.lags.is_empty() {
        notes.push("no commanded positions: a delay of all joints together is not seen".to_owned());
    }
    notes.push(format!(
        "times are from where the tip has left its start by {} mm until it is that near to its end; distances of corners are from where the lines of their own log cross",
        to_mm(LEFT)
    ));
    notes
}
