//! Friction compensation for hosts with their own NC interpreter that are written in C or talk to
//! C: `include/frictcomp.h` is made from this crate, `docs/c.md` shows how it is used.
//!
//! [`machine`] and [`compensation`] are what the handles of C point to, [`failure`] keeps panics inside
//! and the last error available, and [`exports`] alone touches pointers.

#[cfg(panic = "abort")]
compile_error!(
    "a panic must not end the host: build with a profile whose panics unwind, as `release` does"
);

mod compensation;
mod exports;
mod failure;
mod machine;
