//! Correct tables, and all ways in which they can be wrong.

use super::*;

fn steps(text: &str) -> Result<(Summary, Vec<Step>), Problems> {
    let mut steps = Vec::new();
    let summary = read("path.csv", text.as_bytes(), &mut |step| steps.push(step))?;
    Ok((summary, steps))
}

fn moves(text: &str) -> Vec<Move> {
    let (_, steps) = steps(text).unwrap_or_else(|problems| panic!("{problems}"));
    let moves = steps.into_iter().filter_map(|step| match step {
        Step::Move(next) => Some(next),
        Step::Operation(_) | Step::Command(_) => None,
    });
    moves.collect()
}

fn operations(text: &str) -> Vec<Operation> {
    let (_, steps) = steps(text).unwrap_or_else(|problems| panic!("{problems}"));
    let operations = steps.into_iter().filter_map(|step| match step {
        Step::Operation(operation) => Some(operation),
        Step::Move(_) | Step::Command(_) => None,
    });
    operations.collect()
}

fn problems(text: &str) -> String {
    steps(text).unwrap_err().to_string()
}

#[test]
fn the_same_path_in_other_units_and_separators_is_the_same() {
    let first = moves("x_mm,y_mm,z_mm,feed_mm_per_min\n25.4,0,-50.8,600\n0,12.7,0,1524\n");
    for text in [
        "x_m,y_m,z_m,feed_m_per_s\n0.0254,0,-0.0508,0.01\n0,0.0127,0,0.0254\n",
        "x_in;y_in;z_in;feed_mm_per_s\n1;0;-2;10\n0;0,5;0;25,4\n",
        "\u{feff}# my path\r\n\r\nX_IN\tY_in\tz_mm\tfeed_in_per_min\r\n1\t0\t-50,8\t23,62204724409449\r\n\t\t\t\r\n0\t0.5\t0\t60\r\n",
    ] {
        for (a, b) in first.iter().zip(moves(text)) {
            // Rounding of numbers below 1.
            assert!((a.end - b.end).norm() < 1e-15, "{text}");
            let (Pace::Feed(a), Pace::Feed(b)) = (a.pace, b.pace) else {
                panic!("{text}")
            };
            assert!((a - b).abs() < 1e-15, "{text}");
        }
        assert_eq!(moves(text).len(), 2);
    }
}

#[test]
fn rapids_and_missing_axes_and_feeds_are_distinguished() {
    let text = "x_mm,y_mm,z_mm,i,j,k,feed_mm_per_min,rapid,note\n0,0,5,0,0,1,,1,here\n0,0,0,,,,60,0,\n1,0,0,0,0.6,0.8,,,\n";
    let found = moves(text);
    assert_eq!(found[0].pace, Pace::Rapid);
    assert_eq!(found[1].pace, Pace::Feed(0.001));
    assert_eq!(found[2].pace, Pace::Unknown);
    assert_eq!(found[0].axis, Some(Vector3::z_axis()));
    assert_eq!(found[1].axis, None);
    assert!((found[2].axis.unwrap().into_inner() - Vector3::new(0.0, 0.6, 0.8)).norm() < 1e-15);
    assert_eq!(found.iter().map(|m| m.line).collect::<Vec<_>>(), [2, 3, 4]);
}

#[test]
fn an_operation_begins_where_name_speed_or_engagement_change() {
    let text = "x_mm,y_mm,z_mm,op,spindle_rpm,axial_depth_mm,radial_depth_mm\n0,0,0,rough,6000,2,5\n1,0,0,,6000,2,5\n\
                2,0,0,,6000,2,4\n3,0,0,finish,9000,0.5,0\n4,0,0,,,,\n";
    let found = operations(text);
    assert_eq!(found.iter().map(|o| o.line).collect::<Vec<_>>(), [2, 4, 5, 6]);
    let names: Vec<&str> = found.iter().filter_map(|o| o.name.as_deref()).collect();
    assert_eq!(names, ["rough", "rough", "finish", "finish"]);
    assert!((found[0].spindle.unwrap() - 200.0 * std::f64::consts::PI).abs() < 1e-9);
    let depths = |k: usize| found[k].depths.map(|d| (d.axial, d.radial));
    assert_eq!(depths(0), Some((2e-3, 5e-3)));
    assert_eq!(depths(1), Some((2e-3, 4e-3)));
    assert_eq!(
        (depths(3), found[3].spindle),
        (None, None),
        "missing values are not carried over"
    );
}

