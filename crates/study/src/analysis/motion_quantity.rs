//! Quantities of a point of a path in motion.

use crate::analysis::quantity_entry::{Origin, Quantity};

/// Where the motion comes from.
const MOTION: Origin = Origin {
    file: "core/src/motion/along.rs",
    function: "motion_along",
    theory: Some("motion"),
    validation: Some("irb6640-logs"),
};

const fn of_motion(key: &'static str, unit: &'static str, decimals: u8, words: &'static str) -> Quantity {
    Quantity {
        key,
        unit: Some(unit),
        decimals,
        words,
        origin: Some(MOTION),
    }
}

/// Time at a point.
pub const TIME: Quantity = of_motion(
    "time_s",
    "s",
    4,
    "time at which the command is at the point, from the first one",
);
/// Actual speed.
pub const SPEED: Quantity = of_motion("speed_mm_per_s", "mm/s", 3, "speed of the command at the point");
/// Part of the programmed feed.
pub const FEED_REACHED: Quantity = Quantity {
    unit: None,
    ..of_motion(
        "feed_reached",
        "",
        4,
        "speed of the command over the programmed feed",
    )
};
/// Rounded corners.
pub const BLENDING: Quantity = of_motion(
    "blending_um",
    "um",
    3,
    "distance of the commanded path from the programmed point, by the zone of a corner",
);
/// Joints that follow late.
pub const SERVO: Quantity = Quantity {
    origin: Some(Origin {
        validation: None,
        ..MOTION
    }),
    ..of_motion(
        "servo_um",
        "um",
        3,
        "distance of the path that is followed from the commanded one, across it: joints follow late",
    )
};
