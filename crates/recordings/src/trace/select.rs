//! Finding channels by name, comment or symbol, or as an object of the CNC (R6.3).

use std::borrow::Cow;

use serde::Serialize;

use super::channel::{Channel, ChannelIndex, CncObject, parse_address};
use super::error::SelectError;
use super::recognised::ChannelRole;
use super::unit::ChannelQuantity::Position;
use super::unit::{ChannelQuantity, Unit, split_unit};
use frictcomp::diagnostic::did_you_mean;
use frictcomp_physics::current::POSITION_UNITS_PER_MM;

/// Selection of the channels of a trace by the user.
#[derive(Debug, Clone, Default, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ChannelSelection {
    /// The axis whose channels are meant, by its name or its number; `%` stands for it in the names below.
    pub axis: Option<String>,
    /// The channel of the times.
    pub time: Option<String>,
    /// The channel of the positions.
    pub position: Option<String>,
    /// The channel of the velocities.
    pub velocity: Option<String>,
    /// The channel of the torque or the current.
    pub torque: Option<String>,
    /// The channel of the actual positions, in addition to that of the commanded ones.
    pub actual_position: Option<String>,
    /// The channel of the following error, commanded less actual position.
    pub following_error: Option<String>,
    /// Units of channels that the file does not name, or names wrongly.
    pub units: Vec<(String, Unit)>,
    /// Whether the units are those of several recordings, each of which need not have every channel.
    pub is_for_several: bool,
    /// The way of the axis in mm in a turn of its motor, where positions and velocities are those of the motor.
    pub lead_mm: Option<f64>,
}

/// A channel that was found, with the conversion of its samples to the units of lists and traces.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pick {
    /// Index of the channel.
    pub channel: ChannelIndex,
    /// Unit.
    pub unit: Unit,
    /// Whether the unit is assumed to be that of the CNC, because none is named.
    pub is_unit_assumed: bool,
}

/// The names by which channels are chosen without a request, and words that hint at them.
struct ChannelNames {
    quantity: ChannelQuantity,
    taken: &'static [&'static str],
    hints: &'static [&'static str],
}

/// Hints for each quantity; the first hint that is found in a name counts.
const NAMES: [ChannelNames; 4] = [
    ChannelNames {
        quantity: ChannelQuantity::Time,
        taken: &["t", "time", "zeit"],
        hints: &["time", "zeit", "stamp"],
    },
    ChannelNames {
        quantity: ChannelQuantity::Position,
        taken: &["x"],
        hints: &["cmdpos", "setpos", "pos", "weg", "lage"],
    },
    ChannelNames {
        quantity: ChannelQuantity::Velocity,
        taken: &["v"],
        hints: &["cmdvel", "setvel", "vel", "speed", "geschw", "drehzahl"],
    },
    ChannelNames {
        quantity: ChannelQuantity::Torque,
        taken: &["torque"],
        hints: &[
            "acttorque",
            "torque",
            "curr",
            "moment",
            "strom",
            "force",
            "kraft",
        ],
    },
];

impl ChannelSelection {
    fn asked(&self, quantity: ChannelQuantity) -> Option<&str> {
        match quantity {
            ChannelQuantity::Time => self.time.as_deref(),
            ChannelQuantity::Position => self.position.as_deref(),
            ChannelQuantity::Velocity => self.velocity.as_deref(),
            ChannelQuantity::Torque => self.torque.as_deref(),
        }
    }

    /// Returns the channel of a quantity, if there is one: that which the user names, else that of its short name, else
    /// the only one that is recognised.
    ///
    /// # Errors
    /// No channel fits what the user names, or several do; or it is in an unknown unit.
    pub fn find(
        &self,
        quantity: ChannelQuantity,
        channels: &[Channel],
    ) -> Result<Option<Pick>, SelectError> {
        let found = match self.asked(quantity) {
            Some(wanted) => Some(self.named(wanted, channels).map_err(|error| {
                // No channel has a similar spelling, but one of a similar kind may be meant.
                error.or_guess(|| guess(quantity, channels))
            })?),
            None => Self::taken(quantity, channels)?
                .or_else(|| only(&self.candidates_for(quantity, channels), channels)),
        };
        let Some(channel) = found else {
            return Ok(None);
        };
        let pick = self.pick(channel, quantity, channels)?;
        match channels[channel.0].named_unit() {
            // Torque may be in units of the drive.
            Some(unit) if quantity != ChannelQuantity::Torque && pick.is_unit_assumed => {
                Err(SelectError::UnknownUnit {
                    channel: channels[channel.0].name.clone(),
                    quantity,
                    unit: unit.to_owned(),
                })
            }
            _ => Ok(Some(pick)),
        }
    }

