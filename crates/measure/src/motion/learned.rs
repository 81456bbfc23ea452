//! What a log says: its moves, the tip, the values of the motion, and how they predict other logs.

use armill_core::motion::MotionModel;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm, to_ms};
use armill_formats::measurement::joint_log::JointLog;
use armill_formats::motion::MotionTable;
use armill_formats::robot::RobotDescription;
use armill_study::StudyError;
use armill_study::input::motion::MotionSetting;
use armill_study::number::{digits, without_rounding};

use super::course::{MovePart, Shape, moves};
use super::derivative::Differentiator;
use super::fit::{LearntModel, fit};
use super::lag::{JointLag, lags};
use super::observed::Observed;
use super::question::{NamedLog, Question};
use super::reached::{JointReached, commanded, reached};
use super::simulate::{Arm, predicted, zones};
use super::stretches::{HALF_WINDOW, Stretch, joint_speeds, stretches};
use super::tool::{Tool, flanges, straight_tool, tips};

/// A value with a larger relative standard uncertainty is not determined.
pub(super) const MOST_U: f64 = 0.3;
/// A lag is determined to this, s, at least.
const MOST_LAG_U: f64 = 5e-3;
/// Speed of the tip in rapids, which no log has here, m/s.
const RAPID: f64 = 1.0;
/// Digits of values in the robot file.
const DIGITS: i32 = 4;

/// A log, divided.
#[derive(Clone, Debug)]
pub(super) struct Divided {
    pub stretches: Vec<Stretch>,
    /// Moves of each stretch.
    pub moves: Vec<Vec<MovePart>>,
    /// Stretches of straight moves, with their number.
    pub observed: Vec<(usize, Observed)>,
    /// Speeds of the joints, rad/s.
    pub speeds: Vec<f64>,
    /// The tip at each instant, m.
    pub tips: Vec<Point3<f64>>,
}

/// What was learnt of a log.
#[derive(Clone, Debug)]
pub struct Learned {
    /// Its file.
    pub file: String,
    /// The log.
    pub(super) log: JointLog,
    pub(super) divided: Divided,
    /// The tip.
    pub tool: Tool,
    pub(super) fitted: LearntModel,
    pub(super) reached: Vec<JointReached>,
    pub(super) lags: Vec<Option<JointLag>>,
    /// Values for a robot file: those that the log determines.
    pub table: MotionTable,
    /// The model with these values, and with those of the robot file or assumed ones where there are none.
    pub(super) setting: MotionSetting,
}

/// A log compared with its prediction.
#[derive(Clone, Debug)]
pub(super) struct Compared {
    pub file: String,
    pub notes: Vec<String>,
    pub stretches: Vec<ComparedStretch>,
}

/// A stretch compared with its prediction.
#[derive(Clone, Debug)]
pub(super) struct ComparedStretch {
    pub start: f64,
    pub feed: f64,
    pub cycle: [Option<f64>; 2],
    pub feed_rms: f64,
    /// Largest distance from the lines away from passed corners, m: logged and predicted.
    pub off_line: [f64; 2],
    pub corners: Vec<ComparedCorner>,
}

/// A corner compared with its prediction.
#[derive(Clone, Copy, Debug)]
pub(super) struct ComparedCorner {
    pub measured: super::observed::PassedCorner,
    /// Radius of the zone, m; none for a stop.
    pub zone: Option<f64>,
    /// Whether the zone is fitted.
    pub is_fitted: bool,
    /// Radius by which the zone would change for the uncertainty of the distance, m.
    pub zone_u: Option<f64>,
    /// Predicted distance, m.
    pub closest: f64,
}

