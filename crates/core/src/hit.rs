//! The answer to a nearest-hit query.

/// The nearest hit found so far. Small on purpose: positions, normals and
/// texture coordinates are worked out once, after the search is over, by
/// [`Object::surface`](crate::object::Object::surface).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter; also the limit beyond which nothing needs testing.
    pub t: f32,
    /// First surface coordinate (barycentric for triangles).
    pub u: f32,
    /// Second surface coordinate.
    pub v: f32,
    /// Which geometry of the scene, or [`Hit::NOTHING`].
    pub geometry: u32,
    /// Which primitive of that geometry.
    pub primitive: u32,
    /// The instances passed through.
    pub path: InstancePath,
}

impl Hit {
    /// The `geometry` of a hit that is none.
    pub const NOTHING: u32 = u32::MAX;

    /// No hit yet, nothing wanted beyond `t_max`.
    #[inline]
    #[must_use]
    pub const fn none(t_max: f32) -> Self {
        Self {
            t: t_max,
            u: 0.0,
            v: 0.0,
            geometry: Self::NOTHING,
            primitive: Self::NOTHING,
            path: InstancePath::NONE,
        }
    }

    /// Whether it is one.
    #[inline]
    #[must_use]
    pub const fn is_some(&self) -> bool {
        self.geometry != Self::NOTHING
    }

    /// Replaces this hit if the new one is nearer, and says whether it did. Equal
    /// distances go to the lower `(geometry, primitive)`: so every nest of the
    /// same scene gives the same answer, whatever order it tests children in.
    ///
    /// A NaN `t` is never nearer.
    #[inline(always)]
    pub fn offer(&mut self, t: f32, [u, v]: [f32; 2], geometry: u32, primitive: u32) -> bool {
        let new = Self { t, u, v, geometry, primitive, path: InstancePath::NONE };
        let nearer = new.is_before(self);
        if nearer {
            *self = new;
        }
        nearer
    }

    /// Whether it replaces `other`: it is nearer, or as near and of lower
    /// `(geometry, primitive, path)`.
    #[inline(always)]
    #[must_use]
    pub fn is_before(&self, other: &Self) -> bool {
        self.t < other.t || (self.t == other.t && self.id() < other.id())
    }

    /// What it is a hit of: geometry, primitive, path.
    #[inline(always)]
    #[must_use]
    pub fn id(&self) -> (u32, u32, InstancePath) {
        (self.geometry, self.primitive, self.path)
    }
}

/// The chain of instances between a hit and the world, as one number.
///
/// The places of a hierarchy of instances are numbered as in a preorder walk of the
/// hierarchy written out in full: the world is 0, its first instance 1, the instances
/// inside that one follow, and so on. Every instance adds its own number on the way out,
/// so any depth takes one word and one addition. Instances that share a parent must
/// be numbered with room for what is inside ([`Object::paths`]); whoever builds the
/// hierarchy checks that the whole fits 32 bits.
///
/// [`Object::paths`]: crate::object::Object::paths
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct InstancePath(u32);

impl InstancePath {
    /// In no instance.
    pub const NONE: Self = Self(0);

    /// The place with this number.
    #[inline]
    #[must_use]
    pub const fn numbered(number: u32) -> Self {
        Self(number)
    }

    /// Its number; 0 is no instance.
    #[inline]
    #[must_use]
    pub const fn number(self) -> u32 {
        self.0
    }

    /// As seen from outside the instance numbered `first` (at least 1).
    #[inline(always)]
    #[must_use]
    pub const fn outside(self, first: u32) -> Self {
        Self(self.0.wrapping_add(first))
    }

    /// As seen from inside the instance numbered `first` that has `paths` paths inside; none
    /// if it does not lead through that instance.
    #[inline(always)]
    #[must_use]
    pub const fn inside(self, first: u32, paths: u32) -> Option<Self> {
        let inside = self.0.wrapping_sub(first);
        if inside < paths { Some(Self(inside)) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_distances_go_to_the_lower_id() {
        let mut hit = Hit::none(2.0);
        assert!(hit.offer(2.0, [0.0; 2], 7, 1), "exactly at the limit counts");
        assert!(!hit.offer(2.0, [0.0; 2], 7, 2));
        assert!(hit.offer(2.0, [0.0; 2], 6, 9));
        assert!(!hit.offer(f32::NAN, [0.0; 2], 0, 0));
        assert_eq!((hit.geometry, hit.primitive), (6, 9));
    }

    #[test]
    fn a_path_leads_in_and_out_again() {
        let path = InstancePath::NONE.outside(3).outside(10);
        assert_eq!(path.number(), 13);
        assert_eq!(path.inside(10, 5).and_then(|p| p.inside(3, 1)), Some(InstancePath::NONE));
        assert_eq!(path.inside(14, 5), None);
        assert_eq!(InstancePath::NONE.inside(1, 9), None);
    }
}
