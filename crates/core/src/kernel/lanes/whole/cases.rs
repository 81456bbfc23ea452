//! The deviations of a block under load cases: worst case, shares and uncertainty.

use nalgebra::Vector3;

use super::answer::{FindShares, TakeCase, TakeRoot};
use super::backlash::{CaseOnPlane, KeepOffsets, ShareBacklash, Worn, settle};
use super::compensator::Compensated;
use super::curves::Curved;
use super::inputs::AddInputs;
use super::sum::{OneCase, OneWrench};
use super::{WholeAnswers, WholeModel};
use crate::kernel::lanes::load::Worst;
use crate::load::InputUncertainty;
use crate::numbers::Planes;
use crate::spatial::Wrench;

impl WholeModel {
    /// Number of contributors.
    pub(in crate::kernel::lanes) fn contributors(&self) -> usize {
        self.model.contributors
    }

    /// Deviations under these wrenches (at the TCP, base) and the worst case; `plane` is two directions across the
    /// normal, then the normal, base.
    pub(in crate::kernel::lanes) fn envelope(
        &mut self,
        cases: &[Wrench],
        plane: &[Vector3<f64>; 3],
        out: &mut WholeAnswers,
    ) {
        if have_moments(cases) {
            self.envelope_of::<true, false>(cases, plane, out);
        } else {
            self.envelope_of::<false, false>(cases, plane, out);
        }
    }

    /// The envelope; with the parts and the offsets of links that shares need if `DETAILS`.
    fn envelope_of<const MOMENTS: bool, const DETAILS: bool>(
        &mut self,
        cases: &[Wrench],
        plane: &[Vector3<f64>; 3],
        out: &mut WholeAnswers,
    ) {
        if DETAILS || !self.gaps.is_empty() {
            self.respond::<MOMENTS, true>();
        } else {
            self.respond::<MOMENTS, false>();
        }
        for (case, (wrench, deviation)) in cases.iter().zip(&mut out.deviations).enumerate() {
            self.load_all::<MOMENTS>(wrench);
            let of_case = CaseOnPlane { case, wrench, plane };
            self.take::<MOMENTS, DETAILS>(of_case, cases.len(), deviation, &mut out.worst);
        }
    }

    /// The deviation under one of `count` load cases, taken into the worst so far.
    fn take<const MOMENTS: bool, const DETAILS: bool>(
        &mut self,
        of_case: CaseOnPlane<'_>,
        count: usize,
        deviation: &mut Planes<f64, 3>,
        worst: &mut Worst<f64>,
    ) {
        let CaseOnPlane { case, wrench, plane } = of_case;
        let (response, rest) = self.response();
        if self.gaps.is_empty() {
            self.backend.run(OneCase::<f64, MOMENTS> {
                response,
                rest,
                cases: case..count,
                wrench,
                plane,
                deviation,
                worst,
            });
            return;
        }
        self.backend.run(OneWrench::<f64, MOMENTS> {
            response,
            rest,
            wrench,
            deviation,
        });
        let WholeModel {
            model,
            backend,
            frames,
            parts,
            gaps,
            ..
        } = self;
        let arm = Worn {
            model,
            frames,
            parts,
            gaps,
        };
        settle::<DETAILS>(*backend, arm, of_case, deviation);
        backend.run(TakeCase {
            cases: case..count,
            force: wrench.force,
            moment: wrench.moment,
            plane,
            deviation,
            worst,
        });
        if DETAILS {
            backend.run(KeepOffsets {
                model,
                case,
                worst,
                gaps,
            });
        }
    }

    /// [`WholeModel::envelope`] with shares and uncertainty, that of load and tool included.
    pub(in crate::kernel::lanes) fn answer(
        &mut self,
        cases: &[Wrench],
        plane: &[Vector3<f64>; 3],
        inputs: &InputUncertainty,
        out: &mut WholeAnswers,
    ) {
        if have_moments(cases) {
            self.answer_of::<true>(cases, plane, inputs, out);
        } else {
            self.answer_of::<false>(cases, plane, inputs, out);
        }
    }

    fn answer_of<const MOMENTS: bool>(
        &mut self,
        cases: &[Wrench],
        plane: &[Vector3<f64>; 3],
        inputs: &InputUncertainty,
        out: &mut WholeAnswers,
    ) {
        self.envelope_of::<MOMENTS, true>(cases, plane, out);
        if !self.shares {
            return;
        }
        let WholeModel {
            model,
            backend,
            frames,
            parts,
            gaps,
            curves,
            compensated,
            response,
            still,
            along,
            by_unit,
            ..
        } = self;
        let WholeAnswers {
            worst,
            shares,
            uncertainty: variance,
            ..
        } = out;
        let curved = Curved {
            model,
            frames,
            parts,
            curves,
        };
        let both = model.compensator.as_ref().zip(compensated.as_deref());
        let compensated = both.map(|(constants, compensated)| Compensated {
            model,
            constants,
            compensated,
            frames,
            parts,
            worst,
        });
        backend.run(FindShares::<f64, MOMENTS> {
            model,
            frames,
            parts,
            curved,
            compensated,
            still,
            plane,
            worst,
            along,
            by_unit,
            shares,
            variance,
        });
        backend.run(ShareBacklash {
            model,
            parts,
            gaps,
            along,
            shares,
            variance,
        });
        if !inputs.is_none() {
            backend.run(AddInputs::<f64, MOMENTS> {
                model,
                inputs,
                frames,
                parts,
                curved,
                compensated,
                response,
                worst,
                along,
                variance,
            });
        }
        backend.run(TakeRoot { of: variance });
    }
}

fn have_moments(cases: &[Wrench]) -> bool {
    cases.iter().any(|wrench| wrench.moment != Vector3::zeros())
}
