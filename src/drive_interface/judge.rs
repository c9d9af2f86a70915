//! Decides from all known evidence whether the torque values of an axis reach its drive and come
//! back (R7.5 to R7.8).

use std::collections::BTreeMap;
use std::fmt;

use serde::{Serialize, Serializer};

use super::settings::{DriveSettings, Telegram, TorqueScale};
use super::signal::{Device, DriveType, Network, NetworkObject, Protocol, Signal, Slave};
use crate::diagnostic::{Advice, Code, Diagnostic, Severity};
use crate::lists::{Entry, FrictionList, Given, Origin};
use crate::text::Place;

/// The largest torque that S-0-0081 of an AX5000 takes, in 0.1 % (R7.7).
const MOST_SERCOS: f64 = 1000.0;

/// The largest torque that 16 bits hold, in 0.1 %.
const MOST_16_BITS: f64 = 32767.0;

/// The device of the network that drives an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct SlaveOfAxis {
    /// The name of the axis.
    pub axis: String,
    /// The name of the device.
    pub slave: String,
    /// Number of the axis on the device, from 1; required where the device drives several.
    pub channel: Option<u8>,
}

/// Sources besides the axis list.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Evidence {
    /// The network as it is configured, from an ENI file.
    pub network: Option<Network>,
    /// The devices that an ESI file describes.
    pub devices: Vec<Device>,
    /// Devices of axes, as named by the user.
    pub slaves: Vec<SlaveOfAxis>,
}

/// Line that says whether the cyclic data contain a torque value, as `file:line`, with the path of the element in XML.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct TorqueEvidence {
    /// The file and the line.
    pub origin: Origin,
    /// The path of an element of a network.
    pub element: Option<String>,
}

impl From<&Place> for TorqueEvidence {
    fn from(place: &Place) -> Self {
        let is_element = place.text.starts_with("EtherCAT");
        Self {
            origin: Origin::File {
                file: place.file.to_string(),
                line: place.start().line,
            },
            element: is_element.then(|| place.text.to_string()),
        }
    }
}

impl fmt::Display for TorqueEvidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.element {
            Some(element) => write!(f, "{}, {element}", self.origin),
            None => self.origin.fmt(f),
        }
    }
}

impl Serialize for TorqueEvidence {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Evidence on a torque value of an axis.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "state", rename_all = "snake_case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Presence {
    /// The cyclic data contain it.
    Present {
        /// The line that says so.
        evidence: TorqueEvidence,
    },
    /// The cyclic data do not contain it.
    Missing {
        /// The line that says so.
        evidence: TorqueEvidence,
    },
    /// Value that no source gives, or on which the sources contradict each other.
    Unknown {
        /// The reason, in words.
        reason: String,
    },
    /// The axis has no drive, or none that could take it.
    NotApplicable,
}

/// Evidence on the torque interface of an axis.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct DriveReport {
    /// The name of the axis; empty where its list gives none.
    pub axis: String,
    /// Whether friction compensation is configured, P-AXIS-00522.
    pub configured: bool,
    /// P-AXIS-00020; absent where no list gives it.
    pub drive_type: Option<DriveType>,
    /// Whether P-AXIS-00790 switches the drive to simulation.
    pub simulated: bool,
    /// The additive torque command.
    pub additive_torque: Presence,
    /// The actual torque.
    pub actual_torque: Presence,
    /// P-AXIS-00325 and P-AXIS-00326.
    pub scale: TorqueScale,
    /// The largest torque that the value list sends, scaled, in 0.1 % of the rated one; absent
    /// without a value list.
    pub largest_torque: Option<f64>,
    /// Definite faults.
    #[serde(skip)]
    pub diagnostics: Vec<Diagnostic>,
    /// Required facts that are not known, FC504.
    #[serde(skip)]
    pub open: Vec<Diagnostic>,
}

impl DriveReport {
    /// Returns whether the additive torque reaches a drive whose type is not given: the control takes simulation, unless
    /// TwinCAT fills in another type (R7.6).
    pub fn lacks_type(&self) -> bool {
        let Presence::Present { evidence } = &self.additive_torque else {
            return false;
        };
        self.drive_type.is_none() && evidence.element.is_none()
    }

    /// Returns whether the torque would reach the drive and the control has none to send: no accepted value list, or a
    /// factor of 0.
    pub fn is_idle(&self) -> bool {
        self.idle_by().is_some()
    }

