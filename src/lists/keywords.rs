//! The list keys with the numbers of their parameters, for references to them (R3.40), for keys
//! that lost their underscores, and for `explain`.
//!
//! The keys of a channel list have a row each: what the dry run reads from it, or why it reads nothing (R2.105). The public overview
//! of the channel parameters can be read up to P-CHAN-00024; the rows beyond have a page of their own, which was found by its
//! subject: flow, calls, couplings, parameters, words at the start and at the end.

/// A key of a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct KnownKey {
    /// The number in the parameter descriptions; empty where none is documented.
    pub number: &'static str,
    /// The key with all indices left empty: `frict_comp.table[].in`.
    pub pattern: &'static str,
}

macro_rules! keys {
    ($($number:literal $pattern:literal)+) => {
        &[$(KnownKey { number: $number, pattern: $pattern },)+]
    };
}

/// Returns every key that is read or referred to (TF5200 Axis, Compensation, Channel and Start-up parameters).
pub fn known_keys() -> impl Iterator<Item = KnownKey> {
    let channel = CHANNEL_KEYS.iter().map(|row| row.key);
    KEYS.iter().copied().chain(channel)
}

/// Keys of lists other than channel lists.
const KEYS: &[KnownKey] = keys! {
    "P-AXIS-00016" "kopf.achs_nr"
    "P-AXIS-00297" "kopf.log_achs_name"
    "P-AXIS-00015" "kenngr.achs_mode"
    "P-AXIS-00018" "kenngr.achs_typ"
    "P-AXIS-00020" "kenngr.antr_typ"
    "P-AXIS-00070" "kenngr.gantry_ax_nr"
    "P-AXIS-00790" "kenngr.drive_simulation"
    "P-AXIS-00021" "lr_param.anwahl_losekomp"
    "P-AXIS-00047" "lr_param.crosscomp"
    "P-AXIS-00174" "lr_param.crosscomp2"
    "P-AXIS-00175" "lr_param.ssfk"
    "P-AXIS-00271" "lr_param.temp_comp"
    "P-AXIS-00482" "lr_param.temp_comp_manual_activation"
    "P-AXIS-00522" "lr_param.frict_comp"
    "P-AXIS-00789" "lr_param.crosstalk"
    "P-AXIS-00465" "lr_param.prog_movement_requires_compensations"
    "P-AXIS-00089" "antr.sercos.at[].ident_nr"
    "P-AXIS-00090" "antr.sercos.mdt[].ident_nr"
    "P-AXIS-00131" "antr.sercos.at[].nc_ref"
    "P-AXIS-00132" "antr.sercos.mdt[].nc_ref"
    "P-AXIS-00475" "antr.canopen.in[].nc_ref"
    "P-AXIS-00478" "antr.canopen.out[].nc_ref"
    "P-AXIS-00324" "getriebe[].torque_offset"
    "P-AXIS-00325" "antr.torque_scale_num"
    "P-AXIS-00326" "antr.torque_scale_denom"
    "P-AXIS-00008" "getriebe[].dynamik.a_max"
    "P-AXIS-00212" "getriebe[].dynamik.vb_max"
    "P-AXIS-00209" "getriebe[].vb_eilgang"
    "P-AXIS-00001" "getriebe[].slope_profil.a_beschl"
    "P-AXIS-00002" "getriebe[].slope_profil.a_brems"
    "P-AXIS-00004" "getriebe[].slope_profil.a_grenz"
    "P-AXIS-00195" "getriebe[].slope_profil.tr_beschl_ab"
    "P-AXIS-00196" "getriebe[].slope_profil.tr_beschl_zu"
    "P-AXIS-00197" "getriebe[].slope_profil.tr_brems_ab"
    "P-AXIS-00198" "getriebe[].slope_profil.tr_brems_zu"
    "P-AXIS-00200" "getriebe[].slope_profil.tr_grenz"
    "P-AXIS-00199" "getriebe[].dynamik.tr_geom"
    "P-AXIS-00201" "getriebe[].dynamik.tr_min"
    "P-AXIS-00011" "getriebe[].lslope_profil.a_stufe_1"
    "P-AXIS-00011" "getriebe[].slope_profil.a_stufe_1"
    "P-AXIS-00012" "getriebe[].lslope_profil.a_stufe_2"
    "P-AXIS-00012" "getriebe[].slope_profil.a_stufe_2"
    "P-AXIS-00221" "getriebe[].lslope_profil.vb_stufe_1_2"
    "P-AXIS-00221" "getriebe[].slope_profil.vb_stufe_1_2"
    "P-AXIS-00013" "getriebe[].dynamik.a_trans_weight"
    "P-AXIS-00154" "getriebe[].dynamik.r_trans_weight"
    "P-COMP-00001" "kopf.achs_nr"
    "P-COMP-00002" "kopf.log_achs_name"
    "P-COMP-00028" "kw.ssfk.manual_activation"
    "P-COMP-00029" "kw.crosscomp.manual_activation"
    "P-COMP-00030" "kw.crosscomp2.manual_activation"
    "" "kw.crosstalk.manual_activation"
    "P-COMP-00041" "frict_comp.mode"
    "P-COMP-00042" "frict_comp.table_entries"
    "P-COMP-00043" "frict_comp.position_delay"
    "P-COMP-00044" "frict_comp.reversal_lookahead"
    "P-COMP-00045" "frict_comp.scaling_factor"
    "P-COMP-00046" "frict_comp.table[].in"
    "P-COMP-00047" "frict_comp.table[].out"
    "P-COMP-00058" "frict_comp.delay_cycles"
    "P-COMP-00062" "frict_comp.max_points"
    "P-STUP-00009" "sda_mds[]"
    "P-STUP-00014" "zahl_mds"
    "P-STUP-00015" "achs_mds[]"
    "P-STUP-00016" "zahl_kw"
    "P-STUP-00017" "achs_kw[]"
    "P-STUP-00034" "default_sda_mds"
    "P-STUP-00035" "default_achs_mds"
    "P-STUP-00036" "achs_kw_log_ax_nr[]"
};

