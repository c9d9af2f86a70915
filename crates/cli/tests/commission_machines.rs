//! `frictcomp commission` on machines that share no code with its plants: they execute its programs, and are recorded
//! (R16.10 to R16.16).

#[path = "commission_machines/machines.rs"]
mod machines;
#[path = "commission_machines/site.rs"]
mod site;

use frictcomp_testing::Recorder;
use site::{Site, Stage};

/// R16.10, R16.12, R16.15: the provisional lists of a machine that is not known are accepted where each axis leaves
/// less in each direction at each feed, and a round in which one axis had no list is not.
#[test]
fn a_machine_is_commissioned_and_a_list_on_one_axis_only_is_noticed() {
    let site = Site::quick(machines::bristle());
    site.record_all(Stage::Off, &Recorder::default());
    let lists = site.provisional();
    site.plan_round(&lists);
    site.record_all(Stage::On(2), &Recorder::default());
    let (_, said) = site.run(&[]);
    assert!(said.contains("accepted: X m/lists/X-provisional"), "{said}");
    assert!(!said.contains("not accepted"), "{said}");
    assert!(!said.contains("not used"), "{said}");
    site.record_circles(2, [true, false], &Recorder::default());
    let (_, said) = site.run(&[]);
    assert!(said.contains("not accepted"), "{said}");
    assert!(said.contains("hardly differ on Y"), "{said}");
    assert!(!said.contains("hardly differ on X"), "{said}");
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
        let (_, said) = site.run(&["--plant", "mid"]);
        println!("{}\n{said}\n", site.machine.name);
    }
}
