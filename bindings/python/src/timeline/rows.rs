//! The executed blocks of a session on their way into columns.

use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::builder::{Int64Builder, StringBuilder, UInt32Builder};
use arrow_array::types::Int32Type;
use arrow_array::{
    ArrayRef, DictionaryArray, Float64Array, Int32Array, ListArray, RecordBatch, StringArray,
    StructArray, UInt32Array, UInt64Array,
};
use arrow_buffer::OffsetBuffer;
use arrow_schema::{DataType, Field, Fields, Schema, SchemaRef};
use frictcomp::comp::{AxisIndex, Kind, KindSet};
use frictcomp::interpreter::PositionFrame;
use frictcomp::timeline::{Row, StateView};

use crate::arrow::ArrowTable;
use crate::states;

/// The maximum number of blocks in a batch.
const ROWS: usize = 1 << 17;

/// The maximum number of bytes of text in a batch, far below the range of its offsets.
const TEXT: usize = 1 << 29;

/// The content of the columns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShownColumns {
    /// The kinds of compensation. Friction compensation is always shown.
    pub(crate) kinds: KindSet,
    /// Whether positions are shown.
    pub(crate) positions: bool,
}

/// Rows of all blocks so far.
pub(crate) struct BlockRows {
    shown: ShownColumns,
    files: Files,
    /// The states after the last block that was seen, by axis and kind.
    states: Vec<i8>,
    version: Option<u64>,
    full: Vec<Batch>,
    batch: Batch,
}

/// The names of files, each once.
#[derive(Default)]
struct Files {
    names: Vec<String>,
    numbers: HashMap<String, i32>,
    /// File of the last block: most blocks follow one of the same file.
    last: i32,
}

/// Some blocks.
#[derive(Default)]
struct Batch {
    program: Vec<u32>,
    seq: Vec<u64>,
    file: Vec<i32>,
    line: Vec<u32>,
    number: Int64Builder,
    level: UInt32Builder,
    text: StringBuilder,
    /// Runs of blocks with the same states: how many, and the states.
    runs: Vec<(usize, Vec<i8>)>,
    positions: Vec<Vec<Option<f64>>>,
    frames: Vec<i32>,
    changes: Changes,
    codes: Codes,
    branch: StringBuilder,
}

/// Changes made by the blocks.
#[derive(Default)]
struct Changes {
    ends: Vec<i32>,
    axis: StringBuilder,
    kind: StringBuilder,
    from: StringBuilder,
    to: StringBuilder,
}

/// The codes of the messages about the blocks. Messages at the end of a program join those of
/// its last block, as in CSV.
#[derive(Default)]
struct Codes {
    ends: Vec<i32>,
    words: StringBuilder,
    is_open: bool,
}

impl Files {
    fn number(&mut self, name: &str) -> i32 {
        let last = usize::try_from(self.last).unwrap_or_default();
        if self.names.get(last).is_some_and(|last| last == name) {
            return self.last;
        }
        let next = i32::try_from(self.names.len()).expect("there are fewer files than that");
        self.last = *self.numbers.entry(name.to_owned()).or_insert(next);
        if self.last == next {
            self.names.push(name.to_owned());
        }
        self.last
    }
}

impl BlockRows {
    /// Creates empty rows.
    pub(crate) fn new(shown: ShownColumns) -> Self {
        Self {
            shown,
            files: Files::default(),
            states: Vec::new(),
            version: None,
            full: Vec::new(),
            batch: Batch::default(),
        }
    }

    fn kinds(&self) -> impl Iterator<Item = Kind> + use<> {
        let others = self.shown.kinds.iter().filter(|kind| *kind != Kind::Frict);
        let others: Vec<Kind> = others.collect();
        std::iter::once(Kind::Frict).chain(others)
    }

    /// Adds a block.
    pub(crate) fn push(&mut self, row: &Row<'_>) {
        if self.batch.is_full() {
            let full = std::mem::take(&mut self.batch);
            self.full.push(full.closed());
        }
        self.keep_states(row.state);
        let batch = &mut self.batch;
        batch.program.push(row.program);
        batch.seq.push(row.seq);
        batch.file.push(self.files.number(row.file));
        batch.line.push(row.line);
        batch.number.append_option(row.number);
        batch.level.append_option(row.level);
        batch.text.append_value(row.text);
        if let Some((blocks, _)) = batch.runs.last_mut() {
            *blocks += 1;
        }
        if self.shown.positions {
            batch.push_positions(row);
        }
        for change in row.changes {
            if self.shown.kinds.contains(change.kind) {
                batch.changes.axis.append_value(row.state.name(change.axis));
                batch.changes.kind.append_value(change.kind.as_str());
                batch.changes.from.append_value(change.from.as_str());
                batch.changes.to.append_value(change.to.as_str());
            }
        }
        batch.changes.ends.push(end_of(&batch.changes.axis));
        batch.codes.close();
        batch.codes.is_open = true;
        for said in row.diagnostics {
            batch.codes.words.append_value(said.code.as_str());
        }
        batch.branch.append_option(row.branch_in_words());
    }

