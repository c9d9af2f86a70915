//! Messages as one types (R12.2).

use std::fs;

use serde_json::{Value, json};

use super::client::{Client, codes, uri};
use crate::folder::Bench;

/// Returns the messages of `check` about a program, in the form of the editor: code, severity, range, message.
fn checked(bench: &Bench, name: &str) -> Vec<(String, String, [u64; 4], String)> {
    let path = bench.folder().join(name).display().to_string();
    let path = path.replace('\\', "/");
    let text = bench.stdout(&["check", "--format", "ndjson", &path]);
    let records = text
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).expect("JSON"));
    let records = records.filter(|it| it["record"] == "diagnostic" && it["file"] == path);
    let number = |it: &Value| it.as_u64().expect("a number") - 1;
    let mut said: Vec<_> = records
        .map(|it| {
            let range = ["line", "column", "end_line", "end_column"].map(|key| number(&it[key]));
            let word = |key: &str| it[key].as_str().expect("a word").to_owned();
            (word("code"), word("severity"), range, word("message"))
        })
        .collect();
    said.sort();
    said
}

/// Returns the messages of the server about a program.
fn shown(diagnostics: &Value) -> Vec<(String, String, [u64; 4], String)> {
    let all = diagnostics.as_array().expect("a list").iter();
    let mut said: Vec<_> = all
        .map(|it| {
            let at = |end: &str, key: &str| it["range"][end][key].as_u64().expect("a number");
            let severity = ["error", "warning", "info"]
                [usize::try_from(it["severity"].as_u64().expect("a number")).expect("small") - 1];
            let message = it["message"].as_str().expect("text");
            let message = message.split("\nhelp: ").next().expect("a line");
            (
                it["code"].as_str().expect("a code").to_owned(),
                severity.to_owned(),
                [
                    at("start", "line"),
                    at("start", "character"),
                    at("end", "line"),
                    at("end", "character"),
                ],
                message.to_owned(),
            )
        })
        .collect();
    said.sort();
    said
}

#[test]
fn the_editor_says_what_check_says() {
    // R12.2: every program with a mistake, and every demo.
    let root = crate::workspace::root().join("programs");
    for folder in ["err", "ok"] {
        let bench = Bench::new(&[]);
        let mut client = Client::new();
        let mut files: Vec<_> = fs::read_dir(root.join(folder)).expect("a folder").collect();
        files.sort_by_key(|it| it.as_ref().expect("an entry").path());
        for file in files {
            let path = file.expect("an entry").path();
            if path.is_file() {
                let name = path.file_name().expect("a name").to_str().expect("text");
                fs::copy(&path, bench.folder().join(name)).expect("copied");
            }
        }
        let mut names: Vec<_> = fs::read_dir(bench.folder()).expect("a folder").collect();
        names.sort_by_key(|it| it.as_ref().expect("an entry").path());
        for name in names {
            let name = name
                .expect("an entry")
                .file_name()
                .into_string()
                .expect("text");
            let path = bench.folder().join(&name);
            let Ok(text) = fs::read_to_string(&path) else {
                continue;
            };
            if !["nc", "cnc"].iter().any(|it| name.ends_with(it)) {
                continue;
            }
            // The file no longer contains the text.
            let expected = checked(&bench, &name);
            fs::write(&path, "M30\n").expect("written");
            let uri = uri(&path);
            let said = client.open(&uri, &text);
            fs::write(&path, &text).expect("written");
            let is_shortened = codes(&said).iter().any(|(code, _)| code == "own");
            if text.is_ascii() && !is_shortened {
                assert_eq!(shown(&said), expected, "{name}");
            }
            client.close(&uri);
        }
        client.drop_all();
    }
}

