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
}

impl Engagement {
    /// The engagement of a tool of this `diameter` (m).
    ///
    /// # Errors
    /// A radial depth that is not above zero or beyond the diameter.
    pub fn of(immersion: Immersion, diameter: f64) -> Result<Engagement, CuttingError> {
        let radius = diameter / 2.0;
        let depth = |ae: f64| {
            // The least positive number: zero is not a valid radial depth.
            checked("radial depth of cut", ae, [f64::MIN_POSITIVE, diameter], "m")
        };
        Ok(match immersion {
            Immersion::Up(ae) => Engagement {
                right: radius - depth(ae)?,
                left: radius,
            },
            Immersion::Down(ae) => Engagement {
                right: -radius,
                left: depth(ae)? - radius,
            },
            Immersion::Centred(ae) => Engagement {
                right: -depth(ae)? / 2.0,
                left: ae / 2.0,
            },
            Immersion::Slot => Engagement {
                right: -radius,
                left: radius,
            },
        })
    }

    /// The engagement of `cutter` in a cut of this axial `depth` (m).
    ///
    /// A tool that cuts only with its rounded corner is no wider than there: the radial depth is measured from the
    /// widest engaged circle, and a part that reaches beyond it extends to the rim of the tool.
    ///
    /// # Errors
    /// As [`Engagement::of`].
    pub fn at_depth(immersion: Immersion, cutter: &Cutter, depth: f64) -> Result<Engagement, CuttingError> {
        let given = Engagement::of(immersion, cutter.diameter())?;
        let (radius, widest) = (cutter.radius(), cutter.at_height(depth).radius);
        let narrower = radius - widest;
        let reaches = |y: f64| if y >= widest { radius } else { y };
        Ok(match immersion {
            Immersion::Up(_) => Engagement {
                right: -reaches(-(given.right - narrower)),
                left: radius,
            },
            Immersion::Down(_) => Engagement {
                right: -radius,
                left: reaches(given.left + narrower),
            },
            Immersion::Centred(_) | Immersion::Slot => given,
        })
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
        Ok(Engagement { right, left })
    }

    /// The strip that a tool of this `radius` (m) cuts when it is displaced by `cross` (m) to the left; `None` if
    /// that takes it past the strip. A strip that reaches the rim continues beyond it.
    pub fn deflected(&self, cross: f64, radius: f64) -> Option<Engagement> {
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
        (right < left).then_some(Engagement { right, left })
    }

    /// The strip made `width` (m) wide before a tool of this radius that is `widest` (m) where it cuts: from there
    /// inwards, if it reaches a rim, else about its middle, as far as the tool goes. `None` if nothing is left.
    pub fn of_width(&self, width: f64, [widest, radius]: [f64; 2]) -> Option<Engagement> {
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

    /// Right and left edge of the strip, m to the left of the tool axis.
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
        let outside = radius <= 0.0 || self.right >= radius || self.left <= -radius;
        let arc = (!outside).then(|| EngagedArc {
            entry: angle(self.left),
            exit: angle(self.right),
        })?;
        (arc.exit > arc.entry).then_some(arc)
    }

    /// The radii at which the arc begins or ceases to depend on the radius: it has a kink there.
    pub(super) fn kinks(&self) -> [f64; 2] {
        [self.right.abs(), self.left.abs()]
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
    fn the_radial_depth_of_a_shallow_ball_is_measured_from_its_cutting_circle() {
        let ball = Cutter::ball(10.0 * MM, 2).unwrap();
        // At 0.2 mm the circle of a ball of 5 mm has a radius of sqrt(2 5 0.2 - 0.2^2) mm = 1.4 mm.
        let at = |immersion| Engagement::at_depth(immersion, &ball, 0.2 * MM).unwrap();
        let met = |immersion| at(immersion).arc_at(1.4 * MM).map(|arc| [arc.entry, arc.exit]);
        let immersion = (1.0 - 0.5 / 1.4_f64).acos();
        let [entry, exit] = met(Immersion::Up(0.5 * MM)).unwrap();
        assert!(entry == 0.0 && (exit - immersion).abs() < 1e-12);
        let [entry, exit] = met(Immersion::Down(0.5 * MM)).unwrap();
        assert!((entry - (PI - immersion)).abs() < 1e-12 && exit == PI);
        // Wider than the circle is all of it: a slot.
        for all in [
            Immersion::Up(5.0 * MM),
            Immersion::Down(2.9 * MM),
            Immersion::Slot,
        ] {
            assert_eq!(at(all).edges(), [-5.0 * MM, 5.0 * MM], "{all:?}");
        }
        let rib = at(Immersion::Centred(MM));
        assert_eq!(rib, Engagement::of(Immersion::Centred(MM), 10.0 * MM).unwrap());
        assert!(Engagement::at_depth(Immersion::Up(10.1 * MM), &ball, MM).is_err());
    }

    #[test]
    fn above_the_corner_and_on_a_flat_end_mill_the_depth_changes_nothing() {
        let nose = Cutter::bull_nose(10.0 * MM, 2.0 * MM, 2).unwrap();
        let flat = Cutter::flat(10.0 * MM, 2).unwrap();
        for ae in [0.1, 3.0, 5.0, 10.0].map(|ae| ae * MM) {
            for immersion in [Immersion::Up(ae), Immersion::Down(ae), Immersion::Centred(ae)] {
                let plain = Engagement::of(immersion, 10.0 * MM);
                assert_eq!(Engagement::at_depth(immersion, &nose, 2.0 * MM), plain);
                assert_eq!(Engagement::at_depth(immersion, &flat, 0.01 * MM), plain);
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
