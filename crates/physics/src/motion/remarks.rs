//! The messages on motions.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::planner::ToolRadii;
use frictcomp::diagnostic::{Advice, Code, Diagnostic};
use frictcomp::interpreter::{PositionFrame, Simplifications};
use frictcomp::text::{Place, Span};
use frictcomp::timeline::Row;

/// Limit of the named places.
const MAX_NAMED: usize = 100;

/// The place of a block.
pub(super) struct RemarkPlace<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
    pub(super) line: u32,
}

impl<'a> RemarkPlace<'a> {
    pub(super) fn of(row: &Row<'a>) -> Self {
        Self {
            file: row.file,
            text: row.text,
            line: row.line,
        }
    }

    fn place(&self) -> Place {
        Place {
            file: self.file.into(),
            text: self.text.into(),
            first_line: self.line,
            span: Span::new(0, self.text.len()),
        }
    }
}

/// A remark on a block.
pub(super) struct MotionRemark<'a> {
    pub(super) code: Code,
    pub(super) message: &'a str,
    pub(super) help: Advice,
}

/// Key of a message: the code, file and line of a block, and its subject.
type RemarkKey = (Code, Arc<str>, u32, &'static str);

/// Messages on motions, each once per place.
#[derive(Default)]
pub(super) struct MotionRemarks {
    diagnostics: Vec<Diagnostic>,
    named: BTreeSet<RemarkKey>,
    /// Functions that the last motion was followed without.
    simplified: Simplifications,
    before: Option<BeforeTrace>,
}

/// The motions before the trace begins, because the axis positions are not known.
struct BeforeTrace {
    /// The first of them.
    place: Place,
    count: u64,
    /// The axes whose position at the start is not known.
    axes: BTreeSet<String>,
}

impl MotionRemarks {
    pub(super) fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// Returns the functions that the last motion was followed without.
    pub(super) fn simplified(&self) -> Simplifications {
        self.simplified
    }

    /// Notes a motion before the trace begins, and the axes whose position before it is not known. After a
    /// change of the origin, their positions at the start would not help.
    pub(super) fn note_before(&mut self, row: &Row<'_>, unknown: Vec<String>) {
        let before = self.before.get_or_insert_with(|| BeforeTrace {
            place: RemarkPlace::of(row).place(),
            count: 0,
            axes: BTreeSet::new(),
        });
        before.count += 1;
        if !row.modal.has_moved_origin() {
            before.axes.extend(unknown);
        }
    }

    /// Reports FC906 at the first motion before the trace, which begins now or never.
    pub(super) fn say_before(&mut self) {
        let Some(before) = self.before.take() else {
            return;
        };
        let left_out = match before.count {
            1 => "the trace leaves out this motion".to_owned(),
            count => format!("the trace leaves out {count} motions, of which this is the first"),
        };
        let names: Vec<String> = before.axes.into_iter().collect();
        let (why, help) = match names.as_slice() {
            [] => (
                "the origin was moved by values of the machine".to_owned(),
                Advice::CompleteMotion,
            ),
            names => {
                let plural = if names.len() == 1 { "" } else { "s" };
                let all = names.join(", ");
                (
                    format!("unknown start position{plural} of {all}"),
                    Advice::GiveStart(names.to_vec()),
                )
            }
        };
        let message = format!("{left_out}: {why}");
        let diagnostic = Diagnostic::new(Code::Fc906, before.place, message).with_help(help);
        self.diagnostics.insert(0, diagnostic);
    }

    /// Reports FC907 at the start of something that the trace does not follow in full.
    pub(super) fn say_simplified(&mut self, row: &Row<'_>, holds: Simplifications) {
        for what in holds.without(self.simplified).iter() {
            let message = format!("the trace {}", what.instead());
            let key = (Code::Fc907, Arc::from(row.file), row.line, what.name());
            let remark = MotionRemark {
                code: Code::Fc907,
                message: &message,
                help: Advice::ReadPage(Code::Fc907),
            };
            self.say_once(key, &RemarkPlace::of(row), remark);
        }
        self.simplified = holds;
    }

    /// Reports FC904: the difference between the followed path and that of the machine, once for each.
    pub(super) fn say_frame(&mut self, row: &Row<'_>, frame: PositionFrame) {
        let (subject, message, help) = match frame {
            PositionFrame::Machine => return,
            PositionFrame::Shifted => (
                "origin",
                "from here on the trace has the places of the program: only the machine knows the origin",
                "paths and velocities are those of the machine".into(),
            ),
            PositionFrame::Contour => (
                "tool",
                "from here on the trace is that of the programmed contour: the radius of the tool is not known",
                Advice::GiveToolRadius,
            ),
            PositionFrame::Programmed => (
                "",
                "from here on the trace is that of the program, not of the machine: a transformation is active",
                "the axes of the machine move differently".into(),
            ),
        };
        let remark = MotionRemark {
            code: Code::Fc904,
            message,
            help,
        };
        self.say_once(
            (remark.code, Arc::from(""), 0, subject),
            &RemarkPlace::of(row),
            remark,
        );
    }

    /// Reports FC907: the path of the tool beside a contour.
    pub(super) fn say_tool(&mut self, row: &Row<'_>, radii: &ToolRadii) {
        let remark = MotionRemark {
            code: Code::Fc907,
            message: match radii {
                ToolRadii::OfData(_) => {
                    "the trace follows the tool beside the contour, with the radius of its D word, and passes outer \
                     corners and the first block in its own way (`G41`, `G42`)"
                }
                _ => {
                    "the trace follows the tool beside the contour, with the given radius whichever tool is \
                     selected, and passes outer corners and the first block in its own way (`G41`, `G42`)"
                }
            },
            help: Advice::ReadPage(Code::Fc907),
        };
        self.say_once(
            (remark.code, Arc::from(""), 0, "tool"),
            &RemarkPlace::of(row),
            remark,
        );
    }

    /// Reports FC903: a motion is left out.
    pub(super) fn say_left_out(&mut self, row: &Row<'_>, reason: &str) {
        let message = format!("the trace leaves this motion out: {reason}");
        let key = (Code::Fc903, Arc::from(row.file), row.line, "");
        let remark = MotionRemark {
            code: Code::Fc903,
            message: &message,
            help: Advice::CompleteMotion,
        };
        self.say_once(key, &RemarkPlace::of(row), remark);
    }

    /// Adds a message that applies to the rest of the program: only the first is reported.
    pub(super) fn say(&mut self, at: &RemarkPlace<'_>, remark: MotionRemark<'_>) {
        self.say_once((remark.code, Arc::from(""), 0, ""), at, remark);
    }

    fn say_once(&mut self, key: RemarkKey, at: &RemarkPlace<'_>, remark: MotionRemark<'_>) {
        if self.named.len() < MAX_NAMED && self.named.insert(key) {
            let diagnostic = Diagnostic::new(remark.code, at.place(), remark.message);
            let diagnostic = diagnostic.with_help(remark.help);
            self.diagnostics.push(diagnostic);
        }
    }
}
