//! The table `[geometry_covariance]` of a robot file: how uncertain its chain is.
//!
//! ```text
//! [geometry_covariance]    of = ["S along x", "S about z", ...], matrix_mm_deg = [[...], ...], source
//! ```
//!
//! `of` names small motions of the chain in the axes of a joint after its motion. The unit of an entry is the product of those of its row and column: mm
//! along an axis, deg about it.

use armill_core::nalgebra::DMatrix;
use armill_core::robot::{Axis, Robot, SmallMotion, UncertainGeometry};
use armill_core::units::{to_deg, to_mm};
use toml_edit::{Array, Item, Table, Value, value};

use super::calibrated;
use super::checks::Checks;
use super::file::RobotFile;
use super::geometry_covariance_table::GeometryCovarianceTable;

/// Digits of an entry: combinations of motions are known much better than each of them.
const DIGITS: usize = 12;

impl GeometryCovarianceTable {
    /// Of the chain of `robot`, from the calibration that found it.
    pub fn of(robot: &Robot, geometry: &UncertainGeometry) -> GeometryCovarianceTable {
        let name = |motion: &SmallMotion| {
            let joint = &robot.joints()[motion.after].name;
            let axis = Axis::ALL[motion.component % 3].letter();
            match motion.component < 3 {
                true => format!("{joint} along {axis}"),
                false => format!("{joint} about {axis}"),
            }
        };
        let (motions, covariance) = (geometry.motions(), geometry.covariance());
        let size = motions.len();
        let entry = |i: usize, j: usize| covariance[(i, j)] * unit_of(motions[i]) * unit_of(motions[j]);
        GeometryCovarianceTable {
            of: motions.iter().map(name).collect(),
            matrix_mm_deg: (0..size)
                .map(|i| (0..size).map(|j| entry(i, j)).collect())
                .collect(),
            source: calibrated::KEY.to_owned(),
        }
    }

    /// The table for a robot file, one row of the matrix in a line.
    pub(super) fn item(&self) -> Item {
        let mut table = Table::new();
        table.insert("of", value(self.of.iter().collect::<Array>()));
        let number = |of: &f64| {
            let text = format!("{of:.*e}", DIGITS - 1);
            text.parse().unwrap_or_else(|_| Value::from(*of))
        };
        let mut rows = Array::new();
        for row in &self.matrix_mm_deg {
            let mut row: Value = Value::Array(row.iter().map(number).collect());
            row.decor_mut().set_prefix("\n  ");
            rows.push_formatted(row);
        }
        rows.set_trailing("\n");
        rows.set_trailing_comma(true);
        table.insert("matrix_mm_deg", value(rows));
        table.insert("source", value(&self.source));
        Item::Table(table)
    }
}

/// mm or deg in the SI unit of a small motion.
fn unit_of(motion: SmallMotion) -> f64 {
    match motion.component < 3 {
        true => to_mm(1.0),
        false => to_deg(1.0),
    }
}

impl Checks<'_> {
    /// The uncertainty of the chain; what is wrong goes into the problems.
    pub(super) fn geometry_covariance(&mut self, file: &RobotFile) -> Option<UncertainGeometry> {
        let table = file.geometry_covariance.as_ref()?;
        let size = table.of.len();
        let rows = &table.matrix_mm_deg;
        if rows.len() != size || rows.iter().any(|row| row.len() != size) {
            let message =
                format!("the covariance of {size} small motions needs {size} rows of {size} numbers");
            let hint = "one row and column for each name in `of`";
            self.problem("geometry_covariance.matrix_mm_deg", message, hint);
            return None;
        }
        let motions: Vec<SmallMotion> = (table.of.iter().enumerate())
            .filter_map(|(index, name)| {
                let found = motion_of(file, name);
                if found.is_none() {
                    let joints: Vec<&str> = file.joint.iter().map(|joint| joint.name.as_str()).collect();
                    let hint = format!(
                        "a joint and an axis, as `{} about z`: {}",
                        joints[0],
                        joints.join(", ")
                    );
                    let message = format!("`{name}` is not a small motion of this chain");
                    self.problem(&format!("geometry_covariance.of[{index}]"), message, &hint);
                }
                found
            })
            .collect();
        if motions.len() != size {
            return None;
        }
        let covariance = DMatrix::from_fn(size, size, |i, j| {
            rows[i][j] / (unit_of(motions[i]) * unit_of(motions[j]))
        });
        match UncertainGeometry::new(motions, &covariance) {
            Ok(found) => Some(found),
            Err(error) => {
                let hint = "as `armill calibrate` and `armill journal` write it; or remove the table";
                self.problem("geometry_covariance.matrix_mm_deg", error.to_string(), hint);
                None
            }
        }
    }
}

