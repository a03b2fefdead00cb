//! What differs between two plans.

use std::collections::BTreeSet;

use serde::Serialize;
use serde_json::Value;

use super::Plan;

/// Something that is not the same in two plans.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Where: in the first plan, or if it is only in the second, there.
    pub path: String,
    /// What the first has there, if anything.
    pub first: Option<Value>,
    /// What the second has there, if anything.
    pub second: Option<Value>,
}

/// All that differs. Children are compared with those that stand in the same order; what was put in
/// or taken out among them is one difference.
#[must_use]
pub fn differences(first: &Plan, second: &Plan) -> Vec<Difference> {
    let value = |plan: &Plan| serde_json::to_value(plan).expect("a plan is plain data");
    let mut all = Vec::new();
    compare("", Some(&value(first)), Some(&value(second)), &mut all);
    all
}

fn compare(path: &str, first: Option<&Value>, second: Option<&Value>, all: &mut Vec<Difference>) {
    let inner = |name: &str| if path.is_empty() { name.into() } else { format!("{path}/{name}") };
    match (first, second) {
        (first, second) if first == second => {}
        (Some(Value::Object(a)), Some(Value::Object(b))) if same_kind(a, b) => {
            let names: BTreeSet<&String> = a.keys().chain(b.keys()).collect();
            for name in names {
                compare(&inner(name), a.get(name), b.get(name), all);
            }
        }
        (Some(Value::Array(a)), Some(Value::Array(b))) => {
            let [from, to_a, to_b] = middles(a, b);
            for i in from..to_a.max(to_b) {
                let of = |list: &[Value], end: usize| (i < end).then(|| list[i].clone());
                let (a, b) = (of(a, to_a), of(b, to_b));
                compare(&inner(&i.to_string()), a.as_ref(), b.as_ref(), all);
            }
        }
        (first, second) => all.push(Difference {
            path: path.into(),
            first: first.cloned(),
            second: second.cloned(),
        }),
    }
}

/// Whether it makes sense to go into both: nodes of different kinds share nothing.
fn same_kind(a: &serde_json::Map<String, Value>, b: &serde_json::Map<String, Value>) -> bool {
    const KINDS: &[&str] = &["nest", "by_kind", "lazy", "fence", "place", "pick"];
    let kind = |map: &serde_json::Map<String, Value>| {
        KINDS.iter().position(|kind| map.len() == 1 && map.contains_key(*kind))
    };
    kind(a) == kind(b)
}

/// Where lists begin to differ, and where each ends to.
fn middles(a: &[Value], b: &[Value]) -> [usize; 3] {
    let from = a.iter().zip(b).take_while(|(a, b)| a == b).count();
    let rest = a[from..].iter().rev().zip(b[from..].iter().rev());
    let same = rest.take_while(|(a, b)| a == b).count();
    [from, a.len() - same, b.len() - same]
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::plan::{Nest, Node};

    fn nest(technique: &str, children: &[Node]) -> Node {
        Node::nest(technique, children.to_vec())
    }

    /// The paths at which plans with these roots differ.
    fn check(first: &Node, second: &Node, expected: &[&str]) -> Vec<Difference> {
        let all = differences(&Plan::new(first.clone()), &Plan::new(second.clone()));
        let paths: Vec<&str> = all.iter().map(|one| one.path.as_str()).collect();
        assert_eq!(paths, expected);
        all
    }

    #[test]
    fn settings_and_techniques_are_told_apart_at_their_place() {
        let (a, rest) = (nest("bvh", &[]), Node::rest());
        check(&a, &a, &[]);
        let all = check(&a, &nest("grid", &[]), &["root/nest/technique"]);
        assert_eq!(all[0].first, Some(json!("bvh")));
        let Node::Nest(mut tuned) = a.clone() else { unreachable!("it is one") };
        tuned.params.insert("max_leaf".into(), json!(4));
        let tuned = Node::Nest(Nest { ..tuned });
        let all = check(
            &nest("bvh", &[rest.clone(), a.clone()]),
            &nest("bvh", &[rest.clone(), tuned]),
            &["root/nest/children/1/nest/params"],
        );
        assert_eq!((&all[0].first, &all[0].second), (&None, &Some(json!({ "max_leaf": 4 }))));
        check(&a, &Node::Lazy(Box::new(a.clone())), &["root"]);
    }

    #[test]
    fn a_child_put_in_is_one_difference() {
        let [a, b, c] = ["grid", "octree", "list"].map(|name| nest(name, &[]));
        let (few, many) = (nest("bvh", &[a.clone(), c.clone()]), nest("bvh", &[a, b, c]));
        let all = check(&few, &many, &["root/nest/children/1"]);
        assert!(all[0].first.is_none());
        let all = check(&many, &few, &["root/nest/children/1"]);
        assert!(all[0].second.is_none());
    }
}
