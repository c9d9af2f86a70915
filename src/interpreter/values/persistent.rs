//! A map whose copies share unchanged entries (R14.4).
//!
//! Ways through a program part and meet; a copy has to cost nothing, and a comparison of two copies only
//! as much as was written since. The map is a treap: a search tree by keys that is a heap by ranks, and as
//! the rank of a key is a hash of it, equal contents have equal trees. A crate with such a comparison
//! has eight dependencies.

use std::borrow::Borrow;
use std::cmp::Ordering;
use std::hash::{BuildHasher as _, Hash, RandomState};
use std::sync::{Arc, LazyLock};

use serde::ser::SerializeSeq as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Seed of the ranks, random so that no program can choose names whose ranks make the tree deep.
static RANKS: LazyLock<RandomState> = LazyLock::new(RandomState::new);

/// An ordered map; a copy shares everything with its original until one of them changes.
#[derive(Debug, Clone)]
pub(crate) struct PersistentMap<K, V> {
    root: TreeLink<K, V>,
    len: usize,
}

type TreeLink<K, V> = Option<Arc<TreeNode<K, V>>>;

#[derive(Debug, Clone)]
struct TreeNode<K, V> {
    key: K,
    value: V,
    rank: u64,
    left: TreeLink<K, V>,
    right: TreeLink<K, V>,
}

impl<K, V> TreeNode<K, V> {
    /// Returns the key that decides which of two nodes is above the other.
    fn place(&self) -> (u64, &K) {
        (self.rank, &self.key)
    }
}

impl<K, V> Default for PersistentMap<K, V> {
    fn default() -> Self {
        Self { root: None, len: 0 }
    }
}

impl<K, V> PersistentMap<K, V> {
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Returns all entries in the order of their keys.
    pub(crate) fn iter(&self) -> MapEntries<'_, K, V> {
        let mut entries = MapEntries { open: Vec::new() };
        entries.descend(self.root.as_deref());
        entries
    }

    pub(crate) fn keys(&self) -> impl Iterator<Item = &K> {
        self.iter().map(|(key, _)| key)
    }

    pub(crate) fn get<Q>(&self, key: &Q) -> Option<&V>
    where
        K: Borrow<Q>,
        Q: Ord + ?Sized,
    {
        let mut link = self.root.as_deref();
        while let Some(node) = link {
            link = match key.cmp(node.key.borrow()) {
                Ordering::Less => node.left.as_deref(),
                Ordering::Greater => node.right.as_deref(),
                Ordering::Equal => return Some(&node.value),
            };
        }
        None
    }

    /// Returns the entries from a key on.
    pub(crate) fn from<Q>(&self, key: &Q) -> MapEntries<'_, K, V>
    where
        K: Borrow<Q>,
        Q: Ord + ?Sized,
    {
        let mut entries = MapEntries { open: Vec::new() };
        let mut link = self.root.as_deref();
        while let Some(node) = link {
            link = if node.key.borrow() < key {
                node.right.as_deref()
            } else {
                entries.open.push(node);
                node.left.as_deref()
            };
        }
        entries
    }
}

impl<K: Ord + Hash + Clone, V: Clone> PersistentMap<K, V> {
    pub(crate) fn get_mut<Q>(&mut self, key: &Q) -> Option<&mut V>
    where
        K: Borrow<Q>,
        Q: Ord + ?Sized,
    {
        // A search for a missing key must not copy nodes.
        self.get(key)?;
        let mut link = &mut self.root;
        while let Some(shared) = link {
            let node = Arc::make_mut(shared);
            link = match key.cmp(node.key.borrow()) {
                Ordering::Less => &mut node.left,
                Ordering::Greater => &mut node.right,
                Ordering::Equal => return Some(&mut node.value),
            };
        }
        None
    }

    /// Puts a value under a key and returns the one before.
    pub(crate) fn insert(&mut self, key: K, value: V) -> Option<V> {
        if let Some(place) = self.get_mut(&key) {
            return Some(std::mem::replace(place, value));
        }
        self.slot(key, || value);
        None
    }

