//! ENI and ESI files: what their devices map (R7.3, R7.4). Only the entities of XML itself are expanded;
//! a document type is refused.

use std::collections::HashMap;
use std::sync::Arc;

use roxmltree::{Document, Node};
use thiserror::Error;

use frictcomp::drive_interface::{Device, Network, NetworkObject, OwnFriction, Protocol, Slave};
use frictcomp::drive_interface::{Signal, channel};
use frictcomp::text::SourceFile;

/// Number of characters kept of a name.
const MOST_NAME: usize = 200;

/// `CANopen` objects that only drives have, for the first axis: control word, status word, and
/// target and actual values of position, velocity and torque.
const OF_DRIVES: [u16; 8] = [
    0x6040, 0x6041, 0x6064, 0x606C, 0x6071, 0x6077, 0x607A, 0x60FF,
];

/// Reason why a description of a network or of devices cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{file}:{line}: {reason}")]
#[non_exhaustive]
pub struct XmlError {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// The line, from 1.
    pub line: u32,
    /// Fault in words.
    pub reason: String,
}

/// Reads the network information of an `EtherCAT` master, an ENI file.
///
/// # Errors
/// The file is not well-formed XML, has a document type, or is not an ENI file.
pub fn read_network(source: &SourceFile) -> Result<Network, XmlError> {
    let document = parse(source)?;
    let root = Element::root(&document, source, "EtherCATConfig")?;
    let slaves = root.at(&["Config", "Slave"]).into_iter();
    Ok(Network {
        file: source.name().clone(),
        slaves: slaves
            .map(|slave| Mapping::new(&slave).slave(&slave))
            .collect(),
    })
}

/// Reads the devices and modules of an `EtherCAT` device description, an ESI file.
///
/// # Errors
/// The file is not well-formed XML, has a document type, or is not an ESI file.
pub fn read_devices(source: &SourceFile) -> Result<Vec<Device>, XmlError> {
    let document = parse(source)?;
    let root = Element::root(&document, source, "EtherCATInfo")?;
    let vendors = root.at(&["Vendor"]);
    let vendor = vendors.iter().find_map(|vendor| number(vendor.text("Id")?));
    let descriptions = root.at(&["Descriptions"]);
    let groups = descriptions.iter().flat_map(Element::children);
    let items = groups.flat_map(|group| match group.name() {
        "Devices" => group.at(&["Device"]),
        "Modules" => group.at(&["Module"]),
        _ => Vec::new(),
    });
    Ok(items
        .map(|item| Mapping::new(&item).device(vendor))
        .collect())
}

fn parse(source: &SourceFile) -> Result<Document<'_>, XmlError> {
    Document::parse(source.text()).map_err(|error| XmlError {
        file: source.name().clone(),
        line: error.pos().row,
        reason: match error {
            roxmltree::Error::DtdDetected => "a document type is not read".to_owned(),
            error => format!("not well-formed XML: {error}"),
        },
    })
}

/// An element of a file, with its path in the manner of `XPath`.
struct Element<'a> {
    node: Node<'a, 'a>,
    path: String,
    source: &'a SourceFile,
}

impl<'a> Element<'a> {
    /// Returns the outermost element, which tells what the file is.
    fn root(
        document: &'a Document<'_>,
        source: &'a SourceFile,
        wanted: &str,
    ) -> Result<Self, XmlError> {
        let node = document.root_element();
        let root = Self {
            node,
            path: node.tag_name().name().to_owned(),
            source,
        };
        if root.path == wanted {
            return Ok(root);
        }
        Err(XmlError {
            file: source.name().clone(),
            line: root.line(node),
            reason: other_root(&root.path, wanted),
        })
    }

    fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    fn line(&self, node: Node<'_, '_>) -> u32 {
        let offset = u32::try_from(node.range().start).unwrap_or(u32::MAX);
        self.source.lines().line(offset)
    }

    /// Returns the elements in this one, numbered by their names.
    fn children(&self) -> impl Iterator<Item = Self> + use<'a> {
        let mut numbers = HashMap::<&str, u32>::new();
        let (path, source) = (self.path.clone(), self.source);
        let nodes = self.node.children().filter(Node::is_element);
        nodes.map(move |node| {
            let name = node.tag_name().name();
            let number = numbers.entry(name).or_default();
            *number += 1;
            Self {
                node,
                path: format!("{path}/{name}[{number}]"),
                source,
            }
        })
    }

    /// Returns the elements with these names below this one, from level to level.
    fn at(&self, names: &[&str]) -> Vec<Self> {
        let Some((name, rest)) = names.split_first() else {
            return Vec::new();
        };
        let found = self.children().filter(|child| child.name() == *name);
        if rest.is_empty() {
            found.collect()
        } else {
            found.flat_map(|child| child.at(rest)).collect()
        }
    }

    /// Returns the last child with a name.
    fn last(&self, name: &str) -> Option<Node<'a, 'a>> {
        self.node.children().rfind(|child| child.has_tag_name(name))
    }

    /// Returns the text of the last child with a name.
    fn text(&self, name: &str) -> Option<&'a str> {
        self.last(name).map(text)
    }
}

