//! Yaskawa INFORM: jobs (`.JBI`) with their positions.
//!
//! Sources: DX100, Easy Offline Teaching (HW0482494), chapter 4.1, job data format (NPOS, USER, TOOL, POSTYPE, RECTAN,
//! RCONF); instructions by the INFORM manual RE-CSO-A042 [recalled].
//!
//! The unit of `V=` is a parameter of the controller; here it is mm/s. Not interpreted: branches, position shifts,
//! incremental moves, arcs.

mod positions;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use self::positions::{Axes, Position, Positions, Section};
use crate::event::{Action, Blend, JointMove, JointTarget, LinearMove, Posture, Speed};
use crate::log::Log;
use crate::source::{Place, ReplayError, SourceFile};
use crate::value::truth_word;
use crate::words::{Cursor, Word};

const DEPTH: usize = 32;

struct Job<'a> {
    positions: Positions,
    /// Lines after the header of `//INST`.
    lines: Vec<(Place, &'a str)>,
}

struct Inform<'a> {
    jobs: BTreeMap<String, Job<'a>>,
    log: Log,
}

pub fn run(files: &[SourceFile], main: &str, log: Log) -> Result<Log, ReplayError> {
    let mut inform = Inform {
        jobs: BTreeMap::new(),
        log,
    };
    for file in files {
        let (name, job) = load(file)?;
        if inform.jobs.insert(name.clone(), job).is_some() {
            return Err(file.place(0).error(format!("the job {name} exists twice")));
        }
    }
    let start = files.first().map_or(Place::nowhere(), |file| file.place(0));
    if !inform.jobs.contains_key(main) {
        return Err(start.error(format!("no job {main} in the files")));
    }
    inform.job(main, 0)?;
    Ok(inform.log)
}

fn load(file: &SourceFile) -> Result<(String, Job<'_>), ReplayError> {
    let mut name = None;
    let mut section = Section::default();
    let mut positions = Positions::default();
    let mut attributes = Vec::new();
    let mut lines = Vec::new();
    let mut in_instructions = false;
    let mut ended = false;
    for (place, line) in file.lines() {
        let line = line.trim();
        if let Some(rest) = line.strip_prefix("//NAME ") {
            name = Some(rest.trim().to_owned());
        } else if line == "//INST" {
            in_instructions = true;
        } else if line == "/JOB" || line == "//POS" || line.is_empty() {
        } else if in_instructions {
            // Attributes of the job; FRAME is that of a relative job.
            if let Some(rest) = line.strip_prefix("///ATTR ") {
                attributes = rest.split(',').map(|word| word.trim().to_owned()).collect();
            } else if line.starts_with("///DATE ")
                || line.starts_with("///COMM ")
                || line.starts_with("///GROUP")
                || line.starts_with("////FRAME ")
            {
            } else if line.starts_with("//") {
                return Err(place.error(format!("unknown header `{line}`")));
            } else if ended {
                return Err(place.error(format!("`{line}` follows END")));
            } else {
                ended = line == "END";
                lines.push((place, line));
            }
        } else if let Some(header) = line.strip_prefix("///") {
            section.header(header, &place)?;
        } else {
            positions.read(line, &section, &place)?;
        }
    }
    let place = file.place(0);
    let name = name.ok_or_else(|| place.error("no //NAME"))?;
    if !ended {
        return Err(place.error("the job has no END"));
    }
    positions.check(&section, attributes.iter().any(|word| word == "RJ"), &place)?;
    Ok((name, Job { positions, lines }))
}

