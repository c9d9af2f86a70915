//! Notes on regions that were made unknown, so that a loop that returns to one does not examine it
//! again.

use std::collections::HashMap;
use std::sync::Arc;

use super::region::Region;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::programs::wanted::WantedCall;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::value::Value;

/// A call found in a region that may or may not be executed.
#[derive(Debug, Clone)]
pub(crate) struct RegionCall {
    pub(crate) call: WantedCall,
    pub(crate) cause: Unknown,
    /// The file that holds the call.
    pub(crate) unit: usize,
    /// The region that holds it, where it is written there.
    pub(crate) region: Option<RegionKey>,
}

/// Writes since regions were last made unknown: a loop that returns to a region examines only these.
#[derive(Clone, Debug, Default)]
pub(crate) struct Journal {
    written: Vec<Location>,
    /// Rises when the list is restarted.
    epoch: u64,
    /// The end of the list when a region was made unknown.
    seen: HashMap<RegionKey, (u64, usize)>,
}

impl Journal {
    /// A value became known.
    #[inline]
    pub(crate) fn write(&mut self, location: &Location, value: &Value) {
        // If no region was examined, nothing has to be kept.
        if self.seen.is_empty() || matches!(value, Value::Unknown(_)) {
            return;
        }
        if self.written.len() >= MAX_WRITTEN {
            self.begin_anew();
        } else {
            self.written.push(location.clone());
        }
    }

    /// Something happened that the list does not record.
    pub(crate) fn begin_anew(&mut self) {
        self.written.clear();
        self.epoch += 1;
        self.seen.clear();
    }

    /// Returns the writes since the region was last made unknown; `None` where they are not known.
    pub(crate) fn since(&self, key: RegionKey) -> Option<&[Location]> {
        let &(epoch, from) = self.seen.get(&key)?;
        (epoch == self.epoch).then(|| self.written.get(from..).unwrap_or_default())
    }

    pub(crate) fn mark(&mut self, key: RegionKey) {
        self.seen.insert(key, (self.epoch, self.written.len()));
    }
}

/// A file and a range of its blocks.
pub(crate) type RegionKey = (usize, EntryIndex, EntryIndex);

/// Limit of the list.
const MAX_WRITTEN: usize = 4096;

/// Regions that were examined.
pub(crate) type Regions = HashMap<RegionKey, Arc<Region>>;
