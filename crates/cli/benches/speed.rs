//! Throughput of programs, as ratios to a line splitter over the same file in the same run.
//!
//! `cargo bench --bench speed` prints one line a job: the ratio, megabytes (or blocks) a second,
//! the peak memory of the process where `/usr/bin/time` can tell, the goal, and whether it is met.
//! The line splitter reads the file and finds its line ends with `memchr`, in a process of its own as
//! the jobs are. Each pair of job and yardstick runs in turn, and the ratio is the median of the
//! pairs, so that a machine that others use, too, changes it little.
//!
//! `cargo bench --bench speed -- write SHAPE BLOCKS FILE` writes one of the programs: `ThreeAxes`,
//! `FiveAxes`, `Damaged` or `Loop`.
//!
//! `FRICTCOMP_BENCH_BLOCKS` sets the length of the programs, 1 000 000 blocks unless it is given;
//! `FRICTCOMP_BENCH_RUNS` how often each job runs, 5 times; the median counts.

#![allow(clippy::print_stdout)] // The table is what it is for.

mod generate;

use std::error::Error;
use std::fs::File;
use std::hint::black_box;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use frictcomp::syntax::{BlockReader, FastPath, ast::Block};
use frictcomp::text::TextLines;
use frictcomp_testing::measure::{Bench, median};
use generate::Shape;

/// The arguments that make this program one of the yardsticks.
const SPLIT: &str = "split-lines";
const PARSE_FAST: &str = "parse-fast";
const PARSE_GRAMMAR: &str = "parse-grammar";

/// The argument that makes this program write a file.
const WRITE: &str = "write";

const TOOL: &str = env!("CARGO_BIN_EXE_frictcomp");

type Outcome<T> = Result<T, Box<dyn Error>>;

/// A command line of the tool and its permitted time.
struct Job {
    name: &'static str,
    arguments: &'static [&'static str],
    /// The greatest ratio to the line splitter.
    goal: f64,
}

const CHECK: Job = Job {
    name: "check",
    arguments: &["check"],
    goal: 3.0,
};

const JOBS: [Job; 5] = [
    CHECK,
    Job {
        name: "run --changes",
        arguments: &["run", "--changes"],
        goal: 3.0,
    },
    Job {
        name: "run (text, folded)",
        arguments: &["run"],
        goal: 3.5,
    },
    Job {
        name: "run --format ndjson",
        arguments: &["run", "--format", "ndjson"],
        goal: 7.0,
    },
    Job {
        name: "run --format csv",
        arguments: &["run", "--format", "csv"],
        goal: 7.0,
    },
];

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().collect();
    let words: Vec<&str> = arguments.iter().skip(1).map(String::as_str).collect();
    match words.as_slice() {
        [SPLIT, file] => return split_lines(Path::new(file)),
        [PARSE_FAST, file] => return parse(Path::new(file), FastPath::On),
        [PARSE_GRAMMAR, file] => return parse(Path::new(file), FastPath::Off),
        [WRITE, shape, blocks, file, ..] => {
            let shape = Shape::from_name(shape).ok_or("there is no such shape")?;
            return write(shape, blocks.parse()?, Path::new(file));
        }
        _ => {}
    }
    let jobs = Jobs {
        folder: tempfile::tempdir()?,
        blocks: setting("FRICTCOMP_BENCH_BLOCKS", 1_000_000)?,
        bench: Bench::new(5),
    };
    println!(
        "{:<44}{:>9}{:>12}{:>10}   goal",
        "job", "ratio", "speed", "peak"
    );
    for shape in [Shape::ThreeAxes, Shape::FiveAxes] {
        jobs.straight(shape)?;
    }
    jobs.damaged()?;
    jobs.memory()?;
    jobs.loops()?;
    jobs.many_files()?;
    jobs.project()?;
    jobs.start_up()
}

fn write(shape: Shape, blocks: u32, path: &Path) -> Outcome<()> {
    let mut out = BufWriter::new(File::create(path)?);
    shape.write(blocks, &mut out)?;
    Ok(out.flush()?)
}

/// Splits a file into lines as the yardstick: reads it and counts its lines.
fn split_lines(path: &Path) -> Outcome<()> {
    let bytes = std::fs::read(path)?;
    let lines = memchr::memchr_iter(b'\n', &bytes).filter(|at| black_box(*at) < bytes.len());
    println!("{}", lines.count());
    Ok(())
}

fn setting(name: &str, default: u32) -> Outcome<u32> {
    match std::env::var(name) {
        Ok(value) => Ok(value.parse()?),
        Err(_) => Ok(default),
    }
}

struct Jobs {
    folder: tempfile::TempDir,
    blocks: u32,
    bench: Bench,
}

/// The times of a job and of its yardstick, run in turn.
struct Pair {
    ratio: f64,
    job: Duration,
    base: Duration,
}

