//! The sides of a condition that only the machine decides, at a stop.

use serde_json::json;

use super::Client;

const WITH_SIDES: &str = "\
N10 X1
N20 $IF V.E.A == 1
N30 X[COMP OFF FRICT]
N40 $ENDIF
/N50 Y[COMP OFF FRICT]
N60 $SWITCH V.E.PART
N70 $CASE 1
N80 X2
N90 $BREAK
N100 $CASE 2
N110 X3
N120 $BREAK
N130 $ENDSWITCH
N140 $WHILE V.E.A == 1
N150 X4
N160 $ENDWHILE
N170 M30
";

/// Takes a side by its words, and gives the line before which the run is then stopped.
fn take_side(client: &mut Client, words: &str) -> u64 {
    let targets = client.granted("stepInTargets", &json!({ "frameId": 1 }));
    let targets = targets["targets"].as_array().expect("targets").clone();
    let found = targets.iter().find(|it| it["label"] == words);
    let id = &found.unwrap_or_else(|| panic!("{targets:?}"))["id"];
    client.granted("stepIn", &json!({ "threadId": 1, "targetId": id }));
    client.event("stopped");
    client.line()
}

#[test]
fn a_side_of_an_undecided_condition_is_chosen_at_the_stop() {
    // R12.9 R14.1
    let mut client = Client::new(&[("a.nc", WITH_SIDES)]);
    client.launch("a.nc", &["unknown"]);
    let none = client.granted("stepInTargets", &json!({ "frameId": 1 }));
    assert_eq!(none["targets"], json!([]));
    assert_eq!(client.go("continue"), ("exception".to_owned(), 2));
    assert_eq!(take_side(&mut client, "V.E.A == 1 (line 2)"), 3);
    assert_eq!(client.go("next"), ("step".to_owned(), 4));
    assert_eq!(client.scope("Axes")[0], "X = inactive, at 1");
    assert_eq!(client.go("continue"), ("exception".to_owned(), 5));
    // A skipped block is passed over.
    assert_eq!(take_side(&mut client, "skip level 1 is on"), 6);
    assert_eq!(take_side(&mut client, "V.E.PART == 2 (line 6)"), 10);
    assert_eq!(client.go("next"), ("step".to_owned(), 11));
    // A loop is a new question at each pass.
    assert_eq!(client.go("continue"), ("exception".to_owned(), 14));
    assert_eq!(take_side(&mut client, "V.E.A == 1 (line 14)"), 15);
    assert_eq!(client.go("continue"), ("exception".to_owned(), 14));
    assert_eq!(take_side(&mut client, "not V.E.A == 1 (line 14)"), 17);
    assert_eq!(client.scope("Axes")[0], "X = inactive, at 4");
    assert_eq!(client.scope("Axes")[1], "Y = active, position unknown");
    let wrong = client.ask("stepIn", &json!({ "threadId": 1, "targetId": 7 }));
    assert_eq!(wrong["success"], false);
    client.close();
}

#[test]
fn a_side_is_a_variable_where_a_client_knows_no_targets() {
    // R12.9 R14.1
    let mut client = Client::new(&[("a.nc", WITH_SIDES)]);
    client.launch("a.nc", &["unknown"]);
    client.go("continue");
    let open = "open; set 1 to take this side";
    assert_eq!(
        client.scope("Sides"),
        [
            format!("V.E.A == 1 (line 2) = {open}"),
            format!("not V.E.A == 1 (line 2) = {open}"),
        ]
    );
    let set =
        |name: &str, value: &str| json!({ "variablesReference": 5, "name": name, "value": value });
    let refused = client.ask("setVariable", &set("not V.E.A == 1 (line 2)", "2"));
    assert_eq!(refused["message"], "set 1 to take this side");
    client.granted("setVariable", &set("not V.E.A == 1 (line 2)", "1"));
    assert!(client.scope("Sides").is_empty());
    assert_eq!(client.go("continue"), ("exception".to_owned(), 5));
    assert_eq!(client.scope("Axes")[0], "X = active, at 1");
    client.granted("setVariable", &set("skip level 1 is on", "true"));
    assert_eq!(client.event("stopped")["reason"], "step");
    assert_eq!(client.line(), 6);
    client.close();
}
