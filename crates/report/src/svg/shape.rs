//! The shapes of states, which need no colour: full, hollow, half full, a line, dashed; striped if a state
//! is not the start-up state.

use super::canvas::{Area, Canvas};
use frictcomp::comp::State;

/// The content of a bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum BandState {
    /// One state over the whole bar.
    One(State),
    /// State that changes too often to be drawn.
    Changing,
}

impl BandState {
    /// Every state, in the order of the legend.
    const ALL: [Self; 6] = [
        Self::One(State::Active),
        Self::One(State::Ineffective),
        Self::One(State::Inactive),
        Self::One(State::Unconfigured),
        Self::One(State::Unknown),
        Self::Changing,
    ];

    /// Returns the class of the colours of what is only on or off.
    pub(super) fn side(self) -> &'static str {
        match self {
            Self::One(State::Active) => "fc-on",
            _ => "fc-off",
        }
    }

    /// Returns the word in and below the bars.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::One(state) => state.as_str(),
            Self::Changing => "changing",
        }
    }
}

/// Relation of a state to the start-up state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum StartUpRelation {
    /// The start-up state, or an unknown one.
    #[default]
    StartUp,
    /// Another state, which outlives the program.
    Away,
}

impl StartUpRelation {
    /// Returns the relation. Only a state that a command switches can be away from its start-up state.
    pub fn of(state: State, start_up: State) -> Self {
        let switched = matches!(state, State::Active | State::Inactive);
        if switched && state != start_up {
            Self::Away
        } else {
            Self::StartUp
        }
    }
}

/// The height of a bar in a row.
pub(super) const BAR: f64 = 18.0;

/// Appearance of a bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct BarShape {
    pub(super) state: BandState,
    pub(super) relation: StartUpRelation,
}

impl BarShape {
    /// Returns every shape, in the order of the legend.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let relations = [StartUpRelation::StartUp, StartUpRelation::Away];
        BandState::ALL
            .into_iter()
            .flat_map(move |state| relations.map(|relation| Self { state, relation }))
    }

    /// Returns the name of the shape for the legend.
    pub(super) fn name(self) -> String {
        let word = self.state.as_str();
        match self.relation {
            StartUpRelation::Away => format!("{word}, not start-up"),
            StartUpRelation::StartUp => word.to_owned(),
        }
    }

    pub(super) fn draw(self, canvas: &mut Canvas<'_>, area: Area) {
        let middle = area.y + area.height / 2.0;
        let along = [(area.x, middle), (area.right(), middle)];
        match self.state {
            BandState::One(State::Active) => canvas.rect("fc-active", area),
            BandState::One(State::Inactive) => canvas.rect("fc-inactive", area),
            BandState::One(State::Ineffective) => {
                canvas.rect("fc-outline", area);
                let half = Area {
                    y: area.bottom() - 4.0,
                    height: 4.0,
                    ..area
                };
                canvas.rect("fc-half", half);
            }
            BandState::One(State::Unconfigured) => {
                // An invisible bar makes the whole row a target for the pointer.
                canvas.rect("fc-ground", area);
                canvas.line("fc-absent", along[0], along[1]);
            }
            BandState::One(State::Unknown) => canvas.rect("fc-unknown", area),
            BandState::Changing => canvas.rect("fc-mixed", area),
        }
        if self.relation == StartUpRelation::Away {
            let low = if area.height < BAR { " fc-low" } else { "" };
            let side = self.state.side();
            canvas.line(&format!("fc-stripes {side}{low}"), along[0], along[1]);
        }
    }
}