impl Inform<'_> {
    fn job(&mut self, name: &str, depth: usize) -> Result<(), ReplayError> {
        for (place, line) in self.jobs[name].lines.clone() {
            if depth > DEPTH {
                return Err(place.error(format!("more than {DEPTH} calls inside each other")));
            }
            if let Some(comment) = line.strip_prefix('\'') {
                self.log.comment(&place, comment);
                continue;
            }
            let mut cursor = Cursor::new(line, &place)?;
            match cursor.name()?.as_str() {
                "NOP" => {}
                "END" | "RET" => return cursor.end(),
                "MOVJ" => self.move_joints(&mut cursor, name)?,
                "MOVL" => self.move_line(&mut cursor, name)?,
                "DOUT" => {
                    let kind = cursor.name()?;
                    if kind != "OT" && kind != "OG" {
                        return Err(cursor.error(format!("unknown output {kind}#")));
                    }
                    cursor.expect("#(")?;
                    let number = cursor.count()?;
                    cursor.expect(")")?;
                    let value = if cursor.eat_name("ON") {
                        truth_word(true)
                    } else if cursor.eat_name("OFF") {
                        truth_word(false)
                    } else {
                        cursor.count()?.to_string()
                    };
                    self.log.output(&place, format!("{kind}#({number})"), value);
                }
                "TIMER" => {
                    let s = tagged(&mut cursor, "T")?.ok_or_else(|| cursor.unexpected("T="))?;
                    self.log.push(&place, Action::Dwell { s });
                }
                "WAIT" => {
                    let condition = cursor.rest();
                    self.log.push(&place, Action::Wait { condition });
                }
                "PAUSE" => self.log.stop(&place),
                "MSG" => {
                    let text = cursor.text()?;
                    self.log.message(&place, text);
                }
                "CALL" => {
                    if !cursor.eat_name("JOB") {
                        return Err(cursor.unexpected("JOB:"));
                    }
                    cursor.expect(":")?;
                    let called = cursor.rest();
                    if self.jobs.contains_key(&called) {
                        self.job(&called, depth + 1)?;
                    } else {
                        let arguments = Vec::new();
                        self.log.push(
                            &place,
                            Action::Call {
                                name: called,
                                arguments,
                            },
                        );
                    }
                }
                // A variable, which nothing here reads.
                "SET" => {
                    let variable = cursor.name()?;
                    if !variable.starts_with(['B', 'I', 'D', 'R']) {
                        return Err(cursor.error(format!("SET {variable} is not interpreted")));
                    }
                    cursor.number()?;
                }
                other => return Err(cursor.error(format!("unknown instruction `{other}`"))),
            }
            cursor.end()?;
        }
        Ok(())
    }

    /// The position that an instruction names, and the external axes next to it.
    fn target(&self, cursor: &mut Cursor, job: &str) -> Result<(Position, Vec<Option<f64>>), ReplayError> {
        let positions = &self.jobs[job].positions;
        let known = |cursor: &Cursor, name: &str| {
            positions
                .get(name)
                .cloned()
                .ok_or_else(|| cursor.error(format!("position {name} is not in the job")))
        };
        let name = cursor.name()?;
        let position = known(cursor, &name)?;
        let mut external = Vec::new();
        while matches!(cursor.peek(), Some(Word::Name(next)) if next.starts_with("EC") || next.starts_with("BC"))
        {
            let name = cursor.name()?;
            external.extend(known(cursor, &name)?.axes.numbers().iter().copied().map(Some));
        }
        Ok((position, external))
    }

    fn move_joints(&mut self, cursor: &mut Cursor, job: &str) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        let (position, mut external) = self.target(cursor, job)?;
        let percent = tagged(cursor, "VJ")?;
        let blend = level(cursor)?;
        self.station(cursor, job, &mut external)?;
        let to = match position.axes {
            Axes::Pulses(pulses) => JointTarget::Pulses(pulses),
            Axes::Pose(pose) => JointTarget::Pose {
                pose,
                posture: Posture::Flags(position.flags),
            },
        };
        self.log.push(
            &place,
            Action::Joint(JointMove {
                to,
                external,
                base: position.base,
                tool: position.tool,
                speed: percent.map_or(Speed::Unspecified, Speed::Percent),
                blend,
            }),
        );
        Ok(())
    }

    fn move_line(&mut self, cursor: &mut Cursor, job: &str) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        let (position, mut external) = self.target(cursor, job)?;
        let speed = tagged(cursor, "V")?;
        let blend = level(cursor)?;
        self.station(cursor, job, &mut external)?;
        let Axes::Pose(to) = position.axes else {
            return Err(cursor.error("a line to pulses needs the model of the arm"));
        };
        self.log.push(
            &place,
            Action::Linear(LinearMove {
                to,
                external,
                base: position.base,
                tool: position.tool,
                speed: speed.map_or(Speed::Unspecified, Speed::MmPerS),
                blend,
            }),
        );
        Ok(())
    }

    /// `+MOVJ EC00001 VJ=..`: a station that moves at the same time.
    fn station(
        &self,
        cursor: &mut Cursor,
        job: &str,
        external: &mut Vec<Option<f64>>,
    ) -> Result<(), ReplayError> {
        if cursor.eat("+") {
            if !cursor.eat_name("MOVJ") {
                return Err(cursor.unexpected("MOVJ"));
            }
            let (station, _) = self.target(cursor, job)?;
            tagged(cursor, "VJ")?;
            external.extend(station.axes.numbers().iter().copied().map(Some));
        }
        Ok(())
    }
}

/// `TAG=number`.
fn tagged(cursor: &mut Cursor, tag: &str) -> Result<Option<f64>, ReplayError> {
    if !cursor.eat_name(tag) {
        return Ok(None);
    }
    cursor.expect("=")?;
    Ok(Some(cursor.number()?))
}

/// `PL=0` ends in the target; without PL the controller decides.
fn level(cursor: &mut Cursor) -> Result<Blend, ReplayError> {
    match tagged(cursor, "PL")? {
        None => Ok(Blend::Unspecified),
        Some(0.0) => Ok(Blend::Exact),
        Some(level) if (1.0..=8.0).contains(&level) && level.fract() == 0.0 => Ok(Blend::Level(level as u32)),
        Some(level) => Err(cursor.error(format!("PL={level} is not a position level of 0 to 8"))),
    }
}
