//! `frictcomp replay`: compares a recording of what the machine did with the dry run.

use std::path::PathBuf;

use clap::Args;

use crate::args::{ByAxis, ExecutionArgs, MachineArgs, PerAxis, StartArgs, Tolerance, UnitArgs};
use crate::output::{Console, Failure, HtmlArgs, Job, ResultArgs, exit};
use frictcomp::interpreter::StopPolicy;
use frictcomp::machine::Machine;
use frictcomp::text::shown_path;
use frictcomp_host::replay::{Replay, ReplayChannels, read_states};
use frictcomp_host::{FileRegistry, Input};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_report::results::replay::{ReplayReport, document, render_json};

/// Compare what a machine did with the dry run of its programs
///
/// The recording says for each axis whether friction compensation is active: `frict_comp.f_is_active`,
/// or `V.A.FRICT_COMP_ACTIVE.<axis>` sampled by the PLC; as CSV the columns `t`, `active_<axis>` and, if
/// present, `line` or `block`, `program` and `pos_<axis>`. Where only one way through a condition fits,
/// the recording decides it.
#[derive(Debug, Args)]
pub(crate) struct ReplayArgs {
    /// The recording
    #[arg(value_name = "RECORDING")]
    recording: PathBuf,
    /// The programs that ran while it was recorded, in their order
    #[arg(required = true, value_name = "PROGRAM")]
    programs: Vec<PathBuf>,
    /// The channel of the times: its name, comment or CNC object
    #[arg(long, value_name = "CHANNEL")]
    time: Option<String>,
    /// The channel of the state of an axis: `X=FrictX`, or `%.Frict` with `%` for the name of each axis
    #[arg(long, value_name = "CHANNEL")]
    active: Vec<PerAxis>,
    /// The channel of the position of an axis: `X=ActPosX`, or `%.ActPos`
    #[arg(long, value_name = "CHANNEL")]
    position: Vec<PerAxis>,
    /// The channel of the line of the program
    #[arg(long, value_name = "CHANNEL")]
    line: Option<String>,
    /// The channel of the block number, N, where lines were not recorded
    #[arg(long, value_name = "CHANNEL", conflicts_with = "line")]
    block: Option<String>,
    /// The channel of the running number of the program, from 1
    #[arg(long, value_name = "CHANNEL")]
    program: Option<String>,
    #[command(flatten)]
    unit: UnitArgs,
    /// How much positions may differ where no blocks were recorded, in µm or 0.001°; by default 100
    #[arg(long, value_name = "UM")]
    tolerance: Option<Tolerance>,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    html: HtmlArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    start: StartArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Runs the command.
pub(crate) fn run(args: &ReplayArgs, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    registry.reads("recording", &args.recording);
    let inputs: Vec<Input> = args.programs.iter().map(|path| Input::new(path)).collect();
    for input in &inputs {
        input.probe()?;
        input.note(&registry);
    }
    let job = Job::new(&args.result, &registry, console)?.with_page(&args.html)?;
    let mut machines = args.machine.machines(&registry);
    machines.look_ahead(&inputs);
    let first = inputs
        .first()
        .ok_or_else(|| Failure::new("there is no program"))?;
    let loaded = machines.for_folder(first.folder())?;
    job.outputs.check()?;
    let recording = read_states(
        &args.recording,
        &args.channels(&loaded.machine)?,
        &loaded.machine,
    )?;
    let mut options = args.execution.options(&loaded, StopPolicy::FirstError);
    options.start = args.start.positions(&loaded.machine)?;
    let replay = Replay {
        inputs: &inputs,
        loaded: &loaded,
        options,
        tolerance: {
            let given = args.tolerance;
            given.map_or(Replay::TOLERANCE, |it| it.um() / 1000.0)
        },
    };
    let replayed = replay.compare(&recording)?;
    let report = ReplayReport {
        name: shown_path(&args.recording),
        recording: &recording,
        replayed: &replayed,
    };
    let document = document(&report);
    job.finish(&document, || render_json(&report))?;
    args.machine.say_unread(&machines, &registry, console);
    Ok(if replayed.agrees() {
        exit::CLEAN
    } else {
        exit::FOUND
    })
}

impl ReplayArgs {
    fn channels(&self, machine: &Machine) -> Result<ReplayChannels, Failure> {
        let axes: Vec<&str> = machine.axes.iter().map(|it| it.name.as_str()).collect();
        let axes = &axes;
        let of_each = |option, given| ByAxis::new(option, given, axes).channels();
        Ok(ReplayChannels {
            selection: ChannelSelection {
                time: self.time.clone(),
                units: self.unit.unit.clone(),
                ..ChannelSelection::default()
            },
            active: of_each("--active", &self.active)?,
            positions: of_each("--position", &self.position)?,
            line: self.line.clone(),
            block: self.block.clone(),
            program: self.program.clone(),
        })
    }
}
