//! A `frictcomp.toml` to start from (R9.73).

use std::fmt::Write as _;

use frictcomp::machine::Outline;
use frictcomp::syntax::AxisUse;

/// Returns a commented `frictcomp.toml` with the known facts and no invented ones.
pub fn render_configuration(outline: &Outline) -> String {
    let mut text = String::from(
        "# The machine that the programs in this folder and below run on.\n\
         # `frictcomp config show` shows what it describes; the documentation\n\
         # (docs/configuration.md) has every key.\n\n[machine]\n",
    );
    match outline {
        Outline::Startup(path) => {
            let _ = writeln!(
                text,
                "startup = {}   # the control's start-up list, which names all others",
                toml::Value::String(path.clone())
            );
        }
        Outline::Project(path) => {
            let _ = writeln!(
                text,
                "project = {}   # the TwinCAT project, whose items hold the lists",
                toml::Value::String(path.clone())
            );
        }
        Outline::Programs(_) => {
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
    match outline {
        Outline::Startup(_) | Outline::Project(_) => text.push_str(
            "# Entries here override the lists:\n\
             # [[axis]]\n# name = \"X\"\n# frict_comp = true                # P-AXIS-00522\n\n",
        ),
        Outline::Programs(_) => append_axes(&mut text, &outline.axes()),
    }
    text.push_str(
        "# Values that only the machine knows; `frictcomp show values .` lists those that the\n\
         # programs need.\n# [variables]\n# \"V.E.PART\" = 3\n\n\
         # Severities: off, info, warning, error.\n# [lint]\n# FC402 = \"off\"\n",
    );
    text
}

fn append_axes(text: &mut String, axes: &[(&str, AxisUse)]) {
    text.push_str(
        "# All axes of the machine, in its order; any other name is an error. Nobody knows yet which\n\
         # are compensated: `enable = true` assumes it, and results that depend on it say so. Replace\n\
         # it with `frict_comp = true` and `value_list = \"lists/comp_x.lis\"`, or with\n\
         # `frict_comp = false`.\n",
    );
    if axes.is_empty() {
        text.push_str("# [[axis]]\n# name = \"X\"\n# enable = true\n\n");
    }
    for (name, how) in axes {
        let why = match how {
            AxisUse::Switched => {
                "the programs switch it, but nobody knows yet whether it is compensated"
            }
            _ => "nobody knows yet whether it is compensated",
        };
        let _ = writeln!(
            text,
            "[[axis]]\nname = \"{name}\"\nenable = true   # {why}\n"
        );
    }
}
