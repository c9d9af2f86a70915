//! The one table of codes.
//!
//! The control's own numbers (`P-ERR-…`) are listed only where a document ties the number to the
//! cause; all others begin with `FC` (R9.23): 1xx files, configuration and lists, 2xx syntax, 3xx
//! meaning, 4xx lints, 5xx drive, 9xx unknown values and budgets. A number is never reused.
//!
//! A filter selects the codes that count (R9.72), and changes severities of the own ones.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};

use super::message::{Diagnostic, Severity};

macro_rules! codes {
    ($($name:ident $text:literal $severity:ident $title:literal;)+) => {
        /// The stable name of a diagnostic.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $(#[doc = concat!("`", $text, "`: ", $title, ".")] $name,)+
        }

        impl Code {
            /// Every code, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$name,)+];

            /// Returns the code as printed.
            pub fn as_str(self) -> &'static str {
                match self { $(Self::$name => $text,)+ }
            }

            /// Returns the severity, unless the user's `[lint]` table sets another (R9.28).
            pub fn severity(self) -> Severity {
                match self { $(Self::$name => Severity::$severity,)+ }
            }

            /// Returns the subject in a few words.
            pub fn title(self) -> &'static str {
                match self { $(Self::$name => $title,)+ }
            }

            /// Returns the page that `frictcomp explain` shows.
            pub fn page(self) -> &'static str {
                match self { $(Self::$name => include_str!(concat!("../../docs/codes/", $text, ".md")),)+ }
            }
        }
    };
}

