//! Skins, at rest: each vertex where its joints put it.

use std::collections::BTreeMap;

use glam::{Affine3A, Mat4};

use super::Reader;
use super::nodes::Nodes;
use super::primitive::Vertices;

impl Reader<'_> {
    /// Where each joint of a skin puts what hangs on it alone, in the world.
    pub(super) fn joints(&mut self, skin: usize, nodes: &Nodes) -> Result<Vec<Affine3A>, String> {
        let found = self.document.skins.get(skin);
        let found = found.ok_or_else(|| format!("there is no skins[{skin}]"))?;
        let inverses = match found.inverse_bind_matrices {
            Some(accessor) => Some(self.elements(accessor, &[16])?),
            None => None,
        };
        let mut joints = Vec::new();
        for (i, &joint) in found.joints.iter().enumerate() {
            let Some(world) = nodes.world(joint) else {
                return Err(format!("skins[{skin}]: joint {joint} is no node of the scene"));
            };
            let inverse = match &inverses {
                Some(inverses) if i < inverses.count => {
                    Affine3A::from_mat4(Mat4::from_cols_array(&inverses.array(i)))
                }
                Some(_) => return Err(format!("skins[{skin}]: too few inverseBindMatrices")),
                None => Affine3A::IDENTITY,
            };
            joints.push(world * inverse);
        }
        Ok(joints)
    }

    /// The blend of joints of each used vertex.
    pub(super) fn blends(
        &mut self,
        attributes: &BTreeMap<String, usize>,
        joints: &[Affine3A],
        vertices: &Vertices,
    ) -> Result<Vec<Affine3A>, String> {
        let mut sums: Vec<(Mat4, f32)> = vertices.used().map(|_| (Mat4::ZERO, 0.0)).collect();
        for set in 0.. {
            let [joint, weight] = ["JOINTS", "WEIGHTS"].map(|name| format!("{name}_{set}"));
            let (Some(&joint), Some(&weight)) = (attributes.get(&joint), attributes.get(&weight))
            else {
                break;
            };
            let (names, weights) = (self.elements(joint, &[4])?, self.elements(weight, &[4])?);
            vertices.agree("JOINTS", names.count)?;
            vertices.agree("WEIGHTS", weights.count)?;
            for (sum, vertex) in sums.iter_mut().zip(vertices.used()) {
                for at in 0..4 {
                    let weight = weights.float(vertex, at);
                    if weight == 0.0 || weight.is_nan() {
                        continue;
                    }
                    let joint =
                        names.index(vertex, at).and_then(|joint| joints.get(joint as usize));
                    let joint = joint.ok_or("JOINTS name a joint that is not there")?;
                    sum.0 += Mat4::from(*joint) * weight;
                    sum.1 += weight;
                }
            }
        }
        // Weights are meant to add up to one; what hangs on nothing stays where it is.
        let blend = |(sum, weight): (Mat4, f32)| match weight > 0.0 {
            true => Affine3A::from_mat4(sum * (1.0 / weight)),
            false => Affine3A::IDENTITY,
        };
        Ok(sums.into_iter().map(blend).collect())
    }
}
