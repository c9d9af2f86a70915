//! The rounding of transitions between blocks (R11.21): the parameters of `#CONTOUR MODE` and `#HSC`.
//!
//! PM/n is page n of the TF5200 programming manual.

use serde::{Deserialize, Serialize};

use crate::language::ContouringCommand;
use crate::syntax::ast::{Argument, BracketArguments};

/// Rounding of transitions between blocks. Lengths are in mm; `None` means no limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Contouring {
    /// Permitted deviation from the programmed path; 0 where it is not known.
    pub tolerance_mm: Option<f64>,
    /// Permitted length off the programmed blocks, before and after a corner.
    pub distance_mm: Option<f64>,
    /// The largest share of a block that a corner takes at either end.
    pub reach: f64,
    /// The sharpest corner that is rounded, in degrees.
    pub max_angle_deg: Option<f64>,
    /// Blocks that become one curve.
    pub joining: Joining,
    /// Whether the path becomes a spline, `OPMODE 2` (R2.111).
    pub is_spline: bool,
}

/// Selection of the straight blocks that become one curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Joining {
    /// Those that follow a curve already, within a fraction of a µm (R11.22).
    Fine,
    /// All within the tolerance.
    WithinTolerance,
}

/// Default of `PATH_DEV` and `PRE_DIST` (PM/475164939, PM/475180811).
const CONTOUR_MM: f64 = 1.0;
/// Default of `CONTERROR` (PM/207285131).
const CONTOUR_ERROR_MM: f64 = 0.1;
/// Default of `PATH_DEV` and `MAX_ANGLE` of B-splines (PM/207308683).
const SPLINE_MM: f64 = 0.2;
const SPLINE_ANGLE_DEG: f64 = 5.0;

impl ContouringCommand {
    /// Returns the parameters in the bracket of the command; `number` gives the value of an expression.
    /// A value that is not named is that of `before`; in a bracket of `#CONTOUR MODE` with a mode, and in
    /// any bracket of `#HSC`, it is the default.
    pub(crate) fn parameters(
        self,
        before: Contouring,
        (arguments, text): (&BracketArguments, &str),
        mut number: impl FnMut(&Argument) -> Option<f64>,
    ) -> Contouring {
        let has = |word: &str| arguments.has(word, text);
        // `Some(None)` is a value that is not known.
        let mut value = |key: &str| arguments.after(key, text).map(&mut number);
        match self {
            Self::Contour => {
                let mut next = before;
                if has("DEV") || has("PTP") {
                    next = Contouring::default();
                } else if has("DIST") || has("POS") || has("DIST_SOFT") || has("DIST_MASTER") {
                    next = Contouring {
                        tolerance_mm: None,
                        distance_mm: Some(CONTOUR_MM),
                        ..Contouring::default()
                    };
                }
                if let Some(given) = value("PATH_DEV") {
                    next.tolerance_mm = Some(given.unwrap_or(0.0).max(0.0));
                }
                let keys = ["PRE_DIST", "POST_DIST", "PATH_DIST", "SYM_DIST"];
                let distances = keys.into_iter().filter_map(&mut value);
                let shortest = distances
                    .map(|given| given.unwrap_or(0.0))
                    // -1 switches a distance off (PM/475198987).
                    .filter(|distance| *distance >= 0.0)
                    .reduce(f64::min);
                next.distance_mm = shortest.or(next.distance_mm);
                if let Some(given) = value("REMAIN_PART") {
                    let remains = given.map_or(1.0, |percent| percent / 100.0);
                    next.reach = (1.0 - remains.clamp(0.0, 1.0)) / 2.0;
                }
                next
            }
            Self::HighSpeed => {
                let spline = has("BSPLINE") || has("SURFACE");
                let mut next = if arguments.iter().next().is_none() {
                    before
                } else {
                    Contouring::high_speed()
                };
                next.is_spline |= has("BSPLINE");
                if spline {
                    next.tolerance_mm = Some(SPLINE_MM);
                    next.max_angle_deg = Some(SPLINE_ANGLE_DEG);
                }
                if let Some(given) = value("OPMODE")
                    && given != Some(1.0)
                {
                    next.tolerance_mm = None;
                    next.is_spline = given.is_none_or(|mode| (mode - 2.0).abs() < 0.5);
                }
                for key in ["CONTERROR", "PATH_DEV"] {
                    match value(key) {
                        // 0 means no monitoring (PM/207308683).
                        Some(Some(0.0)) if key == "PATH_DEV" => next.tolerance_mm = None,
                        Some(given) => next.tolerance_mm = Some(given.unwrap_or(0.0).max(0.0)),
                        None => {}
                    }
                }
                if let Some(given) = value("MAX_ANGLE") {
                    next.max_angle_deg = given.filter(|angle| *angle > 0.0);
                }
                next
            }
        }
    }
}

