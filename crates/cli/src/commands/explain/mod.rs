//! `frictcomp explain`: the page of a code, a parameter, a rule or another word, or the list of all codes.

mod vocabulary;

use std::borrow::Cow;
use std::fmt::Write as _;

use clap::Args;
use serde_json::json;

use crate::output::{
    Console, Failure, Outputs, ResultArgs, ResultFormat, exit, page as titles, severities,
};
use frictcomp::ControlError;
use frictcomp::diagnostic::{Code, did_you_mean};
use frictcomp::documents::PARAMETER_PAGES;
use frictcomp::lists::ChannelKey;
use frictcomp_host::FileRegistry;
use frictcomp_report::{fitted, to_json, wrap};

/// Columns of the page of a command.
const WIDTH: usize = 80;

/// Explain a code, parameter, rule or word; without one, list all codes
#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// A code, parameter, rule or word, such as `FC201`, `70495`, `P-COMP-00043`,
    /// `frict_comp.mode`, `R1.27`, `C12`, `COMP`, `V.A.FRICT_COMP_ACTIVE`, `60B2` or `MP1511`
    #[arg(value_name = "WORD")]
    word: Vec<String>,
    #[command(flatten)]
    result: ResultArgs,
}

/// Runs the command.
pub(crate) fn run(args: &ExplainArgs, console: Console) -> Result<u8, Failure> {
    let mut outputs = Outputs::new(&FileRegistry::default(), console);
    let mut target = outputs.result(args.result.output.as_deref())?;
    let word = (!args.word.is_empty()).then(|| args.word.join(" "));
    match (&word, args.result.format) {
        (None, ResultFormat::Text) => {
            let list = fitted(&codes(), target.look.width);
            target.painted(&list, severities)?
        }
        (None, ResultFormat::Json) => target.text(&codes_document())?,
        (Some(word), format) => {
            let page = page_about(word).map_err(|error| unknown(word, &error))?;
            let page = page.trim_end();
            match format {
                ResultFormat::Text => target.painted(&format!("{page}\n"), titles)?,
                ResultFormat::Json => {
                    let document = json!({ "schema": 1, "word": word.trim(), "page": page });
                    target.text(&to_json(&document))?
                }
            }
        }
    };
    outputs.finish()?;
    Ok(exit::CLEAN)
}

/// Returns every code with its severity and title.
fn codes() -> String {
    let mut codes = Code::ALL.to_vec();
    codes.sort_by_key(|code| {
        let number = code
            .as_str()
            .trim_start_matches(|it: char| !it.is_ascii_digit());
        (code.as_str().starts_with("FC"), number.parse::<u32>().ok())
    });
    codes.iter().fold(String::new(), |mut list, code| {
        let (name, severity) = (code.as_str(), code.severity().as_str());
        let _ = writeln!(list, "{name:<12}  {severity:<7}  {}", code.title());
        list
    })
}

fn codes_document() -> String {
    let codes = Code::ALL.iter().map(|code| {
        json!({
            "code": code.as_str(),
            "severity": code.severity().as_str(),
            "title": code.title(),
        })
    });
    let document = json!({ "schema": 1, "codes": codes.collect::<Vec<_>>() });
    to_json(&document)
}

/// Returns the page about a code, a parameter by its number or its key, a rule, an error number of the control or another
/// word.
///
/// # Errors
/// There is no page about it.
pub fn page_about(word: &str) -> Result<Cow<'static, str>, NoPage> {
    let word = word.trim();
    find(word).ok_or_else(|| {
        let codes = Code::ALL.iter().map(|code| code.as_str());
        let parameters = PARAMETER_PAGES
            .iter()
            .flat_map(|parameter| [parameter.number, parameter.key]);
        let rows = ChannelKey::all().iter();
        let keys = rows.flat_map(|row| [row.pattern(), row.number()]);
        let all = codes
            .chain(parameters)
            .chain(vocabulary::words())
            .chain(keys);
        NoPage {
            near: did_you_mean(word, all).map(str::to_owned),
        }
    })
}

/// A word without a page.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct NoPage {
    /// The most similar word that has one.
    pub near: Option<String>,
}

