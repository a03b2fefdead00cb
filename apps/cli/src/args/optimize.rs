//! The command line of `nestray optimize`.

use std::path::PathBuf;
use std::time::Duration;

use nestray::render::ray_counts::RayCounts;

/// `nestray optimize`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    nestray optimize builtin:truss -o truss.plan.json\n  \
    nestray optimize scene.gltf -o plan.json --budget 2000evals --seed 7 --report search.html\n  \
    nestray optimize scene.gltf -o plan.json --weights camera=1,shadow=1 --rays-expected 1e9\n  \
    nestray render scene.gltf -o out.png --plan plan.json\n\n\
    The same scene, seed and number of plans (evals) find the same plans; which of them is fastest \
    is measured.")]
pub(crate) struct OptimizeArgs {
    /// A file, `-` for standard input, or `builtin:NAME`.
    pub(crate) scene: String,
    /// Where the plan goes, .json; `-` for standard output.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// How long to search, as in 30s or 2m, or how many plans to try, as in 2000evals; timing
    /// takes about as long again.
    #[arg(long, default_value = "4s", value_parser = budget)]
    pub(crate) budget: Budget,
    /// Techniques that plans may use; all if none is named.
    #[arg(long, value_name = "TECHNIQUE,…", value_delimiter = ',')]
    pub(crate) techniques: Vec<String>,
    /// A plan to begin with, besides the usual ones.
    #[arg(long, value_name = "PLAN")]
    pub(crate) start: Option<PathBuf>,
    /// Nodes of `--start` that every plan must hold as they are, by their paths, as
    /// `root/nest/children/1`; the usual plans, which do not, are then not tried.
    #[arg(long, value_name = "NODE,…", value_delimiter = ',', requires = "start")]
    pub(crate) pin: Vec<String>,
    /// How many rays of each kind come with each other: camera, shadow, reflect, diffuse, chords.
    #[arg(
        long,
        value_name = "KIND=NUMBER,…",
        default_value = "camera=1,shadow=4,reflect=1,diffuse=4"
    )]
    #[arg(value_parser = weights)]
    pub(crate) weights: Weights,
    /// Most rays of each kind to search and time with. [default: 65536]
    #[arg(long, value_parser = super::values::rays)]
    pub(crate) rays: Option<usize>,
    /// Rays that the plan will serve: what building takes is spread over them.
    #[arg(long, value_name = "NUMBER", default_value_t = 1e7, value_parser = many)]
    pub(crate) rays_expected: f64,
    /// Most memory of the nest, in bytes, or as in 500M or 4G.
    #[arg(long, value_name = "BYTES", value_parser = memory)]
    pub(crate) max_memory: Option<u64>,
    /// Prices of steps and tests, as `nestray calibrate -o` writes them, or `usual`: those that come
    /// with the program. [default: those of the cache, or the usual]
    #[arg(long, value_name = "FILE")]
    pub(crate) prices: Option<PathBuf>,
    /// Another number searches other ways.
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
    /// Turns of each plan that is timed.
    #[arg(long, default_value_t = 5, value_parser = super::values::rounds)]
    pub(crate) rounds: usize,
    /// Write all that was tried and timed: as a page with drawings if the name ends with .html, else
    /// as JSON; may be given several times.
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Vec<PathBuf>,
}

/// What may be spent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Budget {
    Time(Duration),
    Plans(usize),
}

fn budget(text: &str) -> Result<Budget, String> {
    let wrong = "expected is a time, as in 30s or 2m, or a number of plans, as in 2000evals";
    if let Some(number) = text.strip_suffix("evals") {
        return number.trim().parse().map(Budget::Plans).map_err(|_| wrong.into());
    }
    time(text).map(Budget::Time).map_err(|_| wrong.into())
}

/// A time with its unit.
pub(super) fn time(text: &str) -> Result<Duration, String> {
    /// More than anybody waits, in seconds.
    const MOST: f64 = 1e7;
    let wrong = || "expected is a time, as in 30s or 2m".to_owned();
    let (number, unit) = match (text.strip_suffix("ms"), text.strip_suffix('s')) {
        (Some(number), _) => (number, 1e-3),
        (_, Some(number)) => (number, 1.0),
        _ => (text.strip_suffix('m').ok_or_else(wrong)?, 60.0),
    };
    let seconds = number.trim().parse::<f64>().map_err(|_| wrong())? * unit;
    if !(0.0..=MOST).contains(&seconds) {
        return Err(wrong());
    }
    Ok(Duration::from_secs_f64(seconds))
}

