//! A search for the minimum of a function of a dozen or two variables that is not smooth.
//!
//! Ros and Hansen, *A Simple Modification in CMA-ES Achieving Linear Time and Space Complexity*,
//! PPSN X (2008): points are drawn around a mean, and mean, step and the spread along each variable
//! follow the better half of them. A crate would bring its own linear algebra and random number
//! generator; these here give the same numbers everywhere and always.

/// Points of a generation.
pub(crate) const POINTS: usize = 12;

/// Points that count, the better half.
const COUNTED: usize = POINTS / 2;

/// Seed of the random numbers; not 0.
const SEED: u64 = 0x9e37_79b9_7f4a_7c15;

/// The search: [`ask`](Self::ask) for points, [`tell`](Self::tell) their values.
#[derive(Debug, Clone)]
pub(crate) struct CmaEs {
    mean: Vec<f64>,
    step: f64,
    /// The spread along each variable, squared, in steps.
    spread: Vec<f64>,
    /// Path of the mean in spreads, for the step.
    path_of_step: Vec<f64>,
    /// Path of the mean in steps, for the spread.
    path_of_spread: Vec<f64>,
    generation: i32,
    asked: Vec<Vec<f64>>,
    random: XorShift,
}

/// Weights of the points of a generation, and the rates of adaptation.
struct Rates {
    weights: [f64; COUNTED],
    /// Effective number of points of the weights.
    worth: f64,
    step: f64,
    damping: f64,
    path: f64,
    one: f64,
    many: f64,
    /// The length of a random vector.
    length: f64,
}

impl Rates {
    fn of(variables: f64) -> Self {
        let half = real(COUNTED) + 0.5;
        let mut weights: [f64; COUNTED] = std::array::from_fn(|at| half.ln() - real(at + 1).ln());
        let sum: f64 = weights.iter().sum();
        for weight in &mut weights {
            *weight /= sum;
        }
        let worth = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let step = (worth + 2.0) / (variables + worth + 5.0);
        let excess = ((worth - 1.0) / (variables + 1.0)).sqrt() - 1.0;
        // The spread has fewer values than a matrix and learns faster.
        let faster = (variables + 2.0) / 3.0;
        let one = 2.0 / ((variables + 1.3).powi(2) + worth);
        let many = 2.0 * (worth - 2.0 + 1.0 / worth) / ((variables + 2.0).powi(2) + worth);
        Self {
            weights,
            worth,
            step,
            damping: 1.0 + step + 2.0 * excess.max(0.0),
            path: (4.0 + worth / variables) / (variables + 4.0 + 2.0 * worth / variables),
            one: (one * faster).min(0.5),
            many: (many * faster).min(0.5),
            length: variables.sqrt()
                * (1.0 - 1.0 / (4.0 * variables) + 1.0 / (21.0 * variables * variables)),
        }
    }
}

impl CmaEs {
    /// Creates a search around a point with a first step; `seed` selects the random numbers.
    pub(crate) fn new(mean: Vec<f64>, step: f64, seed: u64) -> Self {
        let variables = mean.len();
        Self {
            mean,
            step,
            spread: vec![1.0; variables],
            path_of_step: vec![0.0; variables],
            path_of_spread: vec![0.0; variables],
            generation: 0,
            asked: Vec::new(),
            random: XorShift::new(seed),
        }
    }

    /// Returns the points whose values are requested.
    pub(crate) fn ask(&mut self) -> Vec<Vec<f64>> {
        self.asked = (0..POINTS)
            .map(|_| {
                let along = self.mean.iter().zip(&self.spread);
                along
                    .map(|(mean, spread)| mean + self.step * spread.sqrt() * self.random.normal())
                    .collect()
            })
            .collect();
        self.asked.clone()
    }

    /// Takes the values of the requested points, in their order.
    pub(crate) fn tell(&mut self, values: &[f64]) {
        let variables = real(self.mean.len());
        let rates = Rates::of(variables);
        self.generation += 1;
        let mut order: Vec<usize> = (0..self.asked.len().min(values.len())).collect();
        order.sort_by(|&one, &other| values[one].total_cmp(&values[other]));
        let better: Vec<&Vec<f64>> = order
            .iter()
            .take(COUNTED)
            .map(|&at| &self.asked[at])
            .collect();
        let old = self.mean.clone();
        let mut squares = 0.0;
        for (at, mean) in self.mean.iter_mut().enumerate() {
            let weighted = better.iter().zip(rates.weights);
            *mean = weighted.map(|(point, weight)| weight * point[at]).sum();
            let moved = (*mean - old[at]) / self.step;
            let path = &mut self.path_of_step[at];
            let gain = (rates.step * (2.0 - rates.step) * rates.worth).sqrt();
            *path = (1.0 - rates.step) * *path + gain * moved / self.spread[at].sqrt();
            squares += *path * *path;
        }
        let length = squares.sqrt();
        let warm = (1.0 - (1.0 - rates.step).powi(2 * self.generation)).sqrt();
        let is_short = length / warm < (1.4 + 2.0 / (variables + 1.0)) * rates.length;
        let gain = if is_short {
            (rates.path * (2.0 - rates.path) * rates.worth).sqrt()
        } else {
            0.0
        };
        for (at, spread) in self.spread.iter_mut().enumerate() {
            let moved = (self.mean[at] - old[at]) / self.step;
            let path = &mut self.path_of_spread[at];
            *path = (1.0 - rates.path) * *path + gain * moved;
            let weighted = better.iter().zip(rates.weights);
            let width: f64 = weighted
                .map(|(point, weight)| weight * ((point[at] - old[at]) / self.step).powi(2))
                .sum();
            *spread = (1.0 - rates.one - rates.many) * *spread
                + rates.one * *path * *path
                + rates.many * width;
        }
        self.step *= (rates.step / rates.damping * (length / rates.length - 1.0)).exp();
    }
}

/// Reproducible random numbers.
#[derive(Debug, Clone)]
pub(crate) struct XorShift(u64);

impl XorShift {
    /// Creates the numbers of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(SEED ^ seed.wrapping_mul(0xd1b5_4a32_d192_ed03))
    }

    /// Returns a uniformly distributed number from 0 to 1.
    pub(crate) fn even(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        let upper = u32::try_from(self.0 >> 32).expect("32 bits");
        f64::from(upper) / f64::from(u32::MAX)
    }

    /// Returns a number below a count.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative, and below the count"
        )]
        let number = (self.even() * real(count)) as usize;
        number.min(count.saturating_sub(1))
    }

    /// Returns a normally distributed number with a variance of 1: the sum of twelve.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.even()).sum::<f64>() - 6.0
    }
}

fn real(count: usize) -> f64 {
    #[allow(clippy::cast_precision_loss)] // a few
    let real = count as f64;
    real
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_of_a_long_valley_is_found() {
        let value = |point: &Vec<f64>| {
            let terms = point.iter().enumerate();
            let far = terms.map(|(at, it)| real(at + 1) * (it - 0.3).abs());
            far.fold(0.0, f64::max)
        };
        let mut search = CmaEs::new(vec![0.0; 10], 0.2, 0);
        let mut best = f64::INFINITY;
        for _ in 0..200 {
            let values: Vec<f64> = search.ask().iter().map(value).collect();
            best = values.iter().copied().fold(best, f64::min);
            search.tell(&values);
        }
        assert!(best < 0.05, "{best}");
    }
}
