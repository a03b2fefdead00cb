//! Parts of a plan by the paths that lead to them, as error messages say them:
//! `root/nest/children/1`, `shared/tree`.

use super::{ByKind, Node, Plan};
use crate::error::nearest;

impl Plan {
    /// The paths of all nodes with these: the world first, each before what is in it.
    #[must_use]
    pub fn nodes(&self) -> Vec<(String, &Node)> {
        fn add<'a>(path: String, node: &'a Node, all: &mut Vec<(String, &'a Node)>) {
            all.push((path.clone(), node));
            node.visit_children(|step, child| add(format!("{path}/{step}"), child, all));
        }
        let mut all = Vec::new();
        add("root".into(), &self.root, &mut all);
        for (name, node) in &self.shared {
            add(format!("shared/{name}"), node, &mut all);
        }
        all
    }

    /// The node at a path.
    #[must_use]
    pub fn node(&self, path: &str) -> Option<&Node> {
        self.nodes().into_iter().find_map(|(other, node)| (other == path).then_some(node))
    }

    /// The same, to be changed.
    #[must_use]
    pub fn node_mut(&mut self, path: &str) -> Option<&mut Node> {
        if let Some(rest) = below(path, "root") {
            return self.root.node_mut(rest);
        }
        self.shared
            .iter_mut()
            .find_map(|(name, node)| node.node_mut(below(path, &format!("shared/{name}"))?))
    }

    /// The path of a node that is most like one that is none.
    #[must_use]
    pub fn nearest_path(&self, path: &str) -> String {
        let all = self.nodes();
        let known = || all.iter().map(|(other, _)| other.as_str());
        // What lies deeper than anything there is as far as it leads.
        let leads = known().filter(|other| below(path, other).is_some());
        let leads = leads.max_by_key(|other| other.len()).map(str::to_owned);
        leads
            .filter(|other| other != "root")
            .or_else(|| nearest(path, known()))
            .unwrap_or_else(|| "root".into())
    }
}

/// What of a path is left after a part of it.
fn below<'a>(path: &'a str, part: &str) -> Option<&'a str> {
    let rest = path.strip_prefix(part)?;
    if rest.is_empty() { Some(rest) } else { rest.strip_prefix('/') }
}

impl Node {
    fn node_mut(&mut self, path: &str) -> Option<&mut Self> {
        if path.is_empty() {
            return Some(self);
        }
        match self {
            Self::Pick(_) | Self::Place(_) => None,
            Self::Nest(nest) => {
                let rest = below(path, "nest/children")?;
                let (number, rest) = rest.split_once('/').unwrap_or((rest, ""));
                nest.children.get_mut(number.parse::<usize>().ok()?)?.node_mut(rest)
            }
            Self::ByKind(cases) => cases.node_mut(below(path, "by_kind")?),
            Self::Lazy(inner) => inner.node_mut(below(path, "lazy")?),
            Self::Fence(fence) => fence.around.node_mut(below(path, "fence/around")?),
        }
    }
}

impl ByKind {
    fn node_mut(&mut self, path: &str) -> Option<&mut Node> {
        let (name, rest) = path.split_once('/').unwrap_or((path, ""));
        let numbered = rest.split_once('/').unwrap_or((rest, ""));
        match name {
            "camera" => self.camera.as_mut()?.node_mut(rest),
            "shadow" => self.shadow.as_mut()?.node_mut(rest),
            "reflect" => self.reflect.as_mut()?.node_mut(rest),
            "refract" => self.refract.as_mut()?.node_mut(rest),
            "diffuse" => self.diffuse.as_mut()?.node_mut(rest),
            "other" => self.other.node_mut(rest),
            "lights" => self.lights.get_mut(&numbered.0.parse().ok()?)?.node_mut(numbered.1),
            "custom" => self.custom.get_mut(&numbered.0.parse().ok()?)?.node_mut(numbered.1),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Bounds, Fence};

    /// A plan with nodes of every kind.
    fn plan() -> Plan {
        let nest = |name: &str| Node::nest(name, vec![Node::rest()]);
        let mut cases = ByKind::new(nest("grid"));
        cases.camera = Some(nest("eye-buffer"));
        cases.lights.insert(3, Node::Lazy(Box::new(nest("octree"))));
        cases.custom.insert(0, nest("list"));
        let fence = Fence { by: Bounds::TurnedBox, around: nest("slabs") };
        let children = vec![Node::ByKind(Box::new(cases)), Node::Fence(Box::new(fence))];
        let mut plan = Plan::new(Node::nest("bvh", children));
        plan.shared.insert("tree".into(), nest("bvh"));
        plan
    }

    #[test]
    fn every_node_is_found_by_its_path() {
        let plan = plan();
        let all = plan.nodes();
        assert_eq!(all.len(), 16);
        for (path, node) in &all {
            assert_eq!(plan.node(path), Some(*node), "{path}");
            assert_eq!(plan.clone().node_mut(path).as_deref(), Some(*node), "{path}");
        }
        for path in ["", "rot", "root/nest", "root/nest/children/2", "shared/bush", "root/"] {
            assert_eq!(plan.node(path), None, "{path}");
        }
        for path in ["", "rot", "root/nest/children/2", "root/nest/children/x", "shared/bush"] {
            assert_eq!(plan.clone().node_mut(path), None, "{path}");
        }
    }

    #[test]
    fn the_nearest_path_is_as_far_as_one_leads_or_most_alike() {
        let plan = plan();
        let check = |path, expected| assert_eq!(plan.nearest_path(path), expected, "{path}");
        check("root/nest/children/1/nest/children/0", "root/nest/children/1");
        check("root/nest/children/7", "root/nest/children/0");
        check("shared/tre", "shared/tree");
        check("root/nest/children/0/by_kind/camra", "root/nest/children/0");
        check("nonsense", "root");
    }
}