/// A process data object.
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

impl Pdo {
    fn new(element: &Element<'_>) -> Option<Self> {
        let receives = match element.name() {
            "RxPdo" => true,
            "TxPdo" => false,
            _ => return None,
        };
        let entries = element.at(&["Entry"]).into_iter();
        let entries = entries.filter_map(|entry| {
            let index = entry.last("Index")?;
            Some(Mapped {
                index: number16(text(index))?,
                line: entry.line(index),
                path: entry.path,
            })
        });
        Some(Self {
            receives,
            index: element.text("Index").and_then(number16).unwrap_or_default(),
            name: shortened(element.text("Name")),
            has_sync_manager: element.node.has_attribute("Sm"),
            entries: entries.collect(),
        })
    }
}

/// Values that a device maps.
struct Mapping {
    name: String,
    vendor: Option<u32>,
    product: Option<u32>,
    protocol: Protocol,
    pdos: Vec<Pdo>,
    /// The objects that its sync managers list.
    assigned: Vec<u16>,
}

impl Mapping {
    fn new(device: &Element<'_>) -> Self {
        let sercos = device.at(&["Mailbox", "SoE"]);
        let infos = device.at(&["Info"]);
        let of_info = |name| infos.iter().rev().find_map(|info| info.text(name));
        let attribute = |name| device.last("Type").and_then(|it| it.attribute(name));
        let name = device.text("Type").or_else(|| of_info("Name"));
        let product = attribute("ProductCode").or_else(|| attribute("ModuleIdent"));
        let mut mapping = Self {
            name: shortened(name),
            vendor: of_info("VendorId").and_then(number),
            product: product.or_else(|| of_info("ProductCode")).and_then(number),
            protocol: if sercos.is_empty() {
                Protocol::default()
            } else {
                Protocol::Sercos
            },
            pdos: Vec::new(),
            assigned: Vec::new(),
        };
        for child in device.children() {
            mapping.pdos.extend(Pdo::new(&child));
            if child.name() == "ProcessData" {
                child.children().for_each(|it| mapping.process_data(&it));
            }
        }
        mapping
    }

    /// Takes an element of the process data: a process data object, or a sync manager with those assigned to it.
    fn process_data(&mut self, element: &Element<'_>) {
        self.pdos.extend(Pdo::new(element));
        if element.name().starts_with("Sm") {
            let objects = element.node.children().filter(|it| it.has_tag_name("Pdo"));
            let numbers = objects.filter_map(|object| number16(text(object)));
            self.assigned.extend(numbers);
        }
    }

    /// Returns whether the file says which objects are exchanged.
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

    fn slave(self, element: &Element<'_>) -> Slave {
        let assigned = self.pdos.iter().filter(|pdo| self.is_assigned(pdo));
        Slave {
            own_friction: own_friction(element),
            mapped: self.mapped(assigned),
            axes: self.axes(),
            assigns: self.assigns(),
            protocol: self.protocol,
            name: self.name,
            vendor: self.vendor,
            product: self.product,
            path: element.path.clone(),
            line: element.line(element.node),
        }
    }

    fn device(self, vendor: Option<u32>) -> Device {
        Device {
            mappable: self.mapped(self.pdos.iter()),
            name: self.name,
            vendor: self.vendor.or(vendor),
            product: self.product,
        }
    }
}

/// Returns the commands of the start-up that switch on the friction compensation of the device: an AX8000 and an AMP8000
/// have it in object 3144h, that of their second axis in 3544h (R7.10).
fn own_friction(slave: &Element<'_>) -> Vec<OwnFriction> {
    let commands = slave.at(&["Mailbox", "CoE", "InitCmds", "InitCmd"]);
    let found = commands.iter().filter_map(|command| {
        // `Ccs` 1 writes, 2 reads.
        let is_write = command.text("Ccs").is_none_or(|ccs| ccs == "1");
        let sub = command.text("SubIndex").and_then(number)?;
        let index = command.text("Index").and_then(number16)?;
        let channel = match index {
            0x3144 => 1,
            0x3544 => 2,
            _ => return None,
        };
        let data = command.text("Data")?;
        let is_on = data
            .bytes()
            .any(|digit| digit.is_ascii_hexdigit() && digit != b'0');
        // A negative zero is one, too.
        let is_zero = !is_on || data.eq_ignore_ascii_case("00000080");
        (is_write && (1..=3).contains(&sub) && !is_zero).then(|| OwnFriction {
            channel,
            object: format!("{index:04X}:{sub:02}"),
            path: command.path.clone(),
            line: command.line(command.node),
        })
    });
    found.collect()
}

/// Returns the axis that a SERCOS telegram belongs to: those of further axes lie 1000h higher.
fn soe_channel(pdo: u16) -> u8 {
    u8::try_from(pdo >> 12).map_or(1, |above| above + 1)
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

/// Returns the text of an element without the blanks around it.
fn text<'a>(node: Node<'a, 'a>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

/// Returns the beginning of a name that is kept.
fn shortened(name: Option<&str>) -> String {
    name.unwrap_or_default().chars().take(MOST_NAME).collect()
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
