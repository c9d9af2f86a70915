//! The programs and macros of the channel list (R2.75).

use std::collections::BTreeMap;

use frictcomp::machine::{Configuration, ListFiles, NoList, check_list};
use frictcomp::report::lists::render_parameters;
use frictcomp::text::SourceFile;
use insta::assert_snapshot;

/// Lists in memory.
struct Files(BTreeMap<&'static str, &'static str>);

impl ListFiles for Files {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let text = self.0.get(path).ok_or(NoList::Missing)?;
        Ok(SourceFile::new(path, *text))
    }
}

const CHANNEL: &str = "\
gruppe[0].achse[0].bezeichnung X
gruppe[0].achse[0].log_achs_nr 1
start_init_prog_file      init.nc  (runs first)
final_prog_file           *
m6_prog_file              tool change.nc
t_prog_file               select.nc
d_prog_file               data.nc
g80_prog_file             G80_up.nc
g89_prog_file             G89_up.nc
g800_prog_file[0]         G800_up.nc
g800_prog_file[19]        G819_up.nc
g820_prog_file            G820_up.nc
einrechnen_mit_t          1
makro_def[4].symbol       CALC_P5
makro_def[4].nc_code      P5 = P2 + 3
makro_def[6].symbol       EMPTY
Ende
";

fn files() -> Files {
    Files(BTreeMap::from([
        ("s.lis", "zahl_mds 0\nsda_mds[0] c.lis\nEnde\n"),
        ("c.lis", CHANNEL),
    ]))
}

#[test]
fn the_channel_list_names_programs_and_macros() {
    // R2.75
    let toml = "[machine]\nstartup = \"s.lis\"\n";
    let found = Configuration::from_toml(SourceFile::new("f.toml", toml), &mut files()).unwrap();
    let programs = &found.machine.programs;
    assert_eq!(programs.start.as_deref(), Some("init.nc"));
    assert_eq!(programs.end, None);
    assert!(programs.data_with_tool);
    for (word, program) in [
        ("M6", "tool change.nc"),
        ("T", "select.nc"),
        ("D", "data.nc"),
        ("G80", "G80_up.nc"),
        ("G89", "G89_up.nc"),
        ("G800", "G800_up.nc"),
        ("G819", "G819_up.nc"),
        ("G820", "G820_up.nc"),
    ] {
        assert_eq!(programs.word(word), Some(program), "{word}");
    }
    assert_eq!(programs.word("G81"), None);
    assert_eq!(
        programs.macros,
        [("CALC_P5".to_owned(), "P5 = P2 + 3".to_owned())]
    );
    let mut shown = String::new();
    render_parameters(&[], &found.programs, 100, &mut shown).unwrap();
    assert_snapshot!(shown, @"
    programs and macros of the channel
      P-CHAN-00119  start_init_prog_file  init.nc         c.lis:3
      P-CHAN-00252  final_prog_file                       c.lis:4
      P-CHAN-00429  d_prog_file           data.nc         c.lis:7
      P-CHAN-00160  g80_prog_file         G80_up.nc       c.lis:8
      P-CHAN-00187  g800_prog_file[0]     G800_up.nc      c.lis:10
      P-CHAN-00187  g800_prog_file[19]    G819_up.nc      c.lis:11
      P-CHAN-00187  g820_prog_file        G820_up.nc      c.lis:12
      P-CHAN-00169  g89_prog_file         G89_up.nc       c.lis:9
      P-CHAN-00118  m6_prog_file          tool change.nc  c.lis:5
                    t_prog_file           select.nc       c.lis:6
      P-CHAN-00014  einrechnen_mit_t      1               c.lis:13
      P-CHAN-00085  makro_def[4].symbol   CALC_P5         c.lis:14
      P-CHAN-00062  makro_def[4].nc_code  P5 = P2 + 3     c.lis:15
      P-CHAN-00085  makro_def[6].symbol   EMPTY           c.lis:16
    ");
    let report = check_list(SourceFile::new("c.lis", CHANNEL), None, &mut files());
    assert_eq!(report.programs, found.programs);
}

#[test]
fn the_configuration_counts_before_the_channel_list() {
    // R2.75
    let toml = "[machine]\nstartup = \"s.lis\"\nstart_program = \"mine.nc\"\nprograms = { m06 = \"my.nc\" }\n";
    let found = Configuration::from_toml(SourceFile::new("f.toml", toml), &mut files()).unwrap();
    let programs = &found.machine.programs;
    assert_eq!(programs.start.as_deref(), Some("mine.nc"));
    assert_eq!(programs.word("M6"), Some("my.nc"));
    assert_eq!(programs.word("T"), Some("select.nc"));
    let mut shown = String::new();
    render_parameters(&[], &found.programs, 100, &mut shown).unwrap();
    let first: Vec<&str> = shown.lines().take(4).collect();
    assert_snapshot!(first.join("\n"), @"
    programs and macros of the channel
      P-CHAN-00119  start_program         mine.nc      f.toml:3
                    programs.m06          my.nc        f.toml:4
      P-CHAN-00252  final_prog_file                    c.lis:4
    ");
    assert!(
        !shown.contains("init.nc") && !shown.contains("tool change"),
        "{shown}"
    );
}