/// Returns whether a key, with its indices left empty, is one of them.
pub(super) fn is_known(pattern: &str) -> bool {
    known_keys().any(|key| key.pattern == pattern)
}

/// A key whose underscores turned into blanks, as in a list copied from a PDF: `frict comp.mode 3`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Blanked {
    /// The intended key, with its indices left empty.
    pub(super) pattern: &'static str,
    /// The number of bytes that it takes in the line.
    pub(super) length: usize,
}

/// Returns the longest known key that a line begins with, with a blank for at least one underscore.
pub(super) fn blanked(line: &str) -> Option<Blanked> {
    let found = known_keys().filter_map(|key| {
        let length = blanked_length(key.pattern, line)?;
        Some(Blanked {
            pattern: key.pattern,
            length,
        })
    });
    found.max_by_key(|found| found.length)
}

/// Returns the length in bytes of a key at the start of a line, with a blank for at least one
/// underscore.
fn blanked_length(pattern: &str, line: &str) -> Option<usize> {
    let is_blank = |c: char| matches!(c, ' ' | '\t');
    let mut rest = line;
    let mut is_lost = false;
    for wanted in pattern.chars() {
        if wanted == '_' && rest.starts_with(is_blank) {
            rest = rest.trim_start_matches(is_blank);
            is_lost = true;
            continue;
        }
        if wanted == ']' {
            rest = rest.trim_start_matches(|c: char| c.is_ascii_digit() || is_blank(c));
        }
        rest = rest.strip_prefix(wanted)?;
    }
    let ends = rest.is_empty() || rest.starts_with(is_blank);
    (is_lost && ends).then_some(line.len() - rest.len())
}

/// A key of a channel list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct ChannelKey {
    /// The key with the number of its parameter.
    pub(super) key: KnownKey,
    /// Use of the key in a dry run.
    usage: KeyUse,
}

