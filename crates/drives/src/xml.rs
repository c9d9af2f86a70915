//! ENI and ESI files: what their devices map, found while the file is read element by element
//! (R7.3, R7.4). Only the entities of XML itself are expanded; a document type is refused.

use std::collections::HashMap;
use std::sync::Arc;

use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::escape::resolve_xml_entity;
use quick_xml::events::{BytesRef, BytesStart, Event};
use thiserror::Error;

use frictcomp::drive_interface::{Device, Network, NetworkObject, Protocol, Slave};
use frictcomp::drive_interface::{Signal, channel};
use frictcomp::text::SourceFile;

/// Limit for nested elements; the published structures have fewer than twenty levels.
const MOST_NESTED: usize = 64;

/// Number of characters kept of a name.
const MOST_NAME: usize = 200;

/// `CANopen` objects that only drives have, for the first axis: control word, status word, and
/// target and actual values of position, velocity and torque.
const OF_DRIVES: [u16; 8] = [
    0x6040, 0x6041, 0x6064, 0x606C, 0x6071, 0x6077, 0x607A, 0x60FF,
];

/// Why a description of a network or of devices cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{file}:{line}: {reason}")]
#[non_exhaustive]
pub struct XmlError {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// The line, from 1.
    pub line: u32,
    /// What is wrong, in words.
    pub reason: String,
}

/// Reads the network information of an `EtherCAT` master, an ENI file.
///
/// # Errors
/// The file is not well-formed XML, has a document type, or is not an ENI file.
pub fn read_network(source: &SourceFile) -> Result<Network, XmlError> {
    let mut slaves = Vec::new();
    read(source, "EtherCATConfig", &mut |item| {
        slaves.push(item.slave());
    })?;
    Ok(Network {
        file: source.name().clone(),
        slaves,
    })
}

/// Reads the devices and modules of an `EtherCAT` device description, an ESI file.
///
/// # Errors
/// The file is not well-formed XML, has a document type, or is not an ESI file.
pub fn read_devices(source: &SourceFile) -> Result<Vec<Device>, XmlError> {
    let mut devices = Vec::new();
    read(source, "EtherCATInfo", &mut |item| {
        devices.push(item.device());
    })?;
    Ok(devices)
}

/// Paths of devices in the two kinds of files.
const ITEMS: [&[&str]; 3] = [
    &["EtherCATConfig", "Config", "Slave"],
    &["EtherCATInfo", "Descriptions", "Devices", "Device"],
    &["EtherCATInfo", "Descriptions", "Modules", "Module"],
];

/// A process data object while it is read.
#[derive(Debug, Default)]
struct Pdo {
    receives: bool,
    index: u16,
    name: String,
    has_sync_manager: bool,
    entries: Vec<Mapped>,
}

/// An entry of a process data object.
#[derive(Debug)]
struct Mapped {
    index: u16,
    path: String,
    line: u32,
}

/// A device while it is read.
#[derive(Debug, Default)]
struct OpenDevice {
    name: String,
    vendor: Option<u32>,
    product: Option<u32>,
    protocol: Protocol,
    pdos: Vec<Pdo>,
    /// The objects that its sync managers list.
    assigned: Vec<u16>,
    path: String,
    line: u32,
}

impl OpenDevice {
    /// Whether the file says which objects are exchanged.
    fn assigns(&self) -> bool {
        !self.assigned.is_empty() || self.pdos.iter().any(|pdo| pdo.has_sync_manager)
    }

    fn is_assigned(&self, pdo: &Pdo) -> bool {
        pdo.has_sync_manager || self.assigned.contains(&pdo.index)
    }

