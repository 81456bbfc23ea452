//! Quantity and unit of a column of measured poses.
//!
//! | column | meaning | units |
//! |---|---|---|
//! | `q1_deg` ..., `j1_deg` ..., or a joint's own name such as `A1_deg` | joint positions as the controller reports them | `_deg`, `_rad`; `_mm`, `_um`, `_m`, `_in` for prismatic joints |
//! | `x_mm`, `y_mm`, `z_mm` | the measured point, axes of the tracker | `_mm`, `_um`, `_m`, `_in` |
//! | `rx_deg`, `ry_deg`, `rz_deg` | orientation of the measured body | `_deg`, `_rad` |
//! | `commanded_x_mm` ..., `commanded_rx_deg` ... | the commanded pose | as for measured |
//! | `pose`, `direction` | names, any text | |
//!
//! Names and units are not case-sensitive. A table with the names of Landgraf et al. 2021 (`shoulder_pan_joint`,
//! `measurement_x`, `Goal x`, ...) is read directly: joints in rad, measured lengths in mm and angles in deg, goals in
//! m and rad.

use std::str::FromStr;

use armill_core::robot::{Motion, Robot};
use armill_core::units::from_deg;

use crate::measurement::profile::LengthUnit;

/// Maps a column name of the file to one of armill's names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mapping {
    /// armill's name with its unit, such as `x_mm`.
    pub ours: String,
    /// The name in the file.
    pub theirs: String,
}

/// A text that is not a mapping.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("write a mapping as OURS=THEIRS, such as x_mm=Measured X")]
pub struct NoMapping;

impl FromStr for Mapping {
    type Err = NoMapping;

    fn from_str(text: &str) -> Result<Mapping, NoMapping> {
        let (ours, theirs) = text.split_once('=').ok_or(NoMapping)?;
        match (ours.trim(), theirs.trim()) {
            ("", _) | (_, "") => Err(NoMapping),
            (ours, theirs) => Ok(Mapping {
                ours: ours.to_owned(),
                theirs: theirs.to_owned(),
            }),
        }
    }
}

/// Quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::measurement) enum Quantity {
    /// Position of the joint with this index, revolute or prismatic.
    Joint(usize),
    /// Measured position along x, y, z: 0, 1, 2; measured orientation: 3, 4, 5.
    MeasuredPoses(usize),
    /// Commanded, with the same numbers.
    Commanded(usize),
    /// Name of the commanded pose.
    Pose,
    /// Name of the approach direction.
    Direction,
}

/// A column: its quantity, and the factor from its unit to m or rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::measurement) struct Column {
    pub quantity: Quantity,
    pub factor: f64,
}

impl Quantity {
    /// Whether it contains text.
    pub fn is_name(self) -> bool {
        matches!(self, Quantity::Pose | Quantity::Direction)
    }

    /// Whether it is an angle, for this robot.
    pub fn turns(self, robot: &Robot) -> bool {
        match self {
            Quantity::Joint(joint) => matches!(robot.chain().links()[joint].motion, Motion::About(..)),
            Quantity::MeasuredPoses(component) | Quantity::Commanded(component) => component > 2,
            Quantity::Pose | Quantity::Direction => false,
        }
    }

    /// Its name without unit, for messages.
    pub fn name(self, robot: &Robot) -> String {
        match self {
            Quantity::Joint(joint) => robot.joints()[joint].name.clone(),
            Quantity::MeasuredPoses(component) => COMPONENTS[component].to_owned(),
            Quantity::Commanded(component) => format!("commanded_{}", COMPONENTS[component]),
            Quantity::Pose => "pose".to_owned(),
            Quantity::Direction => "direction".to_owned(),
        }
    }

    /// The quantity of a lower-case name without its unit.
    fn of_name(name: &str, robot: &Robot) -> Option<Quantity> {
        let component = |name: &str| COMPONENTS.iter().position(|component| *component == name);
        if let Some(found) = component(name) {
            return Some(Quantity::MeasuredPoses(found));
        }
        if let Some(commanded) = name.strip_prefix("commanded_") {
            return component(commanded).map(Quantity::Commanded);
        }
        let mut joints = robot.joints().iter();
        if let Some(joint) = joints.position(|joint| joint.name.to_lowercase() == name) {
            return Some(Quantity::Joint(joint));
        }
        let number = name.strip_prefix(['q', 'j'])?;
        let plain = !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit());
        let number: usize = number.parse().ok().filter(|_| plain)?;
        (1..=robot.joints().len())
            .contains(&number)
            .then(|| Quantity::Joint(number - 1))
    }
}