impl Jobs {
    fn file(&self, shape: Shape, blocks: u32) -> Outcome<PathBuf> {
        let path = self.folder.path().join(format!("{shape:?}-{blocks}.nc"));
        if !path.exists() {
            write(shape, blocks, &path)?;
        }
        Ok(path)
    }

    /// Runs a job and its yardstick in turn; the medians of the times and of the pairs' ratios.
    fn pair(
        &self,
        mut job: impl FnMut() -> Command,
        mut base: impl FnMut() -> Command,
    ) -> Outcome<Pair> {
        let mut times = Vec::new();
        for _ in 0..self.bench.runs {
            times.push((spawn(&mut job())?, spawn(&mut base())?));
        }
        let mut ratios: Vec<f64> = times.iter().map(|(job, base)| ratio(*job, *base)).collect();
        ratios.sort_by(f64::total_cmp);
        Ok(Pair {
            ratio: ratios[ratios.len() / 2],
            job: median(times.iter().map(|(job, _)| *job)),
            base: median(times.iter().map(|(_, base)| *base)),
        })
    }

    fn straight(&self, shape: Shape) -> Outcome<()> {
        let file = self.file(shape, self.blocks)?;
        let size = std::fs::metadata(&file)?.len();
        let line = |name: &str, pair: &Pair, goal: Option<f64>| Line {
            name: format!("{shape:?}: {name}"),
            ratio: Some(pair.ratio),
            speed: format!("{:.0} MB/s", megabytes(size) / pair.job.as_secs_f64()),
            met: goal.map(|goal| pair.ratio <= goal),
            goal: goal.map_or(String::new(), |goal| format!("{goal} x")),
            ..Line::default()
        };
        for (name, word, goal) in [
            ("line splitter", SPLIT, None),
            ("parse with fast path", PARSE_FAST, None),
            ("grammar only", PARSE_GRAMMAR, Some(35.0)),
        ] {
            let pair = self.pair(|| yardstick(word, &file), || yardstick(SPLIT, &file))?;
            line(name, &pair, goal).print();
        }
        for job in &JOBS {
            let pair = self.pair(|| command(job, &file), || yardstick(SPLIT, &file))?;
            line(job.name, &pair, Some(job.goal))
                .with_peak(peak(job, &file))
                .print();
        }
        Ok(())
    }

    fn damaged(&self) -> Outcome<()> {
        let clean = self.file(Shape::ThreeAxes, self.blocks)?;
        let file = self.file(Shape::Damaged, self.blocks)?;
        let pair = self.pair(|| command(&CHECK, &file), || command(&CHECK, &clean))?;
        Line {
            name: "check, 1 % damaged, to clean".to_owned(),
            ratio: Some(pair.ratio),
            goal: "2 x".to_owned(),
            met: Some(pair.ratio <= 2.0),
            ..Line::default()
        }
        .print();
        Ok(())
    }

    /// Measures the peak memory for a program ten times as long.
    fn memory(&self) -> Outcome<()> {
        let file = self.file(Shape::ThreeAxes, self.blocks.saturating_mul(10))?;
        for job in &JOBS {
            Line {
                name: format!("ten times as long: {}", job.name),
                ..Line::default()
            }
            .with_peak(peak(job, &file))
            .print();
        }
        Ok(std::fs::remove_file(file)?)
    }

    fn loops(&self) -> Outcome<()> {
        for (blocks, goal) in [(400_000, 0.05), (10_000_000, 3.0)] {
            let file = self.file(Shape::Loop, blocks)?;
            let job = &JOBS[1];
            let straight = self.file(Shape::ThreeAxes, 400_000)?;
            let pair = self.pair(|| command(job, &file), || command(job, &straight))?;
            let seconds = pair.job.as_secs_f64();
            Line {
                name: format!("{blocks} blocks in a loop, to 400000 straight"),
                ratio: Some(pair.ratio),
                speed: format!("{seconds:.3} s"),
                goal: format!("{goal} s"),
                met: Some(seconds <= goal),
                ..Line::default()
            }
            .with_peak(peak(job, &file))
            .print();
        }
        Ok(())
    }

    /// Compares one processor's time with that of two for two thousand programs of 20 KB.
    fn many_files(&self) -> Outcome<()> {
        let folder = self.folder.path().join("many");
        std::fs::create_dir(&folder)?;
        for number in 0..2000 {
            write(
                Shape::ThreeAxes,
                480,
                &folder.join(format!("{number:04}.nc")),
            )?;
        }
        let check = |jobs: &str| {
            let mut command = command(&CHECK, &folder);
            command.args(["--jobs", jobs]);
            command
        };
        let pair = self.pair(|| check("1"), || check("2"))?;
        Line {
            name: "check of 2000 files, one processor to two".to_owned(),
            ratio: Some(pair.ratio),
            speed: format!("{:.0} ms", pair.base.as_secs_f64() * 1e3),
            goal: "at least 1.8 x".to_owned(),
            met: Some(pair.ratio >= 1.8),
            ..Line::default()
        }
        .print();
        Ok(())
    }

