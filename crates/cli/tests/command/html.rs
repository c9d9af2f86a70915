//! The HTML report: sound, harmless, complete, and usable in a browser.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::folder::Bench;
use crate::workspace::root;
use roxmltree::{Document, Node, ParsingOptions};

/// Returns the report of programs.
fn report_of(bench: &Bench, arguments: &[&str]) -> String {
    let output = bench.call(&[&["run"], arguments, &["--html", "report.html"]].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_ne!(output.status.code(), Some(2), "{said}");
    bench.read("report.html")
}

fn parse(report: &str) -> Document<'_> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(report, options).expect("the report is well-formed")
}

fn text_of(node: Node<'_, '_>) -> String {
    let texts = node.descendants().filter(Node::is_text);
    texts.filter_map(|text| text.text()).collect()
}

/// Links have targets, identifiers are unique, headings descend one by one, images have names.
fn assert_sound(report: &str) {
    let document = parse(report);
    let mut ids = BTreeSet::new();
    for node in document.descendants() {
        if let Some(id) = node.attribute("id") {
            assert!(ids.insert(id), "`{id}` stands there twice");
        }
    }
    let mut level = 0;
    for node in document.descendants().filter(Node::is_element) {
        for reference in ["href", "aria-labelledby", "aria-describedby"] {
            if let Some(target) = node.attribute(reference) {
                let id = target.trim_start_matches('#');
                assert!(ids.contains(id), "`{target}` leads nowhere");
            }
        }
        let name = node.tag_name().name();
        assert_ne!(name, "script");
        for attribute in node.attributes() {
            let name = attribute.name();
            let active = name.starts_with("on") || ["src", "style", "srcset"].contains(&name);
            assert!(!active, "{name}={}", attribute.value());
        }
        match name {
            "h1" | "h2" | "h3" => {
                let found = name.as_bytes()[1] - b'0';
                assert!(found <= level + 1, "{name} below h{level}");
                level = found;
            }
            "table" => {
                let has = |name: &str| node.descendants().any(|it| it.has_tag_name(name));
                assert!(
                    has("caption") && has("thead"),
                    "a table without caption or head"
                );
            }
            "th" => assert!(node.attribute("scope").is_some()),
            "svg" => assert!(node.attribute("aria-labelledby").is_some()),
            _ => {}
        }
    }
    for landmark in ["header", "nav", "main", "footer"] {
        let count = document
            .descendants()
            .filter(|node| node.has_tag_name(landmark))
            .count();
        assert_eq!(count, 1, "{landmark}");
    }
    assert!(report.contains("default-src 'none'"));
    assert!(!report.contains("http://") && !report.contains("https://"));
}

/// Returns the element with an identifier, as text.
fn part(report: &str, id: &str) -> String {
    let document = parse(report);
    let node = document
        .descendants()
        .find(|node| node.attribute("id") == Some(id));
    text_of(node.unwrap_or_else(|| panic!("there is no `{id}`")))
}

const FRICTION: &str = "\
%FRICTION
N15 X[COMP ON FRICT] ;Activates X axis
N25 Y[COMP OFF FRICT] ;Deactivates Y axis
N35 X22 Y33 Z44
N45 X[COMP OFF FRICT] ;Deactivates X axis
N55 M30 ;Program end
";

#[test]
fn a_session_is_told_from_its_end_to_its_assumptions() {
    // R9.50
    let bench = Bench::new(&[("a.nc", FRICTION), ("b.nc", "N10 G01 X1 F100\nN20 M30\n")]);
    let report = report_of(&bench, &["a.nc", "b.nc"]);
    assert_sound(&report);
    let left = part(&report, "left");
    // FC401 has reported it.
    assert!(!left.contains("write X[COMP"), "{left}");
    assert!(!left.contains("nothing to do"), "{left}");
    assert!(left.contains("N45 (a.nc:5)"));
    let states = part(&report, "states");
    assert!(
        states.contains("X inactive from N45, a.nc:5, executed block 4"),
        "{states}"
    );
    assert!(states.contains("Program 2: b.nc"));
    let line = part(&report, "f0l5");
    assert!(
        line.contains("N45 X[COMP OFF FRICT] ;Deactivates X axis"),
        "{line}"
    );
    assert!(line.contains("active \u{2192} inactive"), "{line}");
    assert!(line.contains("warning[FC401] column 5"), "{line}");
    assert!(part(&report, "messages").contains("FC403"));
    let machine = part(&report, "machine");
    for wanted in [
        "P-AXIS-00522",
        "P-COMP-00047",
        "frictcomp.toml:4",
        "accepted, 2 points",
    ] {
        assert!(machine.contains(wanted), "no `{wanted}` in {machine}");
    }
    assert!(part(&report, "curves").contains("Value list of axis Y"));
    assert!(part(&report, "reading").contains("R1.29"));
}

