//! What a robot file specifies of an arm in addition to its drives: springs, masses, motors, damping, compensator, torque curves,
//! covariance, backlash, repeatability, model error, uncertainty of the geometry.
//!
//! Compliances have the order of the core: the drives in the order of the joints, then the springs in the
//! order of their tables, of which one with a whole matrix gives up to six. A covariance names its compliances; all
//! others stay independent, with their own standard uncertainty.

use std::sync::Arc;

use armill_core::nalgebra::DMatrix;
use armill_core::robot::{Backlash, BacklashSide, Compensator, JointCurve, Structure, TorqueCurve};
use armill_core::source::repeatability;
use armill_core::units::{from_deg, from_mm, from_per_mm};

use super::checks::Checks;
use super::file::{BacklashSideName, CovarianceTable, JointEntry, RobotFile};
use crate::robot::spring_tables::SpringTableError;

impl Checks<'_> {
    /// The structure of the arm; what is wrong goes into the problems.
    ///
    /// Not checked: signs of the covariance as a whole; the core refuses a negative eigenvalue when the robot takes it.
    pub(super) fn structure(&mut self, file: &RobotFile) -> Structure {
        let joints: Vec<&str> = file.joint.iter().map(|joint| joint.name.as_str()).collect();
        let mut structure = Structure::EMPTY;
        // Names of the compliances in the order of the core: drives, then springs.
        let mut names: Vec<Option<String>> = joints.iter().map(|name| Some((*name).to_owned())).collect();
        for (index, table) in file.spring.iter().enumerate() {
            let path = format!("spring[{index}]");
            match table.springs(&joints) {
                Ok(springs) => {
                    names.extend(springs.iter().map(|_| table.name()));
                    structure.springs.extend(springs);
                }
                Err(fault) => self.fault(&path, &fault),
            }
        }
        for (index, table) in file.mass.iter().enumerate() {
            let path = format!("mass[{index}]");
            match table.mass(&joints) {
                Ok(mass) => structure.masses.push(mass),
                Err(fault) => self.fault(&path, &fault),
            }
        }
        structure.motors = self.motors(file);
        structure.damping = self.damping(file);
        structure.curves = (0..file.joint.len())
            .map(|joint| self.curve(file, joint))
            .collect();
        structure.backlash = (0..file.joint.len())
            .map(|joint| self.backlash(file, joint))
            .collect();
        structure.compensator = self.compensator(file, &joints);
        structure.repeatability = (file.repeatability.as_ref())
            .map_or(0.0, |table| repeatability::deviation_of(from_mm(table.pose_mm)));
        structure.model_error = (file.model_error.as_ref()).map_or(0.0, |table| table.percent / 100.0);
        if let Some(table) = &file.covariance {
            structure.covariance = self.covariance(table, &names, &structure, file);
        }
        structure.geometry = self.geometry_covariance(file).map(Arc::new);
        structure
    }

    /// Keeps what is wrong with a spring or mass that is at `table`.
    fn fault(&mut self, table: &str, fault: &SpringTableError) {
        self.problem(&fault.path_in(table), &fault.message, &fault.hint);
    }

    /// Angle over torque (rad, N m) of a joint, if the file gives it.
    ///
    /// A single curve is valid while the load raises the torque and while it lowers it; with a second one the two make
    /// a loop.
    fn curve(&mut self, file: &RobotFile, joint: usize) -> Option<JointCurve> {
        let entry = &file.joint[joint];
        let falling = "torque_curve_falling_n_m_rad";
        let path = format!("joint[{joint}]");
        if entry.torque_curve_n_m_rad.is_none() && entry.torque_curve_falling_n_m_rad.is_some() {
            let message = format!("joint {}: a falling curve without the rising one", entry.name);
            self.problem(&format!("{path}.{falling}"), message, "add torque_curve_n_m_rad");
            return None;
        }
        let mut read = |key: &str, points: Option<&Vec<[f64; 2]>>| {
            let made = TorqueCurve::new(points?.clone());
            made.map_err(|refused| {
                let message = format!("joint {}: {refused}", entry.name);
                let hint = "pairs [N m, rad], torques rising: [[-500, -4e-4], [0, 0], [500, 4e-4]]";
                self.problem(&format!("{path}.{key}"), message, hint);
            })
            .ok()
        };
        let rising = read("torque_curve_n_m_rad", entry.torque_curve_n_m_rad.as_ref());
        let falling = read(falling, entry.torque_curve_falling_n_m_rad.as_ref());
        Some(JointCurve {
            rising: rising?,
            falling,
        })
    }

    /// Backlash of a joint, rad or m, if the file gives it.
    fn backlash(&mut self, file: &RobotFile, joint: usize) -> Option<Backlash> {
        let entry = &file.joint[joint];
        let path = format!("joint[{joint}]");
        let uncertainty = entry.backlash_u_deg.or(entry.backlash_u_mm);
        let Some([gap, standard_uncertainty]) = entry.backlash() else {
            if uncertainty.is_some() || entry.backlash_side.is_some() || entry.backlash_source.is_some() {
                let message = format!(
                    "joint {}: backlash details are given without a backlash",
                    entry.name
                );
                self.problem(&path, message, "add backlash_deg = 0.01, the total backlash");
            }
            return None;
        };
        if entry.backlash_source.is_none() {
            let message = format!("joint {}: its backlash names no source", entry.name);
            self.problem(&path, message, "add backlash_source = \"...\"");
        }
        Some(Backlash {
            gap,
            standard_uncertainty,
            side: match entry.backlash_side {
                Some(BacklashSideName::Torque) => BacklashSide::Torque,
                Some(BacklashSideName::Motion) | None => BacklashSide::Motion,
            },
        })
    }

    /// The spring against gravity, in m, rad and N/m.
    ///
    /// `None` also where it is refused: no such joint, or radii so alike that the two ends of the spring could meet.
    fn compensator(&mut self, file: &RobotFile, joints: &[&str]) -> Option<Compensator> {
        let table = file.compensator.as_ref()?;
        let Some(joint) = joints.iter().position(|name| *name == table.joint) else {
            let message = format!("`{}` is not a joint of the arm", table.joint);
            self.problem(
                "compensator.joint",
                message,
                &format!("one of: {}", joints.join(", ")),
            );
            return None;
        };
        if (table.fixed_radius_mm - table.arm_radius_mm).abs() < 1.0 {
            let message = format!(
                "the radii {} mm and {} mm of the compensator differ by less than 1 mm: its spring could reach length zero",
                table.fixed_radius_mm, table.arm_radius_mm
            );
            self.problem(
                "compensator.arm_radius_mm",
                message,
                "distances of its two ends from the axis of the joint",
            );
            return None;
        }
        Some(Compensator {
            joint,
            fixed_radius: from_mm(table.fixed_radius_mm),
            arm_radius: from_mm(table.arm_radius_mm),
            angle: from_deg(table.angle_deg),
            free_length: from_mm(table.free_length_mm),
            stiffness: from_per_mm(table.stiffness_n_per_mm),
        })
    }

    /// The covariance over all compliances, drives first; those that it does not name stay independent.
    ///
    /// Square in the number of compliances, rad^2/(N m)^2. Standard uncertainties of those that the matrix names are
    /// read off the matrix, not off their own keys. `None` where it is refused.
    fn covariance(
        &mut self,
        table: &CovarianceTable,
        names: &[Option<String>],
        structure: &Structure,
        file: &RobotFile,
    ) -> Option<DMatrix<f64>> {
        let size = table.of.len();
        let rows = &table.matrix_rad2_per_n2_m2;
        if rows.len() != size || rows.iter().any(|row| row.len() != size) {
            let message = format!("the covariance of {size} compliances needs {size} rows of {size} numbers");
            self.problem(
                "covariance.matrix_rad2_per_n2_m2",
                message,
                "one row and column for each name in `of`",
            );
            return None;
        }
        let mut places = Vec::new();
        for (index, name) in table.of.iter().enumerate() {
            let path = format!("covariance.of[{index}]");
            let known = names.iter().position(|known| known.as_ref() == Some(name));
            match known {
                Some(place) if !places.contains(&place) => places.push(place),
                Some(_) => self.problem(&path, format!("`{name}` is given twice"), "name each once"),
                None => {
                    let known: Vec<&str> = names.iter().flatten().map(String::as_str).collect();
                    let hint = format!("a joint, or a spring as `A2 about x`: {}", known.join(", "));
                    self.problem(&path, format!("`{name}` is not a compliance of this file"), &hint);
                }
            }
            if name.contains(" along ") || slides(file, name) {
                let hint = "the matrix has one unit: give prismatic joints and springs along an axis their own uncertainty";
                self.problem(
                    &path,
                    format!("`{name}` is a translation: the matrix is valid for rotations only"),
                    hint,
                );
            }
        }
        if places.len() != size {
            return None;
        }
        let own = file.joint.iter().map(JointEntry::compliance_uncertainty).chain(
            structure
                .springs
                .iter()
                .map(|spring| spring.compliance.standard_uncertainty),
        );
        // Own variances on the diagonal; the matrix then takes the places of those that it names.
        let squares: Vec<f64> = own.map(|u| u * u).collect();
        let mut covariance = DMatrix::from_diagonal(&squares.into());
        for (i, row) in places.iter().enumerate() {
            for (j, column) in places.iter().enumerate() {
                covariance[(*row, *column)] = rows[i][j];
            }
        }
        Some(covariance)
    }
}

/// Whether the chain has a joint of this name that slides.
pub(super) fn slides(file: &RobotFile, joint: &str) -> bool {
    let own = |motion: &&super::file::MotionEntry| motion.joint.as_deref() == Some(joint);
    let motion = file.chain.motions.iter().find(own);
    motion.is_some_and(|motion| motion.along.is_some())
}
