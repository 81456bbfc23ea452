//! `scale CASE BYTES`: reads a generated tool path program of this size, never kept in memory, and prints one row;
//! called by `cargo xtask scale`.
//!
//! | case | program |
//! |---|---|
//! | `gcode`, `apt`, `csv` | short straight cuts, a line each |
//! | `gcode-line`, `apt-line`, `csv-line` | the same with a line that does not end |
//! | `gcode-loop` | the same, all in one loop |
//! | `gcode-call` | the same behind a call of a subroutine that never comes |
//! | `gcode-labels` | the same behind calls of subroutines that have no end |
//!
//! Fields of the row, separated by tabs: case, bytes taken, steps given, seconds, most memory in KiB (0 where the
//! system does not report it), what the reader returned.

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::io::{self, BufReader, Read, Write};
use std::process::ExitCode;
use std::time::Instant;
use std::{env, fs};

use armill_formats::toolpath::LengthUnit;
use armill_formats::toolpath::format::{self, ToolpathReadOptions};

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [case, bytes] = arguments.as_slice() else {
        return usage();
    };
    let (Some(kind), Ok(bytes)) = (Kind::named(case), bytes.parse()) else {
        return usage();
    };
    let mut text = Text::new(kind, bytes);
    let requested = ToolpathReadOptions {
        unit: Some(LengthUnit::Millimetre),
        ..ToolpathReadOptions::default()
    };
    let (start, mut steps) = (Instant::now(), 0_u64);
    let read = format::read(kind.path(), BufReader::new(&mut text), &requested, &mut |_| {
        steps += 1;
    });
    let seconds = start.elapsed().as_secs_f64();
    let said = match read {
        Ok(_) => "read".to_owned(),
        Err(problems) => problems
            .as_slice()
            .first()
            .map_or_else(String::new, |problem| problem.message().to_owned()),
    };
    println!(
        "{case}\t{}\t{steps}\t{seconds:.3}\t{}\t{said}",
        text.given,
        most_kib()
    );
    ExitCode::SUCCESS
}

fn usage() -> ExitCode {
    eprintln!("usage: scale CASE BYTES; the cases are listed in the source");
    ExitCode::from(2)
}

/// Format of a program, and what is odd about it.
#[derive(Clone, Copy)]
struct Kind {
    format: Format,
    /// Before the cuts.
    begins: &'static str,
    /// Whether all cuts are one line.
    one_line: bool,
    ends: &'static str,
}

#[derive(Clone, Copy, PartialEq)]
enum Format {
    Gcode,
    Apt,
    Csv,
}

impl Kind {
    fn named(case: &str) -> Option<Kind> {
        let (format, begins, ends) = match case.split('-').next()? {
            "gcode" => (Format::Gcode, "G21 G90\nG0 X0 Y0 Z5\nF1200\n", "M2\n"),
            "apt" => (
                Format::Apt,
                "UNIT/MM\nRAPID\nGOTO/0,0,5\nFEDRAT/1200,MMPM\n",
                "FINI\n",
            ),
            "csv" => (Format::Csv, "x_mm,y_mm,z_mm,feed_mm_per_min\n", ""),
            _ => return None,
        };
        let plain = Kind {
            format,
            begins,
            one_line: false,
            ends,
        };
        Some(match case {
            "gcode" | "apt" | "csv" => plain,
            "gcode-line" | "apt-line" | "csv-line" => Kind {
                one_line: true,
                ..plain
            },
            "gcode-loop" => Kind {
                begins: "G21 G90\nG0 X0 Y0 Z5\nF1200\no1 repeat [2]\n",
                ends: "o1 endrepeat\nM2\n",
                ..plain
            },
            "gcode-call" => Kind {
                begins: "G21 G90\nG0 X0 Y0 Z5\nF1200\nM98 P1\n",
                ..plain
            },
            "gcode-labels" => Kind {
                begins: "G21 G90\nG0 X0 Y0 Z5\nF1200\nM98 P1\nM98 P2\nM98 P3\nM98 P4\nM2\nO1\nO2\nO3\nO4\n",
                ..plain
            },
            _ => return None,
        })
    }

    fn path(&self) -> &'static str {
        match self.format {
            Format::Gcode => "part.ngc",
            Format::Apt => "part.apt",
            Format::Csv => "part.csv",
        }
    }
}

/// A program that is made as it is read.
struct Text {
    kind: Kind,
    /// Bytes of cuts still to come.
    left: u64,
    /// Bytes that were taken.
    given: u64,
    count: u64,
    /// Made and not yet taken; the part before `at` is taken.
    made: Vec<u8>,
    at: usize,
    ended: bool,
}

impl Text {
    fn new(kind: Kind, bytes: u64) -> Text {
        Text {
            kind,
            left: bytes,
            given: 0,
            count: 0,
            made: kind.begins.into(),
            at: 0,
            ended: false,
        }
    }

    /// One more cut, or the end.
    fn make(&mut self) -> io::Result<()> {
        self.made.clear();
        self.at = 0;
        if self.left == 0 {
            if !self.ended {
                self.made.extend_from_slice(self.kind.ends.as_bytes());
            }
            self.ended = true;
            return Ok(());
        }
        let k = self.count;
        self.count += 1;
        let (x, y) = ((k % 400) as f64 * 0.5, (k / 400 % 400) as f64 * 0.5);
        let z = -1.0 - (0.05 * (k % 1000) as f64).sin();
        match self.kind.format {
            Format::Gcode => write!(self.made, "G1 X{x:.4} Y{y:.4} Z{z:.4}")?,
            Format::Apt => write!(self.made, "GOTO/{x:.4},{y:.4},{z:.4}")?,
            Format::Csv => write!(self.made, "{x:.4},{y:.4},{z:.4},1200")?,
        }
        self.made.push(if self.kind.one_line { b' ' } else { b'\n' });
        self.left = self.left.saturating_sub(self.made.len() as u64);
        Ok(())
    }
}

impl Read for Text {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.at >= self.made.len() {
            self.make()?;
        }
        let taken = self.made.get(self.at..).unwrap_or_default().read(out)?;
        self.at += taken;
        self.given += taken as u64;
        Ok(taken)
    }
}

/// The peak memory of this program, KiB; 0 where the system does not report it.
fn most_kib() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let number = line.and_then(|line| line.split_whitespace().next()?.parse().ok());
    number.unwrap_or(0)
}
