//! Memory that a simulation needs, asked for before it begins.

use super::failure::Failure;

/// What a circular test needs beside the program itself, with room to spare.
const SIMULATION: usize = 24 << 20;

/// A message where the system would end the process in the middle of a simulation.
pub(super) fn for_simulation() -> Result<(), Failure> {
    available(SIMULATION)
}

fn available(bytes: usize) -> Result<(), Failure> {
    let mut room: Vec<u8> = Vec::new();
    room.try_reserve_exact(bytes).map_err(|_| {
        let message = format!("not enough memory: a simulation needs {} MiB", bytes >> 20);
        Failure::new(message)
            .with_help("close other programs, or raise the limit of the shell (`ulimit -v`)")
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
        assert!(failure.message.starts_with("not enough memory"));
    }
}
