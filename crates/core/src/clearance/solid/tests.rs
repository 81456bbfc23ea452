use super::*;
use crate::clearance::{Bounds, Capsule, Role, Segment};
use crate::frame::Isometry;

fn body(attachment: Attachment, shape: Shape) -> ArmBody {
    ArmBody {
        name: "body".to_owned(),
        attachment,
        attachment_from_body: Isometry::identity(),
        shape,
        role: Role::Link,
    }
}

fn capsule(from: [f64; 3], to: [f64; 3], radius: f64) -> Shape {
    Shape::Capsule(Capsule {
        axis: Segment {
            from: from.into(),
            to: to.into(),
        },
        radius,
    })
}

fn cuboid(least: [f64; 3], greatest: [f64; 3]) -> Shape {
    Shape::Box(Bounds {
        least: least.into(),
        greatest: greatest.into(),
    })
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!(
        (value / expected - 1.0).abs() < relative,
        "{value} is not {expected}"
    );
}

#[test]
fn a_box_has_the_inertia_of_a_textbook() {
    // m/12 (b^2 + c^2), centre in the middle.
    let shape = cuboid([0.1, -0.2, 0.3], [0.5, 0.2, 0.4]);
    let masses = estimated_masses(&[body(Attachment::Joint(0), shape)], 12.0, &[]).unwrap();
    let [mass] = masses.as_slice() else { panic!() };
    close(mass.mass, 12.0, 1e-12);
    assert!((mass.centre - Point3::new(0.3, 0.0, 0.35)).norm() < 1e-9);
    let inertia = mass.inertia.unwrap();
    close(inertia[(0, 0)], 0.4 * 0.4 + 0.1 * 0.1, 1e-9);
    close(inertia[(2, 2)], 0.4 * 0.4 + 0.4 * 0.4, 1e-9);
    assert!(inertia[(0, 1)].abs() < 1e-9);
    assert_eq!(mass.relative_uncertainty, LINK_UNCERTAINTY);
}

#[test]
fn a_ball_and_a_capsule_have_the_inertia_of_a_textbook() {
    let (r, length) = (0.2, 0.6);
    let ball = body(Attachment::Joint(0), capsule([0.0; 3], [0.0; 3], r));
    let solid = solid_of(&[&ball]).unwrap();
    let ball_volume = std::f64::consts::PI * r.powi(3) * 4.0 / 3.0;
    close(solid.volume, ball_volume, 2e-2);
    close(solid.inertia_of_unit_mass[(1, 1)], 0.4 * r * r, 2e-2);

    let long = body(Attachment::Joint(0), capsule([0.0; 3], [0.0, 0.0, length], r));
    let solid = solid_of(&[&long]).unwrap();
    let cylinder_volume = std::f64::consts::PI * r * r * length;
    close(solid.volume, ball_volume + cylinder_volume, 2e-2);
    close(solid.centre.z, length / 2.0, 2e-2);
    // About its axis: cylinder r^2/2, ball 2/5 r^2, by volume.
    let axial = (cylinder_volume * 0.5 + ball_volume * 0.4) * r * r / (ball_volume + cylinder_volume);
    close(solid.inertia_of_unit_mass[(2, 2)], axial, 2e-2);
}

#[test]
fn what_two_bodies_share_is_included_once() {
    let half = |from: f64, to: f64| body(Attachment::Joint(1), cuboid([from, 0.0, 0.0], [to, 0.1, 0.1]));
    let (left, right) = (half(0.0, 0.4), half(0.2, 0.6));
    let solid = solid_of(&[&left, &right]).unwrap();
    close(solid.volume, 0.6 * 0.1 * 0.1, 1e-9);
    close(solid.centre.x, 0.3, 1e-6);
}

#[test]
fn the_total_is_distributed_by_volume_over_the_links_without_a_mass() {
    let of = |attachment, edge: f64| body(attachment, cuboid([0.0; 3], [edge, edge, edge]));
    let bodies = [
        of(Attachment::Base, 0.2),
        of(Attachment::Joint(0), 0.4),
        of(Attachment::Joint(1), 0.2),
        of(Attachment::Flange, 5.0),
    ];
    let given = |attachment, mass| Mass {
        attachment,
        mass,
        centre: Point3::origin(),
        inertia: None,
        relative_uncertainty: 0.0,
    };
    // 10 kg are given at joint 2, a tool does not count: 90 kg for 0.008 and 0.064 m^3.
    let known = [given(Attachment::Joint(1), 10.0), given(Attachment::Tool, 30.0)];
    let masses = estimated_masses(&bodies, 100.0, &known).unwrap();
    let found: Vec<_> = masses.iter().map(|mass| mass.attachment).collect();
    assert_eq!(found, [Attachment::Base, Attachment::Joint(0)]);
    close(masses[0].mass, 10.0, 1e-9);
    close(masses[1].mass, 80.0, 1e-9);

    let too_much = [given(Attachment::Joint(1), 100.0)];
    assert_eq!(
        estimated_masses(&bodies, 100.0, &too_much),
        Err(EstimateError::NothingLeft { given: 100.0 })
    );
    assert_eq!(
        estimated_masses(&bodies[3..], 100.0, &[]),
        Err(EstimateError::WithoutBodies)
    );
}
