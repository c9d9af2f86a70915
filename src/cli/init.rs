//! `frictcomp init`: a configuration to begin with (R9.73).

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use ignore::WalkBuilder;

use super::console::Console;
use super::exit;
use super::failure::Failure;
use crate::diagnostic::Code;
use crate::host::{
    CONFIG_NAME, Input, ListsOnDisk, UnfinishedFile, find_programs, normal, read_list, read_text,
    relative, take_away_left,
};
use crate::lists::ListKind;
use crate::machine::{Configuration, check_list};
use crate::syntax::{AxisUse, axis_uses};

/// Write a commented `frictcomp.toml` to start from
///
/// Describes the machine from the control's start-up list if one is given or found in the folder,
/// otherwise from the axes that the programs in the folder use. An existing file is not changed.
#[derive(Debug, Args)]
pub(super) struct InitArgs {
    /// The folder with the programs
    #[arg(value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    /// The start-up list of the machine, such as `hochlauf.lis`
    #[arg(long, value_name = "LIST")]
    startup: Option<PathBuf>,
}

/// What is known about the machine.
enum Known {
    /// Its start-up list, as it is seen from the folder.
    Startup(PathBuf),
    /// What programs do with axes.
    Uses(BTreeMap<String, AxisUse>),
}

/// Runs the command.
pub(super) fn run(args: &InitArgs) -> Result<u8, Failure> {
    let shown = args.folder.display();
    if !args.folder.is_dir() {
        return Err(Failure::new(format!("there is no folder `{shown}`"))
            .with_help("name the folder of the programs"));
    }
    let target = args.folder.join(CONFIG_NAME);
    if target.symlink_metadata().is_ok() {
        return Err(there(&target));
    }
    let startup = match &args.startup {
        Some(path) => Some(path.clone()),
        None => find_startup(&args.folder)?,
    };
    let known = match startup {
        Some(path) => Known::Startup(seen_from(&args.folder, &checked(&path)?)?),
        None => Known::Uses(programs(&args.folder)),
    };
    write_new(&target, &render(&known))?;
    Console::talk(&format!("wrote `{}`: {}", target.display(), told(&known)));
    Console::talk("next: `frictcomp config show` shows the machine that it describes");
    Ok(exit::CLEAN)
}

fn there(target: &Path) -> Failure {
    Failure::new(format!(
        "`{}` already exists and is not changed",
        target.display()
    ))
    .with_help("`frictcomp config show` shows the machine that it describes")
}

/// How deep below the folder a start-up list is looked for.
const DEPTH: usize = 4;

/// The start-up list below a folder, recognised by its content.
fn find_startup(folder: &Path) -> Result<Option<PathBuf>, Failure> {
    let mut found: Vec<PathBuf> = Vec::new();
    let walk = WalkBuilder::new(folder)
        .max_depth(Some(DEPTH))
        .sort_by_file_name(std::ffi::OsStr::cmp)
        .build();
    for entry in walk.filter_map(Result::ok) {
        let path = entry.path();
        let is_list = path
            .extension()
            .is_some_and(|it| it.eq_ignore_ascii_case("lis"));
        if is_list
            && let Ok(list) = read_list(path)
            && check_list(list, None, &mut crate::machine::NoLists).kind == Some(ListKind::Startup)
        {
            found.push(path.strip_prefix(".").unwrap_or(path).to_owned());
        }
    }
    if found.len() > 1 {
        let names: Vec<_> = found
            .iter()
            .map(|path| format!("`{}`", path.display()))
            .collect();
        return Err(Failure::new(format!(
            "there are several start-up lists: {}",
            names.join(", ")
        ))
        .with_help("say with `--startup LIST` which one the machine has"));
    }
    Ok(found.pop())
}

/// The start-up list if it is one.
fn checked(path: &Path) -> Result<PathBuf, Failure> {
    let configuration = Configuration::from_startup(read_list(path)?, &mut ListsOnDisk);
    let wrong = configuration
        .diagnostics
        .iter()
        .find(|said| said.code == Code::Fc125 && *said.place.file == *path.display().to_string());
    match wrong {
        Some(wrong) if configuration.files.len() == 1 => Err(Failure::new(wrong.message.clone())
            .with_help("`--startup` takes the list that names all others, `hochlauf.lis`")),
        _ => Ok(path.to_owned()),
    }
}

/// A path as a configuration in the folder writes it.
fn seen_from(folder: &Path, path: &Path) -> Result<PathBuf, Failure> {
    let absolute = |path: &Path| {
        let found = std::path::absolute(path).map(|path| normal(&path));
        found.map_err(|error| Failure::reading(path, error))
    };
    Ok(relative(&absolute(path)?, &absolute(folder)?))
}