/// The motion of this name, such as `S about z`.
fn motion_of(file: &RobotFile, name: &str) -> Option<SmallMotion> {
    let (joint, axis) = name.rsplit_once(' ')?;
    let (joint, turns) = match joint.strip_suffix(" along") {
        Some(joint) => (joint, false),
        None => (joint.strip_suffix(" about")?, true),
    };
    let after = file.joint.iter().position(|entry| entry.name == joint)?;
    let axis = Axis::ALL
        .iter()
        .position(|own| own.letter().to_string() == axis)?;
    Some(SmallMotion {
        after,
        component: axis + if turns { 3 } else { 0 },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::armill::{Geometry, read, with_geometry};

    const FILE: &str = "format = 1\nname = \"lever\"\n\n[chain]\nsource = \"drawing\"\nmotions = [\n  { about = \"z\", joint = \"A\" },\n  \
        { along = \"x\", length_mm = 300 },\n  { about = \"y\", joint = \"B 2\" },\n]\n\n[[joint]]\nname = \"A\"\nsign = 1\nsource = \"drawing\"\n\n\
        [[joint]]\nname = \"B 2\"\nsign = 1\nsource = \"drawing\"\n\n[sources.drawing]\nwhat = \"lengths\"\nwhere = \"here\"\n\
        licence = \"ours\"\n";

    /// A length within 0.3 mm and two angles within some mrad, of which the difference is known much better.
    fn geometry() -> UncertainGeometry {
        let motions = [(0, 0), (0, 5), (1, 4)].map(|(after, component)| SmallMotion { after, component });
        let covariance = DMatrix::from_row_slice(
            3,
            3,
            &[
                9e-8,
                2e-8,
                2e-8,
                2e-8,
                4e-6,
                3.999_999e-6,
                2e-8,
                3.999_999e-6,
                4e-6,
            ],
        );
        UncertainGeometry::new(motions.to_vec(), &covariance).unwrap()
    }

    fn calibrated() -> String {
        let robot = read("lever.toml", "lever", FILE).unwrap().robot;
        let geometry = Geometry {
            after: Vec::new(),
            what: "20 poses".to_owned(),
            place: "poses.csv".to_owned(),
            covariance: Some(GeometryCovarianceTable::of(&robot, &geometry())),
        };
        with_geometry("lever.toml", FILE, &geometry).unwrap()
    }

    #[test]
    fn a_covariance_is_read_back_with_its_well_known_combinations() {
        let text = calibrated();
        assert!(
            text.contains(r#"of = ["A along x", "A about z", "B 2 about y"]"#),
            "{text}"
        );
        let robot = read("lever.toml", "lever", &text).unwrap().robot;
        let found = robot.structure().geometry.as_deref().unwrap();
        assert_eq!(found.motions(), geometry().motions());
        let off = found.covariance() - geometry().covariance();
        // The difference of the two angles has a variance of 2e-12.
        assert!(off.amax() < 1e-16, "{off}");
        assert_eq!(found.inputs(), 3);
        // 0.3 mm is an entry of 0.09 mm^2.
        assert!(text.contains("[9.0000000000"), "{text}");
    }

    #[test]
    fn a_later_calibration_replaces_or_removes_it() {
        let again = Geometry {
            after: Vec::new(),
            what: "poses".to_owned(),
            place: "other.csv".to_owned(),
            covariance: None,
        };
        let text = with_geometry("lever.toml", &calibrated(), &again).unwrap();
        assert!(!text.contains("geometry_covariance"), "{text}");
    }

    #[test]
    fn all_problems_are_reported_at_their_places() {
        let refused = |from: &str, to: &str, words: &[&str]| {
            let text = calibrated();
            assert!(text.contains(from), "{from}: {text}");
            let problems = read("lever.toml", "lever", &text.replace(from, to))
                .unwrap_err()
                .to_string();
            for word in words {
                assert!(problems.contains(word), "{word}: {problems}");
            }
        };
        refused(
            "A along x",
            "C along x",
            &["`C along x` is not a small motion", "`A about z`: A, B 2"],
        );
        refused("B 2 about y", "B 2 about w", &["lever.toml:33:", "`B 2 about w`"]);
        refused("A about z", "A along x", &["named twice"]);
        refused("\"A along x\", ", "", &["2 small motions needs 2 rows"]);
        refused(
            "[9.0000000000",
            "[-9.0000000000",
            &["not symmetric, negative", "armill calibrate"],
        );
    }
}
