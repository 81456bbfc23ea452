//! The robot library and the example studies, embedded: every command works from an empty folder.

use armill_formats::document::Problems;
use armill_formats::robot::{RobotDescription, armill};

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

macro_rules! embedded {
    ($($name:literal in $path:literal),+ $(,)?) => {
        &[$(Embedded { name: $name, path: $path, text: include_str!(concat!("../../../", $path)) }),+]
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

/// Every example study.
pub const STUDIES: &[Embedded] = embedded![
    "mh12-groove" in "studies/mh12-groove/study.toml",
    "kr120-groove" in "studies/kr120-groove/study.toml",
];

/// The library robot of this name; `None` if there is none.
///
/// # Errors
/// The problems of an embedded file: a defect of the library.
pub fn robot(name: &str) -> Option<Result<RobotDescription, Problems>> {
    let entry = ROBOTS.iter().find(|robot| robot.name == name)?;
    Some(armill::read(entry.path, entry.name, entry.text))
}

/// The name in the library that is most like `name`, if any is.
pub fn most_like(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    let part = ROBOTS
        .iter()
        .find(|robot| robot.name.split('/').any(|word| word == lower));
    part.map(|robot| robot.name).or_else(|| {
        let scored = ROBOTS
            .iter()
            .map(|robot| (strsim::jaro_winkler(robot.name, &lower), robot.name));
        scored
            .filter(|(score, _)| *score > 0.75)
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, name)| name)
    })
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
    fn a_slip_in_a_name_finds_the_robot_meant() {
        assert_eq!(most_like("mh12"), Some("yaskawa/mh12"));
        assert_eq!(most_like("yaskawa/mh21"), Some("yaskawa/mh12"));
        assert_eq!(most_like("lathe"), None);
    }
}
