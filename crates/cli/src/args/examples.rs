//! The examples at the end of every help text (R9.79). A test runs each of them.

use clap::Command;

/// Examples of a command, by its name without that of the tool.
struct Examples {
    command: &'static [&'static str],
    lines: [&'static str; 2],
}

const fn examples(command: &'static [&'static str], lines: [&'static str; 2]) -> Examples {
    Examples { command, lines }
}

static EXAMPLES: [Examples; 40] = [
    examples(
        &["run"],
        [
            "frictcomp run mill.nc",
            "frictcomp run --changes --state shift.json mill.nc next.nc",
        ],
    ),
    examples(
        &["check"],
        [
            "frictcomp check programs",
            "frictcomp check --format sarif -o findings.sarif programs",
        ],
    ),
    examples(
        &["audit"],
        [
            "frictcomp audit programs",
            "frictcomp audit --diff programs",
        ],
    ),
    examples(
        &["golden"],
        [
            "frictcomp golden --update programs",
            "frictcomp golden programs",
        ],
    ),
    examples(
        &["diff"],
        [
            "frictcomp diff mill-old.nc mill.nc",
            "frictcomp diff --kinds all mill-old.nc mill.nc",
        ],
    ),
    examples(&["show"], FILES),
    examples(&["show", "files"], FILES),
    examples(
        &["show", "calls"],
        [
            "frictcomp show calls programs",
            "frictcomp show calls --format dot -o calls.dot programs",
        ],
    ),
    examples(
        &["show", "values"],
        [
            "frictcomp show values programs",
            "frictcomp show values --format ndjson mill.nc",
        ],
    ),
    examples(
        &["show", "passed-over"],
        [
            "frictcomp show passed-over programs",
            "frictcomp show passed-over --format json mill.nc",
        ],
    ),
    examples(
        &["lists"],
        [
            "frictcomp lists hochlauf.lis",
            "frictcomp lists --show --svg curves.svg hochlauf.lis",
        ],
    ),
    examples(
        &["drive"],
        [
            "frictcomp drive hochlauf.lis",
            "frictcomp drive hochlauf.lis --eni network.xml --slave X=Drive1",
        ],
    ),
    examples(
        &["current"],
        [
            "frictcomp current mill.nc --axis X --start X0,Y0,Z0 --svg current.svg -o current.csv",
            "frictcomp current trace.csv --value-list comp_x.lis",
        ],
    ),
    examples(
        &["circle"],
        [
            "frictcomp circle --radius 50 --feed 5000 --svg circle.svg",
            "frictcomp circle ccw.csv cw.csv --radius 50",
        ],
    ),
    examples(
        &["contour"],
        [
            "frictcomp contour mill.nc --start X0,Y0,Z0",
            "frictcomp contour mill.nc --plant mid --svg contour.svg --fail-above 5",
        ],
    ),
    examples(
        &["tune"],
        [
            "frictcomp tune --plant mid --feeds 5000 --no-shaping --write-list comp_x.lis",
            "frictcomp tune --accelerations 70 --no-shaping --svg glitch.svg",
        ],
    ),
    examples(
        &["stiction"],
        [
            "frictcomp stiction --kv 1.5 --tc 3000us --mp1511 8000 --delta-sa 2um",
            "frictcomp stiction --gp 20um --delta-sa-limit 3um",
        ],
    ),
    examples(
        &["trace"],
        [
            "frictcomp trace friction.csv",
            "frictcomp trace friction.csv --format json --svg friction.svg",
        ],
    ),
    examples(
        &["identify"],
        [
            "frictcomp identify friction.csv --axis X --write-list new_x.lis",
            "frictcomp identify friction.csv --points 5 --svg friction.svg",
        ],
    ),
    examples(
        &["verify"],
        [
            "frictcomp verify friction.csv --value-list comp_x.lis",
            "frictcomp verify friction.csv --value-list comp_x.lis --format json",
        ],
    ),
    examples(
        &["replay"],
        [
            "frictcomp replay states.csv mill.nc",
            "frictcomp replay states.csv mill.nc --format json",
        ],
    ),
    examples(&["ask"], ASK),
    examples(&["ask", "write"], ASK),
    examples(
        &["ask", "read"],
        [
            "frictcomp ask read message.txt",
            "frictcomp ask read message.txt --cnc-build 3.1.3132.0",
        ],
    ),
    examples(
        &["ask", "list"],
        ["frictcomp ask list", "frictcomp ask list --format json"],
    ),
    examples(
        &["conformance"],
        [
            "frictcomp conformance conformance",
            "frictcomp conformance --into cases conformance",
        ],
    ),
    examples(&["commission"], COMMISSION),
    examples(&["commission", "plan"], COMMISSION),
    examples(
        &["commission", "run"],
        [
            "frictcomp commission run measuring",
            "frictcomp commission run measuring",
        ],
    ),
    examples(
        &["commission", "learn"],
        [
            "frictcomp commission learn learning --plant mid --friction comp_x.lis",
            "frictcomp commission learn learning --plant mid",
        ],
    ),
    examples(
        &["commission", "trend"],
        [
            "frictcomp commission trend recordings",
            "frictcomp commission trend recordings --axis X --svg trend.svg",
        ],
    ),
    examples(
        &["explain"],
        ["frictcomp explain FC401", "frictcomp explain --format json"],
    ),
    examples(
        &["config"],
        ["frictcomp config show", "frictcomp config show programs"],
    ),
    examples(
        &["config", "schema"],
        ["frictcomp config schema", "frictcomp config schema plant"],
    ),
    examples(
        &["config", "show"],
        [
            "frictcomp config show",
            "frictcomp config show --isolated --enable X,Y",
        ],
    ),
    examples(&["lsp"], ["frictcomp lsp", "frictcomp lsp --stdio"]),
    examples(&["dap"], ["frictcomp dap", "frictcomp dap --stdio"]),
    examples(
        &["init"],
        [
            "frictcomp init programs",
            "frictcomp init --startup hochlauf.lis machine",
        ],
    ),
    examples(
        &["completions"],
        [
            "frictcomp completions bash",
            "frictcomp completions powershell",
        ],
    ),
    examples(&["man"], ["frictcomp man", "frictcomp man --into pages"]),
];

