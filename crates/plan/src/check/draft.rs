//! Plans with their own names looked up.

use nestray_registry::hybrid::Filling;
use nestray_registry::{self as registry, Entry};
use serde_json::Value;

use super::universe::Universe;
use super::{Leaf, Tree};
use crate::build::Order;
use crate::error::PlanError;
use crate::plan::{Leaves, Nest, Node};

/// A node with its own selections looked up.
pub(super) fn draft<'a>(
    path: &str,
    node: &'a Node,
    universe: &Universe<'_>,
) -> Result<Tree<'a>, PlanError> {
    let leaf = |selection, place, below: &str| {
        let path = format!("{path}/{below}");
        let (items, rest) = universe
            .select(selection, place)
            .map_err(|problem| PlanError::at(path.clone(), problem))?;
        Ok::<_, PlanError>(Leaf { items, rest, path })
    };
    Ok(match node {
        Node::Pick(selection) => Tree::Pick(leaf(selection, false, "pick")?),
        Node::Place(place) => Tree::Place {
            leaf: leaf(&place.instance, true, "place/instance")?,
            shared: &place.shared,
            subtrees: Vec::new(),
        },
        Node::Nest(nest) => {
            let children = nest
                .children
                .iter()
                .enumerate()
                .map(|(i, child)| draft(&format!("{path}/nest/children/{i}"), child, universe));
            let children = children.collect::<Result<_, _>>()?;
            Tree::Nest { order: Box::new(order(nest)), children }
        }
        Node::ByKind(by_kind) => {
            let cases = by_kind.cases().into_iter().map(|(case, name, node)| {
                Ok((case, draft(&format!("{path}/by_kind/{name}"), node, universe)?))
            });
            Tree::ByKind { path: path.to_owned(), cases: cases.collect::<Result<_, PlanError>>()? }
        }
        Node::Fence(fence) => {
            let inner = draft(&format!("{path}/fence/around"), &fence.around, universe)?;
            Tree::Fence(fence.by, Box::new(inner))
        }
        Node::Lazy(inner) => Tree::Lazy(Box::new(draft(&format!("{path}/lazy"), inner, universe)?)),
    })
}

/// How a nest is put in order, whatever is in it.
pub(crate) fn order(nest: &Nest) -> Order {
    Order {
        entry: known(&nest.technique),
        params: Value::Object(nest.params.clone()),
        leaves: nest.leaves.as_deref().map(filling),
        open: nest.open,
    }
}

/// Leaves with their techniques looked up.
fn filling(leaves: &Leaves) -> Box<Filling> {
    Box::new(Filling {
        entry: known(&leaves.technique),
        params: Value::Object(leaves.params.clone()),
        more_than: leaves.more_than.get() as usize,
        per_leaf: leaves.per_leaf.get(),
        is_lazy: leaves.lazy,
        leaves: leaves.leaves.as_deref().map(filling),
    })
}

/// A technique that there is.
pub(crate) fn known(technique: &str) -> &'static Entry {
    registry::find(technique).expect("the technique has been checked")
}
