//! Values of tools and work objects.

use armill_core::frame::Isometry;

use super::read::Reader;
use super::value::{Node, Value};
use crate::messages::shown;
use crate::program::Frame;
use crate::tokens::Token;

/// Frame and tool of a move.
pub(super) struct MoveFrames {
    pub frame: Frame,
    pub tool: Frame,
}

impl Reader<'_> {
    /// The frame of a tool.
    pub fn tool(&mut self, at: Token, node: &Node) -> Option<Frame> {
        let Some(found) = self.names.look(node, self.messages.index()) else {
            return Some(self.unknown_frame(at, node, "tool0"));
        };
        let Value::List(all) = &found.node.value else {
            return Some(self.unknown_frame(at, node, "tool0"));
        };
        if all.first().is_some_and(|robhold| is_word(robhold, "false")) {
            return self.stationary_tool(at);
        }
        let pose = all.get(1).and_then(|frame| self.frame(frame, found.text));
        Some(pose.map_or_else(|| self.unknown_frame(at, node, "tool0"), Frame::Given))
    }

    /// The frame of a work object: user frame times object frame.
    pub fn work(&mut self, at: Token, node: &Node) -> Option<Frame> {
        let Some(found) = self.names.look(node, self.messages.index()) else {
            return Some(self.unknown_frame(at, node, "wobj0"));
        };
        let Value::List(all) = &found.node.value else {
            return Some(self.unknown_frame(at, node, "wobj0"));
        };
        if all.first().is_some_and(|robhold| is_word(robhold, "true")) {
            return self.stationary_tool(at);
        }
        let is_moved = all.get(1).is_some_and(|fixed| is_word(fixed, "false"));
        let user = all.get(3).and_then(|frame| self.frame(frame, found.text));
        let object = all.get(4).and_then(|frame| self.frame(frame, found.text));
        if is_moved {
            let sentence = "the work object is moved by another axis, which is not followed";
            self.messages.note(at.line, sentence);
            return Some(Frame::Unknown);
        }
        Some(match (user, object) {
            (Some(user), Some(object)) => Frame::Given(user * object),
            _ => self.unknown_frame(at, node, "wobj0"),
        })
    }

    fn stationary_tool(&mut self, at: Token) -> Option<Frame> {
        let message = "the tool is stationary here and the workpiece is on the flange";
        let hint = "only programs with the tool on the flange are supported: robhold TRUE of the tool, FALSE of the \
            work object";
        self.messages.problem(at.span(), message, hint);
        None
    }

    fn unknown_frame(&mut self, at: Token, node: &Node, ready: &str) -> Frame {
        if is_word(node, ready) {
            return Frame::Given(Isometry::identity());
        }
        let text = shown(&self.text()[node.bytes.clone()]);
        let sentence = format!("`{text}` is not given as numbers: its pose is not known");
        self.messages.note(at.line, sentence);
        Frame::Unknown
    }

    /// `[[x, y, z], [q1, q2, q3, q4]]`
    fn frame(&self, node: &Node, text: usize) -> Option<Isometry> {
        let found = self.names.look(node, text)?;
        let Value::List(all) = &found.node.value else {
            return None;
        };
        self.pose(all, found.text)?.ok()
    }
}

fn is_word(node: &Node, word: &str) -> bool {
    matches!(&node.value, Value::Name(reference) if reference.name == word && reference.steps.is_empty())
}
