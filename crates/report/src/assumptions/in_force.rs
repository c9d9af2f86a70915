//! The remark on the readings of open questions on which results rest (R15.3).

use frictcomp::timeline::{ReadingInForce, ReadingsInForce};

/// Returns the remark; `None` if nothing rests on a reading.
pub fn rests_on_text(readings: &ReadingsInForce) -> Option<String> {
    let named: Vec<String> = readings.iter().map(named).collect();
    if named.is_empty() {
        return None;
    }
    let is_open = readings.iter().any(|it| it.basis != "confirmed");
    let ask = if is_open {
        " (`frictcomp ask` writes the test)"
    } else {
        ""
    };
    Some(format!("Rests on {}{ask}", named.join("; ")))
}

fn named(reading: &ReadingInForce) -> String {
    let basis = match &reading.build {
        Some(build) => format!("confirmed on {build}"),
        None if reading.basis == "selected" => "selected in frictcomp.toml".to_owned(),
        None => reading.basis.to_owned(),
    };
    format!("{}, {basis}: {}", reading.rule, reading.meaning)
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::comp::CncBuild;
    use frictcomp::machine::Machine;
    use frictcomp::readings::{Alternative, Confirmation, Question, QuestionSet};

    #[test]
    fn each_reading_says_its_basis() {
        // R15.3
        let mut machine = Machine::enabled(["X"]);
        let build = CncBuild::new([3, 1, 3132, 0]);
        machine.build = Some(build);
        machine
            .readings
            .select(Question::OrderInBlock, Alternative::Second);
        let date = "2026-05-01".to_owned();
        let answer = Confirmation { build, date };
        machine.readings.confirm(Question::Reset, answer);
        let mut asked = QuestionSet::default();
        assert_eq!(rests_on_text(&ReadingsInForce::of(asked, &machine)), None);
        asked.insert(Question::Reset);
        let words = |asked| rests_on_text(&ReadingsInForce::of(asked, &machine));
        let confirmed = "Rests on R1.28, confirmed on V3.1.3132.00: a reset keeps the state";
        assert_eq!(words(asked).as_deref(), Some(confirmed));
        asked.insert(Question::OrderInBlock);
        asked.insert(Question::WithMotion);
        // Neither reading is taken: both are shown.
        asked.insert(Question::BlockSearch);
        let all = "Rests on R1.9, assumed: the motion of a block with COMP is made in the new state; \
                   R1.28, confirmed on V3.1.3132.00: a reset keeps the state; R1.31, selected in \
                   frictcomp.toml: the first of two opposite commands wins (`frictcomp ask` writes the test)";
        assert_eq!(words(asked).as_deref(), Some(all));
        let records = serde_json::to_value(ReadingsInForce::of(asked, &machine)).expect("JSON");
        assert_eq!(records[1]["basis"], "confirmed");
        assert_eq!(records[1]["build"], "V3.1.3132.00");
        assert_eq!(records[0].get("build"), None);
    }
}
