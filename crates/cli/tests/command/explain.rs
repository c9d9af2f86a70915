//! `frictcomp explain` answers for every word that a user meets.

use crate::folder::{call, stderr, stdout};
use crate::workspace::root;

/// Returns the output of `explain` and its exit status.
fn explain(word: &str) -> (String, i32) {
    let output = call(root(), &["explain", word]);
    let text = [stdout(&output), stderr(&output)].concat();
    (text, output.status.code().expect("a status"))
}

#[test]
fn every_word_that_a_user_meets_has_an_answer() {
    // R9.22
    for (word, says) in [
        ("COMP", "switches compensations"),
        ("comp", "switches compensations"),
        ("FRICT", "P-AXIS-00522"),
        ("CROSSTALK", "P-ERR-70631"),
        ("OFF_ALL", "every kind"),
        ("NO_MOVE", "offset"),
        ("V.A.FRICT_COMP_ACTIVE", "FC412"),
        ("V.A.LEAD_COMP_INIT.X", "another kind"),
        ("60B2", "additive torque"),
        ("0x68B2", "additive torque"),
        ("S-0-0081", "additive torque"),
        ("S_0_0084", "actual torque"),
        ("dig_drv.act_torque", "0115"),
        ("MP1511", "factor of stiction"),
        ("MP1391", "manual modes"),
        ("M105", "MP1515"),
        ("R1.27", "M02 and M30"),
        ("c12", "torque at positive velocity"),
        ("C13", "scaling_factor 10"),
        ("lr_param.ssfk", "P-ERR-70310"),
        ("P-AXIS-00070", "gantry"),
        ("p-stup-00015", "axis list"),
        (
            "gruppe[0].achse[1].bezeichnung",
            "the name of an axis in programs",
        ),
        ("P-CHAN-00068", "does not read"),
        ("70310", "LEAD"),
        ("fc139", "implausible"),
        ("412", "flush"),
        ("50546", "FC411"),
        ("ineffective", "no value list"),
    ] {
        let (text, status) = explain(word);
        assert_eq!(status, 0, "{word}: {text}");
        assert!(text.contains(says), "{word}: {text}");
    }
}

#[test]
fn the_page_of_70495_agrees_with_fc314_and_says_who_does_not_find_it() {
    // R1.24, R2.47
    let (text, _) = explain("P-ERR-70495");
    assert!(!text.contains("a program cannot change that"), "{text}");
    for part in ["FC314", "syntax check", "contour simulation", "conclusion"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn an_unknown_word_comes_with_a_near_one() {
    // R9.26
    for (word, near) in [
        ("FRIKT", "FRICT"),
        ("MP151l", "MP151"),
        ("R1.", ""),
        ("qqqqqq", ""),
    ] {
        let (text, status) = explain(word);
        assert_eq!(status, 2, "{word}: {text}");
        assert!(text.contains(near), "{word}: {text}");
    }
}
