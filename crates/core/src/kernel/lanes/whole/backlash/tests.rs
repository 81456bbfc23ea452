use super::super::model::GapConstants;
use super::*;
use crate::arms;
use crate::robot::{Attachment, JointCompliance, Spring};
use crate::source::backlash::farthest;
use crate::source::{Arm, StiffnessModel};
use nalgebra::Vector2;

/// Witness: the plain row, for whole numbers: many halves are parallel, equal, or zero, and all sums are exact.
#[test]
fn the_chosen_sides_are_those_of_the_plain_row() {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let mut springy = StiffnessModel::DRIVES.clone();
    let c = JointCompliance {
        value: 1e-7,
        standard_uncertainty: 0.0,
    };
    springy.structure.springs = vec![Spring::about(Attachment::Base, Vector3::y(), c); 2];
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model: &springy,
        flange_from_tool: &tool,
    };
    let mut model = ModelConstants::of(&arm, true).unwrap();
    let frames = vec![FramePlanes::unknown(); 9];
    let plane = [Vector3::x(), Vector3::y(), Vector3::z()];
    let case = CaseOnPlane {
        case: 0,
        wrench: &Wrench::ZERO,
        plane: &plane,
    };
    let mut stream = arms::Stream(3);
    let mut whole = |most: f64| {
        let v = stream.vector(most);
        Vector2::new(v.x.round(), v.y.round())
    };
    for (backend, count) in Backend::available()
        .into_iter()
        .flat_map(|backend| [1, 3, 6, 8].map(|count| (backend, count)))
    {
        let gap = |part| GapConstants {
            part,
            half: 1.0,
            relative: 0.0,
            by_torque: false,
        };
        model.backlash = (0..count).map(gap).collect();
        let mut parts = vec![PartPlanes::unknown(); 8];
        let mut gaps = gaps_of(&model);
        let mut deviation: Planes<f64, 3> = planes();
        let mut halves = vec![vec![Vector2::zeros(); count]; BLOCK];
        let mut from = vec![Vector2::zeros(); BLOCK];
        for i in 0..BLOCK {
            for (part, half) in parts.iter_mut().zip(&mut halves[i]) {
                *half = whole(2.4);
                (part.linear[0][i], part.linear[1][i]) = (half.x, half.y);
            }
            from[i] = whole(9.0) / 4.0;
            (deviation[0][i], deviation[1][i]) = (from[i].x, from[i].y);
        }
        let arm = Worn {
            model: &model,
            frames: &frames,
            parts: &parts,
            gaps: &mut gaps,
        };
        settle::<true>(backend, arm, case, &mut deviation);
        for i in 0..BLOCK {
            let mut signs = vec![0.0; count];
            farthest(from[i], &halves[i], &mut signs);
            let found: Vec<f64> = gaps.iter().take(count).map(|gap| gap.offset[i]).collect();
            assert_eq!(found, signs, "{backend} {:?} {:?}", from[i], halves[i]);
            let sum: Vector2<f64> = halves[i]
                .iter()
                .zip(&signs)
                .map(|(half, sign)| half * *sign)
                .sum();
            let far = Vector2::new(deviation[0][i], deviation[1][i]);
            assert_eq!(far, from[i] + sum);
        }
    }
}
