//! From the window to the worker: what is wanted last, and every order.

use super::wanted::{Order, Wanted};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// What the window and the worker share.
#[derive(Debug)]
pub struct Link {
    inbox: Mutex<Inbox>,
    changed: Condvar,
}

/// What lies there for the worker.
#[derive(Debug)]
pub struct Inbox {
    /// What is wanted now.
    pub wanted: Wanted,
    /// What is to be done, in this order.
    pub orders: Vec<Order>,
    /// Whether anything of it is new.
    pub fresh: bool,
}

impl Link {
    /// With something wanted, and no orders.
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

    /// Gives the worker something to do.
    pub fn order(&self, order: Order) {
        let mut inbox = self.inbox();
        inbox.orders.push(order);
        inbox.fresh = true;
        self.changed.notify_one();
    }

    /// Takes what lies there, at once.
    pub fn take(&self) -> Inbox {
        self.inbox().take()
    }

    /// Takes what lies there, once there is something new.
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
    /// What lies here; afterwards nothing of it is new.
    fn take(&mut self) -> Inbox {
        Inbox {
            wanted: self.wanted.clone(),
            orders: std::mem::take(&mut self.orders),
            fresh: std::mem::take(&mut self.fresh),
        }
    }
}
