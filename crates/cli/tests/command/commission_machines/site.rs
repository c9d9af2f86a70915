//! A folder of a commissioning, and the machine that executes its programs.

use std::path::{Path, PathBuf};

use crate::folder::{answer, succeeded};
use frictcomp_testing::{Machine, Program, Recorder, Run, ValueList, planned_circles};

/// The channels of the recordings.
const CHANNELS: [&str; 8] = [
    "--position",
    "%.SetPos",
    "--velocity",
    "%.SetVelo",
    "--torque",
    "%.ActTorque",
    "--actual-position",
    "%.ActPos",
];

const ACTUAL_TORQUE: [&str; 2] = ["--torque-kind", "actual"];

/// Options for a commanded torque, which shows nothing of what was on; the name of the channel would say that it is the
/// actual one.
const COMMANDED_TORQUE: [&str; 2] = ["--torque-kind", "command"];

/// Options to fit a plant and to keep the friction curve in the lists, which takes seconds.
pub(crate) const FITTED: [&str; 3] = ["--plant", "mid", "--no-shaping"];

/// Options to fit a plant and to tune lists on it.
pub(crate) const TUNED: [&str; 2] = ["--plant", "mid"];

const AXES: [&str; 2] = ["X", "Y"];

/// Start position of the first program, in mm.
pub(crate) const START: [f64; 2] = [50.0, 0.0];

/// Stage of a program: compensation off, or on with the lists of a round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    Off,
    /// The lists of a round, from 2 on.
    On(usize),
}

/// A folder of a commissioning with its machine.
pub(crate) struct Site {
    folder: tempfile::TempDir,
    pub(crate) machine: Machine,
    feeds: &'static str,
    radius: &'static str,
}

impl Site {
    /// Returns five feeds over a decade on a radius of 40 mm.
    pub(crate) fn quick(machine: Machine) -> Self {
        Self::planned(machine, "500,1600,2400,3600,5000", "40")
    }

    /// Returns four fast feeds, which fit no plant.
    pub(crate) fn fast(machine: Machine) -> Self {
        Self::planned(machine, "1600,2400,3600,5000", "40")
    }

    /// Returns a folder in which stage 1 is planned.
    fn planned(machine: Machine, feeds: &'static str, radius: &'static str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let axis = |name: &str| {
            format!(
                "[[axis]]\nname = \"{name}\"\nfrict_comp = true\nvalue_list = \"zero.lis\"\nmax_velocity = \
                 20000\nmax_acceleration = 2\nmax_jerk = 50\n"
            )
        };
        let zero = "frict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].in 0\nfrict_comp.table[0].out \
                    0\n";
        let write = |name: &str, text: &str| {
            std::fs::write(folder.path().join(name), text).expect("written");
        };
        write("frictcomp.toml", &AXES.map(axis).concat());
        write("zero.lis", zero);
        let site = Self {
            folder,
            machine,
            feeds,
            radius,
        };
        site.plan(&[]);
        std::fs::create_dir(site.folder.path().join("m/recordings")).expect("a folder");
        site
    }

    /// Returns the same machine with a copy of the folder.
    pub(crate) fn copied(&self) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        copy_folder(self.path(), folder.path());
        Self {
            folder,
            machine: self.machine.clone(),
            ..*self
        }
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    fn plan(&self, more: &[&str]) {
        succeeded(
            self.path(),
            &[&planned_circles(self.feeds, self.radius)[..], &["m"], more].concat(),
        );
    }

    /// Plans the next round with lists.
    pub(crate) fn plan_round(&self, lists: &[PathBuf; 2]) {
        let [x, y] = [0, 1].map(|at| format!("{}={}", AXES[at], lists[at].display()));
        self.plan(&["--value-list", &x, "--value-list", &y]);
    }

    /// Runs the command on what is recorded.
    pub(crate) fn run(&self, more: &[&str]) -> (Option<i32>, String) {
        self.run_with(&[&CHANNELS[..], &ACTUAL_TORQUE[..], more].concat())
    }

    /// Runs it with a torque that shows nothing, so that the positions decide.
    pub(crate) fn run_by_positions(&self) -> (Option<i32>, String) {
        self.run_with(&[&CHANNELS[..], &COMMANDED_TORQUE[..], &FITTED[..]].concat())
    }

    /// Runs it with such a torque and without a plant, so that nothing decides.
    pub(crate) fn run_without_torque(&self) -> (Option<i32>, String) {
        self.run_with(&[&CHANNELS[..], &COMMANDED_TORQUE[..]].concat())
    }