/// Stage 1 for two axes, and for one alone.
const COMMISSION: [&str; 2] = [
    "frictcomp commission plan --axis X,Y --travel X0..300,Y0..200 --feeds 500,1000,2000,5000",
    "frictcomp commission plan --axis X --travel X0..300 --feeds 500,1000,2000,5000 --into x",
];

/// The tests on one axis, and the list of all.
const ASK: [&str; 2] = [
    "frictcomp ask write --axis X --into questions",
    "frictcomp ask list",
];

/// The files of a folder.
const FILES: [&str; 2] = [
    "frictcomp show files programs",
    "frictcomp show files --exclude old --format json programs",
];

/// Examples of the tool itself.
const FIRST: [&str; 2] = ["frictcomp run mill.nc", "frictcomp check programs"];

/// Meaning of the exit status, below the tool's own help.
const STATUS: &str = "Exit status: 0 no message at --fail-on or above, 1 at least one, \
                      2 frictcomp could not do its work.";

/// Returns the command line with its examples.
pub(crate) fn with_examples(tool: Command) -> Command {
    let tool = tool.after_help(format!("{STATUS}\n\n{}", text(FIRST)));
    EXAMPLES.iter().fold(tool, |tool, examples| {
        below(tool, examples.command, &text(examples.lines))
    })
}

fn below(command: Command, names: &[&'static str], help: &str) -> Command {
    match names.split_first() {
        None => command.after_help(help.to_owned()),
        Some((first, rest)) => command.mut_subcommand(*first, |it| below(it, rest, help)),
    }
}

fn text(lines: [&str; 2]) -> String {
    format!("Examples:\n  {}\n  {}", lines[0], lines[1])
}