    /// A code about the program as a whole, which belongs to its last block.
    pub(crate) fn push_code(&mut self, code: &str) {
        if self.batch.codes.is_open {
            self.batch.codes.words.append_value(code);
        }
    }

    /// A program has ended.
    pub(crate) fn end(&mut self) {
        self.batch.codes.close();
    }

    fn keep_states(&mut self, state: StateView<'_>) {
        let is_new = self.version != Some(state.version);
        if is_new {
            self.version = Some(state.version);
            self.states.clear();
            for axis in 0..state.machine.axes.len() {
                let axis = AxisIndex::new(axis);
                let kinds = self.kinds();
                let numbers = kinds.map(|kind| states::number(state.state(axis, kind)));
                self.states.extend(numbers);
            }
        }
        if is_new || self.batch.runs.is_empty() {
            self.batch.runs.push((0, self.states.clone()));
        }
    }

    /// The table of all blocks, with the axes that are listed at the end.
    pub(crate) fn into_table(mut self, end: StateView<'_>) -> ArrowTable {
        let kinds: Vec<Kind> = self.kinds().collect();
        let axes: Vec<(usize, &str)> = end.axes().map(|(at, name)| (at.get(), name)).collect();
        let last = std::mem::take(&mut self.batch);
        if !last.program.is_empty() || self.full.is_empty() {
            self.full.push(last.closed());
        }
        let columns = BatchColumns {
            schema: schema(&axes, &kinds, self.shown.positions),
            axes: axes.iter().map(|(at, _)| *at).collect(),
            kinds: kinds.len(),
            positions: self.shown.positions,
            files: Arc::new(StringArray::from(self.files.names)),
            states: states::words(),
            frames: Arc::new(StringArray::from(vec!["machine", "programmed"])),
        };
        let batches = self.full.into_iter().map(|batch| columns.of(batch));
        ArrowTable {
            batches: batches.collect(),
            schema: columns.schema.clone(),
        }
    }
}

impl Batch {
    fn is_full(&self) -> bool {
        let texts = [&self.text, &self.branch];
        self.program.len() >= ROWS || texts.iter().any(|it| it.values_slice().len() >= TEXT)
    }

    fn push_positions(&mut self, row: &Row<'_>) {
        let axes = row.state.machine.axes.len();
        self.positions.resize_with(axes, Vec::new);
        let mut frame = 0;
        for (at, column) in self.positions.iter_mut().enumerate() {
            let position = row.modal.position(AxisIndex::new(at));
            // Rounded to a nanometre, as in CSV.
            column.push(position.value.map(|value| (value * 1e6).round() / 1e6));
            frame = i32::from(position.frame != PositionFrame::Machine);
        }
        self.frames.push(frame);
    }

    fn closed(mut self) -> Self {
        self.codes.close();
        self
    }
}

impl Codes {
    fn close(&mut self) {
        if self.is_open {
            self.ends.push(end_of(&self.words));
            self.is_open = false;
        }
    }
}

fn end_of(words: &StringBuilder) -> i32 {
    use arrow_array::builder::ArrayBuilder;
    i32::try_from(words.len()).expect("a batch has few changes and codes")
}

/// The columns of a table, and what its batches share.
struct BatchColumns {
    schema: SchemaRef,
    /// The axes that have a column.
    axes: Vec<usize>,
    /// Number of kinds of each axis.
    kinds: usize,
    positions: bool,
    files: Arc<StringArray>,
    states: Arc<StringArray>,
    frames: Arc<StringArray>,
}

