//! Cutter compensation.

use super::program::moves_of;

/// A contour that the cutter follows on its left; offsets worked out by hand.
#[test]
fn the_cutter_is_offset_from_its_contour() {
    let square = "G21 F60\nG0 X-10 Y0\nG41.1 D4\nG1 X0\nX10\nY10\nX0\nY0\nG40\nG0 X-10\n";
    assert_eq!(
        moves_of(square),
        [
            "STRAIGHT_TRAVERSE(-10.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(0.0000, 2.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(8.0000, 2.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(8.0000, 8.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(2.0000, 8.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(2.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(-10.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
        ]
    );
    let outside = moves_of(&square.replace("G41.1", "G42.1"));
    assert_eq!(
        outside[2..4],
        [
            "STRAIGHT_FEED(10.0000, -2.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "ARC_FEED(12.0000, 0.0000, 10.0000, 0.0000, 1, 0.0000, 0.0000, 0.0000, 0.0000)",
        ]
    );
}