/// Use of a key in a dry run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum KeyUse {
    /// Key that is read: its effect, and the case of `tests/rules` or the test that shows it.
    Read(&'static str, &'static str),
    /// Key that is not read: the reason why no result of a dry run depends on it.
    Unread(&'static str),
}

macro_rules! rows {
    ($($number:literal $pattern:literal $usage:expr;)+) => {
        &[$(ChannelKey { key: KnownKey { number: $number, pattern: $pattern }, usage: $usage }),+]
    };
}

/// Case of the keys that name programs.
const PROGRAMS: &str = "Each key that names a program";
/// Case of the keys that name axes.
const AXES: &str = "The axes of the channel";
/// Case of the keys that define the coupling group 0.
const GROUP: &str = "The coupling group 0";
/// Case of the keys that keep couplings and parameters.
const OUTLIVES: &str = "Switches that decide what outlives a program";
/// Test of the keys that only decide velocities.
const VELOCITY: &str = "crates/physics/tests/physics/motion/listed.rs";

/// Reason of keys that only limit or shape the velocity.
const ONLY_VELOCITY: &str = "limits or shapes the velocity, which no state depends on";
/// Reason of keys that choose a kinematics.
const KINEMATICS: &str =
    "chooses a kinematics; under `#TRAFO` positions are those of the program, whichever it is";
/// Reason of keys that record or report.
const RECORDS: &str = "decides what is recorded or reported, not what is executed";
/// Reason of keys of spindles.
const SPINDLE: &str = "concerns the spindle";
/// Reason of keys of the tool management.
const TOOLS: &str = "concerns the exchange of data with a tool management";

