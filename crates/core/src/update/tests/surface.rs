//! The surface that a tool has left: known along its normal alone.

use super::*;

/// Three surfaces that the tool leaves at each of `points`, measured in the frame of the part: along the surface the position is that of another point, millimetres away.
pub(super) fn measured(hidden: &Hidden, points: &[WorkPoint], u: f64) -> Campaign {
    let mut next = arms::Stream(79);
    let frame = Isometry::new(Vector3::new(0.4, -0.2, 0.1), Vector3::new(0.3, -0.1, 1.2));
    let (mut poses, mut conditions, mut normals) = (Vec::new(), Vec::new(), Vec::new());
    for point in points {
        let tip = (frame * Point3::from(hidden.tip(&point.joints, &point.condition))).coords;
        for axis in Axis::ALL {
            let normal = frame.rotation * (axis.unit() + next.vector(0.3)).normalize();
            let away = next.vector(0.002);
            let position = tip + away - normal * normal.dot(&away) + normal * (u * next.normal());
            poses.push(MeasuredPose {
                joints: point.joints.clone(),
                position,
                rotation: None,
            });
            conditions.push(point.condition.clone());
            normals.push(normal);
        }
    }
    Campaign::Positions(Positions {
        poses,
        conditions,
        flange_from_point: tool(),
        point: Known::Exactly,
        standard_uncertainty: u,
        turn_length: 1.0,
        observed: Observed::AlongNormals(normals),
    })
}

#[test]
fn surfaces_of_a_part_determine_an_arm_as_its_features_do() {
    let hidden = Hidden::new();
    let robot = &hidden.nominal;
    let known = prior(robot, &FACTORS, true);
    let (cut, held_out) = (work(&hidden, 20, 1), work(&hidden, 60, 900));
    let of = |campaign: Campaign| {
        let found = update(robot, &known, &[campaign]).unwrap();
        error(&hidden, &held_out, (&found.knowledge, &found.covariance))
    };
    let [by_features, uncertainty] = of(part(&hidden, &cut, 5e-6));
    let [by_surfaces, of_surfaces] = of(measured(&hidden, &cut, 5e-6));
    let before = error(&hidden, &held_out, (&known, &work::independent(&known)))[0];
    // Three surfaces say what three coordinates say, wherever along them they were measured.
    assert!(by_surfaces < 0.01 * before, "{by_surfaces} {before}");
    assert!(
        (0.5..2.0).contains(&(of_surfaces / uncertainty)),
        "{of_surfaces} {uncertainty}"
    );
    assert!(
        (0.4..2.0).contains(&(by_surfaces / of_surfaces)),
        "{by_surfaces} {of_surfaces}"
    );
    assert!(
        (0.3..3.0).contains(&(by_surfaces / by_features)),
        "{by_surfaces} {by_features}"
    );
}

#[test]
fn surfaces_with_other_normals_than_positions_are_refused() {
    let hidden = Hidden::new();
    let known = prior(&hidden.nominal, &FACTORS, true);
    let changed = |change: &dyn Fn(&mut Vec<Vector3<f64>>)| {
        let mut campaign = measured(&hidden, &work(&hidden, 5, 1), 5e-6);
        if let Campaign::Positions(Positions {
            observed: Observed::AlongNormals(normals),
            ..
        }) = &mut campaign
        {
            change(normals);
        }
        update(&hidden.nominal, &known, &[campaign])
            .map(|_| ())
            .unwrap_err()
            .to_string()
    };
    let fewer = changed(&|normals| normals.truncate(normals.len() - 1));
    assert!(fewer.contains("number of normals"), "{fewer}");
    let longer = changed(&|normals| normals[2] *= 1.5);
    assert!(longer.contains("not a unit vector"), "{longer}");
}
