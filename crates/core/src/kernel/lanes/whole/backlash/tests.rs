use super::*;
use crate::arms;
use crate::robot::{Backlash, BacklashSide};
use crate::source::backlash::farthest;
use crate::source::{Arm, StiffnessModel};
use nalgebra::Vector2;

/// Witness: the plain row, for whole numbers: many halves are parallel, equal, or zero, and all sums are exact.
#[test]
fn the_chosen_sides_are_those_of_the_plain_row() {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let mut worn = StiffnessModel::DRIVES.clone();
    let gap = Backlash {
        gap: 2.0,
        standard_uncertainty: 0.0,
        side: BacklashSide::Motion,
    };
    worn.structure.backlash = vec![Some(gap); 6];
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model: &worn,
        flange_from_tool: &tool,
    };
    let model = ModelConstants::of(&arm, true).unwrap();
    let mut stream = arms::Stream(3);
    for backend in Backend::available() {
        let mut parts = vec![PartPlanes::unknown(); 6];
        let frames = vec![FramePlanes::unknown(); 9];
        let mut gaps = vec![GapPlanes::unknown(); 6];
        let mut deviation: Planes<f64, 3> = planes();
        let whole = |stream: &mut arms::Stream, most: f64| {
            let v = stream.vector(most);
            Vector2::new(v.x.round(), v.y.round())
        };
        let mut halves = vec![[Vector2::zeros(); 6]; BLOCK];
        let mut from = vec![Vector2::zeros(); BLOCK];
        for i in 0..BLOCK {
            for (gap, half) in model.backlash.iter().zip(&mut halves[i]) {
                *half = whole(&mut stream, 2.4);
                let part = &mut parts[gap.part];
                (part.linear[0][i], part.linear[1][i]) = (half.x, half.y);
            }
            from[i] = whole(&mut stream, 9.0) / 4.0;
            (deviation[0][i], deviation[1][i]) = (from[i].x, from[i].y);
        }
        let plane = [Vector3::x(), Vector3::y(), Vector3::z()];
        let case = (0, &Wrench::ZERO);
        settle(
            backend,
            &model,
            (&frames, &parts),
            case,
            &plane,
            &mut gaps,
            &mut deviation,
        );
        for i in 0..BLOCK {
            let mut signs = [0.0; 6];
            farthest(from[i], &halves[i], &mut signs);
            let found: Vec<f64> = gaps.iter().map(|gap| gap.offset[i]).collect();
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
