//! Motion in a channel list: the unit of F, the state at the start of a program, and the main
//! spindle (TF5200 Channel parameters, `prog_start.*` and `spindel[].*`).

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::keywords::number_of;
use super::line::{Entries, Entry, Given, Number};
use super::parameter::Parameter;
use crate::diagnostic::{Code, Diagnostic};
use crate::language::GFunction;

/// The unit of the F word with G94, P-CHAN-00108.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum FeedUnit {
    /// mm/min, the default.
    #[default]
    MillimetresPerMinute,
    /// m/min.
    MetresPerMinute,
    /// Factor whose meaning is not documented.
    Unknown,
}

impl FeedUnit {
    /// Returns the unit in mm/min, if it is known.
    pub fn in_mm(self) -> Option<f64> {
        match self {
            Self::MillimetresPerMinute => Some(1.0),
            Self::MetresPerMinute => Some(1000.0),
            Self::Unknown => None,
        }
    }
}

/// Effective settings for the motion of a channel.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ChannelSettings {
    /// The unit of F, P-CHAN-00108.
    pub feed_unit: FeedUnit,
    /// The feed where a program has no F, in mm/min, P-CHAN-00099.
    pub feed_mm_per_min: Option<f64>,
    /// Whether the lists of the channel were read and give no such feed.
    pub lacks_feed: bool,
    /// Whether the lists of the channel were read, so that anything they do not name does not exist.
    pub is_whole: bool,
    /// The G functions in force at the start of a program, P-CHAN-00063, if they differ from the control's defaults.
    pub functions: Vec<u32>,
    /// Whether the unit of coordinates is inch, P-CHAN-00054. What G70 and G71 do then is not documented.
    pub inch: bool,
    /// The acceleration profile at the start of a program, P-CHAN-00071, if the list gives it.
    pub slope: Option<SlopeProfile>,
    /// The names of the main spindle in addition to `S`: P-CHAN-00053 and the name of the spindle with the number of
    /// P-CHAN-00051.
    pub main_spindle: Vec<String>,
    /// The pairs of the coupling group 0 by their logical numbers, follower and leader, P-CHAN-00038 and P-CHAN-00037.
    pub coupled: Vec<[u32; 2]>,
    /// Switches of the channel that are on.
    pub switches: BTreeSet<ChannelSwitch>,
    /// The M and H functions that the PLC does not acknowledge, P-CHAN-00041 and P-CHAN-00027: letter and number.
    pub unacknowledged: BTreeSet<(u8, u32)>,
}

/// A switch of a channel list that decides what outlives a cycle, a program or a reset (R2.105).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ChannelSwitch {
    /// Retention of P parameters at program end.
    KeepParameters,
    /// Retention of the changes of a cycle to G functions and feed.
    KeepCycleChanges,
    /// Retention of couplings after a reset.
    KeepCouplingsAfterReset,
    /// Retention of couplings at program end.
    KeepCouplings,
    /// Retention of the axes of the channel and their couplings at program end.
    KeepAxes,
    /// Retention of the axes of the channel after a reset.
    KeepAxesAfterReset,
    /// Retention of the zero offset at program end.
    KeepOffset,
    /// Retention of the tool data at program end.
    KeepToolData,
}

impl ChannelSwitch {
    /// Each with its key.
    const KEYS: [(Self, &str); 8] = [
        (Self::KeepParameters, "p_param_haltend"),
        (Self::KeepCycleChanges, "cycle_changes_modal"),
        (
            Self::KeepCouplingsAfterReset,
            "synchro_data.restore_coupling_after_reset",
        ),
        (
            Self::KeepCouplings,
            "synchro_data.preserve_coupling_after_prog_end",
        ),
        (Self::KeepAxes, "retain_last_ax_config"),
        (Self::KeepAxesAfterReset, "reset_no_axis_to_axv"),
        (Self::KeepOffset, "preserve_active_zero_offsets"),
        (Self::KeepToolData, "preserve_active_tool_data"),
    ];

