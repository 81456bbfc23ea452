//! Engagement: the angles at which the teeth cut, and the chip thickness there.
//!
//! Seen from the spindle, feed upwards on this page:
//!
//! ```text
//!             x, feed                     phi counts clockwise, as the spindle turns, from the left (+y).
//!           phi = 90 deg                  A tooth in front of the tool (0 to 180 deg) makes a chip of
//!               |                         c sin(phi): none at the sides, most straight ahead.
//!   y  phi = 0 -+- phi = 180 deg
//!               |                         Part on the left: teeth enter at 0, thin chip first: up-milling.
//!              tool                       Part on the right: teeth leave at 180 deg: down-milling.
//! ```
//!
//! The part fills a strip in front of the tool, given by its position to the left of the axis. At the radius `R` of a
//! point of the edge `y = R cos(phi)`, so
//!
//! ```text
//! up:       entry = 0                       exit = acos((R - ae)/R)
//! down:     entry = 180 deg - that          exit = 180 deg
//! centred:  entry = acos(ae/(2 R))          exit = 180 deg - entry
//! c = f / (n N) = 2 pi v / (omega N)        h = c sin(phi),   mean h = c (cos entry - cos exit)/(exit - entry)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `phi` | immersion angle of a tooth | rad |
//! | `ae` | radial depth of cut | m |
//! | `c` | feed per tooth | m |
//! | `v`, `omega`, `N` | feed speed, spindle speed, number of flutes | m/s, rad/s, - |
//! | `h` | chip thickness | m |
//!
//! The side of the material that a ball or a bull nose end mill leaves is no wall: the pass before, of the same tool at the
//! distance `ae` on the same level, left its own profile. At every height the strip is therefore `ae` wide, where the
//! tool is not narrower than that:
//!
//! ```text
//! up:       right edge = R(z) - ae          down:    left edge = ae - R(z)          slot at R(z) < ae/2
//! ```
//!
//! Teeth run on circles: the trochoid that they really run on changes the chip by some `N c/(2 pi R)` of itself.
//!
//! Source: plane geometry; `docs/theory/cutting.md`.

use std::f64::consts::TAU;

use super::arc::EngagedArc;
use super::cutter::Cutter;
use super::error::{CuttingError, checked};

/// How the tool engages the part, seen along the feed; the spindle turns clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Immersion {
    /// Part on the left of the feed, radial depth (m): chips begin thin.
    Up(f64),
    /// Part on the right of the feed, radial depth (m): chips end thin.
    Down(f64),
    /// A strip of this width (m) in the middle of the tool.
    Centred(f64),
    /// The whole width of the tool.
    Slot,
}

/// The strip of part that the tool moves into, by its distances to the left of the tool axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engagement {
    /// Where it begins on the right, m; negative right of the axis.
    right: f64,
    /// Where it ends on the left, m.
    left: f64,
    /// Of a strip whose inner side is the profile that the pass before left: how far to the left of this pass it was, m;
    /// its edges are those at the widest circle of the tool. `None` if both sides are walls along the feed.
    pass_before: Option<f64>,
}

impl Engagement {
    /// The engagement of a tool of this `diameter` (m) with walls along the feed.
    ///
    /// # Errors
    /// A radial depth that is not above zero or beyond the diameter.
    pub fn of(immersion: Immersion, diameter: f64) -> Result<Engagement, CuttingError> {
        let radius = diameter / 2.0;
        let depth = |ae: f64| {
            // The least positive number: zero is not a valid radial depth.
            checked("radial depth of cut", ae, [f64::MIN_POSITIVE, diameter], "m")
        };
        let [right, left] = match immersion {
            Immersion::Up(ae) => [radius - depth(ae)?, radius],
            Immersion::Down(ae) => [-radius, depth(ae)? - radius],
            Immersion::Centred(ae) => [-depth(ae)? / 2.0, ae / 2.0],
            Immersion::Slot => [-radius, radius],
        };
        Ok(Engagement::between_walls([right, left]))
    }

    fn between_walls([right, left]: [f64; 2]) -> Engagement {
        Engagement {
            right,
            left,
            pass_before: None,
        }
    }

    /// Next to a pass of the same tool of this `radius` (m) that was `displaced` (m) to the left; `None` if there is nothing
    /// between them.
    fn next_to_pass(displaced: f64, radius: f64) -> Option<Engagement> {
        let [right, left] = match displaced < 0.0 {
            true => [(radius + displaced).max(-radius), radius],
            false => [-radius, (displaced - radius).min(radius)],
        };
        (right < left).then_some(Engagement {
            right,
            left,
            pass_before: Some(displaced),
        })
    }

