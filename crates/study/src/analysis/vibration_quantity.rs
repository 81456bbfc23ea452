//! Quantities of the vibration at a point.

use crate::analysis::quantity_entry::{Origin, Quantity};

/// Frequency of the lowest mode.
pub const LOWEST_MODE: Quantity = Quantity {
    key: "lowest_mode_hz",
    unit: Some("Hz"),
    decimals: 3,
    words: "frequency of the lowest mode of the arm in this posture",
    origin: Some(Origin {
        file: "core/src/dynamics/modes.rs",
        function: "modes_of",
        theory: Some("modes"),
        validation: Some("planar-modes"),
    }),
};
/// Limit of the depth of cut.
pub const STABLE_DEPTH: Quantity = Quantity {
    key: "stable_depth_mm",
    unit: Some("mm"),
    decimals: 4,
    words: "depth of cut up to which the cut is stable at the programmed spindle speed; twice the diameter of the cutter or three times the depth, the greater, where it is deeper",
    origin: Some(Origin {
        file: "core/src/stability/lobes.rs",
        function: "StabilityLobes::at_speed",
        theory: Some("stability"),
        validation: Some("stability-lobes"),
    }),
};

/// A value of the vibration under the teeth.
const fn forced(key: &'static str, words: &'static str, function: &'static str) -> Quantity {
    Quantity {
        key,
        unit: Some("um"),
        decimals: 3,
        words,
        origin: Some(Origin {
            file: "core/src/stability/forced.rs",
            function,
            theory: Some("stability"),
            validation: None,
        }),
    }
}

/// Vibration across the tool.
pub const AMPLITUDE: Quantity = forced(
    "vibration_amplitude_um",
    "largest distance across the tool of the tip from its mean position, by the force of the teeth in a stable cut",
    "Forced::largest_in_plane",
);
/// Error of a wall.
pub const SURFACE_ERROR: Quantity = forced(
    "surface_error_vibration_um",
    "error of the wall by this vibration, the largest over the depth by size, positive where the wall is deeper in the part; without the mean deflection",
    "Forced::surface_error",
);

/// The release of the thrust of a drill.
const RELEASE: Origin = Origin {
    file: "core/src/dynamics/release.rs",
    function: "release",
    theory: Some("modes"),
    validation: Some("path-and-hole-columns"),
};
/// Speed at breakthrough.
pub const BREAKTHROUGH_SPEED: Quantity = Quantity {
    key: "breakthrough_speed_mm_per_s",
    unit: Some("mm/s"),
    decimals: 3,
    words: "greatest speed of the drill when its thrust ends at once: feed and release of the arm that the thrust bent",
    origin: Some(RELEASE),
};
/// Overshoot at breakthrough.
pub const BREAKTHROUGH_OVERSHOOT: Quantity = Quantity {
    key: "breakthrough_overshoot_um",
    unit: Some("um"),
    decimals: 3,
    words: "way of the drill beyond its place without load after breakthrough",
    origin: Some(RELEASE),
};
/// Permitted feed at breakthrough.
pub const BREAKTHROUGH_FEED: Quantity = Quantity {
    key: "breakthrough_feed",
    unit: None,
    decimals: 4,
    words: "part of the feed before breakthrough with which the drill is at most twice as fast there as programmed",
    origin: Some(Origin {
        validation: None,
        ..RELEASE
    }),
};
