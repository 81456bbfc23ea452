//! The text that a robot is read from. It is kept to make the same robot, bit by bit, in another process (pickle).
//! Parameters of a call are written as a text too, so that each format has one reader.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use armill_formats::input::{self, Inputs};
use armill_formats::robot::armill::{IdentifiedSpring, with_given_springs};
use armill_formats::robot::format::{self, Format, RobotReadOptions};
use armill_formats::robot::spring_tables::SpringKind;
use armill_formats::robot::{RobotDescription, armill};
use armill_study::{library, robots};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::arrays::{Given, wrong_shape};
use crate::errors::{exception, refused};

/// The text of a robot file, and the options of the call.
#[derive(Clone, Debug)]
pub(crate) struct RobotSource {
    /// The path shown in messages.
    path: PathBuf,
    /// The name in results.
    name: String,
    bytes: Vec<u8>,
    format: Format,
    tip: Option<String>,
    /// Joint compliances in place of those of the file.
    compliance: Option<GivenCompliance>,
}

/// Joint compliances given by the caller.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GivenCompliance {
    /// rad/(N m), prismatic m/N, one per joint.
    pub values: Vec<f64>,
    /// Their standard uncertainties.
    pub uncertainties: Vec<f64>,
    /// Their covariance, row by row, if it was given.
    pub covariance: Option<Vec<f64>>,
    /// Where they come from, in the words of the caller.
    pub source: Option<String>,
}

/// Given compliances in a pickle: values, uncertainties, covariance, source.
pub(crate) type GivenParts = (Vec<f64>, Vec<f64>, Option<Vec<f64>>, Option<String>);

/// The parts that a pickle keeps: file; format with tip; given compliances.
pub(crate) type Parts<'py> = (
    (PathBuf, String, Bound<'py, PyBytes>),
    (String, Option<String>),
    Option<GivenParts>,
);

impl GivenCompliance {
    /// Of the parts of a pickle.
    pub(crate) fn of(parts: GivenParts) -> GivenCompliance {
        let (values, uncertainties, covariance, source) = parts;
        GivenCompliance {
            values,
            uncertainties,
            covariance,
            source,
        }
    }

    fn parts(&self) -> GivenParts {
        let given = self.clone();
        (given.values, given.uncertainties, given.covariance, given.source)
    }
}

impl RobotSource {
    /// The text of a robot of the library, or of a file.
    ///
    /// # Errors
    /// No such robot; a file that cannot be read, or is not a robot file.
    pub(crate) fn load(py: Python<'_>, robot: &Path) -> PyResult<RobotSource> {
        let name = robot.to_string_lossy();
        if let Some(entry) = library::ROBOTS.iter().find(|robot| robot.name == name) {
            let mut source = RobotSource::text(Format::Armill, entry.name, entry.text.to_owned(), None);
            source.path = PathBuf::from(entry.path);
            return Ok(source);
        }
        let found = robots::find(&name, Path::new(".")).map_err(|error| exception(py, &error))?;
        RobotSource::file(py, robot, &found, None)
    }

    /// The text of a URDF with its flange at the link `tip`.
    ///
    /// # Errors
    /// As [`RobotSource::load`].
    pub(crate) fn urdf(py: Python<'_>, path: &Path, tip: Option<String>) -> PyResult<RobotSource> {
        let bytes = read(py, path)?;
        let macros = String::from_utf8_lossy(&bytes).contains("xmlns:xacro");
        let requested = RobotReadOptions {
            format: Some(if macros { Format::Xacro } else { Format::Urdf }),
            tip: tip.clone(),
        };
        let found = format::read(path, &stem(path), &bytes, &requested);
        let found = found.map_err(|problems| exception(py, &problems.into()))?;
        RobotSource::file(py, path, &found, tip)
    }

    /// The text of a file that was read already. A file that includes other files is kept as a robot file of armill.
    fn file(
        py: Python<'_>,
        path: &Path,
        found: &RobotDescription,
        tip: Option<String>,
    ) -> PyResult<RobotSource> {
        let bytes = read(py, path)?;
        let name = found.robot.name();
        let mut source = match Format::of(path, &String::from_utf8_lossy(&bytes)) {
            Some(Format::Xacro) | None => RobotSource::text(Format::Armill, name, armill::write(found), None),
            Some(format) => RobotSource {
                bytes,
                ..RobotSource::text(format, name, String::new(), tip)
            },
        };
        source.path = path.to_owned();
        Ok(source)
    }

