//! States of compensation as a column: one byte per row, and a table of the words.

use std::sync::Arc;

use arrow_array::types::Int8Type;
use arrow_array::{ArrayRef, DictionaryArray, Int8Array, StringArray};
use arrow_schema::DataType;
use frictcomp::comp::State;

/// The states in the order of their numbers. Unknown is one of them: nothing is ever missing.
pub(crate) const STATES: [State; 5] = [
    State::Active,
    State::Ineffective,
    State::Inactive,
    State::Unconfigured,
    State::Unknown,
];

/// The number of a state in a column.
pub(crate) fn number(state: State) -> i8 {
    (0..)
        .zip(STATES)
        .find_map(|(number, known)| (known == state).then_some(number))
        .expect("every state is listed")
}

/// The words of the states.
pub(crate) fn words() -> Arc<StringArray> {
    Arc::new(StringArray::from_iter_values(STATES.map(State::as_str)))
}

/// The type of a column.
pub(crate) fn data_type() -> DataType {
    DataType::Dictionary(Box::new(DataType::Int8), Box::new(DataType::Utf8))
}

/// A column of states by their numbers.
pub(crate) fn column(numbers: Vec<i8>, words: &Arc<StringArray>) -> ArrayRef {
    let numbers = Int8Array::from(numbers);
    let words = Arc::clone(words) as ArrayRef;
    let column = DictionaryArray::<Int8Type>::try_new(numbers, words);
    Arc::new(column.expect("every number has its word"))
}
