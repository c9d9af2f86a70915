//! Breakpoints: at the first block, with conditions, hits and texts, and while a program runs.

use serde_json::{Value, json};

use super::Client;

/// Starts a program with breakpoints, without a stop before its first block.
fn begun(client: &mut Client, program: &str, filters: &[&str], breakpoints: &Value) -> Value {
    client.granted("initialize", &json!({ "adapterID": "frictcomp" }));
    let path = client.path(program);
    client.granted("launch", &json!({ "program": path, "stopOnEntry": false }));
    client.granted("setExceptionBreakpoints", &json!({ "filters": filters }));
    let told = set(client, program, breakpoints);
    client.granted("configurationDone", &json!({}));
    told
}

fn set(client: &mut Client, program: &str, breakpoints: &Value) -> Value {
    let path = client.path(program);
    let wanted = json!({ "source": { "path": path }, "breakpoints": breakpoints });
    client.granted("setBreakpoints", &wanted)["breakpoints"].take()
}

#[test]
fn a_run_stops_at_its_first_block_too() {
    // R12.15: breakpoints, unknown values, errors and changes of states.
    let none = json!([]);
    let first = json!([{ "line": 1 }]);
    let condition = json!([{ "line": 1, "condition": "V.A.FRICT_COMP_ACTIVE.X == 1" }]);
    for (text, filters, breakpoints, reason, line) in [
        ("N10 X1\nN20 M30\n", &[][..], &first, "breakpoint", 1),
        ("N10 X1\nN20 M30\n", &[], &condition, "breakpoint", 1),
        (
            "N10 P1 = V.E.PART\nN20 M30\n",
            &["unknown"],
            &none,
            "exception",
            1,
        ),
        (
            "N10 Z[COMP ON FRICT]\nN20 M30\n",
            &[],
            &none,
            "exception",
            1,
        ),
        (
            "N10 X[COMP OFF FRICT]\nN20 M30\n",
            &["state"],
            &none,
            "data breakpoint",
            2,
        ),
    ] {
        let mut client = Client::new(&[("a.nc", text)]);
        begun(&mut client, "a.nc", filters, breakpoints);
        assert_eq!(client.event("stopped")["reason"], reason, "{text}");
        assert_eq!(client.line(), line, "{text}");
        client.granted("continue", &json!({ "threadId": 1 }));
        client.event("terminated");
        client.close();
    }
}

#[test]
fn a_stop_before_the_first_block_says_what_is_there() {
    // R12.15
    let mut client = Client::new(&[("a.nc", "N10 Z[COMP ON FRICT]\nN20 M30\n")]);
    client.granted("initialize", &json!({}));
    let path = client.path("a.nc");
    client.granted("launch", &json!({ "program": path }));
    client.granted("configurationDone", &json!({}));
    let stopped = client.event("stopped");
    assert_eq!(stopped["reason"], "entry");
    let text = stopped["text"].as_str().expect("a text");
    assert!(text.contains("P-ERR-70495"), "{text}");
    client.close();
}

const COUNTING: &str = "N1 P1=0\nN10 $WHILE P1 < 30\nN20 P1 = P1 + 1\nN30 $ENDWHILE\nN40 M30\n";

#[test]
fn a_breakpoint_may_have_a_condition_a_number_of_hits_and_a_text() {
    // R12.15
    let mut client = Client::new(&[("a.nc", COUNTING)]);
    let wanted = json!([{ "line": 3, "condition": "P1*2+1 == 25" }]);
    begun(&mut client, "a.nc", &[], &wanted);
    assert_eq!(client.event("stopped")["reason"], "breakpoint");
    assert_eq!(client.scope("Parameters and variables"), ["P1 = 12"]);

    set(
        &mut client,
        "a.nc",
        &json!([{ "line": 3, "hitCondition": "% 5" }]),
    );
    assert_eq!(client.go("continue"), ("breakpoint".to_owned(), 3));
    assert_eq!(client.scope("Parameters and variables"), ["P1 = 17"]);

    client.close();
}

#[test]
fn a_log_point_prints_and_does_not_stop() {
    // R12.15
    let mut client = Client::new(&[("a.nc", COUNTING)]);
    let log =
        json!([{ "line": 3, "condition": "P1 >= 28", "logMessage": "P1 is {P1}, twice {P1 * 2}" }]);
    begun(&mut client, "a.nc", &[], &log);
    assert_eq!(client.event("output")["output"], "P1 is 28, twice 56\n");
    let last = client.event("output");
    assert_eq!(
        (&last["output"], &last["line"]),
        (&json!("P1 is 29, twice 58\n"), &json!(3))
    );
    client.event("terminated");
    client.close();
}

#[test]
fn a_condition_that_means_nothing_is_refused_with_the_reason() {
    // R12.15
    let mut client = Client::new(&[("a.nc", COUNTING)]);
    let wanted = json!([
        { "line": 3, "condition": "P1 = 5" },
        { "line": 3, "condition": "banana" },
        { "line": 3, "hitCondition": "often" },
    ]);
    let told = begun(&mut client, "a.nc", &[], &wanted);
    client.event("terminated");
    for (told, word) in told
        .as_array()
        .expect("a list")
        .iter()
        .zip(["P1 = 5", "banana", "often"])
    {
        assert_eq!(told["verified"], false, "{told}");
        assert!(
            told["message"].as_str().is_some_and(|it| it.contains(word)),
            "{told}"
        );
    }
    let option = |condition: &str| json!({ "filters": [], "filterOptions": [{ "filterId": "state", "condition": condition }] });
    let told = client.granted("setExceptionBreakpoints", &option("X Q"));
    assert_eq!(
        told["breakpoints"][0]["message"],
        "neither the machine nor the program has an axis `Q`"
    );
    let told = client.granted("setExceptionBreakpoints", &option("x, y"));
    assert_eq!(told["breakpoints"], json!([{ "verified": true }]));
    client.close();
}

#[test]
fn a_condition_that_only_the_machine_can_decide_stops() {
    // R12.15
    let mut client = Client::new(&[("a.nc", "N10 X1\nN20 M30\n")]);
    begun(
        &mut client,
        "a.nc",
        &[],
        &json!([{ "line": 2, "condition": "V.E.PART > 2" }]),
    );
    let stopped = client.event("stopped");
    assert_eq!(
        stopped["text"],
        "the condition `V.E.PART > 2` depends on `V.E.PART`, which only the machine knows"
    );
    client.close();
}

#[test]
fn a_breakpoint_that_is_set_while_the_program_runs_stops_it() {
    // R12.15
    let endless =
        "N1 P1=0\nN10 $WHILE P1 < 100000000\nN20 P1 = P1 + 1\nN30 X1\nN40 $ENDWHILE\nN50 M30\n";
    let mut client = Client::new(&[("a.nc", endless)]);
    begun(&mut client, "a.nc", &[], &json!([]));
    let told = set(&mut client, "a.nc", &json!([{ "line": 4 }]));
    assert_eq!(told[0]["verified"], true);
    assert_eq!(client.event("stopped")["reason"], "breakpoint");
    assert_eq!(client.line(), 4);
    set(&mut client, "a.nc", &json!([]));
    client.granted("continue", &json!({ "threadId": 1 }));
    client.granted("terminate", &json!({}));
    client.event("terminated");
    assert!(client.events.iter().all(|it| it["event"] != "stopped"));
    client.granted("disconnect", &json!({}));
    client.close();
}
