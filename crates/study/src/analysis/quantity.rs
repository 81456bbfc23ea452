//! What is known of a point of an analysis: the closed list of quantities.
//!
//! Tables and VTK files take their columns from it. Each quantity names the function that computes it, the page of the
//! theory with its equations, and the case that compares it with the numbers of others, as far as there
//! are any. The page `docs/guide/quantities.md` is made from this list.
//!
//! Capitals in a key stand for a name or number: `share_NAME_um` is one column for each contributor.

pub use crate::analysis::quantity_entry::{Origin, Quantity};
use crate::analysis::{motion_quantity, vibration_quantity};

/// A deviation, from the sum of all sources.
const fn deviation(key: &'static str, words: &'static str, origin: Origin) -> Quantity {
    Quantity {
        key,
        unit: Some("um"),
        decimals: 3,
        words,
        origin: Some(origin),
    }
}

/// An angle.
const fn angle(key: &'static str, words: &'static str, origin: Origin) -> Quantity {
    Quantity {
        key,
        unit: Some("deg"),
        decimals: 6,
        words,
        origin: Some(origin),
    }
}

/// A number of the input.
const fn input(key: &'static str, unit: Option<&'static str>, decimals: u8, words: &'static str) -> Quantity {
    Quantity {
        key,
        unit,
        decimals,
        words,
        origin: None,
    }
}

/// A coordinate of a point of a path.
const fn path_point(key: &'static str) -> Quantity {
    input(
        key,
        Some("mm"),
        6,
        "point in the coordinates of the program or shape",
    )
}

const SUM: Origin = Origin {
    file: "core/src/predict.rs",
    function: "predict",
    theory: Some("deviation"),
    validation: Some("force-to-deflection"),
};
const ON_PLANE: Origin = Origin {
    file: "core/src/workpiece.rs",
    function: "Split::of",
    theory: Some("deviation"),
    validation: Some("plane-split"),
};
const ALONG_TRACK: Origin = Origin {
    file: "core/src/path/track.rs",
    function: "Track::parts",
    theory: Some("deviation"),
    validation: Some("path-and-hole-columns"),
};
const WITHOUT_LOAD: Origin = Origin {
    file: "core/src/predict.rs",
    function: "unloaded",
    theory: Some("unloaded"),
    validation: None,
};
const POSTURE: Origin = Origin {
    file: "core/src/robot/inverse/mod.rs",
    function: "postures",
    theory: Some("inverse"),
    validation: Some("inverse-vs-opw"),
};
const SPIN: Origin = Origin {
    file: "core/src/optimize/posture.rs",
    function: "postures_along",
    theory: Some("lattice"),
    validation: None,
};
const LEAN: Origin = Origin {
    file: "core/src/path/lean.rs",
    function: "leaned",
    theory: Some("lattice"),
    validation: None,
};
const IN_HOLE: Origin = Origin {
    file: "study/src/analysis/holes/answer.rs",
    function: "error",
    theory: None,
    validation: Some("path-and-hole-columns"),
};