    /// Returns why the control has no torque to send to a drive that it would reach.
    pub fn idle_by(&self) -> Option<IdleBy> {
        if !self.configured || !matches!(self.additive_torque, Presence::Present { .. }) {
            return None;
        }
        match self.largest_torque {
            None => Some(IdleBy::NoValues),
            Some(largest) if largest > 0.0 => None,
            Some(_) if self.scale.factor() > 0.0 => Some(IdleBy::Outputs),
            Some(_) => Some(IdleBy::TorqueScaling),
        }
    }
}

/// Reason for which the control has no torque to send.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum IdleBy {
    /// No accepted value list.
    NoValues,
    /// Value list whose outputs are 0, all of them or by `frict_comp.scaling_factor`.
    Outputs,
    /// Torque scaling of 0, P-AXIS-00325 or P-AXIS-00326.
    TorqueScaling,
}

/// Statement of one source about a value.
enum SourceStatement {
    Nothing,
    Present(Place),
    Missing(Place),
    /// The source does not decide; the reason.
    Undecided(String, Place),
}

/// Statements of the lists about an axis and its drive.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ListedDrive<'a> {
    /// The name of the axis; empty where its list gives none.
    pub axis: &'a str,
    /// The entries of the drive by their keys.
    pub entries: &'a BTreeMap<String, Entry>,
    /// P-AXIS-00522, if a list gives it.
    pub selector: Option<&'a Given<bool>>,
    /// The value list that the control accepts.
    pub friction: Option<&'a FrictionList>,
}

/// Judges the drive of an axis by its lists and the other evidence.
///
/// The codes are P-ERR-110464, P-ERR-110465 and FC130; where friction compensation is configured
/// FC132, FC137, FC501 to FC503 and FC505 as well, and FC504 in [`DriveReport::open`].
pub fn check_drive(listed: &ListedDrive<'_>, evidence: &Evidence) -> DriveReport {
    let mut diagnostics = Vec::new();
    let settings = DriveSettings::from_entries(listed.entries, &mut diagnostics);
    settings.check(&mut diagnostics);
    let configured = listed.selector.is_some_and(|given| given.value);
    let mut judge = Judge {
        axis: listed.axis,
        settings: &settings,
        evidence,
        selector: listed.selector,
        diagnostics: Vec::new(),
        open: Vec::new(),
    };
    let [additive_torque, actual_torque] = judge.presences();
    judge.ask_type(&additive_torque);
    let own = judge.own_friction();
    judge.diagnostics.extend(own);
    let largest_torque = listed.friction.map(|list| judge.largest(list));
    let (of_interface, mut open) = (judge.diagnostics, judge.open);
    if configured {
        diagnostics.extend(of_interface);
    } else {
        open.clear();
    }
    let axis = listed.axis;
    let mut report = DriveReport {
        axis: axis.to_owned(),
        configured,
        drive_type: settings.drive_type.as_ref().map(|given| given.value),
        simulated: settings.simulated.is_some(),
        additive_torque,
        actual_torque,
        scale: settings.scale,
        largest_torque,
        diagnostics,
        open,
    };
    for said in report.diagnostics.iter_mut().chain(&mut report.open) {
        said.axis = (!axis.is_empty()).then(|| axis.to_owned());
    }
    report
}

struct Judge<'a> {
    axis: &'a str,
    settings: &'a DriveSettings,
    evidence: &'a Evidence,
    selector: Option<&'a Given<bool>>,
    diagnostics: Vec<Diagnostic>,
    open: Vec<Diagnostic>,
}

