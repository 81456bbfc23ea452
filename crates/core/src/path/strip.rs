//! The strip of material ahead of a cutter, from the cells of a stock that it enters for the first time.
//!
//! The cutter is a stack of discs: one for a flat end mill, a few up to the height of the material for any other. The
//! front of a disc at its last two pitches of the step sweeps new cells between two arcs. Each cell shows whether there
//! is material above the disc, at its distance `y` from the axis. A strip without a cell uses its neighbours; the
//! outermost ones extend to the edge of the disc. A pass along a finished wall therefore finds nothing, and a slot is
//! full from 0 to 180 deg.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `y` | distance to the left of the tool axis | m |
//! | `rho` | radius of the cutter at its highest engaged point; `R` of a flat one | m |
//!
//! Edges of the strip have an error of half a pitch plus the width of a strip, a quarter of a pitch; straight ahead
//! that is an angle of `pitch/R`, at the sides one of `sqrt(2 pitch/R)`, where chips are thin. A step shorter than two
//! pitches detects material up to two pitches early. For a longer step the engagement is that of its end. A radial
//! depth below a pitch may be missed, and on a ramp down the descent over two pitches. The feed is the chord of a step
//! of two pitches or more, otherwise the direction of the point: round a bend of radius `r` short steps detect up to `2
//! pitch^2/r` of a finished wall.
//!
//! Source: ours \[derived\].

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Point2, Point3, Vector2};

use super::pass::Pass;
use super::stock::Stock;
use crate::load::{EndMillBody, Engagement};

/// Position and direction of the tool at the end of a step.
pub(super) struct Heading {
    at: Point3<f64>,
    /// Unit vector, seen from above; `None` where the tool goes straight down or up.
    feed: Option<Vector2<f64>>,
    /// From the point before, seen from above, m.
    chord: Vector2<f64>,
    /// Its length, m.
    step: f64,
    /// Rise per distance seen from above, negative where the tool goes down.
    slope: f64,
    dives: bool,
}

/// The widest strip of material in front of the cutter.
pub(super) struct StripAhead {
    /// A strip that reaches the rim at its own height continues beyond it.
    pub(super) strip: Engagement,
    /// Across the feed, at its own height, m.
    pub(super) width: f64,
    /// Largest depth, m.
    pub(super) depth: f64,
    /// Whether it fills the cutter at its height, to a pitch.
    pub(super) is_slot: bool,
}

/// Pitches between the two arcs: less, and cells straight ahead could be missed; more, and corners are seen early.
const WINDOW_PITCHES: f64 = 2.0;

/// Strips per pitch.
const STRIPS_A_PITCH: f64 = 4.0;

/// Maximum number of strips: a cutter that needs more gets wider ones.
const MOST_STRIPS: f64 = 4096.0;

/// Discs of a cutter with a rounded bottom, up to the height of the material: the widest disc is then within a twelfth
/// of the engaged radius.
const DISCS: usize = 6;

/// Smallest height of material, m: a micrometre, far below any chip, far above the rounding of heights.
pub(super) const LEAST_HEIGHT: f64 = 1e-6;

/// Fraction of a radius that keeps rounding away from cells on the rim itself.
const RIM: f64 = 1e-9;

/// Below this fraction of its length the feed has no direction seen from above.
const NO_FEED: f64 = 1e-6;

impl Heading {
    pub(super) fn of(pass: &Pass) -> Heading {
        let across = pass.direction.xy();
        let chord = (pass.to - pass.from).xy();
        Heading {
            at: pass.to,
            feed: across.try_normalize(NO_FEED),
            chord,
            step: chord.norm(),
            slope: pass.direction.z / across.norm().max(NO_FEED),
            dives: -pass.direction.z > across.norm(),
        }
    }

    /// Whether the tool goes down steeper than along.
    pub(super) fn dives(&self) -> bool {
        self.dives
    }
}

/// One disc of the cutter.
#[derive(Clone, Copy)]
struct Disc {
    radius: f64,
    /// Of the part of the cutter that it represents, m.
    outer_radius: f64,
    /// Path z of its bottom, m.
    bottom: f64,
    /// Path z at the start of the part of the cutter that it represents, m.
    begins: f64,
}

