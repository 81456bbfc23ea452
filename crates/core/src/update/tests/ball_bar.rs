//! Distances from a pivot as measurements of the hidden arm.

use super::*;

/// Where the pivot is; it is said to be some millimetres from there.
const PIVOT: Vector3<f64> = Vector3::new(0.75, 0.15, 0.6);

/// Distances of the tip from the pivot at `points`; readings of a bar that is not calibrated are all too long by 1 mm.
pub(super) fn readings(hidden: &Hidden, points: &[WorkPoint], u: f64, is_calibrated: bool) -> Campaign {
    let mut next = arms::Stream(79);
    let offset = if is_calibrated { 0.0 } else { 1e-3 };
    let lengths = points.iter().map(|point| {
        let tip = hidden.tip(&point.joints, &point.condition);
        (tip - PIVOT).norm() + offset + u.min(1e-3) * next.normal()
    });
    let pose = |point: &WorkPoint| MeasuredPose {
        joints: point.joints.clone(),
        position: Vector3::zeros(),
        rotation: None,
    };
    Campaign::Positions(Positions {
        observed: Observed::Distances(Distances {
            lengths: lengths.collect(),
            pivot: PIVOT + Vector3::new(0.004, -0.003, 0.005),
            is_calibrated,
        }),
        poses: points.iter().map(pose).collect(),
        conditions: points.iter().map(|point| point.condition.clone()).collect(),
        flange_from_point: tool(),
        point: Known::Approximately,
        standard_uncertainty: u,
        turn_length: 1.0,
    })
}

/// Points without load, as those of a ball-bar.
fn unloaded(hidden: &Hidden, count: usize, seed: u64) -> Vec<WorkPoint> {
    let mut points = work(hidden, count, seed);
    for point in &mut points {
        point.condition.wrench = Wrench::from_force(Vector3::zeros());
    }
    points
}

#[test]
fn distances_from_a_pivot_reduce_the_error_of_a_hidden_arm_as_their_uncertainty_says() {
    let hidden = Hidden::new();
    let robot = &hidden.nominal;
    let known = prior(robot, &FACTORS, true);
    let held_out = unloaded(&hidden, 60, 900);
    let before = error(&hidden, &held_out, (&known, &work::independent(&known)));
    let mut uncertainties = Vec::new();
    for is_calibrated in [true, false] {
        let campaign = readings(&hidden, &unloaded(&hidden, 150, 6), 2e-6, is_calibrated);
        assert_eq!(campaign.rows(), 149 + usize::from(is_calibrated));
        let found = update(robot, &known, &[campaign]).unwrap();
        let [off, u] = error(&hidden, &held_out, (&found.knowledge, &found.covariance));
        assert!(
            off < 0.3 * before[0] && (0.4..2.0).contains(&(off / u)),
            "{off} {u} {before:?}"
        );
        assert!(
            found.campaigns[0].before > 20.0 * found.campaigns[0].after,
            "{found:?}"
        );
        for estimate in &found.knowledge {
            match estimate.parameter {
                Parameter::Backlash(joint) => {
                    let off = (hidden.gaps[joint].ln() - estimate.mean) / estimate.deviation;
                    assert!(off.abs() < 4.0, "{estimate:?}");
                }
                // Without load nothing is said of compliances.
                Parameter::Drive(_) => assert!(
                    known
                        .iter()
                        .any(|one| (one.deviation / estimate.deviation - 1.0).abs() < 1e-6)
                ),
                Parameter::Geometry(_) => {}
            }
        }
        uncertainties.push(u);
    }
    // The length of the bar is worth something, at most a little.
    assert!(uncertainties[0] < uncertainties[1], "{uncertainties:?}");
}

#[test]
fn unsound_distances_are_refused() {
    let hidden = Hidden::new();
    let known = prior(&hidden.nominal, &FACTORS, true);
    let refused = |change: &dyn Fn(&mut Distances)| {
        let mut campaign = readings(&hidden, &work(&hidden, 5, 1), 1e-6, true);
        if let Campaign::Positions(Positions {
            observed: Observed::Distances(distances),
            ..
        }) = &mut campaign
        {
            change(distances);
        }
        update(&hidden.nominal, &known, &[campaign])
            .unwrap_err()
            .to_string()
    };
    assert!(refused(&|one| one.lengths.truncate(3)).contains("number of distances"));
    assert!(refused(&|one| one.lengths[2] = 0.0).contains("not above 0"));
    assert!(refused(&|one| one.pivot.x = f64::NAN).contains("not finite"));
}
