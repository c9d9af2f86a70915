//! Statements of an axis list about its drive (R7.1, R7.2, R7.6, R7.8).

use std::collections::BTreeMap;

use serde::Serialize;

use super::signal::{DriveType, Protocol, Signal, is_torque_command};
use crate::diagnostic::{Code, Diagnostic, nearest};
use crate::lists::{Entry, Given, Number};
use crate::text::Place;

/// The factor by which the control multiplies a torque before sending it, P-AXIS-00325 and
/// P-AXIS-00326.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TorqueScale {
    /// P-AXIS-00325, `antr.torque_scale_num`.
    pub numerator: u32,
    /// P-AXIS-00326, `antr.torque_scale_denom`; with 0 the control sends no additive torque.
    pub denominator: u32,
}

impl Default for TorqueScale {
    fn default() -> Self {
        Self {
            numerator: 1,
            denominator: 1,
        }
    }
}

impl TorqueScale {
    /// Returns the factor; 0 if the denominator is 0.
    pub fn factor(self) -> f64 {
        match self.denominator {
            0 => 0.0,
            denominator => f64::from(self.numerator) / f64::from(denominator),
        }
    }
}

/// Statement of a telegram of the axis list about a value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Telegram {
    /// No entry in this direction; TwinCAT fills it in (R7.5).
    Silent,
    /// Telegram that contains the value.
    Holds(Place),
    /// Telegram that contains other values, with the place of the first.
    Lacks(Place),
    /// Telegram that contains the torque command itself instead.
    HoldsCommand(Place),
}

/// Statements of an axis list about its drive.
#[derive(Debug, Clone, Default)]
pub struct DriveSettings {
    /// P-AXIS-00020; `None` if no list gives it, or the given one is unknown.
    pub drive_type: Option<Given<DriveType>>,
    /// Place where P-AXIS-00790 switches the drive to simulation.
    pub simulated: Option<Place>,
    /// P-AXIS-00325 and P-AXIS-00326.
    pub scale: TorqueScale,
    numerator: Option<Place>,
    denominator: Option<Place>,
    /// P-AXIS-00324 of every gear.
    offsets: Vec<Given<i64>>,
    telegram: Vec<TelegramEntry>,
}

/// An entry of a telegram, `nc_ref` or `ident_nr`.
#[derive(Debug, Clone)]
struct TelegramEntry {
    signal: Signal,
    protocol: Protocol,
    holds: bool,
    is_command: bool,
    place: Place,
}

/// The patterns of telegram entries, each with the value that is sent in that direction.
const TELEGRAMS: [(&str, Protocol, Signal); 6] = {
    use Protocol::{CanOpen, Sercos};
    use Signal::{ActualTorque, AdditiveTorque};
    [
        ("antr.sercos.mdt[].nc_ref", Sercos, AdditiveTorque),
        ("antr.sercos.mdt[].ident_nr", Sercos, AdditiveTorque),
        ("antr.canopen.out[].nc_ref", CanOpen, AdditiveTorque),
        ("antr.sercos.at[].nc_ref", Sercos, ActualTorque),
        ("antr.sercos.at[].ident_nr", Sercos, ActualTorque),
        ("antr.canopen.in[].nc_ref", CanOpen, ActualTorque),
    ]
};

impl DriveSettings {
    /// Collects the values from the drive entries; a value that cannot be used is FC130.
    pub fn from_entries(
        entries: &BTreeMap<String, Entry>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let mut settings = Self::default();
        for entry in entries.values() {
            match entry.pattern.as_str() {
                "kenngr.antr_typ" => settings.drive_type = drive_type(entry, diagnostics),
                "kenngr.drive_simulation" => {
                    let on = entry.truth();
                    settings.simulated = (on.value == Some(true)).then(|| on.place());
                }
                "antr.torque_scale_num" => {
                    if let Some(value) = unsigned(entry, diagnostics) {
                        settings.scale.numerator = value;
                        settings.numerator = Some(entry.word().place());
                    }
                }
                "antr.torque_scale_denom" => {
                    if let Some(value) = unsigned(entry, diagnostics) {
                        settings.scale.denominator = value;
                        settings.denominator = Some(entry.word().place());
                    }
                }
                "getriebe[].torque_offset" => settings.offsets.extend(offset(entry, diagnostics)),
                pattern => settings.telegram.extend(telegram(pattern, entry)),
            }
        }
        settings.telegram.sort_by_key(|entry| entry.place.start());
        settings
    }

    /// Returns the protocol of the drive; `None` if the type is not given, or has none.
    pub(super) fn protocol(&self) -> Option<Protocol> {
        match self.drive_type.as_ref()?.value {
            DriveType::Sercos => Some(Protocol::Sercos),
            DriveType::CanOpen => Some(Protocol::CanOpen),
            _ => None,
        }
    }

    /// Returns the place of a telegram entry of another protocol than that of the drive, which does not use it.
    pub(super) fn unused_entry(&self, signal: Signal) -> Option<&Place> {
        let protocol = self.protocol()?;
        let mut entries = self.telegram.iter();
        let found = entries.find(|it| it.signal == signal && it.protocol != protocol)?;
        Some(&found.place)
    }