codes! {
    PErr20008 "P-ERR-20008" Error "first feed move without a feed";
    PErr20100 "P-ERR-20100" Error "variable that can only be read";
    PErr20131 "P-ERR-20131" Error "G function without a program";
    PErr20160 "P-ERR-20160" Error "M function above 1000";
    PErr20200 "P-ERR-20200" Error "axis that the channel does not have";
    PErr20375 "P-ERR-20375" Warning "`$IF` without `$ENDIF`";
    PErr20472 "P-ERR-20472" Error "coupling group redefined while it is active";
    PErr20839 "P-ERR-20839" Error "jump target that is not permitted";
    PErr20847 "P-ERR-20847" Error "value outside the type of its variable";
    PErr20909 "P-ERR-20909" Error "variable declared twice";
    PErr20933 "P-ERR-20933" Error "cycle variable of a calling program deleted";
    PErr20966 "P-ERR-20966" Error "dimension below 1";
    PErr21216 "P-ERR-21216" Error "array without an index";
    PErr21301 "P-ERR-21301" Error "invalid first keyword in an axis bracket";
    PErr21274 "P-ERR-21274" Error "no saved axes";
    PErr21275 "P-ERR-21275" Error "no saved couplings";
    PErr21381 "P-ERR-21381" Error "cycle call while a modal cycle is active";
    PErr21387 "P-ERR-21387" Error "`#IF` without `#ENDIF`";
    PErr21403 "P-ERR-21403" Error "COMP on an axis in an active coupling";
    PErr21413 "P-ERR-21413" Error "`#MACHINE DATA` waits without `SYN`";
    PErr21480 "P-ERR-21480" Error "jump within a loop";
    PErr21772 "P-ERR-21772" Error "array that exists with other dimensions";
    PErr21500 "P-ERR-21500" Error "local subprogram ends in an open `$IF`";
    PErr21501 "P-ERR-21501" Error "main program ends in an open `$IF`";
    PErr21502 "P-ERR-21502" Error "global subprogram ends in an open `$IF`";
    PErr21947 "P-ERR-21947" Error "unknown axis";
    PErr22132 "P-ERR-22132" Error "execution that cannot be simulated";
    PErr51081 "P-ERR-51081" Error "flushing in an optional section";
    PErr70310 "P-ERR-70310" Error "leadscrew error compensation is not selected";
    PErr70313 "P-ERR-70313" Error "temperature compensation is not selected";
    PErr70316 "P-ERR-70316" Error "cross compensation is not selected";
    PErr70319 "P-ERR-70319" Error "plane compensation is not selected";
    PErr70435 "P-ERR-70435" Error "motion without a compensation that the axis requires";
    PErr70495 "P-ERR-70495" Error "friction compensation is not configured";
    PErr70631 "P-ERR-70631" Error "crosstalk compensation is not selected";
    PErr70637 "P-ERR-70637" Error "backlash compensation is not selected";
    PErr110229 "P-ERR-110229" Error "axis number differs between the lists";
    PErr110464 "P-ERR-110464" Error "torque offset on a drive that takes none";
    PErr110465 "P-ERR-110465" Error "denominator of the torque scaling is 0";
    PErr110591 "P-ERR-110591" Error "velocities negative or not ascending";
    PErr110592 "P-ERR-110592" Error "unknown mode or no table values";
    PErr110641 "P-ERR-110641" Error "max_points changed after the first load";
    Fc101 "FC101" Warning "character outside ASCII";
    Fc102 "FC102" Warning "text shown in another order than it is read";
    Fc103 "FC103" Warning "program without a block";
    Fc104 "FC104" Error "file that is no program";
    Fc105 "FC105" Warning "program that was not looked at";
    Fc110 "FC110" Error "configuration not understood";
    Fc120 "FC120" Info "list without `Ende`";
    Fc121 "FC121" Warning "key given twice";
    Fc122 "FC122" Warning "unknown key";
    Fc123 "FC123" Error "list file not found or not readable";
    Fc124 "FC124" Warning "list line not understood";
    Fc125 "FC125" Error "list of another kind";
    Fc130 "FC130" Error "value outside its type";
    Fc131 "FC131" Error "more table entries than max_points";
    Fc132 "FC132" Warning "value outside the documented range";
    Fc133 "FC133" Error "fewer table lines than table_entries";
    Fc134 "FC134" Warning "more table lines than table_entries";
    Fc135 "FC135" Warning "value list on an axis that is not configured";
    Fc136 "FC136" Warning "first table point comes too late";
    Fc137 "FC137" Warning "value exceeds 16 bits";
    Fc138 "FC138" Warning "friction values on a spindle";
    Fc139 "FC139" Warning "implausible friction values";
    Fc140 "FC140" Warning "gantry slave compensated differently from its master";
    Fc201 "FC201" Error "incomplete COMP command";
    Fc202 "FC202" Error "unknown compensation kind";
    Fc203 "FC203" Error "kind after OFF_ALL";
    Fc204 "FC204" Error "more than one selection in a bracket";
    Fc205 "FC205" Error "bracket not closed";
    Fc206 "FC206" Error "block too long";
    Fc207 "FC207" Error "text not understood";
    Fc208 "FC208" Error "control block not well-formed";
    Fc209 "FC209" Error "jump label missing or given twice";
    Fc210 "FC210" Warning "text not known to frictcomp";
    Fc211 "FC211" Warning "axis word without a value";
    Fc212 "FC212" Info "number that looks like an exponent";
    Fc301 "FC301" Warning "opposite COMP commands in one block";
    Fc302 "FC302" Error "COMP on a spindle";
    Fc303 "FC303" Warning "selected without an accepted value list";
    Fc305 "FC305" Warning "compensation kind newer than the CNC build";
    Fc306 "FC306" Error "block that the selected reading refuses";
    Fc310 "FC310" Warning "program without M30";
    Fc311 "FC311" Error "parameter read before it was written";
    Fc312 "FC312" Error "expression cannot be computed";
    Fc313 "FC313" Error "two words of one kind in a block";
    Fc314 "FC314" Warning "machine data written by the program";
    Fc315 "FC315" Warning "program end inside a subprogram";
    Fc316 "FC316" Warning "circle by radius that ends where it starts";
    Fc317 "FC317" Warning "return from more programs than were called";
    Fc318 "FC318" Warning "the program stops itself";
    Fc320 "FC320" Error "called program not found or not readable";
    Fc321 "FC321" Error "called program outside the project folders";
    Fc322 "FC322" Warning "variable of the control's state written";
    Fc323 "FC323" Warning "file without a main program";
    Fc324 "FC324" Warning "main program that is never run";
    Fc325 "FC325" Warning "no program for a word that calls one";
    Fc326 "FC326" Warning "program of another control";
    Fc327 "FC327" Warning "feed move without a feed";
    Fc328 "FC328" Warning "block that the control may refuse";
    Fc329 "FC329" Info "called name that several files have";
    Fc401 "FC401" Warning "state not restored before program end";
    Fc402 "FC402" Info "command repeats what the program did";
    Fc403 "FC403" Warning "depends on the program before";
    Fc404 "FC404" Info "lower-case keyword";
    Fc405 "FC405" Info "COMP and motion in one block";
    Fc406 "FC406" Info "kind named twice";
    Fc407 "FC407" Warning "the second run differs from the first";
    Fc408 "FC408" Warning "effect depends on a machine that is not described";
    Fc411 "FC411" Warning "COMP while a transformation is active";
    Fc412 "FC412" Info "compensation state read under cutter radius compensation";
    Fc413 "FC413" Warning "state that depends on the block search";
    Fc414 "FC414" Warning "commands that the control does not read";
    Fc409 "FC409" Info "switched while the axis keeps moving";
    Fc490 "FC490" Warning "unused `allow` comment";
    Fc491 "FC491" Warning "`allow` comment not understood";
    Fc501 "FC501" Error "no additive torque command in the cyclic data";
    Fc502 "FC502" Warning "no actual torque in the cyclic data";
    Fc503 "FC503" Error "drive type without friction compensation";
    Fc504 "FC504" Warning "torque interface not known";
    Fc505 "FC505" Warning "the drive compensates friction, too";
    Fc506 "FC506" Warning "compensation makes it worse";
    Fc511 "FC511" Warning "slow speeds were not recorded";
    Fc512 "FC512" Warning "fast speeds were not recorded";
    Fc513 "FC513" Warning "torque repeats with the position";
    Fc514 "FC514" Warning "too few speeds for a friction curve";
    Fc515 "FC515" Warning "too much noise for the accuracy";
    Fc516 "FC516" Warning "friction drifts";
    Fc517 "FC517" Warning "friction of another form";
    Fc518 "FC518" Info "speed in one direction only";
    Fc519 "FC519" Warning "unit of a channel is assumed";
    Fc520 "FC520" Warning "torque is clipped";
    Fc521 "FC521" Warning "compensation was on while recording";
    Fc522 "FC522" Warning "torque that does not belong to the motion";
    Fc523 "FC523" Warning "absolute values";
    Fc524 "FC524" Warning "improbable unit";
    Fc525 "FC525" Warning "rows are missing";
    Fc526 "FC526" Warning "tight spot";
    Fc901 "FC901" Warning "condition not known offline";
    Fc902 "FC902" Warning "jump or call not known offline";
    Fc903 "FC903" Warning "motion not known offline";
    Fc904 "FC904" Info "trace of the program, not of the machine";
    Fc905 "FC905" Info "messages that are only counted";
    Fc906 "FC906" Info "trace begins later";
    Fc907 "FC907" Info "motion followed in a simpler way";
    Fc908 "FC908" Warning "too many ways to follow";
    Fc909 "FC909" Warning "wait without an end";
    Fc910 "FC910" Warning "loop or program without an end";
    Fc911 "FC911" Error "budget of call depth";
    Fc912 "FC912" Error "budget of nested control blocks";
    Fc913 "FC913" Error "budget of nested brackets";
    Fc914 "FC914" Error "budget of macro expansion";
    Fc915 "FC915" Error "budget of CNC cycles";
    Fc918 "FC918" Error "budget of values";
    Fc919 "FC919" Error "budget of work";
}