/// Material ahead of a strip: path z of its top, m, or one of two values below any. The largest value of a strip is
/// used.
type Sight = f64;

/// No material.
const AIR: Sight = f64::MIN;

/// No cell of the strip is new.
const UNSEEN: Sight = f64::NEG_INFINITY;

/// A strip that is engaged.
#[derive(Clone, Copy)]
struct Strip {
    top: f64,
    begins: f64,
    outer_radius: f64,
}

/// The widest strip of material ahead; `None` if there is none, it has no width, or the tool dives.
pub(super) fn strip_ahead(stock: &Stock, heading: &Heading, cutter: &EndMillBody) -> Option<StripAhead> {
    let (radius, pitch) = (cutter.radius(), stock.pitch());
    let given = heading.feed.filter(|_| !heading.dives)?;
    // Where the window is within the step it follows the chord, as the cutter that removes the material does.
    let follows = heading.step >= WINDOW_PITCHES * pitch;
    let feed = if follows {
        heading.chord / heading.step
    } else {
        given
    };
    let count = (2.0 * radius * STRIPS_A_PITCH / pitch)
        .ceil()
        .clamp(8.0, MOST_STRIPS);
    let width = 2.0 * radius / count;
    let mut strips: Vec<Option<Strip>> = vec![None; count as usize];
    let mut sights = vec![UNSEEN; strips.len()];
    for disc in discs(stock, heading, cutter) {
        // Beyond the disc its strips are not valid.
        let beyond = ((radius - disc.outer_radius) / width).round() as usize;
        let within = beyond..strips.len().saturating_sub(beyond);
        let Some(strips) = strips.get_mut(within.clone()) else {
            continue;
        };
        sights.fill(UNSEEN);
        look(stock, heading, feed, &disc, |y, sight| {
            let index = ((y + radius) / width) as u32;
            if let Some(seen) = sights.get_mut(index as usize) {
                *seen = if sight > *seen { sight } else { *seen };
            }
        });
        let sights = &mut sights[within];
        take_after_neighbours(sights);
        for (strip, &mut top) in strips.iter_mut().zip(sights) {
            if top > AIR {
                let lower = strip.get_or_insert(Strip {
                    top,
                    begins: disc.begins,
                    outer_radius: disc.outer_radius,
                });
                lower.top = lower.top.max(top);
                lower.outer_radius = disc.outer_radius;
            }
        }
    }
    longest_arc(stock, &strips, [radius, width])
}

/// The discs that represent a cutter in material of this height, from the tip upwards.
fn discs(stock: &Stock, heading: &Heading, cutter: &EndMillBody) -> Vec<Disc> {
    // On a climb, material detected early is cut by a tip that has risen until then. On a ramp down, the height left by
    // the first arc next to the second is not material.
    let window = WINDOW_PITCHES * stock.pitch();
    let early = (window - heading.step).max(0.0);
    let tip = heading.at.z + heading.slope.max(0.0) * early;
    let left = (-heading.slope).max(0.0) * heading.step.min(window);
    let (radius, flat) = (cutter.radius(), cutter.flat_radius());
    if flat == radius {
        return vec![Disc {
            radius,
            outer_radius: radius,
            bottom: tip + left,
            begins: tip,
        }];
    }
    let up = stock.highest_about(heading.at.xy(), radius + window) - tip;
    if up <= left + LEAST_HEIGHT {
        return Vec::new();
    }
    let widest = cutter.radius_at(up);
    let part = (widest - flat) / DISCS as f64;
    let mut discs: Vec<Disc> = (0..DISCS)
        .map(|k| {
            let inner = flat + part * k as f64;
            Disc {
                radius: inner + 0.5 * part,
                outer_radius: inner + part,
                bottom: tip + left + cutter.height(inner + 0.5 * part),
                begins: tip + cutter.height(inner),
            }
        })
        .collect();
    if up > cutter.corner_radius() {
        let begins = tip + cutter.corner_radius();
        discs.push(Disc {
            radius,
            outer_radius: radius,
            bottom: begins + left,
            begins,
        });
    }
    discs
}

