//! A map that many can read while it changes.

use std::borrow::Borrow;
use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

use fnv::FnvHasher;

/// Number of parts, of which a change copies one.
const PARTS: usize = 256;

/// The entries whose keys have the same remainder.
type Shard<K, V> = Arc<BTreeMap<K, V>>;

/// A map whose copies share all that did not change, and keep their content (R12.16).
#[derive(Debug)]
pub struct SharedMap<K, V> {
    parts: Arc<[Shard<K, V>; PARTS]>,
    length: usize,
}

impl<K, V> Default for SharedMap<K, V> {
    fn default() -> Self {
        let parts = std::array::from_fn(|_| Shard::default());
        Self {
            parts: Arc::new(parts),
            length: 0,
        }
    }
}

impl<K, V> Clone for SharedMap<K, V> {
    fn clone(&self) -> Self {
        Self {
            parts: Arc::clone(&self.parts),
            length: self.length,
        }
    }
}

impl<K, V> SharedMap<K, V> {
    /// Returns whether the map is empty.
    pub(crate) fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Returns all entries, in an arbitrary but fixed order.
    pub fn iter(&self) -> impl Iterator<Item = (&K, &V)> {
        self.parts.iter().flat_map(|part| part.iter())
    }
}

impl<K: Ord + Hash + Clone, V: Clone> SharedMap<K, V> {
    /// Returns the value of a key.
    pub fn get<Q: Ord + Hash + ?Sized>(&self, key: &Q) -> Option<&V>
    where
        K: Borrow<Q>,
    {
        self.parts[part_of(key)].get(key)
    }

    /// Returns the value of a key for modification.
    pub fn get_mut<Q: Ord + Hash + ?Sized>(&mut self, key: &Q) -> Option<&mut V>
    where
        K: Borrow<Q>,
    {
        self.get(key)?;
        self.part_mut(key).get_mut(key)
    }

    /// Sets the value of a key, and returns the earlier one.
    pub fn insert(&mut self, key: K, value: V) -> Option<V> {
        let earlier = self.part_mut(&key).insert(key, value);
        self.length += usize::from(earlier.is_none());
        earlier
    }

    /// Removes a key, and returns its value.
    pub fn remove<Q: Ord + Hash + ?Sized>(&mut self, key: &Q) -> Option<V>
    where
        K: Borrow<Q>,
    {
        self.get(key)?;
        self.length -= 1;
        self.part_mut(key).remove(key)
    }

    fn part_mut<Q: Hash + ?Sized>(&mut self, key: &Q) -> &mut BTreeMap<K, V> {
        Arc::make_mut(&mut Arc::make_mut(&mut self.parts)[part_of(key)])
    }
}

impl<K: Ord + Hash + Clone, V: Clone> FromIterator<(K, V)> for SharedMap<K, V> {
    fn from_iter<T: IntoIterator<Item = (K, V)>>(entries: T) -> Self {
        let mut map = Self::default();
        for (key, value) in entries {
            map.insert(key, value);
        }
        map
    }
}

fn part_of<Q: Hash + ?Sized>(key: &Q) -> usize {
    let mut hasher = FnvHasher::default();
    key.hash(&mut hasher);
    // Less than the number of parts.
    usize::try_from(hasher.finish() % PARTS as u64).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_stays_as_it_is() {
        // R12.16
        let mut map: SharedMap<u32, u32> = (0..1000).map(|key| (key, key)).collect();
        let copy = map.clone();
        assert_eq!(map.remove(&7), Some(7));
        assert_eq!(map.insert(8, 0), Some(8));
        if let Some(value) = map.get_mut(&9) {
            *value = 1;
        }
        let of = |map: &SharedMap<u32, u32>| [7, 8, 9].map(|key| map.get(&key).copied());
        assert_eq!(of(&map), [None, Some(0), Some(1)]);
        assert_eq!(of(&copy), [Some(7), Some(8), Some(9)]);
        assert_eq!((map.iter().count(), copy.iter().count()), (999, 1000));
        assert!(!map.is_empty() && SharedMap::<u32, u32>::default().is_empty());
    }
}
