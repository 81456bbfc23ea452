//! Settings, and reading a log.

use std::io::{BufReader, Read as _};
use std::path::Path;

use armill_core::torsion::Signals;
use armill_core::units::from_deg;
use armill_formats::document::{Problem, Problems};
use armill_formats::input;
use armill_formats::measurement::joint_log::{self, AngleUnit, JointLog, LogReadOptions};
use armill_formats::measurement::matlab::{self, MatlabArray, MatlabFile};
use armill_study::StudyError;

/// What a log has to contain.
const HINT: &str = "use one row per instant: time_s, motor_j1_deg, ..., link_j1_deg, ..., torque_j1_nm, ...; or a MATLAB file with --names";
/// Names of the arrays that are listed in a message at most.
const MOST_NAMES: usize = 40;

/// What is asked of a log.
#[derive(Clone, Debug, Default)]
pub struct DrivesQuestion {
    /// Units that the header does not give, and units of the arrays of a MATLAB file.
    pub units: LogReadOptions,
    /// Arrays of a MATLAB file.
    pub names: Option<MatlabNames>,
    /// Gear ratio of each joint; empty if they are not known.
    pub ratios: Vec<f64>,
}

/// Paths of the arrays of a MATLAB file: time (s), motor and link encoders (rad of a name that ends in `_rad`, otherwise deg), torques (N m);
/// given units take precedence.
#[derive(Clone, Debug, PartialEq)]
pub struct MatlabNames {
    /// In the order of the enumeration above.
    pub paths: [String; 4],
}

/// Signals of all joints, each signal as one list.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveLog {
    /// Its file.
    pub file: String,
    /// Times, s.
    pub times: Vec<f64>,
    /// Motor encoders, link encoders (rad) and torques (N m) of each joint.
    pub joints: Vec<[Vec<f64>; 3]>,
    /// What to know of the log.
    pub notes: Vec<String>,
}

impl DriveLog {
    /// The signals of a joint.
    pub fn signals(&self, joint: usize) -> Signals<'_> {
        let [motor, link, torque] = &self.joints[joint];
        Signals {
            times: &self.times,
            motor,
            link,
            torque,
        }
    }

    fn of(file: String, log: JointLog) -> Result<DriveLog, StudyError> {
        let (Some(link), Some(torque)) = (&log.link, &log.torque) else {
            let what = if log.link.is_none() {
                "no column is the position of a link encoder"
            } else {
                "no column is the torque of a motor"
            };
            return Err(Problems::from(vec![Problem::of_file(&file, what, HINT)]).into());
        };
        let signal =
            |values: &[f64], joint: usize| values.iter().skip(joint).step_by(log.joints).copied().collect();
        let joints =
            (0..log.joints).map(|joint| [&log.positions, link, torque].map(|values| signal(values, joint)));
        Ok(DriveLog {
            joints: joints.collect(),
            times: log.times,
            notes: log.notes,
            file,
        })
    }
}

/// Reads a log: a table, or a MATLAB file.
///
/// # Errors
/// A file that cannot be read; its problems; arrays that are missing or of another size.
pub fn read(path: &Path, question: &DrivesQuestion) -> Result<DriveLog, StudyError> {
    let file = path.display().to_string();
    let refuse = |error: std::io::Error| StudyError::value(format!("cannot read {file}: {error}"), HINT);
    let mut content = Vec::new();
    BufReader::new(input::open(path).map_err(refuse)?)
        .read_to_end(&mut content)
        .map_err(refuse)?;
    if !matlab::is_matlab(&content) {
        let log = joint_log::read(&file, &content[..], None, question.units)?;
        return DriveLog::of(file, log);
    }
    let wanted: Vec<&str> = question
        .names
        .iter()
        .flat_map(|names| names.paths.iter().map(String::as_str))
        .collect();
    let found = matlab::read(&file, &content, &wanted)?;
    let Some(names) = &question.names else {
        let hint = format!("--names TIME,MOTOR,LINK,TORQUE; its arrays: {}", listed(&found));
        return Err(StudyError::value(
            format!("{file}: no arrays are given for the signals of a MATLAB file"),
            hint,
        ));
    };
    from_matlab(file, (names, question.units), &found)
}

fn listed(found: &MatlabFile) -> String {
    let shown = found
        .names
        .iter()
        .take(MOST_NAMES)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    match found.names.len() > MOST_NAMES {
        true => format!("{shown}, ..."),
        false => shown,
    }
}

fn from_matlab(
    file: String,
    named: (&MatlabNames, LogReadOptions),
    found: &MatlabFile,
) -> Result<DriveLog, StudyError> {
    let (names, units) = named;
    let mut problems = Vec::new();
    let mut arrays: Vec<&MatlabArray> = Vec::new();
    for (name, array) in names.paths.iter().zip(&found.arrays) {
        match array {
            Some(array) => arrays.push(array),
            None => problems.push(Problem::of_file(
                &file,
                format!(
                    "there is no numeric array `{name}`; the file has {}",
                    listed(found)
                ),
                "give the paths of four of its arrays with --names",
            )),
        }
    }
    Problems::from(problems).into_result()?;
    let mut problems = Vec::new();
    let time_factor = units.time.map_or(1.0, joint_log::TimeUnit::factor);
    let times: Vec<f64> = arrays[0].values.iter().map(|time| time * time_factor).collect();
    if times.len() < 2
        || times.iter().any(|time| !time.is_finite())
        || !times.is_sorted_by(|one, other| one < other)
    {
        let message = format!(
            "`{}`: {} times, which have to be at least 2, finite and rising",
            names.paths[0],
            times.len()
        );
        problems.push(Problem::of_file(
            &file,
            message,
            "give the array of the times in s",
        ));
    }
    let mut signals: Vec<Vec<Vec<f64>>> = Vec::new();
    for (name, array) in names.paths.iter().zip(&arrays).skip(1) {
        let hint = "give an array with one row or one column for each joint";
        let Some(values) = array.signals(times.len()) else {
            let message = format!(
                "`{name}`: size {:?}, but there are {} times",
                array.dimensions,
                times.len()
            );
            problems.push(Problem::of_file(&file, message, hint));
            continue;
        };
        if array.values.iter().any(|value| !value.is_finite()) {
            problems.push(Problem::of_file(
                &file,
                format!("`{name}` has values that are not finite"),
                "remove the instants that were not recorded",
            ));
        }
        signals.push(values);
    }
    Problems::from(problems).into_result()?;
    let joints = signals[0].len();
    if signals.iter().any(|signal| signal.len() != joints) {
        let counts: Vec<String> = signals.iter().map(|signal| signal.len().to_string()).collect();
        let message = format!("signals of {} joints", counts.join(", "));
        return Err(Problems::from(vec![Problem::of_file(
            &file,
            message,
            "all signals need the same joints",
        )])
        .into());
    }
    for (name, signal) in names.paths[1..3].iter().zip(&mut signals) {
        let is_rad = units
            .angle
            .map_or(name.ends_with("_rad"), |angle| angle == AngleUnit::Radian);
        if !is_rad {
            signal
                .iter_mut()
                .flatten()
                .for_each(|value| *value = from_deg(*value));
        }
    }
    let mut each = signals.into_iter();
    let mut next = || each.next().unwrap_or_default();
    let (motor, link, torque) = (next(), next(), next());
    let joints = motor
        .into_iter()
        .zip(link)
        .zip(torque)
        .map(|((motor, link), torque)| [motor, link, torque]);
    Ok(DriveLog {
        file,
        times,
        joints: joints.collect(),
        notes: Vec::new(),
    })
}
