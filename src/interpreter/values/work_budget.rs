//! Work: the effort that a block causes beyond its own length (R2.60).
//!
//! Work is macros that expand, texts that grow, regions that are examined because their condition is
//! not known, names that are compared. It is a level that rises with each unit and falls
//! with each executed block, so that a program that loops on purpose never gets near the bound, and
//! one whose blocks do far more than is written in them soon does.

use std::cell::Cell;

use serde::{Deserialize, Serialize};

/// The cost of looking at one block or one name, whatever its length.
pub(crate) const ITEM: usize = 32;

/// Units of work that an executed block allows.
const PER_BLOCK: u64 = 500;

/// Units of work that a byte of an executed block allows.
const PER_BYTE: u64 = 4;

/// Units of repeated work that a message needs, whether it is reported again or not.
const PER_MESSAGE: u64 = 1500;

/// Units of repeated work that a unit of other work needs.
const PER_WORK: u64 = 2;

/// Units of a way that a unit of a region needs: regions are read, ways are only copied and compared.
pub(crate) const PER_UNIT_READ: u64 = 40;

/// Units of ways that a block allows when it is executed for the first time.
const PER_NEW_BLOCK: u64 = 15_000;

/// The work of a session, in units.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct WorkBudget {
    spent: Cell<u64>,
    /// Work beyond the share that each executed block allows.
    level: Cell<u64>,
    /// Work of blocks that were executed again.
    repeated: u64,
    /// Work of the program on ways that only the machine decides, about a nanosecond a unit, beyond the share that
    /// each new block allows.
    ways: Cell<u64>,
}

impl WorkBudget {
    /// Counts work.
    pub(crate) fn charge(&self, units: usize) {
        let units = u64::try_from(units).unwrap_or(u64::MAX);
        self.spent.set(self.spent.get().saturating_add(units));
        self.level.set(self.level.get().saturating_add(units));
    }

    /// Counts work of following ways.
    pub(crate) fn charge_ways(&self, units: u64) {
        self.ways.set(self.ways.get().saturating_add(units));
    }

    /// Counts work of reading blocks that are passed over, and of joining what differs.
    pub(crate) fn charge_reading(&self, units: usize) {
        let units = u64::try_from(units).unwrap_or(u64::MAX);
        self.spent.set(self.spent.get().saturating_add(units));
        self.charge_ways(units.saturating_mul(PER_UNIT_READ));
    }

    /// Returns the work of following ways, and of reading blocks that are passed over.
    #[inline]
    pub(crate) fn ways(&self) -> u64 {
        self.ways.get()
    }

    /// Resets the work on ways at the start of a program.
    pub(crate) fn begin_ways(&self) {
        self.ways.set(0);
    }

    /// Grants the work on ways that a block allows when it is executed for the first time.
    #[inline]
    pub(crate) fn grant_ways(&self) {
        let ways = self.ways.get();
        if ways > 0 {
            self.ways.set(ways.saturating_sub(PER_NEW_BLOCK));
        }
    }

    /// Grants the work that an executed block allows.
    #[inline]
    pub(crate) fn grant(&self, text: &str) {
        let level = self.level.get();
        if level > 0 {
            let bytes = u64::try_from(text.len()).unwrap_or(u64::MAX);
            let granted = PER_BYTE.saturating_mul(bytes).saturating_add(PER_BLOCK);
            self.level.set(level.saturating_sub(granted));
        }
    }

    /// Counts a block that was executed again; `before` is all work before it.
    #[inline]
    pub(crate) fn repeat(&mut self, weight: u64, said: u64, before: u64) {
        let work = self.spent.get().saturating_sub(before);
        let units = weight + PER_MESSAGE.saturating_mul(said) + PER_WORK.saturating_mul(work);
        self.repeated = self.repeated.saturating_add(units);
    }

    /// Returns the work of blocks that were executed again.
    #[inline]
    pub(crate) fn repeated(&self) -> u64 {
        self.repeated
    }

    /// Returns all work so far.
    pub(crate) fn spent(&self) -> u64 {
        self.spent.get()
    }

    /// Returns the level of work.
    #[inline]
    pub(crate) fn level(&self) -> u64 {
        self.level.get()
    }
}
