//! The channel in which a program runs: it knows only the axes that the channel list names (R3.13). Which channel that is
//! nobody says, so that it follows from the axes that the program uses.

use crate::comp::{AxisIndex, CompensationError};
use crate::diagnostic::Code;
use crate::interpreter::block::BlockContext;
use crate::interpreter::executor::{Executor, RunState};
use crate::machine::{ChannelsOfAxis, Machine};
use crate::syntax::Fault;
use crate::text::{Span, in_a_row};

/// The error by which the control refuses an axis that the channel does not have (tf5200, 251080843).
const NOT_IN_CHANNEL: u32 = 20200;

/// Answer of the channel lists to the use of an axis.
enum InChannel {
    Present,
    /// Axis that the channel has only on some ways, or as far as is assumed; the reason.
    Perhaps(String),
    /// Axis that no channel has together with those before; the reason.
    Absent(String),
}

impl Executor {
    /// Returns the refusal of a COMP command on an axis that the channel does not have, and reports where the control
    /// may refuse it.
    pub(crate) fn refuse_other_channel(
        &mut self,
        axis: AxisIndex,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<(), CompensationError> {
        match self.in_channel(axis) {
            InChannel::Present => Ok(()),
            InChannel::Perhaps(why) => {
                self.may_refuse(NOT_IN_CHANNEL, &why, span, at);
                Ok(())
            }
            InChannel::Absent(why) => Err(CompensationError::NotInChannel {
                axis: self.machine.axis(axis).name.clone(),
                why,
            }),
        }
    }

    /// Checks that the channel has the axis of a word, once per axis and program.
    pub(crate) fn check_channel(
        &mut self,
        axis: AxisIndex,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        match self.in_channel(axis) {
            InChannel::Perhaps(why) => {
                self.may_refuse(NOT_IN_CHANNEL, &why, span, at);
                Ok(())
            }
            InChannel::Absent(why) if self.state.is_new_word(&why) => {
                Err(Fault::refused(Code::PErr20200, span, why))
            }
            InChannel::Present | InChannel::Absent(_) => Ok(()),
        }
    }

    /// Returns whether nothing limits an axis to some channels.
    #[inline]
    pub(crate) fn is_in_all_channels(&self, axis: AxisIndex) -> bool {
        matches!(self.machine.axis(axis).channels, ChannelsOfAxis::Unsaid)
    }

    /// Returns whether the channel has an axis, and notes that the program uses it.
    #[inline]
    fn in_channel(&mut self, axis: AxisIndex) -> InChannel {
        if self.is_in_all_channels(axis) {
            return InChannel::Present;
        }
        self.judge_channel(axis)
    }

    #[cold]
    fn judge_channel(&mut self, axis: AxisIndex) -> InChannel {
        let machine = &self.machine;
        let name = &machine.axis(axis).name;
        let is_known = self.state.once.contains(&UsedOn::AllWays.mark(name));
        if is_known || self.state.control.channel_axes.has(name) {
            return InChannel::Present;
        }
        let [absent, perhaps] = [UsedOn::AllWays, UsedOn::SomeWays]
            .map(|used| self.state.other_in_channel(machine, axis, used));
        let is_listed = matches!(machine.axis(axis).channels, ChannelsOfAxis::Listed(_));
        let (used, found) = match (absent, perhaps) {
            (Some(why), _) if is_listed => return InChannel::Absent(why),
            // On the way that goes on, the channel has it.
            (Some(why), _) | (None, Some(why)) => (UsedOn::AllWays, InChannel::Perhaps(why)),
            (None, None) if self.state.track.reach.is_always() => {
                (UsedOn::AllWays, InChannel::Present)
            }
            (None, None) => (UsedOn::SomeWays, InChannel::Present),
        };
        self.state.once.insert(used.mark(name));
        found
    }
}

/// Ways on which a program uses an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum UsedOn {
    AllWays,
    SomeWays,
}

impl UsedOn {
    /// Returns the word by which the program remembers that it used an axis.
    fn mark(self, name: &str) -> String {
        match self {
            Self::AllWays => format!("the channel has axis {name}"),
            Self::SomeWays => format!("on some ways the channel has axis {name}"),
        }
    }
}

impl RunState {
    /// Returns why no channel has an axis together with the axes that the program has used before.
    fn other_in_channel(&self, machine: &Machine, axis: AxisIndex, ways: UsedOn) -> Option<String> {
        let own = machine.axis(axis);
        let used_on = |used: UsedOn, name: &str| self.once.contains(&used.mark(name));
        let is_used = |name: &str| {
            used_on(UsedOn::AllWays, name)
                || (ways == UsedOn::SomeWays && used_on(UsedOn::SomeWays, name))
        };
        let used = machine.axes.iter().filter(|it| is_used(&it.name));
        let mut channels = own.channels.among(None);
        if channels.as_ref().is_some_and(Vec::is_empty) {
            return Some(format!("no channel list names axis `{}`", own.name));
        }
        let mut together = Vec::new();
        for other in used {
            together.push(format!("`{}`", other.name));
            channels = other.channels.among(channels);
            if channels.as_ref().is_some_and(Vec::is_empty) {
                let together: Vec<&str> = together.iter().map(String::as_str).collect();
                return Some(format!(
                    "no channel has axis `{}` together with {}, which the program uses",
                    own.name,
                    in_a_row(&together)
                ));
            }
        }
        None
    }
}