    /// The engagement of `cutter` in a cut of this axial `depth` (m).
    ///
    /// Of a ball or bull nose end mill with material on one side, the other side is what the pass before left: the radial
    /// depth is its distance, the stepover. It is a wall for a flat end mill, where both are the same.
    ///
    /// # Errors
    /// As [`Engagement::of`].
    pub fn at_depth(immersion: Immersion, cutter: &Cutter, depth: f64) -> Result<Engagement, CuttingError> {
        let walls = Engagement::of(immersion, cutter.diameter())?;
        let displaced = match immersion {
            Immersion::Up(ae) => -ae,
            Immersion::Down(ae) => ae,
            Immersion::Centred(_) | Immersion::Slot => return Ok(walls),
        };
        if cutter.corner_radius() == 0.0 {
            return Ok(walls);
        }
        // Farther than the tool is wide where it cuts: a slot.
        if displaced.abs() >= 2.0 * cutter.at_height(depth).radius {
            return Engagement::of(Immersion::Slot, cutter.diameter());
        }
        Ok(Engagement::next_to_pass(displaced, cutter.radius()).unwrap_or(walls))
    }

    /// The strip from `right` to `left` (m, to the left of the tool axis) before a tool of this `diameter` (m);
    /// material beyond the tool is ignored.
    ///
    /// # Errors
    /// Numbers that are not finite, a strip without width.
    pub fn strip([right, left]: [f64; 2], diameter: f64) -> Result<Engagement, CuttingError> {
        let radius = diameter / 2.0;
        checked("strip of material, left", left, [-f64::MAX, f64::MAX], "m")?;
        checked("strip of material, right", right, [-f64::MAX, left], "m")?;
        let (right, left) = (right.max(-radius), left.min(radius));
        checked(
            "width of the strip",
            left - right,
            [f64::MIN_POSITIVE, diameter],
            "m",
        )?;
        Ok(Engagement::between_walls([right, left]))
    }

    /// The strip that a tool of this `radius` (m) cuts when it is displaced by `cross` (m) to the left; `None` if
    /// that takes it past the strip. A strip that reaches the rim continues beyond it; the pass before is where it was.
    pub fn deflected(&self, cross: f64, radius: f64) -> Option<Engagement> {
        if let Some(displaced) = self.pass_before {
            let moved = displaced - cross;
            let is_between = moved * displaced > 0.0;
            return is_between
                .then(|| Engagement::next_to_pass(moved, radius))
                .flatten();
        }
        let left = if self.left >= radius {
            radius
        } else {
            (self.left - cross).min(radius)
        };
        let right = if self.right <= -radius {
            -radius
        } else {
            (self.right - cross).max(-radius)
        };
        (right < left).then_some(Engagement::between_walls([right, left]))
    }

    /// The strip made `width` (m) wide before a tool of this radius that is `widest` (m) where it cuts: from there
    /// inwards, if it reaches a rim, else about its middle, as far as the tool goes; next to a pass before, with that at this
    /// distance. `None` if nothing is left.
    pub fn of_width(&self, width: f64, [widest, radius]: [f64; 2]) -> Option<Engagement> {
        if let Some(displaced) = self.pass_before {
            return Engagement::next_to_pass(width.copysign(displaced), radius).filter(|_| width > 0.0);
        }
        let [right, left] = if self.left >= radius {
            [widest - width, radius]
        } else if self.right <= -radius {
            [-radius, width - widest]
        } else {
            let middle = 0.5 * (self.left + self.right);
            [middle - 0.5 * width, middle + 0.5 * width]
        };
        Engagement::strip([right, left], 2.0 * radius).ok()
    }

    /// The same with edges rounded to multiples of `step` (m) for a tool of this `radius` (m); a strip thinner than a step keeps
    /// its edges.
    #[must_use]
    pub(super) fn rounded(&self, step: f64, radius: f64) -> Engagement {
        let nearest = |value: f64| (value / step).round() * step;
        let rounded = match self.pass_before {
            Some(displaced) => Some(nearest(displaced))
                .filter(|displaced| *displaced != 0.0)
                .and_then(|displaced| Engagement::next_to_pass(displaced, radius)),
            None => {
                let edges = self.edges().map(|edge| nearest(edge).clamp(-radius, radius));
                Engagement::strip(edges, 2.0 * radius).ok()
            }
        };
        rounded.unwrap_or(*self)
    }