#[test]
fn the_open_text_counts_and_not_the_file() {
    // R12.2
    let bench = Bench::new(&[("a.nc", "M30\n")]);
    let uri = uri(&bench.folder().join("a.nc"));
    let mut client = Client::new();
    let said = client.open(&uri, "N10 X[COMP OFF FRICT]\nN20 M30\n");
    assert_eq!(codes(&said), [("FC401".to_owned(), 0)]);
    assert_eq!(said[0]["severity"], 2);
    assert_eq!(said[0]["source"], "frictcomp");
    let range =
        json!({ "start": { "line": 0, "character": 4 }, "end": { "line": 0, "character": 21 } });
    assert_eq!(said[0]["range"], range);
    // One more block, in the middle of the text.
    let at =
        json!({ "start": { "line": 1, "character": 0 }, "end": { "line": 1, "character": 0 } });
    client.change(
        &uri,
        2,
        &json!([{ "range": at, "text": "N15 X[COMP ON FRICT]\n" }]),
    );
    assert_eq!(client.diagnostics(&uri), json!([]));
    client.replace(
        &uri,
        3,
        "N10 X[COMP OFF FRICT]\nN12 X[COMP OFF FRICT]\nN13 X[COMP ON FRICT]\nN20 M30\n",
    );
    let said = client.diagnostics(&uri);
    assert_eq!(codes(&said), [("FC402".to_owned(), 1)]);
    assert_eq!(said[0]["tags"], json!([1]));
    assert_eq!(
        said[0]["relatedInformation"][0]["message"],
        "the earlier one"
    );
    assert_eq!(said[0]["relatedInformation"][0]["location"]["uri"], uri);
    client.close(&uri);
    assert_eq!(client.diagnostics(&uri), json!([]));
    client.leave();
}

#[test]
fn pages_of_codes_are_texts_of_the_server() {
    // R12.2
    let mut client = Client::with(&json!({
        "capabilities": { "workspace": { "textDocumentContent": {} } },
    }));
    let said = client.open("untitled:a", "X[COMP ON FRIKT]\nM30\n");
    let href = "frictcomp:/codes/FC202.md";
    assert_eq!(said[0]["codeDescription"]["href"], href);
    let page = |client: &mut Client, uri: &str| {
        client.ask("workspace/textDocumentContent", &json!({ "uri": uri }))["text"].take()
    };
    let text = page(&mut client, "frictcomp:/codes/FC401.md");
    assert_eq!(
        text,
        fs::read_to_string(crate::workspace::root().join("docs/codes/FC401.md")).expect("a page")
    );
    assert_eq!(page(&mut client, "frictcomp:/codes/FC000.md"), "");
    client.leave();
    let mut client = Client::with(&json!({
        "capabilities": {},
        "initializationOptions": { "pages": "file:///ext/codes/" },
    }));
    let said = client.open("untitled:a", "X[COMP ON FRIKT]\nM30\n");
    assert_eq!(
        said[0]["codeDescription"]["href"],
        "file:///ext/codes/FC202.md"
    );
    client.leave();
}

#[test]
fn a_client_that_opens_only_files_gets_links_to_files() {
    // R12.21
    let mut client = Client::new();
    let said = client.open("untitled:a", "X[COMP ON FRIKT]\nM30\n");
    let href = said[0]["codeDescription"]["href"].as_str().expect("a link");
    let path = href.strip_prefix("file://").expect("a file");
    let path = path.trim_start_matches(if cfg!(windows) { "/" } else { "" });
    let text = fs::read_to_string(path).expect("a page");
    assert!(text.starts_with("# FC202"), "{text}");
    client.leave();
}

