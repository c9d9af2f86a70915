//! Numbers in messages.

use std::fmt;

/// A number in a message: very large and very small ones with an exponent (R9.78).
pub(crate) struct Shown(pub(crate) f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size != 0.0 && size.is_finite() && !(1e-9..1e12).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_messages_stay_short() {
        // R9.78
        let shown = |number| Shown(number).to_string();
        assert_eq!(shown(1e308), "1e308");
        assert_eq!(shown(-2.5), "-2.5");
        assert_eq!(shown(1e-300), "1e-300");
        assert_eq!(shown(0.0), "0");
        assert_eq!(shown(1e9), "1000000000");
        assert_eq!(shown(f64::NAN), "NaN");
    }
}
