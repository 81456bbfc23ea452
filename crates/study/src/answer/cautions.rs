//! Warnings of a tool path program: out of reach, jumps of the arm, points without force.

use super::path::PathResult;

/// What a user should know before trusting the result of a program.
pub(super) fn of_program(path: &PathResult) -> Vec<String> {
    let Some(program) = &path.program else {
        return Vec::new();
    };
    let name = &path.name;
    let mut warnings = Vec::new();
    if path.unreached > 0 {
        warnings.push(format!(
            "{name}: {} of {} points are out of reach; does the program lie where it should (part_from_path_mm_deg)?",
            path.unreached, path.points
        ));
    }
    if !program.jumps.is_empty() {
        warnings.push(format!(
            "{name}: the arm cannot follow without a stop: {}.",
            program.jumps.join("; ")
        ));
    }
    if program.points_without_force > 0 {
        warnings.push(format!(
            "{name}: {} of {} points have no force (plunges and steep dives, where the bottom of the cutter cuts): their deviation is told as zero.",
            program.points_without_force, path.points
        ));
    }
    warnings
}
