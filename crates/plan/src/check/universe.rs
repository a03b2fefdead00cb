//! What stands in a group, and what a selection selects of it.

use std::collections::HashMap;

use nestray_scene::scene::Scene;

use crate::error::Problem;
use crate::select::{Selection, Term, matches};

/// What stands in a group, numbered: first its geometries, then its places.
pub(super) struct Universe<'a> {
    scene: &'a Scene,
    pub(super) group: usize,
    /// Geometries in ascending order.
    geometries: Vec<usize>,
    /// Geometries and places by name.
    named: [HashMap<&'a str, Vec<usize>>; 2],
}

impl<'a> Universe<'a> {
    pub(super) fn new(scene: &'a Scene, group: usize) -> Self {
        let mut geometries = scene.groups[group].geometries.clone();
        geometries.sort_unstable();
        geometries.dedup();
        let mut universe = Self { scene, group, geometries, named: Default::default() };
        for item in 0..universe.count() {
            let named = &mut universe.named[usize::from(item >= universe.geometries.len())];
            named
                .entry(item_name(scene, group, &universe.geometries, item))
                .or_default()
                .push(item);
        }
        universe
    }

    /// How many items there are.
    pub(super) fn count(&self) -> usize {
        self.geometries.len() + self.scene.groups[self.group].places.len()
    }

    /// All geometries, or all places.
    pub(super) fn all(&self, places: bool) -> std::ops::Range<usize> {
        if places { self.geometries.len()..self.count() } else { 0..self.geometries.len() }
    }

    /// From numbers here to those of the scene or group.
    pub(super) fn rename(&self, items: &mut [usize]) {
        for item in items {
            *item = match self.geometries.get(*item) {
                Some(&geometry) => geometry,
                None => *item - self.geometries.len(),
            };
        }
    }

    /// What an item is called in messages.
    pub(super) fn describe(&self, item: usize) -> String {
        let name = self.name(item);
        let name = if name.is_empty() { String::new() } else { format!(" \"{name}\"") };
        let kind = self.kind(item >= self.geometries.len());
        let mut number = [item];
        self.rename(&mut number);
        let (what, place) = kind.split_once(' ').unwrap_or((&kind, ""));
        format!("{what} {}{name} {place}", number[0])
    }

    /// The items of a selection, each once, and whether the rest is wanted too.
    pub(super) fn select(
        &self,
        selection: &Selection,
        places: bool,
    ) -> Result<(Vec<usize>, bool), Problem> {
        let (mut items, mut rest) = (Vec::new(), false);
        for term in &selection.0 {
            match term {
                Term::All => items.extend(self.all(places)),
                Term::Rest => rest = true,
                _ => items.extend(self.term(term, places)?),
            }
        }
        let mut seen = vec![false; self.count()];
        items.retain(|&item| !std::mem::replace(&mut seen[item], true));
        Ok((items, rest))
    }

    fn term(&self, term: &Term, places: bool) -> Result<Vec<usize>, Problem> {
        let numbered = |first: usize, last: usize| -> Vec<usize> {
            if places {
                let all = self.all(true);
                let end = last.saturating_add(1).min(all.len());
                (all.start + first.min(end)..all.start + end).collect()
            } else {
                let start = self.geometries.partition_point(|&number| number < first);
                let end = self.geometries.partition_point(|&number| number <= last);
                (start..end.max(start)).collect()
            }
        };
        let found = match term {
            Term::Number(number) => numbered(*number, *number),
            Term::Range(first, last) => numbered(*first, *last),
            Term::Name(name) => match self.named[usize::from(places)].get(name.as_str()) {
                Some(items) => items.clone(),
                None => self.filter(places, |item| matches(name, self.name(item))),
            },
            Term::Material(name) if !places => self.filter(false, |item| {
                let material = self.scene.geometries[self.geometries[item]].material;
                let known = self.scene.materials.get(material);
                name.parse().map_or_else(
                    |_| known.is_some_and(|material| matches(name, &material.name)),
                    |number: usize| number == material,
                )
            }),
            Term::Group(name) if places => self.filter(true, |item| {
                let place = item - self.geometries.len();
                let group = self.scene.groups[self.group].places[place].group;
                name.parse().map_or_else(
                    |_| matches(name, &self.scene.groups[group].name),
                    |number: usize| number == group,
                )
            }),
            _ => Vec::new(),
        };
        if found.is_empty() { Err(self.unknown(term, places)) } else { Ok(found) }
    }

    fn filter(&self, places: bool, keep: impl Fn(usize) -> bool) -> Vec<usize> {
        self.all(places).filter(|&item| keep(item)).collect()
    }

    fn unknown(&self, term: &Term, places: bool) -> Problem {
        let scene = self.scene;
        let prefixed = |prefix: &str, name: &str| format!("{prefix}:{name}");
        let known: Vec<String> = match term {
            Term::Name(_) => self.all(places).map(|item| self.name(item).to_owned()).collect(),
            Term::Material(_) => {
                scene.materials.iter().map(|m| prefixed("material", &m.name)).collect()
            }
            Term::Group(_) => scene.groups.iter().map(|g| prefixed("group", &g.name)).collect(),
            _ => Vec::new(),
        };
        let known = known.iter().map(String::as_str).filter(|name| !name.is_empty());
        Problem::unknown(self.kind(places), &term.to_string(), known)
    }

    /// What an item is, and where.
    fn kind(&self, places: bool) -> String {
        let what = if places { "instance" } else { "geometry" };
        let group = &self.scene.groups[self.group].name;
        match group.as_str() {
            _ if self.group == self.scene.root => format!("{what} of the world"),
            "" => format!("{what} of group {}", self.group),
            name => format!("{what} of group \"{name}\""),
        }
    }

    fn name(&self, item: usize) -> &'a str {
        item_name(self.scene, self.group, &self.geometries, item)
    }
}

fn item_name<'a>(scene: &'a Scene, group: usize, geometries: &[usize], item: usize) -> &'a str {
    match geometries.get(item) {
        Some(&geometry) => &scene.geometries[geometry].name,
        None => &scene.groups[group].places[item - geometries.len()].name,
    }
}
