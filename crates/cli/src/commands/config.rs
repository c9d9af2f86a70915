//! `frictcomp config`: the configuration in effect, the resulting machine, and the schema.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use crate::args::{MachineArgs, remark};
use crate::output::{Console, Failure, exit, parts, shown};
use frictcomp::comp::{AxisIndex, Kind};
use frictcomp::diagnostic::Diagnostic;
use frictcomp::lists::AxisType;
use frictcomp::machine::{AxisSet, Machine, Parameterisation};
use frictcomp_host::{CONFIG_NAME, FileRegistry, LoadedMachine};
use frictcomp_report::results::lists::render_parameters;
use frictcomp_report::results::schema::{config_schema, plant_schema};
use frictcomp_report::{Table, counted, to_json, visible_line};

/// Show the configuration in effect, or its schema
#[derive(Debug, Subcommand)]
pub(crate) enum ConfigCommand {
    /// Print the machine that a program in a folder would run on
    Show(ShowArgs),
    /// Print the JSON schema of `frictcomp.toml`, or of plant files, for editors of TOML
    Schema(SchemaArgs),
}

/// Arguments of `config schema`.
#[derive(Debug, Args)]
pub(crate) struct SchemaArgs {
    /// The file that it describes
    #[arg(value_enum, default_value_t)]
    of: SchemaOf,
}

/// A file that has a schema.
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
enum SchemaOf {
    /// `frictcomp.toml`.
    #[default]
    Config,
    /// Plant files.
    Plant,
}

/// Arguments of `config show`.
#[derive(Debug, Args)]
pub(crate) struct ShowArgs {
    /// The folder of the program
    #[arg(value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    #[command(flatten)]
    machine: MachineArgs,
}

/// Runs the command.
pub(crate) fn run(command: &ConfigCommand, console: Console) -> Result<u8, Failure> {
    match command {
        ConfigCommand::Show(args) => show(args, console),
        ConfigCommand::Schema(args) => {
            let schema = match args.of {
                SchemaOf::Config => config_schema(),
                SchemaOf::Plant => plant_schema(),
            };
            console.print(&to_json(&schema))?;
            Ok(exit::CLEAN)
        }
    }
}

fn show(args: &ShowArgs, console: Console) -> Result<u8, Failure> {
    let mut machines = args.machine.machines(&FileRegistry::default());
    let loaded = machines.for_folder(&args.folder)?;
    let mut output = String::new();
    append_machine(&mut output, &loaded);
    if !loaded.programs.is_empty() {
        output.push('\n');
        let width = console.stdout().look.width;
        output += &render_parameters(&[], &loaded.programs, width);
    }
    console.print_painted(&console.fitted(&output), parts)?;
    let errors: Vec<Diagnostic> = loaded.errors().cloned().collect();
    console.show(&errors);
    if let Some(remark) = remark(&loaded) {
        Console::talk(&remark);
    }
    Ok(if errors.is_empty() {
        exit::CLEAN
    } else {
        exit::FOUND
    })
}

/// Appends the programs that only the machine has, and what they keep.
fn append_external(output: &mut String, machine: &Machine) {
    let programs = &machine.programs;
    if !programs.external.is_empty() {
        let patterns = programs.external.join(", ");
        let _ = writeln!(output, "external       {}", visible_line(&patterns));
    }
    let kept = [
        ("compensation", &programs.keep_compensation),
        ("positions", &programs.keep_positions),
        ("parameters", &programs.keep_parameters),
    ];
    for (what, patterns) in kept.into_iter().filter(|(_, it)| !it.is_empty()) {
        let patterns = patterns.join(", ");
        let _ = writeln!(
            output,
            "external_keeps {what} of {}",
            visible_line(&patterns)
        );
    }
}

fn append_machine(output: &mut String, loaded: &LoadedMachine) {
    let machine = &loaded.machine;
    let _ = match (&loaded.origin, machine.axis_set) {
        (Some(path), _) => writeln!(output, "configuration  {}", shown(path)),
        (None, _) => writeln!(
            output,
            "configuration  none: no {CONFIG_NAME} in this folder or above"
        ),
    };
    let (read, missing) = loaded.lists;
    if read + missing > 0 {
        let _ = writeln!(output, "lists          {read} read, {missing} missing");
    }
    if let Some(build) = machine.build {
        let _ = writeln!(output, "CNC build      {build}");
    }
    if let Some(levels) = machine.skip {
        let _ = writeln!(output, "skip levels    {levels}");
    }
    if let Some(cycle) = machine.cycle_time_ms {
        let _ = writeln!(output, "cycle time     {cycle} ms");
    }
    for folder in &loaded.search_path.program_dirs {
        let _ = writeln!(output, "programs in    {}", shown(folder));
    }
    append_external(output, machine);
    let harmless: Vec<String> = machine.harmless.words().collect();
    if !harmless.is_empty() {
        let _ = writeln!(output, "harmless       {}", harmless.join(", "));
    }
    for (title, names) in [
        ("stable        ", &machine.stable),
        ("own           ", &machine.own),
    ] {
        if !names.is_empty() {
            let _ = writeln!(output, "{title} {}", names.join(", "));
        }
    }
    let columns = ["axis", "type", "at start", "P-AXIS-00522", "value list"];
    let mut table = columns.into_iter().fold(Table::default(), Table::left);
    let comp = machine.compensation();
    for (position, axis) in machine.axes.iter().enumerate() {
        let state = comp.state(AxisIndex::new(position), Kind::Frict);
        let kind = match axis.axis_type {
            AxisType::Linear => "T",
            AxisType::Rotary => "R",
            AxisType::Spindle => "S",
        };
        let value = u8::from(axis.configured.contains(Kind::Frict));
        let origin = match &axis.frict_comp_origin {
            assumed if assumed.is_assumed() => "assumed".to_owned(),
            origin => visible_line(&origin.to_string()).into_owned(),
        };
        let list = match &axis.friction {
            Parameterisation::Missing => "none".to_owned(),
            Parameterisation::Off => "mode 0, off".to_owned(),
            Parameterisation::Rejected { file, code } => {
                format!("{} rejected, {code}", visible_line(file))
            }
            Parameterisation::Assumed => "assumed".to_owned(),
            Parameterisation::Accepted(list) => counted(list.table.len(), "point"),
        };
        table.row(&[
            &axis.name,
            &kind,
            &state.as_str(),
            &format_args!("{value} {origin}"),
            &list,
        ]);
    }
    let _ = write!(output, "\n{table}");
    if let Some(assumption) = machine.assumption() {
        let _ = writeln!(output, "\n{}", visible_line(&assumption));
    }
    let open = machine.axes.iter().filter(|axis| !axis.is_described());
    let open: Vec<&str> = open.map(|axis| axis.name.as_str()).collect();
    if !open.is_empty() && machine.axis_set == AxisSet::Configured {
        let _ = writeln!(
            output,
            "\nNothing describes {}: write `frict_comp = true` or `frict_comp = false`.",
            open.join(", ")
        );
    }
    if machine.axis_set == AxisSet::AsTheyOccur {
        output.push_str("\nWithout a configuration these axes are taken as they occur.\n");
    }
}
