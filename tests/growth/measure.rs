//! The processor time of work, and its growth.

use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};

/// The factor that twice as much work may take (R9.90).
pub(crate) const TWICE: f64 = 2.2;

/// The time that any work may take.
const FLOOR: Duration = Duration::from_micros(200);

/// The most measurements.
const MOST: usize = 16;

/// The number of measurements that have to stay within the bound: other work on the machine slows some of them down,
/// but slow code is slow in all of them.
const ENOUGH: usize = 3;

/// The factor by which exceeding the bound is beyond doubt.
const CLEARLY: f64 = 1.15;

/// Returns the processor time of this thread.
pub(crate) fn of_thread() -> Duration {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    let seconds = u64::try_from(now.tv_sec).expect("a time since the start");
    let nanoseconds = u32::try_from(now.tv_nsec).expect("part of a second");
    Duration::new(seconds, nanoseconds)
}

fn taken(work: impl FnOnce()) -> Duration {
    let before = of_thread();
    work();
    of_thread().saturating_sub(before)
}

/// Returns the factor by which work of the greater size exceeds the bound at least, in all but a few measurements;
/// `None` if it is within the bound at once, or in enough of them.
pub(crate) fn excess(
    [small, great]: [usize; 2],
    bound: f64,
    mut work: impl FnMut(usize),
) -> Option<f64> {
    let mut within = 0;
    let mut least = f64::MAX;
    for measured in 0..MOST {
        let once = taken(|| work(small)).max(FLOOR);
        let growth = taken(|| work(great)).div_duration_f64(once);
        if growth <= bound {
            within += 1;
        } else {
            least = least.min(growth);
        }
        if within > measured || within >= ENOUGH {
            return None;
        }
        if measured >= 2 * ENOUGH && least > CLEARLY * bound {
            break;
        }
    }
    Some(least)
}
