//! Random edits over several open texts: whatever was typed before, an editor shows what a fresh server shows
//! (R12.19).

use std::collections::BTreeMap;

use fastrand::Rng;
use serde_json::{Value, json};

use super::client::{Client, codes, uri};
use crate::folder::Bench;

/// Sequences of edits, each from its own seed.
const SEQUENCES: u64 = 40;

/// Texts of each file: the first one is that of the disk, if there is one. Some of them have a mistake.
const FILES: [(&str, OnDisk, &[&str]); 7] = [
    (
        "frictcomp.toml",
        OnDisk::Yes,
        &[
            CONFIGURATION,
            BUILD,
            "[[axis]\n",
            "",
            "[machine]\nbuild = 3\n",
        ],
    ),
    (
        "x.lis",
        OnDisk::Yes,
        &[
            LIST,
            "kopf.achs_nr 1\n",
            "",
            "lr_param.frict_comp 1\nfrict_comp.max_points 1000\nEnde\n",
        ],
    ),
    (
        "y.lis",
        OnDisk::No,
        &[LIST, "kopf.achs_nr 1\nlr_param.frict_comp 1\nEnde\n"],
    ),
    (
        "main.nc",
        OnDisk::Yes,
        &[
            MAIN,
            "L new.nc\nL sub.nc\nM30\n",
            "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30\n",
            "X[COMP ON\n",
        ],
    ),
    (
        "sub.nc",
        OnDisk::Yes,
        &[
            "X[COMP OFF FRICT]\nM17\n",
            "X[COMP ON FRICT]\nL new.nc\nM17\n",
            "X[COMP ON FRIKT]\n",
        ],
    ),
    (
        "new.nc",
        OnDisk::No,
        &["Y[COMP OFF FRICT]\nM17\n", "M17\n", "L sub.nc\n"],
    ),
    (
        "deep/frictcomp.toml",
        OnDisk::No,
        &["[[axis]]\nname = \"X\"\nfrict_comp = false\n", "[machine\n"],
    ),
];

const CONFIGURATION: &str = "[[axis]]\nname = \"X\"\naxis_list = \"x.lis\"\n[[axis]]\nname = \"Y\"\naxis_list = \"y.lis\"\n";

const BUILD: &str =
    "[machine]\nbuild = \"3.1.3110\"\n[[axis]]\nname = \"X\"\naxis_list = \"x.lis\"\n";

const LIST: &str = "\
kopf.achs_nr 1
kopf.log_achs_name X
lr_param.frict_comp 1
frict_comp.max_points 2
frict_comp.mode 3
frict_comp.table[0].in 0
frict_comp.table[0].out 12
frict_comp.table[1].in 1800
frict_comp.table[1].out 10
Ende
";

const MAIN: &str = "X[COMP OFF FRICT]\nG1 X5 F100\nL sub.nc\nX7\nM30\n";

/// A program that is never edited, below the others: it has the nearest configuration above it.
const DEEP: (&str, &str) = ("deep/deep.nc", "X[COMP ON FRICT]\nM30\n");

#[derive(Clone, Copy, PartialEq, Eq)]
enum OnDisk {
    Yes,
    No,
}

/// A server with the texts that its client has open.
struct Editor {
    client: Client,
    open: BTreeMap<String, String>,
    version: i32,
    said: BTreeMap<String, Value>,
}

impl Editor {
    fn new() -> Self {
        Self {
            client: Client::new(),
            open: BTreeMap::new(),
            version: 1,
            said: BTreeMap::new(),
        }
    }

    fn put(&mut self, uri: &str, text: &str) {
        self.version += 1;
        if self.open.insert(uri.to_owned(), text.to_owned()).is_none() {
            self.client.open_as(uri, "", text);
        } else {
            self.client.replace(uri, self.version, text);
        }
    }

    fn close(&mut self, uri: &str) {
        if self.open.remove(uri).is_some() {
            self.client.close(uri);
        }
    }