#[test]
fn columns_without_unit_unknown_and_duplicate_columns_are_reported_with_a_suggestion() {
    for (header, part) in [
        ("x,y_mm,z_mm", "1:1: column `x` without unit"),
        (
            "x,y_mm,z_mm",
            "lengths carry their unit: write `x_mm`, `x_m` or `x_in`",
        ),
        ("x_mm,y_mm,z_mm,feed", "write `feed_mm_per_min`"),
        ("x_mm,y_mm,z_mm,spindle", "write `spindle_rpm`"),
        ("x_mm,y_mm,z_mm,colour", "1:16: unknown column `colour`"),
        ("x_cm,y_mm,z_mm", "unknown column `x_cm`"),
        ("x_mm,y_mm,z_mm,x_in", "`x_in` repeats `x_mm`"),
        ("x_mm,y_mm,z_mm,i,i", "`i` repeats `i`"),
        ("x_mm,z_mm", "missing columns: `y_mm`"),
        ("x_mm,y_mm,z_mm,i,k", "missing columns: `j`"),
        (
            "x_mm,y_mm,z_mm,axial_depth_mm",
            "missing columns: `radial_depth_mm`",
        ),
        ("1.0,2.0,3.0", "`1.0` is not a column name"),
    ] {
        let given = problems(&format!("{header}\n1,2,3\n"));
        assert!(given.contains(part), "{header}: {given}");
        assert!(given.contains("help: "), "{given}");
    }
}

#[test]
fn wrong_cells_are_reported_with_line_and_column() {
    let head = "x_mm,y_mm,z_mm,i,j,k,feed_mm_per_min,rapid,axial_depth_mm,radial_depth_mm\n";
    for (row, part) in [
        ("1,2 mm,3,,,,,,,", "2:3: `2 mm` is not a number"),
        ("1,2,1e10,,,,,,,", "is not a number from -1e9 to 1e9"),
        ("1,2,inf,,,,,,,", "is not a number from"),
        ("1,,3,,,,,,,", "a point without one of its coordinates"),
        ("1,2,3,1,,,,,,", "a direction of less than three numbers"),
        ("1,2,3,1,1,1,,,,", "has a length of 1.7321"),
        ("1,2,3,,,,0,,,", "`0` is not above 0"),
        ("1,2,3,,,,,maybe,,", "`maybe` is neither yes nor no"),
        ("1,2,3,,,,,,-1,1", "`-1` is below 0"),
        ("1,2,3,,,,,,1,", "one depth without the other"),
        ("1,5,2,3,,,,,,,", "11 cells, but the table has 10 columns"),
        ("1,5,2,3,,,,,,,", "separate cells with `;`"),
    ] {
        let given = problems(&format!("{head}{row}\n"));
        assert!(given.contains(part), "{row}: {given}");
    }
    assert!(problems("").contains("the file has no point"));
    assert!(problems("x_mm,y_mm,z_mm\n").contains("the file has no point"));
}

#[test]
fn no_text_causes_a_panic() {
    for text in [
        "\"",
        ",",
        ";",
        ";;;\n1",
        "x_mm;y_mm;z_mm\n\"1;2;3\n",
        "x_mm,y_mm,z_mm\n\u{fffd},\u{e4},3\n",
    ] {
        assert!(steps(text).is_err(), "{text}");
    }
}

#[test]
fn spin_is_read_in_degrees_or_radians_and_an_empty_cell_gives_none() {
    let found = moves("x_mm,y_mm,z_mm,spin_deg\n0,0,0,-90\n1,0,0,\n");
    assert_eq!(
        [found[0].spin, found[1].spin],
        [Some(GivenSpin::Angle(-std::f64::consts::FRAC_PI_2)), None]
    );
    let found = moves("x_mm,y_mm,z_mm,spin_rad\n0,0,0,0.25\n");
    assert_eq!(found[0].spin, Some(GivenSpin::Angle(0.25)));
    let wrong = problems("x_mm,y_mm,z_mm,spin\n0,0,0,1\n");
    assert!(
        wrong.contains("without unit") && wrong.contains("`spin_deg`"),
        "{wrong}"
    );
    let twice = problems("x_mm,y_mm,z_mm,spin_deg,spin_rad\n0,0,0,1,1\n");
    assert!(twice.contains("`spin_rad` repeats `spin_deg`"), "{twice}");
}
