//! Written value lists read back unchanged.

use std::sync::Arc;

use frictcomp::comp::CncBuild;
use frictcomp::lists::{
    Conditions, Entries, FrictionDraft, FrictionList, ListHead, Points, TablePoint, Verdict,
    write_value_list,
};
use frictcomp::text::SourceFile;
use proptest::prelude::*;

/// Returns the list that the control would accept from a text, on a build that reads real points.
fn read(text: &str) -> FrictionList {
    let source = Arc::new(SourceFile::new("x.lis", text));
    let entries = Entries::parse(&source);
    let mut said = entries.diagnostics.clone();
    let draft = FrictionDraft::from_entries(&entries, &mut said);
    let conditions = Conditions {
        build: Some(CncBuild::new([4, 29, 0, 0])),
        ..Conditions::default()
    };
    match draft.check(&conditions).verdict {
        Verdict::Accepted(list) if said.is_empty() => list,
        verdict => panic!("{verdict:?} {said:?}\n{text}"),
    }
}

/// Generates tables of 1 to 40 points with rising velocities, some of them less than one unit
/// apart.
fn tables() -> impl Strategy<Value = Vec<TablePoint>> {
    let steps = prop_oneof![0.001..0.9, 1.0..50_000.0];
    let points = prop::collection::vec((steps, -32_000.0..32_000.0), 1..40);
    points.prop_map(|points| {
        let mut input = 0.0;
        let table = points.into_iter().map(|(step, output)| {
            let point = TablePoint { input, output };
            input += step;
            point
        });
        table.collect()
    })
}

fn lists() -> impl Strategy<Value = FrictionList> {
    let scalars = (0..=10, 0_u16..=4, 0_i16..=248, -32_766_i16..=32_766);
    (tables(), scalars, 0_u32..100).prop_map(|(table, scalars, spare)| {
        let (position_delay, reversal_lookahead, delay_cycles, scaling_factor) = scalars;
        let count = u32::try_from(table.len()).expect("a short table");
        FrictionList {
            position_delay,
            reversal_lookahead,
            scaling_factor,
            delay_cycles,
            max_points: count + spare,
            table,
        }
    })
}

proptest! {
    /// R3.5 R3.20: the control accepts the text of any list, and reads the same values.
    #[test]
    fn a_written_list_reads_back(list in lists(), real in any::<bool>(), remark in ".{0,40}") {
        let points = if real { Points::Real } else { Points::Whole };
        let head = ListHead {
            remarks: &[&remark, "second\nline"],
            number: Some(3),
            name: Some("X2"),
        };
        let text = write_value_list(&list, points, &head);
        let found = read(&text);
        prop_assert_eq!(write_value_list(&found, points, &head), text);
        let without_table = |list: &FrictionList| FrictionList { table: Vec::new(), ..list.clone() };
        prop_assert_eq!(without_table(&found), without_table(&list));
        if points == Points::Real {
            prop_assert_eq!(found.table.len(), list.table.len());
        }
        // Each point is one of the list, as close as its decimals allow.
        let (of_input, of_output) = if real { (0.0, 0.000_51) } else { (0.5, 0.5) };
        for point in &found.table {
            let near = |of: &&TablePoint| {
                (of.input - point.input).abs() <= of_input
                    && (of.output - point.output).abs() <= of_output
            };
            prop_assert!(list.table.iter().any(|of| near(&of)), "{:?}", point);
            prop_assert!(real || point.input.fract() == 0.0 && point.output.fract() == 0.0);
        }
    }
}

#[test]
fn points_are_written_as_the_build_reads_them() {
    // P-COMP-00046, P-COMP-00047
    let build = |numbers| Points::of_build(Some(CncBuild::new(numbers)));
    assert_eq!(Points::of_build(None), Points::Whole);
    assert_eq!(build([3, 1, 3131, 0]), Points::Whole);
    assert_eq!(build([3, 1, 3132, 0]), Points::Real);
    assert_eq!(build([4, 28, 9, 0]), Points::Whole);
    assert_eq!(build([4, 29, 0, 0]), Points::Real);
}

#[test]
fn a_written_zero_has_no_sign_and_near_velocities_are_one_point() {
    let point = |input, output| TablePoint { input, output };
    let list = FrictionList {
        position_delay: 0,
        reversal_lookahead: 0,
        scaling_factor: 1000,
        delay_cycles: 0,
        max_points: 20,
        table: vec![point(0.0, -0.0001), point(0.4, 3.0), point(1.2, -0.3)],
    };
    let outputs = |points: Points| -> Vec<String> {
        let text = write_value_list(&list, points, &ListHead::default());
        let lines = text.lines().filter(|line| line.contains("].out"));
        lines
            .map(|line| line.split_whitespace().nth(1).expect("a value").to_owned())
            .collect()
    };
    assert_eq!(outputs(Points::Whole), ["0", "0"]);
    assert_eq!(outputs(Points::Real), ["0.000", "3.000", "-0.300"]);
}

#[test]
fn the_axis_of_a_written_list_stands_in_its_head() {
    // P-COMP-00001, P-COMP-00002
    let list = FrictionList {
        position_delay: 0,
        reversal_lookahead: 0,
        scaling_factor: 1000,
        delay_cycles: 0,
        max_points: 20,
        table: Vec::new(),
    };
    let head = |number, name| {
        let head = ListHead {
            remarks: &["a remark"],
            number,
            name,
        };
        let text = write_value_list(&list, Points::Whole, &head);
        let lines = text.lines().filter(|line| line.starts_with("kopf."));
        let words = lines.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
        words.collect::<Vec<_>>()
    };
    assert_eq!(
        head(Some(2), Some("Y")),
        ["kopf.achs_nr 2", "kopf.log_achs_name Y"]
    );
    assert_eq!(head(None, Some("Z1")), ["kopf.log_achs_name Z1"]);
    // A name that a list cannot contain, or that would be read as something else, is left out.
    for name in ["", "a b", "X#", "X(", "\n", "\u{201c}"] {
        assert_eq!(head(None, Some(name)), [""; 0], "{name:?}");
    }
}
