//! Random archives, and the effect of each of their programs, derived from how it was made: without
//! a parser and without an interpreter.

use std::collections::BTreeMap;
use std::fmt::Write as _;

pub(crate) const AXES: [char; 3] = ['X', 'Y', 'C'];

/// A source of random numbers, the same in every run.
pub(crate) struct XorShift(u64);

impl XorShift {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// A number below `bound`.
    pub(crate) fn roll(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 >> 33).expect("31 bits") % bound
    }

    fn chance(&mut self, percent: usize) -> bool {
        self.roll(100) < percent
    }
}

/// The effect of a block of a program.
#[derive(Debug, Clone)]
enum Block {
    Switch {
        axis: usize,
        on: bool,
        all: bool,
        line: u32,
    },
    Move {
        axes: Vec<usize>,
        rapid: bool,
        line: u32,
    },
    Note,
    Branch {
        taken: bool,
        body: Vec<Block>,
    },
    Loop {
        times: usize,
        body: Vec<Block>,
    },
    Call {
        sub: usize,
    },
}

/// A program, how it is written, and its effect.
pub(crate) struct Program {
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
    subs: Vec<Vec<Block>>,
    main: Vec<Block>,
}

/// The effect of a program on an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Expected {
    pub(crate) effect: &'static str,
    /// The line of the last command.
    pub(crate) by: Option<u32>,
    /// The line of the first motion before any command, and whether it is rapid.
    pub(crate) inherits: Option<(u32, bool)>,
}

struct Style {
    /// The first number and the step, if blocks have numbers.
    numbers: Option<(usize, usize)>,
    zeros: bool,
    end: &'static str,
    legacy: bool,
}

struct Writer<'a> {
    style: &'a Style,
    text: String,
    line: u32,
    number: usize,
}

impl Writer<'_> {
    /// Writes a line; returns its number.
    fn raw(&mut self, text: &str) -> u32 {
        self.text.push_str(text);
        self.text.push_str(self.style.end);
        self.line += 1;
        self.line
    }

    fn block(&mut self, text: &str) -> u32 {
        let Some((_, step)) = self.style.numbers else {
            return self.raw(text);
        };
        let number = self.number;
        self.number += step;
        let number = if self.style.zeros {
            format!("N{number:05} ")
        } else {
            format!("N{number} ")
        };
        self.raw(&(number + text))
    }

    fn write(&mut self, blocks: &mut [Block]) {
        for block in blocks {
            match block {
                Block::Switch {
                    axis,
                    on,
                    all,
                    line,
                } => {
                    let way = match (on, all) {
                        (true, _) => "ON FRICT",
                        (false, false) => "OFF FRICT",
                        (false, true) => "OFF_ALL",
                    };
                    *line = self.block(&format!("{}[COMP {way}]", AXES[*axis]));
                }
                Block::Move { axes, rapid, line } => {
                    let mut text = if *rapid { "G00" } else { "G01 F500" }.to_owned();
                    for axis in axes {
                        let _ = write!(text, " {}{}", AXES[*axis], self.line % 7);
                    }
                    *line = self.block(&text);
                }
                Block::Note => {
                    self.raw(if self.style.legacy {
                        "; Größe"
                    } else {
                        "; size"
                    });
                }
                Block::Branch { taken, body } => {
                    self.block(&format!("$IF {} == 1", u8::from(*taken)));
                    self.write(body);
                    self.block("$ENDIF");
                }
                Block::Loop { times, body } => {
                    self.block(&format!("$FOR P1 = 1, {times}, 1"));
                    self.write(body);
                    self.block("$ENDFOR");
                }
                Block::Call { sub } => {
                    self.block(&format!("LL SUB{sub}"));
                }
            }
        }
    }
}