    /// Runs it on the actual positions of the circles alone.
    pub(crate) fn run_without_commands(&self) -> (Option<i32>, String) {
        let (_, without) = CHANNELS.split_at(2);
        self.run_with(without)
    }

    fn run_with(&self, arguments: &[&str]) -> (Option<i32>, String) {
        answer(
            self.path(),
            &[&["commission", "run", "m"], arguments].concat(),
        )
    }

    /// Returns the lists of X and Y of a kind.
    pub(crate) fn lists(&self, kind: &str) -> [PathBuf; 2] {
        AXES.map(|axis| {
            let lists = self.lists_of(axis, kind);
            assert_eq!(lists.len(), 1, "{lists:?}");
            lists[0].clone()
        })
    }

    fn lists_of(&self, axis: &str, kind: &str) -> Vec<PathBuf> {
        let names = self.names("m/lists", &format!("{axis}-{kind}-"));
        let lists = names.iter().map(|it| Path::new("m/lists").join(it));
        lists.collect()
    }

    /// Returns the tuned lists, with the provisional one of an axis that was not tuned; `None` if neither was.
    pub(crate) fn tuned(&self) -> Option<[PathBuf; 2]> {
        let tuned = AXES.map(|axis| self.lists_of(axis, "tuned").pop());
        let is_any = tuned.iter().any(Option::is_some);
        is_any.then(|| {
            let [x, y] = self.lists("provisional");
            let [of_x, of_y] = tuned;
            [of_x.unwrap_or(x), of_y.unwrap_or(y)]
        })
    }

    /// Returns the provisional lists that the recordings of stage 1 give.
    pub(crate) fn provisional(&self) -> [PathBuf; 2] {
        let (_, said) = self.run(&[]);
        assert!(said.contains("provisional list"), "{said}");
        self.lists("provisional")
    }

    fn names(&self, folder: &str, begin: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.path().join(folder)).expect("a folder");
        let names = entries.map(|it| it.expect("an entry").file_name());
        let names = names.map(|it| it.to_string_lossy().into_owned());
        let mut names: Vec<String> = names.filter(|it| it.starts_with(begin)).collect();
        names.sort();
        names
    }

    /// Returns the programs of a round, 1 for stage 1, whose names hold some words.
    pub(crate) fn programs(&self, round: usize, words: &str) -> Vec<String> {
        let path = self.path().join(format!("m/plan-{round}.json"));
        let text = std::fs::read_to_string(path).expect("a plan");
        let plan: serde_json::Value = serde_json::from_str(&text).expect("a plan");
        let programs = plan["plan"]["programs"].as_array().expect("programs");
        let files = programs.iter().filter_map(|it| it["file"].as_str());
        let files = files.filter(|it| it.contains(words));
        files.map(str::to_owned).collect()
    }

    /// Returns the lists with which a round is planned.
    pub(crate) fn loaded(&self, round: usize) -> [ValueList; 2] {
        let path = self.path().join(format!("m/plan-{round}.json"));
        let text = std::fs::read_to_string(path).expect("a plan");
        let plan: serde_json::Value = serde_json::from_str(&text).expect("a plan");
        [0, 1].map(|at: usize| {
            let file = plan["lists"][at]["file"].as_str().expect("a list");
            self.list(Path::new(file))
        })
    }

    /// Returns the text of a program.
    pub(crate) fn text(&self, program: &str) -> String {
        let path = self.path().join("m").join(program);
        std::fs::read_to_string(path).expect("a program")
    }

    /// Returns the circles of a round, to be driven on the machine itself.
    pub(crate) fn circles(&self, round: usize) -> Vec<Program> {
        let programs = self.programs(round, "circle");
        let parsed = programs
            .iter()
            .map(|it| Program::parse(&self.text(it), AXES, START));
        parsed.collect()
    }

    /// Returns a list of the folder.
    pub(crate) fn list(&self, path: &Path) -> ValueList {
        ValueList::parse(&std::fs::read_to_string(self.path().join(path)).expect("a list"))
    }

    /// Drives a machine through the text of a program.
    pub(crate) fn drive(machine: &Machine, text: &str, lists: [Option<&ValueList>; 2]) -> Run {
        machine.run(&Program::parse(text, AXES, START), START, lists)
    }

    /// Puts a recording of a run into the folder, named as its program.
    pub(crate) fn put(
        &self,
        program: &str,
        run: &Run,
        (recorder, change): (&Recorder, Option<fn(&mut Columns)>),
    ) {
        let mut text = recorder.table(run, AXES);
        if let Some(change) = change {
            let mut columns = Columns::parse(&text);
            change(&mut columns);
            text = columns.text();
        }
        std::fs::write(self.recording(program), text).expect("written");
    }

    fn recording(&self, program: &str) -> PathBuf {
        let name = program.replace(".nc", ".csv");
        self.path().join("m/recordings").join(name)
    }

    /// Returns the recordings, to be put back later.
    pub(crate) fn keep(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let entries = std::fs::read_dir(self.path().join("m/recordings")).expect("a folder");
        let paths = entries.map(|it| it.expect("an entry").path());
        paths
            .map(|it| (it.clone(), std::fs::read(&it).expect("a file")))
            .collect()
    }

    /// Puts recordings back.
    pub(crate) fn put_back(kept: &[(PathBuf, Vec<u8>)]) {
        for (path, bytes) in kept {
            std::fs::write(path, bytes).expect("written");
        }
    }

    /// Records every program of a stage.
    pub(crate) fn record_all(&self, stage: Stage, recorder: &Recorder) {
        let (round, lists) = match stage {
            Stage::Off => (1, [None, None]),
            Stage::On(round) => (round, self.loaded(round).map(Some)),
        };
        let how = (&self.machine, recorder);
        self.record((round, ""), lists.each_ref().map(Option::as_ref), how);
    }

    /// Records the programs of a round whose names hold some words, with these lists on a machine.
    pub(crate) fn record(
        &self,
        (round, words): (usize, &str),
        lists: [Option<&ValueList>; 2],
        (machine, recorder): (&Machine, &Recorder),
    ) {
        for (seed, program) in (100..).zip(self.programs(round, words)) {
            let run = Self::drive(machine, &self.text(&program), lists);
            let recorder = Recorder {
                seed: recorder.seed + seed,
                ..recorder.clone()
            };
            self.put(&program, &run, (&recorder, None));
        }
    }
}