/// What the programs below a folder do with axes. What cannot be read is no program to learn from.
fn programs(folder: &Path) -> BTreeMap<String, AxisUse> {
    let mut uses: BTreeMap<String, AxisUse> = BTreeMap::new();
    let inputs = find_programs(&[folder.to_owned()], |_| None).inputs;
    for input in inputs {
        let Input::File(path) = input else {
            continue;
        };
        let Ok(text) = read_text(&path) else {
            continue;
        };
        for (name, how) in axis_uses(&text) {
            let known = uses.entry(name).or_insert(how);
            *known = how.max(*known);
        }
    }
    uses
}

/// Creates the file as a whole; one that came into being meanwhile stays.
fn write_new(target: &Path, text: &str) -> Result<(), Failure> {
    let written = UnfinishedFile::begin(target).and_then(|mut file| {
        take_away_left(&file, &mut BTreeSet::new());
        file.write_all(text.as_bytes())?;
        file.take_free_place()
    });
    written.map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => there(target),
        _ => Failure::writing(target, error),
    })
}

/// What was found out, in a few words.
fn told(known: &Known) -> String {
    match known {
        Known::Startup(path) => format!("the machine of `{}`", path.display()),
        Known::Uses(uses) if uses.is_empty() => {
            "there is no start-up list and no program; fill in the axes".to_owned()
        }
        Known::Uses(uses) => {
            let names: Vec<_> = in_order(uses).map(|(name, _)| name.as_str()).collect();
            format!(
                "no start-up list was found; the programs use {}",
                names.join(", ")
            )
        }
    }
}

/// The axes in the usual order, longer names last.
fn in_order(uses: &BTreeMap<String, AxisUse>) -> impl Iterator<Item = (&String, &AxisUse)> {
    const USUAL: &str = "XYZABCUVW";
    let mut axes: Vec<_> = uses.iter().collect();
    axes.sort_by_key(|(name, _)| (name.len() > 1, USUAL.find(name.as_str())));
    axes.into_iter()
}

fn render(known: &Known) -> String {
    let mut text = String::from(
        "# The machine that the programs in this folder and below run on.\n\
         # `frictcomp config show` shows what it describes; the documentation\n\
         # (docs/configuration.md) has every key.\n\n[machine]\n",
    );
    match known {
        Known::Startup(path) => {
            let _ = writeln!(
                text,
                "startup = {}   # the control's start-up list, which names all others",
                quoted(path)
            );
        }
        Known::Uses(_) => {
            text.push_str(
                "# startup = \"lists/hochlauf.lis\"   # the control's start-up list, \
                           instead of the axes below\n",
            );
        }
    }
    text.push_str(
        "# cycle_time_ms = 1.0              # the CNC cycle\n\
         # cnc_build = \"3.1.3132.0\"         # the version of the control's kernel\n\
         # program_dirs = [\"cycles\"]        # further folders with called programs\n\n",
    );
    match known {
        Known::Startup(_) => text.push_str(
            "# Entries here override the lists:\n\
             # [[axis]]\n# name = \"X\"\n# frict_comp = true                # P-AXIS-00522\n\n",
        ),
        Known::Uses(uses) => axes(&mut text, uses),
    }
    text.push_str(
        "# Values that only the machine knows; `frictcomp check --unknowns .` lists those that the\n\
         # programs need.\n# [variables]\n# \"V.E.PART\" = 3\n\n\
         # Severities: off, info, warning, error.\n# [lint]\n# FC402 = \"off\"\n",
    );
    text
}

fn axes(text: &mut String, uses: &BTreeMap<String, AxisUse>) {
    text.push_str(
        "# All axes of the machine, in its order; any other name is an error. `enable` stands for a\n\
         # value list that is not known yet: replace it with `frict_comp = true` and\n\
         # `value_list = \"lists/comp_x.lis\"`.\n",
    );
    if uses.is_empty() {
        text.push_str("# [[axis]]\n# name = \"X\"\n# enable = true\n\n");
    }
    for (name, how) in in_order(uses) {
        let _ = writeln!(text, "[[axis]]\nname = \"{name}\"");
        if *how == AxisUse::Switched {
            text.push_str("enable = true   # the programs switch its friction compensation\n");
        }
        text.push('\n');
    }
}

/// A path as TOML writes a text, with `/` between its parts.
fn quoted(path: &Path) -> String {
    let shown = path.to_string_lossy();
    let slashed = if cfg!(windows) {
        shown.replace('\\', "/")
    } else {
        shown.into_owned()
    };
    toml::Value::String(slashed).to_string()
}
