//! Parts of plans: finding them, and moving geometries between them.

use nestray_core::aabb::Aabb;
use nestray_scene::scene::Scene;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::plan::{Nest, Node, Plan};
use crate::select::{Selection, Term};

/// How many nests there are.
pub(super) fn nests(plan: &Plan) -> usize {
    fn count(node: &Node) -> usize {
        let mut nests = usize::from(matches!(node, Node::Nest(_)));
        node.visit_children(|_, child| nests += count(child));
        nests
    }
    count(&plan.root) + plan.shared.values().map(count).sum::<usize>()
}

/// A nest by number: those of the world first, each before what is in it.
pub(super) fn nest(plan: &mut Plan, mut number: usize) -> Option<&mut Nest> {
    let nodes = std::iter::once(&mut plan.root).chain(plan.shared.values_mut());
    nodes.into_iter().find_map(|node| below(node, &mut number))
}

/// A nest of the world by number.
pub(super) fn root_nest(plan: &mut Plan, mut number: usize) -> Option<&mut Nest> {
    below(&mut plan.root, &mut number)
}

fn below<'a>(node: &'a mut Node, number: &mut usize) -> Option<&'a mut Nest> {
    match node {
        Node::Pick(_) | Node::Place(_) => None,
        Node::Lazy(inner) => below(inner, number),
        Node::Fence(fence) => below(&mut fence.around, number),
        Node::ByKind(cases) => {
            let special = [
                &mut cases.camera,
                &mut cases.shadow,
                &mut cases.reflect,
                &mut cases.refract,
                &mut cases.diffuse,
            ];
            let special = special.into_iter().flatten();
            let all = special
                .chain(cases.lights.values_mut())
                .chain(cases.custom.values_mut())
                .chain(std::iter::once(&mut cases.other));
            all.into_iter().find_map(|node| below(node, number))
        }
        Node::Nest(nest) => {
            if *number == 0 {
                return Some(nest);
            }
            *number -= 1;
            nest.children.iter_mut().find_map(|child| below(child, number))
        }
    }
}

/// The geometries that a pick of the world means, if it says them by number, or means all.
fn numbers_of(pick: &Selection, scene: &Scene) -> Option<Vec<usize>> {
    let mut numbers = Vec::new();
    for term in &pick.0 {
        match *term {
            Term::Number(number) => numbers.push(number),
            Term::Range(first, last) => numbers.extend(first..=last),
            Term::All => numbers.extend(&scene.groups[scene.root].geometries),
            _ => return None,
        }
    }
    Some(numbers)
}

/// A pick of some geometries, said in ranges.
fn pick_of(mut numbers: Vec<usize>) -> Node {
    numbers.sort_unstable();
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let terms = runs.map(|run| match *run {
        [one] => Term::Number(one),
        [first, .., last] => Term::Range(first, last),
        [] => unreachable!("runs are not empty"),
    });
    Node::Pick(Selection(terms.collect()))
}

/// What geometries are told apart by.
#[derive(Clone, Copy)]
enum By {
    Place(usize),
    Size,
    Count,
    Chance,
}

/// Puts the geometries of a nest of the world into two nests of the same technique.
pub(super) fn split(nest: &mut Nest, scene: &Scene, numbers: &mut Pcg64Mcg) -> Option<()> {
    let is_pick = |node: &Node| matches!(node, Node::Pick(_));
    let mut inside = Vec::new();
    for child in nest.children.iter().filter(|child| is_pick(child)) {
        let Node::Pick(pick) = child else { continue };
        inside.extend(numbers_of(pick, scene)?);
    }
    if inside.len() < 2 {
        return None;
    }
    let by = match numbers.random_range(0..6) {
        axis @ 0..3 => By::Place(axis),
        3 => By::Size,
        4 => By::Count,
        _ => By::Chance,
    };
    let mut keyed: Vec<(f64, usize)> =
        inside.into_iter().map(|number| (key(by, number, scene, numbers), number)).collect();
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let cut = 1 + numbers.random_range(0..keyed.len() - 1);
    let (low, high) = keyed.split_at(cut);
    let part = |of: &[(f64, usize)]| {
        let children = vec![pick_of(of.iter().map(|&(_, number)| number).collect())];
        Node::Nest(Nest { children, ..nest.clone() })
    };
    let parts = [part(low), part(high)];
    nest.children.retain(|child| !is_pick(child));
    nest.children.extend(parts);
    nest.leaves = None;
    Some(())
}

