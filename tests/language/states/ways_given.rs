//! The ways that are named for a state lead there when their answers are given (R14.2, R14.7).

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::ControlFlow;

use frictcomp::comp::{Kind, State};
use frictcomp::interpreter::{PossibleStates, WayCondition};
use frictcomp::session::{Program, Session};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};

use crate::support::Bench;

struct Nothing;

impl Sink for Nothing {
    fn record(&mut self, _: &Record<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Values of the machine by their names, and whether skip level 1 is on.
struct Answers {
    values: BTreeMap<String, f64>,
    is_skipped: bool,
}

fn run(bench: &Bench, program: &str) -> Session {
    let mut session = bench.session();
    let source = Program::Whole(SourceFile::new("a.nc", program));
    let _ = session.program("a.nc", source, &mut |_: &str, _: &str| None, &mut Nothing);
    session
}

/// Returns every combination of values below a number of each variable, and of the skip level.
fn all_answers(variables: &[(&str, u32)]) -> Vec<Answers> {
    let count: u32 = variables.iter().map(|(_, below)| below).product();
    let answers = (0..2 * count).map(|number| {
        let mut rest = number / 2;
        let values = variables.iter().map(|(name, below)| {
            let value = f64::from(rest % below);
            rest /= below;
            ((*name).to_owned(), value)
        });
        Answers {
            values: values.collect(),
            is_skipped: number % 2 == 1,
        }
    });
    answers.collect()
}

impl Answers {
    fn give(&self, bench: Bench) -> Bench {
        let bench = bench.skip(if self.is_skipped { "1" } else { "none" });
        self.values
            .iter()
            .fold(bench, |bench, (name, value)| bench.set(name, *value))
    }

    /// Returns whether a condition `V.E.A == 1`, or one of several, is true.
    #[allow(clippy::float_cmp)] // whole numbers are exact
    fn holds(&self, text: &str) -> bool {
        text.split(" || ").any(|text| {
            let words: Vec<&str> = text.split_whitespace().collect();
            let [name, operator, number] = words.as_slice() else {
                panic!("{text}");
            };
            let (value, number) = (self.values[*name], number.parse().expect("a number"));
            match *operator {
                "==" => value == number,
                "!=" => value != number,
                "<" => value < number,
                other => panic!("{other}"),
            }
        })
    }

    fn fits(&self, condition: &WayCondition) -> bool {
        match condition {
            WayCondition::Condition(asked) | WayCondition::Case(asked) => {
                self.holds(&asked.text) == asked.holds
            }
            WayCondition::Skip { executed, .. } => *executed != self.is_skipped,
            other => panic!("{other:?}"),
        }
    }

    /// Returns the state to which the ways lead that have these answers.
    fn state(&self, possible: &PossibleStates) -> State {
        let leads = |ways: &Vec<Vec<WayCondition>>| {
            let mut ways = ways.iter();
            ways.any(|way| way.iter().all(|condition| self.fits(condition)))
        };
        let mut states = possible.states.iter();
        assert!(possible.states.iter().all(|state| state.more == 0));
        let named = states.find(|state| state.ways.as_ref().is_some_and(leads));
        let otherwise = || possible.states.iter().find(|state| state.ways.is_none());
        named.or_else(otherwise).expect("a state").state
    }
}

#[test]
fn named_ways_lead_where_they_say_when_they_are_given_and_no_others_do() {
    // R14.2 R14.7: overlapping ways, ways in turn, cases, skip levels, six conditions.
    let overlapping = "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\n$IF V.E.B == 1\nX[COMP OFF FRICT]\n$ENDIF\n\
                       /Y[COMP OFF FRICT]\n$IF V.E.B != 1\nY[COMP OFF FRICT]\n$ENDIF\nM30";
    let in_turn = "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ELSEIF V.E.B < 1\nY[COMP OFF FRICT]\n$ELSE\n\
                   X[COMP OFF FRICT]\n$ENDIF\n/Y[COMP ON FRICT]\nM30";
    let cases = "$SWITCH V.E.P\n$CASE 1\n$CASE 2\nX[COMP OFF FRICT]\n$BREAK\n$CASE 0\nY[COMP OFF FRICT]\n$BREAK\n\
                 $DEFAULT\n/X[COMP OFF FRICT]\n$ENDSWITCH\n$IF V.E.A == 1\nM30\n$ENDIF\nY[COMP ON FRICT]\nM30";
    let mut six = String::new();
    for (place, name) in ["A", "B", "C", "D", "E", "F"].into_iter().enumerate() {
        let command = ["X[COMP OFF FRICT]", "Y[COMP OFF FRICT]", "X[COMP ON FRICT]"][place % 3];
        writeln!(six, "$IF V.E.{name} == 1\n{command}\n$ENDIF").expect("text");
    }
    six.push_str("M30\n");
    let names = ["V.E.A", "V.E.B", "V.E.C", "V.E.D", "V.E.E", "V.E.F"].map(|name| (name, 2));
    for (program, variables) in [
        (overlapping, &names[..2]),
        (in_turn, &names[..2]),
        (cases, &[("V.E.A", 2), ("V.E.P", 5)]),
        (six.as_str(), &names),
    ] {
        let open = run(&Bench::new(), program);
        let possible = open.interpreter().possible();
        assert_eq!(possible.len(), 2, "{program}\n{possible:?}");
        for answers in all_answers(variables) {
            let given = run(&answers.give(Bench::new()), program);
            for possible in possible {
                let found = given.interpreter().compensation();
                let found = found.state(possible.axis, Kind::Frict);
                let (said, words) = (answers.state(possible), possible.in_words("a.nc"));
                let values = &answers.values;
                assert_eq!(
                    said, found,
                    "{program}\n{words}\n{values:?} {}",
                    answers.is_skipped
                );
            }
        }
    }
}
