//! What a plan must satisfy before it is built.

mod cover;
mod draft;
mod form;
mod universe;

use std::collections::HashMap;

use nestray_core::aim::Aims;
use nestray_core::by_kind::Case;
use nestray_core::technique;
use nestray_registry::Entry;
use nestray_scene::check::SceneError;
use nestray_scene::group::Motion;
use nestray_scene::paths::Paths;
use nestray_scene::scene::Scene;
use serde_json::Value;

use self::cover::settle;
use self::draft::draft;
pub(crate) use self::draft::{known, order};
use self::universe::Universe;
use crate::build::Order;
use crate::error::{PlanError, Problem};
use crate::fingerprint;
use crate::plan::{Bounds, Node, Plan};

/// Checks that a plan can be built for a scene: that its techniques, settings, names and
/// shared subtrees exist, that it is not too deep, that every technique can serve where it
/// stands, that it holds every geometry and instance once, and that it is made for no other
/// scene.
///
/// # Errors
/// The first thing that is wrong, and where.
pub fn check(plan: &Plan, scene: &Scene) -> Result<(), PlanError> {
    resolve(plan, scene)?;
    fingerprint::check(plan, scene)
}

/// Checks what can be checked without a scene.
///
/// # Errors
/// The first thing that is wrong, and where.
pub fn check_form(plan: &Plan) -> Result<(), PlanError> {
    form::form(plan)?;
    form::unused(plan)
}

/// A plan in which every name has been looked up.
#[derive(Debug)]
pub(crate) struct Resolved<'a> {
    /// Shared subtrees, once for each group they are placed for, with that group; each after
    /// those it places.
    pub(crate) subtrees: Vec<(usize, Tree<'a>)>,
    /// The world.
    pub(crate) root: Tree<'a>,
    /// The numbers of places.
    pub(crate) paths: Paths,
}

/// A part of it.
#[derive(Debug)]
pub(crate) enum Tree<'a> {
    /// Geometries of the scene.
    Pick(Leaf),
    /// Places of the group; for each of them the shared subtree, which is called so.
    Place {
        leaf: Leaf,
        shared: &'a str,
        subtrees: Vec<usize>,
    },
    /// A technique.
    Nest {
        order: Box<Order>,
        children: Vec<Self>,
    },
    /// By kind; the last case is `other`.
    ByKind {
        path: String,
        cases: Vec<(Option<Case>, Self)>,
    },
    /// Built late.
    Lazy(Box<Self>),
    Fence(Bounds, Box<Self>),
}

/// What a selection selects.
#[derive(Debug)]
pub(crate) struct Leaf {
    /// While checking, numbers in the [`Universe`]; then those of the scene and the group.
    pub(crate) items: Vec<usize>,
    /// Whether the rest belongs to it too.
    rest: bool,
    /// Where in the plan it stands.
    path: String,
}

/// Looks every name up.
pub(crate) fn resolve<'a>(plan: &'a Plan, scene: &'a Scene) -> Result<Resolved<'a>, PlanError> {
    form::form(plan)?;
    scene.check_places()?;
    let paths = Paths::new(scene).map_err(SceneError::from)?;
    let mut moves = vec![None; scene.groups.len()];
    for group in 0..scene.groups.len() {
        group_moves(scene, group, &mut moves);
    }
    let mut resolver = Resolver {
        plan,
        scene,
        aims: scene.aims(),
        moves,
        known: HashMap::new(),
        subtrees: Vec::new(),
    };
    let root = resolver.group("root", &plan.root, scene.root, 0)?;
    form::unused(plan)?;
    Ok(Resolved { subtrees: resolver.subtrees, root, paths })
}

/// Whether something in a group moves while the shutter is open.
fn group_moves(scene: &Scene, group: usize, known: &mut Vec<Option<bool>>) -> bool {
    if let Some(moves) = known[group] {
        return moves;
    }
    let moves = scene.groups[group].places.iter().any(|place| {
        matches!(place.motion, Motion::Keys(_)) || group_moves(scene, place.group, known)
    });
    known[group] = Some(moves);
    moves
}