    /// Returns the only channel of the axis that is recognised as a quantity.
    ///
    /// # Errors
    /// Scope scales its unit.
    pub fn recognised(
        &self,
        role: ChannelRole,
        channels: &[Channel],
    ) -> Result<Option<Pick>, SelectError> {
        only(&self.candidates(role, channels), channels)
            .map(|channel| self.pick(channel, role.quantity(), channels))
            .transpose()
    }

    /// Checks that found channels are those of one axis, as far as the user names neither it nor them. A name and a number
    /// may be those of one axis.
    ///
    /// # Errors
    /// They are those of several.
    pub fn check_axis(
        &self,
        found: impl Iterator<Item = (ChannelQuantity, Pick)>,
        channels: &[Channel],
    ) -> Result<(), SelectError> {
        let is_number = |axis: &str| axis.parse::<u32>().is_ok();
        let mut earlier: Vec<String> = Vec::new();
        let unnamed = found.filter(|it| self.axis.is_none() && self.asked(it.0).is_none());
        for (quantity, pick) in unnamed {
            let Some(axis) = channels[pick.channel.0].recognised().and_then(|it| it.axis) else {
                continue;
            };
            let is_other = |it: &&String| is_number(it) == is_number(&axis) && **it != axis;
            if let Some(first) = earlier.iter().find(is_other) {
                return Err(SelectError::Lacks {
                    lacks: format!("no {} of {first}", quantity.as_str()),
                    found: shown(channels),
                    help: format!("it has that of {axis}; name the axis, or the channel"),
                });
            }
            earlier.push(axis);
        }
        Ok(())
    }

    /// Returns an error if the recording has the quantity only for other axes than that of the user.
    fn of_other_axes(
        &self,
        quantity: ChannelQuantity,
        channels: &[Channel],
    ) -> Option<SelectError> {
        let axis = self.axis.as_ref()?;
        let others = Self::default()
            .candidates_for(quantity, channels)
            .into_iter();
        let others = others.filter_map(|at| channels[at].recognised()?.axis);
        let others: Vec<String> = others.collect();
        (!others.is_empty()).then(|| SelectError::Lacks {
            lacks: format!("no {} of {axis}", quantity.as_str()),
            found: shown(channels),
            help: format!(
                "it has that of {}; name any other channel",
                others.join(", ")
            ),
        })
    }

    fn candidates_for(&self, quantity: ChannelQuantity, channels: &[Channel]) -> Vec<usize> {
        let role = ChannelRole::of(quantity);
        role.map_or_else(Vec::new, |role| self.candidates(role, channels))
    }

    /// Returns the channels that are recognised as a quantity: those of the axis, or else those that name none.
    fn candidates(&self, role: ChannelRole, channels: &[Channel]) -> Vec<usize> {
        let recognised = channels.iter().enumerate().filter_map(|(at, channel)| {
            let found = channel.recognised().filter(|it| it.role == role)?;
            Some((at, found.axis))
        });
        let recognised: Vec<(usize, Option<String>)> = recognised.collect();
        let all = || recognised.iter();
        let Some(own) = &self.axis else {
            return all().map(|it| it.0).collect();
        };
        let is_own = |(at, axis): &&(usize, Option<String>)| {
            let is_named = axis.as_ref().is_some_and(|it| it.eq_ignore_ascii_case(own));
            is_named || self.is_of_axis(&channels[*at])
        };
        let found: Vec<usize> = all().filter(is_own).map(|it| it.0).collect();
        if !found.is_empty() {
            return found;
        }
        // A number may be that of the axis.
        let is_open = |it: &String| it.parse::<u32>().is_ok() && own.parse::<u32>().is_err();
        let open = all().filter(|it| it.1.as_ref().is_none_or(is_open));
        open.map(|it| it.0).collect()
    }

