//! The number of a program as long and short strokes, by which its recording is recognised.

/// Bits of the number.
const BITS: u16 = 10;

/// Strokes back and forth: the number, then the number of its set bits, modulo 4.
const STROKES: usize = 12;

/// The length of a short stroke in mm or degrees; a long one is twice as long.
const SHORT: f64 = 1.0;

/// Permitted deviation of a stroke from its length.
const TOLERANCE: f64 = 0.25;

/// Minimum standstill in s before and after the strokes; [`Signature::DWELL_S`] is programmed.
const REST_S: f64 = 1.2;

/// The time between two samples of the position in s.
const LOOK_S: f64 = 0.02;

/// Speed in mm/s or °/s below which motion is standstill: a tenth of half the feed of the strokes.
const STANDSTILL: f64 = 0.5;

/// The number of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Signature(u16);

impl Signature {
    /// The feed of the strokes in mm/min or °/min.
    pub const FEED: f64 = 600.0;

    /// Standstill before and after the strokes in s.
    pub const DWELL_S: f64 = 2.0;

    /// The greatest distance from the start in mm or degrees.
    pub const REACH: f64 = 2.0 * SHORT;

    /// Returns the signature of a number from 1 to 1023.
    pub fn new(number: u16) -> Option<Self> {
        (1..1 << BITS).contains(&number).then_some(Self(number))
    }

    /// Returns the number.
    pub fn number(self) -> u16 {
        self.0
    }

    /// Returns the lengths of the strokes in mm or degrees, each forth and then back.
    pub fn strokes(self) -> [f64; STROKES] {
        let check = u16::try_from(self.0.count_ones() % 4).unwrap_or_default();
        let bits = (self.0 << 2) | check;
        std::array::from_fn(|at| {
            let is_long = bits & (1 << (STROKES - 1 - at)) != 0;
            if is_long { 2.0 * SHORT } else { SHORT }
        })
    }
}

/// Searches the commanded or actual positions of an axis in mm or degrees, a given number of seconds apart,
/// for signatures, and returns each with the sample after its strokes.
pub fn signature_in(positions: &[f64], step_s: f64) -> Vec<(Signature, usize)> {
    let moves = Move::all(positions, step_s);
    let length = 2 * STROKES;
    let windows = moves.windows(length).enumerate();
    let found = windows.filter_map(|(at, window)| {
        let first = window.first()?;
        let last = window.last()?;
        let before = at.checked_sub(1).and_then(|it| moves.get(it));
        let began = before.map_or(0, |it| it.to);
        let next = moves.get(at + length).map_or(positions.len(), |it| it.from);
        let rests = |from: usize, to: usize| seconds(to.saturating_sub(from), step_s) >= REST_S;
        // A recording may begin within the first dwell.
        let is_alone = (before.is_none() || rests(began, first.from)) && rests(last.to, next);
        let signature = is_alone.then(|| read(window)).flatten()?;
        Some((signature, last.to))
    });
    found.collect()
}

/// Returns the number that strokes back and forth encode.
fn read(window: &[Move]) -> Option<Signature> {
    let mut bits = 0_u16;
    for stroke in window.chunks(2) {
        let [forth, back] = stroke else { return None };
        let is_back = (forth.way + back.way).abs() <= TOLERANCE;
        let is = |way: f64| (forth.way.abs() - way).abs() <= TOLERANCE;
        let bit = u16::from(is(2.0 * SHORT));
        if !is_back || (bit == 0 && !is(SHORT)) {
            return None;
        }
        bits = (bits << 1) | bit;
    }
    let signature = Signature::new(bits >> 2)?;
    (signature.0.count_ones() % 4 == u32::from(bits & 3)).then_some(signature)
}

/// A motion between two standstills.
#[derive(Debug, Clone, Copy)]
struct Move {
    from: usize,
    to: usize,
    way: f64,
}