/// Distance to the joint limits.
pub const LIMIT_MARGIN: Quantity = angle(
    "limit_margin_deg",
    "least distance of a joint to its limit (mm for a prismatic joint), negative outside",
    Origin {
        file: "core/src/robot/model.rs",
        function: "Robot::limit_margin",
        theory: None,
        validation: Some("mh12-readings"),
    },
);
/// Distance of the nearest bodies.
pub const CLEARANCE: Quantity = Quantity {
    unit: Some("mm"),
    decimals: 3,
    ..angle(
        "clearance_mm",
        "least distance of two bodies of the cell, 0 where they touch; where no posture keeps the demanded clearance, that of the best one",
        Origin {
            file: "core/src/clearance/state.rs",
            function: "CellState::clearance",
            theory: Some("clearance"),
            validation: Some("clearance-coal"),
        },
    )
};
/// The load case of the envelope.
pub const WORST_CASE: Quantity = Quantity {
    unit: None,
    decimals: 0,
    ..deviation(
        "worst_case",
        "load case with the largest in-plane deviation, from 1",
        Origin {
            file: "core/src/kernel/mod.rs",
            function: "evaluate",
            validation: Some("shares-and-uncertainty"),
            ..ON_PLANE
        },
    )
};
/// The envelope across the normal.
pub const IN_PLANE: Quantity = deviation(
    "in_plane_um",
    "largest in-plane deviation of all cases",
    Origin {
        validation: Some("mh12-readings"),
        ..ON_PLANE
    },
);
/// Its uncertainty.
pub const IN_PLANE_U: Quantity = deviation(
    "in_plane_u_um",
    "standard uncertainty of the in-plane deviation",
    Origin {
        validation: Some("shares-and-uncertainty"),
        ..SUM
    },
);
/// The probability to be within the tolerance.
pub const PROBABILITY_WITHIN: Quantity = Quantity {
    unit: None,
    decimals: 4,
    ..deviation(
        "probability_within",
        "probability that the in-plane deviation is within the tolerance",
        Origin {
            file: "core/src/map/certainty.rs",
            function: "probability_within",
            theory: Some("deviation"),
            validation: Some("shares-and-uncertainty"),
        },
    )
};
/// Along the normal.
pub const NORMAL: Quantity = deviation(
    "normal_um",
    "deviation along the outward normal, of the case where it is largest",
    ON_PLANE,
);
/// The whole length.
pub const FULL: Quantity = deviation(
    "full_um",
    "largest length of the deviation of all cases",
    Origin {
        validation: Some("mh12-readings"),
        ..SUM
    },
);
/// Positions of revolute joints.
pub const JOINT_DEG: Quantity = angle(
    "joint_NAME_deg",
    "joint position in the convention of the robot file",
    POSTURE,
);
/// Positions of prismatic joints.
pub const JOINT_MM: Quantity = Quantity {
    unit: Some("mm"),
    ..angle("joint_NAME_mm", JOINT_DEG.words, POSTURE)
};
/// Shares of the contributors.
pub const SHARE: Quantity = deviation(
    "share_NAME_um",
    "share of the joint (base, flange, tool, geometry, thermal growth, learnt residual) in the in-plane deviation; the sum of the shares is the deviation",
    Origin {
        validation: Some("shares-and-uncertainty"),
        ..SUM
    },
);
/// The deviation under each case.
pub const OF_CASE: Quantity = deviation(
    "deviation_AXIS_case_NUMBER_um",
    "deviation under this load case, base axes",
    SUM,
);

/// Line of a program.
pub const LINE: Quantity = input(
    "line",
    None,
    0,
    "line of the program or file, or piece of the shape",
);
/// Point of the path.
pub const PATH_X: Quantity = path_point("path_x_mm");
/// Point of the path.
pub const PATH_Y: Quantity = path_point("path_y_mm");
/// Point of the path.
pub const PATH_Z: Quantity = path_point("path_z_mm");
/// Distance along a path.
pub const DISTANCE: Quantity = input("distance_mm", Some("mm"), 6, "distance along all cuts before");
/// Speed of the tip.
pub const FEED: Quantity = input(
    "feed_mm_per_s",
    Some("mm/s"),
    6,
    "speed of the tip, if the program specifies it",
);
/// Spin of a search or a curve.
pub const TURN: Quantity = angle(
    "turn_deg",
    "spin of the tool about its axis that was found by a search or is given by a curve, in addition to the constant one",
    SPIN,
);
/// Lean of a search towards the feed.
pub const LEAD: Quantity = angle(
    "lead_deg",
    "lean of the tool towards the feed that was found by a search, about the programmed axis",
    LEAN,
);
/// Lean of a search to the left.
pub const TILT: Quantity = angle(
    "tilt_deg",
    "lean of the tool to the left of the feed that was found by a search, about the programmed axis",
    LEAN,
);
/// Height of scallops.
pub const SCALLOP: Quantity = deviation(
    "scallop_um",
    "height of the scallops between neighbouring passes of the leaning tool on a flat surface",
    Origin {
        file: "core/src/path/scallop.rs",
        function: "scallop",
        theory: Some("lattice"),
        validation: Some("path-and-hole-columns"),
    },
);
/// Along the track.
pub const ALONG: Quantity = deviation(
    "along_um",
    "deviation of the worst case along the track",
    ALONG_TRACK,
);
/// Across the track.
pub const CROSS: Quantity = deviation(
    "cross_um",
    "deviation of the worst case across the track, to the left",
    ALONG_TRACK,
);
/// Along the tool.
pub const AXIAL: Quantity = deviation(
    "axial_um",
    "deviation of the worst case along the tool, away from the part",
    ALONG_TRACK,
);
/// The part without load, along the track.
pub const UNLOADED_ALONG: Quantity = deviation(
    "unloaded_along_um",
    "part of along_um due to backlash, geometry, thermal growth and learnt residual",
    WITHOUT_LOAD,
);
/// The part without load, across the track.
pub const UNLOADED_CROSS: Quantity = deviation(
    "unloaded_cross_um",
    "part of cross_um due to backlash, geometry, thermal growth and learnt residual",
    WITHOUT_LOAD,
);
/// The part without load, along the tool.
pub const UNLOADED_AXIAL: Quantity = deviation(
    "unloaded_axial_um",
    "part of axial_um due to backlash, geometry, thermal growth and learnt residual",
    WITHOUT_LOAD,
);