    /// How far to the left of this pass the one before was, m, if its profile is the side of the strip.
    pub fn pass_before(&self) -> Option<f64> {
        self.pass_before
    }

    /// Right and left edge of the strip, m to the left of the tool axis; next to a pass before those at the widest circle of
    /// the tool.
    pub fn edges(&self) -> [f64; 2] {
        [self.right, self.left]
    }

    /// Width of the strip across the feed, m.
    pub fn width(&self) -> f64 {
        self.left - self.right
    }

    /// Where a point of the edge at `radius` (m) cuts; `None` if it passes outside the strip.
    pub fn arc_at(&self, radius: f64) -> Option<EngagedArc> {
        let angle = |y: f64| (y / radius).clamp(-1.0, 1.0).acos();
        let [right, left] = match self.pass_before {
            None => [self.right, self.left],
            Some(displaced) if displaced < 0.0 => [radius + displaced, radius],
            Some(displaced) => [-radius, displaced - radius],
        };
        let outside = radius <= 0.0 || right >= radius || left <= -radius;
        let arc = (!outside).then(|| EngagedArc {
            entry: angle(left),
            exit: angle(right),
        })?;
        (arc.exit > arc.entry).then_some(arc)
    }

    /// The radii at which the arc begins or ceases to depend on the radius: it has a kink there.
    pub(super) fn kinks(&self) -> [f64; 2] {
        match self.pass_before {
            None => [self.right.abs(), self.left.abs()],
            Some(displaced) => [0.5 * displaced.abs(); 2],
        }
    }
}

