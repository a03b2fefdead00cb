//! What an object is made of, for reports.

mod counted;
mod spent;

use nestray_core::cost::{Cost, CostModel};
use nestray_core::object::Object;
use serde::Serialize;

pub use self::counted::{Counted, Doing, Expected, Sent};
pub use self::spent::Spent;

/// An object and what is in it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// What it is: a technique, a wrapper, a shape.
    pub kind: &'static str,
    /// Its settings; empty if it has none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub settings: String,
    /// How many there are of it, side by side and alike.
    pub count: u64,
    /// Expected time of a random ray that meets the bounds, in nanoseconds, of the first.
    pub nanos: f64,
    /// Memory in bytes, of all of them; what instances share counts for none of them.
    pub bytes: u64,
    /// What it does itself, if it is an aggregate: expected, of the first; counted, of all.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub doing: Option<Doing>,
    /// What it is made of.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub children: Vec<Self>,
    /// Whether there is more in it that is not shown.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub cut: bool,
}

/// Most objects that are looked at: instances in instances are written out in full, and can
/// be more than anybody wants to see.
const MOST: usize = 20_000;

/// What an object is made of. Neighbours that are alike are counted, not repeated.
#[must_use]
pub fn describe(object: &dyn Object, model: &CostModel) -> Part {
    let mut left = MOST;
    part(object, model, &mut left)
}

fn part(object: &dyn Object, model: &CostModel, left: &mut usize) -> Part {
    let cost: Cost = object.cost(model);
    let mut whole = Part {
        kind: object.kind(),
        settings: object.settings(),
        count: 1,
        nanos: cost.nanos(),
        bytes: cost.bytes,
        doing: object.own().map(Doing::new),
        children: Vec::new(),
        cut: false,
    };
    object.visit_children(&mut |child| {
        if *left == 0 {
            whole.cut = true;
            return;
        }
        *left -= 1;
        let child = part(child, model, left);
        match whole.children.iter_mut().rev().take(8).find(|other| other.is_like(&child)) {
            Some(other) => {
                other.count += 1;
                other.bytes += child.bytes;
                other.absorb(child);
            }
            None => whole.children.push(child),
        }
    });
    whole
}

impl Part {
    /// Whether it looks the same but for what it costs.
    fn is_like(&self, other: &Self) -> bool {
        self.kind == other.kind
            && self.settings == other.settings
            && self.cut == other.cut
            && self.children.len() == other.children.len()
            && self
                .children
                .iter()
                .zip(&other.children)
                .all(|(a, b)| a.count == b.count && a.is_like(b))
    }

    /// Takes in what is done in another that looks the same.
    fn absorb(&mut self, other: Self) {
        if let (Some(doing), Some(others)) = (&mut self.doing, other.doing) {
            doing.absorb(others);
        }
        for (child, others) in self.children.iter_mut().zip(other.children) {
            child.absorb(others);
        }
    }

    /// As an indented text, a line each, and what is done in each aggregate if it was counted.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        self.write(0, &mut text);
        text
    }

    fn write(&self, level: usize, text: &mut String) {
        let count = if self.count > 1 { format!("{} × ", self.count) } else { String::new() };
        let settings =
            if self.settings.is_empty() { String::new() } else { format!("  {}", self.settings) };
        let line = format!(
            "{:indent$}{count}{}{settings}  {:.0} ns, {}\n",
            "",
            self.kind,
            self.nanos,
            bytes(self.bytes),
            indent = 2 * level,
        );
        text.push_str(&line);
        if let Some(doing) = self.doing.as_ref().filter(|doing| !doing.counted.is_empty()) {
            doing.write(2 * level + 4, text);
        }
        for child in &self.children {
            child.write(level + 1, text);
        }
        if self.cut {
            text.push_str(&format!("{:indent$}…\n", "", indent = 2 * level + 2));
        }
    }
}

