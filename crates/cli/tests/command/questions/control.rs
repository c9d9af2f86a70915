//! A small independent control that runs the programs of `frictcomp ask`. It does not use
//! the dry run, and follows either reading of a question.

use std::fmt::Write as _;

/// A control with one axis.
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a switch of the machine"
)]
pub(crate) struct Control {
    /// The rule of the question, and whether the second reading is followed.
    pub(crate) asked: (&'static str, bool),
    /// P-AXIS-00522.
    pub(crate) configured: bool,
    /// Whether the control accepted a value list.
    pub(crate) has_list: bool,
    /// Whether skip level 2 is on.
    pub(crate) level_2: bool,
    on: bool,
    lead: bool,
    variable: u32,
    /// `message.txt`.
    pub(crate) messages: String,
}

impl Control {
    pub(crate) fn new(rule: &'static str, second: bool) -> Self {
        Self {
            asked: (rule, second),
            configured: rule != "R1.25",
            has_list: rule != "R1.26",
            level_2: false,
            on: rule != "R1.25",
            lead: rule == "R1.40" && second,
            variable: 0,
            messages: String::new(),
        }
    }

    fn follows_second(&self, rule: &str) -> bool {
        self.asked == (rule, true)
    }

    pub(crate) fn reset(&mut self) {
        if self.follows_second("R1.28") {
            self.on = self.configured;
        }
    }

    pub(crate) fn restart(&mut self) {
        if !self.follows_second("R1.29") {
            self.on = self.configured;
        }
    }

    /// Runs a program, from a block on if a search for it is requested. Returns the number of the error that
    /// stopped it.
    pub(crate) fn start(&mut self, text: &str, search: Option<&str>) -> Option<u32> {
        let level_at_start = self.level_2;
        let mut searching = search.is_some();
        for line in text.lines() {
            let mut block = line.split(';').next().unwrap_or_default().trim();
            if let Some(rest) = block.strip_prefix("/2 ") {
                let skipped = if self.follows_second("R2.90") {
                    level_at_start
                } else {
                    self.level_2
                };
                if skipped {
                    continue;
                }
                block = rest;
            }
            if let Some(rest) = block.strip_prefix('N') {
                let number = rest.split(' ').next().unwrap_or_default();
                searching &= search != Some(number);
                block = rest[number.len()..].trim_start();
            }
            if let Some(message) = block.strip_prefix("#MSG SAVE EXCLUSIVE [\"") {
                self.save(message);
            } else if searching && self.follows_second("R2.96") {
                // Only decoded.
            } else if let Some(error) = self.execute(block) {
                return Some(error);
            }
        }
        None
    }

    fn save(&mut self, message: &str) {
        let (text, rest) = message.split_once('"').expect("a text");
        let value = match rest.trim_start_matches(", ").trim_end_matches(']') {
            "V.A.FRICT_COMP_ACTIVE.X" => self.configured && self.has_list && self.on,
            "V.A.FRICT_COMP_INIT.X" => self.configured && self.has_list,
            "V.A.LEAD_COMP_ACTIVE.X" => self.lead,
            "V.A.LEAD_COMP_INIT.X" => self.asked.0 == "R1.40",
            "V.S.FRICTASK" => self.variable == 1,
            "P1" => !self.follows_second("R2.40"),
            "P2" => !self.follows_second("R2.112"),
            "V.P.FRICTASK" => self.follows_second("R2.101"),
            "" => false,
            other => panic!("unknown value {other}"),
        };
        let text = text.replace("%d", &u32::from(value).to_string());
        writeln!(self.messages, "{text}").expect("text");
    }

    fn execute(&mut self, block: &str) -> Option<u32> {
        if block.starts_with("X[") {
            return self.commands(block);
        }
        if block == "M00" {
            self.level_2 = true;
        } else if block.starts_with("#ERROR") && self.follows_second("R2.100") {
            return Some(455);
        } else if self.refuses(block) {
            return Some(456);
        } else if block.starts_with("#CALL AX") && self.follows_second("R2.70") {
            self.on = self.configured;
        } else if block.starts_with("#MACHINE DATA") && !self.follows_second("R2.92") {
            self.on = true;
        } else if let Some(value) = block.strip_prefix("V.S.FRICTASK = ") {
            self.variable = value.parse().expect("a number");
        }
        None
    }

    /// Returns whether a block is an error by the second reading of a question.
    fn refuses(&self, block: &str) -> bool {
        let asked = [
            ("V.L.FRICTASK", "R2.102"),
            ("$GOTO [FRICTASK]", "R2.103"),
            ("#CONTOUR BEGIN", "R2.109"),
            ("O1234", "R2.113"),
        ];
        let mut rows = asked.into_iter();
        rows.any(|(begins, rule)| block.starts_with(begins) && self.follows_second(rule))
    }

    fn commands(&mut self, block: &str) -> Option<u32> {
        let mut switched = false;
        for command in block.split(']').filter(|it| !it.trim().is_empty()) {
            let words = command.trim().trim_start_matches("X[");
            let is_lower = words.chars().any(char::is_lowercase);
            let on = words.eq_ignore_ascii_case("COMP ON FRICT");
            if is_lower && self.follows_second("R1.8") {
                return Some(20_123);
            }
            if !self.configured && (on || self.follows_second("R1.25")) {
                return Some(if on { 70_495 } else { 70_999 });
            }
            if on && !self.has_list && self.follows_second("R1.26") {
                return Some(70_998);
            }
            if !(switched && self.follows_second("R1.31")) {
                self.on = on;
            }
            switched = true;
        }
        None
    }
}
