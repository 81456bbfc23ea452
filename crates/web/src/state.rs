//! What all handlers share.

use std::sync::Arc;

use armill_api::Context;

use crate::opening::Opening;
use crate::queue::Queue;
use crate::tickets::Tickets;
use crate::work::Work;

/// The study, and the work on it.
pub(crate) struct State {
    pub context: Arc<Context>,
    pub jobs: Queue,
    pub work: Work,
    pub opening: Opening,
    pub tickets: Tickets,
}
