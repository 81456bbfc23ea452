//! Which inputs of a prediction have an uncertainty, and whether that of the prediction is therefore known: the one
//! place that decides it.
//!
//! An input without standard uncertainty is not exact: its uncertainty is unknown. Loads are given and not part of this
//! list: a prediction is valid for the load as it is given.
//!
//! | inputs with an effect | uncertainty of the prediction |
//! |---|---|
//! | each has an uncertainty | known |
//! | at least one compliance has one, another input has none | a lower bound |
//! | no compliance has one | not known |
//!
//! An arm that does not deflect has no compliance with an effect; its backlash and thermal growth decide then.

use super::stiffness_model::Arm;

/// An input that has an effect, but no uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputWithoutUncertainty {
    /// The compliance of a joint.
    Joint(usize),
    /// The compliance of a spring of the structure.
    Spring(usize),
    /// The backlash of a joint.
    Backlash(usize),
    /// The thermal growth of the links.
    Thermal,
    /// The calibrated geometry.
    Geometry,
}

/// The inputs of an arm, with and without uncertainty.
struct Inputs {
    compliances_with: usize,
    others_with: usize,
    without: Vec<InputWithoutUncertainty>,
}

impl Arm<'_> {
    /// Whether the uncertainty of a prediction with this arm is known, completely or as a lower bound.
    pub fn has_known_uncertainty(&self) -> bool {
        let inputs = self.inputs();
        let compliance_without = |input: &InputWithoutUncertainty| {
            matches!(
                input,
                InputWithoutUncertainty::Joint(_) | InputWithoutUncertainty::Spring(_)
            )
        };
        let deflects = inputs.compliances_with > 0 || inputs.without.iter().any(compliance_without);
        if deflects {
            inputs.compliances_with > 0
        } else {
            inputs.others_with > 0
        }
    }

    /// Inputs that have an effect, but no uncertainty: joints, springs, backlash, thermal growth.
    pub fn inputs_without_uncertainty(&self) -> Vec<InputWithoutUncertainty> {
        self.inputs().without
    }

    fn inputs(&self) -> Inputs {
        let structure = &self.model.structure;
        let joints = self.compliance.len();
        let mut inputs = Inputs {
            compliances_with: 0,
            others_with: 0,
            without: Vec::new(),
        };
        for (k, compliance) in self.compliances().iter().enumerate() {
            let covariance = structure.covariance.as_ref().filter(|s| k < s.nrows());
            let variance = covariance.map_or(compliance.standard_uncertainty.powi(2), |s| s[(k, k)]);
            let curved = k < joints && structure.curve(k).is_some();
            if variance > 0.0 {
                inputs.compliances_with += 1;
            } else if compliance.value > 0.0 || curved {
                inputs.without.push(match k.checked_sub(joints) {
                    None => InputWithoutUncertainty::Joint(k),
                    Some(spring) => InputWithoutUncertainty::Spring(spring),
                });
            }
        }
        for (joint, backlash) in structure.joints_with_backlash() {
            if backlash.standard_uncertainty > 0.0 {
                inputs.others_with += 1;
            } else {
                inputs.without.push(InputWithoutUncertainty::Backlash(joint));
            }
        }
        if self.model.gravity.is_some() {
            let uncertain = structure
                .masses
                .iter()
                .filter(|mass| mass.relative_uncertainty > 0.0);
            inputs.others_with += uncertain.count();
        }
        inputs.others_with += usize::from(structure.learnt.is_some());
        inputs.others_with += usize::from(structure.geometry.is_some());
        if self.model.actual.is_some() && structure.geometry.is_none() {
            inputs.without.push(InputWithoutUncertainty::Geometry);
        }
        match self.model.thermal {
            Some(growth) if growth.standard_uncertainty > 0.0 => inputs.others_with += 1,
            Some(growth) if growth.growth != 0.0 => inputs.without.push(InputWithoutUncertainty::Thermal),
            _ => {}
        }
        inputs
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, Vector3};

    use super::InputWithoutUncertainty::{Backlash, Geometry, Joint, Spring, Thermal};
    use super::*;
    use crate::arms;
    use crate::robot::{self, Attachment, BacklashSide, JointCompliance};
    use crate::source::{StiffnessModel, ThermalGrowth};

    const fn compliance(value: f64, standard_uncertainty: f64) -> JointCompliance {
        JointCompliance {
            value,
            standard_uncertainty,
        }
    }

    /// Whether the uncertainty is known, and the inputs without one, with these compliances and this model.
    fn decided(
        compliance: &[JointCompliance],
        model: &StiffnessModel,
    ) -> (bool, Vec<InputWithoutUncertainty>) {
        let arm = Arm {
            robot: &arms::ALL[0],
            compliance,
            model,
            flange_from_tool: &arms::bent_tool(),
        };
        (arm.has_known_uncertainty(), arm.inputs_without_uncertainty())
    }

    #[test]
    fn compliances_without_any_uncertainty_are_unknown_and_with_some_a_lower_bound() {
        let (with, without, rigid) = (
            compliance(1e-6, 1e-7),
            compliance(1e-6, 0.0),
            compliance(0.0, 0.0),
        );
        let drives = StiffnessModel::DRIVES;
        assert_eq!(decided(&[with; 6], drives), (true, vec![]));
        assert_eq!(
            decided(&[without; 6], drives),
            (false, (0..6).map(Joint).collect())
        );
        let mut mixed = [with; 6];
        (mixed[2], mixed[4]) = (without, rigid);
        // A rigid joint is an assumption without an effect that could be uncertain.
        assert_eq!(decided(&mixed, drives), (true, vec![Joint(2)]));
    }

    #[test]
    fn a_covariance_decides_for_the_compliances_that_it_holds() {
        let mut model = StiffnessModel::DRIVES.clone();
        model.structure.covariance = Some(DMatrix::from_diagonal_element(6, 6, 1e-16));
        assert_eq!(decided(&[compliance(1e-6, 0.0); 6], &model), (true, vec![]));
        let spring = robot::Spring::about(Attachment::Joint(1), Vector3::x(), compliance(1e-7, 0.0));
        model.structure.springs = vec![spring];
        assert_eq!(
            decided(&[compliance(1e-6, 0.0); 6], &model),
            (true, vec![Spring(0)])
        );
    }

    #[test]
    fn backlash_and_thermal_growth_without_uncertainty_are_named() {
        let mut model = StiffnessModel::DRIVES.clone();
        let backlash = |standard_uncertainty| {
            Some(robot::Backlash {
                gap: 1e-4,
                standard_uncertainty,
                side: BacklashSide::Motion,
            })
        };
        model.structure.backlash = vec![None, backlash(0.0), backlash(1e-5)];
        model.thermal = Some(ThermalGrowth {
            growth: 1e-4,
            standard_uncertainty: 0.0,
        });
        let with = [compliance(1e-6, 1e-7); 6];
        assert_eq!(decided(&with, &model), (true, vec![Backlash(1), Thermal]));
        model.actual = Some(std::sync::Arc::new(arms::mh12()));
        assert_eq!(
            decided(&with, &model),
            (true, vec![Backlash(1), Geometry, Thermal])
        );
        model.actual = None;
        // Known backlash is not enough where the deflection is unknown, and is where nothing deflects.
        assert!(!decided(&[compliance(1e-6, 0.0); 6], &model).0);
        assert!(decided(&[compliance(0.0, 0.0); 6], &model).0);
        assert!(!decided(&[compliance(0.0, 0.0); 6], StiffnessModel::DRIVES).0);
    }
}