impl Judge<'_> {
    fn presences(&mut self) -> [Presence; 2] {
        let none = [Presence::NotApplicable, Presence::NotApplicable];
        if self.settings.simulated.is_some() {
            return none;
        }
        if let Some(given) = &self.settings.drive_type {
            if given.value.is_without_drive() {
                return none;
            }
            if !given.value.compensates_friction() {
                let message = format!(
                    "friction compensation is not available with the drive type {}",
                    given.value.as_str()
                );
                self.diagnostics.push(
                    Diagnostic::new(Code::Fc503, given.place(), message)
                        .with_help("it needs a SERCOS (`2`) or CANopen (`8`) drive"),
                );
                return none;
            }
        }
        Signal::ALL.map(|signal| self.presence(signal))
    }

    fn presence(&mut self, signal: Signal) -> Presence {
        let list = self.list_says(signal);
        let network = self.network_says(signal);
        match (list, network) {
            (SourceStatement::Present(listed), SourceStatement::Missing(place)) => {
                let reason = format!(
                    "`{}` has the {signal}, but `{}` does not map it",
                    listed.file, place.file
                );
                self.ask(signal, &reason, Some(listed));
                Presence::Unknown { reason }
            }
            (SourceStatement::Present(place), _)
            | (SourceStatement::Nothing, SourceStatement::Present(place)) => Presence::Present {
                evidence: (&place).into(),
            },
            (SourceStatement::Missing(place), _)
            | (SourceStatement::Nothing, SourceStatement::Missing(place)) => {
                let evidence = (&place).into();
                self.miss(signal, place);
                Presence::Missing { evidence }
            }
            (_, SourceStatement::Undecided(reason, place)) => {
                self.ask(signal, &reason, Some(place));
                Presence::Unknown { reason }
            }
            _ => {
                let (reason, place) = self.no_entry(signal);
                self.ask(signal, &reason, place);
                Presence::Unknown { reason }
            }
        }
    }

    /// Returns why no source says anything about a value.
    fn no_entry(&self, signal: Signal) -> (String, Option<Place>) {
        let drive_type = self.settings.drive_type.as_ref();
        match (self.settings.unused_entry(signal), drive_type) {
            (Some(place), Some(given)) => {
                let reason = format!(
                    "the drive type is {}, which does not use the telegram entries of the axis list",
                    given.value.as_str()
                );
                (reason, Some(place.clone()))
            }
            _ => ("the axis list has no telegram entry".to_owned(), None),
        }
    }

    /// Reports FC504 for an axis whose list has the telegram of a drive and no list gives the type: the control takes
    /// simulation, unless TwinCAT fills in another type (R7.6).
    fn ask_type(&mut self, additive_torque: &Presence) {
        let Presence::Present { evidence } = additive_torque else {
            return;
        };
        let place = self.selector.map(Given::place);
        if self.settings.drive_type.is_some() || evidence.element.is_some() {
            return;
        }
        let said = place.map(|place| {
            let message = "no list gives the drive type: the control takes simulation, which takes no additive torque, \
                           unless TwinCAT fills in another type";
            Diagnostic::new(Code::Fc504, place, message)
                .with_help("set `kenngr.antr_typ` to `2` for SERCOS or `8` for CANopen")
        });
        self.open.extend(said);
    }

    fn list_says(&self, signal: Signal) -> SourceStatement {
        match self.settings.telegram(signal) {
            Telegram::Silent => SourceStatement::Nothing,
            Telegram::Holds(place) => SourceStatement::Present(place),
            Telegram::Lacks(place) | Telegram::HoldsCommand(place) => {
                SourceStatement::Missing(place)
            }
        }
    }

    fn network_says(&self, signal: Signal) -> SourceStatement {
        let Some(network) = &self.evidence.network else {
            return SourceStatement::Nothing;
        };
        let given = |slave: &&SlaveOfAxis| slave.axis == self.axis;
        if let Some(given) = self.evidence.slaves.iter().find(given) {
            return match network
                .slaves
                .iter()
                .find(|slave| slave.name == given.slave)
            {
                Some(slave) => assigned(network, slave, given.channel, signal),
                None => SourceStatement::Undecided(
                    format!("there is no device `{}` in the network", given.slave),
                    network.place("EtherCATConfig", 1),
                ),
            };
        }
        agreed(network, self.settings.protocol(), signal)
    }

    /// Returns the device of the network that drives the axis, if the user named it.
    fn slave(&self) -> Option<&Slave> {
        let network = self.evidence.network.as_ref()?;
        let mut slaves = self.evidence.slaves.iter();
        let given = slaves.find(|given| given.axis == self.axis)?;
        network
            .slaves
            .iter()
            .find(|slave| slave.name == given.slave)
    }

    /// Returns FC505: the drive compensates friction by itself, or may do so (R7.10).
    fn own_friction(&self) -> Vec<Diagnostic> {
        let mut all = Vec::new();
        let (Some(network), Some(selector)) = (&self.evidence.network, self.selector) else {
            return all;
        };
        let named = self.slave();
        let mut given = self.evidence.slaves.iter();
        let channel = given
            .find(|given| given.axis == self.axis)
            .and_then(|given| given.channel);
        let drives: Vec<&Slave> = named.map_or_else(|| network.drives().collect(), |it| vec![it]);
        let is_known = drives.len() == 1;
        for drive in drives {
            let mut written = drive.own_friction.iter();
            let written = written.find(|it| channel.is_none_or(|channel| it.channel == channel));
            let said = match written {
                Some(own) => {
                    let adds = format!(
                        "the start-up of `{}` writes {}, which adds a friction torque in the drive",
                        drive.name, own.object
                    );
                    let place = network.place(&own.path, own.line);
                    if is_known {
                        let message = format!("{adds}; P-AXIS-00522 is 1, so both add");
                        Diagnostic::new(Code::Fc505, place, message)
                            .with_label(selector.place(), "P-AXIS-00522 is set here")
                            .with_help("write 0 to it, or set `lr_param.frict_comp` to 0")
                    } else {
                        let message = format!("{adds}; whether it drives this axis is not known");
                        let advice = Advice::AssignSlave(self.axis.to_owned());
                        Diagnostic::new(Code::Fc505, place, message).with_help(advice)
                    }
                }
                None if is_known && drive.may_compensate() => {
                    let message = format!(
                        "`{}` can add a friction torque of its own; nothing says whether it does",
                        drive.name
                    );
                    let mut said = Diagnostic::new(Code::Fc505, selector.place(), message);
                    said.severity = Severity::Info;
                    said.with_help(match channel {
                        Some(2) => "look at 3544:02 and 3544:03; 3541:08 shows the result",
                        _ => "look at 3144:02 and 3144:03; 3141:08 shows the result",
                    })
                }
                None => continue,
            };
            all.push(said);
        }
        all
    }

    /// Reports FC501 or FC502.
    fn miss(&mut self, signal: Signal, place: Place) {
        let is_command = signal == Signal::AdditiveTorque
            && matches!(self.settings.telegram(signal), Telegram::HoldsCommand(_));
        let code = match signal {
            Signal::AdditiveTorque => Code::Fc501,
            Signal::ActualTorque => Code::Fc502,
        };
        let message = match signal {
            _ if is_command => "this is the torque command itself; friction compensation needs \
                                the additive torque command"
                .to_owned(),
            Signal::AdditiveTorque => "the cyclic data hold no additive torque command; friction \
                                       compensation does not reach the drive"
                .to_owned(),
            Signal::ActualTorque => "the cyclic data hold no actual torque; friction cannot be \
                                     measured or verified"
                .to_owned(),
        };
        let drive_type = self.settings.drive_type.as_ref().map(|given| given.value);
        let (idn, object) = (signal.idn(), signal.object());
        let name = match drive_type {
            Some(DriveType::Sercos) => format!("S-0-{idn:04}"),
            Some(DriveType::CanOpen) => format!("object {object:04X}h"),
            _ => format!("S-0-{idn:04} (SERCOS) or object {object:04X}h (CANopen)"),
        };
        let mut said = Diagnostic::new(code, place, message)
            .with_help(format!("add {name} to the cyclic data of the drive"));
        if let Some(help) = self.selectable(signal) {
            said = said.with_help(help);
        }
        self.diagnostics.push(said);
    }

    /// Returns the process data object that could be selected (R7.4).
    fn selectable(&self, signal: Signal) -> Option<String> {
        let slave = self.slave();
        let may_be = |device: &&Device| {
            slave.is_none_or(|slave| {
                slave.product == device.product && slave.vendor == device.vendor
            })
        };
        let devices = self.evidence.devices.iter().filter(may_be);
        let (device, object) = devices.into_iter().find_map(|device| {
            let object = device.mappable.iter().find(|it| it.signal == signal)?;
            Some((device, object))
        })?;
        Some(format!(
            "the device description offers it: select {} of {}",
            pdo(object),
            device.name
        ))
    }

    /// Reports FC504.
    fn ask(&mut self, signal: Signal, reason: &str, place: Option<Place>) {
        let Some(place) = place.or_else(|| self.selector.map(Given::place)) else {
            return;
        };
        let message = format!("whether the cyclic data hold the {signal} is not known: {reason}");
        let advice = match &self.evidence.network {
            None => Advice::GiveNetwork,
            Some(_) => Advice::AssignSlave(self.axis.to_owned()),
        };
        let mut said = Diagnostic::new(Code::Fc504, place, message).with_help(advice);
        if let Some(help) = self.selectable(signal) {
            said = said.with_help(help);
        }
        self.open.push(said);
    }

    /// Returns the largest torque of a value list, scaled, in 0.1 %, and reports it if it is too
    /// large (R7.7).
    fn largest(&mut self, list: &FrictionList) -> f64 {
        let outputs = list.table.iter().map(|point| point.output.abs());
        let plain = outputs.fold(0.0, f64::max) * f64::from(list.scaling_factor).abs() / 1000.0;
        let largest = plain * self.settings.scale.factor();
        let drive_type = self.settings.drive_type.as_ref();
        let place = drive_type
            .map(Given::place)
            .or_else(|| self.selector.map(Given::place));
        let Some(place) = place else {
            return largest;
        };
        let is_sercos = drive_type.is_some_and(|given| given.value == DriveType::Sercos);
        let percent = largest / 10.0;
        if largest > MOST_16_BITS && plain <= MOST_16_BITS {
            let message = format!(
                "scaled, the value list sends up to {percent:.1} % of the rated torque; 16 bits hold 3276.7 %"
            );
            self.diagnostics
                .push(Diagnostic::new(Code::Fc137, place, message));
        } else if is_sercos && largest > MOST_SERCOS {
            let message = format!(
                "the value list sends up to {percent:.1} % of the rated torque; S-0-0081 of an AX5000 ends at 100 %"
            );
            self.diagnostics.push(
                Diagnostic::new(Code::Fc132, place, message)
                    .with_help("check the outputs, `scaling_factor` and the torque scaling"),
            );
        }
        largest
    }
}

