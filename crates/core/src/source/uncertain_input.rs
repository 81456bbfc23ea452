//! Independent uncertain inputs of a prediction, each as a change of the arm or its load by one standard uncertainty.
//!
//! ```text
//! u^2(y) = sum over k of (y(x + l_k) - y(x))^2        S = L L^T, columns l_k
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `y` | any prediction, such as the difference of two deviations of one arm |
//! | `x` | all inputs |
//! | `l_k` | change of the inputs by one standard uncertainty of the independent input k |
//! | `S` | covariance of the compliances; the other inputs are independent |
//!
//! This is the numerical form of the law of propagation (JCGM 100:2008, 5.1.3, note 2). Predictions that share the inputs
//! are correlated: the uncertainty of their difference follows from evaluating both with the same changes.

use std::sync::Arc;

use nalgebra::{DMatrix, SymmetricEigen, Translation3, Vector3};

use super::stiffness_model::{Arm, StiffnessModel};
use crate::frame::Isometry;
use crate::load::InputUncertainty;
use crate::robot::{JointCompliance, Robot, Structure};

/// One independent input, changed by its standard uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub enum UncertainInput {
    /// Changes of all compliances, drives, then springs: rad/(N m), m/N.
    Compliances(Vec<f64>),
    /// A joint, and the change of its backlash, rad (m).
    Backlash(usize, f64),
    /// A mass of the structure, and its relative change, its inertia included; it has an effect with gravity only.
    Mass(usize, f64),
    /// Change of the relative growth of the links.
    Thermal(f64),
    /// Shift of the learnt residual along one of its axes by its standard uncertainty, in every posture.
    Learnt(usize),
    /// Change of the geometry by one standard uncertainty of this independent input of it.
    Geometry(usize),
    /// Change of the position of the TCP along the tool axis, m.
    ToolLength(f64),
    /// Relative change of the load.
    LoadSize(f64),
    /// A force added to every load case, N, base.
    Force(Vector3<f64>),
}

/// An arm with one input changed.
#[derive(Clone, Debug)]
pub struct ChangedArm {
    compliance: Vec<JointCompliance>,
    model: StiffnessModel,
    flange_from_tool: Isometry,
}

impl ChangedArm {
    /// The arm, a variant of `robot`.
    pub fn arm<'a>(&'a self, robot: &'a Robot) -> Arm<'a> {
        Arm {
            robot,
            compliance: &self.compliance,
            model: &self.model,
            flange_from_tool: &self.flange_from_tool,
        }
    }
}

impl UncertainInput {
    /// All inputs of `arm` and its load whose uncertainty is known and not zero.
    pub fn all(arm: &Arm<'_>, load: &InputUncertainty) -> Vec<UncertainInput> {
        let backlash = arm.model.structure.joints_with_backlash();
        let thermal = arm
            .model
            .thermal
            .map_or(0.0, |growth| growth.standard_uncertainty);
        let weights = arm
            .model
            .gravity
            .iter()
            .flat_map(|_| arm.model.structure.masses.iter().enumerate());
        let masses = weights.map(|(index, mass)| UncertainInput::Mass(index, mass.relative_uncertainty));
        let learnt = arm.model.structure.learnt.iter().flat_map(|_| 0..3);
        let geometry = arm
            .model
            .structure
            .geometry
            .iter()
            .flat_map(|geometry| 0..geometry.inputs());
        let compliances = compliance_changes(arm).into_iter();
        compliances
            .filter(|changes| changes.iter().any(|by| *by != 0.0))
            .map(UncertainInput::Compliances)
            .chain(
                backlash
                    .map(|(joint, backlash)| UncertainInput::Backlash(joint, backlash.standard_uncertainty)),
            )
            .chain(masses)
            .chain(learnt.map(UncertainInput::Learnt))
            .chain(geometry.map(UncertainInput::Geometry))
            .chain([
                UncertainInput::Thermal(thermal),
                UncertainInput::ToolLength(load.tool_length),
                UncertainInput::LoadSize(load.relative),
            ])
            .chain(load.forces.map(UncertainInput::Force))
            .filter(|input| !input.is_zero())
            .collect()
    }

