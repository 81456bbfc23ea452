//! The parts of the stiffness model, and the arm to which they apply.
//!
//! The simple model: every joint deflects about its own axis, and nothing else does. Every further part is optional;
//! without it the results are identical to the last bit.

use std::sync::Arc;

use nalgebra::{DMatrix, Vector3};

use super::contributor::Contributor;
use super::thermal::ThermalGrowth;
use crate::frame::Isometry;
use crate::robot::deflected_arm::FlexibleArm;
use crate::robot::{Attachment, Joint, JointCompliance, MovedBy, Robot, Structure};

/// Standard acceleration of free fall, m/s^2: 3rd CGPM 1901, ISO 80000-3.
pub const FREE_FALL: f64 = 9.806_65;

/// Gravity, and the joint positions at tool setting: deflection by gravity is relative to those.
#[derive(Clone, Debug, PartialEq)]
pub struct Gravity {
    /// Acceleration, m/s^2, base; points down.
    pub acceleration: Vector3<f64>,
    /// Joint positions at tool setting, rad (m), controller coordinates.
    pub reference: Vec<f64>,
}

/// The parts of the stiffness model in addition to the drive springs.
#[derive(Clone, Debug)]
pub struct StiffnessModel {
    /// Springs, masses and other parts, tool and payload included.
    pub structure: Structure,
    /// Gravity; `None` neglects it, whatever the masses.
    pub gravity: Option<Gravity>,
    /// Whether the load acts on the deflected arm instead of the undeflected one.
    pub load_dependent: bool,
    /// The calibrated arm, where it differs from the model in its controller.
    pub actual: Option<Arc<Robot>>,
    /// Thermal growth of the links; `None` neglects it.
    pub thermal: Option<ThermalGrowth>,
}

impl StiffnessModel {
    /// Only drive springs.
    pub const DRIVES: &'static StiffnessModel = &StiffnessModel {
        structure: Structure::EMPTY,
        gravity: None,
        load_dependent: false,
        actual: None,
        thermal: None,
    };

    /// Whether only drive springs contribute to the deviation, each with an independent uncertainty.
    pub fn is_drives_alone(&self) -> bool {
        let s = &self.structure;
        let curved = s.curves.iter().any(Option::is_some);
        let plain = s.springs.is_empty() && s.compensator.is_none() && s.covariance.is_none() && !curved;
        plain && !self.load_dependent && (self.gravity.is_none() || s.masses.is_empty())
    }

    /// Whether the deviation under a wrench `w` is `C w + g` in one posture: no joint stiffens with its torque, and the
    /// load does not change the arm that it acts on.
    pub fn is_affine(&self) -> bool {
        !self.load_dependent && self.structure.curves.iter().all(Option::is_none)
    }

    /// Whether the tool has deviations that do not depend on the load, or uncertainties of such: backlash, geometry, thermal growth, learnt residual.
    pub fn has_unloaded_deviation(&self) -> bool {
        self.structure.joints_with_backlash().next().is_some()
            || self.actual.is_some()
            || self.thermal.is_some()
            || self.structure.learnt.is_some()
            || self.structure.geometry.is_some()
    }

    /// The contributors to the deviation: every joint, then base, flange and tool where they have springs, then the
    /// geometry, thermal growth and the learnt residual where they are included.
    pub fn contributors(&self, joints: usize) -> Vec<Contributor> {
        let others = [Attachment::Base, Attachment::Flange, Attachment::Tool];
        let has_spring = |attachment: &Attachment| {
            self.structure
                .springs
                .iter()
                .any(|spring| spring.attachment == *attachment)
        };
        (0..joints)
            .map(Attachment::Joint)
            .chain(others.into_iter().filter(has_spring))
            .map(Contributor::At)
            .chain(self.actual.as_ref().map(|_| Contributor::Geometry))
            .chain(self.thermal.map(|_| Contributor::Thermal))
            .chain(self.structure.learnt.as_ref().map(|_| Contributor::Learnt))
            .collect()
    }

    /// Names of [`StiffnessModel::contributors`].
    pub fn contributor_names(&self, joints: &[Joint]) -> Vec<String> {
        let all = self.contributors(joints.len()).into_iter();
        all.map(|contributor| contributor.name(joints)).collect()
    }
}