    /// Returns the value under a key, put there first where there is none.
    pub(crate) fn slot(&mut self, key: K, first: impl FnOnce() -> V) -> &mut V {
        let rank = RANKS.hash_one(&key);
        let mut link = &mut self.root;
        while link
            .as_ref()
            .is_some_and(|node| node.place() > (rank, &key))
        {
            let Some(shared) = link else { break };
            let node = Arc::make_mut(shared);
            link = if key < node.key {
                &mut node.left
            } else {
                &mut node.right
            };
        }
        let node = match link.take() {
            Some(node) if node.key == key => node,
            below => {
                self.len += 1;
                let (left, right) = split(below, &key);
                let value = first();
                Arc::new(TreeNode {
                    key,
                    value,
                    rank,
                    left,
                    right,
                })
            }
        };
        &mut Arc::make_mut(link.insert(node)).value
    }

    pub(crate) fn remove<Q>(&mut self, key: &Q) -> Option<V>
    where
        K: Borrow<Q>,
        Q: Ord + ?Sized,
    {
        self.get(key)?;
        let mut link = &mut self.root;
        loop {
            let order = key.cmp(link.as_ref()?.key.borrow());
            if order == Ordering::Equal {
                break;
            }
            let node = Arc::make_mut(link.as_mut()?);
            link = match order {
                Ordering::Less => &mut node.left,
                _ => &mut node.right,
            };
        }
        let node = Arc::unwrap_or_clone(link.take()?);
        *link = merge(node.left, node.right);
        self.len -= 1;
        Some(node.value)
    }
}

impl<K: Ord + Hash + Clone, V: Clone + PartialEq> PersistentMap<K, V> {
    /// Returns the keys whose values differ in another map, or that only one of the two has.
    pub(crate) fn differing(&self, other: &Self) -> Vec<K> {
        let mut keys = Vec::new();
        compare(&self.root, &other.root, &mut keys);
        keys
    }
}

impl<K: Ord + Hash + Clone, V: Clone + PartialEq> PartialEq for PersistentMap<K, V> {
    fn eq(&self, other: &Self) -> bool {
        self.len == other.len && self.differing(other).is_empty()
    }
}

impl<K: Ord + Hash + Clone, V: Clone> FromIterator<(K, V)> for PersistentMap<K, V> {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(entries: I) -> Self {
        let mut map = Self::default();
        for (key, value) in entries {
            map.insert(key, value);
        }
        map
    }
}

impl<K: Serialize, V: Serialize> Serialize for PersistentMap<K, V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut entries = serializer.serialize_seq(Some(self.len))?;
        for entry in self.iter() {
            entries.serialize_element(&entry)?;
        }
        entries.end()
    }
}

impl<'de, K, V> Deserialize<'de> for PersistentMap<K, V>
where
    K: Deserialize<'de> + Ord + Hash + Clone,
    V: Deserialize<'de> + Clone,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(|entries: Vec<(K, V)>| entries.into_iter().collect())
    }
}

/// The entries of a map in the order of their keys.
#[derive(Debug)]
pub(crate) struct MapEntries<'a, K, V> {
    /// The nodes whose left side is done.
    open: Vec<&'a TreeNode<K, V>>,
}

impl<'a, K, V> MapEntries<'a, K, V> {
    fn descend(&mut self, mut link: Option<&'a TreeNode<K, V>>) {
        while let Some(node) = link {
            self.open.push(node);
            link = node.left.as_deref();
        }
    }
}

impl<'a, K, V> Iterator for MapEntries<'a, K, V> {
    type Item = (&'a K, &'a V);

    fn next(&mut self) -> Option<Self::Item> {
        let node = self.open.pop()?;
        self.descend(node.right.as_deref());
        Some((&node.key, &node.value))
    }
}

/// Splits a tree into the nodes below and above a key that it does not hold.
fn split<K: Ord + Clone, V: Clone>(
    link: TreeLink<K, V>,
    key: &K,
) -> (TreeLink<K, V>, TreeLink<K, V>) {
    let Some(mut shared) = link else {
        return (None, None);
    };
    let node = Arc::make_mut(&mut shared);
    if node.key < *key {
        let (left, right) = split(node.right.take(), key);
        node.right = left;
        (Some(shared), right)
    } else {
        let (left, right) = split(node.left.take(), key);
        node.left = right;
        (left, Some(shared))
    }
}

