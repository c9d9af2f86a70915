//! Programs of any length, the same bytes on every machine.

use std::io::{self, Write};

/// Blocks between two COMP commands.
const COMP_EVERY: u32 = 1000;

/// One block in so many is damaged in a [`Shape::Damaged`] program.
const DAMAGED_EVERY: u32 = 100;

/// Form of a generated program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Plain motion of X, Y and Z, with a COMP command every 1000 blocks.
    ThreeAxes,
    /// The same with the rotary axes A and B.
    FiveAxes,
    /// Three axes; one block in a hundred is damaged.
    Damaged,
    /// One loop over three blocks with two expressions.
    Loop,
}

impl Shape {
    /// Returns the shape that a name means.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        let all = [Self::ThreeAxes, Self::FiveAxes, Self::Damaged, Self::Loop];
        all.into_iter().find(|shape| format!("{shape:?}") == name)
    }

    /// Writes a program; a loop counts its passes as blocks.
    pub(crate) fn write(self, blocks: u32, out: &mut dyn Write) -> io::Result<()> {
        if self == Self::Loop {
            return write_loop(blocks / 4, out);
        }
        let mut path = Path::new();
        writeln!(out, "%BENCH")?;
        for block in 1..=blocks {
            let number = u64::from(block) * 10;
            if block % COMP_EVERY == 0 {
                let word = if block / COMP_EVERY % 2 == 1 {
                    "OFF"
                } else {
                    "ON"
                };
                writeln!(out, "N{number} X[COMP {word} FRICT]")?;
            } else if self == Self::Damaged && block % DAMAGED_EVERY == 50 {
                writeln!(out, "N{number} G01 X{} Y[ Z1.5 F1500", path.coordinate())?;
            } else {
                path.motion(number, self, out)?;
            }
        }
        writeln!(out, "M30")
    }
}

/// Writes a loop with four executed blocks a pass.
fn write_loop(passes: u32, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "%LOOP\nP2 = 0\n$FOR P1 = 1, {passes}, 1\nN10 G01 X[P1 * 0.001] F1500\nN20 P2 = P2 + P1\nN30 Y1.5\n$ENDFOR\nM30"
    )
}

/// A walk in steps that look like those of a CAM system.
struct Path {
    state: u64,
}

impl Path {
    fn new() -> Self {
        Self {
            state: 0x2545_f491_4f6c_dd1d,
        }
    }

    /// Returns the next number of a xorshift generator.
    fn next(&mut self) -> u64 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        self.state
    }

    fn coordinate(&mut self) -> String {
        let number = self.next();
        let sign = if number & 1 == 0 { "" } else { "-" };
        format!("{sign}{}.{:03}", number / 2 % 200, number / 1024 % 1000)
    }

    fn motion(&mut self, number: u64, shape: Shape, out: &mut dyn Write) -> io::Result<()> {
        let axes = match shape {
            Shape::FiveAxes => "XYZAB",
            _ => "XYZ",
        };
        write!(out, "N{number} G01")?;
        for axis in axes.chars() {
            write!(out, " {axis}{}", self.coordinate())?;
        }
        writeln!(out, " F1500")
    }
}
