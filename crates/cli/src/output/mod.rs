//! Output of a command and its destination: results, messages, progress, pages, the exit status.

mod code_page;
mod console;
pub(crate) mod exit;
mod failure;
mod html;
mod job;
mod outputs;
mod painted;
mod piped;
pub(crate) mod progress;
mod result;
mod watch;

pub(crate) use code_page::{CodePage, Encoded};
pub(crate) use console::{Color, Console, DataTarget, OutputContents, Printed, WIDTHS};
pub(crate) use exit::{CLEAN, FOUND};
pub(crate) use failure::{Failure, Failures, shown};
pub(crate) use html::{Files, HtmlArgs, HtmlFile, write_page};
pub(crate) use job::Job;
pub(crate) use outputs::{Outputs, write_picture, write_text};
pub(crate) use painted::{difference, page, parts, severities};
pub(crate) use piped::broken_pipe;
pub(crate) use progress::Terminal;
pub(crate) use result::{RecordsFormat, ResultArgs, ResultFormat};
pub(crate) use watch::FileWatch;