    fn of(key: &str) -> Option<Self> {
        let mut all = Self::KEYS.iter();
        let found = all.find(|(_, known)| *known == key)?;
        Some(found.0)
    }
}

impl ChannelSettings {
    /// Returns whether a switch is on.
    pub fn has(&self, switch: ChannelSwitch) -> bool {
        self.switches.contains(&switch)
    }
}

/// The acceleration profile, P-CHAN-00071.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum SlopeProfile {
    /// Steps of the acceleration, with the values of the stages.
    Step,
    /// Ramps of constant jerk.
    Trapez,
    /// Sine-squared ramps.
    Sin2,
    /// Ramps with the longest of the four ramp times.
    Hsc,
}

impl SlopeProfile {
    /// Returns the profile with a number of P-CHAN-00071.
    pub(crate) fn numbered(number: f64) -> Option<Self> {
        let all = [Self::Step, Self::Trapez, Self::Sin2, Self::Hsc];
        let is_it = |at: &u8| f64::from(*at).total_cmp(&number).is_eq();
        (0..)
            .zip(all)
            .find(|(at, _)| is_it(at))
            .map(|(_, profile)| profile)
    }
}

/// P-CHAN-00108.
const FEED_FACTOR: &str = "prog_start.feedrate_factor";
/// P-CHAN-00099.
const FEED: &str = "prog_start.feedrate";
/// P-CHAN-00063.
const FUNCTIONS: &str = "prog_start.g_gruppe[].nr";

/// Kinds of synchronisation without an acknowledgement by the PLC: no output, or output only.
const UNACKNOWLEDGED: [&str; 5] = ["NO_SYNCH", "MOS", "MOS_TS", "MEP_MOS", "MET_MOS"];

/// Kinds of synchronisation with an acknowledgement (TF5200 Channel parameters, page 148946059).
const ACKNOWLEDGED: [&str; 7] = [
    "MVS_SVS", "MVS_SNS", "MNS_SNS", "MVS_SLM", "MEP_SVS", "MET_SVS", "MCS_SNS",
];

/// The keys of a pair of the coupling group 0: its follower, its leader, and 1 for a pair of spindles.
const PAIR: [&str; 3] = [
    "synchro_data.koppel_gruppe[].paar[].log_achs_nr_slave",
    "synchro_data.koppel_gruppe[].paar[].log_achs_nr_master",
    "synchro_data.koppel_gruppe[].paar[].mode",
];

/// Values as given by a channel list.
#[derive(Debug, Clone, Default)]
pub struct ChannelDraft {
    factor: Option<Given<Number>>,
    feed: Option<Given<Number>>,
    /// Whether a line gives the feed with a value that is not understood.
    feed_is_odd: bool,
    functions: BTreeMap<u32, Given<u32>>,
    inch: Option<Given<bool>>,
    slope: Option<Given<SlopeProfile>>,
    spindle_number: Option<Given<u32>>,
    spindle_name: Option<Given<String>>,
    acknowledged: BTreeMap<(u8, u32), bool>,
    /// The parts of each pair, by its place and that of its key.
    pairs: BTreeMap<(u32, usize), Given<u32>>,
    switches: BTreeMap<ChannelSwitch, Given<bool>>,
}