impl Default for Contouring {
    /// `#CONTOUR MODE` at the start of a program: `DEV` with 1 mm (PM/475164939).
    fn default() -> Self {
        Self {
            tolerance_mm: Some(CONTOUR_MM),
            distance_mm: None,
            reach: 0.5,
            max_angle_deg: None,
            joining: Joining::Fine,
            is_spline: false,
        }
    }
}

impl Contouring {
    /// `#HSC ON` without parameters: `OPMODE 1` (PM/207285131).
    pub(crate) fn high_speed() -> Self {
        Self {
            tolerance_mm: Some(CONTOUR_ERROR_MM),
            joining: Joining::WithinTolerance,
            ..Self::default()
        }
    }

    /// Parameters that are not known: nothing is rounded.
    pub(crate) fn unknown(self) -> Self {
        Self {
            tolerance_mm: Some(0.0),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpreter::motion::pace::plain_number;
    use crate::language::HashAction;
    use crate::syntax::ast::Item;
    use crate::syntax::parse_block;

    fn of(command: &str, bracket: &str) -> Contouring {
        let text = format!("{command} {bracket}");
        let block = parse_block(&text);
        let [Item::Hash(hash)] = block.items.as_slice() else {
            panic!("{text}")
        };
        let HashAction::Round(command) = hash.command.action else {
            panic!("{text}")
        };
        let before = match command {
            ContouringCommand::Contour => Contouring::default(),
            ContouringCommand::HighSpeed => Contouring::high_speed(),
        };
        command.parameters(before, (&hash.brackets, &text), plain_number)
    }

    #[test]
    fn parameters_are_those_of_the_bracket() {
        // R11.21
        let contour = |bracket| of("#CONTOUR MODE", bracket);
        assert_eq!(contour("").tolerance_mm, Some(1.0));
        assert_eq!(contour("[DEV PATH_DEV=0.25]").tolerance_mm, Some(0.25));
        assert_eq!(contour("[dev path_dev = 0.5 ]").tolerance_mm, Some(0.5));
        assert_eq!(contour("[DEV PATH_DEV=V.P.A]").tolerance_mm, Some(0.0));
        let distance = contour("[DIST PRE_DIST=3 POST_DIST=2]");
        assert_eq!(
            (distance.tolerance_mm, distance.distance_mm),
            (None, Some(2.0))
        );
        assert!((contour("[DEV REMAIN_PART=20]").reach - 0.4).abs() < 1e-12);
        let fast = |bracket| of("#HSC", bracket);
        assert_eq!(fast("").tolerance_mm, Some(0.1));
        assert_eq!(fast("[OPMODE 1 CONTERROR 0.01]").tolerance_mm, Some(0.01));
        assert_eq!(fast("[OPMODE 2]").tolerance_mm, None);
        let spline = fast("[BSPLINE PATH_DEV=0.05 MAX_ANGLE=10]");
        assert_eq!(
            (spline.tolerance_mm, spline.max_angle_deg),
            (Some(0.05), Some(10.0))
        );
        assert_eq!(fast("[BSPLINE PATH_DEV=0]").tolerance_mm, None);
    }
}
