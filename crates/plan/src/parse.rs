//! Reading plans.

use crate::error::PlanError;
use crate::plan::Plan;

impl Plan {
    /// A plan from JSON.
    ///
    /// # Errors
    /// [`PlanError::Syntax`] if it is none.
    pub fn from_json(text: &str) -> Result<Self, PlanError> {
        too_deep(text)?;
        let mut reader = serde_json::Deserializer::from_str(text);
        // The depth has been looked at.
        reader.disable_recursion_limit();
        let plan = serde::Deserialize::deserialize(&mut reader);
        plan.and_then(|plan| reader.end().map(|()| plan)).map_err(|error| {
            let message = error.to_string();
            // The place is told apart.
            let place = format!(" at line {} column {}", error.line(), error.column());
            PlanError::Syntax {
                line: error.line().max(1),
                column: error.column().max(1),
                message: message.strip_suffix(&place).unwrap_or(&message).to_owned(),
            }
        })
    }
}

/// Refuses brackets deeper than those of the deepest plan, before anything walks into them.
fn too_deep(text: &str) -> Result<(), PlanError> {
    /// Each level of a plan takes three brackets, settings and selections a few.
    const DEEPEST: usize = 3 * (Plan::DEEPEST + 8);
    let (mut depth, mut quoted, mut escaped) = (0usize, false, false);
    let (mut line, mut start) = (1, 0);
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'\n' => (line, start) = (line + 1, at + 1),
            _ if escaped => {
                escaped = false;
                continue;
            }
            b'\\' if quoted => escaped = true,
            b'"' => quoted = !quoted,
            b'[' | b'{' if !quoted => depth += 1,
            b']' | b'}' if !quoted => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            let levels = Plan::DEEPEST;
            let message = format!("more than {levels} levels (the limit `Plan::DEEPEST`)");
            return Err(PlanError::Syntax { line, column: at - start + 1, message });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{ByKind, Nest, Node, Place};
    use crate::select::{Selection, Term};

    #[test]
    fn the_example_of_the_book_is_read() {
        let plan = Plan::from_json(
            r#"{ "version": 1, "shared": { "tree": { "nest": { "technique": "bvh",
                 "children": [ { "pick": "tree" } ] } } },
               "root": { "nest": { "technique": "grid", "params": { "density": 2.0 },
                 "children": [ { "pick": "ground" },
                               { "place": { "instance": 0, "shared": "tree" } } ] } } }"#,
        )
        .expect("it is a plan");
        let Node::Nest(nest) = &plan.root else { panic!("{plan:?}") };
        assert_eq!(nest.params["density"], 2.0);
        assert_eq!(nest.children.len(), 2);
    }

    #[test]
    fn errors_say_where() {
        let check = |text: &str, expected: &str| {
            let error = Plan::from_json(text).expect_err(text).to_string();
            assert!(error.starts_with(expected), "{text}: {error}");
        };
        check("", "1:1: EOF while parsing");
        check("{\n \"version\": 1,\n \"roof\": 3 }", "3:7: unknown field `roof`");
        check("{ \"version\": 1 }", "1:16: missing field `root`");
        check("{ \"version\": -1 }", "1:15: invalid value");
        check("{\"version\":1,\"root\":{\"pick\":\"*\"}} x", "1:35: trailing characters");
        check("{\"version\":1,\"root\":{\"pick\":\n{}}}", "2:3: a selection is a number");
        check(&"[".repeat(5000), "1:601: more than 192 levels");
        check(&format!("\"{}\"", "[".repeat(5000)), "1:5002: invalid type");
    }

    #[test]
    fn what_is_written_is_read_again() {
        let mut plan = Plan::new(Node::ByKind(Box::new(ByKind {
            shadow: Some(Node::Lazy(Box::new(Node::nest("grid", vec![Node::rest()])))),
            lights: [(3, Node::rest())].into(),
            custom: [(7, Node::rest())].into(),
            ..ByKind::new(Node::Place(Place {
                instance: Selection(vec![Term::Range(0, 4), Term::Number(9)]),
                shared: "tree".into(),
            }))
        })));
        plan.scene = Some("abc".into());
        plan.shared.insert("tree".into(), Node::nest("bvh", vec![Node::Pick(Selection::all())]));
        assert_eq!(Plan::from_json(&plan.to_json()), Ok(plan.clone()));
        assert_eq!(plan.hash(), plan.clone().hash());
        plan.shared.clear();
        assert_ne!(Plan::from_json(&plan.to_json()).expect("read").hash(), "");
    }

    #[test]
    fn the_hash_does_not_depend_on_the_order_of_settings() {
        let nest = |names: [&str; 2]| {
            let params = names.iter().map(|&n| (n.to_owned(), n.len().into())).collect();
            let technique = "grid".into();
            let nest = Nest { technique, params, leaves: None, open: 0.0, children: Vec::new() };
            Plan::new(Node::Nest(nest)).hash()
        };
        assert_eq!(nest(["a", "bb"]), nest(["bb", "a"]));
        assert_ne!(nest(["a", "bb"]), nest(["a", "cc"]));
    }

    #[test]
    fn the_deepest_plan_is_read() {
        let mut node = Node::rest();
        for _ in 0..Plan::DEEPEST {
            node = Node::nest("list", vec![node]);
        }
        let plan = Plan::new(node);
        assert!(Plan::from_json(&plan.to_json()).is_ok());
    }
}
