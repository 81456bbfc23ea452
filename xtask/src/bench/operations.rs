//! What the instructions of a function are: quotients, roots, loads, stores, and those in libraries of the system.
//!
//! The units of a processor that divide and take roots are not pipelined: a vector of these takes as long as some ten
//! sums or products, which a count of instructions does not show. Loads and stores show how much of a loop is moving
//! numbers and not arithmetic. Instructions in libraries are those of the memory allocator and of long copies and fills, of
//! which Callgrind counts each byte as one instruction, although a processor writes 32 or 64 at once.
//!
//! Read are the file that Callgrind writes with `--dump-instr=yes --cache-sim=yes` and the listing of `objdump -d`:
//!
//! ```text
//! events: Ir Dr Dw ...        order of the counts: instructions, loads, stores; zeros at the end of a line are left out
//! ob=(1) /path/program        or without (1): the program that the lines after it are of
//! 0x1f40 12 800 700 ...       address, line, counts; `+4`, `-4`, `*`: relative to the line before
//! calls=...                   the line after it is not of this function alone
//!
//!   1f40:  vdivpd %ymm1,%ymm2,%ymm3
//! ```

use std::collections::HashMap;

/// Quotients and roots, those of a vector are several; loads and stores, a vector is one; instructions in libraries.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Operations {
    pub quotients: f64,
    pub roots: f64,
    pub loads: f64,
    pub stores: f64,
    pub in_libraries: f64,
}

impl Operations {
    /// Those of one of `count` poses.
    pub fn per_pose(self, count: f64) -> Operations {
        Operations {
            quotients: self.quotients / count,
            roots: self.roots / count,
            loads: self.loads / count,
            stores: self.stores / count,
            in_libraries: self.in_libraries / count,
        }
    }
}

/// The instructions of a program that divide or take roots, by address: how many quotients and roots each computes.
pub struct Dividing(HashMap<u64, [f64; 2]>);

impl Dividing {
    /// From the listing of a program.
    pub fn of(listing: &str) -> Dividing {
        Dividing(listing.lines().filter_map(dividing).collect())
    }

    /// The operations of a run of the program whose path ends in `program`; none if the caches were not simulated.
    pub fn counted(&self, callgrind: &str, program: &str) -> Option<Operations> {
        callgrind
            .lines()
            .find(|line| line.starts_with("events: Ir Dr Dw"))?;
        let mut sum = Operations::default();
        for line in counted_lines(callgrind, program) {
            let [executions, loads, stores] = line.counts;
            if !line.is_program {
                sum.in_libraries += executions;
                continue;
            }
            sum.loads += loads;
            sum.stores += stores;
            if let Some([quotients, roots]) = self.0.get(&line.address) {
                sum.quotients += executions * quotients;
                sum.roots += executions * roots;
            }
        }
        Some(sum)
    }
}

/// Address of an instruction that divides or takes roots, and how many quotients and roots it computes.
fn dividing(line: &str) -> Option<(u64, [f64; 2])> {
    let (address, rest) = line.trim_start().split_once(':')?;
    let mut words = rest.split_whitespace();
    let (name, operands) = (words.next()?.trim_start_matches('v'), words.next()?);
    let lanes = match name.get(name.len().checked_sub(2)?..)? {
        "sd" | "ss" => 1.0,
        "pd" | "ps" => {
            let bytes = match () {
                () if operands.contains("%zmm") => 64.0,
                () if operands.contains("%ymm") => 32.0,
                () => 16.0,
            };
            bytes / if name.ends_with("pd") { 8.0 } else { 4.0 }
        }
        _ => return None,
    };
    let numbers = match &name[..name.len() - 2] {
        "div" => [lanes, 0.0],
        "sqrt" => [0.0, lanes],
        _ => return None,
    };
    Some((u64::from_str_radix(address, 16).ok()?, numbers))
}

