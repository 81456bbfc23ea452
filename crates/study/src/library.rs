//! The robot and material libraries and the example studies, embedded: every command works from an empty folder.
//!
//! The robot `yaskawa/mh12` is `robots/yaskawa/mh12.toml`, the material `brass` is `materials/brass.toml`. A file that
//! is not listed here is not in the program; `cargo xtask tidy` reports a missing one. `build.rs` of the crate
//! finds the folders.

use armill_formats::document::Problems;
use armill_formats::material::{self, Material};
use armill_formats::robot::{RobotDescription, armill};

use crate::error::StudyError;

/// A text file that travels inside the program.
#[derive(Clone, Copy, Debug)]
pub struct Embedded {
    /// What a user calls it.
    pub name: &'static str,
    /// Its path in the repository.
    pub path: &'static str,
    /// Its contents.
    pub text: &'static str,
}

/// Pairs of name and path in the repository, with the texts of the files.
macro_rules! embedded {
    ($($name:literal in $path:literal),+ $(,)?) => {
        &[$(Embedded { name: $name, path: $path, text: include_str!(concat!(env!("ARMILL_LIBRARY"), "/", $path)) }),+]
    };
}

/// Every robot of the library.
pub const ROBOTS: &[Embedded] = embedded![
    "abb/irb2400" in "robots/abb/irb2400.toml",
    "abb/irb4400l-30-243" in "robots/abb/irb4400l-30-243.toml",
    "abb/irb6600-225-255" in "robots/abb/irb6600-225-255.toml",
    "abb/irb6640-185-280" in "robots/abb/irb6640-185-280.toml",
    "fanuc/m20ia" in "robots/fanuc/m20ia.toml",
    "fanuc/m20ia-10l" in "robots/fanuc/m20ia-10l.toml",
    "fanuc/m20ib-25" in "robots/fanuc/m20ib-25.toml",
    "fanuc/m710ic-45m" in "robots/fanuc/m710ic-45m.toml",
    "fanuc/m710ic-50" in "robots/fanuc/m710ic-50.toml",
    "fanuc/r2000ic" in "robots/fanuc/r2000ic.toml",
    "kuka/kr120r2500pro" in "robots/kuka/kr120r2500pro.toml",
    "kuka/kr150-2" in "robots/kuka/kr150-2.toml",
    "kuka/kr150r3100-2" in "robots/kuka/kr150r3100-2.toml",
    "kuka/kr16-2" in "robots/kuka/kr16-2.toml",
    "kuka/kr210l150" in "robots/kuka/kr210l150.toml",
    "kuka/kr210r2700extra" in "robots/kuka/kr210r2700extra.toml",
    "kuka/kr6r700sixx" in "robots/kuka/kr6r700sixx.toml",
    "kuka/lbr-iiwa-14-r820" in "robots/kuka/lbr-iiwa-14-r820.toml",
    "staubli/rx160" in "robots/staubli/rx160.toml",
    "staubli/rx160l" in "robots/staubli/rx160l.toml",
    "staubli/tx2-90" in "robots/staubli/tx2-90.toml",
    "staubli/tx2-90l" in "robots/staubli/tx2-90l.toml",
    "staubli/tx200" in "robots/staubli/tx200.toml",
    "staubli/tx90" in "robots/staubli/tx90.toml",
    "universal-robots/ur10" in "robots/universal-robots/ur10.toml",
    "universal-robots/ur10e" in "robots/universal-robots/ur10e.toml",
    "yaskawa/es165" in "robots/yaskawa/es165.toml",
    "yaskawa/gp180-120" in "robots/yaskawa/gp180-120.toml",
    "yaskawa/gp25" in "robots/yaskawa/gp25.toml",
    "yaskawa/mh110" in "robots/yaskawa/mh110.toml",
    "yaskawa/mh12" in "robots/yaskawa/mh12.toml",
    "yaskawa/mh50" in "robots/yaskawa/mh50.toml",
];

