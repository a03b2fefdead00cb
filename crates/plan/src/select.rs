//! Naming some of the geometries, or instances, of a group.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Some geometries or instances: whatever any of the terms means.
///
/// In JSON it is one term or a list of them; a term is a number or a string.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection(pub Vec<Term>);

/// A part of a selection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Term {
    /// `3`: the geometry of that number in the scene, the instance of that number in its
    /// group.
    Number(usize),
    /// `"3-9"`: from the first to the last, both included.
    Range(usize, usize),
    /// `"leaf"`, or `"name:leaf"`: all of that name; in it `*` stands for any letters.
    Name(String),
    /// `"material:glass"`, `"material:2"`: geometries of a material, by name or number.
    Material(String),
    /// `"group:tree"`, `"group:2"`: instances of a group, by name or number.
    Group(String),
    /// `"*"`: all.
    All,
    /// `"rest"`: all that are not picked elsewhere in the same subtree.
    Rest,
}

impl Selection {
    /// All.
    #[must_use]
    pub fn all() -> Self {
        Self(vec![Term::All])
    }

    /// All that are not picked elsewhere.
    #[must_use]
    pub fn rest() -> Self {
        Self(vec![Term::Rest])
    }

    /// All of a name.
    #[must_use]
    pub fn named(name: impl Into<String>) -> Self {
        Self(vec![Term::Name(name.into())])
    }

    /// By number.
    #[must_use]
    pub fn numbers(numbers: impl IntoIterator<Item = usize>) -> Self {
        Self(numbers.into_iter().map(Term::Number).collect())
    }
}

impl Term {
    /// What a string means.
    #[must_use]
    pub fn parse(text: &str) -> Self {
        if let Some((first, last)) = text.split_once('-')
            && let (Ok(first), Ok(last)) = (first.parse(), last.parse())
        {
            return Self::Range(first, last);
        }
        if let Ok(number) = text.parse() {
            return Self::Number(number);
        }
        match text {
            "*" => return Self::All,
            "rest" => return Self::Rest,
            _ => {}
        }
        match text.split_once(':') {
            Some(("name", name)) => Self::Name(name.into()),
            Some(("material", name)) => Self::Material(name.into()),
            Some(("group", name)) => Self::Group(name.into()),
            _ => Self::Name(text.into()),
        }
    }
}

impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Range(first, last) => write!(f, "{first}-{last}"),
            // Whatever would be read as something else says what it is.
            Self::Name(name) if Self::parse(name) != *self => write!(f, "name:{name}"),
            Self::Name(name) => write!(f, "{name}"),
            Self::Material(name) => write!(f, "material:{name}"),
            Self::Group(name) => write!(f, "group:{name}"),
            Self::All => write!(f, "*"),
            Self::Rest => write!(f, "rest"),
        }
    }
}

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, term) in self.0.iter().enumerate() {
            write!(f, "{}{term}", if i > 0 { ", " } else { "" })?;
        }
        Ok(())
    }
}

/// Whether `name` is what `pattern` means, where `*` stands for any letters.
#[must_use]
pub(crate) fn matches(pattern: &str, name: &str) -> bool {
    let Some((head, mut tail)) = pattern.split_once('*') else { return pattern == name };
    let Some(mut rest) = name.strip_prefix(head) else { return false };
    while let Some((middle, after)) = tail.split_once('*') {
        let Some(at) = rest.find(middle) else { return false };
        rest = &rest[at + middle.len()..];
        tail = after;
    }
    rest.ends_with(tail)
}

/// A term as it stands in JSON.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Word<'a> {
    Number(usize),
    Text(Cow<'a, str>),
}

/// A selection as it stands in JSON.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Words<'a> {
    One(Word<'a>),
    Many(Vec<Word<'a>>),
}

impl Serialize for Selection {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let word = |term: &Term| match term {
            Term::Number(number) => Word::Number(*number),
            _ => Word::Text(term.to_string().into()),
        };
        match &self.0[..] {
            [one] => Words::One(word(one)),
            many => Words::Many(many.iter().map(word).collect()),
        }
        .serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Selection {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let words = match Words::deserialize(deserializer) {
            Ok(Words::One(word)) => vec![word],
            Ok(Words::Many(words)) => words,
            Err(_) => {
                return Err(D::Error::custom(
                    "a selection is a number, a string, or a list of numbers and strings",
                ));
            }
        };
        let term = |word| match word {
            Word::Number(number) => Term::Number(number),
            Word::Text(text) => Term::parse(&text),
        };
        Ok(Self(words.into_iter().map(term).collect()))
    }
}

impl JsonSchema for Selection {
    fn schema_name() -> Cow<'static, str> {
        "Selection".into()
    }

    fn json_schema(_generator: &mut SchemaGenerator) -> Schema {
        let word = || {
            json_schema!({ "anyOf": [
                { "type": "integer", "minimum": 0 },
                { "type": "string", "examples":
                    ["leaf", "leaf*", "3-9", "material:glass", "group:tree", "*", "rest"] },
            ] })
        };
        json_schema!({
            "description": "Some geometries or instances: a number, a range `3-9`, a name \
                (`*` in it stands for any letters; `name:` before it if it looks like \
                something else), `material:` or `group:` and a name or number, `*` for all, \
                `rest` for all that are not picked elsewhere; or a list of these.",
            "anyOf": [word(), { "type": "array", "items": word() }],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_term_reads_as_it_is_written() {
        let terms = [
            Term::Number(3),
            Term::Range(0, 9),
            Term::All,
            Term::Rest,
            Term::Material("glass".into()),
            Term::Group("2".into()),
        ];
        for term in terms.into_iter().chain(
            ["leaf", "rest", "*", "7", "0-9", "name:x", "material:x", "a-b", "1-b", "é:x", ""]
                .map(|name| Term::Name(name.into())),
        ) {
            assert_eq!(Term::parse(&term.to_string()), term, "{term}");
        }
    }

    #[test]
    fn stars_stand_for_any_letters() {
        let check = |pattern, name, expected| assert_eq!(matches(pattern, name), expected);
        check("leaf", "leaf", true);
        check("leaf", "leaf2", false);
        check("leaf*", "leaf2", true);
        check("*a*b", "xaybzb", true);
        check("a*a", "a", false);
        check("a*b*c", "a-c-b", false);
    }

    #[test]
    fn selections_are_words_or_lists_of_words() {
        let read = |text| serde_json::from_str::<Selection>(text).map_err(|e| e.to_string());
        assert_eq!(read("3"), Ok(Selection::numbers([3])));
        assert_eq!(read("\"*\""), Ok(Selection::all()));
        assert_eq!(read("[1, \"rest\"]"), Ok(Selection(vec![Term::Number(1), Term::Rest])));
        assert!(read("-1").is_err() && read("{}").is_err() && read("[[1]]").is_err());
    }
}
