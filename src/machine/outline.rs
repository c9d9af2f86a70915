//! Knowledge about a machine that is not described (R9.73).

use std::collections::BTreeMap;

use crate::syntax::{AxisUse, axis_uses};

/// Knowledge about a machine that is not described.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Outline {
    /// The path of its start-up list, as a configuration would write it.
    Startup(String),
    /// The path of the TwinCAT project that holds its lists.
    Project(String),
    /// Use of axes by its programs.
    Programs(BTreeMap<String, AxisUse>),
}

impl Outline {
    /// Collects the axes that programs use, executed or not.
    pub fn of_programs(texts: impl IntoIterator<Item = String>) -> Self {
        let mut uses: BTreeMap<String, AxisUse> = BTreeMap::new();
        for (name, how) in texts.into_iter().flat_map(|text| axis_uses(&text)) {
            let known = uses.entry(name).or_insert(how);
            *known = how.max(*known);
        }
        Self::Programs(uses)
    }

    /// Returns the axes in the usual order, longer names last; none if a start-up list names them.
    pub fn axes(&self) -> Vec<(&str, AxisUse)> {
        const USUAL: &str = "XYZABCUVW";
        let Self::Programs(uses) = self else {
            return Vec::new();
        };
        let mut axes: Vec<_> = uses
            .iter()
            .map(|(name, how)| (name.as_str(), *how))
            .collect();
        axes.sort_by_key(|(name, _)| (name.len() > 1, USUAL.find(name)));
        axes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_come_in_the_usual_order() {
        // R9.73
        let texts = ["G0 C1 Z2 X2=3", "X[COMP OFF FRICT]\nX1 M30"].map(str::to_owned);
        let outline = Outline::of_programs(texts);
        let expected = [
            ("X", AxisUse::Switched),
            ("Z", AxisUse::Named),
            ("C", AxisUse::Named),
            ("X2", AxisUse::Named),
        ];
        assert_eq!(outline.axes(), expected);
        assert!(Outline::Startup("h.lis".to_owned()).axes().is_empty());
    }
}