#[test]
fn called_programs_are_taken_as_they_are_open() {
    // R12.2
    let bench = Bench::new(&[("sub.nc", "M17\n")]);
    let (main, sub) = (
        bench.folder().join("main.nc"),
        bench.folder().join("sub.nc"),
    );
    let (main, sub) = (uri(&main), uri(&sub));
    let mut client = Client::new();
    assert_eq!(codes(&client.open(&main, "L sub.nc\nM30\n")), []);
    // The program leaves the axis as the open subprogram does.
    client.open(&sub, "X[COMP OFF FRICT]\nM17\n");
    let text = json!({ "textDocument": { "uri": main } });
    let lenses = client.ask("textDocument/codeLens", &text);
    assert_eq!(lenses[0]["command"]["title"], "leaves X inactive");
    client.settled(&sub);
    client.close(&sub);
    assert_eq!(client.diagnostics(&sub), json!([]));
    // The file of the disk is called again.
    client.settle(&main);
    bench.write("sub.nc", "X[COMP ON FRIKT]\nM17\n");
    client.tell(
        "workspace/didChangeWatchedFiles",
        &json!({ "changes": [{ "uri": sub, "type": 2 }] }),
    );
    let said = client.diagnostics(&sub);
    assert_eq!(codes(&said), [("FC202".to_owned(), 0)]);
    let related = &said[0]["relatedInformation"][0];
    assert_eq!(
        (&related["message"], &related["location"]["uri"]),
        (&json!("called from here"), &json!(main))
    );
    client.close(&main);
    assert_eq!(client.diagnostics(&sub), json!([]));
    client.drop_all();
}

#[test]
fn a_message_in_a_called_program_names_those_that_reach_it() {
    // R17.1: it is one message, however many open programs call it.
    let bench = Bench::new(&[("sub.nc", "X[COMP ON FRIKT]\nM17\n")]);
    let [one, two, called] = ["one.nc", "two.nc", "sub.nc"].map(|it| uri(&bench.folder().join(it)));
    let mut client = Client::new();
    let mut said = Value::Null;
    for program in [&one, &two] {
        client.open(program, "L sub.nc\nM30\n");
        said = client.diagnostics(&called);
        assert_eq!(said.as_array().map(Vec::len), Some(1), "{said}");
    }
    let related = said[0]["relatedInformation"].as_array().expect("places");
    let reached = related.iter();
    let reached = reached.filter(|it| it["message"] == "reached from this program");
    let reached: Vec<&Value> = reached.map(|it| &it["location"]["uri"]).collect();
    assert_eq!(reached, [&Value::from(one), &Value::from(two)], "{said}");
    client.drop_all();
}

#[test]
fn a_program_that_was_never_saved_is_called() {
    // R12.2
    let bench = Bench::new(&[]);
    let (main, sub) = (
        uri(&bench.folder().join("main.nc")),
        uri(&bench.folder().join("new.nc")),
    );
    let mut client = Client::new();
    assert_eq!(
        codes(&client.open(&main, "L new.nc\nM30\n")),
        [("FC320".to_owned(), 0)]
    );
    client.open(&sub, "M17\n");
    assert_eq!(client.diagnostics(&main), json!([]));
    client.close(&sub);
    assert_eq!(codes(&client.diagnostics(&main)), [("FC320".to_owned(), 0)]);
    client.drop_all();
}

const AXIS_LIST: &str = "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 0\nEnde\n";