/// Every material of the library.
pub const MATERIALS: &[Embedded] = embedded![
    "aluminium-6061-t6" in "materials/aluminium-6061-t6.toml",
    "aluminium-6082-t6" in "materials/aluminium-6082-t6.toml",
    "aluminium-7075-t6" in "materials/aluminium-7075-t6.toml",
    "aluminium-almgsi0.5" in "materials/aluminium-almgsi0.5.toml",
    "aluminium-cast-high-silicon" in "materials/aluminium-cast-high-silicon.toml",
    "aluminium-cast-low-silicon" in "materials/aluminium-cast-low-silicon.toml",
    "aluminium-cast-low-silicon-cured" in "materials/aluminium-cast-low-silicon-cured.toml",
    "aluminium-wrought" in "materials/aluminium-wrought.toml",
    "aluminium-wrought-cured" in "materials/aluminium-wrought-cured.toml",
    "aluminium-wrought-not-cured" in "materials/aluminium-wrought-not-cured.toml",
    "brass" in "materials/brass.toml",
    "cast-iron-grey" in "materials/cast-iron-grey.toml",
    "cast-iron-grey-180-hb" in "materials/cast-iron-grey-180-hb.toml",
    "cast-iron-grey-260-hb" in "materials/cast-iron-grey-260-hb.toml",
    "cast-iron-malleable-ferritic" in "materials/cast-iron-malleable-ferritic.toml",
    "cast-iron-malleable-pearlitic" in "materials/cast-iron-malleable-pearlitic.toml",
    "cast-iron-nodular-ferritic" in "materials/cast-iron-nodular-ferritic.toml",
    "cast-iron-nodular-pearlitic" in "materials/cast-iron-nodular-pearlitic.toml",
    "copper-electrolytic" in "materials/copper-electrolytic.toml",
    "copper-free-cutting" in "materials/copper-free-cutting.toml",
    "stainless-austenitic" in "materials/stainless-austenitic.toml",
    "stainless-ferritic" in "materials/stainless-ferritic.toml",
    "stainless-martensitic" in "materials/stainless-martensitic.toml",
    "steel-high-carbon-annealed" in "materials/steel-high-carbon-annealed.toml",
    "steel-high-carbon-quenched" in "materials/steel-high-carbon-quenched.toml",
    "steel-low-alloy" in "materials/steel-low-alloy.toml",
    "steel-low-alloy-275-hb" in "materials/steel-low-alloy-275-hb.toml",
    "steel-low-alloy-300-hb" in "materials/steel-low-alloy-300-hb.toml",
    "steel-low-alloy-350-hb" in "materials/steel-low-alloy-350-hb.toml",
    "steel-low-alloy-annealed" in "materials/steel-low-alloy-annealed.toml",
    "steel-tool-annealed" in "materials/steel-tool-annealed.toml",
    "steel-tool-quenched" in "materials/steel-tool-quenched.toml",
    "steel-unalloyed-annealed" in "materials/steel-unalloyed-annealed.toml",
    "steel-unalloyed-low-carbon" in "materials/steel-unalloyed-low-carbon.toml",
    "steel-unalloyed-quenched" in "materials/steel-unalloyed-quenched.toml",
    "superalloy-iron-annealed" in "materials/superalloy-iron-annealed.toml",
    "superalloy-iron-cured" in "materials/superalloy-iron-cured.toml",
    "superalloy-nickel-annealed" in "materials/superalloy-nickel-annealed.toml",
    "superalloy-nickel-cast" in "materials/superalloy-nickel-cast.toml",
    "superalloy-nickel-cured" in "materials/superalloy-nickel-cured.toml",
    "titanium-alpha-beta" in "materials/titanium-alpha-beta.toml",
    "titanium-pure" in "materials/titanium-pure.toml",
];

/// All files of all examples, by the name of the example; its study is first.
pub const EXAMPLES: &[Embedded] = embedded![
    "mh12-groove" in "studies/mh12-groove/study.toml",
    "kr120-groove" in "studies/kr120-groove/study.toml",
    "r2000ic-pocket" in "studies/r2000ic-pocket/study.toml",
    "r2000ic-pocket" in "studies/r2000ic-pocket/pocket.ngc",
    "kr210-rivets" in "studies/kr210-rivets/study.toml",
    "mh12-ballbar" in "studies/mh12-ballbar/study.toml",
    "mh12-ballbar" in "studies/mh12-ballbar/ballbar-groove.csv",
    "mh12-ballbar" in "studies/mh12-ballbar/ballbar-side.csv",
    "mh12-ballbar" in "studies/mh12-ballbar/cmm.csv",
    "r2000ic-measured" in "studies/r2000ic-measured/study.toml",
    "r2000ic-measured" in "studies/r2000ic-measured/r2000ic-measured.toml",
    "r2000ic-measured" in "studies/r2000ic-measured/tests.csv",
];

/// The studies of all examples.
pub fn example_studies() -> impl Iterator<Item = &'static Embedded> {
    EXAMPLES.iter().filter(|file| file.path.ends_with("/study.toml"))
}

/// The files of the example of this name, each with its name in the folder of the example.
///
/// # Errors
/// No such example, with the names of all.
pub fn example(name: &str) -> Result<Vec<(&'static str, &'static Embedded)>, StudyError> {
    let files: Vec<_> = EXAMPLES
        .iter()
        .filter(|file| file.name == name)
        .filter_map(|file| Some((file.path.rsplit('/').next()?, file)))
        .collect();
    if files.is_empty() {
        let names: Vec<&str> = example_studies().map(|study| study.name).collect();
        return Err(StudyError::value(
            format!("no example is called `{name}`"),
            format!("one of: {}", names.join(", ")),
        ));
    }
    Ok(files)
}

/// The library robot of this name; `None` if there is none.
///
/// # Errors
/// The problems of an embedded file: a defect of the library.
pub fn robot(name: &str) -> Option<Result<RobotDescription, Problems>> {
    let entry = ROBOTS.iter().find(|robot| robot.name == name)?;
    Some(armill::read(entry.path, entry.name, entry.text))
}