    /// Finds a channel that must exist.
    ///
    /// # Errors
    /// There is none.
    pub fn require(
        &self,
        quantity: ChannelQuantity,
        channels: &[Channel],
    ) -> Result<Pick, SelectError> {
        self.find(quantity, channels)?.ok_or_else(|| {
            let name = quantity.as_str();
            let several = self.candidates_for(quantity, channels);
            if !several.is_empty() {
                return several_fit(name, &several, channels);
            }
            if let Some(lacking) = self.of_other_axes(quantity, channels) {
                return lacking;
            }
            SelectError::Lacks {
                lacks: format!("no channel that is known to be the {name}"),
                found: shown(channels),
                help: match guess(quantity, channels) {
                    Some(guess) => format!("name it; perhaps `{guess}` is the {name}"),
                    None => {
                        "name the channel, by its name, its comment or as a CNC object".to_owned()
                    }
                },
            }
        })
    }

    /// Returns a channel by the user's description, with the unit for a quantity.
    ///
    /// # Errors
    /// No channel fits, or several do.
    pub fn pick_named(
        &self,
        wanted: &str,
        quantity: ChannelQuantity,
        channels: &[Channel],
    ) -> Result<Pick, SelectError> {
        self.pick(self.named(wanted, channels)?, quantity, channels)
    }

    /// Returns the channel of the positions of an axis: the one that has the name of the axis alone, with its unit if
    /// that is one of positions, in mm where it names none; or the one that is recognised as the actual position of the
    /// axis.
    ///
    /// # Errors
    /// Scope scales the unit.
    pub fn position_of(
        &self,
        axis: &str,
        channels: &[Channel],
    ) -> Result<Option<Pick>, SelectError> {
        let found = channels.iter().position(|channel| {
            let name = split_unit(&channel.name).0;
            let unit = channel.named_unit().map(Unit::parse);
            let fits = unit.is_none_or(|unit| unit.is_some_and(|it| it.quantity == Position));
            name.eq_ignore_ascii_case(axis) && fits
        });
        let Some(channel) = found else {
            return self.actual_position_of(axis, channels);
        };
        let mut pick = self.pick(ChannelIndex(channel), Position, channels)?;
        if pick.is_unit_assumed {
            pick.unit.factor = POSITION_UNITS_PER_MM;
            pick.is_unit_assumed = false;
        }
        Ok(Some(pick))
    }

    /// Returns the only channel that is recognised as the actual position of an axis, by its name or its number.
    ///
    /// # Errors
    /// Scope scales the unit.
    pub fn actual_position_of(
        &self,
        axis: &str,
        channels: &[Channel],
    ) -> Result<Option<Pick>, SelectError> {
        let is_own = |channel: &Channel| {
            channel.recognised().is_some_and(|it| {
                let own = it.axis.filter(|it| it.eq_ignore_ascii_case(axis));
                it.role == ChannelRole::ActualPosition && own.is_some()
            })
        };
        let found: Vec<usize> = (0..channels.len())
            .filter(|&at| is_own(&channels[at]))
            .collect();
        only(&found, channels)
            .map(|channel| self.pick(channel, Position, channels))
            .transpose()
    }

    /// Returns the channel that has the short name of a quantity.
    fn taken(
        quantity: ChannelQuantity,
        channels: &[Channel],
    ) -> Result<Option<ChannelIndex>, SelectError> {
        let names = NAMES.iter().filter(|names| names.quantity == quantity);
        for name in names.flat_map(|names| names.taken) {
            let is_so = |channel: &Channel| split_unit(&channel.name).0.eq_ignore_ascii_case(name);
            let found: Vec<usize> = (0..channels.len())
                .filter(|&at| is_so(&channels[at]))
                .collect();
            match (only(&found, channels), quantity) {
                (Some(channel), _) => return Ok(Some(channel)),
                (None, _) if found.is_empty() => {}
                // Each channel may have a column of its times.
                (None, ChannelQuantity::Time) => return Ok(Some(ChannelIndex(found[0]))),
                (None, _) => return Err(several_fit(name, &found, channels)),
            }
        }
        Ok(None)
    }

