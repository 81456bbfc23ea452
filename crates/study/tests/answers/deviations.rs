//! Deviations, their contributions and their uncertainty for changes of load, compliance and uncertainty.

use crate::{PLATE, answered, plate_with, study};

#[test]
fn uncertainty_of_load_and_tool_only_increases_the_uncertainty() {
    let exact = answered(&plate_with(""));
    for (table, key) in [
        (
            "tool = { flange_from_tool_mm_deg = [0, 0, 0, 0, 0, 0], length_u_mm = 2 }\n",
            "length",
        ),
        ("load.u_percent = 10\n", "percent"),
        ("load.u_n = [1, 1, 1]\n", "components"),
    ] {
        let text = match table.strip_prefix("load.") {
            Some(more) => PLATE.replace("5, 5]] }", &format!("5, 5]], {} }}", more.trim())),
            None => format!("{PLATE}{table}"),
        };
        let uncertain = answered(&study(&text));
        let (a, b) = (&exact.maps[0].grid, &uncertain.maps[0].grid);
        assert_eq!(
            uncertain.maps[0].fraction_within, exact.maps[0].fraction_within,
            "{key}"
        );
        for (exact, uncertain) in a.in_plane_u_um.iter().zip(&b.in_plane_u_um) {
            assert!(uncertain > exact, "{key}: {uncertain:?} against {exact:?}");
        }
        for (exact, uncertain) in a.in_plane_um.iter().zip(&b.in_plane_um) {
            // Rounded to 0.1 nm.
            assert!((exact.unwrap() - uncertain.unwrap()).abs() < 2e-4, "{key}");
        }
    }
}

#[test]
fn twice_the_compliance_or_twice_the_force_deviates_twice() {
    let own = |factor: f64| {
        let values = [2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5].map(|c| format!("{:e}", c * factor));
        format!(
            "compliance = {{ rad_per_n_m = [{}], source = \"scaled\" }}\n",
            values.join(", ")
        )
    };
    let once = answered(&plate_with(&own(1.0)));
    let softer = answered(&plate_with(&own(2.0)));
    let forces = "[[analysis]]\nkind = \"map\"\nname = \"map\"\nload.cases_n = [[6, -10, -10], [6, -10, 10], [6, 10, -10], [6, 10, 10]]\n";
    let pushed = answered(&plate_with(&format!("{}{forces}", own(1.0))));
    for other in [&softer, &pushed] {
        for (a, b) in once.maps[0]
            .grid
            .in_plane_um
            .iter()
            .flatten()
            .zip(other.maps[0].grid.in_plane_um.iter().flatten())
        {
            // Both reported to 1e-4 um.
            assert!((2.0 * a - b).abs() < 2.0 * 1e-4, "{a} um and {b} um");
        }
    }
}

#[test]
fn shares_of_the_joints_add_up_to_the_worst_deviation() {
    let answer = answered(&plate_with(
        "[[analysis]]\nkind = \"map\"\n[[analysis]]\nkind = \"path\"\ncircle.radius_mm = 100\n",
    ));
    for worst in [
        answer.maps[0].worst.as_ref().unwrap(),
        answer.paths[0].worst.as_ref().unwrap(),
    ] {
        let sum: f64 = worst.joint_share_um.iter().sum();
        // Six numbers of 1e2 um.
        assert!(
            (sum - worst.in_plane_um).abs() < 1e-10,
            "{sum} um of {} um",
            worst.in_plane_um
        );
    }
}
