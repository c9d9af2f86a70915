//! `frictcomp commission` on machines that share no code with its plants: they execute its programs, and are recorded
//! (R16.10 to R16.16).

#[path = "commission_machines/machines.rs"]
mod machines;
#[path = "commission_machines/site.rs"]
mod site;

use frictcomp_testing::Recorder;
use site::{Site, Stage};

/// R16.10, R16.12, R16.13, R16.14, R16.15, R16.18: the provisional lists of a machine that is not known are accepted where each axis leaves
/// less in each direction at each feed and the torque shows that they were on; other rounds are not, with the reason.
#[test]
fn a_machine_is_commissioned_and_other_rounds_are_not_accepted() {
    let site = Site::planned(machines::bristle(), "1600,2400,3600,5000", "40");
    let recorder = Recorder::default();
    site.record_all(Stage::Off, &recorder);
    let lists = site.provisional();
    site.plan_round(&lists);
    site.record_all(Stage::On(2), &recorder);
    let (_, said) = site.run(&[]);
    assert!(said.contains("accepted: X m/lists/X-provisional"), "{said}");
    for words in [
        "not accepted",
        "not used",
        "recorded at different",
        "longer",
    ] {
        assert!(!said.contains(words), "{words}: {said}");
    }
    let [x, y] = site.loaded(2);
    let tenth = [x.clone().times(0.1), y.clone().times(0.1)];
    let copied = Recorder {
        is_commanded: true,
        noise_um: 0.4,
        ..recorder.clone()
    };
    let apart = Recorder {
        y_late: 3,
        y_factor: 1.003,
        ..recorder.clone()
    };
    for (on, recorder, words) in [
        (
            [Some(&x), None],
            &recorder,
            &["not accepted", "hardly differ on Y", "list of Y was on"][..],
        ),
        (
            [Some(&tenth[0]), Some(&tenth[1])],
            &recorder,
            &["not accepted", "that the list of X was on"],
        ),
        (
            [None, None],
            &recorder,
            &["not accepted", "hardly differ on X"],
        ),
        (
            [Some(&x), Some(&y)],
            &copied,
            &["its actual positions are the commanded ones"],
        ),
        (
            [Some(&x), Some(&y)],
            &apart,
            &[
                "recorded at different times",
                "the way of Y is +0.30 % longer",
            ],
        ),
    ] {
        site.record((2, "circle"), on, (&site.machine, recorder));
        let (status, said) = site.run(&[]);
        assert_eq!(status, Some(1), "{said}");
        for words in words {
            assert!(said.contains(words), "{words}: {said}");
        }
    }
}

/// R16.10 to R16.16: the table of machines in the documents.
#[test]
#[ignore = "minutes"]
#[allow(clippy::print_stdout, reason = "the table is its purpose")]
fn machines_with_their_verdicts() {
    for machine in machines::all() {
        let site = Site::quick(machine);
        site.record_all(Stage::Off, &Recorder::default());
        let lists = site.provisional();
        site.plan_round(&lists);
        site.record_all(Stage::On(2), &Recorder::default());
        let (_, said) = site.run(&["--plant", "mid", "--no-shaping"]);
        println!("{}\n{said}\n", site.machine.name);
    }
}