/// The library material of this name; `None` if there is none.
///
/// # Errors
/// The problems of an embedded file: a defect of the library.
pub fn material(name: &str) -> Option<Result<Material, Problems>> {
    let entry = MATERIALS.iter().find(|material| material.name == name)?;
    Some(material::read(entry.path, entry.text))
}

/// The library material of this name, or why there is none.
///
/// # Errors
/// An unknown name, with the one most like it; the problems of an embedded file.
pub fn find_material(name: &str) -> Result<Material, StudyError> {
    let found = material(name).ok_or_else(|| {
        let message = format!("no material of the library is called `{name}`");
        StudyError::value(message, hint_of_material(name))
    })?;
    Ok(found?)
}

/// Suggestion if no material is called `name`.
pub fn hint_of_material(name: &str) -> String {
    spelt_like(MATERIALS, &name.to_lowercase()).map_or_else(
        || "`armill materials` lists all".to_owned(),
        |like| format!("did you mean `{like}`? `armill materials` lists all"),
    )
}

/// Characters of a type by which types are distinguished.
const BEGUN: usize = 3;

/// The name of the robot library that is most like `name`, if any is.
///
/// The type without its maker finds it, or the beginning of either; else spelling decides.
pub fn most_like(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    let part = ROBOTS
        .iter()
        .find(|robot| robot.name.split('/').any(|word| word == lower));
    // The manufacturer alone is common to many names.
    let given = |name: &str| name.rsplit('/').next().is_some_and(|kind| kind.len() >= BEGUN);
    let begins = |robot: &&Embedded| {
        let kind = robot.name.split('/').nth(1).unwrap_or_default();
        given(&lower) && (robot.name.starts_with(&lower) || kind.starts_with(&lower))
    };
    part.or_else(|| ROBOTS.iter().find(begins))
        .or_else(|| typed_like(&lower))
        .map(|robot| robot.name)
        .or_else(|| spelt_like(ROBOTS, &lower))
}

/// The robot whose type begins as `lower` does without spaces, hyphens and the maker: `KUKA KR 120`, `mh-12`.
fn typed_like(lower: &str) -> Option<&'static Embedded> {
    let joined = |text: &str| -> String { text.chars().filter(char::is_ascii_alphanumeric).collect() };
    let whole = joined(lower);
    let fits = |robot: &&Embedded| {
        let (maker, kind) = robot.name.split_once('/').unwrap_or_default();
        let requested = whole.strip_prefix(&joined(maker)).unwrap_or(&whole);
        requested.len() >= BEGUN && joined(kind).starts_with(requested)
    };
    ROBOTS.iter().find(fits)
}

/// The name that is spelt most like `lower`, if any is.
fn spelt_like(among: &[Embedded], lower: &str) -> Option<&'static str> {
    let scored = among
        .iter()
        .map(|entry| (strsim::jaro_winkler(entry.name, lower), entry.name));
    scored
        .filter(|(score, _)| *score > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_embedded_robot_reads() {
        for entry in ROBOTS {
            let read = robot(entry.name).unwrap();
            assert!(read.is_ok(), "{}", read.unwrap_err());
        }
    }

    #[test]
    fn every_embedded_material_reads_and_has_its_file_as_name() {
        for entry in MATERIALS {
            let read = material(entry.name).unwrap();
            assert!(read.is_ok(), "{}", read.unwrap_err());
            assert_eq!(entry.path, format!("materials/{}.toml", entry.name));
        }
        assert!(material("cheese").is_none());
    }

    #[test]
    fn sets_of_7075_spread_and_one_of_6082_does_not() {
        let law = |name: &str| material(name).unwrap().unwrap().mechanistic();
        let spread = law("aluminium-7075-t6").unwrap();
        assert_eq!(spread.sets, 3);
        let (mean, u) = (spread.mean[0], spread.covariance.unwrap()[(0, 0)].sqrt());
        // 767.01, 951.365 and 1319.41 N/mm2: 1012.60 with a standard deviation of 281.24.
        assert!(
            (mean * 1e-6 - 1012.595).abs() < 1e-9 && (u * 1e-6 - 281.24).abs() < 0.01,
            "{mean} {u}"
        );
        assert_eq!(law("aluminium-6082-t6").unwrap().sets, 1);
        assert!(
            law("aluminium-6061-t6").is_none(),
            "its set has no axial coefficients"
        );
    }

    #[test]
    fn a_slip_in_a_name_finds_the_robot_meant() {
        assert_eq!(most_like("mh12"), Some("yaskawa/mh12"));
        assert_eq!(most_like("yaskawa/mh21"), Some("yaskawa/mh12"));
        assert_eq!(most_like("kuka/kr120"), Some("kuka/kr120r2500pro"));
        assert_eq!(most_like("kr120"), Some("kuka/kr120r2500pro"));
        assert_eq!(most_like("KUKA KR 120"), Some("kuka/kr120r2500pro"));
        assert_eq!(most_like("mh-12"), Some("yaskawa/mh12"));
        assert_eq!(most_like("ABB IRB 6640"), Some("abb/irb6640-185-280"));
        assert_eq!(most_like("lathe"), None);
    }
}