impl BatchColumns {
    fn of(&self, mut batch: Batch) -> RecordBatch {
        let mut arrays: Vec<ArrayRef> = vec![
            Arc::new(UInt32Array::from(batch.program)),
            Arc::new(UInt64Array::from(batch.seq)),
            words(batch.file, &self.files),
            Arc::new(UInt32Array::from(batch.line)),
            Arc::new(batch.number.finish()),
            Arc::new(batch.level.finish()),
            Arc::new(batch.text.finish()),
        ];
        for axis in &self.axes {
            for kind in 0..self.kinds {
                let at = axis * self.kinds + kind;
                let runs = batch.runs.iter();
                let numbers =
                    runs.flat_map(|(blocks, states)| std::iter::repeat_n(states[at], *blocks));
                arrays.push(states::column(numbers.collect(), &self.states));
            }
        }
        if self.positions {
            batch
                .positions
                .resize_with(self.axes.iter().max().map_or(0, |it| it + 1), Vec::new);
            for axis in &self.axes {
                let column = std::mem::take(&mut batch.positions[*axis]);
                arrays.push(Arc::new(Float64Array::from(column)));
            }
            arrays.push(words(batch.frames, &self.frames));
        }
        arrays.push(batch.changes.finish());
        arrays.push(batch.codes.finish());
        arrays.push(Arc::new(batch.branch.finish()));
        let made = RecordBatch::try_new(self.schema.clone(), arrays);
        made.expect("each block gave every column one value")
    }
}

impl Changes {
    fn finish(mut self) -> ArrayRef {
        let parts: Vec<ArrayRef> = [&mut self.axis, &mut self.kind, &mut self.from, &mut self.to]
            .map(|part| Arc::new(part.finish()) as ArrayRef)
            .into();
        list(self.ends, Arc::new(StructArray::new(change(), parts, None)))
    }
}

impl Codes {
    fn finish(mut self) -> ArrayRef {
        list(self.ends, Arc::new(self.words.finish()))
    }
}

/// The parts of a change.
fn change() -> Fields {
    ["axis", "kind", "from", "to"]
        .map(|name| Field::new(name, DataType::Utf8, false))
        .into_iter()
        .collect()
}

fn item(kind: DataType) -> Arc<Field> {
    Arc::new(Field::new("item", kind, false))
}

fn list(ends: Vec<i32>, items: ArrayRef) -> ArrayRef {
    let offsets: Vec<i32> = std::iter::once(0).chain(ends).collect();
    let item = item(items.data_type().clone());
    let offsets = OffsetBuffer::new(offsets.into());
    Arc::new(ListArray::new(item, offsets, items, None))
}

fn words(numbers: Vec<i32>, words: &Arc<StringArray>) -> ArrayRef {
    let words = Arc::clone(words) as ArrayRef;
    let column = DictionaryArray::<Int32Type>::try_new(Int32Array::from(numbers), words);
    Arc::new(column.expect("every number has its word"))
}

/// The columns that every timeline has before those of the axes, and after them.
const BEFORE: [&str; 7] = ["program", "seq", "file", "line", "n", "level", "text"];
const AFTER: [&str; 4] = ["frame", "changes", "codes", "branch"];

/// The name of the column of a state: that of the axis, `X.LEAD` for other kinds, and
/// `X.FRICT` where an axis has the name of another column.
pub(super) fn state_name(axis: &str, kind: Kind) -> String {
    let is_taken = BEFORE.contains(&axis) || AFTER.contains(&axis);
    if kind == Kind::Frict && !is_taken {
        axis.to_owned()
    } else {
        format!("{axis}.{}", kind.as_str())
    }
}

fn schema(axes: &[(usize, &str)], kinds: &[Kind], positions: bool) -> SchemaRef {
    let named = DataType::Dictionary(Box::new(DataType::Int32), Box::new(DataType::Utf8));
    let types = [
        (DataType::UInt32, false),
        (DataType::UInt64, false),
        (named.clone(), false),
        (DataType::UInt32, false),
        (DataType::Int64, true),
        (DataType::UInt32, true),
        (DataType::Utf8, false),
    ];
    let before = BEFORE.into_iter().zip(types);
    let mut fields: Vec<Field> = before
        .map(|(name, (kind, nullable))| Field::new(name, kind, nullable))
        .collect();
    for (_, axis) in axes {
        let states = kinds.iter();
        fields.extend(
            states.map(|kind| Field::new(state_name(axis, *kind), states::data_type(), false)),
        );
    }
    if positions {
        let positions = axes.iter();
        fields.extend(
            positions.map(|(_, axis)| Field::new(format!("{axis}_pos"), DataType::Float64, true)),
        );
        fields.push(Field::new(AFTER[0], named, false));
    }
    let changes = DataType::List(item(DataType::Struct(change())));
    fields.push(Field::new(AFTER[1], changes, false));
    let codes = DataType::List(item(DataType::Utf8));
    fields.push(Field::new(AFTER[2], codes, false));
    fields.push(Field::new(AFTER[3], DataType::Utf8, true));
    Arc::new(Schema::new(fields))
}
