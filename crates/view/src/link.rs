//! [`Link`]: the inbox through which the window reaches the worker. It keeps the latest [`Wanted`], and every [`Order`] until it is taken.

use super::wanted::{Order, Wanted};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// The inbox that the window and the worker share, and a signal that something new is in it.
#[derive(Debug)]
pub struct Link {
    inbox: Mutex<Inbox>,
    changed: Condvar,
}

/// What the worker finds.
#[derive(Debug)]
pub struct Inbox {
    /// What is wanted now.
    pub wanted: Wanted,
    /// The orders since the last look, oldest first.
    pub orders: Vec<Order>,
    /// Whether anything has changed since the last look.
    pub fresh: bool,
}

impl Link {
    /// With a first thing wanted, and no orders.
    pub fn new(wanted: Wanted) -> Self {
        Link { inbox: Mutex::new(Inbox { wanted, orders: vec![], fresh: true }), changed: Condvar::new() }
    }

    /// Lets the worker know what is wanted now.
    pub fn want(&self, wanted: &Wanted) {
        let mut inbox = self.inbox();
        if inbox.wanted != *wanted {
            inbox.wanted = wanted.clone();
            inbox.fresh = true;
            self.changed.notify_one();
        }
    }

    /// Gives the worker an order.
    pub fn order(&self, order: Order) {
        let mut inbox = self.inbox();
        inbox.orders.push(order);
        inbox.fresh = true;
        self.changed.notify_one();
    }

    /// What is in the inbox, without waiting.
    pub fn take(&self) -> Inbox {
        self.inbox().take()
    }

    /// What is in the inbox, once there is something new.
    pub fn wait(&self) -> Inbox {
        let mut inbox = self.inbox();
        while !inbox.fresh {
            inbox = self.changed.wait(inbox).unwrap_or_else(PoisonError::into_inner);
        }
        inbox.take()
    }

    fn inbox(&self) -> MutexGuard<'_, Inbox> {
        self.inbox.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inbox {
    /// Takes the orders and a copy of what is wanted; afterwards nothing is new.
    fn take(&mut self) -> Inbox {
        Inbox {
            wanted: self.wanted.clone(),
            orders: std::mem::take(&mut self.orders),
            fresh: std::mem::take(&mut self.fresh),
        }
    }
}
