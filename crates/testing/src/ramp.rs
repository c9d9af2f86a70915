//! Motion along a path from rest to rest, with bounded acceleration and jerk.

/// Bounds of a motion along its path.
#[derive(Debug, Clone, Copy)]
pub struct Ramp {
    /// Acceleration in mm/s².
    pub acceleration: f64,
    /// Jerk in mm/s³.
    pub jerk: f64,
}

/// A motion from rest to rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    ramp: Ramp,
    length: f64,
    /// The speed between the ramps in mm/s.
    speed: f64,
    /// The duration of each ramp in s.
    ramp_s: f64,
}

impl Ramp {
    /// Returns the time in s from rest to a speed in mm/s.
    fn seconds_to(self, speed: f64) -> f64 {
        if speed >= self.acceleration.powi(2) / self.jerk {
            speed / self.acceleration + self.acceleration / self.jerk
        } else {
            2.0 * (speed / self.jerk).sqrt()
        }
    }

    /// Returns a motion over a length in mm, at most at a speed in mm/s.
    pub(crate) fn motion(self, length: f64, speed: f64) -> Motion {
        let of_ramps = |speed: f64| speed * self.seconds_to(speed);
        let mut reached = speed;
        if of_ramps(speed) > length {
            let [mut low, mut high] = [0.0, speed];
            for _ in 0..60 {
                reached = f64::midpoint(low, high);
                if of_ramps(reached) > length {
                    high = reached;
                } else {
                    low = reached;
                }
            }
        }
        Motion {
            ramp: self,
            length,
            speed: reached,
            ramp_s: self.seconds_to(reached),
        }
    }
}

impl Motion {
    /// Returns the duration in s.
    pub(crate) fn seconds(&self) -> f64 {
        let steady = self.length - self.speed * self.ramp_s;
        2.0 * self.ramp_s + steady.max(0.0) / self.speed.max(1e-12)
    }

    /// Returns the distance in mm and the speed in mm/s at a time in s.
    pub(crate) fn at(&self, time: f64) -> (f64, f64) {
        let whole = self.seconds();
        if time <= 0.0 {
            (0.0, 0.0)
        } else if time < self.ramp_s {
            self.rising(time)
        } else if time <= whole - self.ramp_s {
            (self.speed * (time - self.ramp_s / 2.0), self.speed)
        } else if time < whole {
            let (left, speed) = self.rising(whole - time);
            (self.length - left, speed)
        } else {
            (self.length, 0.0)
        }
    }

    fn rising(&self, time: f64) -> (f64, f64) {
        let Ramp { acceleration, jerk } = self.ramp;
        let rise = (acceleration / jerk).min(self.ramp_s / 2.0);
        let peak = jerk * rise;
        let steady = self.ramp_s - rise;
        if time <= rise {
            (jerk * time.powi(3) / 6.0, jerk * time.powi(2) / 2.0)
        } else if time <= steady {
            let (way, speed) = (jerk * rise.powi(3) / 6.0, jerk * rise.powi(2) / 2.0);
            let since = time - rise;
            (
                way + speed * since + peak * since.powi(2) / 2.0,
                speed + peak * since,
            )
        } else {
            let left = self.ramp_s - time;
            let way = self.speed * self.ramp_s / 2.0;
            (
                way - self.speed * left + jerk * left.powi(3) / 6.0,
                self.speed - jerk * left.powi(2) / 2.0,
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_is_smooth_and_ends_where_it_should() {
        for (acceleration, jerk, length, speed) in [
            (2000.0, 50_000.0, 300.0, 80.0),
            (500.0, 5000.0, 3.0, 80.0),
            (500.0, 5000.0, 100.0, 10.0),
        ] {
            let motion = Ramp { acceleration, jerk }.motion(length, speed);
            let mut way = 0.0;
            let steps = 20_000;
            let step = motion.seconds() / f64::from(steps);
            for at in 0..steps {
                let (place, now) = motion.at((f64::from(at) + 0.5) * step);
                way += now * step;
                assert!(now <= speed * (1.0 + 1e-9));
                assert!((place - (way - now * step / 2.0)).abs() < 1e-3 * length);
            }
            assert!((way - length).abs() < 1e-4 * length, "{way} {length}");
        }
    }
}
