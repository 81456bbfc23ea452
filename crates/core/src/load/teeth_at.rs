//! The teeth of a cutter at one point of their edges: what each cuts of what those before it left.
//!
//! ```text
//! h_j = min over m = 1 .. N of   m h + l_jm          l_jm = (rho_j - rho_(j-m)) sin(kappa)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `h`, `h_j` | chip thickness of teeth without runout, of tooth `j` | m |
//! | `rho_j` | radial runout of tooth `j` at this point | m |
//! | `kappa` | axial immersion angle | rad |
//!
//! Each term is a line over `h`, so their minimum rises and is concave: tooth `j` cuts where `h` exceeds the largest `-l_jm/m`, and from
//! there on down to the surfaces of ever nearer teeth. Between the angles at which the surface changes, the chip has the form of an
//! even one, and integrals over it are closed.
//!
//! Source: `docs/theory/cutting.md`.

use std::f64::consts::{PI, TAU};

use super::arc::{Chip, EngagedArc};
use super::cutter::{Cutter, EdgePoint};

/// The teeth at a point of their edges.
#[derive(Clone, Debug)]
pub(super) struct TeethAt {
    /// Radial runout of each tooth, m; empty if the tool runs true.
    runout: Vec<f64>,
    sin_kappa: f64,
}

/// The surface that an earlier tooth left.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Surface {
    /// How many teeth earlier.
    before: f64,
    /// How far the tooth is farther out than that one, across the edge, m.
    lead: f64,
}

impl Surface {
    /// Thickness down to it where even teeth cut `even`, m.
    fn depth(self, even: f64) -> f64 {
        self.before * even + self.lead
    }
}

impl TeethAt {
    /// The teeth of `cutter` at `point`.
    pub(super) fn new(cutter: &Cutter, point: &EdgePoint) -> TeethAt {
        let teeth = match cutter.runout().offset == 0.0 {
            true => 0..0,
            false => 0..cutter.flutes(),
        };
        TeethAt {
            runout: teeth
                .map(|tooth| cutter.radial_runout(tooth, point.height))
                .collect(),
            sin_kappa: point.sin_kappa,
        }
    }

    /// Chip thickness (m) of tooth `tooth` where even teeth cut `even` (m); negative where it cuts nothing.
    pub(super) fn chip(&self, tooth: u32, even: f64) -> f64 {
        if self.runout.is_empty() {
            return even;
        }
        let depths = self.surfaces(tooth).map(|surface| surface.depth(even));
        depths.fold(f64::INFINITY, f64::min)
    }

    /// The parts of `arc` in which tooth `tooth` cuts, each with its chip where even teeth have the chip `even`.
    pub(super) fn cuts(&self, tooth: u32, even: Chip, arc: EngagedArc) -> Vec<(EngagedArc, Chip)> {
        if self.runout.is_empty() {
            return vec![(arc, even)];
        }
        let surfaces: Vec<Surface> = self.surfaces(tooth).collect();
        let mut ends = vec![arc.entry, arc.exit];
        for thickness in changes(&surfaces, even.along + even.across.abs()) {
            ends.extend(angles(even, thickness, arc));
        }
        ends.sort_by(f64::total_cmp);
        let parts = ends.windows(2).filter(|ends| ends[1] > ends[0]);
        let cut = parts.filter_map(|ends| {
            let middle = 0.5 * (ends[0] + ends[1]);
            let surface = deepest(&surfaces, even.at(middle));
            let part = EngagedArc {
                entry: ends[0],
                exit: ends[1],
            };
            let chip = Chip {
                across: surface.before * even.across,
                along: surface.before * even.along + surface.lead,
            };
            (chip.at(middle) >= 0.0).then_some((part, chip))
        });
        cut.collect()
    }

    /// The surfaces that the teeth before tooth `tooth` left: the one before, the second before, and so on to itself.
    fn surfaces(&self, tooth: u32) -> impl Iterator<Item = Surface> + '_ {
        let flutes = self.runout.len();
        let tooth = tooth as usize;
        (1..=flutes).map(move |before| Surface {
            before: before as f64,
            lead: (self.runout[tooth] - self.runout[(tooth + flutes - before) % flutes]) * self.sin_kappa,
        })
    }
}

/// The surface down to which a tooth cuts where even teeth cut `even`.
fn deepest(surfaces: &[Surface], even: f64) -> Surface {
    let nearer = |a: Surface, b: &Surface| if b.depth(even) < a.depth(even) { *b } else { a };
    surfaces[1..].iter().fold(surfaces[0], nearer)
}

