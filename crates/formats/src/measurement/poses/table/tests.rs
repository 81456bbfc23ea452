use armill_core::robot::{Amount, Axis, Joint, Motion};

use super::*;

fn lever() -> Robot {
    let motions = vec![
        Motion::About(Axis::Z, Amount::Joint(0)),
        Motion::Along(Axis::X, Amount::Joint(1)),
    ];
    Robot::new("lever", motions, ["turn", "slide"].map(Joint::plain).to_vec()).unwrap()
}

fn read_with(text: &[u8], columns: &[&str]) -> Result<MeasuredPoses, String> {
    let given = PoseReadOptions {
        columns: columns.iter().map(|mapping| mapping.parse().unwrap()).collect(),
        turns: None,
    };
    read("poses.csv", text, &lever(), &given).map_err(|problems| problems.to_string())
}

#[test]
fn the_same_poses_in_other_units_names_and_separators_are_the_same() {
    let first = read_with(b"q1_deg,q2_mm,x_mm,y_mm,z_mm\n90,100,1,2,3\n", &[]).unwrap();
    assert!((first.poses[0].joints[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert!((first.poses[0].position - Vector3::new(1e-3, 2e-3, 3e-3)).norm() < 1e-17);
    for (text, columns) in [
        (&b"# by hand\r\nstamp;Turn_rad;SLIDE_m;x_um;y_m;z_mm\r\n2,02103E+13;1,5707963267948966;0,1;1000;0,002;3\0\r\n;;;;;\r\n"[..], &[][..]),
        (b"J1_DEG\tJ2_M\tX actual\tY\tz_mm\n90\t0.1\t1\t2\t3\n", &["x_mm=X actual", "y_mm=Y"]),
    ] {
        let other = read_with(text, columns).unwrap();
        assert_eq!(other.poses.len(), 1);
        assert!((other.poses[0].position - first.poses[0].position).norm() < 1e-17);
        assert!((other.poses[0].joints[0] - first.poses[0].joints[0]).abs() < 1e-15);
        assert!((other.poses[0].joints[1] - 0.1).abs() < 1e-16);
    }
}

#[test]
fn names_directions_commanded_poses_orientations_and_ignored_columns_are_returned() {
    let text = "pose,direction,q1_deg,q2_mm,x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg,commanded_x_mm,commanded_y_mm,commanded_z_mm,std\n\
                P1,up,0,0,1,2,3,0,0,90,1,1,1,x\nP1,down,0,0,,,,,,,1,1,1,x\n";
    let found = read_with(text.as_bytes(), &[]).unwrap();
    assert_eq!((found.poses.len(), found.not_measured), (1, 1));
    assert_eq!(found.names.unwrap(), ["P1"]);
    assert_eq!(found.directions.unwrap(), ["up"]);
    assert_eq!(found.commanded.unwrap(), [[1e-3, 1e-3, 1e-3, 0.0, 0.0, 0.0]]);
    assert_eq!((found.unused, found.lines), (vec!["std".to_owned()], vec![2]));
    let turned = found.poses[0].rotation.unwrap() * Vector3::x();
    assert!((turned - Vector3::y()).norm() < 1e-15);
}

#[test]
fn each_order_of_angles_gives_a_different_rotation() {
    let angles = [0.3, -0.4, 1.2];
    let [fixed, moving] = [TurnOrder::FixedXyz, TurnOrder::MovingXyz].map(|order| order.rotation(angles));
    let x = |by: f64| UnitQuaternion::from_scaled_axis(Vector3::x() * by);
    let y = |by: f64| UnitQuaternion::from_scaled_axis(Vector3::y() * by);
    let z = |by: f64| UnitQuaternion::from_scaled_axis(Vector3::z() * by);
    assert!(fixed.angle_to(&(z(1.2) * y(-0.4) * x(0.3))) < 1e-12);
    assert!(moving.angle_to(&(x(0.3) * y(-0.4) * z(1.2))) < 1e-12);
}

#[test]
fn problems_are_reported_with_their_positions() {
    for (text, columns, part) in [
        ("", &[][..], "the file has no poses"),
        ("q1_deg,q2_mm,x_mm,y_mm,z_mm\n", &[], "the file has no poses"),
        (
            "q1_deg,x_mm,y_mm\n1,2,3\n",
            &[],
            "columns are missing: `slide_mm`, `z_mm`",
        ),
        (
            "q1_deg,q2_mm,x_mm,y_mm,z_mm,rx_deg\n",
            &[],
            "columns are missing: `ry_deg`, `rz_deg`",
        ),
        ("q1,q2_mm,x_mm,y_mm,z_mm\n", &[], "1:1: no unit is given for `q1`"),
        ("q1_mm,q2_mm,x_mm,y_mm,z_mm\n", &[], "`mm` is not a unit of `q1`"),
        (
            "q1_deg,q2_deg,x_mm,y_mm,z_mm\n",
            &[],
            "`deg` is not a unit of `q2`",
        ),
        (
            "q1_deg,turn_rad,q2_mm,x_mm,y_mm,z_mm\n",
            &[],
            "1:8: `turn_rad` repeats an earlier column",
        ),
        (
            "q1_deg,q2_mm,x_mm,y_mm,a\n",
            &["z_mm=b"],
            "no column is called `b`",
        ),
        (
            "q1_deg,q2_mm,x_mm,y_mm,a\n",
            &["zed_mm=a"],
            "`a` is mapped to `zed_mm`, which is not a known column",
        ),
        (
            "q1_deg,q2_mm,x_mm,y_mm,z_mm\n1,2,3,4\n",
            &[],
            "2:1: 4 cells, but the table has 5 columns",
        ),
        (
            "q1_deg,q2_mm,x_mm,y_mm,z_mm\n1,2,3,4,five\n",
            &[],
            "2:9: `five` is not a number",
        ),
        (
            "q1_deg,q2_mm,x_mm,y_mm,z_mm\n1,2,3,4,inf\n",
            &[],
            "`inf` is not a number",
        ),
        (
            "q1_rad,q2_mm,x_mm,y_mm,z_mm\n90,2,3,4,5\n",
            &[],
            "exceeds two turns",
        ),
        (
            "q1_deg,q2_mm,x_m,y_mm,z_mm\n90,2,30000,4,5\n",
            &[],
            "2:6: a length of 30000 m exceeds",
        ),
    ] {
        let problems = read_with(text.as_bytes(), columns).unwrap_err();
        assert!(problems.contains(part), "{text:?}: {problems}");
    }
}

#[test]
fn problems_of_all_rows_are_reported_together() {
    let text = b"q1_deg,q2_mm,x_mm,y_mm,z_mm\na,2,3,4,5\n1,b,c,4,5\n1,2,3,4,5\n";
    let problems = read_with(text, &[]).unwrap_err();
    for place in ["2:1", "3:3", "3:5"] {
        assert!(problems.contains(place), "{problems}");
    }
}

#[test]
fn mappings_need_both_names() {
    for text in ["x_mm", "=a", "x_mm=", ""] {
        assert!(text.parse::<Mapping>().is_err(), "{text:?}");
    }
}
