//! The events of a program as it runs: how the last move ends, and which message a stop shows.

use crate::event::{Action, Blend, Event};
use crate::source::Place;

#[derive(Debug, Default)]
pub struct Log {
    events: Vec<Event>,
    /// Messages since the last event that is none.
    messages: Vec<String>,
    /// The last move has possibly not ended.
    moving: bool,
}

impl Log {
    pub fn into_events(self) -> Vec<Event> {
        self.events
    }

    pub fn push(&mut self, place: &Place, action: Action) {
        match &action {
            Action::Message { text } => self.messages.push(text.clone()),
            Action::Comment { .. } => {}
            _ => self.messages.clear(),
        }
        if let Some(blend) = blend_of(&action) {
            self.moving = *blend != Blend::Exact;
        }
        self.events.push(Event {
            place: place.clone(),
            action,
        });
    }

    /// A move that runs while the statements after it do.
    pub fn push_asynchronous(&mut self, place: &Place, action: Action) {
        self.push(place, action);
        self.moving = true;
    }

    /// A message that is shown by other means than an event of its own.
    pub fn note(&mut self, message: String) {
        self.messages.push(message);
    }

    pub fn comment(&mut self, place: &Place, text: &str) {
        let text = text.trim().to_owned();
        self.push(place, Action::Comment { text });
    }

    pub fn message(&mut self, place: &Place, text: String) {
        self.push(place, Action::Message { text });
    }

    pub fn output(&mut self, place: &Place, name: String, value: String) {
        let moving = self.moving;
        self.push(place, Action::Output { name, value, moving });
    }

    pub fn stop(&mut self, place: &Place) {
        let message = (!self.messages.is_empty()).then(|| self.messages.join(" "));
        self.push(place, Action::Stop { message });
    }

    /// The last move ends in its target, at rest, before the next statement.
    pub fn settle(&mut self) {
        self.moving = false;
        let last = self
            .events
            .iter_mut()
            .rev()
            .find_map(|event| match &mut event.action {
                Action::Joint(joint) => Some(&mut joint.blend),
                Action::Linear(linear) => Some(&mut linear.blend),
                Action::Circular { end, .. } => Some(&mut end.blend),
                _ => None,
            });
        if let Some(blend) = last {
            *blend = Blend::Exact;
        }
    }
}

fn blend_of(action: &Action) -> Option<&Blend> {
    match action {
        Action::Joint(joint) => Some(&joint.blend),
        Action::Linear(linear) => Some(&linear.blend),
        Action::Circular { end, .. } => Some(&end.blend),
        _ => None,
    }
}