    /// Returns the torque values mapped in these process data objects.
    fn mapped<'a>(&'a self, pdos: impl Iterator<Item = &'a Pdo>) -> Vec<NetworkObject> {
        let mut mapped = Vec::new();
        for pdo in pdos {
            let signal = if pdo.receives {
                Signal::AdditiveTorque
            } else {
                Signal::ActualTorque
            };
            for entry in &pdo.entries {
                let channel = match self.protocol {
                    Protocol::Sercos => signal.is_idn(entry.index).then(|| soe_channel(pdo.index)),
                    Protocol::CanOpen => signal.channel(entry.index),
                };
                mapped.extend(channel.map(|channel| NetworkObject {
                    signal,
                    channel,
                    pdo: pdo.index,
                    pdo_name: pdo.name.clone(),
                    path: entry.path.clone(),
                    line: entry.line,
                }));
            }
        }
        mapped
    }

    /// Returns the number of axes of the device, by its process data.
    fn axes(&self) -> u8 {
        let in_use = |pdo: &&Pdo| !self.assigns() || self.is_assigned(pdo);
        let pdos = self.pdos.iter().filter(in_use);
        let most = match self.protocol {
            Protocol::Sercos => pdos.map(|pdo| soe_channel(pdo.index)).max(),
            Protocol::CanOpen => {
                let entries = pdos.flat_map(|pdo| &pdo.entries);
                let channels = entries.flat_map(|entry| {
                    let of_drive = OF_DRIVES.iter();
                    of_drive.filter_map(|&first| channel(first, entry.index))
                });
                channels.max()
            }
        };
        most.unwrap_or_default()
    }

    fn slave(self) -> Slave {
        let assigned = self.pdos.iter().filter(|pdo| self.is_assigned(pdo));
        Slave {
            mapped: self.mapped(assigned),
            axes: self.axes(),
            assigns: self.assigns(),
            protocol: self.protocol,
            name: self.name,
            vendor: self.vendor,
            product: self.product,
            path: self.path,
            line: self.line,
        }
    }

    fn device(self) -> Device {
        Device {
            mappable: self.mapped(self.pdos.iter()),
            name: self.name,
            vendor: self.vendor,
            product: self.product,
        }
    }

    /// Takes the beginning of an element below the device.
    fn open(&mut self, below: &[&str], start: &BytesStart<'_>) {
        match below {
            ["Mailbox", "SoE"] => self.protocol = Protocol::Sercos,
            ["ProcessData", pdo @ ("RxPdo" | "TxPdo")] | [pdo @ ("RxPdo" | "TxPdo")] => {
                self.pdos.push(Pdo {
                    receives: *pdo == "RxPdo",
                    has_sync_manager: attribute(start, "Sm").is_some(),
                    ..Pdo::default()
                });
            }
            ["Type"] => {
                let product = attribute(start, "ProductCode").or(attribute(start, "ModuleIdent"));
                self.product = product.and_then(|text| number(&text));
            }
            _ => {}
        }
    }

    /// Takes the text of an element below the device.
    fn take(&mut self, below: &[&str], text: &str, place: impl FnOnce() -> (String, u32)) {
        match below {
            ["Info", "Name"] | ["Type"] => self.name = text.chars().take(MOST_NAME).collect(),
            ["Info", "VendorId"] => self.vendor = number(text),
            ["Info", "ProductCode"] => self.product = number(text),
            ["ProcessData", manager, "Pdo"] if manager.starts_with("Sm") => {
                self.assigned.extend(number16(text));
            }
            ["ProcessData", "RxPdo" | "TxPdo", rest @ ..] | ["RxPdo" | "TxPdo", rest @ ..] => {
                let Some(pdo) = self.pdos.last_mut() else {
                    return;
                };
                match rest {
                    ["Index"] => pdo.index = number16(text).unwrap_or_default(),
                    ["Name"] => pdo.name = text.chars().take(MOST_NAME).collect(),
                    ["Entry", "Index"] => {
                        let (path, line) = place();
                        let entry = number16(text).map(|index| Mapped { index, path, line });
                        pdo.entries.extend(entry);
                    }
                    _ => {}
                }
            }
            _ => {}
        }
    }
}

/// Returns the axis that a SERCOS telegram belongs to: those of further axes lie 1000h higher.
fn soe_channel(pdo: u16) -> u8 {
    u8::try_from(pdo >> 12).map_or(1, |above| above + 1)
}

/// An open element, with the texts and children read so far.
struct Open {
    name: String,
    number: u32,
    text: String,
    children: HashMap<String, u32>,
    line: u32,
}

/// The open elements, from the root on.
#[derive(Default)]
struct Path(Vec<Open>);

impl Path {
    fn names(&self) -> Vec<&str> {
        self.0.iter().map(|open| open.name.as_str()).collect()
    }

    /// Returns the path of the innermost element, or of its parent, in the manner of `XPath`.
    fn shown(&self, without: usize) -> String {
        let step = |open: &Open| match open.number {
            0 => open.name.clone(),
            number => format!("{}[{number}]", open.name),
        };
        let shown = self.0.len().saturating_sub(without);
        let steps: Vec<String> = self.0[..shown].iter().map(step).collect();
        steps.join("/")
    }

    fn push(&mut self, name: &str, line: u32) {
        let number = self.0.last_mut().map_or(0, |parent| {
            let count = parent.children.entry(name.to_owned()).or_default();
            *count += 1;
            *count
        });
        self.0.push(Open {
            name: name.to_owned(),
            number,
            text: String::new(),
            children: HashMap::new(),
            line,
        });
    }
}

