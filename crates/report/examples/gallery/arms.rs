//! A made-up arm of six joints, solved by hand for a wrist that keeps its direction.

use armill_report::{ArmDrawing, ArmJoint, ArmPosture, BodyKind, CellBody, CellView, NearestPair, View};

type Vec3 = [f64; 3];

/// The arm with its tool at `tip`, tool along +x: shoulder 150 mm off the column at 505 mm, upper arm 760 mm, forearm 795 mm.
fn posture(tip: Vec3) -> ArmPosture {
    let (flange, wrist) = ([tip[0] - 210.0, tip[1], tip[2]], [tip[0] - 315.0, tip[1], tip[2]]);
    let turn = wrist[1].atan2(wrist[0]);
    let radial = wrist[0].hypot(wrist[1]) - 150.0;
    let rise = wrist[2] - 505.0;
    let (upper, fore) = (760.0_f64, 795.0_f64);
    let reach = radial.hypot(rise).min(upper + fore - 1.0);
    let lift =
        rise.atan2(radial) + ((upper.powi(2) + reach.powi(2) - fore.powi(2)) / (2.0 * upper * reach)).acos();
    let in_plane = |r: f64, z: f64| [r * turn.cos(), r * turn.sin(), z];
    let shoulder = in_plane(150.0, 505.0);
    let elbow = in_plane(150.0 + upper * lift.cos(), 505.0 + upper * lift.sin());
    let along: Vec3 = [wrist[0] - elbow[0], wrist[1] - elbow[1], wrist[2] - elbow[2]];
    let across = [-turn.sin(), turn.cos(), 0.0];
    let joint = |name: &str, origin_mm: Vec3, axis: Vec3| ArmJoint {
        name: name.into(),
        origin_mm,
        axis,
    };
    ArmPosture {
        base_mm: [0.0; 3],
        joints: vec![
            joint("S", [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
            joint("L", shoulder, across),
            joint("U", elbow, across),
            joint("R", wrist, along),
            joint("B", wrist, [0.0, 1.0, 0.0]),
            joint("T", wrist, [1.0, 0.0, 0.0]),
        ],
        flange_mm: flange,
        tool_mm: tip,
    }
}

fn on_circle(angle_deg: f64) -> Vec3 {
    let (s, c) = angle_deg.to_radians().sin_cos();
    [1150.0, 250.0 * c, 750.0 + 250.0 * s]
}

/// Name and SVG of each picture.
pub fn pictures() -> Vec<(&'static str, String)> {
    let drawing = ArmDrawing {
        title: "The arm at the plate, tool along +x".into(),
        subtitle: "Circle of 500 mm on a vertical plate at x = 1150 mm; three more postures on the circle"
            .into(),
        posture: posture(on_circle(100.0)),
        ghosts: [0.0, 200.0, 280.0].map(|a| posture(on_circle(a))).into(),
        plate_mm: Some([
            [1150.0, -400.0, 350.0],
            [1150.0, 400.0, 350.0],
            [1150.0, 400.0, 1150.0],
            [1150.0, -400.0, 1150.0],
        ]),
        path_mm: (0..=72).map(|k| on_circle(f64::from(k) * 5.0)).collect(),
        view: View::Iso,
        standing_tool_mm: None,
    };
    let plain = ArmDrawing {
        ghosts: Vec::new(),
        title: "One posture".into(),
        ..drawing.clone()
    };
    let body = |kind: BodyKind, points_mm: &[[f64; 3]], radius_mm: f64| CellBody {
        kind,
        points_mm: points_mm.to_vec(),
        radius_mm,
    };
    let cell = CellView {
        title: "A spindle next to a fence".into(),
        subtitle: "Capsules around the links; a box of 100 mm x 800 mm as fence".into(),
        bodies: vec![
            body(BodyKind::Link, &[[0.0, 0.0, 150.0], [0.0, 0.0, 400.0]], 180.0),
            body(
                BodyKind::Link,
                &[[150.0, 0.0, 505.0], [300.0, 0.0, 1250.0]],
                110.0,
            ),
            body(
                BodyKind::Link,
                &[[300.0, 0.0, 1250.0], [900.0, 0.0, 1100.0]],
                90.0,
            ),
            body(BodyKind::Tool, &[[950.0, 0.0, 1080.0], [950.0, 0.0, 850.0]], 60.0),
            body(BodyKind::Cutter, &[[950.0, 0.0, 850.0], [950.0, 0.0, 760.0]], 6.0),
            body(
                BodyKind::Obstacle,
                &[
                    [1100.0, -400.0, 0.0],
                    [1200.0, -400.0, 0.0],
                    [1100.0, 400.0, 1500.0],
                    [1200.0, 400.0, 1500.0],
                ],
                0.0,
            ),
        ],
        line_mm: vec![
            [0.0; 3],
            [150.0, 0.0, 505.0],
            [300.0, 0.0, 1250.0],
            [950.0, 0.0, 1080.0],
        ],
        floor_mm: Some([
            [-2000.0, -2000.0, 0.0],
            [2000.0, -2000.0, 0.0],
            [2000.0, 2000.0, 0.0],
            [-2000.0, 2000.0, 0.0],
        ]),
        nearest: Some(NearestPair {
            points_mm: [[1010.0, 0.0, 1000.0], [1100.0, 0.0, 1000.0]],
            label: "90.0 mm".into(),
        }),
    };
    vec![
        ("cell_view", cell.to_svg()),
        ("arm_iso", drawing.to_svg()),
        (
            "arm_side",
            ArmDrawing {
                view: View::Side,
                ..plain.clone()
            }
            .to_svg(),
        ),
        (
            "arm_views",
            plain.to_svg_views(&[View::Iso, View::Side, View::Front, View::Top]),
        ),
    ]
}