    fn is_zero(&self) -> bool {
        match self {
            UncertainInput::Compliances(changes) => changes.iter().all(|by| *by == 0.0),
            UncertainInput::Backlash(_, by)
            | UncertainInput::Mass(_, by)
            | UncertainInput::Thermal(by)
            | UncertainInput::ToolLength(by)
            | UncertainInput::LoadSize(by) => *by == 0.0,
            UncertainInput::Force(by) => *by == Vector3::zeros(),
            UncertainInput::Learnt(_) | UncertainInput::Geometry(_) => false,
        }
    }

    /// `arm` with this input changed; the same arm for an input of the load.
    pub fn changed(&self, arm: &Arm<'_>) -> ChangedArm {
        let mut changed = ChangedArm {
            compliance: arm.compliance.to_vec(),
            model: arm.model.clone(),
            flange_from_tool: *arm.flange_from_tool,
        };
        match self {
            UncertainInput::Compliances(by) => add(&mut changed.compliance, &mut changed.model.structure, by),
            UncertainInput::Backlash(joint, by) => {
                if let Some(backlash) = &mut changed.model.structure.backlash[*joint] {
                    backlash.gap += by;
                }
            }
            UncertainInput::Mass(index, by) => {
                let mass = &mut changed.model.structure.masses[*index];
                mass.mass *= 1.0 + by;
                mass.inertia = mass.inertia.map(|inertia| inertia * (1.0 + by));
            }
            UncertainInput::Thermal(by) => {
                if let Some(thermal) = &mut changed.model.thermal {
                    thermal.growth += by;
                }
            }
            UncertainInput::Learnt(component) => {
                let learnt = &mut changed.model.structure.learnt;
                *learnt = learnt.as_ref().map(|learnt| Arc::new(learnt.shifted(*component)));
            }
            UncertainInput::Geometry(input) => {
                let geometry = &mut changed.model.structure.geometry;
                *geometry = geometry
                    .as_ref()
                    .map(|geometry| Arc::new(geometry.shifted(*input)));
            }
            UncertainInput::ToolLength(by) => {
                changed.flange_from_tool *= Translation3::new(0.0, 0.0, *by);
            }
            UncertainInput::LoadSize(_) | UncertainInput::Force(_) => {}
        }
        changed
    }
}

/// Adds `by` to the compliances of drives and springs; a torque curve turns by as much more per unit of torque.
fn add(compliance: &mut [JointCompliance], structure: &mut Structure, by: &[f64]) {
    let (drives, springs) = by.split_at(compliance.len());
    for (joint, by) in drives.iter().enumerate() {
        compliance[joint].value += by;
        if let Some(Some(curve)) = structure.curves.get_mut(joint) {
            *curve = curve.more_compliant(*by);
        }
    }
    for (spring, by) in structure.springs.iter_mut().zip(springs) {
        spring.compliance.value += by;
    }
}