    /// A text.
    pub(crate) fn text(format: Format, name: &str, text: String, tip: Option<String>) -> RobotSource {
        RobotSource {
            path: PathBuf::from(format!("<{name}>")),
            name: name.to_owned(),
            bytes: text.into_bytes(),
            format,
            tip,
            compliance: None,
        }
    }

    /// Whether both give the same robot: the same text under the same name with the same compliances.
    pub(crate) fn is_same(&self, other: &RobotSource) -> bool {
        (&self.name, &self.bytes, self.format, &self.tip, &self.compliance)
            == (
                &other.name,
                &other.bytes,
                other.format,
                &other.tip,
                &other.compliance,
            )
    }

    /// Its name, if it is a robot of the library as it is.
    pub(crate) fn name_in_library(&self) -> Option<&str> {
        let mut entries = library::ROBOTS.iter();
        let found = entries.find(|entry| entry.name == self.name && entry.text.as_bytes() == self.bytes)?;
        self.compliance.is_none().then_some(found.name)
    }

    /// The name in results.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The same with other joint compliances.
    pub(crate) fn with_compliance(&self, compliance: GivenCompliance) -> RobotSource {
        RobotSource {
            compliance: Some(compliance),
            ..self.clone()
        }
    }

    /// The robot.
    ///
    /// # Errors
    /// The problems of the text.
    pub(crate) fn read(&self, py: Python<'_>) -> PyResult<RobotDescription> {
        let requested = RobotReadOptions {
            format: Some(self.format),
            tip: self.tip.clone(),
        };
        let found = format::read(&self.path, &self.name, &self.bytes, &requested);
        found.map_err(|problems| exception(py, &problems.into()))
    }

    /// The robot as a robot file of armill: its own text if it is one, with the given compliances.
    ///
    /// # Errors
    /// Given compliances for a robot with springs in addition to its drives, which a list of joint compliances leaves open.
    pub(crate) fn toml(&self, py: Python<'_>) -> PyResult<String> {
        let found = self.read(py)?;
        let text = match self.format {
            Format::Armill => String::from_utf8_lossy(&self.bytes).into_owned(),
            _ => armill::write(&found),
        };
        let Some(given) = &self.compliance else {
            return Ok(text);
        };
        if !found.robot.structure().springs.is_empty() {
            let message = format!("robot `{}` has springs in addition to its drives", self.name);
            return Err(refused(py, message, "change the compliances in its robot file"));
        }
        let joints = found.robot.joints().iter().enumerate();
        let springs = joints.zip(given.values.iter().zip(&given.uncertainties)).map(
            |((index, joint), (value, uncertainty))| IdentifiedSpring {
                at: joint.name.clone(),
                kind: match found.robot.slides(index) {
                    true => SpringKind::PrismaticDrive,
                    false => SpringKind::Drive,
                },
                compliance: *value,
                standard_uncertainty: *uncertainty,
            },
        );
        let what = given
            .source
            .as_deref()
            .unwrap_or("joint compliances given without a source");
        let path = self.path.to_string_lossy();
        let covariance = match &given.covariance {
            Some(covariance) => self.turning(py, &found, covariance)?,
            None => Vec::new(),
        };
        let written = with_given_springs(&path, &text, (springs.collect(), covariance), what);
        written.map_err(|problems| exception(py, &problems.into()))
    }

    /// The rows of a covariance of all joints that are of revolute joints.
    ///
    /// # Errors
    /// A prismatic joint that is correlated with another: a robot file has covariances of one unit.
    fn turning(
        &self,
        py: Python<'_>,
        found: &RobotDescription,
        covariance: &[f64],
    ) -> PyResult<Vec<Vec<f64>>> {
        let dof = found.robot.joints().len();
        let slides = |index: &usize| found.robot.slides(*index);
        let turning: Vec<usize> = (0..dof).filter(|index| !slides(index)).collect();
        for index in (0..dof).filter(slides) {
            let row = &covariance[index * dof..][..dof];
            if row
                .iter()
                .enumerate()
                .any(|(other, entry)| other != index && *entry != 0.0)
            {
                let name = &found.robot.joints()[index].name;
                let message =
                    format!("the covariance of prismatic joint {name} with other joints cannot be written");
                return Err(refused(
                    py,
                    message,
                    "robot files have covariances of revolute joints",
                ));
            }
        }
        let row = |i: &usize| turning.iter().map(|j| covariance[i * dof + j]).collect();
        Ok(turning.iter().map(row).collect())
    }

