//! The debug adapter over its protocol: scripted sessions, and clients that keep to nothing.

#[path = "dap/sides.rs"]
mod sides;

use std::fs;
use std::io::{BufRead, BufReader, PipeReader, PipeWriter, Read, Write, pipe};
use std::path::PathBuf;
use std::thread::{self, JoinHandle};

use serde_json::{Value, json};
use tempfile::TempDir;

const CONFIGURATION: &str = "[[axis]]\nname = \"X\"\nenable = true\n[[axis]]\nname = \"Y\"\nenable = true\n\
                             [[axis]]\nname = \"Z\"\nfrict_comp = false\n";

/// A folder with programs, and a client of an adapter that works on them.
struct Client {
    folder: TempDir,
    to: Option<PipeWriter>,
    from: BufReader<PipeReader>,
    server: Option<JoinHandle<()>>,
    seq: i64,
    /// Events that came before an answer.
    events: Vec<Value>,
}

impl Client {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("frictcomp.toml"), CONFIGURATION).expect("written");
        for (name, text) in files {
            fs::write(folder.path().join(name), text).expect("written");
        }
        let (input, to) = pipe().expect("a pipe");
        let (from, output) = pipe().expect("a pipe");
        let server = thread::spawn(move || {
            let _ = frictcomp_editor::dap::serve(BufReader::new(input), output);
        });
        Self {
            folder,
            to: Some(to),
            from: BufReader::new(from),
            server: Some(server),
            seq: 0,
            events: Vec::new(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&mut self, text: &str) {
        let to = self.to.as_mut().expect("an open pipe");
        to.write_all(text.as_bytes()).expect("written");
    }

    /// Sends a request and gives its answer.
    fn ask(&mut self, command: &str, arguments: &Value) -> Value {
        self.seq += 1;
        let request = json!({
            "seq": self.seq, "type": "request", "command": command, "arguments": arguments,
        });
        let body = request.to_string();
        self.write(&format!("Content-Length: {}\r\n\r\n{body}", body.len()));
        loop {
            let message = self.read().expect("an answer");
            if message["type"] == "response" {
                assert_eq!(message["request_seq"], self.seq, "{message}");
                assert_eq!(message["command"], command);
                return message;
            }
            self.events.push(message);
        }
    }

    /// The same, for a request that is granted.
    fn granted(&mut self, command: &str, arguments: &Value) -> Value {
        let mut answer = self.ask(command, arguments);
        assert_eq!(answer["success"], true, "{answer}");
        answer["body"].take()
    }

    fn read(&mut self) -> Option<Value> {
        let mut length = 0;
        loop {
            let mut line = String::new();
            if self.from.read_line(&mut line).expect("a header") == 0 {
                return None;
            }
            match line.trim().split_once(": ") {
                Some((_, value)) => length = value.parse().expect("a length"),
                None => break,
            }
        }
        let mut body = vec![0; length];
        self.from.read_exact(&mut body).expect("a body");
        Some(serde_json::from_slice(&body).expect("JSON"))
    }

    /// The next event of a kind; the others before it are passed over.
    fn event(&mut self, kind: &str) -> Value {
        loop {
            let message = if self.events.is_empty() {
                self.read().expect("an event")
            } else {
                self.events.remove(0)
            };
            if message["event"] == kind {
                return message["body"].clone();
            }
        }
    }

    /// Launches a program and stops before its first block.
    fn launch(&mut self, program: &str, filters: &[&str]) {
        self.granted("initialize", &json!({ "adapterID": "frictcomp" }));
        let program = self.path(program);
        self.granted(
            "launch",
            &json!({ "program": program, "stopOnEntry": true }),
        );
        self.event("initialized");
        self.granted("setExceptionBreakpoints", &json!({ "filters": filters }));
        self.granted("configurationDone", &json!({}));
        assert_eq!(self.event("stopped")["reason"], "entry");
    }

    /// Goes on, and gives why and before which line the run stopped.
    fn go(&mut self, command: &str) -> (String, u64) {
        self.granted(command, &json!({ "threadId": 1 }));
        let stopped = self.event("stopped");
        (
            stopped["reason"].as_str().expect("a reason").to_owned(),
            self.line(),
        )
    }

    fn frames(&mut self) -> Vec<(String, u64)> {
        let stack = self.granted("stackTrace", &json!({ "threadId": 1 }));
        let frames = stack["stackFrames"].as_array().expect("frames").iter();
        let frame = |frame: &Value| {
            let name = frame["source"]["name"].as_str().expect("a file").to_owned();
            (name, frame["line"].as_u64().expect("a line"))
        };
        frames.map(frame).collect()
    }

    fn line(&mut self) -> u64 {
        self.frames()[0].1
    }

    /// The variables of a scope, as `name = value`.
    fn scope(&mut self, name: &str) -> Vec<String> {
        let scopes = self.granted("scopes", &json!({ "frameId": 1 }));
        let scopes = scopes["scopes"].as_array().expect("scopes").clone();
        let Some(scope) = scopes.iter().find(|scope| scope["name"] == name) else {
            return Vec::new();
        };
        let reference = &scope["variablesReference"];
        let lines = self.granted("variables", &json!({ "variablesReference": reference }));
        let lines = lines["variables"].as_array().expect("variables").iter();
        let text = |value: &Value| value.as_str().expect("a text").to_owned();
        lines
            .map(|line| format!("{} = {}", text(&line["name"]), text(&line["value"])))
            .collect()
    }

    /// Closes the connection; the adapter ends.
    fn close(mut self) {
        self.to = None;
        let server = self.server.take().expect("a server");
        while self.read().is_some() {}
        server.join().expect("no panic");
    }
}

