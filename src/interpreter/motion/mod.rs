//! Motion: the modal words that it depends on, its form and its pace.

pub(super) mod block;
pub(super) mod form;
pub(super) mod modal;
pub(super) mod pace;