/// The rows, in the order of their numbers; keys without a public number come last.
pub(super) static CHANNEL_KEYS: &[ChannelKey] = {
    use KeyUse::{Read, Unread};
    rows! {
        "P-CHAN-00001" "prog_start.slope.acceleration" Unread(ONLY_VELOCITY);
        "P-CHAN-00002" "vector.acceleration" Unread(ONLY_VELOCITY);
        "P-CHAN-00003" "gruppe[].achs_anzahl" Read("how many of the axes in the list the channel has", AXES);
        "P-CHAN-00004" "spindel[].autom_range" Unread(SPINDLE);
        "P-CHAN-00005" "gruppe[].bezeichnung" Unread("names the group of axes, which programs do not");
        "P-CHAN-00006" "gruppe[].achse[].bezeichnung" Read("the name of an axis in programs", AXES);
        "P-CHAN-00007" "spindel[].bezeichnung" Read("the name of a spindle, whose speed G95 and G96 use", VELOCITY);
        "P-CHAN-00008" "cax_face_id" Unread(KINEMATICS);
        "P-CHAN-00009" "corr_v_trans_jerk" Unread(ONLY_VELOCITY);
        "P-CHAN-00010" "default_ax_name_of_spindle" Unread("names the axis that a spindle becomes in the path; a spindle has no friction compensation");
        "P-CHAN-00011" "gruppe[].achse[].default_feed_axis" Unread(ONLY_VELOCITY);
        "P-CHAN-00012" "speed_limit_look_ahead.dist_from_corner" Unread(ONLY_VELOCITY);
        "P-CHAN-00013" "speed_limit_look_ahead.dist_to_corner" Unread(ONLY_VELOCITY);
        "P-CHAN-00014" "einrechnen_mit_t" Read("whether a T word also has the effect of a D word", PROGRAMS);
        "P-CHAN-00015" "einzelschrittmodus" Unread("decides where single step stops, not what is executed");
        "P-CHAN-00016" "ext_wzv_vorhanden" Unread(TOOLS);
        "P-CHAN-00017" "speed_limit_look_ahead.f_enable" Unread(ONLY_VELOCITY);
        "P-CHAN-00018" "speed_limit_look_ahead.f_time" Unread(ONLY_VELOCITY);
        "P-CHAN-00019" "syn_chk.fehler_gesamt" Unread("concerns the syntax check of the control");
        "P-CHAN-00020" "syn_chk.fehler_pro_zeile" Unread("concerns the syntax check of the control");
        "P-CHAN-00021" "create_cont_mask_warnings" Unread(RECORDS);
        "P-CHAN-00022" "aep.g_gruppe[]" Unread(RECORDS);
        "P-CHAN-00023" "grp_anzahl" Unread("counts the groups; the first one is that of the path, and the others have no axes of programs");
        "P-CHAN-00024" "aep.output_mode" Unread(RECORDS);
        "P-CHAN-00027" "h_synch[]" Read("whether the PLC acknowledges an H function, so that it may change `V.E.` variables there", "Acknowledged functions");
        "P-CHAN-00028" "syn_chk.interaktiv" Unread("concerns the syntax check of the control");
        "P-CHAN-00032" "kinematik_id" Unread(KINEMATICS);
        "P-CHAN-00035" "gruppe[].achse[].log_achs_nr" Read("the logical number of an axis, by which lists and axis exchange name it", AXES);
        "P-CHAN-00036" "spindel[].log_achs_nr" Read("the logical number of a spindle, by which `main_spindle_ax_nr` names it", VELOCITY);
        "P-CHAN-00037" "synchro_data.koppel_gruppe[].paar[].log_achs_nr_master" Read("the leading axis of a pair of the coupling group 0", GROUP);
        "P-CHAN-00038" "synchro_data.koppel_gruppe[].paar[].log_achs_nr_slave" Read("the following axis of a pair of the coupling group 0", GROUP);
        "P-CHAN-00041" "m_synch[]" Read("whether the PLC acknowledges an M function, so that it may change `V.E.` variables there", "Acknowledged functions");
        "P-CHAN-00051" "main_spindle_ax_nr" Read("the number of the main spindle, whose speed G95 and G96 use", VELOCITY);
        "P-CHAN-00053" "main_spindle_name" Read("the name of the main spindle", VELOCITY);
        "P-CHAN-00054" "mass_einh" Read("the unit of coordinates: 0 mm, 1 inch", "The unit of coordinates");
        "P-CHAN-00061" "synchro_data.koppel_gruppe[].paar[].mode" Read("whether a pair of the coupling group 0 is of spindles", GROUP);
        "P-CHAN-00062" "makro_def[].nc_code" Read("the text that a macro of the channel stands for", "A macro of the channel");
        "P-CHAN-00063" "prog_start.g_gruppe[].nr" Read("the G function of a group at program start", "G functions at program start");
        "P-CHAN-00064" "prog_start.m_gruppe[].nr" Unread(SPINDLE);
        "P-CHAN-00067" "p_param_haltend" Read("whether P parameters outlive the program", OUTLIVES);
        "P-CHAN-00068" "aep.p_parameter" Unread(RECORDS);
        "P-CHAN-00071" "prog_start.slope.profile" Read("the profile of the acceleration at program start: 0 for steps, 1 for ramps, 2 for sine-squared ramps, 3 for ramps with the longest ramp time; default 0, where no list gives it ramps are assumed", VELOCITY);
        "P-CHAN-00075" "reset_no_axis_to_axv" Read("whether a reset leaves the axes that the program exchanged in the channel", "Axes after a reset");
        "P-CHAN-00076" "tool_life_to_wzv" Unread(TOOLS);
        "P-CHAN-00085" "makro_def[].symbol" Read("the name of a macro of the channel", "A macro of the channel");
        "P-CHAN-00087" "t_info_to_wzv" Unread(TOOLS);
        "P-CHAN-00099" "prog_start.feedrate" Read("the feed before the first F", "The feed before the first F");
        "P-CHAN-00104" "synchro_data.restore_coupling_after_reset" Read("whether couplings stay in force after an error", "Couplings after a reset");
        "P-CHAN-00105" "synchro_data.preserve_coupling_after_prog_end" Read("whether couplings stay in force after the end of the program", OUTLIVES);
        "P-CHAN-00108" "prog_start.feedrate_factor" Read("the unit of F: 100 for mm/min, 0.1 for m/min", VELOCITY);
        "P-CHAN-00115" "release_non_channel_axis" Unread("concerns axes that `reset_no_axis_to_axv` leaves in the channel; which they are is unknown then");
        "P-CHAN-00118" "m6_prog_file" Read("the program that M6 calls", PROGRAMS);
        "P-CHAN-00119" "start_init_prog_file" Read("a program that runs at the start of every main program; it may switch compensation", PROGRAMS);
        "P-CHAN-00145" "kin_trafo_display" Unread(RECORDS);
        "P-CHAN-00160" "g80_prog_file" Read("the program that G80 calls", PROGRAMS);
        "P-CHAN-00161" "g81_prog_file" Read("the program that G81 calls", PROGRAMS);
        "P-CHAN-00162" "g82_prog_file" Read("the program that G82 calls", PROGRAMS);
        "P-CHAN-00163" "g83_prog_file" Read("the program that G83 calls", PROGRAMS);
        "P-CHAN-00164" "g84_prog_file" Read("the program that G84 calls", PROGRAMS);
        "P-CHAN-00165" "g85_prog_file" Read("the program that G85 calls", PROGRAMS);
        "P-CHAN-00166" "g86_prog_file" Read("the program that G86 calls", PROGRAMS);
        "P-CHAN-00167" "g87_prog_file" Read("the program that G87 calls", PROGRAMS);
        "P-CHAN-00168" "g88_prog_file" Read("the program that G88 calls", PROGRAMS);
        "P-CHAN-00169" "g89_prog_file" Read("the program that G89 calls", PROGRAMS);
        "P-CHAN-00179" "ax_default_config_after_reset" Unread("restores the axes of the list after a reset, which the start of a program does, too");
        "P-CHAN-00187" "g800_prog_file[]" Read("the program that G800 and the index call: index 12 is G812", PROGRAMS);
        "P-CHAN-00210" "cycle_changes_modal" Read("whether a cycle keeps its changes to G functions and feed", "A cycle keeps its G functions");
        "P-CHAN-00252" "final_prog_file" Read("a program that runs at the end of every main program; it may switch compensation", PROGRAMS);
        "P-CHAN-00260" "start_init_prog_file_mode" Read("the operation modes in which the program at the start runs", "A start program for MDI does not run");
        "P-CHAN-00262" "trafo[].id" Unread(KINEMATICS);
        "P-CHAN-00263" "trafo[].param[]" Unread(KINEMATICS);
        "P-CHAN-00264" "default_id_of_kin_step[]" Unread(KINEMATICS);
        "P-CHAN-00294" "trafo[].linkage_mode" Unread(KINEMATICS);
        "P-CHAN-00399" "provide_channel_interface.track_cs" Unread("provides an interface; `#CS TRACK` is needed to use it");
        "P-CHAN-00429" "d_prog_file" Read("the program that a D word calls", PROGRAMS);
        "P-CHAN-00433" "final_prog_file_mode" Read("the operation modes in which the program at the end runs", OUTLIVES);
        "P-CHAN-00460" "retain_last_ax_config" Read("whether the axes of the channel and their couplings outlive the program and a reset", "The axes of the channel stay");
        "P-CHAN-00498" "range_check_prog_soft_limits" Unread("limits software limit switches, which a dry run does not check");
        "P-CHAN-00553" "configuration.tool_radius_comp.fct_enable[]" Unread("enables programming of two paths, whose words are passed over");
        "P-CHAN-00799" "dynamic_model.params[].p[]" Unread(ONLY_VELOCITY);
        "P-CHAN-00829" "trafo_pcs.type" Unread(KINEMATICS);
        "P-CHAN-00854" "default_id_of_trafo_pcs" Unread(KINEMATICS);
        "P-CHAN-00875" "dynamic_model.params[].q[]" Unread(ONLY_VELOCITY);
        "P-CHAN-00879" "preserve_active_zero_offsets" Read("whether the zero offset of the last program is kept, so that positions at the start are unknown", "Offsets and tool data that are kept");
        "P-CHAN-00880" "preserve_active_tool_data" Read("whether the tool data of the last program are kept, so that positions at the start are unknown", "Offsets and tool data that are kept");
        "" "t_prog_file" Read("the program that a T word calls", PROGRAMS);
        "" "m_default_outp_ax_name[]" Unread("names the axis to which an M function is output, not what it calls");
        "" "spindel[].plc_control" Unread(SPINDLE);
    }
};