impl ChannelDraft {
    /// Collects the values of a list. Reports FC130 for invalid values, FC132 for those without a documented meaning.
    pub fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut draft = Self::default();
        for entry in &list.entries {
            draft.add(entry, diagnostics);
        }
        draft
    }

    fn add(&mut self, entry: &Entry, diagnostics: &mut Vec<Diagnostic>) {
        match (entry.pattern.as_str(), entry.indices.as_slice()) {
            (FEED_FACTOR, []) => {
                self.factor = number(entry, diagnostics).or(self.factor.take());
                if let Some(factor) = &self.factor {
                    diagnostics.extend(odd_factor(entry, factor));
                }
            }
            (FEED, []) => {
                let given = number(entry, diagnostics);
                self.feed_is_odd = given.is_none();
                self.feed = given.or(self.feed.take());
            }
            (FUNCTIONS, &[group]) => self.function(group, entry, diagnostics),
            ("mass_einh", []) => {
                let given = entry.truth();
                match given.value {
                    Some(inch) => self.inch = Some(given.with(inch)),
                    None => diagnostics.push(odd(entry, "`0` for mm or `1` for inch")),
                }
            }
            ("m_synch[]", &[function]) => self.synchronise((b'M', function), entry, diagnostics),
            ("h_synch[]", &[function]) => self.synchronise((b'H', function), entry, diagnostics),
            ("prog_start.slope.profile", []) => {
                let given = number(entry, diagnostics);
                let profile = given
                    .as_ref()
                    .and_then(|given| SlopeProfile::numbered(given.value.to_f64()));
                if given.is_some() && profile.is_none() {
                    diagnostics.push(odd(entry, "`0` to `3` are STEP, TRAPEZ, SIN2 and HSC"));
                }
                let found = given.zip(profile);
                self.slope = found.map(|(given, profile)| given.with(profile));
            }
            ("main_spindle_ax_nr", []) => {
                let given = number(entry, diagnostics);
                self.spindle_number = given.and_then(|given| Some(given.with(whole(given.value)?)));
            }
            ("main_spindle_name", []) => {
                let name = entry.text();
                self.spindle_name = Some(name.with(name.value.to_owned()));
            }
            (key, &[0, pair]) => {
                if let Some(part) = PAIR.iter().position(|it| *it == key) {
                    self.pair((pair, part), entry, diagnostics);
                }
            }
            (key, []) => {
                if let Some(switch) = ChannelSwitch::of(key) {
                    let given = entry.truth();
                    match given.value {
                        Some(on) => _ = self.switches.insert(switch, given.with(on)),
                        None => diagnostics.push(odd(entry, "`0` or `1`")),
                    }
                }
            }
            _ => {}
        }
    }

    /// Reads a part of a pair of the coupling group 0.
    fn pair(&mut self, place: (u32, usize), entry: &Entry, diagnostics: &mut Vec<Diagnostic>) {
        let Some(given) = number(entry, diagnostics) else {
            return;
        };
        let is_mode = place.1 == PAIR.len() - 1;
        match whole(given.value) {
            Some(number) if !is_mode || number < 2 => {
                self.pairs.insert(place, given.with(number));
            }
            _ if is_mode => diagnostics.push(odd(entry, "`0` for axes or `1` for spindles")),
            _ => diagnostics.push(odd(entry, "the logical number of an axis")),
        }
    }

    /// Reads the kind of synchronisation of a function, by its name or as a bit code. One that is not known counts as
    /// acknowledged.
    fn synchronise(
        &mut self,
        function: (u8, u32),
        entry: &Entry,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        let text = entry.text().value.trim_matches('"').to_ascii_uppercase();
        let digits = text.strip_prefix("0X").map_or((&*text, 10), |it| (it, 16));
        let number = u32::from_str_radix(digits.0, digits.1).ok();
        let is_silent = UNACKNOWLEDGED.contains(&&*text) || number.is_some_and(|it| it < 2);
        if !is_silent && number.is_none() && !ACKNOWLEDGED.contains(&&*text) {
            let known = UNACKNOWLEDGED.iter().chain(&ACKNOWLEDGED);
            let known: Vec<String> = known.map(|it| format!("`{it}`")).collect();
            let help = format!(
                "write one of {}, or its bit code; until then the PLC counts as acknowledging the function",
                known.join(", ")
            );
            diagnostics.push(odd(entry, &help));
        }
        self.acknowledged.insert(function, !is_silent);
    }

    fn function(&mut self, group: u32, entry: &Entry, diagnostics: &mut Vec<Diagnostic>) {
        let Some(given) = number(entry, diagnostics) else {
            return;
        };
        // The control's own default.
        if given.value == Number::Integer(-1) {
            self.functions.remove(&group);
            return;
        }
        let allowed: Vec<u32> = GFunction::defaults_of(group).collect();
        let number = whole(given.value).filter(|number| allowed.contains(number));
        if let Some(number) = number {
            self.functions.insert(group, given.with(number));
            return;
        }
        let names: Vec<String> = allowed.iter().map(|it| format!("`{it}`")).collect();
        let expected = match names.as_slice() {
            [] => "the group takes no default; leave the line out".to_owned(),
            names => format!("the group takes {}", names.join(", ")),
        };
        diagnostics.push(odd(entry, &expected));
    }

    /// Replaces values by those of another list.
    pub(super) fn override_with(&mut self, other: Self) {
        self.factor = other.factor.or(self.factor.take());
        self.feed_is_odd |= other.feed_is_odd;
        self.feed = other.feed.or(self.feed.take());
        self.functions.extend(other.functions);
        self.inch = other.inch.or(self.inch.take());
        self.slope = other.slope.or(self.slope.take());
        self.spindle_number = other.spindle_number.or(self.spindle_number.take());
        self.spindle_name = other.spindle_name.or(self.spindle_name.take());
        self.acknowledged.extend(other.acknowledged);
        self.pairs.extend(other.pairs);
        self.switches.extend(other.switches);
    }

    /// Returns the effective settings; `spindles` are the names of the spindles with their axis numbers.
    pub(super) fn settings<'a>(
        &self,
        spindles: impl Iterator<Item = (&'a str, Option<u32>)>,
    ) -> ChannelSettings {
        let spindles: Vec<_> = spindles.collect();
        let number = self.spindle_number.as_ref().map(|given| given.value);
        let main = spindles.iter().filter(|(_, own)| match number {
            Some(number) => *own == Some(number),
            // A single spindle is the main one.
            None => spindles.len() == 1,
        });
        let given = self.spindle_name.iter().map(|given| given.value.as_str());
        let names = given.chain(main.map(|(name, _)| *name));
        let feed = self.feed.as_ref().map(|given| given.value.to_f64());
        let feed = feed.filter(|feed| *feed > 0.0);
        ChannelSettings {
            feed_unit: self.factor.as_ref().map_or(FeedUnit::default(), unit_of),
            feed_mm_per_min: feed,
            lacks_feed: feed.is_none() && !self.feed_is_odd,
            is_whole: true,
            functions: self.functions.values().map(|given| given.value).collect(),
            inch: self.inch.as_ref().is_some_and(|given| given.value),
            slope: self.slope.as_ref().map(|given| given.value),
            main_spindle: names
                .filter(|name| !name.is_empty())
                .map(str::to_owned)
                .collect(),
            coupled: self.coupled(),
            switches: {
                let on = self.switches.iter().filter(|(_, given)| given.value);
                on.map(|(switch, _)| *switch).collect()
            },
            unacknowledged: {
                let silent = self.acknowledged.iter().filter(|(_, is_it)| !**is_it);
                silent.map(|(function, _)| *function).collect()
            },
        }
    }

    /// Returns the followers and leaders of the coupling group 0 by their logical numbers, without pairs of spindles.
    fn coupled(&self) -> Vec<[u32; 2]> {
        let part = |place, part| {
            self.pairs
                .get(&(place, part))
                .map_or(0, |given| given.value)
        };
        let places: BTreeSet<u32> = self.pairs.keys().map(|(place, _)| *place).collect();
        let pairs = places.into_iter().filter(|place| part(*place, 2) == 0);
        let pairs = pairs.map(|place| [part(place, 0), part(place, 1)]);
        pairs.filter(|pair| !pair.contains(&0)).collect()
    }

    /// Returns the parameters that the list gives.
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut rows = Vec::new();
        let mut row = |pattern: &str, indices: Vec<u32>, value: String, origin| {
            let unit = if pattern == FEED { "mm/min" } else { "" };
            let key = indices.iter().fold(pattern.to_owned(), |key, index| {
                key.replacen("[]", &format!("[{index}]"), 1)
            });
            rows.push(Parameter {
                number: number_of(pattern),
                key,
                value,
                unit,
                origin,
            });
        };
        if let Some(given) = &self.factor {
            row(
                FEED_FACTOR,
                Vec::new(),
                given.value.to_string(),
                given.into(),
            );
        }
        if let Some(given) = &self.feed {
            row(FEED, Vec::new(), given.value.to_string(), given.into());
        }
        for (group, given) in &self.functions {
            let value = given.value.to_string();
            row(FUNCTIONS, vec![*group], value, given.into());
        }
        if let Some(given) = &self.inch {
            let value = u8::from(given.value).to_string();
            row("mass_einh", Vec::new(), value, given.into());
        }
        if let Some(given) = &self.slope {
            let value = (given.value as u8).to_string();
            row("prog_start.slope.profile", Vec::new(), value, given.into());
        }
        if let Some(given) = &self.spindle_number {
            let value = given.value.to_string();
            row("main_spindle_ax_nr", Vec::new(), value, given.into());
        }
        if let Some(given) = &self.spindle_name {
            row(
                "main_spindle_name",
                Vec::new(),
                given.value.clone(),
                given.into(),
            );
        }
        for ((pair, part), given) in &self.pairs {
            let value = given.value.to_string();
            row(PAIR[*part], vec![0, *pair], value, given.into());
        }
        for (switch, key) in ChannelSwitch::KEYS {
            if let Some(given) = self.switches.get(&switch) {
                let value = u8::from(given.value).to_string();
                row(key, Vec::new(), value, given.into());
            }
        }
        rows
    }
}

