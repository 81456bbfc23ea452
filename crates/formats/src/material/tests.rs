use super::*;

const SMALL: &str = r#"
format = 1
name = "cheese"
[[mechanistic]]
tool = "wire"
source = "made-up"
ktc_n_per_mm2 = 100
krc_n_per_mm2 = 40
kac_n_per_mm2 = 10
kte_n_per_mm = 2
kre_n_per_mm = 1
kae_n_per_mm = 0.5
[[mechanistic]]
tool = "knife"
source = "made-up"
ktc_n_per_mm2 = 140
krc_n_per_mm2 = 60
kac_n_per_mm2 = 10
kte_n_per_mm = 4
kre_n_per_mm = 1
kae_n_per_mm = 0.5
[[mechanistic]]
tool = "spoon"
source = "made-up"
ktc_n_per_mm2 = 9999
[[kienzle]]
source = "made-up"
group = 22
kc1_n_per_mm2 = 800
mc_exponent = 0.25
[sources.made-up]
what = "nothing real"
where = "this test"
licence = "none"
"#;

fn problems_of(from: &str, to: &str) -> String {
    assert!(SMALL.contains(from), "the sample has no `{from}`");
    read("cheese.toml", &SMALL.replacen(from, to, 1))
        .unwrap_err()
        .to_string()
}

#[test]
fn coefficients_arrive_in_si() {
    let cheese = read("cheese.toml", SMALL).unwrap();
    let [ktc, _, _, kte, ..] = cheese.mechanistic[0].coefficients;
    assert_eq!((ktc, kte), (Some(100e6), Some(2e3)));
    assert_eq!(cheese.mechanistic[2].coefficients[3], None);
    assert_eq!(cheese.kienzle[0].specific_force, 800e6);
    assert_eq!(cheese.sources[0].place, "this test");
}

#[test]
fn whole_sets_are_accepted_and_incomplete_ones_are_refused() {
    let together = read("cheese.toml", SMALL).unwrap().mechanistic().unwrap();
    assert_eq!(together.sets, 2);
    assert_eq!(
        (together.mean[0], together.mean[1], together.mean[3]),
        (120e6, 50e6, 3e3)
    );
    let one = SMALL.replace("ktc_n_per_mm2 = 140\n", "");
    let together = read("cheese.toml", &one).unwrap().mechanistic().unwrap();
    assert_eq!((together.sets, together.covariance), (1, None));
    let none = one.replace("kae_n_per_mm = 0.5\n", "");
    assert!(read("cheese.toml", &none).unwrap().mechanistic().is_none());
}

#[test]
fn kienzle_values_of_several_sets_scatter() {
    let one = read("cheese.toml", SMALL).unwrap().kienzle().unwrap();
    assert_eq!((one.sets, one.mean[0], one.covariance), (1, 800e6, None));
    let second = "[[kienzle]]\nsource = \"made-up\"\nkc1_n_per_mm2 = 600\nmc_exponent = 0.25\n[sources";
    let two = read("cheese.toml", &SMALL.replacen("[sources", second, 1)).unwrap();
    let two = two.kienzle().unwrap();
    assert_eq!((two.sets, two.mean[0]), (2, 700e6));
    let covariance = two.covariance.unwrap();
    assert!((covariance[(0, 0)].sqrt() - 100e6 * 2_f64.sqrt()).abs() < 1.0);
    assert_eq!(covariance[(1, 1)], 0.0);
}

#[test]
fn a_field_that_is_not_known_is_reported_with_its_unit() {
    let text = problems_of("kte_n_per_mm = 2\n", "kte = 2\n");
    assert!(
        text.contains("cheese.toml:10:1: unknown field `mechanistic[0].kte`"),
        "{text}"
    );
    assert!(text.contains("`kte_n_per_mm`"), "{text}");
}

#[test]
fn every_problem_is_reported_at_once() {
    let broken = SMALL
        .replacen("source = \"made-up\"", "source = \"hearsay\"", 1)
        .replace("ktc_n_per_mm2 = 9999\n", "")
        .replace(
            "[sources.made-up]",
            "[sources.lost]\nwhat=\"\"\nwhere=\"\"\nlicence=\"\"\n[sources.made-up]",
        );
    let text = read("cheese.toml", &broken).unwrap_err().to_string();
    for part in [
        "source `hearsay` is not among the sources",
        "the set has no coefficient",
        "source `lost` is used by no number",
    ] {
        assert!(text.contains(part), "no `{part}` in:\n{text}");
    }
}

#[test]
fn numbers_that_no_material_has_are_refused() {
    for (from, to) in [
        ("kc1_n_per_mm2 = 800", "kc1_n_per_mm2 = 0"),
        ("mc_exponent = 0.25", "mc_exponent = 1.5"),
        ("ktc_n_per_mm2 = 100", "ktc_n_per_mm2 = nan"),
        ("ktc_n_per_mm2 = 100", "ktc_n_per_mm2 = 1e9"),
        ("group = 22", "group = 42"),
        ("format = 1", "format = 2"),
    ] {
        assert!(problems_of(from, to).contains("cheese.toml:"), "{to}");
    }
}

#[test]
fn a_material_without_a_force_is_refused() {
    let text = "format = 1\nname = \"air\"\n[sources]\n";
    let problems = read("air.toml", text).unwrap_err().to_string();
    assert!(
        problems.contains("the material has no cutting force"),
        "{problems}"
    );
}

#[test]
fn invalid_toml_is_reported_with_its_line() {
    let problems = read("air.toml", "format = 1\nname = air\n")
        .unwrap_err()
        .to_string();
    assert!(problems.contains("air.toml:2:"), "{problems}");
}
