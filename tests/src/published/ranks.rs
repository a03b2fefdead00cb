//! In which order techniques come, from little work of a ray to much.

use super::PerRay;

/// What a technique does in a scene.
#[derive(Clone, Copy, Debug)]
pub struct Ranked {
    /// The technique.
    pub name: &'static str,
    /// What was printed.
    pub printed: PerRay,
    /// What ours does.
    pub ours: PerRay,
    /// What it does without anything of ours.
    pub plain: PerRay,
}

/// Of one technique in one scene: its name, what was printed and what we count.
type Rank = (&'static str, [f64; 2]);

/// Prints how techniques rank in each scene; how many pairs are in the same order, and how many
/// there are.
#[expect(clippy::print_stdout, reason = "the tables are what one looks at")]
pub fn show(
    title: &str,
    scenes: &[(&str, Vec<Ranked>)],
    of: impl Fn(&Ranked) -> Option<[f64; 2]>,
) -> [usize; 2] {
    println!("\n{title}:\n");
    println!("| scene | printed | ours | same order | others, as printed and ours |");
    println!("|---|---|---|---|---|");
    let (mut same, mut of_all) = (0, 0);
    for (scene, techniques) in scenes {
        let all: Vec<Rank> =
            techniques.iter().filter_map(|one| Some((one.name, of(one)?))).collect();
        let pairs = (0..all.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let pairs: Vec<[Rank; 2]> = pairs.map(|(a, b)| [all[a], all[b]]).collect();
        let others: Vec<String> =
            pairs.iter().filter(|pair| is_reversed(pair)).map(|pair| times(*pair)).collect();
        let [agree, count] = [pairs.len() - others.len(), pairs.len()];
        let (printed, ours) = (order(&all, 0), order(&all, 1));
        println!("| {scene} | {printed} | {ours} | {agree} of {count} | {} |", others.join("; "));
        same += agree;
        of_all += count;
    }
    println!("\n{same} of {of_all}");
    [same, of_all]
}

fn is_reversed([(_, a), (_, b)]: &[Rank; 2]) -> bool {
    (a[0] < b[0]) != (a[1] < b[1])
}

/// How many times as much the first does as the second.
fn times([(a, x), (b, y)]: [Rank; 2]) -> String {
    format!("{a} / {b}: {:.2}, {:.2}", x[0] / y[0], x[1] / y[1])
}

/// All in their order.
fn order(all: &[Rank], of: usize) -> String {
    let mut all = all.to_vec();
    all.sort_by(|(_, a), (_, b)| a[of].total_cmp(&b[of]));
    let each = all.iter().map(|(name, count)| format!("{name} {:.1}", count[of]));
    each.collect::<Vec<_>>().join(", ")
}