impl Move {
    fn all(positions: &[f64], step_s: f64) -> Vec<Self> {
        let look = looks(step_s);
        let mut moves: Vec<Self> = Vec::new();
        let mut open: Option<(usize, f64)> = None;
        let mut last = (0, positions.first().copied().unwrap_or_default());
        for (at, &position) in positions.iter().enumerate().step_by(look) {
            let speed = (position - last.1) / seconds(look, step_s);
            let is_moving = speed.abs() > STANDSTILL;
            // A reversal without a standstill ends a motion, too.
            let turns = open.is_some_and(|(_, from)| (last.1 - from) * speed < 0.0);
            if let Some((from, place)) = open.filter(|_| !is_moving || turns) {
                moves.push(Self {
                    from,
                    to: last.0,
                    way: last.1 - place,
                });
                open = None;
            }
            if is_moving && open.is_none() {
                open = Some(last);
            }
            last = (at, position);
        }
        moves.extend(open.map(|(from, place)| Self {
            from,
            to: last.0,
            way: last.1 - place,
        }));
        moves
    }
}

/// Returns the number of samples between two positions.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive number of samples, bounded by the clamp"
)]
fn looks(step_s: f64) -> usize {
    (LOOK_S / step_s).round().clamp(1.0, 1e6) as usize
}

#[allow(clippy::cast_precision_loss, reason = "a number of samples")]
fn seconds(samples: usize, step_s: f64) -> f64 {
    samples as f64 * step_s
}

#[cfg(test)]
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "rows of recordings that the tests make themselves"
)]
mod tests {
    use super::*;

    const STEP_S: f64 = 0.002;

    /// Appends a standstill of some seconds.
    fn rest(places: &mut Vec<f64>, seconds: f64) {
        let place = places.last().copied().unwrap_or_default();
        places.resize(places.len() + (seconds / STEP_S) as usize, place);
    }

    /// Appends a stroke there and back at a part of the feed of the strokes.
    fn stroke(places: &mut Vec<f64>, way: f64, part: f64) {
        for to in [way, 0.0] {
            let from = places.last().copied().unwrap_or_default();
            let steps =
                ((to - from).abs() / (part * Signature::FEED / 60.0 * STEP_S)).round() as usize;
            places.extend((1..=steps).map(|at| from + (to - from) * at as f64 / steps as f64));
            rest(places, 0.2);
        }
    }

    /// Returns a program at a part of its feeds, in steps of 1 µm, with 2 µm of vibration.
    fn recorded(strokes: &[f64], inwards: f64, part: f64) -> Vec<f64> {
        let mut places = vec![0.0];
        rest(&mut places, Signature::DWELL_S);
        for way in strokes {
            stroke(&mut places, inwards * way, part);
        }
        rest(&mut places, Signature::DWELL_S);
        stroke(&mut places, inwards * 30.0, part);
        let vibrating = places.iter().enumerate();
        let vibrating = vibrating.map(|(at, place)| place + 0.002 * (at as f64 * 0.29).sin());
        vibrating
            .map(|place| (place * 1000.0).round() / 1000.0)
            .collect()
    }

    fn numbers(places: &[f64]) -> Vec<u16> {
        let found = signature_in(places, STEP_S);
        found.iter().map(|it| it.0.number()).collect()
    }

    /// R16.1: the number of a program is read in either direction, at 100 % and at 10 % override.
    #[test]
    fn a_number_is_read_at_any_override() {
        for number in [1, 64, 511, 682, 1023] {
            let strokes = Signature::new(number).expect("a number").strokes();
            for (inwards, part) in [(1.0, 1.0), (-1.0, 1.0), (1.0, 0.1)] {
                let found = numbers(&recorded(&strokes, inwards, part));
                assert_eq!(found, [number], "{inwards} {part}");
            }
        }
        assert_eq!(Signature::new(0), None);
        assert_eq!(Signature::new(1024), None);
    }

    /// R16.1: strokes that encode no number, with one too few or one of another length, are rejected.
    #[test]
    fn other_strokes_are_no_number() {
        let strokes = Signature::new(682).expect("a number").strokes();
        assert!(numbers(&recorded(&strokes[1..], 1.0, 1.0)).is_empty());
        for at in 0..strokes.len() {
            for way in [1.5, 3.0 - strokes[at]] {
                let mut others = strokes;
                others[at] = way;
                assert!(
                    numbers(&recorded(&others, 1.0, 1.0)).is_empty(),
                    "{at} {way}"
                );
            }
        }
        assert!(numbers(&[]).is_empty());
    }
}