/// A number of bytes, for people.
#[must_use]
pub fn bytes(count: u64) -> String {
    let mut size = count as f64;
    for unit in ["B", "kB", "MB", "GB"] {
        if size < 1000.0 {
            return if unit == "B" { format!("{size} B") } else { format!("{size:.1} {unit}") };
        }
        size /= 1000.0;
    }
    format!("{size:.1} TB")
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Affine3A, Vec3A};
    use nestray_core::hit::Hit;
    use nestray_core::instance::Instance;
    use nestray_core::object::DynObject;
    use nestray_core::ray::{Ray, RayKind};
    use nestray_core::scratch::Scratch;
    use nestray_registry::{Members, find};
    use nestray_shapes::shape::Single;
    use nestray_shapes::sphere::Sphere;
    use serde_json::Value;

    use super::*;

    fn bvh(members: Vec<DynObject>) -> DynObject {
        let entry = find("bvh").expect("it is there");
        (entry.build)(&Value::Null, Members::Objects(members)).expect("the defaults are sound")
    }

    fn sphere(x: f32) -> DynObject {
        Arc::new(Single::new(0, Sphere { center: Vec3A::new(x, 0.0, 0.0), radius: 1.0 }))
    }

    #[test]
    fn what_is_alike_is_counted() {
        let tree = bvh((0..5).map(|i| sphere(i as f32)).collect());
        let place = |i| Arc::new(Instance::new(i, Arc::clone(&tree), Affine3A::IDENTITY)) as _;
        let world = bvh((1..4).map(place).chain([sphere(9.0)]).collect());
        let text = describe(&world, &CostModel::default()).to_text();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 5, "{text}");
        assert!(
            lines[1].starts_with("  3 × instance") && lines[2].starts_with("    bvh"),
            "{text}"
        );
        assert!(lines[3].starts_with("      5 × sphere") && lines[4].starts_with("  sphere"));
    }

    #[test]
    fn what_rays_did_is_told_of_each_aggregate_once() {
        let tree = bvh((0..5).map(|i| sphere(3.0 * i as f32)).collect());
        let place = |i: u16| {
            let place = Affine3A::from_translation(glam::Vec3::Y * 10.0 * f32::from(i));
            Arc::new(Instance::new(i.into(), Arc::clone(&tree), place)) as _
        };
        let world = bvh((1..4).map(place).collect());
        let mut scratch = Scratch::counting_by_site();
        for i in 0..4u8 {
            // Two rays at each of the first instances, two at nothing.
            let from = Vec3A::new(0.0, 10.0 + 10.0 * f32::from(i / 2), 5.0);
            let to = if i % 2 == 0 { Vec3A::NEG_Z } else { Vec3A::Z };
            let ray = Ray::new(from, to, RayKind::Reflect);
            world.closest_hit(&ray, &mut Hit::none(ray.t_max()), &mut scratch);
        }
        let sent =
            Sent { rays: vec![("bent".into(), RayKind::Reflect, 4)], counters: scratch.counters };
        let part = describe(&world, CostModel::usual()).counted(&sent);
        let counted = |part: &Part| part.doing.clone().expect("it is an aggregate").counted;
        let only =
            |visits, steps, tests| vec![Counted { rays: "bent".into(), visits, steps, tests }];
        assert_eq!(counted(&part), only(1.0, 1.0, 0.5));
        assert_eq!(counted(&part.children[0].children[0]), only(0.5, 1.0, 1.0));
        let text = part.to_text();
        assert!(text.contains("expected") && text.matches("bent").count() == 2, "{text}");
        let prices = CostModel::usual();
        let spent = part.spent(prices, &|rays| if rays == "bent" { 0.5 } else { 0.0 });
        let outer = 0.5 * (prices.step("bvh") + 0.5 * prices.transform);
        let inner = 0.5 * 0.5 * (prices.step("bvh") + prices.primitive("sphere"));
        assert!((spent.own - outer).abs() < 1e-9 && (spent.total - outer - inner).abs() < 1e-9);
        assert_eq!(spent.inner[0].inner[0].total, inner);
    }

    #[test]
    fn a_tower_of_instances_is_cut_short() {
        let mut tower = bvh(vec![sphere(0.0)]);
        for _ in 0..14 {
            let place = |i| Arc::new(Instance::new(i, Arc::clone(&tower), Affine3A::IDENTITY)) as _;
            tower = bvh((1..3).map(place).collect());
        }
        assert!(describe(&tower, &CostModel::default()).to_text().contains('…'));
    }
}