impl Code {
    /// Returns whether it reports that a bound of the dry run was reached (R2.60).
    pub fn is_budget(self) -> bool {
        matches!(
            self,
            Self::Fc910
                | Self::Fc911
                | Self::Fc912
                | Self::Fc913
                | Self::Fc914
                | Self::Fc915
                | Self::Fc918
                | Self::Fc919
        )
    }

    /// Returns whether it is about the program text as written, whichever way the control takes (R14.5).
    pub(crate) fn is_about_text(self) -> bool {
        matches!(
            self,
            Self::Fc101
                | Self::Fc102
                | Self::Fc103
                | Self::Fc104
                | Self::Fc210
                | Self::Fc211
                | Self::Fc212
                | Self::Fc323
                | Self::Fc324
                | Self::Fc325
                | Self::Fc326
                | Self::Fc404
                | Self::Fc406
                | Self::Fc414
                | Self::Fc490
                | Self::Fc491
                | Self::Fc905
        )
    }

    /// Returns whether it is one of the control's numbers; those cannot be silenced (R9.24).
    pub fn is_controller(self) -> bool {
        self.as_str().starts_with("P-ERR-")
    }
}

/// A text that is not a code.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no code `{0}`")]
pub struct UnknownCode(pub String);

impl FromStr for Code {
    type Err = UnknownCode;

