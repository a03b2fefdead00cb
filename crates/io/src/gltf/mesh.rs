//! Meshes: one group each, one geometry for each primitive.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::Affine3A;
use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::group::Group;
use nestray_shapes::shape::Sides;
use nestray_shapes::triangle_mesh::Triangles;

use super::Reader;
use super::document::Primitive;
use super::nodes::Nodes;
use super::primitive::Wanted;

/// Meshes made so far.
#[derive(Debug, Default)]
pub(super) struct Meshes {
    groups: BTreeMap<Variant, usize>,
    triangles: BTreeMap<Data, Option<Arc<Triangles>>>,
    joints: BTreeMap<usize, Arc<Vec<Affine3A>>>,
}

/// A mesh, with what a node makes of it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Variant {
    /// Which mesh.
    pub(super) mesh: usize,
    /// Its skin, if it has one.
    pub(super) skin: Option<usize>,
    /// How much of each morph target, as bits so that they can be compared.
    weights: Vec<u32>,
}

/// All that decides on the triangles of a primitive: meshes often share them.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Data {
    attributes: BTreeMap<String, usize>,
    targets: Vec<BTreeMap<String, usize>>,
    indices: Option<usize>,
    mode: Option<u32>,
    uv_set: usize,
    weights: Vec<u32>,
    skin: Option<usize>,
}

impl Reader<'_> {
    /// The mesh of a node, if it has one: which, and in what shape.
    pub(super) fn variant(&self, node: usize) -> Result<Option<Variant>, String> {
        let node = &self.document.nodes[node];
        let Some(mesh) = node.mesh else { return Ok(None) };
        let found = self.document.meshes.get(mesh);
        let found = found.ok_or_else(|| format!("there is no meshes[{mesh}]"))?;
        let weights = if node.weights.is_empty() { &found.weights } else { &node.weights };
        let weights = weights.iter().map(|weight| weight.to_bits()).collect();
        Ok(Some(Variant { mesh, skin: node.skin, weights }))
    }

    /// The group of a mesh, made when it is first asked for.
    pub(super) fn group(&mut self, variant: &Variant, nodes: &Nodes) -> Result<usize, String> {
        if let Some(&group) = self.meshes.groups.get(variant) {
            return Ok(group);
        }
        let mesh = &self.document.meshes[variant.mesh];
        let joints = match variant.skin {
            Some(skin) => Some(self.shared_joints(skin, nodes)?),
            None => None,
        };
        let mut group = Group { name: mesh.name.clone(), ..Group::default() };
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let at = |why: String| format!("meshes[{}].primitives[{number}]: {why}", variant.mesh);
            let uv_set = self.uv_set(primitive.material);
            let triangles =
                self.shared_triangles(primitive, variant, uv_set, joints.as_deref()).map_err(at)?;
            let Some(triangles) = triangles else { continue };
            // Back faces are kept even where the file calls a material single-sided: light
            // must not leak in through them.
            let geometry = Geometry {
                name: mesh.name.clone(),
                material: self.material(primitive.material).map_err(at)?,
                sides: Sides::Both,
                content: Content::Mesh(triangles),
            };
            group.geometries.push(self.scene.add_apart(geometry));
        }
        let number = self.scene.add_group(group);
        self.meshes.groups.insert(variant.clone(), number);
        Ok(number)
    }

    fn shared_triangles(
        &mut self,
        primitive: &Primitive,
        variant: &Variant,
        uv_set: usize,
        joints: Option<&Vec<Affine3A>>,
    ) -> Result<Option<Arc<Triangles>>, String> {
        // What has no joints of its own is moved by none.
        let joints = joints.filter(|_| primitive.attributes.contains_key("JOINTS_0"));
        let data = Data {
            attributes: primitive.attributes.clone(),
            targets: primitive.targets.clone(),
            indices: primitive.indices,
            mode: primitive.mode,
            uv_set,
            weights: variant.weights.clone(),
            skin: variant.skin.filter(|_| joints.is_some()),
        };
        if let Some(known) = self.meshes.triangles.get(&data) {
            return Ok(known.clone());
        }
        let weights: Vec<f32> = variant.weights.iter().map(|&bits| f32::from_bits(bits)).collect();
        let wanted = Wanted { uv_set, weights: &weights, joints: joints.map(Vec::as_slice) };
        let triangles = self.triangles(primitive, &wanted)?.map(Arc::new);
        self.meshes.triangles.insert(data, triangles.clone());
        Ok(triangles)
    }

    fn shared_joints(&mut self, skin: usize, nodes: &Nodes) -> Result<Arc<Vec<Affine3A>>, String> {
        if let Some(known) = self.meshes.joints.get(&skin) {
            return Ok(known.clone());
        }
        let joints = Arc::new(self.joints(skin, nodes)?);
        self.meshes.joints.insert(skin, joints.clone());
        Ok(joints)
    }
}