/// Returns the number of the parameter of a key, with its indices left empty.
pub(super) fn number_of(pattern: &str) -> &'static str {
    let mut rows = CHANNEL_KEYS.iter();
    let row = rows.find(|row| row.pattern() == pattern);
    row.map_or("", ChannelKey::number)
}

impl ChannelKey {
    /// Returns all keys in the order of their numbers.
    pub fn all() -> &'static [Self] {
        CHANNEL_KEYS
    }

    /// Returns the key with its indices left empty, `g800_prog_file[]`.
    pub fn pattern(&self) -> &'static str {
        self.key.pattern
    }

    /// Returns the key as lists have it, `g800_prog_file[i]`.
    pub fn key(&self) -> String {
        self.pattern().replace("[]", "[i]")
    }

    /// Returns the number of the parameter; empty where none is public.
    pub fn number(&self) -> &'static str {
        self.key.number
    }

    /// Returns the case or test that shows what the key decides; `None` for a key that is not read.
    pub fn case(&self) -> Option<&'static str> {
        match self.usage {
            KeyUse::Read(_, case) => Some(case),
            KeyUse::Unread(_) => None,
        }
    }

    /// Returns its page: what frictcomp reads from it, or why it reads nothing.
    pub fn explanation(&self) -> String {
        let number = match self.number() {
            "" => String::new(),
            number => format!(", `{number}`"),
        };
        let usage = match self.usage {
            KeyUse::Read(decides, _) => {
                format!("A key of a channel list. frictcomp reads from it {decides}.")
            }
            KeyUse::Unread(reason) => {
                format!("A key of a channel list that frictcomp does not read: it {reason}.")
            }
        };
        format!(
            "# `{}`{number}\n\n{usage}\n\nRule R2.105. Source: TF5200 channel parameters.\n",
            self.key()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Beginning of the document.
    const HEAD: &str = "# The keys of a channel list\n\n\
        Every key of a channel list that frictcomp reads, with what it decides, and every key that the public pages of the \
        channel parameters describe and that might touch flow, calls, couplings, parameters, the start or the end, with the \
        reason why nothing here depends on it. `frictcomp explain P-CHAN-00105` shows one of them. The public overview of \
        the channel parameters can be read up to P-CHAN-00024; keys beyond it were looked for by their subject, so that a \
        key that is not here is not known. Each key that is read has a case, which shows something else without its \
        lines.\n";

    #[test]
    fn each_key_has_a_row_in_the_document() {
        // R2.105
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/channel-list.md");
        let rows = CHANNEL_KEYS.iter().map(|row| {
            let (usage, case) = match row.usage {
                KeyUse::Read(decides, case) => (decides.to_owned(), case),
                KeyUse::Unread(reason) => (format!("not read: it {reason}"), ""),
            };
            format!(
                "| {} | `{}` | {usage} | {case} |\n",
                row.number(),
                row.key()
            )
        });
        let read = CHANNEL_KEYS.iter().filter(|row| row.case().is_some());
        let fresh = format!(
            "{HEAD}\nOf {} keys {} are read.\n\n| number | key | what it decides | case |\n|---|---|---|---|\n{}",
            CHANNEL_KEYS.len(),
            read.count(),
            rows.collect::<String>()
        );
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::write(path, &fresh).expect("written");
        }
        assert_eq!(std::fs::read_to_string(path).expect("the document"), fresh);
        let numbers = CHANNEL_KEYS.iter().map(ChannelKey::number);
        assert!(numbers.filter(|it| !it.is_empty()).is_sorted());
    }
}
