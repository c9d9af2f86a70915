//! The programs and macros of the channel list (R2.75).

use std::collections::BTreeMap;

use frictcomp::machine::{Configuration, FeedUnit, ListFiles, NoList, check_list};
use frictcomp::text::SourceFile;
use frictcomp_report::lists::render_parameters;
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

#[test]
fn the_channel_list_says_what_holds_for_motion() {
    // R3.13 R5.1
    let channel = |text: &'static str| {
        let mut files = Files(BTreeMap::from([
            ("s.lis", "zahl_mds 0\nsda_mds[0] c.lis\nEnde\n"),
            ("c.lis", text),
        ]));
        let toml = "[machine]\nstartup = \"s.lis\"\n";
        Configuration::from_toml(SourceFile::new("f.toml", toml), &mut files).unwrap()
    };
    let found = channel(
        "gruppe[0].achse[0].bezeichnung X\ngruppe[0].achse[0].log_achs_nr 1\n\
         prog_start.feedrate_factor 0.1 (m/min)\nprog_start.feedrate 1000\n\
         prog_start.g_gruppe[0].nr 1\nprog_start.g_gruppe[14].nr -1\n\
         prog_start.g_gruppe[12].nr 70\nmass_einh 0\nmain_spindle_ax_nr 6\n\
         main_spindle_name S\nspindel[0].bezeichnung S1\nspindel[0].log_achs_nr 6\n\
         spindel[1].bezeichnung S2\nspindel[1].log_achs_nr 11\nEnde\n",
    );
    assert!(found.diagnostics.is_empty(), "{:?}", found.diagnostics);
    let settings = &found.machine.channel;
    assert_eq!(settings.feed_unit, FeedUnit::MetresPerMinute);
    assert_eq!(settings.feed_mm_per_min, Some(1000.0));
    assert!(!settings.lacks_feed);
    // R2.110: whether the lists give no feed; a value that is not understood may be one.
    for (feed, lacks_feed) in [
        ("Ende\n", true),
        ("prog_start.feedrate 0\nEnde\n", true),
        ("prog_start.feedrate 0.0\nEnde\n", true),
        ("prog_start.feedrate 1.5\nEnde\n", false),
        ("prog_start.feedrate fast\nEnde\n", false),
    ] {
        assert_eq!(
            channel(feed).machine.channel.lacks_feed,
            lacks_feed,
            "{feed}"
        );
    }
    assert_eq!(settings.functions, [1, 70]);
    assert_eq!(settings.main_spindle, ["S", "S1"]);
    let shown: Vec<_> = found
        .programs
        .iter()
        .map(|row| format!("{} {} {}", row.number, row.key, row.value))
        .collect();
    assert_eq!(
        shown,
        [
            "P-CHAN-00108 prog_start.feedrate_factor 0.1",
            "P-CHAN-00099 prog_start.feedrate 1000",
            "P-CHAN-00063 prog_start.g_gruppe[0].nr 1",
            "P-CHAN-00063 prog_start.g_gruppe[12].nr 70",
            "P-CHAN-00054 mass_einh 0",
            "P-CHAN-00051 main_spindle_ax_nr 6",
            "P-CHAN-00053 main_spindle_name S",
        ]
    );
    // 0 and less count as mm/min, and the control warns unless the value is -1; others are not
    // documented.
    for (value, unit, said) in [
        ("100", FeedUnit::MillimetresPerMinute, 0),
        ("-1", FeedUnit::MillimetresPerMinute, 0),
        ("0", FeedUnit::MillimetresPerMinute, 1),
        ("-5", FeedUnit::MillimetresPerMinute, 1),
        ("0.1", FeedUnit::MetresPerMinute, 0),
        ("1", FeedUnit::Unknown, 1),
        ("2540", FeedUnit::Unknown, 1),
        ("fast", FeedUnit::MillimetresPerMinute, 1),
    ] {
        let text = format!("prog_start.feedrate_factor {value}\nEnde\n");
        let found = channel(Box::leak(text.into_boxed_str()));
        assert_eq!(found.machine.channel.feed_unit, unit, "{value}");
        let codes = found.diagnostics.iter().map(|said| said.code.as_str());
        let codes: Vec<_> = codes
            .filter(|code| ["FC130", "FC132"].contains(code))
            .collect();
        assert_eq!(codes.len(), said, "{value}: {:?}", found.diagnostics);
    }
    for line in [
        "prog_start.g_gruppe[4].nr 16",
        "prog_start.g_gruppe[1].nr 5",
        "mass_einh inch",
    ] {
        let text = format!("{line}\nEnde\n");
        let found = channel(Box::leak(text.into_boxed_str()));
        let said = found
            .diagnostics
            .iter()
            .any(|said| said.code.as_str() == "FC132");
        assert!(said, "{line}: {:?}", found.diagnostics);
    }
}
