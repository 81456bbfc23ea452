//! Codes by their modal groups: of each group a block may have one.
//!
//! Codes G are in tenths, so that G92.1 is 921; codes M are whole. Groups of G and of M have the same numbers for other
//! things and have separate lists.
//!
//! Source: LinuxCNC documentation, G-code overview, table of modal groups; the codes of other controls for tool-centre
//! control: FANUC G43.4 and G43.5, Heidenhain M128 and M129, Siemens TRAORI and TRAFOOF, LinuxCNC remaps M428 and M429.

/// Groups of G as of M.
pub(super) const GROUPS: usize = 16;

/// Not modal: dwell, offsets, homes.
pub(super) const ONCE: usize = 0;
/// G0 to G3, G38, canned cycles, G80.
pub(super) const MOTION: usize = 1;
/// G17 to G19.
pub(super) const PLANE: usize = 2;
/// G90, G91.
pub(super) const DISTANCE: usize = 3;
/// G90.1, G91.1.
pub(super) const ARC_DISTANCE: usize = 4;
/// G93 to G95.
pub(super) const FEED_MODE: usize = 5;
/// G20, G21.
pub(super) const UNITS: usize = 6;
/// G40 to G42.1.
pub(super) const CUTTER: usize = 7;
/// G43 to G49.
pub(super) const LENGTH: usize = 8;
/// G98, G99.
pub(super) const RETRACT: usize = 10;
/// G54 to G59.3.
pub(super) const SYSTEM: usize = 12;
/// G61, G61.1, G64.
pub(super) const PATH: usize = 13;
/// G97.
pub(super) const SPINDLE_MODE: usize = 14;
/// G53, together with G0 and G1.
pub(super) const MACHINE: usize = 15;

/// From here on groups of M: M0, M1, M2, M30, M60.
pub(super) const STOPPING: usize = 4;
/// M62 to M68.
pub(super) const OUTPUTS: usize = 5;
/// M6, M61.
pub(super) const TOOL: usize = 6;
/// M3, M4, M5, M19.
pub(super) const SPINDLE: usize = 7;
/// M7 to M9.
pub(super) const COOLANT: usize = 8;
/// M48 to M53.
pub(super) const OVERRIDE: usize = 9;
/// M100 to M999 but for those of tool-centre control.
pub(super) const USER: usize = 10;
/// Tool-centre control: M128, M129, M428, M429, TRAORI, TRAFOOF.
pub(super) const CENTRE: usize = 11;
/// M98, M99.
pub(super) const CALL: usize = 12;

/// Siemens words, as M beyond all that is written so.
pub(super) const TRAORI: u16 = 60_001;
pub(super) const TRAFOOF: u16 = 60_002;

/// The group of a G code in tenths.
pub(super) fn of_g(code: u16) -> Option<usize> {
    Some(match code {
        40 | 100 | 280 | 281 | 300 | 301 | 520 | 920..=923 => ONCE,
        530 => MACHINE,
        0 | 10 | 20 | 30 | 382..=385 | 730 | 800 | 810 | 820 | 830 | 840 | 850 | 860 | 880 | 890 => MOTION,
        170 | 180 | 190 => PLANE,
        900 | 910 => DISTANCE,
        901 | 911 => ARC_DISTANCE,
        930 | 940 | 950 => FEED_MODE,
        200 | 210 => UNITS,
        400 | 410 | 411 | 420 | 421 => CUTTER,
        430 | 431 | 432 | 434 | 435 | 490 => LENGTH,
        980 | 990 => RETRACT,
        540 | 550 | 560 | 570 | 580 | 590 | 591 | 592 | 593 => SYSTEM,
        610 | 611 | 640 => PATH,
        970 => SPINDLE_MODE,
        _ => return None,
    })
}

/// The group of an M code.
pub(super) fn of_m(code: u16) -> Option<usize> {
    Some(match code {
        0 | 1 | 2 | 30 | 60 => STOPPING,
        62..=68 => OUTPUTS,
        6 | 61 => TOOL,
        3 | 4 | 5 | 19 => SPINDLE,
        7..=9 => COOLANT,
        48..=53 => OVERRIDE,
        128 | 129 | 428 | 429 | TRAORI | TRAFOOF => CENTRE,
        98 | 99 => CALL,
        100..=999 => USER,
        _ => return None,
    })
}

/// Why a code that is known is not read.
///
/// `None` for supported codes and for unknown ones.
pub(super) fn unsupported(letter: u8, code: u16) -> Option<&'static str> {
    if letter != b'g' {
        return match code {
            70..=73 => Some("saved modal states are not kept"),
            _ => None,
        };
    }
    Some(match code {
        50..=53 | 60..=63 => "splines and NURBS are not expanded",
        70 | 80 => "it is for lathes",
        330 | 331 | 760 => "threads are cut by a turning spindle",
        171 | 181 | 191 => "planes of U, V, W are not known",
        531 | 533 | 536 | 680..=689 | 690 => "tilted planes need the machine's kinematics",
        740 => "tapping left-hand threads is not expanded",
        870 => "back boring is not expanded",
        960 => "constant surface speed is for lathes",
        _ => return None,
    })
}

/// A code as it is written.
pub(super) fn name(letter: u8, code: u16) -> String {
    match (letter, code) {
        (_, TRAORI) => "TRAORI".to_owned(),
        (_, TRAFOOF) => "TRAFOOF".to_owned(),
        (b'g', _) if code.is_multiple_of(10) => format!("G{}", code / 10),
        (b'g', _) => format!("G{}.{}", code / 10, code % 10),
        _ => format!("M{code}"),
    }
}