/// An arm with its tool, compliances and stiffness model.
#[derive(Clone, Copy, Debug)]
pub struct Arm<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Compliance of each of its joints.
    pub compliance: &'a [JointCompliance],
    /// The other parts of the model.
    pub model: &'a StiffnessModel,
    /// Flange to tool centre point.
    pub flange_from_tool: &'a Isometry,
}

impl Arm<'_> {
    /// Chain, springs and tool.
    pub fn flexible(&self) -> FlexibleArm<'_> {
        FlexibleArm {
            robot: self.robot,
            springs: &self.model.structure.springs,
            flange_from_tool: self.flange_from_tool,
        }
    }

    /// Compliances of all drives, then of all springs.
    pub fn compliances(&self) -> Vec<JointCompliance> {
        let springs = self
            .model
            .structure
            .springs
            .iter()
            .map(|spring| spring.compliance);
        self.compliance.iter().copied().chain(springs).collect()
    }

    /// Covariance of the compliances of all drives, then of all springs, rad^2/(N m)^2, m^2/N^2; those outside the covariance of
    /// the structure are independent.
    pub fn compliance_covariance(&self) -> DMatrix<f64> {
        let own: Vec<f64> = (self.compliances().iter())
            .map(|compliance| compliance.standard_uncertainty.powi(2))
            .collect();
        let mut covariance = DMatrix::from_diagonal(&own.into());
        if let Some(known) = &self.model.structure.covariance {
            covariance.view_mut((0, 0), known.shape()).copy_from(known);
        }
        covariance
    }

    /// What each drive, then each spring, moves.
    pub(super) fn moved_by(&self) -> Vec<MovedBy> {
        let (ground, joints) = (self.robot.chain().ground(), self.robot.joints().len());
        let springs = self.model.structure.springs.iter();
        (0..joints)
            .map(|joint| ground.moved_by_drive(joint))
            .chain(springs.map(|spring| ground.moved_by_spring(spring.attachment, joints)))
            .collect()
    }

    /// Attachment of each drive, then of each spring.
    pub fn attachments(&self) -> Vec<Attachment> {
        let springs = self
            .model
            .structure
            .springs
            .iter()
            .map(|spring| spring.attachment);
        (0..self.robot.joints().len())
            .map(Attachment::Joint)
            .chain(springs)
            .collect()
    }
}

