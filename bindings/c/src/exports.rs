//! The functions that C sees. Handles are checked for NULL, texts for UTF-8; that a pointer leads to what
//! it was made for is the responsibility of the host, as everywhere in C.
#![allow(unsafe_code)]
#![allow(
    clippy::missing_safety_doc,
    reason = "these pages are the comments of a C header; docs/c.md has the rules for every handle"
)]

use std::ffi::{CStr, c_char};
use std::path::Path;
use std::ptr::{null, null_mut};

use crate::compensation::{FrictcompChange, FrictcompCompensation, FrictcompState};
use crate::failure::{Failure, FrictcompStatus, call, last_code, last_message};
use crate::machine::FrictcompMachine;

/// The version of frictcomp, as `0.1.0`. The text is always valid.
#[unsafe(no_mangle)]
pub extern "C" fn frictcomp_version() -> *const c_char {
    const VERSION: &CStr =
        match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
            Ok(version) => version,
            Err(_) => panic!("a version has no NUL"),
        };
    VERSION.as_ptr()
}

/// Returns why the last failing call of this thread failed, in one sentence; NULL if none has failed yet. A
/// call that succeeds changes nothing here: read it after a call that reports a failure. The text is valid
/// until the next call of this thread that fails.
#[unsafe(no_mangle)]
pub extern "C" fn frictcomp_last_error() -> *const c_char {
    last_message()
}

/// The number of that error, such as `P-ERR-70495` for an error of the control or `FC202` for one of
/// frictcomp; NULL if it has none. The text is valid until the next call of this thread that fails.
#[unsafe(no_mangle)]
pub extern "C" fn frictcomp_last_error_code() -> *const c_char {
    last_code()
}

/// Reads the machine from a start-up list of the control, with every list that it names, or from a
/// `frictcomp.toml`. The path is UTF-8. NULL if that is not possible. A machine is made despite
/// errors in the lists: check `frictcomp_machine_error_count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_machine_read(path: *const c_char) -> *mut FrictcompMachine {
    call(
        |_| null_mut(),
        || {
            let path = unsafe { text(path, "path") }?;
            FrictcompMachine::read(Path::new(path)).map(handle)
        },
    )
}

/// A machine without lists: the axes X Y Z A B C U V W, none of which has compensation until
/// `frictcomp_machine_enable` assumes it.
#[unsafe(no_mangle)]
pub extern "C" fn frictcomp_machine_unconfigured() -> *mut FrictcompMachine {
    call(
        |_| null_mut(),
        || Ok(handle(FrictcompMachine::unconfigured())),
    )
}

/// Assumes friction compensation on an axis: P-AXIS-00522 is 1 and its value list is accepted. What was
/// made from the machine before does not change. A machine without lists gets an axis that it does not have
/// if a program can name it: a capital A, B, C, U, V, W, X, Y, Z or Q, then capitals, digits or `_`, but not
/// `Q` alone, `ALL` or a word of the COMP command; from lists, only their axes are accepted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_machine_enable(
    machine: *mut FrictcompMachine,
    axis: *const c_char,
) -> FrictcompStatus {
    done(|| {
        let axis = unsafe { text(axis, "axis") }?;
        unsafe { changed(machine, "machine") }?.enable(axis)
    })
}

/// Returns the number of axes of the machine; 0 for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_machine_axis_count(machine: *const FrictcompMachine) -> usize {
    call(
        |_| 0,
        || Ok(unsafe { read(machine, "machine") }?.names().len()),
    )
}

/// The name of an axis by its position; NULL if there is none. The text is valid until the machine
/// is changed or freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_machine_axis_name(
    machine: *const FrictcompMachine,
    axis: usize,
) -> *const c_char {
    call(
        |_| null(),
        || {
            let names = unsafe { read(machine, "machine") }?.names();
            item(names, axis, "axis").map(|name| name.as_ptr())
        },
    )
}

