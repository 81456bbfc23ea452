use super::*;

const HEAD: &str = "format = 1\nname = \"end mill\"\nsource = \"drawing\"\n";

fn read_segments(segments: &str) -> Result<ToolAssembly, Problems> {
    read("tool.toml", &format!("{HEAD}{segments}"))
}

fn problems(segments: &str) -> String {
    read_segments(segments).unwrap_err().to_string()
}

#[test]
fn values_are_converted_to_si() {
    let found = read_segments(
        "beam = \"euler\"\n[spindle]\nmass_kg = 8\ncentre_mm = [0, 0, -120]\ninertia_kg_m2 = [0.1, 0.1, 0.02]\n\
         [[segment]]\nname = \"holder\"\nlength_mm = 60\ndiameter_mm = 40\nbore_mm = 12\nmaterial = \"steel\"\nloss_factor = 0.01\n\
         joint = { lateral_n_per_um = 80, axial_n_per_um = 300, bending_n_m_per_rad = 4e5, lateral_damping_n_s_per_m = 50, loss_factor = 0.02 }\n\
         [[segment]]\nlength_mm = 25\ndiameter_mm = 12\nfluted = true\nmodulus_gpa = 600\ndensity_kg_per_m3 = 14500\npoisson_ratio = 0.21\n",
    )
    .unwrap();
    let [holder, cutter] = &found.segments[..] else {
        panic!("two segments")
    };
    assert_eq!(found.names, ["holder", "2"]);
    assert!((holder.length - 0.06).abs() < 1e-15 && (holder.section.bore - 0.012).abs() < 1e-15);
    assert_eq!(holder.theory, BeamTheory::Euler);
    assert!((holder.material.modulus / 206e9 - 1.0).abs() < 1e-14 && holder.material.loss_factor == 0.01);
    let joint = holder.joint.unwrap();
    assert!((joint.lateral.stiffness.unwrap() / 8e7 - 1.0).abs() < 1e-12);
    assert!((joint.axial.stiffness.unwrap() / 3e8 - 1.0).abs() < 1e-12);
    assert_eq!(
        [joint.bending.stiffness, joint.torsion.stiffness],
        [Some(4e5), None]
    );
    assert!(joint.lateral.damping == 50.0 && joint.loss_factor == 0.02);
    // 80 % of 12 mm.
    assert!((cutter.section.outer - 9.6e-3).abs() < 1e-15);
    assert!((cutter.material.modulus / 6e11 - 1.0).abs() < 1e-14 && cutter.material.poisson == 0.21);
    let spindle = found.spindle.unwrap();
    assert!((spindle.centre.z + 0.12).abs() < 1e-15 && spindle.inertia[(2, 2)] == 0.02);
    let said = found.assumptions.join("\n");
    assert!(
        said.contains("0.0015") && said.contains("80 %") && !said.contains("rigid"),
        "{said}"
    );
}

#[test]
fn an_equivalent_diameter_replaces_that_of_the_flutes() {
    let segment = "[[segment]]\nlength_mm = 25\ndiameter_mm = 12\nmaterial = \"carbide\"\n";
    let found = read_segments(&format!(
        "{segment}fluted = true\nequivalent_diameter_mm = 9\nloss_factor = 0\n"
    ))
    .unwrap();
    assert!((found.segments[0].section.outer - 9e-3).abs() < 1e-15);
    assert_eq!(
        found.assumptions.len(),
        1,
        "rigid joints: {:?}",
        found.assumptions
    );
    let text = problems(&format!("{segment}equivalent_diameter_mm = 9\n"));
    assert!(text.contains("without flutes"), "{text}");
    let text = problems(&format!("{segment}fluted = true\nequivalent_diameter_mm = 13\n"));
    assert!(text.contains("greater than `diameter_mm`"), "{text}");
}

#[test]
fn all_problems_are_reported_together_with_their_lines() {
    let text = problems(
        "[[segment]]\nlength_mm = 25\ndiameter_mm = 12\n\
         [[segment]]\nlength_mm = 25\ndiameter_mm = 12\nbore_mm = 12\nmaterial = \"steel\"\n\
         [[segment]]\nlength_mm = 25\ndiameter_mm = 12\nmodulus_gpa = 200\n\
         [[segment]]\nlength_mm = 25\ndiameter_mm = 12\nmaterial = \"steel\"\npoisson_ratio = 0.3\n\
         [spindle]\nmass_kg = 1\ncentre_mm = [0, 0, 0]\ninertia_kg_m2 = [1, 1, 3]\n",
    );
    for expected in [
        "tool.toml:4",
        "the segment has no material",
        "`bore_mm` must be less than the outer diameter of 12 mm (got 12)",
        "`density_kg_per_m3` is missing",
        "`material` and `poisson_ratio` are both given",
        "more than the sum of the other two",
    ] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
}

#[test]
fn values_out_of_range_unknown_keys_and_no_segment_are_refused() {
    let segment =
        |line: &str| format!("[[segment]]\nlength_mm = 25\ndiameter_mm = 12\nmaterial = \"steel\"\n{line}\n");
    assert!(read_segments(&segment("")).is_ok());
    for line in [
        "thickness_mm = 1",
        "bore_mm = -1",
        "loss_factor = 2",
        "bore_mm = nan",
        "joint = { lateral_n_per_um = 0 }",
        "joint = { k = 1 }",
        "name = \"\"",
    ] {
        assert!(!problems(&segment(line)).is_empty(), "{line}");
    }
    assert!(problems(&segment("").replace("25", "0")).contains("length_mm"));
    assert!(problems(&segment("").replace("steel", "cheese")).contains("material"));
    assert!(!problems("segment = []\n").is_empty());
    assert!(!problems("").is_empty());
    assert!(read("tool.toml", "format = 1\n[[segment").is_err());
}