    /// The parts that a pickle keeps.
    pub(crate) fn parts<'py>(&self, py: Python<'py>) -> Parts<'py> {
        (
            (
                self.path.clone(),
                self.name.clone(),
                PyBytes::new(py, &self.bytes),
            ),
            (self.format.name().to_owned(), self.tip.clone()),
            self.compliance.as_ref().map(GivenCompliance::parts),
        )
    }

    /// From the parts of a pickle, without compliances.
    ///
    /// # Errors
    /// An unknown format.
    pub(crate) fn again(
        py: Python<'_>,
        file: (PathBuf, String, Bound<'_, PyBytes>),
        format: (String, Option<String>),
    ) -> PyResult<RobotSource> {
        let ((path, name, bytes), (format, tip)) = (file, format);
        let format = format
            .parse()
            .map_err(|message: String| refused(py, message, "the pickle may be of another version"))?;
        Ok(RobotSource {
            path,
            name,
            bytes: bytes.as_bytes().to_vec(),
            format,
            tip,
            compliance: None,
        })
    }
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(|| "robot".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

fn read(py: Python<'_>, path: &Path) -> PyResult<Vec<u8>> {
    Inputs::naming([path])
        .during(|| input::read(path))
        .map_err(|error| {
            let message = format!("cannot read robot file {}: {error}", path.display());
            refused(py, message, "check the path")
        })
}

/// The Denavit-Hartenberg table of these rows.
///
/// # Errors
/// Rows or limits of another shape, numbers that are not finite.
pub(crate) fn dh_text(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    convention: &str,
    prismatic: &[usize],
    limits: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let rows = table(py, rows, "rows", None, 4)?;
    let limits = limits
        .map(|limits| table(py, limits, "limits", Some(rows.len()), 2))
        .transpose()?;
    if let Some(index) = prismatic.iter().find(|index| **index >= rows.len()) {
        let message = format!(
            "prismatic: joint {index} does not exist: there are {} joints",
            rows.len()
        );
        return Err(refused(py, message, "joints are numbered from 0"));
    }
    let mut text = format!("convention = {convention}\na_m, alpha_rad, d_m, theta_rad, type");
    if limits.is_some() {
        // A column has one unit.
        let slides = (0..rows.len()).filter(|index| prismatic.contains(index)).count();
        let unit = match slides {
            0 => "rad",
            slides if slides == rows.len() => "m",
            _ => {
                let message = "limits of revolute and of prismatic joints cannot be in one table";
                return Err(refused(
                    py,
                    message,
                    "write a robot file of armill, or omit the limits",
                ));
            }
        };
        let _ = write!(text, ", lower_{unit}, upper_{unit}");
    }
    for (index, row) in rows.iter().enumerate() {
        let kind = if prismatic.contains(&index) {
            "prismatic"
        } else {
            "revolute"
        };
        let numbers: Vec<String> = row.iter().map(f64::to_string).collect();
        // Writing into a string cannot fail.
        let _ = write!(text, "\n{}, {kind}", numbers.join(", "));
        for limit in limits.iter().flat_map(|limits| &limits[index]) {
            let _ = write!(text, ", {limit}");
        }
    }
    text.push('\n');
    Ok(text)
}

/// Rows of numbers.
fn table(
    py: Python<'_>,
    value: &Bound<'_, PyAny>,
    name: &str,
    count: Option<usize>,
    width: usize,
) -> PyResult<Vec<Vec<f64>>> {
    let expected = match count {
        Some(count) => format!("({count}, {width})"),
        None => format!("(dof, {width})"),
    };
    let given = Given::of(value, name, &expected)?;
    match given.shape() {
        [rows, columns] if *columns == width && count.is_none_or(|count| count == *rows) => {}
        shape => return Err(wrong_shape(py, name, &expected, shape)),
    }
    given.finite(py, name)?;
    Ok(given.values().chunks(width).map(<[f64]>::to_vec).collect())
}

/// OPW parameters as the text of a file.
pub(crate) fn opw_text(lengths: [f64; 7], offsets: [f64; 6], signs: [i64; 6]) -> String {
    let names = ["a1", "a2", "b", "c1", "c2", "c3", "c4"];
    let lengths: String = names
        .iter()
        .zip(lengths)
        .map(|(name, length)| format!("  {name}: {length:?}\n"))
        .collect();
    format!(
        "opw_kinematics_geometric_parameters:\n{lengths}opw_kinematics_joint_offsets: {offsets:?}\n\
         opw_kinematics_joint_sign_corrections: {signs:?}\n"
    )
}
