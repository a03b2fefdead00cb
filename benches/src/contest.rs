//! Contenders that take turns, so that a machine that slows down slows all of them.

use std::time::Instant;

/// Some rays, and how often they are shot.
pub(crate) struct Contest<'a> {
    /// What the rays are.
    pub(crate) name: &'static str,
    /// How many.
    pub(crate) rays: usize,
    /// How often each contender shoots them all.
    pub(crate) rounds: usize,
    /// How far a ray goes, by exhaustive search in doubles: asked where answers differ.
    pub(crate) judge: &'a dyn Fn(usize) -> f64,
}

/// One way to shoot the rays; writes how far each goes.
pub(crate) struct Contender<'a> {
    /// What it is called.
    pub(crate) name: &'static str,
    /// Shoots all rays.
    pub(crate) shoot: &'a mut dyn FnMut(&mut [f32]),
}

impl Contest<'_> {
    /// Prints rates, ratios to the first contender, and how many answers differ from its.
    pub(crate) fn run(&self, mut contenders: Vec<Contender<'_>>) {
        let mut answers = vec![vec![f32::INFINITY; self.rays]; contenders.len()];
        let mut seconds = vec![Vec::new(); contenders.len()];
        for _ in 0..self.rounds {
            for (i, contender) in contenders.iter_mut().enumerate() {
                let start = Instant::now();
                (contender.shoot)(&mut answers[i]);
                seconds[i].push(start.elapsed().as_secs_f64());
            }
        }
        println!(
            "\n{:16} {:>10} {:>8} {:>14} {:>14}",
            self.name, "Mray/s", "ratio", "other answers", "of them right"
        );
        for (i, contender) in contenders.iter().enumerate() {
            let ratios: Vec<f64> =
                seconds[0].iter().zip(&seconds[i]).map(|(first, this)| first / this).collect();
            let rate = self.rays as f64 / median(&seconds[i]) / 1e6;
            let other: Vec<usize> =
                (0..self.rays).filter(|&ray| differ(answers[0][ray], answers[i][ray])).collect();
            let right = other.iter().take(JUDGED);
            let right = right.filter(|&&ray| !differ((self.judge)(ray) as f32, answers[i][ray]));
            println!(
                "{:16} {rate:>10.2} {:>8.2} {:>14} {:>14}",
                contender.name,
                median(&ratios),
                other.len(),
                right.count(),
            );
        }
    }
}

/// Most answers that are judged by exhaustive search.
const JUDGED: usize = 1000;

/// Whether two distances are not nearly the same.
fn differ(a: f32, b: f32) -> bool {
    a.is_finite() != b.is_finite() || (a - b).abs() > 1e-3 * a.abs().max(b.abs())
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}
