//! The hierarchy of nodes: in which order, where, and what stands there.

use glam::{Affine3A, Mat4, Quat, Vec3};
use nestray_scene::animation::{Node, Pose, Track};
use nestray_scene::group::{Group, Motion, Place};

use super::Reader;
use super::document::Instancing;

/// The nodes of the scene, each after its parent.
#[derive(Debug)]
pub(super) struct Nodes {
    /// For each of the document, which of the scene's it is.
    numbers: Vec<Option<usize>>,
    /// Those of the scene.
    pub(super) all: Vec<Found>,
}

/// A node of the scene.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// Which of the document.
    pub(super) index: usize,
    parent: Option<usize>,
    depth: usize,
    rest: Pose,
    /// Where it rests in the world.
    world: Affine3A,
}

impl Nodes {
    /// Where a node of the document rests in the world; none if it is not of the scene.
    pub(super) fn world(&self, index: usize) -> Option<Affine3A> {
        self.number(index).map(|number| self.all[number].world)
    }

    /// Which of the scene's nodes one of the document is.
    pub(super) fn number(&self, index: usize) -> Option<usize> {
        self.numbers.get(index).copied().flatten()
    }
}

impl Reader<'_> {
    /// The nodes of the scene that is shown first.
    pub(super) fn nodes(&mut self) -> Result<Nodes, String> {
        /// Deeper ones are no work of a person, and take too long to walk.
        const DEEPEST: usize = 1024;
        let count = self.document.nodes.len();
        let mut nodes = Nodes { numbers: vec![None; count], all: Vec::new() };
        let mut open: Vec<(usize, Option<usize>)> =
            self.roots()?.into_iter().rev().map(|root| (root, None)).collect();
        while let Some((index, parent)) = open.pop() {
            let Some(node) = self.document.nodes.get(index) else {
                return Err(format!("there is no nodes[{index}]"));
            };
            if nodes.numbers[index].is_some() {
                return Err(format!("nodes[{index}] stands in itself, or in two nodes at once"));
            }
            let above = parent.map(|parent: usize| &nodes.all[parent]);
            let depth = above.map_or(0, |above| above.depth + 1);
            if depth > DEEPEST {
                return Err(format!("nodes stand in one another more than {DEEPEST} deep"));
            }
            let rest = self.rest(index)?;
            let local = matrix(&rest);
            let world = above.map_or(local, |above| above.world * local);
            if !world.is_finite() {
                return Err(format!("nodes[{index}] is nowhere: its place is no number"));
            }
            nodes.numbers[index] = Some(nodes.all.len());
            open.extend(node.children.iter().rev().map(|&child| (child, Some(nodes.all.len()))));
            nodes.all.push(Found { index, parent, depth, rest, world });
        }
        Ok(nodes)
    }

    fn roots(&mut self) -> Result<Vec<usize>, String> {
        let document = self.document;
        if document.scenes.len() > 1 {
            self.warn(format!("one of {} scenes is read", document.scenes.len()));
        }
        match (document.scene, document.scenes.as_slice()) {
            (None, []) => {
                let mut root = vec![true; document.nodes.len()];
                for &child in document.nodes.iter().flat_map(|node| &node.children) {
                    match root.get_mut(child) {
                        Some(root) => *root = false,
                        None => return Err(format!("there is no nodes[{child}]")),
                    }
                }
                Ok((0..root.len()).filter(|&node| root[node]).collect())
            }
            (scene, scenes) => {
                let scene = scene.unwrap_or(0);
                let found =
                    scenes.get(scene).ok_or_else(|| format!("there is no scenes[{scene}]"))?;
                Ok(found.nodes.clone())
            }
        }
    }

    /// Where a node rests, relative to its parent.
    fn rest(&self, index: usize) -> Result<Pose, String> {
        let node = &self.document.nodes[index];
        if let Some(matrix) = node.matrix {
            return Ok(Pose::Matrix(Affine3A::from_mat4(Mat4::from_cols_array(&matrix))));
        }
        let rotation = node.rotation.map_or(Quat::IDENTITY, Quat::from_array);
        let length = rotation.length_squared();
        if !(length.is_finite() && length > 0.0) {
            return Err(format!("nodes[{index}].rotation is no rotation"));
        }
        Ok(Pose::Parts {
            translation: node.translation.map_or(Vec3::ZERO, Vec3::from_array),
            rotation: rotation.normalize(),
            scale: node.scale.map_or(Vec3::ONE, Vec3::from_array),
        })
    }

    /// Puts the nodes into the scene's animation, with their tracks, if any of them moves.
    pub(super) fn animate(&mut self, nodes: &Nodes, mut tracks: Vec<Tracks>) {
        if tracks.iter().all(Tracks::is_empty) {
            return;
        }
        for (found, tracks) in nodes.all.iter().zip(&mut tracks) {
            let tracks = std::mem::take(tracks);
            // Tracks replace parts of a pose, so a matrix is taken apart.
            let rest = match found.rest {
                Pose::Matrix(matrix) if !tracks.is_empty() => {
                    let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
                    Pose::Parts { translation, rotation, scale }
                }
                rest => rest,
            };
            self.scene.animation.nodes.push(Node {
                parent: found.parent,
                rest,
                translation: tracks.translation,
                rotation: tracks.rotation,
                scale: tracks.scale,
            });
        }
    }

    /// Puts meshes, lights and cameras where their nodes are.
    pub(super) fn place_nodes(&mut self, nodes: &Nodes) -> Result<(), String> {
        let moving = self.moving(nodes);
        for (number, found) in nodes.all.iter().enumerate() {
            let node = &self.document.nodes[found.index];
            let hangs_on = moving[number].then_some(number);
            if let Some(variant) = self.variant(found.index)? {
                let mut group = self.group(&variant, nodes)?;
                if let Some(instancing) = &node.extensions.instancing {
                    group = self.instances(group, instancing)?;
                }
                let motion = match (variant.skin, hangs_on) {
                    // The joints have put it in the world already.
                    (Some(_), _) => Motion::Still(Affine3A::IDENTITY),
                    (None, Some(number)) => Motion::Node(number),
                    (None, None) => Motion::Still(found.world),
                };
                if let Some(skin) = variant.skin
                    && moving.contains(&true)
                {
                    let name = named(&self.document.skins[skin].name, "skin", skin);
                    self.warn(format!("skin {name} does not move: it is shown at rest"));
                }
                let root = self.scene.root;
                let place = Place { name: node.name.clone(), group, motion };
                self.scene.groups[root].places.push(place);
            }
            let place = if hangs_on.is_some() { Affine3A::IDENTITY } else { found.world };
            if let Some(camera) = node.camera {
                self.add_camera(camera, place, hangs_on, &node.name)?;
            }
            if let Some(light) = &node.extensions.light {
                self.add_light(light.light, place, hangs_on, &node.name)?;
            }
        }
        Ok(())
    }

    /// Which nodes move, or hang on one that does.
    fn moving(&self, nodes: &Nodes) -> Vec<bool> {
        let mut moving = Vec::with_capacity(nodes.all.len());
        for (number, found) in nodes.all.iter().enumerate() {
            let own = self.scene.animation.nodes.get(number).is_some_and(|node| {
                let keys =
                    [node.translation.keys.len(), node.rotation.keys.len(), node.scale.keys.len()];
                keys.iter().any(|&keys| keys > 0)
            });
            moving.push(own || found.parent.is_some_and(|parent| moving[parent]));
        }
        moving
    }

    /// A group that holds another in many places.
    fn instances(&mut self, group: usize, instancing: &Instancing) -> Result<usize, String> {
        let mut read = |name: &str, width: usize| match instancing.attributes.get(name) {
            Some(&accessor) => self.elements(accessor, &[width]).map(Some),
            None => Ok(None),
        };
        let (moves, turns) = (read("TRANSLATION", 3)?, read("ROTATION", 4)?);
        let scales = read("SCALE", 3)?;
        let counts = [&moves, &turns, &scales].map(|e| e.as_ref().map(|e| e.count));
        let count = counts.iter().flatten().copied().min().unwrap_or(0);
        // A place takes as much room as several vertices.
        self.keep(count.saturating_mul(8))?;
        let mut places = Vec::with_capacity(count);
        for i in 0..count {
            let turn = turns.as_ref().map_or(Quat::IDENTITY, |e| Quat::from_array(e.array(i)));
            let length = turn.length_squared();
            let place = Affine3A::from_scale_rotation_translation(
                scales.as_ref().map_or(Vec3::ONE, |e| Vec3::from_array(e.array(i))),
                if length.is_finite() && length > 0.0 { turn.normalize() } else { Quat::IDENTITY },
                moves.as_ref().map_or(Vec3::ZERO, |e| Vec3::from_array(e.array(i))),
            );
            if !place.is_finite() {
                return Err(format!("instance {i} of EXT_mesh_gpu_instancing is nowhere"));
            }
            places.push(Place { name: String::new(), group, motion: Motion::Still(place) });
        }
        Ok(self.scene.add_group(Group { name: String::new(), geometries: Vec::new(), places }))
    }
}

/// What a part of the document is called in warnings.
pub(super) fn named(name: &str, kind: &str, number: usize) -> String {
    match name {
        "" => format!("{kind}s[{number}]"),
        name => format!("`{}`", name.escape_debug()),
    }
}

fn matrix(pose: &Pose) -> Affine3A {
    match *pose {
        Pose::Matrix(matrix) => matrix,
        Pose::Parts { translation, rotation, scale } => {
            Affine3A::from_scale_rotation_translation(scale, rotation, translation)
        }
    }
}

/// How a node moves.
#[derive(Debug, Default)]
pub(super) struct Tracks {
    pub(super) translation: Track<Vec3>,
    pub(super) rotation: Track<Quat>,
    pub(super) scale: Track<Vec3>,
}

impl Tracks {
    fn is_empty(&self) -> bool {
        self.translation.keys.is_empty()
            && self.rotation.keys.is_empty()
            && self.scale.keys.is_empty()
    }
}