    /// Finds a code by its text, in any case; the control's numbers also without `P-ERR-`.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut codes = Self::ALL.iter().copied();
        let found = codes.find(|code| {
            code.as_str().eq_ignore_ascii_case(text)
                || (code.is_controller() && code.as_str().strip_prefix("P-ERR-") == Some(text))
        });
        found.ok_or_else(|| UnknownCode(text.to_owned()))
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl Serialize for Code {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

/// Selection of the codes that count, with their severity. Errors of the control always count.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct CodeFilter {
    /// Codes that are not reported.
    pub ignore: Vec<Code>,
    /// The only codes that are reported; all if empty.
    pub select: Vec<Code>,
    /// Severities that replace those of the codes. The last one counts.
    pub severity: Vec<(Code, Severity)>,
}

impl CodeFilter {
    /// Returns whether a code is reported.
    pub fn keeps(&self, code: Code) -> bool {
        let selected = self.select.is_empty() || self.select.contains(&code);
        code.is_controller() || (selected && !self.ignore.contains(&code))
    }

    /// Returns a code whose severity has no effect, because the code is not reported.
    pub fn without_effect(&self) -> Option<Code> {
        let codes = self.severity.iter().map(|(code, _)| *code);
        codes.into_iter().find(|code| !self.keeps(*code))
    }

    /// Changes the severities of a configuration.
    pub fn apply(&self, levels: &mut Levels) {
        for &code in Code::ALL {
            if !self.keeps(code) {
                levels.set(code, None);
            }
        }
        for &(code, severity) in &self.severity {
            levels.set(code, Some(severity));
        }
    }

    /// Applies the filter to messages about lists that were reported already.
    pub fn sift(&self, said: &mut Vec<Diagnostic>) {
        said.retain(|diagnostic| self.keeps(diagnostic.code));
        for diagnostic in said {
            let mut given = self.severity.iter().rev();
            if let Some((_, severity)) = given.find(|(code, _)| *code == diagnostic.code) {
                diagnostic.severity = *severity;
            }
        }
    }
}

/// Severities of the user's `[lint]` table for codes of frictcomp (R9.28).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Levels {
    levels: BTreeMap<Code, Option<Severity>>,
}

impl Levels {
    /// Gives a code another severity, or none, which silences it. The control's own errors keep theirs (R9.24). Returns
    /// whether the code may be changed.
    pub fn set(&mut self, code: Code, level: Option<Severity>) -> bool {
        let ours = !code.is_controller();
        if ours {
            self.levels.insert(code, level);
        }
        ours
    }

    /// Gives a diagnostic the severity that the user set for its code. A raised diagnostic keeps its own, a lowered one
    /// is not raised again, and all others stay as they are. Returns whether it is reported at all.
    pub(crate) fn weigh(&self, diagnostic: &mut Diagnostic) -> bool {
        if diagnostic.is_raised() {
            return true;
        }
        match self.levels.get(&diagnostic.code) {
            Some(None) => return false,
            Some(Some(severity)) if diagnostic.is_lowered() => {
                diagnostic.severity = diagnostic.severity.min(*severity);
            }
            Some(Some(severity)) => diagnostic.severity = *severity,
            None => {}
        }
        true
    }

    /// Returns the codes of warnings and errors that are off.
    pub fn unreported(&self) -> impl Iterator<Item = Code> {
        let off = self.levels.iter().filter(|(_, level)| level.is_none());
        off.map(|(code, _)| *code)
            .filter(|code| code.severity() >= Severity::Warning)
    }

    /// Returns the severity of a code; `None` if it is off.
    pub fn severity(&self, code: Code) -> Option<Severity> {
        self.levels
            .get(&code)
            .copied()
            .unwrap_or(Some(code.severity()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_found_by_their_text() {
        // R9.23
        assert_eq!("70495".parse(), Ok(Code::PErr70495));
        assert_eq!("p-err-70495".parse(), Ok(Code::PErr70495));
        assert_eq!("fc201".parse(), Ok(Code::Fc201));
        assert_eq!("201".parse::<Code>(), Err(UnknownCode("201".to_owned())));
    }

    #[test]
    fn codes_are_left_out_and_weighed() {
        // R9.72
        let mut levels = Levels::default();
        let filter = CodeFilter {
            select: vec![Code::Fc401],
            severity: vec![(Code::Fc401, Severity::Error)],
            ..CodeFilter::default()
        };
        assert_eq!(filter.without_effect(), None);
        filter.apply(&mut levels);
        assert_eq!(levels.severity(Code::Fc401), Some(Severity::Error));
        assert_eq!(levels.severity(Code::Fc402), None);
        assert_eq!(levels.severity(Code::PErr70495), Some(Severity::Error));
        let filter = CodeFilter {
            ignore: vec![Code::Fc401],
            severity: vec![(Code::Fc401, Severity::Error)],
            ..CodeFilter::default()
        };
        assert_eq!(filter.without_effect(), Some(Code::Fc401));
    }
}
