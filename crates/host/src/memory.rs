//! Memory that work needs, checked before it begins.

use super::error::HostError;

/// Memory of a circular test in addition to the program itself, with room to spare.
const SIMULATION: usize = 24 << 20;

/// What a thread needs: address space for its stack and for its own heap, 128 MiB with glibc.
/// Without the heap each of its allocations takes a page.
const THREAD: usize = 136 << 20;

/// Whether there is memory for one more thread.
pub(super) fn is_there_for_a_thread() -> bool {
    available(THREAD).is_ok()
}

/// Checks the memory that a simulation needs, since the system would otherwise end the process during the
/// simulation.
///
/// # Errors
/// There is not enough.
pub fn memory_for_simulation() -> Result<(), HostError> {
    available(SIMULATION)
}

fn available(bytes: usize) -> Result<(), HostError> {
    let mut room: Vec<u8> = Vec::new();
    room.try_reserve_exact(bytes)
        .map_err(|_| HostError::Memory {
            mebibytes: bytes >> 20,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_there_is_said() {
        // R2.60
        assert!(available(1 << 10).is_ok());
        let failure = available(usize::MAX / 2).expect_err("more than any machine has");
        assert!(failure.to_string().starts_with("not enough memory"));
    }
}
