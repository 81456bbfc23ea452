//! Settings, and reading a log.

use std::io::{BufReader, Read as _};
use std::path::Path;

use armill_core::robot::Robot;
use armill_core::torsion::{Signals, without_rotor};
use armill_core::units::from_deg;
use armill_formats::document::{Problem, Problems};
use armill_formats::input;
use armill_formats::measurement::joint_log::{self, AngleUnit, JointLog, LogReadOptions};
use armill_formats::measurement::matlab::{self, MatlabArray, MatlabFile, Requested};
use armill_study::StudyError;

/// What a log has to contain.
const HINT: &str = "use one row per instant: time_s, motor_j1_deg, ..., torque_j1_nm, ..., and link_j1_deg, ... of link encoders; or a MATLAB file with --names";
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
    /// Inertia of the rotor of each motor, kg m^2; empty if they are not known.
    pub rotor_inertias: Vec<f64>,
    /// The robot, for the functions of the load.
    pub robot: Option<Robot>,
}

impl DrivesQuestion {
    /// Whether ratios, inertias and robot are those of a log of `joints` joints.
    ///
    /// # Errors
    /// Another number of joints; inertias without ratios; a robot with prismatic joints.
    pub fn check(&self, joints: usize) -> Result<(), StudyError> {
        for (flag, what, values) in [
            ("--gear", "ratios", &self.ratios),
            ("--rotor-inertia", "inertias", &self.rotor_inertias),
        ] {
            if !values.is_empty() && values.len() != joints {
                let message = format!("{flag}: {} {what}, but the log has {joints} joints", values.len());
                return Err(StudyError::value(
                    message,
                    "one for each joint, such as 257,267,252 for --gear",
                ));
            }
        }
        if !self.rotor_inertias.is_empty() && self.ratios.is_empty() {
            let hint =
                "the torque of a rotor is its inertia times the ratio times the acceleration of the joint";
            return Err(StudyError::value(
                "--rotor-inertia needs the gear ratios, --gear",
                hint,
            ));
        }
        let Some(robot) = &self.robot else { return Ok(()) };
        let own = robot.joints().len();
        if own != joints {
            let message = format!(
                "--robot: {} has {own} joints, but the log has {joints}",
                robot.name()
            );
            return Err(StudyError::value(
                message,
                "give the robot of the log, without external axes",
            ));
        }
        match (0..own).find(|joint| robot.slides(*joint)) {
            Some(joint) => {
                let name = &robot.joints()[joint].name;
                let message = format!("--robot: joint {name} of {} is prismatic", robot.name());
                Err(StudyError::value(
                    message,
                    "only logs of revolute joints are evaluated",
                ))
            }
            None => Ok(()),
        }
    }
}

/// Paths of the arrays of a MATLAB file: time (s), motor and link encoders (rad of a name that ends in `_rad`, otherwise deg), torques (N m);
/// given units take precedence.
#[derive(Clone, Debug, PartialEq)]
pub struct MatlabNames {
    /// Of the times.
    pub time: String,
    /// Of the motor encoders.
    pub motor: String,
    /// Of the link encoders, if there are any.
    pub link: Option<String>,
    /// Of the torques.
    pub torque: String,
}

impl MatlabNames {
    /// Three or four names: time, motor, link if there is one, torque; `None` of another number.
    pub fn of(names: &[String]) -> Option<MatlabNames> {
        let (time, motor, link, torque) = match names {
            [time, motor, torque] => (time, motor, None, torque),
            [time, motor, link, torque] => (time, motor, Some(link.clone()), torque),
            _ => return None,
        };
        Some(MatlabNames {
            time: time.clone(),
            motor: motor.clone(),
            link,
            torque: torque.clone(),
        })
    }

    /// All names, in the order time, motor, torque, link.
    fn all(&self) -> Vec<&str> {
        let link = self.link.as_deref();
        [&self.time, &self.motor, &self.torque]
            .into_iter()
            .map(String::as_str)
            .chain(link)
            .collect()
    }
}

