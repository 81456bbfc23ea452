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
    "kuka/kr120r2500pro" in "robots/kuka/kr120r2500pro.toml",
    "yaskawa/mh12" in "robots/yaskawa/mh12.toml",
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
