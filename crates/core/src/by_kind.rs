//! Different structures for different kinds of ray.

use crate::aabb::Aabb;
use crate::cost::{Cost, CostModel};
use crate::hit::Hit;
use crate::object::Object;
use crate::ray::{Ray, RayKind, Source};
use crate::scratch::Scratch;
use crate::surface::Surface;

/// Sends the rays of some kinds to objects of their own and all others to another. All must
/// hold the same geometry.
#[derive(Debug)]
pub struct ByKind<O> {
    cases: Vec<(Case, O)>,
    other: O,
}

/// Which rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Case {
    /// [`RayKind::Camera`].
    Camera,
    /// [`RayKind::Shadow`], towards one light or towards any.
    Shadow(Option<u16>),
    /// [`RayKind::Reflect`].
    Reflect,
    /// [`RayKind::Refract`].
    Refract,
    /// [`RayKind::Diffuse`].
    Diffuse,
    /// [`RayKind::Custom`], one or any.
    Custom(Option<u8>),
}

impl Case {
    /// Whether rays of this kind are meant.
    #[must_use]
    pub fn matches(self, kind: RayKind) -> bool {
        match (self, kind) {
            (Self::Camera, RayKind::Camera)
            | (Self::Reflect, RayKind::Reflect)
            | (Self::Refract, RayKind::Refract)
            | (Self::Diffuse, RayKind::Diffuse) => true,
            (Self::Shadow(light), RayKind::Shadow { light: of }) => light.is_none_or(|l| l == of),
            (Self::Custom(number), RayKind::Custom(of)) => number.is_none_or(|n| n == of),
            _ => false,
        }
    }
}

impl<O: Object> ByKind<O> {
    /// The first of `cases` that matches serves a ray, `other` if none does.
    #[must_use]
    pub fn new(cases: Vec<(Case, O)>, other: O) -> Self {
        Self { cases, other }
    }

    /// What serves rays of this kind.
    pub fn serving(&self, kind: RayKind) -> &O {
        self.object(self.number(kind))
    }

    fn objects(&self) -> impl Iterator<Item = &O> {
        self.cases.iter().map(|(_, object)| object).chain([&self.other])
    }

    /// Which object serves rays of this kind: the number of its case, or how many there are.
    fn number(&self, kind: RayKind) -> usize {
        let case = self.cases.iter().position(|(case, _)| case.matches(kind));
        case.unwrap_or(self.cases.len())
    }

    fn object(&self, number: usize) -> &O {
        self.cases.get(number).map_or(&self.other, |(_, object)| object)
    }

    /// Calls `ask` with each object and rays that it serves, as many as there are in a row; those of
    /// short rows are put together. Then `answers` has theirs.
    fn by_object<A: Copy>(
        &self,
        rays: &[Ray],
        answers: &mut [A],
        mut ask: impl FnMut(&O, &[Ray], &mut [A]),
    ) {
        /// Rays in a row that are worth a batch of their own.
        const ROW: usize = 64;
        let mut scattered = vec![Vec::new(); self.cases.len() + 1];
        let mut start = 0;
        while start < rays.len() {
            let number = self.number(rays[start].kind());
            let same = |ray: &&Ray| self.number(ray.kind()) == number;
            let end = start + rays[start..].iter().take_while(same).count();
            if end - start >= ROW || end - start == rays.len() {
                ask(self.object(number), &rays[start..end], &mut answers[start..end]);
            } else {
                scattered[number].extend(start..end);
            }
            start = end;
        }
        for (number, which) in scattered.into_iter().enumerate() {
            if which.is_empty() {
                continue;
            }
            let mine: Vec<Ray> = which.iter().map(|&nth| rays[nth]).collect();
            let mut found: Vec<A> = which.iter().map(|&nth| answers[nth]).collect();
            ask(self.object(number), &mine, &mut found);
            which.into_iter().zip(found).for_each(|(nth, answer)| answers[nth] = answer);
        }
    }
}

impl<O: Object> Object for ByKind<O> {
    fn kind(&self) -> &'static str {
        "by-kind"
    }

    fn bounds(&self) -> Aabb {
        self.objects()
            .map(Object::bounds)
            .filter(|bounds| !bounds.is_empty())
            .fold(Aabb::EMPTY, Aabb::join)
    }

    fn bounds_during(&self, time: [f32; 2]) -> Aabb {
        self.objects()
            .map(|object| object.bounds_during(time))
            .filter(|bounds| !bounds.is_empty())
            .fold(Aabb::EMPTY, Aabb::join)
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        self.serving(ray.kind()).closest_hit(ray, hit, scratch)
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.serving(ray.kind()).any_hit(ray, scratch)
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        self.serving(ray.kind()).all_hits(ray, hits, scratch);
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        self.by_object(rays, hits, |object, rays, hits| object.closest_hits(rays, hits, scratch));
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        self.by_object(rays, blocked, |object, rays, blocked| {
            object.any_hits(rays, blocked, scratch);
        });
    }

    fn parts(&self, kind: RayKind) -> bool {
        self.serving(kind).parts(kind)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.serving(ray.kind()).surface(ray, hit)
    }

    fn holds(&self, source: &Source) -> bool {
        self.other.holds(source)
    }

    fn paths(&self) -> u32 {
        self.objects().map(Object::paths).max().unwrap_or(1)
    }

    /// Of the kind under study, or of those that have no object of their own; all memory.
    fn cost(&self, model: &CostModel) -> Cost {
        let serving = model.kind.map_or(&self.other, |kind| self.serving(kind));
        let bytes = self.objects().map(|object| object.cost(model).bytes).sum();
        Cost { bytes, ..serving.cost(model) }
    }

    fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
        for object in self.objects() {
            visit(object);
        }
    }
}