    /// Returns the name of a channel with that of the axis in place of `%`, and with `%` in place of `%%`. A name
    /// that a channel has exactly as it is written stays.
    fn with_axis<'a>(&self, wanted: &'a str, channels: &[Channel]) -> Cow<'a, str> {
        let is_name = |it: &Channel| it.name == wanted || it.symbol == wanted;
        match &self.axis {
            Some(axis) if wanted.contains('%') && !channels.iter().any(is_name) => {
                let between = wanted.split("%%").map(|it| it.replace('%', axis));
                between.collect::<Vec<_>>().join("%").into()
            }
            _ => wanted.into(),
        }
    }

    fn named(&self, wanted: &str, channels: &[Channel]) -> Result<ChannelIndex, SelectError> {
        let wanted = &*self.with_axis(wanted.trim(), channels);
        let object = parse_object(wanted);
        // From an exact fit to a loose one; the first that finds any decides.
        let fits: [&dyn Fn(&Channel) -> bool; 7] = [
            &|channel| channel.name == wanted,
            &|channel| channel.symbol == wanted,
            &|channel| {
                channel
                    .object
                    .is_some_and(|it| object.is_some_and(|ours| ours.fits(it)))
            },
            &|channel| channel.name.eq_ignore_ascii_case(wanted),
            &|channel| split_unit(&channel.name).0.eq_ignore_ascii_case(wanted),
            &|channel| channel.comment == wanted,
            &|channel| holds(&channel.comment, wanted) || holds(&channel.symbol, wanted),
        ];
        for fits in fits {
            let mut found: Vec<usize> = (0..channels.len())
                .filter(|&index| fits(&channels[index]))
                .collect();
            if found.len() > 1 {
                let of_axis: Vec<usize> = found
                    .iter()
                    .copied()
                    .filter(|&index| self.is_of_axis(&channels[index]))
                    .collect();
                if !of_axis.is_empty() {
                    found = of_axis;
                }
            }
            match only(&found, channels) {
                Some(channel) => return Ok(channel),
                None if found.is_empty() => {}
                None => return Err(several_fit(wanted, &found, channels)),
            }
        }
        let names = channels.iter().map(|channel| channel.name.as_str());
        Err(SelectError::None {
            wanted: wanted.to_owned(),
            found: shown(channels),
            guess: did_you_mean(wanted, names).map(str::to_owned),
        })
    }

    /// Returns whether a channel is one of the axis that the user names.
    pub(crate) fn is_of_axis(&self, channel: &Channel) -> bool {
        let Some(axis) = &self.axis else {
            return false;
        };
        if let (Ok(number), Some(object)) = (axis.parse::<u32>(), channel.object) {
            return object.axis() == number;
        }
        [&channel.name, &channel.symbol, &channel.comment]
            .into_iter()
            .any(|text| {
                let mut words = text.split(|letter: char| !letter.is_alphanumeric());
                words.any(|word| word.eq_ignore_ascii_case(axis))
            })
    }

    /// Returns the channel whose unit the user gives.
    fn unit_target(
        &self,
        name: &str,
        channels: &[Channel],
    ) -> Result<Option<ChannelIndex>, SelectError> {
        match self.named(name, channels) {
            Ok(channel) => Ok(Some(channel)),
            Err(error @ SelectError::None { .. }) if !self.is_for_several => Err(error),
            Err(_) => Ok(None),
        }
    }

    fn pick(
        &self,
        channel: ChannelIndex,
        quantity: ChannelQuantity,
        channels: &[Channel],
    ) -> Result<Pick, SelectError> {
        let described = &channels[channel.0];
        let mut of_user = None;
        for (name, unit) in &self.units {
            let mut quantities = ChannelQuantity::ALL.iter();
            let named = quantities.find(|it| it.as_str().eq_ignore_ascii_case(name));
            let is_meant = match named {
                Some(named) => *named == quantity,
                None => self.unit_target(name, channels)? == Some(channel),
            };
            if is_meant {
                of_user = Some(*unit);
            }
        }
        if let Some(unit) = of_user.filter(|unit| unit.quantity != quantity) {
            return Err(SelectError::OtherUnit {
                channel: described.name.clone(),
                quantity,
                given: unit.quantity,
            });
        }
        let of_file = described.named_unit().and_then(Unit::parse);
        if let Some([factor, offset]) = described.unit_scale
            && of_user.is_none()
            && quantity != ChannelQuantity::Time
        {
            return Err(SelectError::UnitScaled {
                channel: described.name.clone(),
                unit: described.unit.clone().unwrap_or_default(),
                factor: factor.to_string().into(),
                offset: offset.to_string().into(),
                quantity,
            });
        }
        if of_user.is_none() && of_file.is_some_and(|unit| unit.quantity != quantity) {
            return Err(SelectError::UnknownUnit {
                channel: described.name.clone(),
                quantity,
                unit: described.named_unit().unwrap_or_default().to_owned(),
            });
        }
        let unit = of_user.or(of_file);
        let along = |unit: Unit| {
            self.lead_mm
                .map_or(unit, |lead_mm| unit.along_path(lead_mm))
        };
        Ok(Pick {
            channel,
            unit: unit.map_or(Unit::own(quantity), along),
            is_unit_assumed: unit.is_none(),
        })
    }
}