fn find(text: &str) -> Option<Cow<'static, str>> {
    let number = text.bytes().all(|byte| byte.is_ascii_digit());
    let bare = number.then(|| format!("FC{text}"));
    let code = text.parse::<Code>().ok();
    if let Some(code) = code.or_else(|| bare?.parse().ok()) {
        return Some(code.page().into());
    }
    let key = general_key(text);
    PARAMETER_PAGES
        .iter()
        .find(|parameter| {
            parameter.number.eq_ignore_ascii_case(text) || parameter.key.eq_ignore_ascii_case(&key)
        })
        .map(|parameter| parameter.page.into())
        .or_else(|| vocabulary::find(text).map(Cow::Owned))
        .or_else(|| control_error(text).map(Cow::Owned))
        .or_else(|| channel_key(text).map(Cow::Owned))
        .or_else(|| command(text).map(Cow::Owned))
}

/// Returns the page of a command of the tool: `circle`, `commission learn`.
fn command(text: &str) -> Option<String> {
    let mut command = &crate::description();
    for word in text.split_whitespace().skip_while(|it| *it == "frictcomp") {
        command = command.find_subcommand(word)?;
    }
    let about = command.get_long_about().or_else(|| command.get_about())?;
    let name = text.trim_start_matches("frictcomp").trim();
    let about = about.to_string();
    let paragraphs = about
        .split("\n\n")
        .map(|it| format!("{}.", it.trim_end_matches('.')));
    let further = format!("`frictcomp {name} --help` shows its options and examples.");
    let paragraphs = paragraphs
        .chain([further])
        .map(|it| wrap(&it, WIDTH, 0) + "\n");
    let page: Vec<String> = paragraphs.collect();
    (!name.is_empty()).then(|| format!("# frictcomp {name}\n\n{}", page.join("\n")))
}

/// Returns the page of an error number of the control, with `P-ERR-` or without (R2.114).
fn control_error(text: &str) -> Option<String> {
    let number = text.to_ascii_uppercase();
    let number = number.strip_prefix("P-ERR-").unwrap_or(&number);
    let row = ControlError::of(number.parse().ok()?)?;
    Some(row.explanation())
}

/// Returns the page of a key of a channel list, by its number or with any indices (R2.105).
fn channel_key(text: &str) -> Option<String> {
    let wanted = vocabulary::canonical(text);
    let is_it = |row: &&ChannelKey| {
        [&row.key(), row.number()]
            .map(vocabulary::canonical)
            .contains(&wanted)
    };
    let row = ChannelKey::all().iter().find(is_it)?;
    (!wanted.is_empty()).then(|| row.explanation())
}

/// Turns `frict_comp.table[3].in` into `frict_comp.table[i].in`.
fn general_key(text: &str) -> String {
    let Some((before, rest)) = text.split_once('[') else {
        return text.to_owned();
    };
    match rest.split_once(']') {
        Some((index, behind)) if index.bytes().all(|byte| byte.is_ascii_digit()) => {
            format!("{before}[i]{behind}")
        }
        _ => text.to_owned(),
    }
}

fn unknown(text: &str, error: &NoPage) -> Failure {
    let failure = Failure::new(format!("there is no page about `{text}`"));
    match &error.near {
        Some(near) => failure.with_help(format!("did you mean `{near}`?")),
        None => failure.with_help("`frictcomp explain` lists every code"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_found_by_every_name() {
        for name in [
            "P-ERR-70495",
            "70495",
            "fc201",
            "P-COMP-00043",
            "p-axis-00522",
            "frict_comp.mode",
            "frict_comp.table[7].in",
            "frict_comp.table[i].out",
            "139",
            "R1.27",
            "120434",
            "P-ERR-22008",
            "COMP",
            "circle",
            "frictcomp commission learn",
        ] {
            assert!(find(name).is_some(), "{name}");
        }
        assert!(find("P-ERR-1").is_none());
        assert!(find("1").is_none() && find("").is_none());
        for (word, near) in [("FC20l", "FC201"), ("FRIKT", "FRICT")] {
            let error = page_about(word).expect_err("a misspelt word");
            assert_eq!(error.near.as_deref(), Some(near));
        }
    }
}
