//! Any text: nothing panics, and every place is in its text.

use frictcomp::diagnostic::Diagnostic;
use frictcomp::machine::{Configuration, NoLists, check_list};
use frictcomp::text::SourceFile;
use proptest::prelude::*;

fn hold(diagnostics: &[Diagnostic]) {
    for diagnostic in diagnostics {
        let labels = diagnostic.labels.iter().map(|label| &label.place);
        for place in std::iter::once(&diagnostic.place).chain(labels) {
            assert!(place.text.get(place.span.range()).is_some(), "{place:?}");
            assert!(place.start() <= place.end(), "{place:?}");
        }
        assert!(!diagnostic.message.is_empty());
    }
}

fn check(text: &str) {
    let report = check_list(SourceFile::new("a.lis", text), None, &mut NoLists);
    hold(&report.diagnostics);
    if let Err(error) =
        Configuration::from_toml(SourceFile::new("frictcomp.toml", text), &mut NoLists)
    {
        hold(&[*error.diagnostic]);
    }
}

/// Generates lines that are nearly entries.
fn near_list() -> impl Strategy<Value = String> {
    let key = prop::sample::select(vec![
        "frict_comp.mode",
        "frict_comp.table_entries",
        "frict_comp.table[0].in",
        "frict_comp.table[ 1 ].out",
        "frict_comp.table[4294967295].in",
        "frict_comp.max_points",
        "frict_comp.delay_cycles",
        "frict_comp.\u{fc}",
        "kopf.achs_nr",
        "lr_param.frict_comp",
        "lr_param.prog_movement_requires_compensations",
        "achs_mds[0]",
        "zahl_mds",
        "gruppe[0].achse[9].bezeichnung",
        "#",
        "/*",
        ":",
    ]);
    let value = prop_oneof![
        "[-+0-9.eExX ]{0,8}",
        any::<i64>().prop_map(|n| n.to_string()),
        any::<f64>().prop_map(|n| n.to_string()),
        "[A-Z |#(/*\u{fc}\u{1f980}]{0,10}",
    ];
    let line = (key, "[ \t]{0,2}", value).prop_map(|(k, gap, v)| format!("{k}{gap}{v}"));
    let end = prop::sample::select(vec!["\n", "\r\n", "\r"]);
    prop::collection::vec((line, end), 0..20)
        .prop_map(|lines| lines.into_iter().map(|(line, end)| line + end).collect())
}

proptest! {
    #[test]
    fn no_text_breaks_the_reader(text in any::<String>()) {
        // R3.1 to R3.5
        check(&text);
    }

    #[test]
    fn no_list_breaks_the_checks(text in near_list()) {
        // R3.20 to R3.30
        check(&text);
    }
}

#[test]
fn sizes_that_lists_claim_cost_nothing() {
    // R3.23, R3.26
    check(
        "frict_comp.mode 3\nfrict_comp.max_points 4294967295\nfrict_comp.table_entries 65535\n\
         frict_comp.table[4000000000].in 1\nfrict_comp.table[99999999999].in 1\nEnde",
    );
    check("zahl_mds 65535\nachs_mds[4000000000] x.lis\nEnde");
}

#[test]
fn a_place_that_runs_over_line_ends_lies_in_its_text() {
    check("[[axis]]\nname = \"X\"\naxis_list = \"# The\r\r\r\r a list\"\n");
    check("\u{feff}x = \r\r\n");
}

#[test]
fn deep_and_long_texts_end() {
    check(&"[".repeat(100_000));
    check(&format!("a = {}", "[".repeat(100_000)));
    check(&format!("a{}", "[1]".repeat(100_000)));
    check(&"a.b 1\n".repeat(100_000));
    let pairs = "[1, x],".repeat(20_000);
    check(&format!(
        "[[axis]]\nname = \"X\"\n[axis.value]\nmode = 3\ntable = [{pairs}]"
    ));
    let pairs = "[nan, nan],".repeat(20_000);
    check(&format!(
        "[[axis]]\nname = \"X\"\n[axis.value]\nmode = 3\nmax_points = 60000\ntable = [{pairs}]"
    ));
}