    /// Measures the demo project with 50 MB of other elements in it (R3.42).
    fn project(&self) -> Outcome<()> {
        let demo = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../programs/demo/twincat");
        let text = std::fs::read_to_string(demo.join("Machine.tsproj"))?;
        let other = "<Io><Device><Name>Term_1</Name><Data>0000000000000000</Data></Device></Io>\n";
        let others = other.repeat(50_000_000 / other.len());
        let file = self.folder.path().join("Machine.tsproj");
        std::fs::write(&file, text.replacen("<Cnc>", &format!("{others}<Cnc>"), 1))?;
        let show = || {
            let mut command = Command::new(TOOL);
            command.args(["config", "show", "--isolated", "--project"]);
            command.arg(&file);
            command
        };
        let pair = self.pair(show, show)?;
        let seconds = pair.job.as_secs_f64();
        Line {
            name: "a project of 50 MB".to_owned(),
            speed: format!("{seconds:.3} s"),
            goal: "2 s".to_owned(),
            met: Some(seconds <= 2.0),
            ..Line::default()
        }
        .print();
        Ok(())
    }

    fn start_up(&self) -> Outcome<()> {
        let demo = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../programs/demo/friction.nc");
        let run = || {
            let mut command = Command::new(TOOL);
            command.arg("run").arg(&demo);
            command
        };
        let pair = self.pair(run, run)?;
        let time = pair.job.as_secs_f64() * 1e3;
        Line {
            name: "the demo, start-up included".to_owned(),
            speed: format!("{time:.1} ms"),
            goal: "5 ms".to_owned(),
            met: Some(time <= 5.0),
            ..Line::default()
        }
        .print();
        Ok(())
    }
}

/// Memory that no job may exceed, in MiB.
const MOST_MEMORY: f64 = 20.0;

/// One line of the table.
#[derive(Default)]
struct Line {
    name: String,
    ratio: Option<f64>,
    speed: String,
    peak: Option<f64>,
    goal: String,
    met: Option<bool>,
}

impl Line {
    /// Returns the line with the peak memory in MiB, where it is known.
    fn with_peak(mut self, peak: Option<f64>) -> Self {
        self.peak = peak;
        let separator = if self.goal.is_empty() { "" } else { ", " };
        self.goal = format!("{}{separator}{MOST_MEMORY} MiB", self.goal);
        if let Some(peak) = peak {
            self.met = Some(self.met.unwrap_or(true) && peak <= MOST_MEMORY);
        }
        self
    }

    fn print(&self) {
        let ratio = self.ratio.map(|ratio| format!("{ratio:.2} x"));
        let peak = self.peak.map(|peak| format!("{peak:.1} MiB"));
        let met = match self.met {
            Some(true) => "met",
            Some(false) => "MISSED",
            None => "",
        };
        println!(
            "{:<46}{:>9}{:>12}{:>10}   {:<16}{met}",
            self.name,
            ratio.unwrap_or_default(),
            self.speed,
            peak.unwrap_or_default(),
            self.goal
        );
    }
}

/// Reads a file and parses its blocks.
fn parse(path: &Path, fast_path: FastPath) -> Outcome<()> {
    let text = std::fs::read_to_string(path)?;
    let mut reader = BlockReader::new(TextLines::new(&text), 1, fast_path);
    let mut block = Block::default();
    while reader.next(&mut block).is_some() {
        black_box(&block);
    }
    Ok(())
}

/// Returns a command that starts this program as one of the yardsticks.
fn yardstick(word: &str, file: &Path) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap_or_default());
    command.arg(word).arg(file);
    command
}

fn command(job: &Job, file: &Path) -> Command {
    let mut command = Command::new(TOOL);
    command
        .args(job.arguments)
        .args(["--isolated", "--enable", "X,Y,Z"])
        .arg(file);
    command
}

/// Measures the time of a command; its output is discarded, and its verdict on the program is ignored.
fn spawn(command: &mut Command) -> Outcome<Duration> {
    let start = Instant::now();
    let status = command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()?;
    match status.code() {
        Some(0 | 1) => Ok(start.elapsed()),
        _ => Err(format!("{command:?} failed: {status}").into()),
    }
}

/// Returns the peak memory of a job in MiB, where `/usr/bin/time` can tell.
fn peak(job: &Job, file: &Path) -> Option<f64> {
    let inner = command(job, file);
    let output = Command::new("/usr/bin/time")
        .args(["-f", "%M"])
        .arg(inner.get_program())
        .args(inner.get_args())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .output()
        .ok()?;
    let said = String::from_utf8(output.stderr).ok()?;
    let kibibytes: f64 = said.lines().last()?.trim().parse().ok()?;
    Some(kibibytes / 1024.0)
}

fn ratio(time: Duration, base: Duration) -> f64 {
    time.as_secs_f64() / base.as_secs_f64()
}

fn megabytes(bytes: u64) -> f64 {
    u32::try_from(bytes).map_or(f64::INFINITY, f64::from) / 1e6
}
