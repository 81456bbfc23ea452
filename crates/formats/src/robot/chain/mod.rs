//! A chain of elementary motions as one types it: `Tz(450) Rz(q1) Tx(155) Ry(q2) ...`, mm and degrees.
//!
//! | written | means |
//! |---|---|
//! | `Tx Ty Tz`, or `A1 A2 A3` as in the paper | along x, y, z |
//! | `Rx Ry Rz`, or `A4 A5 A6` | about x, y, z by the right hand |
//! | `(450)`, `(-90)` | a constant: mm, deg |
//! | `(q1)`, `(phi)` | a joint with the sign of the chain |
//! | `(-q3)`, `(q3-90)`, `(90-q3)` | a joint with the opposite sign, and chain position at its zero |
//! | `H = 450` on a line of its own | a symbol for a constant |
//!
//! Factors are separated by blanks, `*` or line ends; `#` starts a comment. Inside a translation only `q1`, `q2`, ...
//! are joints: any other name is a length that needs a value, so that a forgotten one does not become a slide.
//!
//! In reading order: `cursor` (walks over a text), `factors` (the words), and here the chain that they make.
//!
//! Source: the form-shaping function of Shneor & Chapsky 2021, eq. 6; `docs/theory/chain.md`.

mod cursor;
mod factors;

use armill_core::robot::{Amount, Joint, Robot};

use self::factors::Factor;
use super::MOST_JOINTS;
use super::description::RobotDescription;
use crate::document::{Problems, Source};

/// The robot of this chain; `path` is what errors show, `id` the robot's name in results.
///
/// Joints are in the order of the chain; they have no limits, no speeds and no compliance: a chain does not contain
/// them.
///
/// # Errors
/// What is not a factor, a length without value, a joint that moves twice, no joint at all.
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    let file = Source::new(path, text);
    let factors = factors::read(&file)?;
    let mut motions = Vec::new();
    let mut joints: Vec<Joint> = Vec::new();
    let mut symbols = Vec::new();
    let mut problems = Vec::new();
    for Factor {
        kind,
        argument,
        place,
    } in factors
    {
        let constant = kind.si(argument.constant);
        let amount = match argument.joint {
            None => Amount::Constant(constant),
            Some(_) if joints.len() >= MOST_JOINTS => {
                let message = format!("more than {MOST_JOINTS} joints move");
                problems.push(file.problem(place, message, None));
                break;
            }
            Some((name, sign)) => {
                if joints.iter().any(|joint| joint.name == name) {
                    let message = format!("joint `{name}` moves a second time");
                    let hint = "a joint moves one factor of the chain".to_owned();
                    problems.push(file.problem(place, message, Some(hint)));
                    continue;
                }
                joints.push(Joint {
                    sign,
                    zero_offset: constant,
                    ..Joint::plain(name)
                });
                Amount::Joint(joints.len() - 1)
            }
        };
        symbols.push(argument.symbol);
        motions.push(kind.by(amount));
    }
    Problems::from(problems).into_result()?;
    let robot = Robot::new(id, motions, joints).map_err(|error| {
        let hint = "joints are names, such as Rz(q1)".to_owned();
        Problems::from(file.problem(0..0, error.to_string(), Some(hint)))
    })?;
    let mut found = RobotDescription::of_one_source(robot, "chain", path, "chain of elementary motions");
    found.symbols = symbols;
    found.remarks = vec!["lengths are taken as mm, angles as degrees".to_owned()];
    Ok(found)
}

#[cfg(test)]
mod tests;
