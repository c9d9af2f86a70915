//! The list keys with the numbers of their parameters, for references to them (R3.40), for keys
//! that lost their underscores, and for `explain`.

use super::channel_keys::CHANNEL_KEYS;

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

/// Every key that is read or referred to (TF5200 Axis, Compensation, Channel and Start-up parameters).
pub fn known_keys() -> impl Iterator<Item = KnownKey> {
    let channel = CHANNEL_KEYS.iter().map(|row| row.key);
    KEYS.iter().copied().chain(channel)
}

/// Those that are not in a channel list.
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

/// Whether a key, with its indices left empty, is one of them.
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