    /// Returns the statement of the list's telegrams about a value.
    pub(super) fn telegram(&self, signal: Signal) -> Telegram {
        let protocol = self.protocol();
        let is_used = |it: &&TelegramEntry| protocol.is_none_or(|protocol| it.protocol == protocol);
        let of_signal = |it: &&TelegramEntry| it.signal == signal && is_used(it);
        let entries = || self.telegram.iter().filter(of_signal);
        if let Some(entry) = entries().find(|entry| entry.holds) {
            return Telegram::Holds(entry.place.clone());
        }
        if let Some(entry) = entries().find(|entry| entry.is_command) {
            return Telegram::HoldsCommand(entry.place.clone());
        }
        match entries().next() {
            Some(entry) => Telegram::Lacks(entry.place.clone()),
            None => Telegram::Silent,
        }
    }

    /// Checks the torque parameters as the control does when it loads the list (R7.8).
    pub(super) fn check(&self, diagnostics: &mut Vec<Diagnostic>) {
        if let (0, Some(place)) = (self.scale.denominator, &self.denominator) {
            let message = "the denominator of the torque scaling is 0: the control warns and sends \
                           no additive torque";
            diagnostics.push(
                Diagnostic::new(Code::PErr110465, place.clone(), message)
                    .with_help("set `antr.torque_scale_denom` to 1 or more"),
            );
        }
        if let (0, Some(place)) = (self.scale.numerator, &self.numerator) {
            let message = "`antr.torque_scale_num` is 0, outside the documented range, which begins above 0: every \
                           torque is sent as 0";
            diagnostics.push(
                Diagnostic::new(Code::Fc132, place.clone(), message)
                    .with_help("set `antr.torque_scale_num` to 1 or more"),
            );
        }
        let drive_type = self.drive_type.as_ref().map(|given| given.value);
        for offset in &self.offsets {
            if offset.value < 0 {
                let message = format!(
                    "a torque offset of {} is outside the documented range, which begins at 0",
                    offset.value
                );
                diagnostics.push(Diagnostic::new(Code::Fc132, offset.place(), message));
            } else if let Some(drive_type) = drive_type
                && offset.value > 0
                && !drive_type.takes_torque_offset()
            {
                let message = format!(
                    "the drive type {} takes no torque offset",
                    drive_type.as_str()
                );
                diagnostics.push(
                    Diagnostic::new(Code::PErr110464, offset.place(), message)
                        .with_help("set `torque_offset` to 0"),
                );
            }
        }
    }
}

/// Returns FC130 for a value that cannot be used.
fn unusable(entry: &Entry, expected: &'static str) -> Diagnostic {
    let word = entry.word();
    let message = format!(
        "`{}` is `{}`; the value is not used",
        entry.key(),
        word.value
    );
    Diagnostic::new(Code::Fc130, word.place(), message).with_help(expected)
}

fn drive_type(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Option<Given<DriveType>> {
    let written = entry.number();
    let found = match written.value.number {
        Some(Number::Integer(number)) => DriveType::from_number(number),
        _ => DriveType::from_word(&written.value.text),
    };
    if found.is_none() {
        let expected = "write `2` for SERCOS, `8` for CANopen, `4` for simulation, `16` for a \
                        virtual axis";
        let text = &written.value.text;
        let near = nearest(text, DriveType::words());
        diagnostics.push(unusable(entry, expected).with_near(text, &near));
    }
    found.map(|drive_type| written.with(drive_type))
}

fn unsigned(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Option<u32> {
    let value = match entry.number().value.number {
        Some(Number::Integer(value)) => u32::try_from(value).ok(),
        _ => None,
    };
    if value.is_none() {
        diagnostics.push(unusable(entry, "write a whole number from 0 to 4294967295"));
    }
    value
}

fn offset(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Option<Given<i64>> {
    let written = entry.number();
    match written.value.number {
        Some(Number::Integer(value)) if i16::try_from(value).is_ok() => Some(written.with(value)),
        _ => {
            diagnostics.push(unusable(entry, "write a whole number from 0 to 32767"));
            None
        }
    }
}

fn telegram(pattern: &str, entry: &Entry) -> Option<TelegramEntry> {
    let mut known = TELEGRAMS.iter();
    let (key, protocol, signal) = *known.find(|(key, ..)| *key == pattern)?;
    let word = entry.text();
    let reference = word.value.split_whitespace().next()?;
    let idn = match Number::parse(reference) {
        Some(Number::Integer(idn)) if key.ends_with("ident_nr") => u16::try_from(idn).ok(),
        _ => None,
    };
    Some(TelegramEntry {
        signal,
        protocol,
        holds: signal.is_reference(reference) || idn.is_some_and(|idn| signal.is_idn(idn)),
        is_command: is_torque_command(reference) || idn == Some(80),
        place: word.place(),
    })
}