const WITH_CALL: &str = "\
%L SUB
N100 X[COMP OFF FRICT]
N110 X5
N120 M17
%MAIN
N10 X1
N20 LL SUB
N30 Y2
; a comment
N40 X[COMP ON FRICT]
N50 M30
";

#[test]
fn a_program_is_stepped_block_by_block_into_and_over_calls() {
    // R12.9
    let mut client = Client::new(&[("main.nc", WITH_CALL)]);
    client.launch("main.nc", &[]);
    assert_eq!(client.line(), 6);
    assert_eq!(client.go("next"), ("step".to_owned(), 7));
    assert_eq!(client.scope("Axes")[0], "X = active, at 1");

    assert_eq!(client.go("stepIn"), ("step".to_owned(), 2));
    let main = "main.nc".to_owned();
    assert_eq!(client.frames(), [(main.clone(), 2), (main.clone(), 7)]);
    assert_eq!(client.go("stepIn"), ("step".to_owned(), 3));
    assert_eq!(client.scope("Axes")[0], "X = inactive, at 1");
    assert_eq!(client.go("stepOut"), ("step".to_owned(), 8));
    assert_eq!(client.frames(), [(main, 8)]);
    assert_eq!(client.scope("Axes")[0], "X = inactive, at 5");

    client.granted("continue", &json!({ "threadId": 1 }));
    let end = client.event("output");
    assert_eq!(
        end["output"],
        "the program ends by M30 and leaves X active, Y active, Z unconfigured\n"
    );
    client.event("terminated");
    assert_eq!(client.event("exited")["exitCode"], 0);
    client.close();
}

#[test]
fn next_goes_over_a_call() {
    // R12.9
    let mut client = Client::new(&[("main.nc", WITH_CALL)]);
    client.launch("main.nc", &[]);
    assert_eq!(client.go("next"), ("step".to_owned(), 7));
    assert_eq!(client.go("next"), ("step".to_owned(), 8));
    assert_eq!(client.scope("Axes")[0], "X = inactive, at 5");
    client.close();
}

#[test]
fn a_run_stops_at_lines_and_where_a_state_changes() {
    // R12.9
    let mut client = Client::new(&[("main.nc", WITH_CALL)]);
    client.launch("main.nc", &["state"]);
    let source = client.path("main.nc");
    let wanted =
        json!({ "source": { "path": source }, "breakpoints": [{ "line": 9 }, { "line": 99 }] });
    let told = client.granted("setBreakpoints", &wanted);
    assert_eq!(
        told["breakpoints"][0],
        json!({ "verified": true, "line": 10 })
    );
    assert_eq!(told["breakpoints"][1]["verified"], false);

    client.granted("continue", &json!({ "threadId": 1 }));
    let stopped = client.event("stopped");
    assert_eq!(stopped["reason"], "data breakpoint");
    assert_eq!(stopped["text"], "X: active \u{2192} inactive");
    assert_eq!(client.line(), 3, "after the block that changes it");
    assert_eq!(client.go("continue"), ("breakpoint".to_owned(), 10));

    let only_y =
        json!({ "filters": [], "filterOptions": [{ "filterId": "state", "condition": "y" }] });
    client.granted("setExceptionBreakpoints", &only_y);
    client.granted("continue", &json!({ "threadId": 1 }));
    client.event("terminated");
    client.close();
}

