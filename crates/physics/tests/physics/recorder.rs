//! A recorder of synthetic circles: the motion of a machine around the circle, and the effects of an
//! encoder and a recorder on it.

use std::f64::consts::TAU;

use frictcomp_physics::circle::{Direction, RecordedTrace};

/// Noise from a separate generator, the same each time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Noise {
    largest_um: f64,
    state: u64,
}

impl Noise {
    pub(crate) fn of_um(largest_um: f64) -> Self {
        Self {
            largest_um,
            state: 0x9e37_79b9_7f4a_7c15,
        }
    }

    /// Returns a uniformly distributed number between plus and minus the largest, in mm.
    #[allow(clippy::cast_precision_loss)] // 32 bits of it
    fn next_mm(&mut self) -> f64 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        let share = (self.state >> 32) as f64 / f64::from(u32::MAX);
        self.largest_um / 1000.0 * (2.0 * share - 1.0)
    }
}

/// The machine, and what was recorded so far.
#[derive(Debug, Clone)]
pub(crate) struct Recorder {
    pub(crate) radius: f64,
    pub(crate) feed: f64,
    /// Samples per second.
    pub(crate) rate: f64,
    /// The step of the encoder; 0 for none.
    pub(crate) quantum_um: f64,
    pub(crate) centre: [f64; 2],
    pub(crate) start_deg: f64,
    pub(crate) noise: Noise,
    /// The current angle of the axes on the circle.
    pub(crate) angle: f64,
    pub(crate) samples: Vec<[f64; 2]>,
    /// The shift of the machine per turn, in µm.
    pub(crate) drift_um: [f64; 2],
}

impl Recorder {
    pub(crate) fn new(radius: f64) -> Self {
        Self {
            radius,
            feed: 2000.0,
            rate: 1000.0,
            quantum_um: 0.0,
            centre: [0.0; 2],
            start_deg: 0.0,
            noise: Noise::of_um(0.0),
            angle: f64::NAN,
            samples: Vec::new(),
            drift_um: [0.0; 2],
        }
    }

    fn angle(&self) -> f64 {
        if self.angle.is_nan() {
            self.start_deg.to_radians()
        } else {
            self.angle
        }
    }

    /// Returns the distance of a sample in mm.
    fn step(&self) -> f64 {
        self.feed / 60.0 / self.rate
    }

    fn take(&mut self, [x, y]: [f64; 2]) {
        let quantum = self.quantum_um / 1000.0;
        let [x, y] = [x + self.centre[0], y + self.centre[1]].map(|place| {
            let noisy = place + self.noise.next_mm();
            if quantum > 0.0 {
                (noisy / quantum).round() * quantum
            } else {
                noisy
            }
        });
        self.samples.push([x, y]);
    }

    fn on_circle(&self) -> [f64; 2] {
        let (sin, cos) = self.angle().sin_cos();
        [self.radius * cos, self.radius * sin]
    }

    /// Adds a number of turns with a radial deviation in µm.
    pub(crate) fn turns(
        mut self,
        direction: Direction,
        turns: f64,
        deviation: &dyn Fn(Direction, f64) -> f64,
    ) -> Self {
        let start = self.angle();
        let whole = turns * TAU;
        let turning = self.step() / self.radius;
        let mut way = 0.0;
        while way <= whole {
            let angle = start + direction.sign() * way;
            let radius = self.radius + deviation(direction, angle.rem_euclid(TAU)) / 1000.0;
            let [x, y] = self.drift_um.map(|um| um / 1000.0 * way / TAU);
            self.take([radius * angle.cos() + x, radius * angle.sin() + y]);
            way += turning;
        }
        self.angle = start + direction.sign() * whole;
        self
    }

    /// Adds a standstill of some seconds.
    pub(crate) fn standstill(mut self, seconds: f64) -> Self {
        let place = self.samples.last().copied();
        let place = place.map_or_else(
            || self.on_circle(),
            |[x, y]| [x - self.centre[0], y - self.centre[1]],
        );
        let mut time = 0.0;
        while time < seconds {
            self.take(place);
            time += 1.0 / self.rate;
        }
        self
    }

    /// Returns the path to the circle: the path from it, backwards.
    pub(crate) fn lead_in(
        mut self,
        lead: fn(Self, Direction) -> Self,
        direction: Direction,
    ) -> Self {
        let back = match direction {
            Direction::Ccw => Direction::Cw,
            _ => Direction::Ccw,
        };
        let empty = Self {
            samples: Vec::new(),
            ..self.clone()
        };
        let mut way = lead(empty, back);
        self.noise = way.noise;
        way.samples.reverse();
        self.samples.append(&mut way.samples);
        self
    }

    pub(crate) fn lead_out(self, lead: fn(Self, Direction) -> Self, direction: Direction) -> Self {
        lead(self, direction)
    }

    /// Returns the direction along the radius from the circle to its centre.
    pub(crate) fn radial(mut self, _: Direction) -> Self {
        let [x, y] = self.on_circle();
        let parts = (self.radius / self.step()).floor();
        let mut part = 1.0;
        while part <= parts {
            let share = 1.0 - part / parts;
            self.take([x * share, y * share]);
            part += 1.0;
        }
        self
    }

    /// Returns the direction along the tangent, away from the circle.
    pub(crate) fn tangential(mut self, direction: Direction) -> Self {
        let [x, y] = self.on_circle();
        let (sin, cos) = self.angle().sin_cos();
        let mut way = self.step();
        while way < 0.8 * self.radius {
            let along = direction.sign() * way;
            self.take([x - sin * along, y + cos * along]);
            way += self.step();
        }
        self
    }

    /// Returns half a circle of half the radius, which leaves the circle tangentially, to its centre.
    pub(crate) fn arc(mut self, direction: Direction) -> Self {
        let (sin, cos) = self.angle().sin_cos();
        let half = self.radius / 2.0;
        let turning = self.step() / half;
        let mut way = turning;
        while way < TAU / 2.0 {
            let (s, c) = (self.angle() + direction.sign() * way).sin_cos();
            self.take([half * (cos + c), half * (sin + s)]);
            way += turning;
        }
        self
    }

    /// Returns the rows with their times.
    pub(crate) fn trace(self) -> RecordedTrace {
        let mut time = 0.0;
        let mut times_s = Vec::new();
        for _ in &self.samples {
            times_s.push(time);
            time += 1.0 / self.rate;
        }
        RecordedTrace {
            points_mm: self.samples,
            times_s,
        }
    }
}

/// Returns the radial deviation of axes with backlash in µm: each lags by half of it.
pub(crate) fn backlash([x, y]: [f64; 2], direction: Direction, angle: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let turning = direction.sign();
    0.5 * turning * (x * sin.signum() * cos - y * cos.signum() * sin)
}

/// Returns the peaks in µm that friction leaves after every crossing: they rise at once and decay over this number of
/// degrees.
pub(crate) fn friction(height: f64, width_deg: f64, direction: Direction, angle: f64) -> f64 {
    let quarter = TAU / 4.0;
    let after = (direction.sign() * angle).rem_euclid(quarter).to_degrees();
    height * (-after / width_deg).exp()
}