/// The rows of a recording: the time, and of each axis the commanded position and velocity, the actual position and
/// the torque.
pub(crate) struct Columns {
    head: String,
    rows: Vec<Vec<f64>>,
}

impl Columns {
    fn parse(text: &str) -> Self {
        let mut lines = text.lines();
        let head = lines.next().expect("a head").to_owned();
        let number = |cell: &str| cell.parse().expect("a number");
        let rows = lines.map(|line| line.split(',').map(number).collect());
        Self {
            head,
            rows: rows.collect(),
        }
    }

    fn text(&self) -> String {
        let mut text = format!("{}\n", self.head);
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(|it| format!("{it:.7}")).collect();
            text.push_str(&cells.join(","));
            text.push('\n');
        }
        text
    }

    pub(crate) fn swap(&mut self, one: usize, other: usize) {
        self.rows.iter_mut().for_each(|it| it.swap(one, other));
    }

    pub(crate) fn times(&mut self, column: usize, factor: f64) {
        self.rows.iter_mut().for_each(|it| it[column] *= factor);
    }

    pub(crate) fn plus(&mut self, column: usize, more: f64) {
        self.rows.iter_mut().for_each(|it| it[column] += more);
    }

    /// Holds a value for a number of rows.
    pub(crate) fn hold(&mut self, column: usize, rows: usize) {
        for held in self.rows.chunks_mut(rows) {
            let value = held[0][column];
            for row in held {
                row[column] = value;
            }
        }
    }

    /// Records a value a number of rows later.
    pub(crate) fn delay(&mut self, column: usize, rows: usize) {
        for at in (rows..self.rows.len()).rev() {
            self.rows[at][column] = self.rows[at - rows][column];
        }
    }

    pub(crate) fn copy(&mut self, from: usize, to: usize) {
        self.rows.iter_mut().for_each(|it| it[to] = it[from]);
    }

    /// Keeps rows by their number, from 1, and their values.
    pub(crate) fn keep(&mut self, is_kept: fn(usize, &[f64]) -> bool) {
        let mut at = 0;
        self.rows.retain(|row| {
            at += 1;
            is_kept(at, row)
        });
    }
}

/// Copies a folder with everything below it.
fn copy_folder(from: &Path, to: &Path) {
    for entry in std::fs::read_dir(from).expect("a folder") {
        let entry = entry.expect("an entry");
        let copy = to.join(entry.file_name());
        if entry.file_type().expect("a type").is_dir() {
            std::fs::create_dir(&copy).expect("a folder");
            copy_folder(&entry.path(), &copy);
        } else {
            std::fs::copy(entry.path(), copy).expect("a copy");
        }
    }
}