#[test]
fn bars_lead_to_the_lines_that_made_them() {
    // R9.50
    let bench = Bench::new(&[("a.nc", FRICTION)]);
    let report = report_of(&bench, &["a.nc"]);
    let document = parse(&report);
    let bars = document.descendants().filter(|node| {
        node.has_tag_name("a") && node.ancestors().any(|above| above.has_tag_name("svg"))
    });
    let leads: Vec<&str> = bars.filter_map(|bar| bar.attribute("href")).collect();
    assert_eq!(leads, ["#f0", "#f0l5", "#f0", "#f0l3", "#f0"]);
}

/// Returns the markup of a part of the report.
fn section(report: &str, id: &str) -> String {
    let (_, behind) = report
        .split_once(&format!("<section id=\"{id}\""))
        .expect("the part");
    behind
        .split_once("</section>")
        .expect("its end")
        .0
        .to_owned()
}

#[test]
fn what_is_away_from_home_looks_like_it() {
    // R9.50, R9.51
    let bench = Bench::new(&[("a.nc", "X[COMP OFF FRICT]\nG1 X1 F100\nM30\n")]);
    let report = report_of(&bench, &["a.nc"]);
    let left = section(&report, "left");
    assert!(left.contains("class=\"state inactive away\""), "{left}");
    assert!(left.contains("class=\"state active\""), "{left}");
    let states = section(&report, "states");
    assert!(
        states.contains("fc-away") && states.contains("fc-stripes"),
        "{states}"
    );
    // R17.8
    assert!(states.contains("inactive, not start-up"), "{states}");
    assert!(
        states.contains(">start<") && states.contains(">3<"),
        "{states}"
    );
    assert!(
        !states.contains(">4<"),
        "the scale ends at the last block: {states}"
    );
    let back = Bench::new(&[("a.nc", "X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30\n")]);
    let left = section(&report_of(&back, &["a.nc"]), "left");
    assert!(!left.contains(" away\""), "{left}");
}

#[test]
fn an_unknown_state_says_when_it_is_which() {
    // R14.2
    let program = "\
N10 $IF V.E.A < 2
N20 X[COMP OFF FRICT]
N30 $ENDIF
N40 G1 X1 F100
N50 M30
";
    let bench = Bench::new(&[("a.nc", program)]);
    let report = report_of(&bench, &["a.nc"]);
    assert_sound(&report);
    let words = "inactive if V.E.A &lt; 2 (line 1), else active";
    let left = section(&report, "left");
    assert!(left.contains(&format!("</span>: {words}</td>")), "{left}");
    let states = section(&report, "states");
    let title = format!("X unknown from N30, a.nc:3, executed block 3: {words}");
    assert!(states.contains(&title), "{states}");
    let source = section(&report, "source");
    let line = format!("<strong>X</strong> <span class=\"state unknown\">unknown</span>: {words}");
    assert_eq!(source.matches(&line).count(), 1, "{source}");
    let (_, below) = source
        .split_once("id=\"f0l3\"")
        .expect("the line where ways meet");
    assert!(below.contains(&line), "{source}");
}

#[test]
fn a_report_says_nothing_twice() {
    // R9.50
    let bench = Bench::new(&[("a.nc", "X[COMP OFF FRICT]\nM30\n")]);
    let report = report_of(&bench, &["a.nc"]);
    assert!(!report.contains(">once<") && !report.contains(">said<"));
    assert!(report.contains("<caption class=\"unseen\">Messages</caption>"));
    assert!(report.contains("<td class=\"num\">"));
    let made = section(&report, "reading");
    let (made, _) = made.split_once("<details>").unwrap_or((&made, ""));
    assert!(!made.contains("without a configuration"), "{made}");
}

