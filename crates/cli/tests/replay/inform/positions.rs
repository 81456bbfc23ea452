//! Positions of a job, and the headers that they are under.
//!
//! Source: DX100, Easy Offline Teaching (HW0482494), chapter 4.1.3: a header is valid for all positions after it.

use std::collections::BTreeMap;

use crate::event::Reference;
use crate::pose::Pose;
use crate::source::{Place, ReplayError};

/// What the headers above a position say.
#[derive(Clone, Debug, Default)]
pub struct Section {
    counts: Option<Vec<usize>>,
    tool: Option<u32>,
    user: Option<u32>,
    kind: String,
    cartesian: bool,
    flags: Vec<i32>,
}

#[derive(Clone, Debug)]
pub enum Axes {
    Pulses(Vec<f64>),
    Pose(Pose),
}

impl Axes {
    /// Numbers of an external axis.
    pub fn numbers(&self) -> &[f64] {
        match self {
            Axes::Pulses(pulses) => pulses,
            Axes::Pose(_) => &[],
        }
    }
}

#[derive(Clone, Debug)]
pub struct Position {
    pub axes: Axes,
    pub base: Reference,
    pub tool: Reference,
    /// RCONF.
    pub flags: Vec<i32>,
}

#[derive(Debug, Default)]
pub struct Positions(BTreeMap<String, Position>);

impl Section {
    /// A header without its three slashes.
    pub fn header(&mut self, header: &str, place: &Place) -> Result<(), ReplayError> {
        let (word, rest) = header.split_once(' ').unwrap_or((header, ""));
        let whole = |text: &str| {
            text.trim()
                .parse::<u32>()
                .map_err(|_| place.error(format!("`{text}` is not a whole number")))
        };
        match word {
            "NPOS" => {
                let counts: Result<Vec<u32>, ReplayError> = rest.split(',').map(whole).collect();
                self.counts = Some(counts?.into_iter().map(|count| count as usize).collect());
            }
            "TOOL" => self.tool = Some(whole(rest)?),
            "USER" => self.user = Some(whole(rest)?),
            "POSTYPE" => match rest.trim() {
                kind @ ("PULSE" | "BASE" | "ROBOT" | "USER") => kind.clone_into(&mut self.kind),
                other => return Err(place.error(format!("///POSTYPE {other} is not interpreted"))),
            },
            "PULSE" => self.cartesian = false,
            "RECTAN" => self.cartesian = true,
            "RCONF" => {
                let flag = |text: &str| text.trim().parse::<i32>();
                let flags: Result<_, _> = rest.split(',').map(flag).collect();
                self.flags = flags.map_err(|_| place.error(format!("`{rest}` are not whole numbers")))?;
            }
            _ => return Err(place.error(format!("unknown header `///{header}`"))),
        }
        Ok(())
    }
}

impl Positions {
    pub fn get(&self, name: &str) -> Option<&Position> {
        self.0.get(name)
    }

    /// `C00001=x,y,z,rx,ry,rz`, `EC00001=..`, `P0001=..`.
    pub fn read(&mut self, line: &str, section: &Section, place: &Place) -> Result<(), ReplayError> {
        let (name, numbers) = line
            .split_once('=')
            .ok_or_else(|| place.error(format!("unknown line `{line}`")))?;
        if !["C", "EC", "BC", "P", "EX", "BP"].contains(&name.trim_end_matches(|c: char| c.is_ascii_digit()))
        {
            return Err(place.error(format!("`{name}` is not the name of a position")));
        }
        let numbers: Result<Vec<f64>, ReplayError> = numbers
            .split(',')
            .map(|number| {
                let number = number.trim();
                number
                    .parse()
                    .map_err(|_| place.error(format!("`{number}` is not a number")))
            })
            .collect();
        let numbers = numbers?;
        let of_robot = name.starts_with(['C', 'P']);
        let axes = if section.cartesian && of_robot {
            let pose: [f64; 6] = numbers
                .try_into()
                .map_err(|_| place.error(format!("{name} needs six numbers")))?;
            Axes::Pose(Pose::fixed_xyz(pose))
        } else {
            if of_robot && numbers.len() != 6 {
                return Err(place.error(format!("{name} has {} axes, not six", numbers.len())));
            }
            Axes::Pulses(numbers)
        };
        if section.cartesian == (section.kind == "PULSE") && of_robot {
            return Err(place.error(format!(
                "///POSTYPE {} does not fit the position {name}",
                section.kind
            )));
        }
        let tool = section
            .tool
            .ok_or_else(|| place.error("no ///TOOL above the position"))?;
        let base = match section.kind.as_str() {
            "BASE" | "ROBOT" => Reference::new(section.kind.clone(), Some(Pose::IDENTITY)),
            "USER" => {
                let user = section
                    .user
                    .ok_or_else(|| place.error("no ///USER above the position"))?;
                Reference::new(user.to_string(), None)
            }
            _ => Reference::default(),
        };
        let position = Position {
            axes,
            base,
            tool: Reference::new(tool.to_string(), None),
            flags: section.flags.clone(),
        };
        if self.0.insert(name.to_owned(), position).is_some() {
            return Err(place.error(format!("{name} is given twice")));
        }
        Ok(())
    }

    /// As many positions as NPOS says, in its order C, BC, EC, P, BP, EX; Cartesian ones need a relative job.
    pub fn check(&self, section: &Section, relative: bool, place: &Place) -> Result<(), ReplayError> {
        let counts = section.counts.as_ref().ok_or_else(|| place.error("no ///NPOS"))?;
        for (kind, expected) in ["C", "BC", "EC", "P", "BP", "EX"].iter().zip(counts) {
            let is_kind = |name: &&String| name.trim_end_matches(|c: char| c.is_ascii_digit()) == *kind;
            let found = self.0.keys().filter(is_kind).count();
            if found != *expected {
                return Err(place.error(format!("///NPOS says {expected} positions {kind}, found {found}")));
            }
        }
        let cartesian = |(name, position): (&String, &Position)| {
            name.starts_with('C') && matches!(position.axes, Axes::Pose(_))
        };
        // A job whose taught positions are Cartesian is a relative job [recalled].
        if !relative && self.0.iter().any(cartesian) {
            return Err(place.error("Cartesian positions need ///ATTR with RJ (relative job)"));
        }
        Ok(())
    }
}