/// Thicknesses of even chips up to `most` at which a tooth begins to cut, and at which it cuts down to another surface, rising; m.
fn changes(surfaces: &[Surface], most: f64) -> Vec<f64> {
    let begins = |surface: &Surface| -surface.lead / surface.before;
    let begin = surfaces.iter().map(begins).fold(f64::NEG_INFINITY, f64::max);
    let mut changes = vec![begin];
    // Of surfaces that a tooth reaches at once it follows the one of the nearest tooth, which comes first.
    let first = surfaces.iter().find(|surface| begins(surface) == begin);
    let mut followed = first.map_or(surfaces[0], |surface| *surface);
    loop {
        let meets = |other: &Surface| (other.lead - followed.lead) / (followed.before - other.before);
        let nearer = surfaces.iter().take_while(|other| other.before < followed.before);
        let Some(next) = nearer.min_by(|a, b| meets(a).total_cmp(&meets(b))) else {
            return changes;
        };
        if meets(next) > most {
            return changes;
        }
        changes.push(meets(next));
        followed = *next;
    }
}

/// Angles inside `arc` at which `chip` has this thickness, rad.
fn angles(chip: Chip, thickness: f64, arc: EngagedArc) -> impl Iterator<Item = f64> {
    let sine = (thickness - chip.along) / chip.across;
    let both = if sine.abs() < 1.0 {
        vec![sine.asin(), PI - sine.asin()]
    } else {
        Vec::new()
    };
    let after_entry = move |phi: f64| phi + TAU * ((arc.entry - phi) / TAU).ceil();
    both.into_iter()
        .map(after_entry)
        .filter(move |phi| *phi < arc.exit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::Runout;
    use proptest::prelude::*;

    fn teeth(flutes: u32, offset: f64) -> TeethAt {
        let runout = Runout { offset, angle: 0.3 };
        let cutter = Cutter::flat(16e-3, flutes).unwrap().with_runout(runout).unwrap();
        TeethAt::new(&cutter, &cutter.at_height(0.0))
    }

    #[test]
    fn teeth_that_run_true_cut_evenly_over_the_whole_arc() {
        let true_running = teeth(4, 0.0);
        let even = Chip {
            across: 1e-4,
            along: 2e-5,
        };
        let arc = EngagedArc {
            entry: 0.2,
            exit: 2.0,
        };
        assert_eq!(true_running.chip(3, 7e-5), 7e-5);
        assert_eq!(true_running.cuts(3, even, arc), [(arc, even)]);
    }

    #[test]
    fn a_tooth_that_is_far_inside_cuts_nothing_and_the_farthest_its_own_surface() {
        let two = teeth(2, 50e-6);
        let even = Chip {
            across: 20e-6,
            along: 0.0,
        };
        let arc = EngagedArc {
            entry: 0.5,
            exit: 2.5,
        };
        // 96 um apart, far more than two chips of 20 um: one tooth cuts the chips of both.
        assert_eq!(two.cuts(1, even, arc), []);
        let both = Chip {
            across: 40e-6,
            along: 0.0,
        };
        assert_eq!(two.cuts(0, even, arc), [(arc, both)]);
    }

    #[test]
    fn an_edge_that_rubs_without_feed_touches_with_its_farthest_tooth() {
        let still = Chip {
            across: 0.0,
            along: 0.0,
        };
        let arc = EngagedArc {
            entry: 0.5,
            exit: 2.5,
        };
        let four = teeth(4, 20e-6);
        let touching: Vec<u32> = (0..4)
            .filter(|tooth| !four.cuts(*tooth, still, arc).is_empty())
            .collect();
        assert_eq!(touching, [0]);
    }

    proptest! {
        #[test]
        fn parts_have_the_chip_of_every_angle_in_them_and_the_rest_of_the_arc_none(
            flutes in 1_u32..9,
            offset in 1e-6..4e-4_f64,
            across in 0.0..3e-4_f64,
            along in -1e-4..1e-4_f64,
            entry in -7.0..7.0_f64,
            length in 0.1..6.2_f64,
        ) {
            let teeth = teeth(flutes, offset);
            let (even, arc) = (Chip { across, along }, EngagedArc { entry, exit: entry + length });
            for tooth in 0..flutes {
                let parts = teeth.cuts(tooth, even, arc);
                for k in 0..200 {
                    let phi = entry + length * (f64::from(k) + 0.5) / 200.0;
                    let thickness = teeth.chip(tooth, even.at(phi));
                    let found = parts.iter().find(|(part, _)| part.contains(phi));
                    match found {
                        // Lengths below 4 mm, a few roundings.
                        Some((_, chip)) => prop_assert!((chip.at(phi) - thickness).abs() < 1e-17 * 4e2, "{phi}: {chip:?} {thickness}"),
                        None => prop_assert!(thickness < 1e-17 * 4e2, "{phi}: {thickness}"),
                    }
                }
            }
        }
    }
}
