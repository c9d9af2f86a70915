//! The values of P parameters by number.

use serde::{Deserialize, Serialize};

use super::names::{Weight, weight};
use super::persistent::PersistentMap;
use super::shared::Shared;
use super::value::Value;

/// Parameters below this number are found without a search.
const DIRECT: u32 = 1024;

/// Parameters that are copied together.
const PAGE: usize = 16;

type Page = [Option<Value>; PAGE];

/// The values of P parameters. Copies share the pages in which nothing was written since.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ParameterValues {
    pages: Vec<Shared<Page>>,
    further: PersistentMap<u32, Value>,
    /// Weight of the texts among the further ones.
    texts: Weight,
}

impl ParameterValues {
    pub(crate) fn get(&self, index: u32) -> Option<&Value> {
        if index >= DIRECT {
            return self.further.get(&index);
        }
        let (page, place) = page_of(index);
        self.pages.get(page)?[place].as_ref()
    }

    pub(crate) fn set(&mut self, index: u32, value: Value) {
        if index >= DIRECT {
            self.texts.add(weight(0, &value) - 1);
            if let Some(before) = self.further.insert(index, value) {
                self.texts.take(weight(0, &before) - 1);
            }
            return;
        }
        let (page, place) = page_of(index);
        if self.pages.len() <= page {
            self.pages.resize_with(page + 1, Shared::default);
        }
        self.pages[page][place] = Some(value);
    }

    pub(crate) fn remove(&mut self, index: u32) {
        if let Some(before) = self.further.remove(&index) {
            self.texts.take(weight(0, &before) - 1);
        }
        let (page, place) = page_of(index);
        if let Some(page) = self.pages.get_mut(page) {
            page[place] = None;
        }
    }

    /// The parameters that have a value, in the order of their numbers.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, &Value)> {
        let direct = (0..).zip(self.pages.iter().flat_map(|page| page.iter()));
        let direct = direct.filter_map(|(index, value)| Some((index, value.as_ref()?)));
        let further = self.further.iter().map(|(index, value)| (*index, value));
        direct.chain(further)
    }

    /// The numbers whose values differ in another set, or that only one of the two has.
    pub(crate) fn differing(&self, other: &Self) -> Vec<u32> {
        let none = Shared::default();
        let mut found = Vec::new();
        for number in 0..self.pages.len().max(other.pages.len()) {
            let [mine, theirs] = [self, other].map(|it| it.pages.get(number).unwrap_or(&none));
            if mine.is_copy_of(theirs) {
                continue;
            }
            let indices = (0..DIRECT).skip(number * PAGE);
            let pairs = indices.zip(mine.iter().zip(theirs.iter()));
            let differing = pairs.filter(|(_, (mine, theirs))| mine != theirs);
            found.extend(differing.map(|(index, _)| index));
        }
        found.extend(self.further.differing(&other.further));
        found
    }

    pub(crate) fn weight(&self) -> usize {
        let count = self.pages.len() * PAGE + self.further.len();
        count.saturating_add(self.texts.0)
    }
}

fn page_of(index: u32) -> (usize, usize) {
    let index = index as usize;
    (index / PAGE, index % PAGE)
}