#[test]
fn nothing_in_a_program_becomes_active() {
    // R9.51
    let program = "%<script>alert(1)</script>\n\
        N10 X[COMP OFF FRICT] ; <img src=x onerror=alert(1)> ]]> & \" ' \0 \u{202e}gnp.exe\u{202c}\n\
        (--></main><style>*{display:none}</style><script>document.title='gone'</script>)\n\
        N20 #MSG[\"<b>&amp;</b>\"]\nN30 L \"<i>.nc\"\nN40 M30\n";
    let name = if cfg!(windows) { "a.nc" } else { "<b>&\".nc" };
    let bench = Bench::new(&[(name, program)]);
    let report = report_of(&bench, &[name, "--keep-going"]);
    assert_sound(&report);
    for raw in [
        "<script",
        "<img",
        "</main><style",
        "<b>",
        "<i>",
        "\0",
        "\u{202e}",
    ] {
        assert!(!report.contains(raw), "`{raw}` is raw");
    }
    let source = part(&report, "source");
    assert!(source.contains(
        "<img src=x onerror=alert(1)> ]]> & \" ' \u{2400} \u{27e8}U+202E\u{27e9}gnp.exe"
    ));
    bench.write("b.nc", "N10 X[COMP OFF FRICT] (<i>)\nN20 M30\n");
    bench.write("c.nc", "N20 M30\n");
    bench.call(&["diff", "c.nc", "b.nc", "--html", "d.html"]);
    let compared = bench.read("d.html");
    assert!(
        compared.contains("(&lt;i&gt;)") && !compared.contains("<i>"),
        "{compared}"
    );
    let undescribed = report_of(&bench, &["b.nc", "--isolated"]);
    assert!(undescribed.contains("No machine is described"));
    assert!(!undescribed.to_lowercase().contains("nothing to do"));
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    // R9.16
    let bench = Bench::new(&[("a.nc", FRICTION)]);
    let first = report_of(&bench, &["a.nc"]);
    assert_eq!(first, report_of(&bench, &["a.nc"]));
    assert!(!first.contains(&bench.folder().display().to_string()));
}

#[test]
fn called_programs_and_loops_are_shown_where_they_stand() {
    // R9.50
    let bench = Bench::new(&[
        (
            "main.nc",
            "%MAIN\nN10 $FOR P1 = 1, 100, 1\nN20 L SUB.NC\nN30 $ENDFOR\n\
             N40 $IF V.E.PART == 3\nN50 X[COMP OFF FRICT]\nN60 $ENDIF\nN70 M30\n",
        ),
        (
            "sub.nc",
            "N1 Y[COMP OFF FRICT]\nN2 X1\nN3 Y[COMP ON FRICT]\nN4 M17\n",
        ),
    ]);
    let report = report_of(&bench, &["main.nc", "--kinds", "all"]);
    assert_sound(&report);
    assert!(part(&report, "f1").contains("sub.nc"));
    let line = part(&report, "f1l1");
    assert!(
        line.contains("100\u{d7}") && line.contains("(100 times)"),
        "{line}"
    );
    assert!(part(&report, "states").contains("X unknown from"));
    assert!(report.contains("X may be left off"));
    assert!(part(&report, "reading").contains("R2.51"));
}

#[test]
fn an_error_is_shown_with_what_did_not_run() {
    // R9.50
    let bench = Bench::new(&[(
        "a.nc",
        "N10 X1\nN20 Z[COMP ON FRICT]\nN30 Y[COMP OFF FRICT]\nN40 M30\n",
    )]);
    let report = report_of(&bench, &["a.nc"]);
    assert_sound(&report);
    assert!(report.contains("Stopped by an error"));
    assert!(part(&report, "states").contains("ended by error"));
    assert!(part(&report, "f0l2").contains("error[P-ERR-70495]"));
    assert!(part(&report, "source").contains("     3          N30 Y[COMP OFF FRICT]"));
    let assumed = report_of(&bench, &["a.nc", "--enable", "Z"]);
    let machine = part(&assumed, "machine");
    assert!(machine.contains("assumed by --enable"), "{machine}");
}