/// Changes of all compliances, drives, then springs, by one standard uncertainty of each independent input: each
/// compliance by itself, and along the axes of the covariance where one is known.
pub(crate) fn compliance_changes(arm: &Arm<'_>) -> Vec<Vec<f64>> {
    let compliances = arm.compliances();
    let row = |of: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..compliances.len()).map(of).collect() };
    let known = arm.model.structure.covariance.as_ref();
    let size = known.map_or(0, DMatrix::nrows);
    let axes = known.map(|covariance| SymmetricEigen::new(covariance.clone()));
    let together = axes.iter().flat_map(|axes| {
        (0..size).map(|m| {
            let length = axes.eigenvalues[m].max(0.0).sqrt();
            row(&|k| {
                if k < size {
                    length * axes.eigenvectors[(k, m)]
                } else {
                    0.0
                }
            })
        })
    });
    let alone = (size..compliances.len())
        .map(|own| {
            let u = compliances[own].standard_uncertainty;
            row(&|k| if k == own { u } else { 0.0 })
        })
        .collect::<Vec<_>>();
    together.chain(alone).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms;
    use crate::robot::{Attachment, Backlash, BacklashSide, Mass, SmallMotion, Spring, UncertainGeometry};
    use crate::source::stiffness_model::Gravity;
    use crate::source::{ArmState, ThermalGrowth};
    use crate::spatial::Wrench;
    use nalgebra::{Matrix3, Point3};

    fn model() -> StiffnessModel {
        let mut model = StiffnessModel::DRIVES.clone();
        let spring = JointCompliance {
            value: 4e-7,
            standard_uncertainty: 1e-7,
        };
        model.structure.springs = vec![Spring::about(Attachment::Joint(1), Vector3::x(), spring)];
        // Of the first two drives.
        model.structure.covariance = Some(DMatrix::from_row_slice(2, 2, &[4e-16, 3e-16, 3e-16, 4e-16]));
        model.structure.backlash = vec![
            None,
            Some(Backlash {
                gap: 1e-4,
                standard_uncertainty: 2e-5,
                side: BacklashSide::Motion,
            }),
        ];
        model.thermal = Some(ThermalGrowth {
            growth: 1e-4,
            standard_uncertainty: 3e-5,
        });
        model
    }

    #[test]
    fn changes_of_the_inputs_give_the_variance_that_the_arm_reports() {
        let (robot, model, tool) = (&arms::ALL[0], model(), arms::bent_tool());
        let arm = Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model: &model,
            flange_from_tool: &tool,
        };
        let (q, load) = (
            [0.4, -0.3, 0.2, 0.5, -0.8, 0.1],
            Wrench::from_force(Vector3::new(300.0, -200.0, 100.0)),
        );
        let along = Vector3::new(0.48, -0.6, 0.64);
        let elastic = |arm: &Arm<'_>| {
            let mut arm_state = ArmState::new(*arm);
            arm_state.set_joints(&q);
            let deviation = arm_state.elastic(&load).unwrap().linear.dot(&along);
            (deviation, arm_state.variance_along(&along))
        };
        let (nominal, variance) = elastic(&arm);
        let changes = compliance_changes(&arm);
        // Two axes of the covariance, four other drives, a spring.
        assert_eq!(changes.len(), 7);
        let sum: f64 = changes
            .into_iter()
            .map(|by| {
                let changed = UncertainInput::Compliances(by).changed(&arm);
                (elastic(&changed.arm(robot)).0 - nominal).powi(2)
            })
            .sum();
        assert!(
            variance > 0.0 && (sum / variance - 1.0).abs() < 1e-9,
            "{sum} {variance}"
        );
    }

    #[test]
    fn changes_of_the_masses_give_their_part_of_the_variance() {
        let (robot, mut model, tool) = (&arms::ALL[0], model(), arms::bent_tool());
        let mass = |joint: usize, relative_uncertainty| Mass {
            attachment: Attachment::Joint(joint),
            mass: 60.0 - 8.0 * joint as f64,
            centre: Point3::new(0.1, -0.05, 0.2),
            inertia: None,
            relative_uncertainty,
        };
        model.structure.masses = vec![mass(1, 0.4), mass(2, 0.0), mass(4, 0.2)];
        model.gravity = Some(Gravity {
            acceleration: Vector3::new(1.0, 2.0, -9.5),
            reference: vec![0.1, 0.2, -0.3, 0.4, 0.9, 0.0],
        });
        let arm = Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model: &model,
            flange_from_tool: &tool,
        };
        let along = Vector3::new(0.48, -0.6, 0.64);
        let sag = |arm: &Arm<'_>| {
            let mut arm_state = ArmState::new(*arm);
            arm_state.set_joints(&[0.4, -0.3, 0.2, 0.5, -0.8, 0.1]);
            arm_state.elastic(&Wrench::ZERO).unwrap();
            let sag = arm_state.gravity().unwrap().unwrap().linear.dot(&along);
            let covariance = along.dot(&(arm_state.covariance() * along));
            (sag, arm_state.variance_along(&along), covariance)
        };
        let (nominal, variance, by_matrix) = sag(&arm);
        let inputs = UncertainInput::all(&arm, &InputUncertainty::NONE);
        let by_masses = inputs
            .iter()
            .filter(|input| matches!(input, UncertainInput::Mass(..)));
        assert_eq!(by_masses.count(), 2);
        let acting = |input: &&UncertainInput| {
            matches!(input, UncertainInput::Mass(..) | UncertainInput::Compliances(_))
        };
        let squares = inputs.iter().filter(acting).map(|input| {
            let changed = input.changed(&arm);
            (sag(&changed.arm(robot)).0 - nominal).powi(2)
        });
        let sum: f64 = squares.sum();
        // Of the compliances alone.
        let exact = StiffnessModel {
            structure: Structure {
                masses: model
                    .structure
                    .masses
                    .iter()
                    .map(|mass| Mass {
                        relative_uncertainty: 0.0,
                        ..*mass
                    })
                    .collect(),
                ..model.structure.clone()
            },
            ..model.clone()
        };
        let (_, without, _) = sag(&Arm { model: &exact, ..arm });
        assert!(variance > 1.1 * without, "{variance} {without}");
        assert!((sum / variance - 1.0).abs() < 1e-9, "{sum} {variance}");
        assert!(
            (by_matrix / variance - 1.0).abs() < 1e-12,
            "{by_matrix} {variance}"
        );
    }

    #[test]
    fn changes_of_the_geometry_give_its_part_of_the_variance() {
        let (robot, mut model, tool) = (&arms::ALL[0], model(), arms::bent_tool());
        (model.thermal, model.structure.backlash) = (None, Vec::new());
        let motions = [(0, 3), (1, 0), (1, 4), (2, 5), (4, 1)];
        let motions = motions
            .map(|(after, component)| SmallMotion { after, component })
            .to_vec();
        let root = DMatrix::from_fn(5, 5, |i, j| 1e-4 * ((2 * i + 3 * j) as f64).cos());
        let covariance = &root * root.transpose() + DMatrix::identity(5, 5) * 1e-9;
        let geometry = UncertainGeometry::new(motions, &covariance).unwrap();
        model.structure.geometry = Some(Arc::new(geometry));
        let arm = Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model: &model,
            flange_from_tool: &tool,
        };
        let moved = |arm: &Arm<'_>| {
            let mut arm_state = ArmState::new(*arm);
            arm_state.set_joints(&[0.4, -0.3, 0.2, 0.5, -0.8, 0.1]);
            let mut covariance = Matrix3::zeros();
            arm_state.each_unloaded(&[0.0; 6], &Wrench::ZERO, |_, _, u| {
                covariance += u * u.transpose();
            });
            (arm_state.geometric().linear, covariance)
        };
        let (nominal, covariance) = moved(&arm);
        assert_eq!(nominal, Vector3::zeros());
        let inputs = UncertainInput::all(&arm, &InputUncertainty::NONE);
        let of_geometry = inputs
            .iter()
            .filter(|input| matches!(input, UncertainInput::Geometry(_)));
        assert_eq!(of_geometry.clone().count(), 5);
        let sum: Matrix3<f64> = of_geometry
            .map(|input| {
                let by = moved(&input.changed(&arm).arm(robot)).0;
                by * by.transpose()
            })
            .sum();
        assert!(covariance.norm() > 1e-9 && (sum - covariance).norm() < 1e-12 * covariance.norm());
    }

    #[test]
    fn inputs_without_uncertainty_are_not_listed_and_each_changes_its_own_part() {
        let (robot, model, tool) = (&arms::ALL[0], model(), arms::bent_tool());
        let exact = vec![
            JointCompliance {
                value: 1e-7,
                standard_uncertainty: 0.0
            };
            6
        ];
        let arm = Arm {
            robot,
            compliance: &exact,
            model: &model,
            flange_from_tool: &tool,
        };
        let load = InputUncertainty {
            relative: 0.1,
            forces: [Vector3::zeros(), Vector3::y(), Vector3::zeros()],
            tool_length: 1e-3,
        };
        let all = UncertainInput::all(&arm, &load);
        assert_eq!(all.len(), 3 + 1 + 1 + 1 + 1 + 1);
        assert!(
            all.contains(&UncertainInput::Force(Vector3::y()))
                && all.contains(&UncertainInput::LoadSize(0.1))
        );
        let changed = |input: UncertainInput| input.changed(&arm);
        let backlash = changed(UncertainInput::Backlash(1, 2e-5))
            .model
            .structure
            .backlash[1];
        assert!((backlash.unwrap().gap - 1.2e-4).abs() < 1e-18);
        let warmer = changed(UncertainInput::Thermal(3e-5)).model.thermal;
        assert!((warmer.unwrap().growth - 1.3e-4).abs() < 1e-18);
        let longer = changed(UncertainInput::ToolLength(1e-3)).flange_from_tool;
        let by = (tool.inverse() * longer).translation.vector;
        assert!((by - Vector3::new(0.0, 0.0, 1e-3)).norm() < 1e-15);
        assert_eq!(
            UncertainInput::all(
                &Arm {
                    model: StiffnessModel::DRIVES,
                    ..arm
                },
                &InputUncertainty::NONE
            ),
            []
        );
    }
}
