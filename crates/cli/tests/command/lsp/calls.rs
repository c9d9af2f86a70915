//! Call hierarchy of the programs of a project (R17.2).

use serde_json::{Value, json};

use super::client::{Client, uri};
use crate::folder::Bench;

/// Returns a client of the folder of a bench.
fn client(bench: &Bench) -> Client {
    Client::with(&json!({
        "capabilities": {},
        "workspaceFolders": [{ "uri": uri(bench.folder()), "name": "p" }],
    }))
}

fn archive() -> Bench {
    Bench::new(&[
        ("a.nc", "N10 L sub.nc\nN20 L sub.nc\nN30 M30\n"),
        ("b.nc", "N10 L sub.nc\nN20 M30\n"),
        ("sub.nc", "N10 L deep.nc\nM17\n"),
        ("deep.nc", "M17\n"),
    ])
}

fn names(calls: &Value, key: &str) -> Vec<String> {
    let calls = calls.as_array().expect("calls").iter();
    let name = |it: &Value| it[key]["name"].as_str().expect("a name").to_owned();
    let lines = |it: &Value| {
        let lines = it["fromRanges"].as_array().expect("ranges").iter();
        let lines = lines.map(|it| it["start"]["line"].to_string());
        lines.collect::<Vec<_>>().join(",")
    };
    calls
        .map(|it| format!("{}:{}", name(it), lines(it)))
        .collect()
}

#[test]
fn the_tree_of_callers_is_shown() {
    // R17.2
    let bench = archive();
    let mut client = client(&bench);
    let a = uri(&bench.folder().join("a.nc"));
    client.open(&a, &bench.read("a.nc"));
    let place = json!({ "textDocument": { "uri": a }, "position": { "line": 0, "character": 7 } });
    let items = client.ask("textDocument/prepareCallHierarchy", &place);
    assert_eq!(
        (&items[0]["name"], items.as_array().map(Vec::len)),
        (&"sub.nc".into(), Some(1))
    );
    let of = |item: &Value| json!({ "item": item });
    let callers = client.ask("callHierarchy/incomingCalls", &of(&items[0]));
    assert_eq!(names(&callers, "from"), ["a.nc:0,1", "b.nc:0"]);
    let called = client.ask("callHierarchy/outgoingCalls", &of(&items[0]));
    assert_eq!(names(&called, "to"), ["deep.nc:0"]);
    // Outside a call it is the program itself.
    let place = json!({ "textDocument": { "uri": a }, "position": { "line": 2, "character": 0 } });
    let items = client.ask("textDocument/prepareCallHierarchy", &place);
    assert_eq!(items[0]["name"], "a.nc");
    assert_eq!(
        client.ask("callHierarchy/incomingCalls", &of(&items[0])),
        json!([])
    );
    // A save is noticed.
    bench.write("deep.nc", "L a.nc\nM17\n");
    client.tell(
        "textDocument/didSave",
        &json!({ "textDocument": { "uri": a } }),
    );
    let callers = client.ask("callHierarchy/incomingCalls", &of(&items[0]));
    assert_eq!(names(&callers, "from"), ["deep.nc:0"]);
    client.drop_all();
}

#[test]
fn a_lens_says_from_how_many_programs_one_is_reached() {
    // R17.2
    let bench = archive();
    let mut client = client(&bench);
    let mut title = |name: &str| {
        let uri = uri(&bench.folder().join(name));
        client.open_as(&uri, "isg-cnc", &bench.read(name));
        let lenses = client.ask(
            "textDocument/codeLens",
            &json!({ "textDocument": { "uri": uri } }),
        );
        let lenses = lenses.as_array().expect("lenses").clone();
        let open = lenses.into_iter().find(|it| it.get("command").is_none());
        let lens = client.ask("codeLens/resolve", &open.expect("a lens without its words"));
        lens["command"]["title"]
            .as_str()
            .expect("a title")
            .to_owned()
    };
    assert_eq!(title("deep.nc"), "reached from 2 programs: a.nc, b.nc");
    assert_eq!(title("a.nc"), "called by no program of the project");
    client.drop_all();
}

#[test]
fn programs_are_found_by_their_names() {
    // R17.2
    let bench = archive();
    let mut client = client(&bench);
    let mut found = |query: &str| {
        let found = client.ask("workspace/symbol", &json!({ "query": query }));
        let found = found.as_array().expect("symbols").iter();
        let names = found.map(|it| it["name"].as_str().expect("a name").to_owned());
        names.collect::<Vec<_>>()
    };
    assert_eq!(found("DEE"), ["deep.nc"]);
    assert_eq!(found("").len(), 4);
    assert_eq!(found("none"), [""; 0]);
    client.leave();
}

#[test]
fn local_subprograms_are_found_beside_programs() {
    // R17.2
    let local = "%MAIN\nN10 LL DRILL\nN20 M30\n\n  %l DRILL (\u{fc})\nM17\n%L Deep\nM17\n";
    let comment = "#COMMENT BEGIN\n%L DRILL\n#COMMENT END\n%LATHE\nM30 (%L DRILL)\n";
    let bench = Bench::new(&[("a.nc", local), ("b.nc", comment), ("drilled.nc", "M17\n")]);
    let mut client = client(&bench);
    let mut found = |query: &str| {
        let found = client.ask("workspace/symbol", &json!({ "query": query }));
        let found = found.as_array().expect("symbols").clone().into_iter();
        let start = |it: &Value| {
            let start = &it["location"]["range"]["start"];
            (start["line"].as_u64(), start["character"].as_u64())
        };
        let shown = found.map(|it| {
            let file = it["location"]["uri"]
                .as_str()
                .and_then(|it| it.rsplit('/').next());
            (
                it["name"].clone(),
                it["kind"].clone(),
                file.map(str::to_owned),
                start(&it),
            )
        });
        shown.collect::<Vec<_>>()
    };
    let program = |name: &str| {
        let place = (Some(0), Some(0));
        (json!(name), json!(1), Some(name.to_owned()), place)
    };
    let subprogram = |name: &str, line, column| {
        let place = (Some(line), Some(column));
        (json!(name), json!(12), Some("a.nc".to_owned()), place)
    };
    assert_eq!(
        found("drill"),
        [program("drilled.nc"), subprogram("DRILL", 4, 5)]
    );
    assert_eq!(found("deep"), [subprogram("Deep", 6, 3)]);
    assert_eq!(found("lathe"), []);
    assert_eq!(found("").len(), 5);
    client.leave();
}

#[test]
fn nothing_is_searched_without_a_project() {
    // R17.2
    let mut client = Client::raw();
    let answer = client.ask("initialize", &json!({ "capabilities": {} }));
    let offered = &answer["capabilities"];
    assert!(offered.get("callHierarchyProvider").is_none(), "{offered}");
    assert!(
        offered.get("workspaceSymbolProvider").is_none(),
        "{offered}"
    );
    assert_eq!(
        client.ask("workspace/symbol", &json!({ "query": "" })),
        Value::Null
    );
    client.drop_all();
}