#[test]
fn long_programs_are_folded_and_stay_small() {
    // R9.52
    let mut program = String::from("%LONG\n");
    for block in 0..30_000 {
        let _ = match block {
            15_000 => writeln!(program, "N{block} X[COMP OFF FRICT]"),
            _ => writeln!(program, "N{block} G01 X{}.5 F100", block % 97),
        };
    }
    program.push_str("M30\n");
    let bench = Bench::new(&[("long.nc", &program)]);
    let report = report_of(&bench, &["long.nc"]);
    assert_sound(&report);
    let document = parse(&report);
    let elements = document.descendants().filter(Node::is_element).count();
    assert!(elements < 3000, "{elements} elements");
    assert!(report.len() < 3 * program.len() + 100_000);
    let folded: usize = document
        .descendants()
        .filter(|node| node.has_tag_name("summary"))
        .filter_map(|summary| {
            let text = text_of(summary);
            let count = text.strip_suffix(" without a change")?.rsplit(' ').next()?;
            count.parse::<usize>().ok()
        })
        .sum();
    assert!(
        (29_900..30_001).contains(&folded),
        "{folded} lines are folded"
    );
    for line in ["N0 G01 X0.5 F100", "N29999 G01"] {
        assert!(report.contains(line), "`{line}` is missing");
    }
}

#[test]
fn loops_without_end_do_not_grow_the_report() {
    // R9.52
    let program = "N10 $FOR P1 = 1, 20000, 1\nN20 X[COMP OFF FRICT]\nN30 X[COMP ON FRICT]\nN40 $ENDFOR\nN50 M30\n";
    let bench = Bench::new(&[("loop.nc", program)]);
    let report = report_of(&bench, &["loop.nc", "--changes"]);
    assert_sound(&report);
    assert!(report.len() < 200_000, "{} bytes", report.len());
    assert!(part(&report, "f0l2").contains("(20000 times)"));
}

#[test]
fn a_report_is_whole_or_not_there() {
    // R9.53
    let bench = Bench::new(&[("a.nc", FRICTION)]);
    let refused = |path: &str, word: &str| {
        let output = bench.call(&["run", "a.nc", "--html", path]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(word), "{said}");
    };
    refused("no/report.html", "`no/report.html` cannot be written");
    refused(".", "cannot be written");
    refused("a.nc", "would overwrite the program");
    assert_eq!(bench.read("a.nc"), FRICTION);
    if Path::new("/dev/full").exists() {
        refused("/dev/full", "cannot be written");
    }
    let names = fs::read_dir(bench.folder()).expect("a folder").count();
    assert_eq!(names, 2, "nothing half written is left");
}

