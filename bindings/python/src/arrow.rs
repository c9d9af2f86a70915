//! Tables that leave Rust as a stream of Arrow batches, without a copy.

use std::ffi::CStr;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::UInt32Type;
use arrow_array::{Array, ArrayRef, RecordBatch, RecordBatchIterator};
use arrow_ipc::reader::StreamReader;
use arrow_ipc::writer::StreamWriter;
use arrow_schema::{ArrowError, Field, Schema, SchemaRef};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyCapsule};

use crate::exceptions::refused;

/// The name that the `PyCapsule` interface of Arrow gives a stream.
const STREAM: &CStr = c"arrow_array_stream";

/// A table in batches. Its buffers live as long as any part of them is in use.
#[derive(Debug, Clone)]
pub(crate) struct ArrowTable {
    pub(crate) schema: SchemaRef,
    pub(crate) batches: Vec<RecordBatch>,
}

/// A column: its name and its values.
pub(crate) type ArrowColumn = (&'static str, ArrayRef);

impl ArrowTable {
    /// A table of one batch. Only the named columns may have missing values.
    pub(crate) fn of(columns: Vec<ArrowColumn>, nullable: &[&str]) -> Self {
        let (fields, arrays): (Vec<Field>, Vec<ArrayRef>) = columns
            .into_iter()
            .map(|(name, array)| {
                let kind = array.data_type().clone();
                (Field::new(name, kind, nullable.contains(&name)), array)
            })
            .unzip();
        let schema = Arc::new(Schema::new(fields));
        let batch = RecordBatch::try_new(Arc::clone(&schema), arrays);
        Self {
            schema,
            batches: vec![
                batch.expect("the columns have one length and lack nothing they may not"),
            ],
        }
    }

    /// Returns the number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    /// The names of its columns.
    pub(crate) fn columns(&self) -> Vec<String> {
        let fields = self.schema.fields().iter();
        fields.map(|field| field.name().clone()).collect()
    }

    /// The named columns of texts and numbers, row by row, as texts.
    pub(crate) fn texts<'a>(
        &'a self,
        columns: &'a [&str],
    ) -> impl Iterator<Item = Vec<String>> + 'a {
        self.batches.iter().flat_map(move |batch| {
            (0..batch.num_rows()).map(move |row| {
                let columns = columns.iter().filter_map(|name| batch.column_by_name(name));
                columns.map(|column| text(column, row)).collect()
            })
        })
    }

    /// The table as the bytes of a stream of Arrow, to be pickled.
    pub(crate) fn pickled<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.to_bytes();
        let bytes = bytes.map_err(|error| refused(error.to_string()))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn to_bytes(&self) -> Result<Vec<u8>, ArrowError> {
        let mut writer = StreamWriter::try_new(Vec::new(), &self.schema)?;
        for batch in &self.batches {
            writer.write(batch)?;
        }
        writer.into_inner()
    }

    /// The table that was pickled.
    pub(crate) fn unpickled(bytes: &[u8]) -> PyResult<Self> {
        Self::from_bytes(bytes).map_err(|error| refused(error.to_string()))
    }

    fn from_bytes(bytes: &[u8]) -> Result<Self, ArrowError> {
        let reader = StreamReader::try_new(bytes, None)?;
        Ok(Self {
            schema: reader.schema(),
            batches: reader.collect::<Result<_, _>>()?,
        })
    }

    /// A stream of the batches for its consumer; dropped with the capsule if there is none.
    pub(crate) fn stream<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let batches = self.batches.clone().into_iter().map(Ok);
        let reader = RecordBatchIterator::new(batches, self.schema.clone());
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(reader)), STREAM)
    }
}

/// Returns a value as a text; empty if it is missing.
fn text(column: &ArrayRef, row: usize) -> String {
    if column.is_null(row) {
        return String::new();
    }
    if let Some(texts) = column.as_string_opt::<i32>() {
        return texts.value(row).to_owned();
    }
    let numbers = column.as_primitive_opt::<UInt32Type>();
    numbers.map_or_else(String::new, |numbers| numbers.value(row).to_string())
}
