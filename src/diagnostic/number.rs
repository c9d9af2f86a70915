//! Numbers in messages.

use std::fmt;

/// A number in a message; very large and very small ones have an exponent (R9.78).
pub struct ReadableNumber(pub f64);

impl fmt::Display for ReadableNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size != 0.0 && size.is_finite() && !(1e-9..1e12).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            // No negative zero.
            write!(f, "{}", self.0 + 0.0)
        }
    }
}

/// A number with a fixed number of decimals; a value that rounds to zero has no sign.
pub struct Rounded(pub f64, pub usize);

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{:.*}", self.1, self.0);
        let is_zero = |digits: &&str| digits.bytes().all(|it| matches!(it, b'0' | b'.'));
        let unsigned = text.strip_prefix('-').filter(is_zero);
        f.pad(unsigned.unwrap_or(&text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_rounded_to_zero_has_no_sign() {
        assert_eq!(Rounded(-0.0004, 3).to_string(), "0.000");
        assert_eq!(Rounded(-0.000_500_1, 3).to_string(), "-0.001");
        assert_eq!(format!("{:>8}", Rounded(-0.4, 0)), "       0");
        assert_eq!(format!("{:>8}", Rounded(-1.25, 1)), "    -1.2");
        assert_eq!(ReadableNumber(-0.0).to_string(), "0");
    }

    #[test]
    fn numbers_in_messages_stay_short() {
        // R9.78
        let shown = |number| ReadableNumber(number).to_string();
        assert_eq!(shown(1e308), "1e308");
        assert_eq!(shown(-2.5), "-2.5");
        assert_eq!(shown(1e-300), "1e-300");
        assert_eq!(shown(0.0), "0");
        assert_eq!(shown(1e9), "1000000000");
        assert_eq!(shown(f64::NAN), "NaN");
    }
}