#[test]
fn a_program_from_a_pipe_has_a_report() {
    // R9.50
    let bench = Bench::new(&[]);
    let mut child = bench
        .command(&["run", "-", "--html", "report.html"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .expect("the tool starts");
    let mut input = child.stdin.take().expect("a pipe");
    input.write_all(FRICTION.as_bytes()).expect("written");
    drop(input);
    assert!(child.wait().expect("it ends").success());
    let report = bench.read("report.html");
    assert_sound(&report);
    assert!(part(&report, "source").contains("N45 X[COMP OFF FRICT]"));
    assert!(part(&report, "source").contains("cannot be read a second time"));
}

#[test]
fn a_circular_test_has_a_report() {
    // R9.50, R5.23
    let bench = Bench::new(&[]);
    let output = bench.call(&[
        "circle",
        "--feed",
        "5000",
        "--radius",
        "50",
        "--html",
        "report.html",
    ]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let report = bench.read("report.html");
    assert_sound(&report);
    assert!(part(&report, "result").contains("deviation magnified"));
    let figures = part(&report, "figures");
    let text = String::from_utf8_lossy(&output.stdout);
    let zone = text
        .lines()
        .find(|line| line.starts_with("G     minimum zone"));
    for value in zone.expect("a figure").split_whitespace().skip(3) {
        assert!(figures.contains(value), "no {value} in {figures}");
    }
    assert!(part(&report, "conditions").contains("reading: standstill=hold"));
}

/// Calls of commands that have a page, with words of it.
fn calls_with_pages(bench: &Bench) -> Vec<(Vec<String>, &'static str)> {
    let demo = root().join("programs/demo");
    let file = |name: &str| demo.join(name).to_string_lossy().into_owned();
    let (recording, trend) = (file("recordings/friction_x.csv"), file("recorded/trend"));
    let channels = ["--velocity", "SetVelo", "--torque", "ActTorque"];
    let identified = ["identify", &recording, "--write-list", "x.lis"];
    bench.stdout(&[&identified[..], &channels].concat());
    let state = format!("warm={recording}");
    let commands: [(&[&str], &[&str], &str); 8] = [
        (&["trace", &recording], &[], "Channels of"),
        (
            &["identify", &recording],
            &channels,
            "Segments on the trace",
        ),
        (
            &["identify", "--states", &state],
            &channels,
            "the list is for",
        ),
        (
            &["verify", &recording, "--value-list", "x.lis"],
            &channels,
            "recorded/predicted",
        ),
        (&["commission", "trend", &trend], &[], "changed by"),
        (
            &["tune", "--plant", "stiff", "--feeds", "1000"],
            &[],
            "position_delay",
        ),
        (
            &["stiction", "--gp", "20um", "--delta-sa-limit", "3um"],
            &[],
            "MP1512",
        ),
        (
            &["circle", "--feed", "2000"],
            &[],
            "What the shapes suggest",
        ),
    ];
    let calls = commands.into_iter().map(|(command, more, wanted)| {
        let arguments = command.iter().chain(more).map(|&it| it.to_owned());
        (arguments.collect(), wanted)
    });
    calls.collect()
}

/// Makes the page of a call; returns it with the output of the call.
fn page_of(bench: &Bench, arguments: &[String]) -> (String, String) {
    let mut all: Vec<&str> = arguments.iter().map(String::as_str).collect();
    all.extend(["--html", "page.html"]);
    let shown = bench.call(&all);
    let said = String::from_utf8_lossy(&shown.stderr);
    assert_ne!(shown.status.code(), Some(2), "{arguments:?}: {said}");
    let page = bench.read("page.html");
    fs::remove_file(bench.folder().join("page.html")).expect("removed");
    let text = String::from_utf8_lossy(&shown.stdout).into_owned();
    (page, text)
}

#[test]
fn each_result_has_a_page() {
    // R9.50, R18.20
    let bench = Bench::new(&[]);
    for (command, wanted) in calls_with_pages(&bench) {
        let (page, text) = page_of(&bench, &command);
        assert_sound(&page);
        assert!(page.contains(wanted), "{command:?}: {wanted}");
        // The page opens with the verdict of the terminal.
        let verdict = text.lines().next().unwrap_or_default();
        let words = verdict.split_whitespace().last().unwrap_or_default();
        let words = words.trim_matches('`');
        let document = parse(&page);
        let lead = document.descendants().find(|node| {
            let class = node.attribute("class").unwrap_or_default();
            class.starts_with("lead ")
        });
        let lead = text_of(lead.expect("a verdict"));
        assert!(lead.contains(words), "{command:?}: {verdict}: {lead}");
    }
}

/// The script that measures a page in a frame: what is wider than the window, literal backticks, texts of pictures that
/// are cut or printed over others.
const MEASURE: &str = "<script>
const wrong = [];
if (document.documentElement.scrollWidth > innerWidth) wrong.push('wider than the window');
for (const part of document.querySelectorAll('.wide'))
  if (part.scrollWidth > part.clientWidth) wrong.push('a table is cut: ' + part.ariaLabel);
if (document.body.innerText.includes('`')) wrong.push('a literal backtick');
for (const picture of document.querySelectorAll('svg')) {
  const room = picture.getBoundingClientRect();
  const texts = [...picture.querySelectorAll('text')].map(text => [text.textContent, text.getBoundingClientRect()]);
  texts.forEach(([words, box], at) => {
    if (box.left < room.left - 1 || box.right > room.right + 1) wrong.push('cut: ' + words);
    for (const [others, other] of texts.slice(at + 1)) {
      const across = Math.min(box.right, other.right) - Math.max(box.left, other.left);
      const along = Math.min(box.bottom, other.bottom) - Math.max(box.top, other.top);
      if (across > 1.5 && along > box.height / 3) wrong.push(words + ' is printed over ' + others);
    }
  });
}
parent.postMessage(wrong, '*');
</script>";

#[test]
fn pages_fit_narrow_and_wide_windows() {
    // R18.25
    let Some(browser) = browser() else {
        return;
    };
    let bench = Bench::new(&[("a.nc", FRICTION), ("b.nc", "N10 G01 X1 F100\nN20 M30\n")]);
    let mut calls: Vec<Vec<String>> = calls_with_pages(&bench)
        .into_iter()
        .map(|it| it.0)
        .collect();
    let programs = root().join("programs/demo");
    let programs = programs.to_str().expect("text");
    for call in [
        "run a.nc b.nc",
        "run --kinds all @/five_axis/milling.nc",
        "audit .",
        "diff a.nc b.nc",
        "contour @/contour/plate.nc --start X0,Y0,Z10",
        "current @/friction.nc --axis X,Y --start X0,Y0,Z0",
        "replay @/replay/states.csv @/replay/pocket.nc",
        "commission learn @/learning --plant mid",
    ] {
        calls.push(
            call.split(' ')
                .map(|it| it.replace('@', programs))
                .collect(),
        );
    }
    let mut frames = String::from(
        "<!doctype html><meta charset=utf-8><body><script>onmessage = event => \
         document.body.setAttribute('data-frame' + Array.from(frames).indexOf(event.source), event.data.join('; '))</script>",
    );
    let mut names = Vec::new();
    for (number, call) in calls.iter().enumerate() {
        let (page, _) = page_of(&bench, call);
        let measured = page
            .replace(
                "default-src 'none'",
                "default-src 'none'; script-src 'unsafe-inline'",
            )
            .replace("</body>", &format!("{MEASURE}</body>"));
        bench.write(&format!("page-{number}.html"), &measured);
        for width in [480, 1400, 2200] {
            let _ = write!(
                frames,
                "<iframe width={width} height=1000 src=page-{number}.html></iframe>"
            );
            names.push(format!("{} at {width} px", call.join(" ")));
        }
    }
    bench.write("frames.html", &frames);
    let (dom, log) = load(&browser, &bench.folder().join("frames.html"));
    let body = body_tag(&dom);
    for (at, name) in names.iter().enumerate() {
        let fits = body.contains(&format!(" data-frame{at}=\"\""));
        assert!(fits, "{name}: {body}: {log}");
    }
}

#[test]
fn the_additive_current_has_a_page() {
    // R9.50, R18.20
    let program = "N10 G90 G01 F600 X0\nN20 X1\nN30 X0\nN40 M30\n";
    let bench = Bench::new(&[("a.nc", program)]);
    let arguments = [
        "current", "a.nc", "--axis", "X", "--start", "X0", "--html", "x.html",
    ];
    let shown = bench.call(&arguments);
    let said = String::from_utf8_lossy(&shown.stderr);
    let verdict = said
        .lines()
        .find(|line| line.contains(" drive units (line "));
    let page = bench.read("x.html");
    assert_sound(&page);
    assert!(page.contains("Additive current of axis X</h1>"), "{page}");
    let verdict = verdict.expect("a verdict").trim_start_matches("over");
    assert!(page.contains(verdict), "{verdict}: {page}");
}

/// Returns the browser of this machine: `FRICTCOMP_BROWSER`, or what Debian and others call Chromium.
fn browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("FRICTCOMP_BROWSER") {
        return Some(named.into());
    }
    let path = std::env::var_os("PATH")?;
    let found = std::env::split_paths(&path)
        .flat_map(|folder| {
            ["chromium", "chromium-browser", "google-chrome"].map(|name| folder.join(name))
        })
        .find(|file| file.is_file());
    if found.is_none() {
        let _ = writeln!(
            std::io::stderr(),
            "skipped: no Chromium in PATH and no FRICTCOMP_BROWSER; no page was opened"
        );
    }
    found
}

/// Loads a page and returns the resulting document, and what the browser logged.
fn load(browser: &Path, page: &Path) -> (String, String) {
    let profile = tempfile::tempdir().expect("a folder");
    let output = tempfile::NamedTempFile::new().expect("a file");
    let log = tempfile::NamedTempFile::new().expect("a file");
    let mut child = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--disable-dev-shm-usage",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--enable-logging=stderr",
            "--virtual-time-budget=5000",
            "--dump-dom",
        ])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("file://{}", page.display()))
        .stdin(Stdio::null())
        .stdout(output.reopen().expect("a file"))
        .stderr(log.reopen().expect("a file"))
        .spawn()
        .expect("the browser starts");
    let start = Instant::now();
    while child.try_wait().expect("a process").is_none() {
        if start.elapsed() > Duration::from_secs(180) {
            let _ = child.kill();
            panic!("the browser does not come to an end");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let read = |file: &tempfile::NamedTempFile| {
        String::from_utf8_lossy(&fs::read(file.path()).expect("text")).into_owned()
    };
    (read(&output), read(&log))
}

/// The script that queries the page in a browser. Reports have no script: this one is inserted into
/// a copy whose policy allows it.
const PROBE: &str = "<script>
const fold = document.querySelector('.source details');
const before = fold.getBoundingClientRect().height;
fold.querySelector('summary').click();
const after = fold.getBoundingClientRect().height;
const links = [...document.querySelectorAll('a[href^=\"#\"]')];
const lost = links.filter(a => !document.getElementById(a.getAttribute('href').slice(1)));
const bar = document.querySelector('svg a[href*=\"l\"]');
bar.focus();
document.body.setAttribute('data-fold', before < 60 && after > 1000 ? 'opens' : before + ' ' + after);
document.body.setAttribute('data-lost', lost.length);
document.body.setAttribute('data-focus', document.activeElement === bar ? 'bar' : 'other');
document.body.setAttribute('data-wide', document.documentElement.scrollWidth > innerWidth ? 'page' : 'parts');
</script>";

/// Returns the attributes of the body.
fn body_tag(dom: &str) -> &str {
    let behind = dom.split_once("<body").map_or("", |(_, rest)| rest);
    behind.split('>').next().unwrap_or_default()
}

#[test]
fn the_report_works_in_a_browser() {
    // R9.51, R9.52
    let Some(browser) = browser() else {
        return;
    };
    let mut program = String::from("%<script>document.body.dataset.gone='1'</script>\n");
    for block in 0..200_000 {
        let _ = match block % 50_000 {
            20_000 => writeln!(
                program,
                "N{block} X[COMP OFF FRICT] (<script>alert(1)</script>)"
            ),
            40_000 => writeln!(program, "N{block} X[COMP ON FRICT]"),
            _ => writeln!(program, "N{block} G01 X{}.5 F100", block % 97),
        };
    }
    program.push_str("M30\n");
    let bench = Bench::new(&[("long.nc", &program)]);
    let report = report_of(&bench, &["long.nc", "--changes"]);
    let (dom, log) = load(&browser, &bench.folder().join("report.html"));
    assert!(
        dom.contains("N199999 G01"),
        "not all of the page is there: {log}"
    );
    assert!(!dom.contains("data-gone"));
    assert!(!log.contains("CONSOLE"), "{log}");
    let probed = report
        .replace(
            "default-src 'none'",
            "default-src 'none'; script-src 'unsafe-inline'",
        )
        .replace("</body>", &format!("{PROBE}</body>"));
    bench.write("probed.html", &probed);
    let (dom, log) = load(&browser, &bench.folder().join("probed.html"));
    let body = body_tag(&dom);
    for wanted in [
        "data-fold=\"opens\"",
        "data-lost=\"0\"",
        "data-focus=\"bar\"",
        "data-wide=\"parts\"",
    ] {
        assert!(body.contains(wanted), "no {wanted} in {body}: {log}");
    }
    // The policy of the report itself lets no script run.
    bench.write(
        "guarded.html",
        &report.replace("</body>", &format!("{PROBE}</body>")),
    );
    let (dom, log) = load(&browser, &bench.folder().join("guarded.html"));
    assert_eq!(body_tag(&dom), "", "a script ran");
    assert!(log.contains("Content Security Policy"), "{log}");
}
