//! The limits of a run (R2.60).

/// Bounds on what a dry run may do (R2.60).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Limits {
    /// Executed blocks of a session.
    pub blocks: u64,
    /// Work beyond the text of the executed blocks: macros, strings that grow, regions under an
    /// unknown condition.
    pub work: u64,
    /// Units of work of blocks that are executed again, in loops and by calls: about a nanosecond each.
    /// Blocks that are executed once need none, however many there are.
    pub repeats: u64,
    /// Units of work on ways that only the machine decides, and on regions that may or may not be executed: about a
    /// nanosecond each, for each program. Past it no further way is followed, and whatever the rest could change is
    /// unknown.
    pub ways: u64,
    /// Values that are held at a time; a text counts as one more for every 32 bytes.
    pub values: u32,
    /// Depth of subprogram calls.
    pub calls: u32,
    /// Depth of nested `$` blocks.
    pub nesting: u32,
    /// Depth of macro expansion.
    pub macros: u32,
}

/// Repeated work that takes about two seconds of processor time.
const BRIEF_REPEATS: u64 = 1_500_000_000;

/// Units of ways for each unit of work: 700 million, by default.
const WAYS_PER_WORK: u64 = 70;

/// Default of the work beyond the text of the blocks.
const WORK: u64 = 10_000_000;

impl Limits {
    /// The default limits, and repeated work for about two seconds of a processor (R9.91).
    pub fn brief() -> Self {
        Self::default().with_repeats(BRIEF_REPEATS)
    }

    /// Sets [`blocks`](Self::blocks).
    pub fn with_blocks(mut self, blocks: u64) -> Self {
        self.blocks = blocks;
        self
    }

    /// Sets [`work`](Self::work), and [`ways`](Self::ways) in proportion.
    pub fn with_work(mut self, work: u64) -> Self {
        self.work = work;
        self.ways = work.saturating_mul(WAYS_PER_WORK);
        self
    }

    /// Sets [`ways`](Self::ways).
    pub fn with_ways(mut self, ways: u64) -> Self {
        self.ways = ways;
        self
    }

    /// Sets [`repeats`](Self::repeats).
    pub fn with_repeats(mut self, repeats: u64) -> Self {
        self.repeats = repeats;
        self
    }

    /// Sets [`values`](Self::values).
    pub fn with_values(mut self, values: u32) -> Self {
        self.values = values;
        self
    }

    /// Sets [`calls`](Self::calls).
    pub fn with_calls(mut self, calls: u32) -> Self {
        self.calls = calls;
        self
    }

    /// Sets [`nesting`](Self::nesting).
    pub fn with_nesting(mut self, nesting: u32) -> Self {
        self.nesting = nesting;
        self
    }

    /// Sets [`macros`](Self::macros).
    pub fn with_macros(mut self, macros: u32) -> Self {
        self.macros = macros;
        self
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            blocks: 100_000_000,
            work: WORK,
            ways: WORK * WAYS_PER_WORK,
            repeats: u64::MAX,
            values: 1_000_000,
            calls: 50,
            nesting: 50,
            macros: 16,
        }
    }
}
