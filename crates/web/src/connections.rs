//! How many connections are open, and which one is closed for a new one.
//!
//! Every connection has a place. Where all are taken, a new connection gets the place of the oldest one that has not
//! shown the token: clients without the token cannot keep out those that have it. Where all have shown it, it waits.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot};

/// The connections that are open.
pub(crate) struct Connections {
    places: Arc<Semaphore>,
    /// Those that have not shown the token, by age, each with what closes it.
    unknown: Mutex<BTreeMap<u64, oneshot::Sender<()>>>,
    count: AtomicU64,
}

/// The place of one connection, free again when it is dropped.
pub(crate) struct ConnectionSlot {
    /// What its requests carry.
    pub client: Client,
    closed: oneshot::Receiver<()>,
    _permit: OwnedSemaphorePermit,
}

/// The client of a connection, as each of its requests has it.
#[derive(Clone)]
pub(crate) struct Client {
    number: u64,
    is_known: Arc<AtomicBool>,
    connections: Arc<Connections>,
}

impl Connections {
    /// None yet, `most` at most.
    pub(crate) fn new(most: usize) -> Arc<Connections> {
        Arc::new(Connections {
            places: Arc::new(Semaphore::new(most)),
            unknown: Mutex::default(),
            count: AtomicU64::new(0),
        })
    }

    fn with_unknown<T>(&self, change: impl FnOnce(&mut BTreeMap<u64, oneshot::Sender<()>>) -> T) -> T {
        change(&mut self.unknown.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// A place for a new connection; `None` after the server has stopped.
    pub(crate) async fn place(self: &Arc<Connections>) -> Option<ConnectionSlot> {
        let permit = match Arc::clone(&self.places).try_acquire_owned() {
            Ok(permit) => permit,
            Err(_) => {
                if let Some((_, close)) = self.with_unknown(BTreeMap::pop_first) {
                    // One that has ended on its own leaves its place too.
                    let _ = close.send(());
                }
                Arc::clone(&self.places).acquire_owned().await.ok()?
            }
        };
        let number = self.count.fetch_add(1, Ordering::Relaxed);
        let (close, closed) = oneshot::channel();
        self.with_unknown(|unknown| unknown.insert(number, close));
        Some(ConnectionSlot {
            client: Client {
                number,
                is_known: Arc::default(),
                connections: Arc::clone(self),
            },
            closed,
            _permit: permit,
        })
    }
}

impl ConnectionSlot {
    /// Waits until the place is required for another connection.
    pub(crate) async fn is_revoked(&mut self) {
        if (&mut self.closed).await.is_err() {
            // The token was shown: the place is kept.
            std::future::pending::<()>().await;
        }
    }
}

impl Drop for ConnectionSlot {
    fn drop(&mut self) {
        self.client.forget();
    }
}

impl Client {
    /// The token was shown: the connection is not closed for another.
    pub(crate) fn keep_place(&self) {
        if !self.is_known.swap(true, Ordering::Relaxed) {
            self.forget();
        }
    }

    /// Whether the token was shown.
    pub(crate) fn is_known(&self) -> bool {
        self.is_known.load(Ordering::Relaxed)
    }

    fn forget(&self) {
        self.connections
            .with_unknown(|unknown| unknown.remove(&self.number));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use futures_util::FutureExt;

    fn now(connections: &Arc<Connections>) -> Option<ConnectionSlot> {
        connections.place().now_or_never().flatten()
    }

    #[test]
    fn the_oldest_connection_without_the_token_makes_room() {
        let connections = Connections::new(3);
        let [mut first, mut second, mut third] = [0; 3].map(|_| now(&connections).unwrap());
        first.client.keep_place();
        assert!(first.client.is_known() && !second.client.is_known());
        let mut fourth = Box::pin(connections.place());
        assert!(fourth.as_mut().now_or_never().is_none(), "all places are taken");
        assert!(second.is_revoked().now_or_never().is_some());
        assert!(first.is_revoked().now_or_never().is_none() && third.is_revoked().now_or_never().is_none());
        drop(second);
        assert!(fourth.now_or_never().flatten().is_some());
    }

    #[test]
    fn connections_with_the_token_are_never_closed_for_another() {
        let connections = Connections::new(2);
        let mut places = [0; 2].map(|_| now(&connections).unwrap());
        places.iter().for_each(|place| place.client.keep_place());
        assert!(now(&connections).is_none());
        assert!(
            places
                .iter_mut()
                .all(|place| place.is_revoked().now_or_never().is_none())
        );
        drop(places);
        assert!(now(&connections).is_some());
        assert!(
            connections.with_unknown(|unknown| unknown.is_empty()),
            "nothing is left of those that ended"
        );
    }
}
