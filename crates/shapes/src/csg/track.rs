//! Where a ray enters and leaves one operand.

use std::cell::RefCell;

use nestray_core::aabb::Aabb;
use nestray_core::hit::Hit;
use nestray_core::object::Object;
use nestray_core::ray::Ray;
use nestray_core::scratch::Scratch;
use nestray_core::surface::Surface;

use glam::Vec3A;

/// The ray enters or leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub(super) t: f32,
    pub(super) enters: bool,
}

/// What happens along a ray: events in order that enter and leave in turn.
#[derive(Debug, Default)]
pub(super) struct Track {
    /// Whether the ray starts inside.
    pub(super) inside: bool,
    pub(super) events: Vec<Event>,
}

/// What a query needs, kept for the next one of this thread.
#[derive(Debug, Default)]
pub(super) struct Memory {
    pub(super) left: Track,
    pub(super) right: Track,
    pub(super) hits: Vec<Hit>,
}

thread_local! {
    /// One for every level of solids within solids.
    static SPARE: RefCell<Vec<Memory>> = const { RefCell::new(Vec::new()) };
}

impl Memory {
    pub(super) fn take() -> Self {
        let mut memory = SPARE.with_borrow_mut(Vec::pop).unwrap_or_default();
        memory.left.clear();
        memory.right.clear();
        memory
    }

    pub(super) fn give_back(self) {
        SPARE.with_borrow_mut(|spare| spare.push(self));
    }
}

/// Whether a ray enters where it hits a surface.
pub(super) fn enters(surface: &Surface, ray: &Ray) -> bool {
    surface.normal.dot(ray.dir()) < 0.0
}

/// Whether all hits of an object are those of one solid made of solids, which say whether they
/// enter: also of one in an instance. Otherwise the surface has to be asked.
pub(super) fn is_told(object: &dyn Object) -> bool {
    let (mut count, mut told) = (0, object.kind() == "csg");
    if !told {
        object.visit_children(&mut |child| {
            count += 1;
            told = count == 1 && is_told(child);
        });
    }
    told
}

impl Track {
    fn clear(&mut self) {
        self.inside = false;
        self.events.clear();
    }

    /// Follows the whole ray; says whether it is ever inside.
    pub(super) fn follow(
        &mut self,
        operand: &impl Object,
        told: bool,
        ray: &Ray,
        hits: &mut Vec<Hit>,
        scratch: &mut Scratch,
    ) -> bool {
        hits.clear();
        operand.all_hits(ray, hits, scratch);
        self.events.extend(hits.iter().filter_map(|hit| {
            let enters = match told {
                true => hit.u != 0.0,
                false => enters(&operand.surface(ray, hit)?, ray),
            };
            Some(Event { t: hit.t, enters })
        }));
        self.events.sort_by(|a, b| a.t.total_cmp(&b.t).then(b.enters.cmp(&a.enters)));
        let bounds = operand.bounds();
        let bounded = bounds.is_bounded();
        self.settle(ray);
        if bounded && self.events.last().is_some_and(|last| last.enters) {
            // Nothing bounded goes on forever: the ray only grazed it.
            self.events.pop();
        }
        let start = Aabb { min: ray.origin(), max: ray.origin() };
        let outside = bounded && !bounds.padded().contains(&start);
        if outside && self.events.first().is_some_and(|first| !first.enters) {
            // Nor can it be left by who was not in it.
            self.events.remove(0);
        }
        self.inside = match self.events.first() {
            Some(first) => !first.enters,
            None => !bounded && is_inside(operand, ray, scratch),
        };
        self.inside || !self.events.is_empty()
    }

    /// Makes events alternate. An edge between two triangles may be hit twice, and a ray that
    /// grazes one may leave before it enters: what lies closer together than rounding can tell
    /// is taken for one event, or for none if it enters and leaves.
    fn settle(&mut self, ray: &Ray) {
        let events = &mut self.events;
        let mut kept = 0;
        let mut next = 0;
        while next < events.len() {
            let from = next;
            next += 1;
            while next < events.len()
                && events[next].t - events[next - 1].t <= blur(ray, events[next].t)
            {
                next += 1;
            }
            let together = &events[from..next];
            let entry = together.iter().find(|event| event.enters).copied();
            let exit = together.iter().rfind(|event| !event.enters).copied();
            let thin = together[0].enters && !together[together.len() - 1].enters;
            let before = kept > 0 && events[kept - 1].enters;
            let after = match (entry, exit) {
                (_, None) => true,
                (None, _) => false,
                _ => next < events.len() && !events[next].enters,
            };
            match (entry, exit) {
                // Another one on the way out: the last counts.
                (None, Some(exit)) if kept > 0 && !before => events[kept - 1] = exit,
                (None, Some(exit)) => {
                    events[kept] = exit;
                    kept += 1;
                }
                (Some(entry), Some(exit)) if !before && !after && thin => {
                    (events[kept], events[kept + 1]) = (entry, exit);
                    kept += 2;
                }
                (Some(entry), _) if !before && after => {
                    events[kept] = entry;
                    kept += 1;
                }
                (_, Some(exit)) if before && !after => {
                    events[kept] = exit;
                    kept += 1;
                }
                _ => {}
            }
        }
        events.truncate(kept);
    }
}

/// How far apart two hits of the same point may seem: a few roundings of `t` and of the
/// coordinates it comes from.
fn blur(ray: &Ray, t: f32) -> f32 {
    let reach = ray.origin().abs().max(ray.at(t).abs()).max_element();
    4.0 * f32::EPSILON * (reach / ray.dir().abs().max_element()).max(t)
}

/// Whether the start of a ray that meets nothing is inside something without bounds: seen by
/// what rays in other directions meet first.
#[cold]
fn is_inside(operand: &impl Object, ray: &Ray, scratch: &mut Scratch) -> bool {
    let axes = [Vec3A::X, Vec3A::Y, Vec3A::Z];
    let others = [-ray.dir()].into_iter().chain(axes).chain(axes.map(|axis| -axis));
    for dir in others {
        let other = Ray::new(ray.origin(), dir, ray.kind()).at_time(ray.time());
        let mut hit = Hit::none(other.t_max());
        if operand.closest_hit(&other, &mut hit, scratch)
            && let Some(surface) = operand.surface(&other, &hit)
        {
            return !enters(&surface, &other);
        }
    }
    false
}
