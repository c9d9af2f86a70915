//! The statements that open, part and close control blocks.

use super::ast::{Block, Flow, Item};
use crate::language::HashAction;

/// A kind of control block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ControlBlock {
    /// `$IF`.
    If,
    /// `$SWITCH`.
    Switch,
    /// `$FOR`.
    For,
    /// `$WHILE`.
    While,
    /// `$DO`.
    Do,
    /// `$REPEAT`.
    Repeat,
    /// `#RT WHILE`, which real time leaves (tf5261, 783727499).
    RealTime,
}

/// Part of a statement in its control block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Start of the block.
    Opener,
    /// Start of another branch of the block.
    Branch,
    /// End of the block.
    Closer,
}

impl ControlBlock {
    pub(crate) const ALL: [Self; 7] = [
        Self::If,
        Self::Switch,
        Self::For,
        Self::While,
        Self::Do,
        Self::Repeat,
        Self::RealTime,
    ];

    pub(crate) fn opener(self) -> &'static str {
        self.words().0
    }

    pub(crate) fn closer(self) -> &'static str {
        self.words().1
    }

    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::If => ("$IF", "$ENDIF"),
            Self::Switch => ("$SWITCH", "$ENDSWITCH"),
            Self::For => ("$FOR", "$ENDFOR"),
            Self::While => ("$WHILE", "$ENDWHILE"),
            Self::Do => ("$DO", "$ENDDO"),
            Self::Repeat => ("$REPEAT", "$UNTIL"),
            Self::RealTime => ("#RT WHILE", "#RT ENDWHILE"),
        }
    }
}

/// Returns the control block that an item of a block belongs to, and its part in it. `$IF c $GOTO N10` opens none.
pub fn control_part(block: &Block, item: &Item) -> Option<(ControlBlock, Part)> {
    use ControlBlock::{Do, For, If, RealTime, Repeat, Switch, While};
    use Part::{Branch, Closer, Opener};
    let flow = match item {
        Item::Flow(flow, _) => flow,
        Item::Hash(hash) => {
            return match hash.command.action {
                HashAction::RealTimeLoop => Some((RealTime, Opener)),
                HashAction::EndRealTimeLoop => Some((RealTime, Closer)),
                _ => None,
            };
        }
        _ => return None,
    };
    Some(match flow {
        Flow::If(_) if block.jumps => return None,
        Flow::If(_) => (If, Opener),
        Flow::ElseIf(_) | Flow::Else => (If, Branch),
        Flow::EndIf => (If, Closer),
        Flow::Switch(..) => (Switch, Opener),
        Flow::Case(_) | Flow::Default => (Switch, Branch),
        Flow::EndSwitch => (Switch, Closer),
        Flow::For { .. } => (For, Opener),
        Flow::EndFor => (For, Closer),
        Flow::While(_) => (While, Opener),
        Flow::EndWhile => (While, Closer),
        Flow::Do(_) => (Do, Opener),
        Flow::EndDo(_) => (Do, Closer),
        Flow::Repeat => (Repeat, Opener),
        Flow::Until(_) => (Repeat, Closer),
        Flow::Break | Flow::Continue | Flow::Goto(_) => return None,
    })
}
