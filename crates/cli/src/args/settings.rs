//! Option values with a syntax: `NAME=VALUE`, `FRICT,LEAD`.

use crate::output::WIDTHS;
use frictcomp::comp::{Kind, KindSet};
use frictcomp::diagnostic::did_you_mean;
use frictcomp::machine::Setting;

/// A variable and its value, from `--set`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SetVariable {
    pub(crate) name: String,
    pub(crate) value: Setting,
}

/// Parses `V.E.PART=3`; a value that is not a number is a text.
pub(crate) fn parse_setting(text: &str) -> Result<SetVariable, String> {
    let Some((name, value)) = text.split_once('=') else {
        return Err("write it as NAME=VALUE, such as V.E.PART=3".to_owned());
    };
    let (name, value) = (name.trim(), value.trim());
    if !Setting::is_for(name) {
        return Err(format!(
            "`{name}` is not a variable; variables are, for example, `V.E.PART`, `P5` and `@P5`"
        ));
    }
    if value.is_empty() {
        return Err(format!(
            "there is no value after `{name}=`; an empty text is `\"\"`"
        ));
    }
    let number = value
        .parse::<f64>()
        .ok()
        .filter(|number| number.is_finite());
    let unquoted = value
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'))
        .unwrap_or(value);
    Ok(SetVariable {
        name: name.to_owned(),
        value: number.map_or_else(|| Setting::Text(unquoted.to_owned()), Setting::Number),
    })
}

/// Parses a width in columns.
pub(crate) fn parse_width(text: &str) -> Result<usize, String> {
    let width = text.trim().parse().ok();
    width.filter(|width| WIDTHS.contains(width)).ok_or_else(|| {
        let (least, most) = (WIDTHS.start(), WIDTHS.end());
        format!("a width is a number of columns from {least} to {most}")
    })
}

/// Parses `FRICT,LEAD` or `all`.
pub(crate) fn parse_kinds(text: &str) -> Result<KindSet, String> {
    if text.eq_ignore_ascii_case("all") {
        return Ok(KindSet::ALL);
    }
    text.split(',')
        .map(|word| {
            let word = word.trim();
            word.parse().map_err(|_| {
                let near = did_you_mean(word, Kind::ALL.map(Kind::as_str));
                match near {
                    Some(near) => format!("`{word}` is not a kind; did you mean `{near}`?"),
                    None => format!("`{word}` is not a kind; write `FRICT,LEAD` or `all`"),
                }
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_numbers_or_texts() {
        let value = |text| parse_setting(text).unwrap().value;
        assert_eq!(value("V.E.PART=3"), Setting::Number(3.0));
        assert_eq!(value("V.E.NAME = nan"), Setting::Text("nan".to_owned()));
        assert_eq!(value("V.E.NAME=\"3\""), Setting::Text("3".to_owned()));
        assert_eq!(value("V.E.A=b=c"), Setting::Text("b=c".to_owned()));
        assert!(parse_setting("V.E.PART").is_err());
        // R9.74
        for wrong in ["=3", "V.E.PART=", "E.PART=3", "PART=3", "P=3", "@5=1"] {
            assert!(parse_setting(wrong).is_err(), "{wrong}");
        }
        assert_eq!(value("v.e.list[P1]=1"), Setting::Number(1.0));
        assert_eq!(value("p4=1"), Setting::Number(1.0));
        assert_eq!(value("@P4=1"), Setting::Number(1.0));
        assert_eq!(value("V.E.NAME=\"\""), Setting::Text(String::new()));
    }

    #[test]
    fn kinds_are_keywords() {
        assert_eq!(parse_kinds("frict").unwrap(), KindSet::of(Kind::Frict));
        assert_eq!(parse_kinds("all").unwrap(), KindSet::ALL);
        assert!(parse_kinds("FRIKT").unwrap_err().contains("`FRICT`"));
    }
}