const COMPONENTS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Names in the data set of Landgraf et al. 2021, with armill's names.
const LANDGRAF: [(&str, &str); 18] = [
    ("shoulder_pan_joint", "q1_rad"),
    ("shoulder_lift_joint", "q2_rad"),
    ("elbow_joint", "q3_rad"),
    ("wrist_1_joint", "q4_rad"),
    ("wrist_2_joint", "q5_rad"),
    ("wrist_3_joint", "q6_rad"),
    ("measurement_x", "x_mm"),
    ("measurement_y", "y_mm"),
    ("measurement_z", "z_mm"),
    ("measurement_rx", "rx_deg"),
    ("measurement_ry", "ry_deg"),
    ("measurement_rz", "rz_deg"),
    ("goal x", "commanded_x_m"),
    ("goal y", "commanded_y_m"),
    ("goal z", "commanded_z_m"),
    ("goal roll", "commanded_rx_rad"),
    ("goal pitch", "commanded_ry_rad"),
    ("goal yaw", "commanded_rz_rad"),
];

/// armill's name for a column of Landgraf et al.; `None` if it is not one of theirs.
pub(super) fn of_data_set(name: &str) -> Option<&'static str> {
    let name = name.trim().to_lowercase();
    let found = LANDGRAF.iter().find(|(theirs, _)| *theirs == name);
    found.map(|(_, ours)| *ours)
}

/// The column of a name that ends in its unit; `None` for an unknown name.
///
/// # Errors
/// A known name without a unit, or with a unit of another quantity: problem and hint.
pub(in crate::measurement) fn named(name: &str, robot: &Robot) -> Result<Option<Column>, (String, String)> {
    let lower = name.trim().to_lowercase();
    let plain = |quantity| Column {
        quantity,
        factor: 1.0,
    };
    match lower.as_str() {
        "pose" => return Ok(Some(plain(Quantity::Pose))),
        "direction" => return Ok(Some(plain(Quantity::Direction))),
        _ => {}
    }
    let units = |quantity: Quantity| match quantity.turns(robot) {
        true => "deg or rad",
        false => "mm, um, m or in",
    };
    if let Some(quantity) = Quantity::of_name(&lower, robot) {
        return Err((
            format!("no unit is given for `{name}`"),
            format!("end the name with its unit: {}", units(quantity)),
        ));
    }
    // The direction of the last motion of a joint is a condition, read by `conditions`.
    let Some((plain, unit)) = lower.rsplit_once('_').filter(|(_, unit)| *unit != "direction") else {
        return Ok(None);
    };
    let Some(quantity) = Quantity::of_name(plain, robot) else {
        return Ok(None);
    };
    let factor = match (quantity.turns(robot), unit) {
        (true, "deg") => Some(from_deg(1f64)),
        (true, "rad") => Some(1.0),
        (true, _) => None,
        (false, unit) => unit.parse::<LengthUnit>().ok().map(LengthUnit::factor),
    };
    match factor {
        Some(factor) => Ok(Some(Column { quantity, factor })),
        None => Err((
            format!("`{unit}` is not a unit of `{plain}`"),
            format!("known units are {}", units(quantity)),
        )),
    }
}

/// Names of missing columns; empty if the columns make poses.
pub(super) fn missing(columns: &[Option<Column>], robot: &Robot) -> Vec<String> {
    let has = |quantity: Quantity| columns.iter().flatten().any(|column| column.quantity == quantity);
    let mut requested: Vec<Quantity> = (0..robot.joints().len()).map(Quantity::Joint).collect();
    requested.extend((0..3).map(Quantity::MeasuredPoses));
    for kind in [Quantity::MeasuredPoses, Quantity::Commanded] {
        if (3..6).any(|component| has(kind(component))) {
            requested.extend((3..6).map(kind));
        }
    }
    if (0..6).any(|component| has(Quantity::Commanded(component))) {
        requested.extend((0..3).map(Quantity::Commanded));
    }
    let absent = requested.into_iter().filter(|quantity| !has(*quantity));
    absent
        .map(|quantity| {
            let unit = if quantity.turns(robot) { "deg" } else { "mm" };
            format!("`{}_{unit}`", quantity.name(robot))
        })
        .collect()
}