#[test]
fn a_breakpoint_far_away_is_met_in_the_right_pass() {
    // R12.9: further than one stride, and in the middle of a loop.
    let program = "N1 P1=0\nN10 $WHILE P1 < 30000\nN20 P1 = P1 + 1\nN30 $IF P1 == 25000\nN40 Y[COMP OFF FRICT]\n\
                   N50 $ENDIF\nN60 $ENDWHILE\nN70 M30\n";
    let mut client = Client::new(&[("loop.nc", program)]);
    client.launch("loop.nc", &[]);
    let source = client.path("loop.nc");
    let wanted = json!({ "source": { "path": source }, "breakpoints": [{ "line": 5 }] });
    client.granted("setBreakpoints", &wanted);
    assert_eq!(client.go("continue"), ("breakpoint".to_owned(), 5));
    assert_eq!(client.scope("Parameters and variables"), ["P1 = 25000"]);
    assert_eq!(client.scope("Axes")[1], "Y = active, position unknown");
    client.go("stepIn");
    assert_eq!(client.scope("Axes")[1], "Y = inactive, position unknown");
    client.close();
}

#[test]
fn a_value_that_only_the_machine_knows_can_be_set_where_it_is_read() {
    // R12.9
    let program = "N10 P1 = V.E.PART\nN20 $IF P1 > 2\nN30 X[COMP OFF FRICT]\nN40 $ENDIF\nN50 M30\n";
    let mut client = Client::new(&[("part.nc", program)]);
    client.launch("part.nc", &["unknown"]);
    assert_eq!(client.line(), 1);
    assert_eq!(
        client.scope("Only the machine knows"),
        ["V.E.PART = unknown; set a value here"]
    );
    let wrong = json!({ "variablesReference": 2, "name": "V.E.PART", "value": "three" });
    let refused = client.ask("setVariable", &wrong);
    assert_eq!(
        refused["message"],
        "`three` is no number and no text in quotes"
    );
    let set = json!({ "variablesReference": 2, "name": "V.E.PART", "value": "3" });
    assert_eq!(client.granted("setVariable", &set)["value"], "3");
    assert_eq!(client.go("next"), ("step".to_owned(), 2));
    assert_eq!(client.scope("Parameters and variables")[0], "P1 = 3");
    assert_eq!(client.go("next"), ("step".to_owned(), 3));
    let computed = json!({ "variablesReference": 3, "name": "P1", "value": "1" });
    assert_eq!(client.ask("setVariable", &computed)["success"], false);
    client.close();
}

#[test]
fn the_control_s_error_stops_before_its_block() {
    // R12.9
    let mut client = Client::new(&[("wrong.nc", "N10 X1\nN20 Z[COMP ON FRICT]\nN30 M30\n")]);
    client.launch("wrong.nc", &[]);
    client.granted("continue", &json!({ "threadId": 1 }));
    let stopped = client.event("stopped");
    assert_eq!(stopped["reason"], "exception");
    let text = stopped["text"].as_str().expect("a text");
    assert!(text.contains("P-ERR-70495"), "{text}");
    assert_eq!(client.line(), 2);
    client.granted("continue", &json!({ "threadId": 1 }));
    let said = client.event("output");
    assert_eq!(
        (&said["category"], &said["line"]),
        (&json!("stderr"), &json!(2))
    );
    assert_eq!(client.event("exited")["exitCode"], 1);
    client.close();
}