/// How many rays of each kind come with each other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Weights(Vec<(String, f64)>);

/// Kinds that can be weighed.
const KINDS: &[&str] = &["camera", "shadow", "reflect", "diffuse", "chords"];

impl Weights {
    /// All kinds, one as often as the other.
    pub(crate) fn all() -> Self {
        Self(KINDS.iter().map(|&kind| (kind.to_owned(), 1.0)).collect())
    }

    /// Of rays of a kind; 0 if none was said.
    pub(crate) fn of(&self, kind: &str) -> f64 {
        self.0.iter().find(|(name, _)| name == kind).map_or(0.0, |&(_, weight)| weight)
    }
}

impl Weights {
    /// As many as there were.
    pub(crate) fn counted(rays: &RayCounts) -> Self {
        let weight = |name: &str, count: u64| (name.to_owned(), count as f64);
        // The log has no refracted rays; they start where mirrored ones do, and are as scattered.
        Self(vec![
            weight("camera", rays.camera.cast),
            weight("shadow", rays.shadow.cast),
            weight("reflect", rays.reflect.cast + rays.refract.cast),
            weight("diffuse", rays.diffuse.cast),
        ])
    }
}

impl Default for Weights {
    /// Those of a path tracer with one light, and some mirrors.
    fn default() -> Self {
        weights("camera=1,shadow=4,reflect=1,diffuse=4").expect("they are in order")
    }
}

fn weights(text: &str) -> Result<Weights, String> {
    let one = |part: &str| {
        let (kind, weight) = part
            .split_once('=')
            .ok_or_else(|| format!("{part:?}: expected is a kind and a number, as in camera=1"))?;
        let kind = kind.trim();
        if !KINDS.contains(&kind) {
            return Err(format!("no kind of rays {kind:?}; there are: {}", KINDS.join(", ")));
        }
        let number = weight.trim().parse::<f64>().ok();
        let number = number.filter(|weight| (0.0..=1e9).contains(weight));
        Ok((kind.to_owned(), number.ok_or_else(|| format!("{weight:?} is no weight"))?))
    };
    text.split(',').map(one).collect::<Result<_, String>>().map(Weights)
}

fn many(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| (1.0..=1e18).contains(number));
    number.ok_or_else(|| "a number from 1 to 1e18 is expected".into())
}

fn memory(text: &str) -> Result<u64, String> {
    let wrong = || "expected is a number of bytes, as in 500M or 4G".to_owned();
    let (number, unit) = match text.char_indices().last() {
        Some((at, 'K' | 'k')) => (&text[..at], 1u64 << 10),
        Some((at, 'M' | 'm')) => (&text[..at], 1 << 20),
        Some((at, 'G' | 'g')) => (&text[..at], 1 << 30),
        _ => (text, 1),
    };
    number.trim().parse::<u64>().ok().and_then(|n| n.checked_mul(unit)).ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_are_times_or_plans() {
        assert_eq!(budget("30s"), Ok(Budget::Time(Duration::from_secs(30))));
        assert_eq!(budget("1.5m"), Ok(Budget::Time(Duration::from_secs(90))));
        assert_eq!(budget("250ms"), Ok(Budget::Time(Duration::from_millis(250))));
        assert_eq!(budget("2000evals"), Ok(Budget::Plans(2000)));
        for wrong in ["", "30", "s", "-1s", "nans", "1e9m", "x evals", "1h"] {
            assert!(budget(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn weights_name_kinds() {
        let some = weights("camera=1, shadow=0.5").expect("they are in order");
        assert_eq!((some.of("camera"), some.of("shadow"), some.of("diffuse")), (1.0, 0.5, 0.0));
        for wrong in ["", "camera", "camra=1", "camera=-1", "camera=nan"] {
            assert!(weights(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn memory_has_units() {
        assert_eq!(memory("4G"), Ok(4 << 30));
        assert_eq!(memory("123"), Ok(123));
        assert!(memory("4T").is_err() && memory("").is_err() && memory("99999999999G").is_err());
    }
}