/// Feed per tooth (m) from feed speed (m/s), spindle speed (rad/s) and number of flutes.
///
/// # Errors
/// A spindle at rest or turning backwards, a negative feed, no flute.
pub fn feed_per_tooth(feed: f64, spindle: f64, flutes: u32) -> Result<f64, CuttingError> {
    checked("feed speed", feed, [0.0, f64::MAX], "m/s")?;
    checked("spindle speed", spindle, [f64::MIN_POSITIVE, f64::MAX], "rad/s")?;
    checked("number of flutes", f64::from(flutes), [1.0, f64::MAX], "")?;
    checked(
        "feed per tooth",
        feed * TAU / (spindle * f64::from(flutes)),
        [0.0, f64::MAX],
        "m",
    )
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const MM: f64 = 1e-3;

    fn arc_deg(immersion: Immersion, diameter: f64) -> [f64; 2] {
        let arc = Engagement::of(immersion, diameter)
            .unwrap()
            .arc_at(diameter / 2.0)
            .unwrap();
        [arc.entry.to_degrees(), arc.exit.to_degrees()]
    }

    #[test]
    fn angles_of_the_published_cut() {
        // D 16 mm, ae 5 mm: acos(3/8) = 67.9757 deg, printed to four decimals.
        let [entry, exit] = arc_deg(Immersion::Up(5.0 * MM), 16.0 * MM);
        assert!(entry == 0.0 && (exit - 67.9757).abs() < 5e-5, "{entry} {exit}");
        let [entry, exit] = arc_deg(Immersion::Down(5.0 * MM), 16.0 * MM);
        assert!((entry - 112.0243).abs() < 5e-5 && exit == 180.0, "{entry} {exit}");
    }

    #[test]
    fn full_depth_from_either_side_is_a_slot() {
        for immersion in [
            Immersion::Up(0.01),
            Immersion::Down(0.01),
            Immersion::Centred(0.01),
            Immersion::Slot,
        ] {
            assert_eq!(arc_deg(immersion, 0.01), [0.0, 180.0], "{immersion:?}");
        }
    }

    #[test]
    fn a_centred_strip_of_half_the_width_is_cut_from_60_to_120_deg() {
        let [entry, exit] = arc_deg(Immersion::Centred(5.0 * MM), 10.0 * MM);
        assert!((entry - 60.0).abs() < 1e-12 && (exit - 120.0).abs() < 1e-12);
    }

    #[test]
    fn points_near_the_axis_pass_outside_a_shallow_strip() {
        let up = Engagement::of(Immersion::Up(MM), 10.0 * MM).unwrap();
        assert_eq!(up.arc_at(3.9 * MM), None);
        assert!(up.arc_at(4.1 * MM).is_some());
        let down = Engagement::of(Immersion::Down(MM), 10.0 * MM).unwrap();
        assert_eq!(down.arc_at(3.9 * MM), None);
        // More than half: points near the axis are in the part all the way.
        let deep = Engagement::of(Immersion::Up(7.0 * MM), 10.0 * MM).unwrap();
        assert_eq!(deep.arc_at(MM), Some(EngagedArc { entry: 0.0, exit: PI }));
    }

    #[test]
    fn feed_per_tooth_of_the_published_cut() {
        // 40 mm/s, 3333 rpm, 4 teeth: 0.180018 mm, printed to six decimals.
        let spindle = 3333.0 * TAU / 60.0;
        let c = feed_per_tooth(40.0 * MM, spindle, 4).unwrap();
        assert!((c / MM - 0.180018).abs() < 5e-7);
        assert!(feed_per_tooth(40.0 * MM, 0.0, 4).is_err());
        assert!(feed_per_tooth(-1.0, spindle, 4).is_err());
        assert!(feed_per_tooth(f64::MAX, f64::MIN_POSITIVE, 1).is_err());
    }

    #[test]
    fn a_displaced_tool_cuts_more_or_less_of_a_wall_and_all_of_a_slot() {
        let (diameter, radius) = (10.0 * MM, 5.0 * MM);
        let up = Engagement::of(Immersion::Up(2.0 * MM), diameter).unwrap();
        let down = Engagement::of(Immersion::Down(2.0 * MM), diameter).unwrap();
        let slot = Engagement::of(Immersion::Slot, diameter).unwrap();
        // Half a millimetre to the left: into a wall on the left, out of one on the right.
        let width = |strip: Engagement| strip.deflected(0.5 * MM, radius).map(|strip| strip.width() / MM);
        assert!((width(up).unwrap() - 2.5).abs() < 1e-12);
        assert!((width(down).unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(slot.deflected(0.5 * MM, radius), Some(slot));
        assert_eq!(down.deflected(2.0 * MM, radius), None);
        // A rib keeps its width until its edge passes the rim.
        let rib = Engagement::of(Immersion::Centred(2.0 * MM), diameter).unwrap();
        assert!((width(rib).unwrap() - 2.0).abs() < 1e-12);
        let outside = rib.deflected(-5.0 * MM, radius).unwrap();
        assert!((outside.width() - MM).abs() < 1e-15);
    }

    #[test]
    fn the_profile_of_the_pass_before_is_met_where_two_circles_at_a_height_intersect() {
        let ball = Cutter::ball(10.0 * MM, 2).unwrap();
        let (ae, depth) = (0.5 * MM, 0.2 * MM);
        for immersion in [Immersion::Up(ae), Immersion::Down(ae)] {
            let strip = Engagement::at_depth(immersion, &ball, depth).unwrap();
            for radius in [0.26, 0.4, 1.0, 1.4].map(|radius| radius * MM) {
                let arc = strip.arc_at(radius).unwrap();
                // At the side of the pass before a tooth is as far from its axis as the rim of that.
                let (is_up, inner) = match immersion {
                    Immersion::Up(_) => (1.0, arc.exit),
                    _ => (-1.0, arc.entry),
                };
                let beyond = radius * inner.cos() + is_up * ae;
                assert!((beyond - is_up * radius).abs() < 1e-15, "{immersion:?} {radius}");
            }
            // In the ridge between the two all is cut.
            assert_eq!(strip.arc_at(0.24 * MM), Some(EngagedArc { entry: 0.0, exit: PI }));
            assert!((strip.width() - ae).abs() < 1e-15);
        }
        // Farther than the tool is wide at this depth: 2.8 mm.
        let slot = Engagement::of(Immersion::Slot, 10.0 * MM).unwrap();
        assert_eq!(
            Engagement::at_depth(Immersion::Up(2.9 * MM), &ball, depth),
            Ok(slot)
        );
        assert_ne!(
            Engagement::at_depth(Immersion::Up(2.7 * MM), &ball, depth),
            Ok(slot)
        );
        assert!(Engagement::at_depth(Immersion::Up(10.1 * MM), &ball, depth).is_err());
    }

    #[test]
    fn a_tool_displaced_from_the_pass_before_has_another_stepover() {
        let nose = Cutter::bull_nose(10.0 * MM, 2.0 * MM, 2).unwrap();
        let stepover = |immersion: Immersion, cross: f64| {
            let strip = Engagement::at_depth(immersion, &nose, MM).unwrap();
            strip
                .deflected(cross * MM, 5.0 * MM)?
                .pass_before()
                .map(|displaced| displaced / MM)
        };
        assert!((stepover(Immersion::Up(2.0 * MM), 0.5).unwrap() + 2.5).abs() < 1e-12);
        assert!((stepover(Immersion::Down(2.0 * MM), 0.5).unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(stepover(Immersion::Down(2.0 * MM), 2.0), None);
        assert_eq!(stepover(Immersion::Up(2.0 * MM), -2.5), None);
        let strip = Engagement::at_depth(Immersion::Down(2.0 * MM), &nose, MM).unwrap();
        let wider = strip.of_width(3.0 * MM, [4.0 * MM, 5.0 * MM]).unwrap();
        assert_eq!(wider.pass_before(), Some(3.0 * MM));
        assert_eq!(strip.of_width(0.0, [4.0 * MM, 5.0 * MM]), None);
        assert_eq!(
            strip.rounded(0.7 * MM, 5.0 * MM).pass_before(),
            Some(3.0 * 0.7 * MM)
        );
        assert_eq!(strip.rounded(7.0 * MM, 5.0 * MM), strip);
    }

    #[test]
    fn on_the_cylinder_the_pass_before_left_a_wall_as_a_flat_end_mill_does() {
        let nose = Cutter::bull_nose(10.0 * MM, 2.0 * MM, 2).unwrap();
        let flat = Cutter::flat(10.0 * MM, 2).unwrap();
        for ae in [0.1, 3.0, 5.0, 10.0].map(|ae| ae * MM) {
            for immersion in [Immersion::Up(ae), Immersion::Down(ae), Immersion::Centred(ae)] {
                let plain = Engagement::of(immersion, 10.0 * MM).unwrap();
                let next = Engagement::at_depth(immersion, &nose, 2.0 * MM).unwrap();
                assert_eq!(next.edges(), plain.edges());
                assert_eq!(next.arc_at(5.0 * MM), plain.arc_at(5.0 * MM));
                assert_eq!(Engagement::at_depth(immersion, &flat, 0.01 * MM), Ok(plain));
            }
        }
    }

    #[test]
    fn a_strip_keeps_its_side_when_it_becomes_wider_and_is_measured_from_the_cutting_circle() {
        let (radius, diameter) = (5.0 * MM, 10.0 * MM);
        for (immersion, mirrored) in [(Immersion::Up(2.0 * MM), 1.0), (Immersion::Down(2.0 * MM), -1.0)] {
            let strip = Engagement::of(immersion, diameter).unwrap();
            let wider = strip.of_width(3.0 * MM, [radius, radius]).unwrap();
            assert!((wider.width() - 3.0 * MM).abs() < 1e-15);
            assert_eq!(
                wider
                    .edges()
                    .map(f64::abs)
                    .iter()
                    .fold(0.0, |a: f64, b| a.max(*b)),
                radius
            );
            let shallow = strip.of_width(MM, [1.4 * MM, radius]).unwrap();
            let arc = shallow.arc_at(1.4 * MM).unwrap();
            let middle = 0.5 * (arc.entry + arc.exit);
            assert!(
                mirrored * middle.cos() > 0.0
                    && ((arc.exit - arc.entry) - (1.0 - 1.0 / 1.4_f64).acos()).abs() < 1e-12
            );
        }
        let rib = Engagement::of(Immersion::Centred(MM), diameter).unwrap();
        assert_eq!(
            rib.of_width(4.0 * MM, [radius, radius]).unwrap().edges(),
            [-2.0 * MM, 2.0 * MM]
        );
        assert_eq!(rib.of_width(0.0, [radius, radius]), None);
    }

    #[test]
    fn a_strip_is_cut_off_at_the_rim_and_must_have_a_width() {
        let strip = Engagement::strip([3.0 * MM, 8.0 * MM], 10.0 * MM).unwrap();
        assert_eq!(strip, Engagement::of(Immersion::Up(2.0 * MM), 10.0 * MM).unwrap());
        for no_strip in [
            [MM, MM],
            [MM, 0.0],
            [6.0 * MM, 7.0 * MM],
            [f64::NAN, MM],
            [0.0, f64::INFINITY],
        ] {
            assert!(Engagement::strip(no_strip, 10.0 * MM).is_err(), "{no_strip:?}");
        }
    }

    #[test]
    fn no_depth_and_too_much_depth_are_refused() {
        for ae in [0.0, -MM, 10.1 * MM, f64::INFINITY] {
            assert!(Engagement::of(Immersion::Up(ae), 10.0 * MM).is_err(), "{ae}");
        }
    }
}