/// Returns the names of channels, for a list of the existing ones.
fn shown(channels: &[Channel]) -> Vec<String> {
    channels
        .iter()
        .map(|channel| channel.name.clone())
        .collect()
}

fn holds(text: &str, wanted: &str) -> bool {
    wanted.len() > 2 && text.to_lowercase().contains(&wanted.to_lowercase())
}

/// Returns the only one of some channels; Scope writes a channel once for each chart that shows it.
fn only(found: &[usize], channels: &[Channel]) -> Option<ChannelIndex> {
    let first = found.first()?;
    all_alike(found, channels).then_some(ChannelIndex(*first))
}

fn several_fit(wanted: &str, found: &[usize], channels: &[Channel]) -> SelectError {
    let found = found.iter().map(|&index| full_name(&channels[index]));
    SelectError::Several {
        wanted: wanted.to_owned(),
        found: found.collect(),
    }
}

fn all_alike(found: &[usize], channels: &[Channel]) -> bool {
    found.windows(2).all(|pair| {
        let [one, other] = [&channels[pair[0]], &channels[pair[1]]];
        !one.symbol.is_empty()
            && one.symbol == other.symbol
            && one.sample_time_s == other.sample_time_s
    })
}

fn full_name(channel: &Channel) -> String {
    let more = [
        channel.symbol.clone(),
        channel
            .object
            .map(|object| object.to_string())
            .unwrap_or_default(),
    ];
    let more: Vec<String> = more.into_iter().filter(|it| !it.is_empty()).collect();
    if more.is_empty() {
        channel.name.clone()
    } else {
        format!("{} ({})", channel.name, more.join(", "))
    }
}

/// Returns the channel that by its name, symbol or comment may be a quantity.
pub(super) fn guess(quantity: ChannelQuantity, channels: &[Channel]) -> Option<String> {
    let names = NAMES.iter().find(|names| names.quantity == quantity)?;
    names.hints.iter().find_map(|hint| {
        let fits = |channel: &&Channel| {
            let texts = [&channel.name, &channel.symbol, &channel.comment];
            texts.into_iter().any(|text| {
                let letters = text.to_lowercase().replace(['_', ' ', '.'], "");
                letters.contains(hint)
            })
        };
        channels
            .iter()
            .find(fits)
            .map(|channel| channel.name.clone())
    })
}

/// A CNC object as the user writes it.
#[derive(Debug, Clone, Copy)]
enum WantedObject {
    /// `0x120300:0x10017`.
    Whole(CncObject),
    /// `0x10017`, an offset with its axis.
    Offset(u32),
    /// `0x17`, the object of any axis.
    Element(u32),
}

impl WantedObject {
    fn fits(self, object: CncObject) -> bool {
        match self {
            Self::Whole(whole) => whole == object,
            Self::Offset(offset) => offset == object.offset,
            Self::Element(element) => element == object.element(),
        }
    }
}

