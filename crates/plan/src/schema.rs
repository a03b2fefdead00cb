//! The JSON schema of plans, for editors and for whoever writes plans by program.

use nestray_registry as registry;
use serde_json::Value;

use crate::plan::Plan;

/// The JSON schema of plan files. It names the techniques there are.
#[must_use]
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Plan).to_value();
    let names: Vec<Value> = registry::names().map(Value::from).collect();
    for place in ["Nest", "Leaves"] {
        let place = format!("/$defs/{place}/properties/technique");
        if let Some(technique) = schema.pointer_mut(&place) {
            technique["enum"] = names.clone().into();
        }
    }
    schema
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Node;

    #[test]
    fn plans_satisfy_it_and_others_do_not() {
        let validator = jsonschema::validator_for(&schema()).expect("a schema");
        let check = |text: &str| {
            let value = serde_json::from_str(text).expect("it is JSON");
            assert_eq!(validator.is_valid(&value), Plan::from_json(text).is_ok(), "{text}");
            validator.is_valid(&value)
        };
        assert!(check(&Plan::new(Node::nest("bvh", vec![Node::rest()])).to_json()));
        assert!(check(r#"{ "version": 1, "root": { "lazy": { "pick": [1, "a"] } } }"#));
        assert!(check(
            r#"{ "version": 1, "root": { "by_kind": { "lights": { "3": { "pick": 0 } },
                 "other": { "pick": "*" } } } }"#
        ));
        let over = |leaves: &str| {
            let nest = format!(r#""technique": "grid", "leaves": {leaves}, "children": []"#);
            check(&format!(r#"{{ "version": 1, "root": {{ "nest": {{ {nest} }} }} }}"#))
        };
        assert!(over(r#"{ "technique": "bvh" }"#));
        assert!(over(r#"{ "technique": "bvh", "lazy": true, "leaves": { "technique": "list" } }"#));
        assert!(!over(r#"{ "technique": "bvh", "more_than": 0 }"#));
        assert!(!over(r#"{ "technique": "bvh", "children": [] }"#));
        assert!(!over(r#"{}"#));
        assert!(check(r#"{ "version": 1, "root": { "fence": { "around": { "pick": 0 } } } }"#));
        assert!(!check(r#"{ "version": 1, "root": { "fence": { "by": "hedge" } } }"#));
        assert!(!check(r#"{ "version": 1, "root": { "nets": {} } }"#));
        assert!(!check(r#"{ "version": 1, "root": { "pick": -1 } }"#));
        assert!(!check(r#"{ "version": 1, "root": { "pick": 1 }, "more": 2 }"#));
        assert!(!check(r#"{ "root": { "pick": 1 } }"#));
    }

    #[test]
    fn it_knows_the_techniques() {
        let text = schema().to_string();
        for name in registry::names() {
            assert_eq!(text.matches(&format!("\"{name}\"")).count(), 2, "{name}");
        }
    }
}
