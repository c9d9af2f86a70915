//! Recorded traces of machines: what they hold, and the friction that they show.
//!
//! The bytes of a recording go in, from Scope, SINUMERIK or a plain table; a [`trace::TraceReader`] gives its
//! channels with their times. [`identify`] finds friction curves and value lists in them, and judges a value
//! list by them.

pub mod identify;
pub mod trace;
