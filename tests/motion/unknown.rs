//! R5.1 and R5.4: what is not known.