fn key(by: By, number: usize, scene: &Scene, numbers: &mut Pcg64Mcg) -> f64 {
    let geometry = &scene.geometries[number];
    let bounds = geometry.bounds();
    let bounds = if bounds.is_bounded() { bounds } else { Aabb::EMPTY };
    match by {
        By::Place(axis) if !bounds.is_empty() => f64::from(bounds.center()[axis]),
        By::Place(_) => 0.0,
        By::Size => f64::from(bounds.surface_area()),
        By::Count => f64::from(geometry.primitives()),
        By::Chance => numbers.random(),
    }
}

/// Puts the children of a nest inside another into that one.
pub(super) fn dissolve(nest: &mut Nest, numbers: &mut Pcg64Mcg) -> Option<()> {
    let at = inner(nest, numbers)?;
    let Node::Nest(gone) = nest.children.remove(at) else { return None };
    nest.children.extend(gone.children);
    join_picks(nest);
    Some(())
}

/// Puts the children of one nest inside another into a second.
pub(super) fn merge(nest: &mut Nest, numbers: &mut Pcg64Mcg) -> Option<()> {
    let from = inner(nest, numbers)?;
    let Node::Nest(gone) = nest.children.remove(from) else { return None };
    let to = inner(nest, numbers)?;
    let Node::Nest(kept) = &mut nest.children[to] else { return None };
    kept.children.extend(gone.children);
    join_picks(kept);
    Some(())
}

/// One of the children that are nests.
fn inner(nest: &Nest, numbers: &mut Pcg64Mcg) -> Option<usize> {
    let nests: Vec<usize> =
        (0..nest.children.len()).filter(|&i| matches!(nest.children[i], Node::Nest(_))).collect();
    super::pick(&nests, numbers).copied()
}

/// Makes one pick of all that are said by number.
fn join_picks(nest: &mut Nest) {
    let mut terms = Vec::new();
    nest.children.retain(|child| match child {
        Node::Pick(pick) => {
            terms.extend(pick.0.iter().cloned());
            false
        }
        _ => true,
    });
    if !terms.is_empty() {
        nest.children.insert(0, Node::Pick(Selection(terms)));
    }
}

/// Moves one geometry of the world from one pick to another.
pub(super) fn transfer(plan: &mut Plan, scene: &Scene, numbers: &mut Pcg64Mcg) -> Option<()> {
    let count = nests(plan);
    let places = |plan: &mut Plan, least: usize| -> Vec<usize> {
        (0..count)
            .filter(|&at| {
                root_nest(plan, at)
                    .and_then(|nest| own_pick(nest, scene))
                    .is_some_and(|(_, inside)| inside.len() >= least)
            })
            .collect()
    };
    let from = *super::pick(&places(plan, 2), numbers)?;
    let to = *super::pick(&places(plan, 1), numbers)?;
    if from == to {
        return None;
    }
    let (at, mut inside) = own_pick(root_nest(plan, from)?, scene)?;
    let moved = inside.remove(numbers.random_range(0..inside.len()));
    root_nest(plan, from)?.children[at] = pick_of(inside);
    let (at, mut inside) = own_pick(root_nest(plan, to)?, scene)?;
    inside.push(moved);
    root_nest(plan, to)?.children[at] = pick_of(inside);
    Some(())
}

/// The first pick of a nest that says geometries by number: which child it is, and those.
fn own_pick(nest: &Nest, scene: &Scene) -> Option<(usize, Vec<usize>)> {
    nest.children.iter().enumerate().find_map(|(at, child)| match child {
        Node::Pick(pick) => Some((at, numbers_of(pick, scene)?)),
        _ => None,
    })
}