/// Returns the unit of a factor: 100 is mm/min, 0.1 is m/min; for 0 and less the control uses mm/min.
fn unit_of(factor: &Given<Number>) -> FeedUnit {
    let factor = factor.value.to_f64();
    let near = |known: f64| (factor - known).abs() < 1e-9;
    if factor <= 0.0 || near(100.0) {
        FeedUnit::MillimetresPerMinute
    } else if near(0.1) {
        FeedUnit::MetresPerMinute
    } else {
        FeedUnit::Unknown
    }
}

/// Returns FC132 for a factor that the control warns about, or whose meaning is not documented.
fn odd_factor(entry: &Entry, factor: &Given<Number>) -> Option<Diagnostic> {
    let value = factor.value.to_f64();
    if unit_of(factor) == FeedUnit::Unknown {
        return Some(odd(
            entry,
            "write `100` for mm/min or `0.1` for m/min; until then the velocity of motions with F is not known",
        ));
    }
    let is_default = (value + 1.0).abs() < 1e-9;
    (value <= 0.0 && !is_default).then(|| {
        odd(
            entry,
            "write `100` for mm/min, which the control takes here",
        )
    })
}

/// Returns FC132 for a value that has no documented meaning.
pub(super) fn odd(entry: &Entry, help: &str) -> Diagnostic {
    let word = entry.word();
    let message = format!(
        "`{}` of `{}` is outside the documented values",
        word.value,
        entry.key()
    );
    Diagnostic::new(Code::Fc132, word.place(), message).with_help(help.to_owned())
}

fn number(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Option<Given<Number>> {
    let given = entry.number();
    if given.value.number.is_none() {
        let message = format!(
            "`{}` is `{}`; the value is not used",
            entry.key(),
            given.value.text
        );
        let diagnostic = Diagnostic::new(Code::Fc130, given.place(), message);
        diagnostics.push(diagnostic.with_help("write a number"));
    }
    given.value.number.map(|number| given.with(number))
}

fn whole(number: Number) -> Option<u32> {
    match number {
        Number::Integer(value) => u32::try_from(value).ok(),
        Number::Real(_) => None,
    }
}