/// Number of a hole.
pub const HOLE: Quantity = input("hole", None, 0, "number in the order given, from 1");
/// Bend of the wrist.
pub const WRIST_BEND: Quantity = angle(
    "wrist_bend_deg",
    "angle between axes 4 and 6; empty for an arm without named branches",
    Origin {
        file: "core/src/robot/jacobian.rs",
        function: "wrist_bend",
        theory: None,
        validation: Some("path-and-hole-columns"),
    },
);
const OF_CUT: Origin = Origin {
    file: "core/src/load/spindle.rs",
    function: "Milling::mean_torque",
    theory: Some("cutting"),
    validation: Some("path-and-hole-columns"),
};

/// A value of the cut.
const fn of_cut(key: &'static str, unit: &'static str, words: &'static str, origin: Origin) -> Quantity {
    Quantity {
        key,
        unit: Some(unit),
        decimals: 3,
        words,
        origin: Some(origin),
    }
}

/// Force of the cut.
pub const FORCE: Quantity = of_cut(
    "force_n",
    "N",
    "size of the mean cutting force of a revolution, at force-deflection equilibrium",
    Origin {
        file: "core/src/load/mean.rs",
        function: "Milling::mean_force",
        validation: Some("milling-mean-force"),
        ..OF_CUT
    },
);
/// Torque of the cut.
pub const TORQUE: Quantity = of_cut(
    "torque_n_m",
    "N m",
    "mean torque of a revolution, of the nominal cut",
    OF_CUT,
);
/// Chip thickness.
pub const CHIP: Quantity = of_cut(
    "chip_um",
    "um",
    "largest chip thickness of any tooth, of the nominal cut",
    Origin {
        function: "Milling::largest_chip",
        ..OF_CUT
    },
);
/// Material removal rate.
pub const REMOVAL: Quantity = of_cut(
    "removal_mm3_per_s",
    "mm^3/s",
    "material removal rate, of the nominal cut",
    Origin {
        function: "Cut::removal_rate",
        ..OF_CUT
    },
);
/// Across a hole.
pub const HOLE_X: Quantity = deviation(
    "hole_x_um",
    "deviation across the hole, along x of the part projected into its plane",
    IN_HOLE,
);
/// Across a hole.
pub const HOLE_Y: Quantity = deviation(
    "hole_y_um",
    "deviation across the hole, to the left of its x",
    IN_HOLE,
);
/// Along a hole.
pub const DEPTH: Quantity = deviation("depth_um", "deviation out of the part: too shallow", IN_HOLE);

/// All quantities, in the order of the tables: of a path, of holes, of every analysis.
pub const ALL: [&Quantity; 49] = [
    &LINE,
    &PATH_X,
    &PATH_Y,
    &PATH_Z,
    &DISTANCE,
    &FEED,
    &ALONG,
    &CROSS,
    &AXIAL,
    &TURN,
    &LEAD,
    &TILT,
    &SCALLOP,
    &FORCE,
    &TORQUE,
    &CHIP,
    &REMOVAL,
    &UNLOADED_ALONG,
    &UNLOADED_CROSS,
    &UNLOADED_AXIAL,
    &motion_quantity::TIME,
    &motion_quantity::SPEED,
    &motion_quantity::FEED_REACHED,
    &motion_quantity::BLENDING,
    &motion_quantity::SERVO,
    &HOLE,
    &WRIST_BEND,
    &HOLE_X,
    &HOLE_Y,
    &DEPTH,
    &vibration_quantity::BREAKTHROUGH_SPEED,
    &vibration_quantity::BREAKTHROUGH_OVERSHOOT,
    &vibration_quantity::BREAKTHROUGH_FEED,
    &LIMIT_MARGIN,
    &CLEARANCE,
    &WORST_CASE,
    &IN_PLANE,
    &IN_PLANE_U,
    &PROBABILITY_WITHIN,
    &NORMAL,
    &FULL,
    &JOINT_DEG,
    &JOINT_MM,
    &vibration_quantity::LOWEST_MODE,
    &vibration_quantity::STABLE_DEPTH,
    &vibration_quantity::AMPLITUDE,
    &vibration_quantity::SURFACE_ERROR,
    &SHARE,
    &OF_CASE,
];
