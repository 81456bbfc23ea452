//! Tickets: each opens one file of the folder once, within a minute, so that an address never contains the token.
//!
//! An address is in the history of the browser, and may be passed on; one with a used ticket opens nothing.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use armill_study::StudyError;

use crate::guard::random_hex;

/// How long a ticket is valid.
const VALID: Duration = Duration::from_secs(60);
/// Tickets at a time; of more, the oldest are no longer valid.
const MOST_TICKETS: usize = 1000;

/// The tickets that are valid.
#[derive(Default)]
pub(crate) struct Tickets(Mutex<HashMap<String, Ticket>>);

struct Ticket {
    /// The file, in the folder.
    path: String,
    issued: Instant,
}

impl Tickets {
    /// A new ticket for this file.
    ///
    /// # Errors
    /// The system gives no randomness.
    pub(crate) fn issue(&self, path: String, now: Instant) -> Result<String, StudyError> {
        let name = random_hex()?;
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|_, ticket| is_valid(ticket, now));
        while all.len() >= MOST_TICKETS {
            let oldest = all.iter().min_by_key(|(_, ticket)| ticket.issued);
            let Some(oldest) = oldest.map(|(name, _)| name.clone()) else {
                break;
            };
            all.remove(&oldest);
        }
        all.insert(name.clone(), Ticket { path, issued: now });
        Ok(name)
    }

    /// The file of this ticket, which is used up; none if it is unknown, used or too old.
    pub(crate) fn redeem(&self, name: &str, now: Instant) -> Option<String> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let ticket = all.remove(name)?;
        is_valid(&ticket, now).then_some(ticket.path)
    }
}

fn is_valid(ticket: &Ticket, now: Instant) -> bool {
    now.saturating_duration_since(ticket.issued) < VALID
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ticket_opens_one_file_once_and_not_for_long() {
        let tickets = Tickets::default();
        let begin = Instant::now();
        let issue = |path: &str| tickets.issue(path.to_owned(), begin).unwrap();
        let (a, b, late) = (issue("a"), issue("b"), issue("late"));
        assert!(a != b && a.len() == 32, "{a} {b}");
        assert_eq!(tickets.redeem(&b, begin).as_deref(), Some("b"));
        assert_eq!(tickets.redeem(&b, begin), None);
        assert_eq!(tickets.redeem("", begin), None);
        let last = begin + VALID - Duration::from_millis(1);
        assert_eq!(tickets.redeem(&a, last).as_deref(), Some("a"));
        assert_eq!(tickets.redeem(&late, begin + VALID), None);
    }

    #[test]
    fn there_are_never_more_tickets_than_allowed() {
        let tickets = Tickets::default();
        let begin = Instant::now();
        let at = |k: usize| begin + Duration::from_millis(u64::try_from(k).unwrap());
        let all: Vec<String> = (0..=MOST_TICKETS)
            .map(|k| tickets.issue(k.to_string(), at(k)).unwrap())
            .collect();
        assert_eq!(tickets.redeem(&all[0], at(MOST_TICKETS)), None);
        assert_eq!(tickets.redeem(&all[1], at(MOST_TICKETS)).as_deref(), Some("1"));
    }
}
