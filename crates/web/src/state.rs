//! What all handlers share.

use armill_study::live::{PartCache, PathCache};

use crate::cell::Cell;
use crate::opening::Opening;
use crate::queue::Queue;
use crate::tickets::Tickets;
use crate::work::Work;

/// The study, and the work on it.
pub(crate) struct State {
    pub cell: Cell,
    pub jobs: Queue,
    pub work: Work,
    pub opening: Opening,
    pub tickets: Tickets,
    pub paths: PathCache,
    pub parts: PartCache,
}
