//! Whether the language of a program is that of the robot's controllers.

use armill_formats::robot::RobotDescription;
use armill_programs::Language;

/// Words in the names of a maker's robots, and the language of its controllers.
const MAKERS: [(&str, Language); 9] = [
    ("kuka", Language::Krl),
    ("abb", Language::Rapid),
    ("yaskawa", Language::Inform),
    ("motoman", Language::Inform),
    ("fanuc", Language::Tp),
    ("ur", Language::UrScript),
    ("universal", Language::UrScript),
    ("staubli", Language::Val3),
    ("st\u{e4}ubli", Language::Val3),
];

/// The language of the robot's controllers; none of a maker that is not known.
pub fn own_language(robot: &RobotDescription) -> Option<Language> {
    let names = format!("{} {}", robot.title, robot.robot.name()).to_lowercase();
    let words: Vec<&str> = names
        .split(|c: char| !c.is_alphabetic())
        .filter(|word| !word.is_empty())
        .collect();
    let (_, own) = MAKERS.iter().find(|(word, _)| words.contains(word))?;
    Some(*own)
}

/// A warning if the robot is of a maker whose controllers have another language.
pub(super) fn question(robot: &RobotDescription, language: Language) -> Option<String> {
    let own = own_language(robot)?;
    (own != language).then(|| {
        format!(
            "the program is written in {}, but controllers of {} read {}: check the file name extension",
            language.title(),
            robot.title,
            own.title()
        )
    })
}