/// Calls `out` for the new cells in front of a disc: distance left of the axis (m), and the material there above the
/// disc.
fn look(stock: &Stock, heading: &Heading, feed: Vector2<f64>, disc: &Disc, mut out: impl FnMut(f64, Sight)) {
    let left = Vector2::new(-feed.y, feed.x);
    let (pitch, radius) = (stock.pitch(), disc.radius);
    let window = WINDOW_PITCHES * pitch;
    let first: Point2<f64> = heading.at.xy() - feed * heading.step.min(window);
    let inside_squared = (radius * (1.0 - RIM)).powi(2);
    // Two positions per pitch along the arc, on two arcs between the first and the last.
    let count = (2.0 * PI * radius / pitch).ceil().clamp(8.0, MOST_STRIPS);
    let (turn_sin, turn_cos) = (PI / count).sin_cos();
    let (mut sin, mut cos) = (FRAC_PI_2 / count).sin_cos();
    for _ in 0..count as usize {
        for part in [0.25, 0.75] {
            let at = first + feed * (radius * sin + part * window) + left * (radius * cos);
            // Outside the box there is air.
            let (centre, height) = stock.cell_at(at).unwrap_or((at, 0.0));
            let off = centre - first;
            let (x, y) = (off.dot(&feed), off.dot(&left));
            let ahead = if x > window { x - window } else { 0.0 };
            // All of it without branches: the result is hard to predict, and a wrong prediction takes longer.
            let passed_before = (x <= 0.0) | (x * x + y * y <= radius * radius);
            if passed_before | (ahead * ahead + y * y >= inside_squared) {
                continue;
            }
            let height = f64::from(height);
            let top = stock.bottom() + height;
            let is_material = height > LEAST_HEIGHT && top > disc.bottom + LEAST_HEIGHT;
            out(y, if is_material { top } else { AIR });
        }
        (sin, cos) = (sin * turn_cos + cos * turn_sin, cos * turn_cos - sin * turn_sin);
    }
}

/// The longest run of engaged strips round the cutter of this radius; each has this width (m).
fn longest_arc(stock: &Stock, strips: &[Option<Strip>], [radius, width]: [f64; 2]) -> Option<StripAhead> {
    let mut longest: Option<(f64, StripAhead)> = None;
    let mut first = 0;
    for run in strips.chunk_by(|one, next| one.is_some() == next.is_some()) {
        let (begin, end) = (first, first + run.len());
        first = end;
        let engaged = || run.iter().flatten();
        let rho = engaged().fold(0.0, |most: f64, strip| most.max(strip.outer_radius));
        if rho <= 0.0 {
            continue;
        }
        // The outermost strip of a disc extends to its edge.
        let edge = |strip: usize| {
            let y = strip as f64 * width - radius;
            if rho - y.abs() < width { rho.copysign(y) } else { y }
        };
        let (right, left) = (edge(begin), edge(end));
        // A length: the tip of a ball may be engaged all round, next to a deep strip at its side.
        let arc = rho * ((right / rho).acos() - (left / rho).acos());
        let right_beyond = if right <= -rho { -radius } else { right };
        let left_beyond = if left >= rho { radius } else { left };
        let Ok(strip) = Engagement::strip([right_beyond, left_beyond], 2.0 * radius) else {
            continue;
        };
        let depth = engaged().map(|strip| strip.top - strip.begins.max(stock.bottom()));
        let full = rho - stock.pitch();
        let front = StripAhead {
            strip,
            width: left - right,
            depth: depth.fold(0.0, f64::max),
            is_slot: left >= full && right <= -full,
        };
        if longest.as_ref().is_none_or(|(most, _)| arc > *most) {
            longest = Some((arc, front));
        }
    }
    longest.map(|(_, front)| front)
}

