//! The answers in `frictcomp.toml`.

use std::time::{SystemTime, UNIX_EPOCH};

use toml_edit::{DocumentMut, InlineTable, Item, Table, TomlError, value};

use frictcomp::comp::CncBuild;
use frictcomp::readings::{Alternative, Question};

/// An answer recorded in the configuration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AnsweredReading {
    /// The question.
    pub(super) question: Question,
    /// The reading that the control follows.
    pub(super) reading: Alternative,
    /// The build of the control; without it nothing is confirmed.
    pub(super) build: Option<CncBuild>,
    /// The date of the answer.
    pub(super) date: String,
}

/// Returns the text of a configuration with answers in `[reading]` and `[confirmed]`; everything else stays.
pub(super) fn with_findings(text: &str, findings: &[AnsweredReading]) -> Result<String, TomlError> {
    let mut document = text.parse::<DocumentMut>()?;
    for finding in findings {
        let rule = finding.question.facts().rule;
        let reading = finding.question.name_of(finding.reading);
        table(&mut document, "reading")[rule] = value(reading);
        match finding.build {
            Some(build) => {
                let mut confirmed = InlineTable::new();
                confirmed.insert("build", build.to_string().into());
                confirmed.insert("date", finding.date.as_str().into());
                table(&mut document, "confirmed")[rule] = value(confirmed);
            }
            // An older answer does not apply to this one.
            None => {
                if let Some(confirmed) = document.get_mut("confirmed").and_then(Item::as_table_mut)
                {
                    confirmed.remove(rule);
                }
            }
        }
    }
    Ok(document.to_string())
}

fn table<'a>(document: &'a mut DocumentMut, name: &str) -> &'a mut Item {
    document
        .entry(name)
        .or_insert_with(|| Item::Table(Table::new()))
}

/// Returns the date of a moment in universal time, `2026-01-31`.
pub(super) fn date_of(moment: SystemTime) -> String {
    let seconds = moment
        .duration_since(UNIX_EPOCH)
        .map_or(0, |it| it.as_secs());
    // Days to a date of the Gregorian calendar, in eras of 400 years that begin with March.
    let days = seconds / 86_400 + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 {
        shifted_month + 3
    } else {
        shifted_month - 9
    };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// R15.2: the date of an answer is that of its file.
    #[test]
    fn dates_are_those_of_the_calendar() {
        let of = |seconds| date_of(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(of(0), "1970-01-01");
        assert_eq!(of(951_782_400), "2000-02-29");
        assert_eq!(of(1_798_761_599), "2026-12-31");
    }

    /// R15.2: the rest of a configuration stays as it is, a new answer takes the place of an old one.
    #[test]
    fn answers_take_their_place_in_the_configuration() {
        let before = "# the mill\n[machine]\ncnc_build = \"3.1.3132.0\" # ours\n";
        let finding = |reading, build| AnsweredReading {
            question: Question::Reset,
            reading,
            build,
            date: "2026-01-31".to_owned(),
        };
        let build = Some(CncBuild::new([3, 1, 3132, 0]));
        let first = with_findings(before, &[finding(Alternative::Second, build)]).expect("TOML");
        assert!(first.starts_with(before), "{first}");
        assert!(first.contains("\"R1.28\" = \"start-up\""), "{first}");
        let again = with_findings(&first, &[finding(Alternative::First, None)]).expect("TOML");
        assert!(again.contains("\"R1.28\" = \"kept\""), "{again}");
        assert!(!again.contains("date"), "{again}");
    }
}
