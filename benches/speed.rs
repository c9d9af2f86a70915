//! How fast programs go through, as ratios to a line splitter over the same file in the same run.
//!
//! `cargo bench --bench speed` prints one line a job: the ratio, megabytes (or blocks) a second,
//! the peak memory of the process where `/usr/bin/time` can tell, and the goal. The line splitter
//! reads the file and finds its line ends with `memchr`, in a process of its own as the jobs are.
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

use frictcomp::source::TextLines;
use frictcomp::syntax::ast::Block;
use frictcomp::syntax::{BlockReader, FastPath};
use generate::Shape;

/// The argument that makes this program the line splitter.
const SPLIT: &str = "split-lines";

const TOOL: &str = env!("CARGO_BIN_EXE_frictcomp");

type Outcome<T> = Result<T, Box<dyn Error>>;

/// A command line of the tool and what it may take.
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
    if let [_, word, file] = arguments.as_slice()
        && word == SPLIT
    {
        return split_lines(Path::new(file));
    }
    let bench = Bench {
        folder: tempfile::tempdir()?,
        blocks: setting("FRICTCOMP_BENCH_BLOCKS", 1_000_000)?,
        runs: setting("FRICTCOMP_BENCH_RUNS", 5)?,
    };
    println!(
        "{:<44}{:>9}{:>12}{:>10}   goal",
        "job", "ratio", "speed", "peak"
    );
    for shape in [Shape::ThreeAxes, Shape::FiveAxes] {
        bench.straight(shape)?;
    }
    bench.damaged()?;
    bench.memory()?;
    bench.loops()?;
    bench.start_up()
}

/// The line splitter: reads a file and counts its lines.
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

struct Bench {
    folder: tempfile::TempDir,
    blocks: u32,
    runs: u32,
}

impl Bench {
    fn file(&self, shape: Shape, blocks: u32) -> Outcome<PathBuf> {
        let path = self.folder.path().join("program.nc");
        let mut out = BufWriter::new(File::create(&path)?);
        shape.write(blocks, &mut out)?;
        out.flush()?;
        Ok(path)
    }

    /// The median wall time of a piece of work.
    fn median(&self, mut work: impl FnMut() -> Outcome<()>) -> Outcome<Duration> {
        let mut times = Vec::new();
        for _ in 0..self.runs.max(1) {
            let start = Instant::now();
            work()?;
            times.push(start.elapsed());
        }
        times.sort();
        Ok(times[times.len() / 2])
    }

    fn splitter(&self, file: &Path) -> Outcome<Duration> {
        let program = std::env::current_exe()?;
        self.median(|| spawn(Command::new(&program).arg(SPLIT).arg(file)))
    }

    fn job(&self, job: &Job, file: &Path) -> Outcome<Duration> {
        self.median(|| spawn(&mut command(job, file)))
    }

    fn straight(&self, shape: Shape) -> Outcome<()> {
        let file = self.file(shape, self.blocks)?;
        let text = std::fs::read_to_string(&file)?;
        let base = self.splitter(&file)?;
        let line = |name: &str, time: Duration| Line {
            name: format!("{shape:?}: {name}"),
            ratio: Some(ratio(time, base)),
            speed: format!("{:.0} MB/s", megabytes(text.len()) / time.as_secs_f64()),
            ..Line::default()
        };
        line("line splitter", base).print();
        let fast = self.median(|| {
            parse(&text, FastPath::On);
            Ok(())
        })?;
        line("parse with fast path", fast).print();
        // The grammar takes its time; once is enough.
        let start = Instant::now();
        parse(&text, FastPath::Off);
        Line {
            goal: "35 x".to_owned(),
            ..line("grammar only", start.elapsed())
        }
        .print();
        for job in &JOBS {
            Line {
                peak: peak(job, &file),
                goal: format!("{} x, 20 MiB", job.goal),
                ..line(job.name, self.job(job, &file)?)
            }
            .print();
        }
        Ok(())
    }