fn parse_object(text: &str) -> Option<WantedObject> {
    let is_hex = |text: &str| text.starts_with("0x") || text.starts_with("0X");
    match text.split_once([':', ',', '/']) {
        Some((group, offset)) => Some(WantedObject::Whole(CncObject {
            group: parse_address(group)?,
            offset: parse_address(offset)?,
        })),
        None if is_hex(text) => match parse_address(text)? {
            element @ 0..=0xffff => Some(WantedObject::Element(element)),
            offset => Some(WantedObject::Offset(offset)),
        },
        None => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(name: &str, comment: &str, offset: u32) -> Channel {
        Channel {
            name: name.to_owned(),
            comment: comment.to_owned(),
            object: Some(CncObject {
                group: 0x12_0300,
                offset,
            }),
            ..Channel::default()
        }
    }

    fn two_axes() -> [Channel; 4] {
        [
            channel("ActTorque", "torque of X", 0x1_0017),
            channel("ActTorque", "torque of Y", 0x2_0017),
            channel("SetVelo [mm/s]", "", 0x1_0005),
            channel("Position", "", 0x1_0003),
        ]
    }

    #[test]
    fn channels_are_found_by_name_comment_and_object() {
        // R6.3
        let selection = ChannelSelection::default();
        let find = |wanted: &str| selection.named(wanted, &two_axes()).map(|it| it.0);
        assert_eq!(find("Position"), Ok(3));
        assert_eq!(find("setvelo"), Ok(2));
        assert_eq!(find("torque of Y"), Ok(1));
        assert_eq!(find("0x120300:0x20017"), Ok(1));
        assert_eq!(find("0x10017"), Ok(0));
        assert_eq!(find("1180416:131095"), Ok(1));
        assert!(matches!(
            find("ActTorque"),
            Err(SelectError::Several { .. })
        ));
        assert!(matches!(find("0x17"), Err(SelectError::Several { .. })));
        let Err(error) = find("Positon") else {
            panic!("found")
        };
        let help = error.help().unwrap_or_default();
        assert!(
            help.starts_with("did you mean `Position`? the channels are ActTorque, "),
            "{help}"
        );
    }

    #[test]
    fn the_axis_tells_channels_apart() {
        // R6.3
        for (axis, found) in [("1", 0), ("2", 1), ("X", 0), ("y", 1)] {
            let selection = ChannelSelection {
                axis: Some(axis.to_owned()),
                ..ChannelSelection::default()
            };
            let torque = selection.named("ActTorque", &two_axes()).map(|it| it.0);
            assert_eq!(torque, Ok(found), "{axis}");
        }
    }

    #[test]
    fn the_sign_stands_for_the_axis_unless_it_is_in_the_name() {
        // R6.3
        let channels = [
            channel("load X", "", 0x1_0017),
            channel("load %", "", 0x2_0017),
            channel("load X %", "", 0x3_0017),
        ];
        let selection = ChannelSelection {
            axis: Some("X".to_owned()),
            ..ChannelSelection::default()
        };
        let find = |wanted: &str| selection.named(wanted, &channels).map(|it| it.0);
        assert_eq!(find("load %"), Ok(1));
        assert_eq!(find("load % %%"), Ok(2));
        assert_eq!(find("LOAD %"), Ok(0));
    }

    #[test]
    fn the_unit_of_the_user_goes_before_that_of_the_file() {
        // R6.3
        let mut selection = ChannelSelection {
            velocity: Some("SetVelo".to_owned()),
            ..ChannelSelection::default()
        };
        let factor = |selection: &ChannelSelection| {
            let pick = selection.require(ChannelQuantity::Velocity, &two_axes());
            pick.map(|pick| (pick.unit.factor, pick.is_unit_assumed))
        };
        assert_eq!(factor(&selection), Ok((1000.0, false)));
        let metres = Unit::parse("m/s").expect("a unit");
        selection.units.push(("velocity".to_owned(), metres));
        assert_eq!(factor(&selection), Ok((1e6, false)));
    }

    #[test]
    fn a_unit_without_a_channel_is_refused_where_there_is_one_recording() {
        // R6.3
        let metres = Unit::parse("m/s").expect("a unit");
        let mut selection = ChannelSelection {
            velocity: Some("SetVelo".to_owned()),
            units: vec![("SetVelocity".to_owned(), metres)],
            ..ChannelSelection::default()
        };
        let found = |selection: &ChannelSelection| {
            selection.require(ChannelQuantity::Velocity, &two_axes())
        };
        let error = found(&selection).expect_err("no such channel");
        assert!(matches!(error, SelectError::None { .. }), "{error}");
        selection.is_for_several = true;
        assert_eq!(found(&selection).map(|pick| pick.unit.factor), Ok(1000.0));
    }

    #[test]
    fn what_is_not_named_is_guessed() {
        // R6.3
        let require = |channels: &[Channel]| {
            let found = ChannelSelection::default().require(ChannelQuantity::Torque, channels);
            found.expect_err("no channel `torque`")
        };
        let error = require(&[channel("MotorTorque", "", 0x1_0017)]);
        assert!(
            error
                .help()
                .is_some_and(|help| help.contains("perhaps `MotorTorque`"))
        );
        // The channels of two axes are recognised, and none is taken.
        let error = require(&two_axes());
        assert!(matches!(error, SelectError::Several { .. }), "{error}");
    }
}