    /// Returns everything that is shown about the open texts, once they are checked.
    fn shown(&mut self) -> BTreeMap<String, Value> {
        let uris: Vec<String> = self.open.keys().cloned().collect();
        for uri in &uris {
            self.client.settle(uri);
        }
        self.said.extend(self.client.published(|_| true));
        let said = self.said.iter().filter(|(_, said)| **said != json!([]));
        let mut shown: BTreeMap<_, _> = said
            .map(|(uri, said)| (format!("messages {uri}"), said.clone()))
            .collect();
        for uri in uris {
            let text = json!({ "uri": uri });
            let end = json!({ "line": 99, "character": 0 });
            let start = json!({ "line": 0, "character": 0 });
            let lines = self.open[&uri].lines().count();
            let mut ask = |method: &str, more: Value| {
                let mut params = json!({ "textDocument": text });
                params
                    .as_object_mut()
                    .expect("a table")
                    .extend(more.as_object().expect("a table").clone());
                let answer = self.client.ask(method, &params);
                shown.insert(format!("{method} {uri} {more}"), answer);
            };
            ask("textDocument/codeLens", json!({}));
            ask("frictcomp/timeline", json!({}));
            ask(
                "textDocument/inlayHint",
                json!({ "range": { "start": start, "end": end } }),
            );
            for line in 0..lines {
                ask(
                    "textDocument/hover",
                    json!({ "position": { "line": line, "character": 0 } }),
                );
            }
        }
        shown
    }
}

/// Makes a random edit of one of the texts.
fn edit(editor: &mut Editor, random: &mut Rng, uris: &[String]) {
    let at = random.usize(..FILES.len());
    let (uri, texts) = (&uris[at], FILES[at].2);
    match random.u8(..8) {
        0 => editor.close(uri),
        1..4 => {
            let text = editor.open.get(uri).cloned();
            let mut text = text.unwrap_or_else(|| texts[0].to_owned());
            let start = random.usize(..=text.len());
            let end = random.usize(start..=text.len().min(start + 6));
            text.replace_range(start..end, "");
            editor.put(uri, &text);
        }
        _ => editor.put(uri, texts[random.usize(..texts.len())]),
    }
    if random.bool() {
        let open: Vec<String> = editor.open.keys().cloned().collect();
        if let Some(uri) = random.choice(open) {
            editor.client.settle(&uri);
        }
    }
}

#[test]
fn an_editor_heals_after_any_edits() {
    // R12.19
    let bench = Bench::new(&[]);
    std::fs::create_dir(bench.folder().join("deep")).expect("a folder");
    bench.write(DEEP.0, DEEP.1);
    for (name, on_disk, texts) in FILES {
        if on_disk == OnDisk::Yes {
            bench.write(name, texts[0]);
        }
    }
    let of = |name: &str| uri(&bench.folder().join(name));
    let uris: Vec<String> = FILES.iter().map(|(name, ..)| of(name)).collect();
    for seed in 0..SEQUENCES {
        let mut random = Rng::with_seed(seed);
        let mut editor = Editor::new();
        editor.put(&of(DEEP.0), DEEP.1);
        for _ in 0..random.usize(2..12) {
            edit(&mut editor, &mut random, &uris);
        }
        let shown = editor.shown();
        let mut fresh = Editor::new();
        for (uri, text) in &editor.open {
            fresh.put(uri, text);
        }
        assert_eq!(shown, fresh.shown(), "seed {seed}: {:?}", editor.open);
        editor.client.drop_all();
        fresh.client.drop_all();
    }
}

#[test]
fn a_program_is_checked_again_once_its_configuration_is_mended() {
    // R12.19: it is open, and nobody edits it.
    let bench = Bench::new(&[]);
    let of = |name: &str| uri(&bench.folder().join(name));
    let (program, toml) = (of("a.nc"), of("frictcomp.toml"));
    let configuration = bench.read("frictcomp.toml");
    let mut client = Client::new();
    client.open(&program, "X[COMP OFF FRICT]\nM30\n");
    client.open_as(&toml, "toml", &configuration);
    client.diagnostics(&toml);
    client.settle(&program);
    client.replace(&toml, 2, "[[axis]\n");
    assert_eq!(
        codes(&client.diagnostics(&program)),
        [("own".to_owned(), 0)]
    );
    client.replace(&toml, 3, &configuration);
    assert_eq!(
        codes(&client.diagnostics(&program)),
        [("FC401".to_owned(), 0)]
    );
    client.drop_all();
}