    fn damaged(&self) -> Outcome<()> {
        let clean = self.file(Shape::ThreeAxes, self.blocks)?;
        let base = self.job(&CHECK, &clean)?;
        let file = self.file(Shape::Damaged, self.blocks)?;
        Line {
            name: "check, 1 % damaged, to clean".to_owned(),
            ratio: Some(ratio(self.job(&CHECK, &file)?, base)),
            peak: peak(&CHECK, &file),
            goal: "2 x".to_owned(),
            ..Line::default()
        }
        .print();
        Ok(())
    }

    /// The peak memory for a program ten times as long.
    fn memory(&self) -> Outcome<()> {
        let file = self.file(Shape::ThreeAxes, self.blocks.saturating_mul(10))?;
        for job in &JOBS {
            Line {
                name: format!("ten times as long: {}", job.name),
                peak: peak(job, &file),
                goal: "20 MiB".to_owned(),
                ..Line::default()
            }
            .print();
        }
        Ok(())
    }

    fn loops(&self) -> Outcome<()> {
        let straight = self.file(Shape::ThreeAxes, self.blocks)?;
        let base = self.job(&JOBS[1], &straight)?;
        for (blocks, goal) in [
            (400_000, "0.05 s"),
            (self.blocks.saturating_mul(10), "0.3 s a million"),
        ] {
            let file = self.file(Shape::Loop, blocks)?;
            let time = self.job(&JOBS[1], &file)?;
            let straight = base.as_secs_f64() / f64::from(self.blocks);
            let looped = time.as_secs_f64() / f64::from(blocks);
            Line {
                name: format!("{blocks} blocks in a loop, to straight"),
                ratio: Some(looped / straight),
                speed: format!("{:.3} s", time.as_secs_f64()),
                peak: peak(&JOBS[1], &file),
                goal: goal.to_owned(),
            }
            .print();
        }
        Ok(())
    }

    fn start_up(&self) -> Outcome<()> {
        let demo = Path::new(env!("CARGO_MANIFEST_DIR")).join("programs/demo/friction.nc");
        let time = self.median(|| spawn(Command::new(TOOL).arg("run").arg(&demo)))?;
        Line {
            name: "the demo, start-up included".to_owned(),
            speed: format!("{:.1} ms", time.as_secs_f64() * 1e3),
            goal: "5 ms".to_owned(),
            ..Line::default()
        }
        .print();
        Ok(())
    }
}

/// One line of the table.
#[derive(Default)]
struct Line {
    name: String,
    ratio: Option<f64>,
    speed: String,
    peak: Option<String>,
    goal: String,
}

impl Line {
    fn print(&self) {
        let ratio = self.ratio.map(|ratio| format!("{ratio:.2} x"));
        println!(
            "{:<44}{:>9}{:>12}{:>10}   {}",
            self.name,
            ratio.unwrap_or_default(),
            self.speed,
            self.peak.as_deref().unwrap_or_default(),
            self.goal
        );
    }
}

fn parse(text: &str, fast_path: FastPath) {
    let mut reader = BlockReader::new(TextLines::new(text), 1, fast_path);
    let mut block = Block::default();
    while reader.next(&mut block).is_some() {
        black_box(&block);
    }
}

fn command(job: &Job, file: &Path) -> Command {
    let mut command = Command::new(TOOL);
    command
        .args(job.arguments)
        .args(["--isolated", "--enable", "X,Y,Z"])
        .arg(file);
    command
}

/// Runs a command to its end; what it prints is of no interest, nor what it thinks of the program.
fn spawn(command: &mut Command) -> Outcome<()> {
    let status = command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()?;
    match status.code() {
        Some(0 | 1) => Ok(()),
        _ => Err(format!("{command:?} failed: {status}").into()),
    }
}

/// The peak memory of a job, where `/usr/bin/time` can tell.
fn peak(job: &Job, file: &Path) -> Option<String> {
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
    Some(format!("{:.1} MiB", kibibytes / 1024.0))
}

fn ratio(time: Duration, base: Duration) -> f64 {
    time.as_secs_f64() / base.as_secs_f64()
}

fn megabytes(bytes: usize) -> f64 {
    u32::try_from(bytes).map_or(f64::INFINITY, f64::from) / 1e6
}