/// Learns from a log.
///
/// # Errors
/// No tip is given and none can be fitted; no straight moves with stops.
pub fn learn(found: &RobotDescription, named: NamedLog, question: &Question) -> Result<Learned, StudyError> {
    let robot = &found.robot;
    let NamedLog { file, log } = named;
    let speeds = joint_speeds(&log);
    let divided = stretches(&log, &speeds);
    let tool = match question.tip {
        Some(tip) => Tool { tip, fitted: None },
        None => tool_of(&file, robot, &log, &divided)?,
    };
    let divided = divide(robot, &log, speeds, divided, &tool);
    let usable: Vec<&Observed> = divided
        .observed
        .iter()
        .map(|(_, observed)| observed)
        .filter(|observed| observed.stops_only())
        .collect();
    if usable.is_empty() {
        return Err(StudyError::value(
            format!("{file}: no straight moves from a rest to a rest with stops at their corners"),
            "log a program of lines with exact stops (fine), with a rest of 0.2 s before and after it; --tool-mm gives the tip if it is known",
        ));
    }
    let given = found.motion.clone().unwrap_or_default();
    let arm = Arm { robot, tip: tool.tip };
    // Accelerations of joints limit only where they are known.
    let mut model: MotionModel = MotionSetting::of(&given, robot, RAPID).model;
    if given.joint_acceleration_deg_per_s2.is_none() {
        for joint in &mut model.limits.joints {
            joint.acceleration = f64::INFINITY;
        }
    }
    let fitted = fit(arm, &usable, &model);
    let reached = reached(&log, &divided.speeds, &divided.stretches);
    let lags = lags(&log);
    let table = table(&fitted, &reached, &commanded(&usable, &model, &fitted), &lags);
    let setting = MotionSetting::of(&table.or(&given), robot, RAPID);
    Ok(Learned {
        file,
        log,
        tool,
        fitted,
        reached,
        lags,
        table,
        setting,
        divided,
    })
}

/// The tip that makes the moves straight, from the numbers of moves.
fn tool_of(file: &str, robot: &Robot, log: &JointLog, found: &[Stretch]) -> Result<Tool, StudyError> {
    let flanges = flanges(robot, &log.positions);
    let mut parts = Vec::new();
    for stretch in found
        .iter()
        .filter(|stretch| stretch.is_complete && !stretch.is_joint_move)
    {
        match &log.moves {
            Some(numbers) => {
                let mut begin = stretch.moving.start;
                for index in stretch.moving.clone() {
                    let is_last = index + 1 == stretch.moving.end;
                    if is_last || numbers[index + 1] != numbers[index] {
                        parts.push(begin..index + 1);
                        begin = index + 1;
                    }
                }
            }
            // Corners of the tip are corners of the flange.
            None => {
                let origins = smoothed(log, &tips(&flanges, Vector3::zeros()));
                parts.extend(
                    moves(&origins, &stretch.moving)
                        .into_iter()
                        .map(|part| part.range),
                );
            }
        }
    }
    straight_tool(&flanges, &parts).ok_or_else(|| {
        StudyError::value(
            format!("{file}: the tip of the tool cannot be fitted: no moves between rests"),
            "give it with --tool-mm X,Y,Z",
        )
    })
}

pub(super) fn divide(
    robot: &Robot,
    log: &JointLog,
    speeds: Vec<f64>,
    stretches: Vec<Stretch>,
    tool: &Tool,
) -> Divided {
    let tips = tips(&flanges(robot, &log.positions), tool.tip);
    let smoothed = smoothed(log, &tips);
    let moves: Vec<Vec<MovePart>> = stretches
        .iter()
        .map(|stretch| match stretch.is_joint_move {
            true => vec![MovePart {
                shape: Shape::JointMove,
                ..whole(&tips, stretch)
            }],
            false => moves(&smoothed, &stretch.moving),
        })
        .collect();
    let observed = stretches
        .iter()
        .zip(&moves)
        .enumerate()
        .filter_map(|(k, (stretch, parts))| Some((k, Observed::of(log, stretch, parts, &tips)?)));
    Divided {
        observed: observed.collect(),
        stretches,
        moves,
        speeds,
        tips,
    }
}

/// The tip without the noise of single instants, in which corners are sought.
fn smoothed(log: &JointLog, tips: &[Point3<f64>]) -> Vec<Point3<f64>> {
    let by_time = Differentiator::new(&log.times, HALF_WINDOW * log.usual_step());
    let flat: Vec<f64> = tips.iter().flat_map(|tip| [tip.x, tip.y, tip.z]).collect();
    let values = by_time.values(&flat, 3);
    values
        .chunks_exact(3)
        .map(|tip| Point3::new(tip[0], tip[1], tip[2]))
        .collect()
}

fn whole(tips: &[Point3<f64>], stretch: &Stretch) -> MovePart {
    let ways = tips[stretch.moving.clone()]
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).norm());
    MovePart {
        range: stretch.moving.clone(),
        shape: Shape::Curve,
        length: ways.sum(),
    }
}