struct Resolver<'a> {
    plan: &'a Plan,
    scene: &'a Scene,
    /// Its lights and eyes.
    aims: Aims,
    /// For each group whether something in it moves.
    moves: Vec<Option<bool>>,
    /// The subtree made of a shared one for a group.
    known: HashMap<(&'a str, usize), usize>,
    subtrees: Vec<(usize, Tree<'a>)>,
}

impl<'a> Resolver<'a> {
    /// A subtree that holds a group, below so many instances.
    fn group(
        &mut self,
        path: &str,
        node: &'a Node,
        group: usize,
        instances: usize,
    ) -> Result<Tree<'a>, PlanError> {
        let universe = Universe::new(self.scene, group);
        let mut tree = draft(path, node, &universe)?;
        settle(path, &mut tree, &universe)?;
        self.finish(path, &mut tree, &universe, instances)?;
        Ok(tree)
    }

    /// Finds the subtrees of places, asks techniques for objections, and tells them where lights
    /// and eyes are; says whether
    /// something in it moves.
    fn finish(
        &mut self,
        path: &str,
        tree: &mut Tree<'a>,
        universe: &Universe<'_>,
        instances: usize,
    ) -> Result<bool, PlanError> {
        match tree {
            Tree::Pick(leaf) => {
                universe.rename(&mut leaf.items);
                Ok(false)
            }
            Tree::Place { leaf, shared, subtrees } => {
                universe.rename(&mut leaf.items);
                let mut moving = false;
                for &place in &leaf.items {
                    let place = &self.scene.groups[universe.group].places[place];
                    moving |= matches!(place.motion, Motion::Keys(_));
                    moving |= self.moves[place.group] == Some(true);
                    subtrees.push(self.subtree(shared, place.group, instances)?);
                }
                Ok(moving)
            }
            Tree::Nest { order, children } => {
                let mut moving = false;
                for (i, child) in children.iter_mut().enumerate() {
                    let path = format!("{path}/nest/children/{i}");
                    moving |= self.finish(&path, child, universe, instances)?;
                }
                let place = technique::Place { instances, moving };
                self.aim(path, order.entry, &mut order.params, &place)?;
                let (mut path, mut leaves) = (format!("{path}/nest"), &mut order.leaves);
                while let Some(filling) = leaves {
                    path.push_str("/leaves");
                    self.aim(&path, filling.entry, &mut filling.params, &place)?;
                    leaves = &mut filling.leaves;
                }
                Ok(moving)
            }
            Tree::ByKind { path, cases } => {
                let mut moving = false;
                for (case, tree) in cases {
                    let path = format!("{path}/by_kind/{}", case_name(*case));
                    moving |= self.finish(&path, tree, universe, instances)?;
                }
                Ok(moving)
            }
            Tree::Lazy(inner) => self.finish(&format!("{path}/lazy"), inner, universe, instances),
            Tree::Fence(_, inner) => {
                self.finish(&format!("{path}/fence/around"), inner, universe, instances)
            }
        }
    }

    /// Asks a technique for objections to its place, and tells it where lights and eyes are.
    fn aim(
        &self,
        path: &str,
        entry: &Entry,
        params: &mut Value,
        place: &technique::Place,
    ) -> Result<(), PlanError> {
        const CHECKED: &str = "the settings have been checked";
        if let Some(reason) = (entry.objection)(params, place).expect(CHECKED) {
            let technique = entry.name;
            return Err(PlanError::at(path, Problem::Objection { technique, reason }));
        }
        *params = (entry.aimed)(params, &self.aims).expect(CHECKED);
        Ok(())
    }

    /// The shared subtree of that name, for a group.
    fn subtree(
        &mut self,
        name: &'a str,
        group: usize,
        instances: usize,
    ) -> Result<usize, PlanError> {
        if let Some(&known) = self.known.get(&(name, group)) {
            return Ok(known);
        }
        let node = &self.plan.shared[name];
        let tree = self.group(&format!("shared/{name}"), node, group, instances + 1)?;
        self.subtrees.push((group, tree));
        self.known.insert((name, group), self.subtrees.len() - 1);
        Ok(self.subtrees.len() - 1)
    }
}

/// What a case is called in paths.
fn case_name(case: Option<Case>) -> String {
    match case {
        Some(Case::Camera) => "camera".into(),
        Some(Case::Reflect) => "reflect".into(),
        Some(Case::Refract) => "refract".into(),
        Some(Case::Diffuse) => "diffuse".into(),
        Some(Case::Shadow(Some(light))) => format!("lights/{light}"),
        Some(Case::Shadow(None)) => "shadow".into(),
        Some(Case::Custom(Some(number))) => format!("custom/{number}"),
        Some(Case::Custom(None)) => "custom".into(),
        None => "other".into(),
    }
}

#[cfg(test)]
mod tests;