#[test]
fn lists_and_configurations_are_checked_and_what_they_mean() {
    // R12.2
    let bench = Bench::new(&[("x.lis", AXIS_LIST)]);
    let configuration = "[[axis]]\nname = \"X\"\naxis_list = \"x.lis\"\nvalue = { mode = 3, table = [[0, 12], [1800, 10]] }\n";
    bench.write("frictcomp.toml", configuration);
    let of = |name: &str| uri(&bench.folder().join(name));
    let (program, list, toml) = (of("a.nc"), of("x.lis"), of("frictcomp.toml"));
    let mut client = Client::new();
    let said = client.open(&program, "X[COMP ON FRICT]\nM30\n");
    assert_eq!(codes(&said)[0].0, "P-ERR-70495", "{said}");
    let related = said[0]["relatedInformation"].as_array().expect("a list");
    let sets = related
        .iter()
        .find(|it| it["location"]["uri"] == list)
        .expect("the line of the list");
    assert_eq!(sets["location"]["range"]["start"]["line"], 2);
    // The list is changed in the editor, not on the disk.
    client.open_as(&list, "isg-list", AXIS_LIST);
    client.diagnostics(&list);
    client.settle(&program);
    client.replace(&list, 2, &AXIS_LIST.replace("frict_comp 0", "frict_comp 1"));
    let said = client.diagnostics(&program);
    assert!(
        codes(&said).iter().all(|(code, _)| code != "P-ERR-70495"),
        "{said}"
    );
    client.replace(&list, 3, &AXIS_LIST.replace("Ende\n", ""));
    assert_eq!(
        codes(&client.settled(&list).expect("news")),
        [("FC120".to_owned(), 2)]
    );
    // A configuration that cannot be read is also an error of the program: it is not an all-clear.
    client.open_as(&toml, "toml", configuration);
    client.diagnostics(&toml);
    client.replace(&toml, 2, "[[axis]\n");
    let said = client.settled(&toml).expect("news");
    assert_eq!(codes(&said)[0].0, "FC110", "{said}");
    let said = client.settled(&program).expect("news");
    assert_eq!(codes(&said), [("own".to_owned(), 0)], "{said}");
    assert_eq!(said[0]["severity"], 1);
    assert!(
        said[0]["message"]
            .as_str()
            .is_some_and(|it| it.starts_with("not checked: ")),
        "{said}"
    );
    client.drop_all();
}

#[test]
fn paths_of_all_kinds_are_found() {
    // R12.2
    let bench = Bench::new(&[]);
    let folder = bench.folder().join("N\u{fc}t #1 50%");
    fs::create_dir(&folder).expect("a folder");
    fs::write(folder.join("sub.nc"), b"(\xdc) X[COMP ON FRIKT]\nM17\n").expect("written");
    let escaped = uri(bench.folder()) + "/N%C3%BCt%20%231%2050%25";
    let mut client = Client::new();
    let main = format!("{escaped}/a.nc");
    assert_eq!(client.open(&main, "L sub.nc\nM30\n"), json!([]));
    let said = client.diagnostics(&format!("{escaped}/sub.nc"));
    assert_eq!(said[0]["range"]["start"]["character"], 14, "{said}");
    client.drop_all();
}

#[test]
fn a_text_without_a_file_runs_in_the_folder_of_the_project() {
    // R12.2
    let bench = Bench::new(&[("sub.nc", "X[COMP OFF FRICT]\nM17\n")]);
    let mut client = Client::with(&json!({
        "capabilities": {},
        "workspaceFolders": [{ "uri": uri(bench.folder()), "name": "p" }],
    }));
    assert_eq!(
        client.open("untitled:Untitled-1", "L sub.nc\nM30\n"),
        json!([])
    );
    assert_eq!(
        codes(&client.diagnostics(&uri(&bench.folder().join("sub.nc"))))[0].0,
        "FC401"
    );
    client.leave();
}

#[test]
fn a_program_that_is_too_long_says_how_far_it_was_checked() {
    // R12.7
    let mut client = Client::with(&json!({
        "capabilities": {},
        "initializationOptions": { "maxBlocks": 200 },
    }));
    let said = client.open("untitled:a", &("G1 X1 F100\n".repeat(500) + "M30\n"));
    assert_eq!(codes(&said)[0], ("own".to_owned(), 0));
    assert!(
        said[0]["message"]
            .as_str()
            .is_some_and(|it| it.starts_with("only the first 200 executed blocks"))
    );
    assert!(!said.to_string().contains("FC910"), "{said}");
    let said = client.open(
        "untitled:b",
        "$WHILE 1\nG1 X1 F100\nG1 X2\n$ENDWHILE\nM30\n",
    );
    assert!(said.to_string().contains("FC910"), "{said}");
    assert!(!said.to_string().contains("only the first"), "{said}");
    client.leave();
}