fn blocks(random: &mut XorShift, depth: usize, subs: usize) -> Vec<Block> {
    let count = 1 + random.roll(5);
    let mut made = Vec::new();
    for _ in 0..count {
        made.push(match random.roll(if depth < 2 { 12 } else { 8 }) {
            0..=2 => {
                let on = random.chance(50);
                Block::Switch {
                    axis: random.roll(AXES.len()),
                    on,
                    all: !on && random.chance(30),
                    line: 0,
                }
            }
            3..=6 => {
                let mut axes: Vec<usize> = (0..AXES.len()).filter(|_| random.chance(45)).collect();
                if axes.is_empty() {
                    axes.push(random.roll(AXES.len()));
                }
                Block::Move {
                    axes,
                    rapid: random.chance(40),
                    line: 0,
                }
            }
            7 => Block::Note,
            8 | 9 => Block::Branch {
                taken: random.chance(50),
                body: blocks(random, depth + 1, subs),
            },
            10 if subs > 0 => Block::Call {
                sub: random.roll(subs),
            },
            // One loop inside another would count with the same parameter.
            _ if depth == 0 => Block::Loop {
                times: 1 + random.roll(3),
                body: blocks(random, 2, subs),
            },
            _ => Block::Note,
        });
    }
    made
}

impl Program {
    pub(crate) fn random(random: &mut XorShift, number: usize) -> Self {
        let style = Style {
            numbers: random
                .chance(70)
                .then(|| (1 + random.roll(20), 1 + random.roll(10))),
            zeros: random.chance(30),
            end: if random.chance(40) { "\r\n" } else { "\n" },
            legacy: random.chance(50),
        };
        let mut subs: Vec<Vec<Block>> = Vec::new();
        for _ in 0..random.roll(3) {
            subs.push(blocks(random, 2, 0));
        }
        let mut main = blocks(random, 0, subs.len());
        let mut writer = Writer {
            style: &style,
            text: String::new(),
            line: 0,
            number: style.numbers.map_or(0, |(first, _)| first),
        };
        for (at, sub) in subs.iter_mut().enumerate() {
            writer.raw(&format!("%L SUB{at}"));
            writer.write(sub);
            writer.block("M17");
        }
        if !subs.is_empty() || random.chance(30) {
            writer.raw(&format!("%PROGRAM{number}"));
        }
        writer.write(&mut main);
        match random.roll(4) {
            0 => {}
            1 => {
                writer.block("M02");
            }
            _ => {
                writer.block("M30");
            }
        }
        let mut text = writer.text;
        match random.roll(4) {
            0 => text.truncate(text.len() - style.end.len()),
            1 => text.push_str(style.end),
            _ => {}
        }
        let bytes = if style.legacy && random.chance(70) {
            text.chars()
                .map(|it| u8::try_from(it).expect("Latin"))
                .collect()
        } else {
            text.into_bytes()
        };
        Self {
            name: format!("p{number:02}.nc"),
            bytes,
            subs,
            main,
        }
    }

    /// The effect of the program on each axis, from how it was made.
    pub(crate) fn expected(&self) -> BTreeMap<char, Expected> {
        let mut walk = Walk {
            subs: &self.subs,
            axes: Default::default(),
        };
        walk.blocks(&self.main);
        let expected = walk.axes.into_iter().zip(AXES).map(|(axis, name)| {
            let effect = match axis.last {
                None => "keeps",
                Some((true, _)) => "leaves on",
                Some((false, _)) => "leaves off",
            };
            let by = axis.last.map(|(_, line)| line);
            (
                name,
                Expected {
                    effect,
                    by,
                    inherits: axis.inherits,
                },
            )
        });
        expected.collect()
    }
}

#[derive(Default)]
struct WalkAxis {
    last: Option<(bool, u32)>,
    inherits: Option<(u32, bool)>,
}

struct Walk<'a> {
    subs: &'a [Vec<Block>],
    axes: [WalkAxis; AXES.len()],
}

impl Walk<'_> {
    fn blocks(&mut self, blocks: &[Block]) {
        for block in blocks {
            match block {
                Block::Switch { axis, on, line, .. } => self.axes[*axis].last = Some((*on, *line)),
                Block::Move { axes, rapid, line } => {
                    for axis in axes {
                        let axis = &mut self.axes[*axis];
                        if axis.last.is_none() {
                            axis.inherits.get_or_insert((*line, *rapid));
                        }
                    }
                }
                Block::Note => {}
                Block::Branch { taken, body } => {
                    if *taken {
                        self.blocks(body);
                    }
                }
                Block::Loop { times, body } => (0..*times).for_each(|_| self.blocks(body)),
                Block::Call { sub } => self.blocks(&self.subs[*sub]),
            }
        }
    }
}