/// Merges two trees, where all keys of the first are below those of the second.
fn merge<K: Ord + Clone, V: Clone>(low: TreeLink<K, V>, high: TreeLink<K, V>) -> TreeLink<K, V> {
    let (mut low, mut high) = match (low, high) {
        (Some(low), Some(high)) => (low, high),
        (only, None) | (None, only) => return only,
    };
    if low.place() > high.place() {
        let node = Arc::make_mut(&mut low);
        node.right = merge(node.right.take(), Some(high));
        Some(low)
    } else {
        let node = Arc::make_mut(&mut high);
        node.left = merge(Some(low), node.left.take());
        Some(high)
    }
}

/// Appends the keys under which two trees differ. Shared nodes are skipped.
fn compare<K: Ord + Clone, V: Clone + PartialEq>(
    mine: &TreeLink<K, V>,
    theirs: &TreeLink<K, V>,
    keys: &mut Vec<K>,
) {
    let (one, other) = match (mine, theirs) {
        (None, None) => return,
        (Some(one), Some(other)) => (one, other),
        (Some(only), None) | (None, Some(only)) => {
            compare(&only.left, &None, keys);
            keys.push(only.key.clone());
            compare(&only.right, &None, keys);
            return;
        }
    };
    if Arc::ptr_eq(one, other) {
        return;
    }
    if one.key == other.key {
        compare(&one.left, &other.left, keys);
        if one.value != other.value {
            keys.push(one.key.clone());
        }
        compare(&one.right, &other.right, keys);
        return;
    }
    // The key of the higher rank would also be at the top of the other tree if that held it.
    let (top, rest) = if one.place() > other.place() {
        (one, theirs)
    } else {
        (other, mine)
    };
    let (below, above) = split(rest.clone(), &top.key);
    compare(&top.left, &below, keys);
    keys.push(top.key.clone());
    compare(&top.right, &above, keys);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keys and values without a pattern, the same in every run.
    fn numbers(mut seed: u64) -> impl FnMut(u64) -> u64 {
        move |below| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 33) % below
        }
    }

    #[test]
    fn it_is_an_ordered_map() {
        let mut next = numbers(7);
        let mut map = PersistentMap::default();
        let mut expected = std::collections::BTreeMap::new();
        for _ in 0..4000 {
            let (key, value) = (next(300), next(9));
            match next(3) {
                0 => assert_eq!(map.remove(&key), expected.remove(&key)),
                _ => assert_eq!(map.insert(key, value), expected.insert(key, value)),
            }
            assert_eq!(map.len(), expected.len());
        }
        assert!(map.iter().eq(expected.iter()));
        assert!(map.from(&120).eq(expected.range(120..)));
        let text = serde_json::to_string(&map).expect("text");
        let entries: Vec<_> = expected.iter().collect();
        assert_eq!(text, serde_json::to_string(&entries).expect("text"));
        let read: PersistentMap<u64, u64> = serde_json::from_str(&text).expect("the same");
        assert!(read == map);
    }

    #[test]
    fn copies_differ_in_what_was_written_since() {
        // R14.4
        let mut next = numbers(11);
        for _ in 0..50 {
            let one: PersistentMap<u64, u64> = (0..200).map(|key| (key, next(9))).collect();
            let mut other = one.clone();
            for _ in 0..next(20) {
                match next(2) {
                    0 => drop(other.remove(&next(250))),
                    _ => drop(other.insert(next(250), next(9))),
                }
            }
            let keys = (0..250).filter(|key| one.get(key) != other.get(key));
            let keys: Vec<u64> = keys.collect();
            assert_eq!(one.differing(&other), keys);
            assert_eq!(other.differing(&one), keys);
            assert_eq!(one == other, keys.is_empty());
        }
    }

    #[test]
    fn a_copy_keeps_what_its_original_loses() {
        let mut one: PersistentMap<u64, u64> = (0..100).map(|key| (key, key)).collect();
        let copy = one.clone();
        for key in 0..100 {
            one.remove(&key);
        }
        assert!(one.is_empty());
        assert!(copy.keys().copied().eq(0..100));
    }
}