/// Writes the position of an axis to `axis`, by its name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_machine_find(
    machine: *const FrictcompMachine,
    name: *const c_char,
    axis: *mut usize,
) -> FrictcompStatus {
    done(|| {
        let name = unsafe { text(name, "name") }?;
        let found = unsafe { read(machine, "machine") }?.find(name)?;
        *unsafe { changed(axis, "axis") }? = found.get();
        Ok(())
    })
}

/// Returns the number of messages about the lists of the machine; 0 for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_machine_message_count(
    machine: *const FrictcompMachine,
) -> usize {
    call(
        |_| 0,
        || Ok(unsafe { read(machine, "machine") }?.messages().len()),
    )
}

/// Returns the number of errors among the messages: where there is one, the control would not start with these
/// lists, or would reject one of them. `SIZE_MAX` for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_machine_error_count(machine: *const FrictcompMachine) -> usize {
    call(
        |_| usize::MAX,
        || Ok(unsafe { read(machine, "machine") }?.errors()),
    )
}

/// A message about the lists, `file:line:column: severity[code] words`; NULL if there is none. The
/// text is valid until the machine is freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_machine_message(
    machine: *const FrictcompMachine,
    message: usize,
) -> *const c_char {
    call(
        |_| null(),
        || {
            let messages = unsafe { read(machine, "machine") }?.messages();
            item(messages, message, "message").map(|line| line.as_ptr())
        },
    )
}

/// Frees a machine; NULL is ignored. What was made from it remains valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_machine_free(machine: *mut FrictcompMachine) {
    unsafe { free(machine) };
}

/// The states of every compensation on every axis after a start of the control; NULL if that is not
/// possible.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_compensation_new(
    machine: *const FrictcompMachine,
) -> *mut FrictcompCompensation {
    call(
        |_| null_mut(),
        || {
            let machine = unsafe { read(machine, "machine") }?;
            Ok(handle(FrictcompCompensation::at_startup(machine)))
        },
    )
}

/// The states that dry runs left in a state file of `frictcomp run --state`, on the same machine; NULL
/// if that is not possible. The path is UTF-8.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_compensation_read(
    machine: *const FrictcompMachine,
    path: *const c_char,
) -> *mut FrictcompCompensation {
    call(
        |_| null_mut(),
        || {
            let machine = unsafe { read(machine, "machine") }?;
            let path = unsafe { text(path, "path") }?;
            FrictcompCompensation::left_in(machine, Path::new(path)).map(handle)
        },
    )
}

/// Frees the states; NULL is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_compensation_free(compensation: *mut FrictcompCompensation) {
    unsafe { free(compensation) };
}

/// Applies one COMP command on one line, such as `X[COMP OFF FRICT]`. More than one command or line, and a
/// skip mark, whose switch only the machine has, are `FRICTCOMP_STATUS_FAULTY`. If the control refuses it, nothing is changed,
/// `FRICTCOMP_STATUS_REFUSED` is returned, and `frictcomp_last_error_code` is the control's error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_apply(
    compensation: *mut FrictcompCompensation,
    command: *const c_char,
) -> FrictcompStatus {
    done(|| {
        let states = unsafe { changed(compensation, "compensation") }?.begin();
        states.apply(unsafe { text(command, "command") }?)
    })
}

/// Applies the end of a program: friction compensation does not change.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_program_end(
    compensation: *mut FrictcompCompensation,
) -> FrictcompStatus {
    done(|| {
        unsafe { changed(compensation, "compensation") }?
            .begin()
            .program_end();
        Ok(())
    })
}

/// Applies a reset of the control.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_reset(
    compensation: *mut FrictcompCompensation,
) -> FrictcompStatus {
    done(|| {
        unsafe { changed(compensation, "compensation") }?
            .begin()
            .reset();
        Ok(())
    })
}

/// Sets a state that the host knows from elsewhere, such as the previous job. `kind` is a
/// `FrictcompKind`; `state` is active, inactive or unknown.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_set_state(
    compensation: *mut FrictcompCompensation,
    axis: usize,
    kind: u32,
    state: u32,
) -> FrictcompStatus {
    done(|| {
        unsafe { changed(compensation, "compensation") }?
            .begin()
            .set(axis, kind, state)
    })
}