#[test]
fn values_are_found_by_their_names() {
    // R12.9
    let mut client = Client::new(&[("a.nc", "N10 P7=1.5\nN20 V.P.NAME=\"A\"\nN30 X3\nN40 M30\n")]);
    client.launch("a.nc", &[]);
    for _ in 0..3 {
        client.go("next");
    }
    let mut value =
        |name: &str| client.granted("evaluate", &json!({ "expression": name }))["result"].take();
    assert_eq!(value("p7"), "1.5");
    assert_eq!(value("V.P.NAME"), "\"A\"");
    assert_eq!(value(" X "), "active, at 3");
    assert_eq!(
        client.ask("evaluate", &json!({ "expression": "P8" }))["success"],
        false
    );
    assert!(
        client
            .scope("G functions")
            .contains(&"coordinates = G90".to_owned())
    );
    client.close();
}

#[test]
fn a_client_that_keeps_to_nothing_gets_answers() {
    // R12.9: no order, no arguments, no program, no JSON.
    let mut client = Client::new(&[("a.nc", "N10 X1\nN20 M30\n")]);
    for command in [
        "continue",
        "next",
        "stackTrace",
        "scopes",
        "variables",
        "configurationDone",
        "fly",
    ] {
        let refused = client.ask(command, &json!({}));
        assert_eq!(refused["success"], false, "{command}: {refused}");
    }
    for arguments in [
        json!(null),
        json!([]),
        json!({ "program": 7 }),
        json!({ "program": "/no/such.nc" }),
    ] {
        let refused = client.ask("launch", &arguments);
        assert_eq!(refused["success"], false, "{refused}");
    }
    let program = client.path("a.nc");
    let wrong = json!({ "program": program, "set": { "V.E.A": [1] } });
    let refused = client.ask("launch", &wrong);
    assert_eq!(
        refused["message"],
        "`V.E.A` must be a number or a text, found `[1]`"
    );
    client.write("Content-Length: 3\r\n\r\n{x}");
    client.write("Content-Length: 2\r\nContent-Type: x\r\n\r\n{}");
    assert!(
        client.event("output")["output"]
            .as_str()
            .is_some_and(|it| it.contains("no request"))
    );
    client.launch("a.nc", &["state", "unknown", "other"]);
    client.granted("pause", &json!({}));
    assert_eq!(
        client.granted("variables", &json!({ "variablesReference": -5 }))["variables"],
        json!([])
    );
    client.write("Content-Length: 99999999999999999999\r\n\r\n");
    client.close();
}

#[test]
fn a_client_that_leaves_in_the_middle_ends_the_adapter() {
    // R12.9
    for text in [
        "",
        "Content-Length: 10\r\n\r\n{",
        "Content-",
        "\r\n\r\n\r\n",
        "Content-Length: -1\r\n\r\n",
    ] {
        let mut client = Client::new(&[]);
        client.write(text);
        client.close();
    }
}

/// Launches a program without a stop before its first block, with breakpoints; the run has begun.
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

#[test]
fn expressions_are_computed_and_a_called_program_shows_its_parameters() {
    // R12.15
    let cycle = "N100 X=@P1\nN110 M17\n";
    let main = "N10 P1=3\nN20 L CYCLE [NAME=part.cyc @P1=7 @P2=P1]\nN30 M30\n";
    let mut client = Client::new(&[("main.nc", main), ("part.cyc", cycle)]);
    client.launch("main.nc", &[]);
    client.go("stepIn");
    client.go("stepIn");
    assert_eq!(client.frames()[0], ("part.cyc".to_owned(), 1));
    let values = client.scope("Parameters and variables");
    assert!(values.contains(&"@P1 = 7".to_owned()), "{values:?}");
    let mut value = |expression: &str| client.ask("evaluate", &json!({ "expression": expression }));
    assert_eq!(value("@P1 + @P2")["body"]["result"], "10");
    assert_eq!(value("P1*2+1")["body"]["result"], "7");
    assert_eq!(
        value("V.E.PART")["body"]["result"],
        "unknown, from V.E.PART"
    );
    let refused = value("P1*");
    assert_eq!(refused["message"], "`P1*` is no expression");
    assert!(
        value("P8 + 1")["message"]
            .as_str()
            .is_some_and(|it| it.contains("P8"))
    );
    client.go("next");
    client.go("next");
    assert_eq!(client.line(), 3);
    assert_eq!(client.scope("Parameters and variables"), ["P1 = 3"]);
    client.close();
}