/// Values that the log determines.
fn table(
    fitted: &LearntModel,
    reached: &[JointReached],
    commanded: &[f64],
    lags: &[Option<JointLag>],
) -> MotionTable {
    let [acceleration, smoothing, lag, settling] = fitted.values;
    let [acceleration_u, _, lag_u, settling_u] = fitted.u;
    let round = |value: f64| without_rounding(digits(value, DIGITS));
    // Commanded and actual positions say more of the lag than starts and stops.
    let by_command: Option<Vec<JointLag>> = lags
        .iter()
        .copied()
        .collect::<Option<Vec<_>>>()
        .filter(|all| !all.is_empty());
    let is_acceleration_known = acceleration_u < MOST_U * acceleration;
    let is_lag_known = lag_u < MOST_LAG_U;
    MotionTable {
        path_acceleration_mm_per_s2: is_acceleration_known.then(|| round(to_mm(acceleration))),
        smoothing_ms: is_lag_known.then(|| round(to_ms(smoothing))),
        settling_ms: (settling_u < MOST_LAG_U).then(|| round(to_ms(settling))),
        motor_lead_s2: fitted
            .leads
            .as_ref()
            .map(|leads| leads.values.iter().map(|lead| round(*lead)).collect()),
        lag_ms: match &by_command {
            Some(all) => Some(all.iter().map(|own| round(to_ms(own.lag))).collect()),
            None => is_lag_known.then(|| vec![round(to_ms(lag))]),
        },
        lag_u_ms: match &by_command {
            Some(all) => Some(all.iter().map(|own| round(to_ms(own.lag_u))).collect()),
            None => is_lag_known.then(|| vec![round(to_ms(lag_u))]),
        },
        // Less twice the noise, or in the command that explains the log: what was reached for certain.
        joint_acceleration_reached_deg_per_s2: Some(
            reached
                .iter()
                .zip(commanded)
                .map(|(own, commanded)| {
                    let logged = own.acceleration - 2.0 * own.noise.unwrap_or(0.0);
                    logged.max(if is_acceleration_known { *commanded } else { 0.0 })
                })
                .map(|own| to_deg(own).floor())
                .collect(),
        ),
        ..MotionTable::default()
    }
}

/// Compares a log with its prediction; `zone`, m, is that of its corners, 0 a stop, none fitted.
pub(super) fn compare(robot: &Robot, learned: &Learned, named: &NamedLog, zone: Option<f64>) -> Compared {
    let speeds = joint_speeds(&named.log);
    let found = stretches(&named.log, &speeds);
    let divided = divide(robot, &named.log, speeds, found, &learned.tool);
    let stretches = divided
        .observed
        .iter()
        .map(|(_, observed)| compared(robot, learned, observed, zone));
    Compared {
        file: named.file.clone(),
        notes: named.log.notes.clone(),
        stretches: stretches.collect(),
    }
}

pub(super) fn compared(
    robot: &Robot,
    learned: &Learned,
    observed: &Observed,
    zone: Option<f64>,
) -> ComparedStretch {
    let arm = Arm {
        robot,
        tip: learned.tool.tip,
    };
    let model = &learned.setting.model;
    let used = match zone {
        Some(radius) => vec![Some(radius).filter(|radius| *radius > 0.0); observed.corners.len()],
        None => zones(arm, observed, model),
    };
    let found = predicted(arm, observed, model, observed.feed, &used);
    let distances = found.closest(observed);
    let corners = observed
        .corners
        .iter()
        .enumerate()
        .map(|(k, measured)| ComparedCorner {
            measured: *measured,
            zone: used[k],
            is_fitted: zone.is_none(),
            zone_u: used[k].filter(|_| zone.is_none()).map(|radius| {
                let mut more = used.clone();
                let step = (0.1 * radius).max(2e-4);
                more[k] = Some(radius + step);
                let slope = (predicted(arm, observed, model, observed.feed, &more).closest(observed)[k]
                    - distances[k])
                    / step;
                measured.closest_u / slope.abs().max(1e-6)
            }),
            closest: distances[k],
        });
    ComparedStretch {
        start: observed.times[0],
        feed: observed.feed,
        cycle: [observed.cycle(), found.cycle(observed)],
        feed_rms: found.feed_rms(observed),
        off_line: [&observed.tips, &found.tips].map(|tips| observed.off_line(tips)),
        corners: corners.collect(),
    }
}
