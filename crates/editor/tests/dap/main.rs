//! The debug adapter over its protocol: scripted sessions, and clients that break the protocol.

mod breakpoints;
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

    /// Sends a request that must succeed, and gives its answer.
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

    /// Returns the next event of a kind; the others before it are dropped.
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

    /// Continues, and gives the reason for the stop and the line of the next block.
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

    /// Returns the variables of a scope, as `name = value`.
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
        "`three` is not a number or a text in quotes"
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
            .is_some_and(|it| it.contains("not a request"))
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
    assert_eq!(refused["message"], "`P1*` is not an expression");
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