/// Returns the rest of the path below a device, if one is open.
fn below<'a>(names: &'a [&'a str]) -> Option<&'a [&'a str]> {
    ITEMS.iter().find_map(|item| names.strip_prefix(*item))
}

/// Reads a file whose outermost element is `root`, device by device.
fn read(
    source: &SourceFile,
    root: &str,
    found: &mut dyn FnMut(OpenDevice),
) -> Result<(), XmlError> {
    let mut reader = Reader::from_str(source.text());
    let mut walk = Walk::new(root, found);
    loop {
        let offset = u32::try_from(reader.buffer_position()).unwrap_or(u32::MAX);
        let line = source.lines().line(offset);
        let refuse = |reason: String| XmlError {
            file: source.name().clone(),
            line,
            reason,
        };
        let event = reader.read_event();
        match event.map_err(|error| refuse(error.to_string()))? {
            Event::Start(start) => walk.open(&start, line).map_err(refuse)?,
            Event::Empty(start) => {
                walk.open(&start, line).map_err(refuse)?;
                walk.close();
            }
            Event::End(_) => walk.close(),
            Event::Text(text) => walk.add(&text.xml_content(XmlVersion::Implicit1_0)),
            Event::CData(text) => walk.add(&text.xml_content(XmlVersion::Implicit1_0)),
            Event::GeneralRef(reference) => walk.add(&expanded(&reference).map_err(refuse)?),
            Event::DocType(_) => return Err(refuse("a document type is not read".to_owned())),
            Event::Eof => return walk.end().map_err(refuse),
            _ => {}
        }
    }
}

/// Returns the text of a character reference or an entity of XML.
fn expanded(reference: &BytesRef<'_>) -> Result<String, String> {
    if let Ok(Some(character)) = reference.resolve_char_ref() {
        return Ok(character.to_string());
    }
    let name: &str = reference;
    let text = resolve_xml_entity(name).map(str::to_owned);
    text.ok_or_else(|| format!("the entity `{name}` is not expanded"))
}

/// A file that is being read, from its first element to its last.
struct Walk<'a> {
    root: &'a str,
    found: &'a mut dyn FnMut(OpenDevice),
    path: Path,
    item: OpenDevice,
    vendor: Option<u32>,
    is_described: bool,
}

impl<'a> Walk<'a> {
    fn new(root: &'a str, found: &'a mut dyn FnMut(OpenDevice)) -> Self {
        Self {
            root,
            found,
            path: Path::default(),
            item: OpenDevice::default(),
            vendor: None,
            is_described: false,
        }
    }

    fn open(&mut self, start: &BytesStart<'_>, line: u32) -> Result<(), String> {
        let name = start.local_name();
        let name: &str = name.as_ref();
        if self.path.0.len() >= MOST_NESTED {
            return Err("the elements are nested too deeply".to_owned());
        }
        if self.path.0.is_empty() {
            self.is_described = true;
            if name != self.root {
                return Err(other_root(name, self.root));
            }
        }
        self.path.push(name, line);
        let names = self.path.names();
        match below(&names) {
            Some([]) => {
                self.item = OpenDevice {
                    vendor: self.vendor,
                    path: self.path.shown(0),
                    line,
                    ..OpenDevice::default()
                };
            }
            Some(below) => self.item.open(below, start),
            None => {}
        }
        Ok(())
    }

    fn close(&mut self) {
        let names = self.path.names();
        let text = self.path.0.last().map_or("", |open| open.text.trim());
        match below(&names) {
            Some([]) => (self.found)(std::mem::take(&mut self.item)),
            Some(below) => {
                let line = self.path.0.last().map_or(1, |open| open.line);
                let here = || (self.path.shown(1), line);
                self.item.take(below, text, here);
            }
            None if names == ["EtherCATInfo", "Vendor", "Id"] => self.vendor = number(text),
            None => {}
        }
        self.path.0.pop();
    }

    /// Adds to the text of the innermost element.
    fn add(&mut self, text: &str) {
        if let Some(open) = self.path.0.last_mut()
            && open.text.len() < 4 * MOST_NAME
        {
            open.text.push_str(text);
        }
    }

    /// Checks that no element is open at the end of the file.
    fn end(&self) -> Result<(), String> {
        match self.path.0.last() {
            Some(open) => Err(format!("the file ends inside `<{}>`", open.name)),
            None if self.is_described => Ok(()),
            None => Err("there is no XML element".to_owned()),
        }
    }
}

/// Returns the message for a file with another outermost element.
fn other_root(name: &str, wanted: &str) -> String {
    let what = match name {
        "EtherCATConfig" => "network information (ENI)",
        "EtherCATInfo" => "a device description (ESI)",
        _ => return format!("the outermost element is `<{name}>`, not `<{wanted}>`"),
    };
    format!("this is {what}")
}

fn attribute(start: &BytesStart<'_>, name: &str) -> Option<String> {
    let attribute = start.try_get_attribute(name).ok().flatten()?;
    Some(attribute.value.to_string())
}

/// Parses a number as these files write it: `#x60b2`, `0x60b2` or decimal.
fn number(text: &str) -> Option<u32> {
    let hex = ["#x", "#X", "0x", "0X"]
        .iter()
        .find_map(|prefix| text.strip_prefix(prefix));
    match hex {
        Some(hex) => u32::from_str_radix(hex, 16).ok(),
        None => text.parse().ok(),
    }
}

fn number16(text: &str) -> Option<u16> {
    u16::try_from(number(text)?).ok()
}