/// Signals of all joints, each signal as one list.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveLog {
    /// Its file.
    pub file: String,
    /// Times, s.
    pub times: Vec<f64>,
    /// Its joints.
    pub joints: Vec<DriveJoint>,
    /// What to know of the log.
    pub notes: Vec<String>,
}

/// Signals of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveJoint {
    /// Motor encoder, reduced to the joint, rad.
    pub motor: Vec<f64>,
    /// Link encoder, rad, if it has one.
    pub link: Option<Vec<f64>>,
    /// Torque of the motor, N m.
    pub torque: Vec<f64>,
}

impl DriveLog {
    /// Torque of the motor of a joint that passes its gear, N m, with the torque of the rotor per acceleration of the joint, kg m^2.
    pub(super) fn gear_torque(&self, joint: usize, rotor: f64) -> Vec<f64> {
        let DriveJoint { motor, torque, .. } = &self.joints[joint];
        without_rotor(&self.times, motor, torque, rotor)
    }

    /// The signals of a joint with a link encoder and this torque, N m.
    pub(super) fn signals<'a>(&'a self, joint: usize, torque: &'a [f64]) -> Option<Signals<'a>> {
        let DriveJoint { motor, link, .. } = &self.joints[joint];
        Some(Signals {
            times: &self.times,
            motor,
            link: link.as_ref()?,
            torque,
        })
    }

    fn of(file: String, log: JointLog) -> Result<DriveLog, StudyError> {
        let Some(torque) = &log.torque else {
            let what = "no column is the torque of a motor";
            return Err(Problems::from(vec![Problem::of_file(&file, what, HINT)]).into());
        };
        let signal = |values: &[f64], joint: usize| -> Vec<f64> {
            values.iter().skip(joint).step_by(log.joints).copied().collect()
        };
        let joints = (0..log.joints).map(|joint| DriveJoint {
            motor: signal(&log.positions, joint),
            link: log.link.as_ref().map(|link| signal(link, joint)),
            torque: signal(torque, joint),
        });
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
    let wanted: Vec<&str> = question.names.iter().flat_map(MatlabNames::all).collect();
    let found = matlab::read(&file, content, &wanted)?;
    let Some(names) = &question.names else {
        let hint = format!(
            "--names TIME,MOTOR,LINK,TORQUE, or without LINK; its arrays: {}",
            listed(&found)
        );
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
    let paths = names.all();
    for (name, found_there) in paths.iter().zip(&found.requested) {
        let message = match found_there {
            Requested::Array(array) => {
                arrays.push(array);
                continue;
            }
            Requested::Other(class) => format!("`{name}` is of class {class}, not a numeric array"),
            Requested::Absent => format!("there is no array `{name}`"),
        };
        problems.push(Problem::of_file(
            &file,
            format!("{message}; the numeric arrays of the file are {}", listed(found)),
            "give the paths of its arrays with --names",
        ));
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
            names.time,
            times.len()
        );
        problems.push(Problem::of_file(
            &file,
            message,
            "give the array of the times in s",
        ));
    }
    let mut signals: Vec<Vec<Vec<f64>>> = Vec::new();
    for (name, array) in paths.iter().zip(&arrays).skip(1) {
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
    let mut each = paths[1..].iter().zip(signals);
    let mut next = || each.next();
    let in_rad = |(name, mut signal): (&&str, Vec<Vec<f64>>)| {
        let is_rad = units
            .angle
            .map_or(name.ends_with("_rad"), |angle| angle == AngleUnit::Radian);
        if !is_rad {
            signal
                .iter_mut()
                .flatten()
                .for_each(|value| *value = from_deg(*value));
        }
        signal
    };
    let motor = next().map(in_rad).unwrap_or_default();
    let torque = next().map(|(_, torque)| torque).unwrap_or_default();
    let links = next().map(in_rad);
    let mut link = links.into_iter().flatten();
    let joints = motor.into_iter().zip(torque).map(|(motor, torque)| DriveJoint {
        motor,
        link: link.next(),
        torque,
    });
    Ok(DriveLog {
        file,
        times,
        joints: joints.collect(),
        notes: Vec::new(),
    })
}
