//! What a deviation is shared out to.

use crate::robot::{Attachment, Joint};

/// One entry of the shares of a deviation; all shares add up to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contributor {
    /// The drive of a joint with its backlash and the springs attached to its link; or springs of base, flange or tool.
    At(Attachment),
    /// The calibrated arm differs from the model in its controller.
    Geometry,
    /// Thermal growth of the links since the calibration.
    Thermal,
    /// What the model leaves of measured positions.
    Learnt,
    /// Corners that the controller rounds.
    Blending,
    /// Joints that follow their command late.
    Servo,
}

impl Contributor {
    /// Its name: of a joint as its maker calls it, else `base`, `flange`, `tool`, `geometry`, `thermal`, `learnt`, `blending`, `servo`.
    pub fn name(self, joints: &[Joint]) -> String {
        match self {
            Contributor::At(Attachment::Joint(index)) => joints[index].name.clone(),
            Contributor::At(Attachment::Base) => "base".to_owned(),
            Contributor::At(Attachment::Flange) => "flange".to_owned(),
            Contributor::At(Attachment::Tool) => "tool".to_owned(),
            Contributor::Geometry => "geometry".to_owned(),
            Contributor::Thermal => "thermal".to_owned(),
            Contributor::Learnt => "learnt".to_owned(),
            Contributor::Blending => "blending".to_owned(),
            Contributor::Servo => "servo".to_owned(),
        }
    }
}