/// The standard uncertainties of a covariance: the roots of its diagonal, 0 where rounding made that negative.
pub fn standard_uncertainties(covariance: &DMatrix<f64>) -> Vec<f64> {
    let variances = covariance.diagonal();
    variances
        .iter()
        .map(|variance| variance.max(0.0).sqrt())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms;
    use crate::robot::{Compensator, JointCurve, Mass, Spring, TorqueCurve};
    use crate::spatial::Wrench;
    use nalgebra::Point3;

    type Part = (&'static str, fn(&mut StiffnessModel));

    fn compliance() -> JointCompliance {
        JointCompliance {
            value: 3e-7,
            standard_uncertainty: 1e-8,
        }
    }

    /// Every part that a model may have.
    fn parts() -> [Part; 7] {
        [
            ("springs", |m| {
                m.structure.springs = vec![
                    Spring::about(Attachment::Tool, Vector3::x(), compliance()),
                    Spring::about(Attachment::Base, Vector3::y(), compliance()),
                    Spring::about(Attachment::Joint(1), Vector3::y(), compliance()),
                ];
            }),
            ("masses", |m| {
                m.structure.masses = vec![Mass {
                    attachment: Attachment::Joint(2),
                    mass: 40.0,
                    centre: Point3::new(0.1, 0.0, 0.3),
                    inertia: None,
                    relative_uncertainty: 0.0,
                }];
            }),
            ("gravity", |m| {
                m.gravity = Some(Gravity {
                    acceleration: Vector3::new(0.0, 0.0, -FREE_FALL),
                    reference: vec![0.2; 6],
                });
            }),
            ("compensator", |m| {
                m.structure.compensator = Some(Compensator {
                    joint: 1,
                    fixed_radius: 0.69,
                    arm_radius: 0.185,
                    angle: 0.17,
                    free_length: 0.458,
                    stiffness: 1e4,
                });
            }),
            ("curve", |m| {
                let knee = TorqueCurve::new(vec![[-90.0, -1e-3], [-30.0, -6e-4], [30.0, 6e-4], [90.0, 1e-3]]);
                m.structure.curves = vec![Some(JointCurve {
                    rising: knee.unwrap(),
                    falling: None,
                })];
            }),
            ("covariance", |m| {
                m.structure.covariance = Some(DMatrix::identity(6, 6) * 1e-16);
            }),
            ("load", |m| m.load_dependent = true),
        ]
    }

    fn with(chosen: &[&str]) -> StiffnessModel {
        let mut model = StiffnessModel::DRIVES.clone();
        for (_, put) in parts().iter().filter(|(name, _)| chosen.contains(name)) {
            put(&mut model);
        }
        model
    }

    #[test]
    fn only_drives_is_true_where_no_other_part_has_an_effect() {
        assert!(StiffnessModel::DRIVES.is_drives_alone());
        // Masses act only with gravity, and gravity only on masses.
        for alone in ["masses", "gravity"] {
            assert!(with(&[alone]).is_drives_alone(), "{alone}");
        }
        assert!(!with(&["masses", "gravity"]).is_drives_alone());
        for part in ["springs", "compensator", "curve", "covariance", "load"] {
            assert!(!with(&[part]).is_drives_alone(), "{part}");
        }
    }

    #[test]
    fn a_model_is_affine_where_doubling_the_load_doubles_what_it_adds() {
        let robot = &arms::ALL[1];
        let (tool, q) = (arms::bent_tool(), [0.4, -1.2, 1.0, 0.3, 0.9, -0.2]);
        let load = Wrench::from_force(Vector3::new(300.0, -200.0, 100.0));
        for (name, _) in parts() {
            let model = with(&[name, "masses", "gravity"]);
            let arm = Arm {
                robot,
                compliance: robot.compliance().unwrap(),
                model: &model,
                flange_from_tool: &tool,
            };
            let under = |times: f64| arms::predicted(&arm, &q, &(load * times)).unwrap().twist.linear;
            let (none, once, twice) = (under(0.0), under(1.0), under(2.0));
            let bent = ((twice - none) - (once - none) * 2.0).norm() / (once - none).norm();
            assert_eq!(model.is_affine(), bent < 1e-12, "{name}: {bent}");
            assert_eq!(model.is_affine(), !["curve", "load"].contains(&name));
        }
    }

    #[test]
    fn contributors_are_joints_and_the_attachments_of_springs() {
        let joints: Vec<Joint> = ["A1", "A2"].map(Joint::plain).to_vec();
        assert_eq!(StiffnessModel::DRIVES.contributor_names(&joints), ["A1", "A2"]);
        // Base before tool, whatever the order of the list; springs of a joint contribute to it.
        assert_eq!(
            with(&["springs"]).contributor_names(&joints),
            ["A1", "A2", "base", "tool"]
        );
        let mut flange = StiffnessModel::DRIVES.clone();
        flange.structure.springs = vec![Spring::along(Attachment::Flange, Vector3::x(), compliance()); 2];
        assert_eq!(
            flange.contributors(1),
            [Attachment::Joint(0), Attachment::Flange].map(Contributor::At)
        );
        assert_eq!(flange.contributor_names(&joints[..1]), ["A1", "flange"]);
    }

    #[test]
    fn compliances_and_attachments_of_an_arm_are_those_of_drives_then_of_springs() {
        let (robot, model, tool) = (&arms::ALL[0], with(&["springs"]), arms::bent_tool());
        let arm = Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model: &model,
            flange_from_tool: &tool,
        };
        let compliances = arm.compliances();
        assert_eq!(&compliances[..6], robot.compliance().unwrap());
        assert_eq!(compliances[6..], [compliance(); 3]);
        let u: Vec<f64> = compliances
            .iter()
            .map(|compliance| compliance.standard_uncertainty)
            .collect();
        let found = standard_uncertainties(&arm.compliance_covariance());
        assert!(
            found
                .iter()
                .zip(&u)
                .all(|(found, u)| (found - u).abs() <= 1e-15 * u),
            "{found:?} {u:?}"
        );
        let correlated = with(&["springs", "covariance"]);
        let covariance = Arm {
            model: &correlated,
            ..arm
        }
        .compliance_covariance();
        assert_eq!(
            (covariance.nrows(), covariance[(0, 0)], covariance[(5, 5)]),
            (9, 1e-16, 1e-16)
        );
        assert_eq!(covariance[(6, 6)], 1e-8_f64.powi(2));
        assert_eq!(
            arm.attachments()[5..],
            [
                Attachment::Joint(5),
                Attachment::Tool,
                Attachment::Base,
                Attachment::Joint(1)
            ]
        );
    }
}