/// Sets whether an axis takes part in a coupling, a `FrictcompCoupling`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_set_coupling(
    compensation: *mut FrictcompCompensation,
    axis: usize,
    coupling: u32,
) -> FrictcompStatus {
    done(|| {
        unsafe { changed(compensation, "compensation") }?
            .begin()
            .couple(axis, coupling)
    })
}

/// The state of a kind of compensation, a `FrictcompKind`, on an axis. What does not exist is unknown, and
/// `frictcomp_last_error` says why.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_state(
    compensation: *const FrictcompCompensation,
    axis: usize,
    kind: u32,
) -> FrictcompState {
    call(
        |_| FrictcompState::Unknown,
        || unsafe { read(compensation, "compensation") }?.state(axis, kind),
    )
}

/// The states that are possible for a kind of compensation, a `FrictcompKind`, on an axis, with the
/// conditions that lead to each: `inactive if V.E.MATERIAL == 2 (part.nc:12), else active`. NULL if the
/// state is known, or unknown for a reason other than a condition of a dry run. The text is
/// valid until the handle is changed or freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_possible_states(
    compensation: *const FrictcompCompensation,
    axis: usize,
    kind: u32,
) -> *const c_char {
    call(
        |_| null(),
        || {
            let states = unsafe { read(compensation, "compensation") }?;
            let words = states.possible(axis, kind)?;
            Ok(words.map_or(null(), |words| words.as_ptr()))
        },
    )
}

/// Returns the number of states that the last call with this handle changed; 0 for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_change_count(
    compensation: *const FrictcompCompensation,
) -> usize {
    call(
        |_| 0,
        || {
            Ok(unsafe { read(compensation, "compensation") }?
                .changes()
                .len())
        },
    )
}

/// Writes a change of the last call with this handle to `change`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn frictcomp_change(
    compensation: *const FrictcompCompensation,
    number: usize,
    change: *mut FrictcompChange,
) -> FrictcompStatus {
    done(|| {
        let changes = unsafe { read(compensation, "compensation") }?.changes();
        *unsafe { changed(change, "change") }? = *item(changes, number, "change")?;
        Ok(())
    })
}

fn done(work: impl FnOnce() -> Result<(), Failure>) -> FrictcompStatus {
    call(|status| status, || work().map(|()| FrictcompStatus::Ok))
}

fn handle<T>(value: T) -> *mut T {
    Box::into_raw(Box::new(value))
}

/// Frees a handle that [`handle`] made.
unsafe fn free<T>(handle: *mut T) {
    if !handle.is_null() {
        let owned = unsafe { Box::from_raw(handle) };
        call(
            |_| (),
            || {
                drop(owned);
                Ok(())
            },
        );
    }
}

unsafe fn read<'a, T>(pointer: *const T, what: &str) -> Result<&'a T, Failure> {
    unsafe { pointer.as_ref() }.ok_or_else(|| missing(what))
}

unsafe fn changed<'a, T>(pointer: *mut T, what: &str) -> Result<&'a mut T, Failure> {
    unsafe { pointer.as_mut() }.ok_or_else(|| missing(what))
}

unsafe fn text<'a>(pointer: *const c_char, what: &str) -> Result<&'a str, Failure> {
    if pointer.is_null() {
        return Err(missing(what));
    }
    let text = unsafe { CStr::from_ptr(pointer) }.to_str();
    text.map_err(|_| Failure::bad(format!("`{what}` is not UTF-8")))
}

fn missing(what: &str) -> Failure {
    Failure::bad(format!("`{what}` is NULL"))
}

fn item<'a, T>(items: &'a [T], number: usize, what: &str) -> Result<&'a T, Failure> {
    let there = items.len();
    let found = items.get(number);
    found.ok_or_else(|| Failure::bad(format!("there is no {what} {number}; there are {there}")))
}