/// Strips without a cell use the nearest strip that has one; the left one of two at the same distance.
fn take_after_neighbours(sights: &mut [Sight]) {
    let mut known: Option<usize> = None;
    for index in 0..=sights.len() {
        let next = sights.get(index).copied();
        if next == Some(UNSEEN) {
            continue;
        }
        let before = known.map(|known| sights[known]);
        let first = known.map_or(0, |known| known + 1);
        let gap = index - first;
        for (k, sight) in sights[first..index].iter_mut().enumerate() {
            let nearer = if 2 * k < gap {
                before.or(next)
            } else {
                next.or(before)
            };
            *sight = nearer.unwrap_or(UNSEEN);
        }
        known = Some(index);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Unit, Vector3};

    fn pass(direction: [f64; 3]) -> Pass {
        Pass {
            from: Point3::new(1.0, 2.0, 3.0),
            to: Point3::new(1.3, 2.4, 3.0),
            direction: Unit::new_normalize(Vector3::from(direction)),
            axis: Vector3::z_axis(),
        }
    }

    #[test]
    fn a_tool_that_goes_down_steeper_than_along_dives() {
        for (direction, dives) in [
            ([1.0, 0.0, 0.0], false),
            ([0.0, 1.0, -0.99], false),
            ([0.6, 0.8, -1.01], true),
            ([0.0, 0.0, -1.0], true),
            ([0.0, 0.0, 1.0], false),
        ] {
            let heading = Heading::of(&pass(direction));
            assert_eq!(heading.dives(), dives, "{direction:?}");
            assert!((heading.step - 0.5).abs() < 1e-15);
        }
        assert!(Heading::of(&pass([0.0, 0.0, 1.0])).feed.is_none());
        assert!((Heading::of(&pass([3.0, 4.0, -2.5])).slope + 0.5).abs() < 1e-15);
    }

    #[test]
    fn strips_without_a_cell_use_the_nearest_with_one() {
        let (a, b) = (1.0, 2.0);
        for (mut sights, expected) in [
            (vec![UNSEEN, a, UNSEEN, UNSEEN, b, UNSEEN], vec![a, a, a, b, b, b]),
            (vec![a, UNSEEN, UNSEEN, UNSEEN, AIR], vec![a, a, a, AIR, AIR]),
            (vec![UNSEEN, UNSEEN, b], vec![b; 3]),
            (vec![UNSEEN; 3], vec![UNSEEN; 3]),
            (vec![a, AIR, b], vec![a, AIR, b]),
            (vec![], vec![]),
        ] {
            take_after_neighbours(&mut sights);
            assert_eq!(sights, expected);
        }
    }

    #[test]
    fn of_several_runs_the_one_with_the_longest_arc_is_reported_with_its_own_depth() {
        let corners = [Point3::new(0.0, 0.0, -0.02), Point3::new(0.01, 0.01, 0.0)];
        let stock = Stock::new(corners, 1e-3).unwrap();
        let strip = |top: f64| {
            Some(Strip {
                top,
                begins: -0.004,
                outer_radius: 5e-3,
            })
        };
        // Ten strips of a millimetre from the right: two at the rim there, three in the middle.
        let mut strips = vec![None; 10];
        (strips[0], strips[1]) = (strip(-0.003), strip(-0.002));
        (strips[4], strips[5], strips[6]) = (strip(0.0), strip(-0.001), strip(-0.001));
        let front = longest_arc(&stock, &strips, [5e-3, 1e-3]).unwrap();
        // At the rim two strips are passed over acos(0.6) = 53 deg, three in the middle over 35 deg.
        let [right, left] = front.strip.edges();
        assert!(right == -5e-3 && (left + 3e-3).abs() < 1e-12, "{right} {left}");
        assert!((front.depth - 0.002).abs() < 1e-12 && (front.width - 2e-3).abs() < 1e-12);
        assert!(!front.is_slot);
        // Of a ball: a millimetre at its tip over a quarter of a turn, and two at its side, where the circle is five times as large, over 53 deg.
        let mut strips = vec![None; 10];
        (strips[0], strips[1]) = (strip(-0.003), strip(-0.002));
        strips[4] = strip(-0.003).map(|tip| Strip {
            outer_radius: 1e-3,
            ..tip
        });
        let front = longest_arc(&stock, &strips, [5e-3, 1e-3]).unwrap();
        assert!(front.strip.edges()[0] == -5e-3 && (front.depth - 0.002).abs() < 1e-12);
        let all = longest_arc(&stock, &[strip(0.0); 10], [5e-3, 1e-3]).unwrap();
        assert!(all.is_slot && all.strip.edges() == [-5e-3, 5e-3]);
        assert!(longest_arc(&stock, &[None; 10], [5e-3, 1e-3]).is_none());
    }
}
