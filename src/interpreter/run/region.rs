//! The possible effects of a region of a program, and its exits (R2.51).

use std::collections::HashSet;
use std::hash::Hash;

use super::event::EndedBy;
use crate::comp::{AxisIndex, KindSet};
use crate::interpreter::programs::index::{EntryIndex, LabelName};
use crate::interpreter::programs::wanted::{FunctionWord, WantedCall};
use crate::interpreter::values::location::Location;
use crate::language::{HashWords, Simplification};
use crate::syntax::ast::Owner;
use crate::syntax::{Subscripts, VariableName};
use crate::text::Span;

/// Something that a region could change.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum RegionEffect {
    /// These kinds on this axis.
    Compensation(String, KindSet),
    /// A G function comes into force; `None` for one that is not known.
    G(Option<i64>),
    /// The feeds.
    Feeds,
    /// The speed of the main spindle.
    Spindle,
    /// Programmed overrides.
    Overrides,
    /// The trace follows the path or its velocity in a simpler way than the control.
    Simplified(Simplification),
    /// The radius of circles.
    Radius,
    /// The position of an axis.
    Position(AxisIndex),
    /// The position of any axis.
    Positions,
    /// The offset of G92 of an axis.
    Reference(AxisIndex),
    /// A `#` command.
    Hash(HashWords),
    /// These axes may follow others from here on, or no longer.
    Followers(Vec<AxisIndex>),
    /// A coupling group is defined with these axes.
    Coupling(Vec<AxisIndex>),
    /// A declaration.
    Declaration(VariableName),
    /// A G, M, T or D word, which may call a program.
    Function(FunctionWord),
    /// A macro is defined.
    Macro(String),
    /// A word gets another program by `#FILE NAME`.
    FileName(String),
    /// The PLC acts by design (R2.99).
    Plc,
    /// Everything, through a call of an unknown program.
    All,
    /// Everything that any local subprogram of the file does, through a call of an unknown one.
    AnyLocal(Span),
}

/// Exit from a region other than its end.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum Exit {
    /// A jump of the same program.
    Label(LabelName),
    /// A jump to an unknown place.
    AnyLabel,
    /// `$BREAK`, `$CONTINUE`.
    Block(EntryIndex),
    /// M17, M29.
    Return,
    /// M17, M29 over several programs or to a label.
    Far,
    /// M02, M30.
    End,
}

impl Exit {
    /// Returns the exit to a label.
    pub(crate) fn label(name: &str) -> Self {
        Self::Label(LabelName::Text(name.trim_matches(['[', ']']).to_owned()))
    }
}

/// Possible effects of a region.
#[derive(Debug, Default)]
pub(crate) struct Region {
    pub(crate) effects: Vec<RegionEffect>,
    pub(crate) targets: Vec<Location>,
    /// The targets, to ask whether something is one.
    pub(crate) written: HashSet<Location>,
    pub(crate) calls: Vec<WantedCall>,
    pub(crate) exits: Vec<Exit>,
    /// Its blocks that end the program, each with its unit.
    pub(crate) ends: Vec<((usize, EntryIndex), EndedBy)>,
    /// Whether an error ends the program in it.
    pub(crate) is_refused: bool,
    /// The macros that it was looked through with.
    pub(crate) macro_version: u64,
}

impl Region {
    /// A block ends the program by M30 or M02.
    pub(crate) fn end_at(&mut self, place: (usize, EntryIndex)) {
        self.ends.push((place, EndedBy::M30));
    }

    /// An error ends the program at a block, where one does.
    pub(crate) fn refuse_if(&mut self, is_refused: bool, place: (usize, EntryIndex)) {
        if is_refused {
            self.is_refused = true;
            self.ends.push((place, EndedBy::Error));
        }
    }

    /// Whether it could define a coupling.
    pub(crate) fn couples(&self) -> bool {
        let mut effects = self.effects.iter();
        effects.any(|effect| matches!(effect, RegionEffect::Coupling(_)))
    }

    /// Whether it could switch a compensation.
    pub(crate) fn switches(&self) -> bool {
        let mut effects = self.effects.iter();
        effects.any(|effect| matches!(effect, RegionEffect::Compensation(..)))
    }

    /// Whether it could move an axis.
    pub(crate) fn moves(&self) -> bool {
        let moves = |effect: &RegionEffect| {
            matches!(
                effect,
                RegionEffect::Position(_) | RegionEffect::Positions | RegionEffect::All
            )
        };
        self.effects.iter().any(moves)
    }

    /// Whether the region could write what was written.
    pub(crate) fn writes(&self, written: &Location) -> bool {
        let whole = match written {
            Location::Parameter(Owner::Program, _) => self.written.contains(&Location::Parameters),
            Location::Variable(name) if name.is_element() => {
                let array = name.at(Subscripts::default());
                self.written.contains(&Location::Elements(array))
            }
            _ => false,
        };
        whole || self.written.contains(written)
    }
}