/// Counts of an instruction.
#[derive(Debug, PartialEq)]
struct CountedLine {
    /// Whether it is one of the program, not of a library.
    is_program: bool,
    address: u64,
    /// Executions, loads, stores.
    counts: [f64; 3],
}

/// Every instruction that was counted.
fn counted_lines(callgrind: &str, program: &str) -> Vec<CountedLine> {
    let mut names: HashMap<&str, &str> = HashMap::new();
    let (mut address, mut is_program, mut is_of_call) = (0, false, false);
    let mut all = Vec::new();
    for line in callgrind.lines() {
        if let Some(object) = line.strip_prefix("ob=").or(line.strip_prefix("cob=")) {
            // A number stands for a name given before, and may be in front of a new one.
            let name = match object.split_once(' ') {
                Some((number, name)) if number.starts_with('(') => {
                    names.insert(number, name);
                    name
                }
                _ => names.get(object).copied().unwrap_or(object),
            };
            if line.starts_with("ob=") {
                is_program = name.ends_with(program);
            }
            continue;
        }
        if line.starts_with("calls=") {
            is_of_call = true;
            continue;
        }
        let mut fields = line.split(' ');
        let Some(at) = fields.next().and_then(|field| position(field, address)) else {
            continue;
        };
        address = at;
        let mut count = |_| fields.next().and_then(|field| field.parse().ok()).unwrap_or(0.0);
        let [_, counts @ ..] = [(); 4].map(&mut count);
        if !is_of_call {
            all.push(CountedLine {
                is_program,
                address,
                counts,
            });
        }
        is_of_call = false;
    }
    all
}

/// The address in a field; `before`: that of the line before.
fn position(field: &str, before: u64) -> Option<u64> {
    if let Some(address) = field.strip_prefix("0x") {
        u64::from_str_radix(address, 16).ok()
    } else if field == "*" {
        Some(before)
    } else if field.starts_with(['+', '-']) {
        before.checked_add_signed(field.parse().ok()?)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_that_divide_are_found_with_their_lanes() {
        let listing = "  1f40:\tvdivpd %ymm1,%ymm2,%ymm3\n  1f44:\tvsqrtsd %xmm1,%xmm1,%xmm1\n  1f48:\tvaddpd %ymm1,%ymm2,%ymm3\n  1f4c:\tdivps %xmm1,%xmm0\n";
        let found = Dividing::of(listing).0;
        let numbers = |address| found.get(&address).copied();
        assert_eq!(numbers(0x1f40), Some([4.0, 0.0]));
        assert_eq!(numbers(0x1f44), Some([0.0, 1.0]));
        assert_eq!(numbers(0x1f48), None);
        assert_eq!(numbers(0x1f4c), Some([4.0, 0.0]));
    }

    #[test]
    fn calls_are_not_counted_and_libraries_apart() {
        let callgrind = "events: Ir Dr Dw\npositions: instr line\nob=(1) /a/program\nfn=(1) f\n0x1f40 7 10 3\n+4 * 5\ncalls=2 0x1 3\n* * 900\n+4 +2 1 0 4\ncob=(2) /lib/libm.so\nob=(2)\n0x1f40 1 77\nob=(1)\n0x1f40 1 2\n";
        let dividing = Dividing::of("1f40:\tvdivsd %xmm1,%xmm2,%xmm3\n1f44:\tsqrtsd %xmm1,%xmm2\n");
        let expected = Operations {
            quotients: 12.0,
            roots: 5.0,
            loads: 3.0,
            stores: 4.0,
            in_libraries: 77.0,
        };
        assert_eq!(dividing.counted(callgrind, "program"), Some(expected));
        assert_eq!(dividing.counted("events: Ir\n0x1f40 7 10\n", "program"), None);
        let without_numbers = "events: Ir Dr Dw\nob=/a/program\n0x1f40 7 10\n";
        let counted = dividing.counted(without_numbers, "program");
        assert!(counted.is_some_and(|counted| counted.quotients == 10.0 && counted.in_libraries == 0.0));
    }
}