/// Returns the statement of the device that the user named.
fn assigned(
    network: &Network,
    slave: &Slave,
    channel: Option<u8>,
    signal: Signal,
) -> SourceStatement {
    let place = network.place(&slave.path, slave.line);
    let channels: Vec<u8> = match channel {
        Some(channel) => vec![channel],
        None => (1..=slave.axes).collect(),
    };
    let maps: Vec<Option<&NetworkObject>> = channels
        .iter()
        .map(|&channel| slave.maps(signal, channel))
        .collect();
    if slave.axes == 0 {
        return SourceStatement::Undecided(format!("`{}` is not a drive", slave.name), place);
    }
    if !slave.assigns {
        let reason = format!(
            "the network does not say which process data objects `{}` exchanges",
            slave.name
        );
        return SourceStatement::Undecided(reason, place);
    }
    if channel.is_some_and(|channel| !(1..=slave.axes).contains(&channel)) {
        let reason = format!("`{}` drives {} axes", slave.name, slave.axes);
        return SourceStatement::Undecided(reason, place);
    }
    match maps.as_slice() {
        [Some(first), rest @ ..] if rest.iter().all(Option::is_some) => {
            SourceStatement::Present(network.place(&first.path, first.line))
        }
        maps if maps.iter().all(Option::is_none) => SourceStatement::Missing(place),
        _ => {
            SourceStatement::Undecided(format!("only some axes of `{}` have it", slave.name), place)
        }
    }
}

/// Returns the statement that all candidate drives of the network agree on.
fn agreed(network: &Network, protocol: Option<Protocol>, signal: Signal) -> SourceStatement {
    let may_be = |slave: &&Slave| protocol.is_none_or(|protocol| slave.protocol == protocol);
    let mut drives = network.drives().filter(may_be);
    let whole = network.place("EtherCATConfig", 1);
    let Some(first) = drives.next() else {
        let reason = "the network has no drive of the type that the axis list gives";
        return SourceStatement::Undecided(reason.to_owned(), whole);
    };
    let says = assigned(network, first, None, signal);
    let same = |other: SourceStatement| match says {
        SourceStatement::Present(_) => matches!(other, SourceStatement::Present(_)),
        SourceStatement::Missing(_) => matches!(other, SourceStatement::Missing(_)),
        _ => false,
    };
    if drives.all(|slave| same(assigned(network, slave, None, signal))) {
        return says;
    }
    SourceStatement::Undecided("only some drives of the network have it".to_owned(), whole)
}

/// Returns the name of a process data object in the engineering tools.
fn pdo(object: &NetworkObject) -> String {
    format!("PDO {:04X}h (`{}`)", object.pdo, object.pdo_name)
}
