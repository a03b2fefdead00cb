//! Places of a patch and how it lies there, in space.

use glam::{DVec3, Vec3A};

use super::net::Weights;

/// A place of a patch.
pub(super) struct Place {
    pub(super) point: DVec3,
    by_u: DVec3,
    by_v: DVec3,
    by_uv: DVec3,
    /// Second derivatives by `u` and by `v`.
    bends: [DVec3; 2],
}

/// What each control point counts for the second derivative.
fn bend(u: f64) -> [f64; 4] {
    let v = 1.0 - u;
    [6.0 * v, 6.0 * (u - 2.0 * v), 6.0 * (v - 2.0 * u), 6.0 * u]
}

impl Place {
    pub(super) fn new(points: &[[Vec3A; 4]; 4], [u, v]: [f64; 2]) -> Self {
        let sum = |a: &[f64; 4], b: &[f64; 4]| {
            let mut sum = DVec3::ZERO;
            for i in 0..4 {
                for j in 0..4 {
                    sum += points[i][j].as_dvec3() * (a[i] * b[j]);
                }
            }
            sum
        };
        let (a, b) = (Weights::new(u), Weights::new(v));
        Self {
            point: sum(&a.value, &b.value),
            by_u: sum(&a.slope, &b.value),
            by_v: sum(&a.value, &b.slope),
            by_uv: sum(&a.slope, &b.slope),
            bends: [sum(&bend(u), &b.value), sum(&a.value, &bend(v))],
        }
    }

    /// The unit normal of the patch at `uv`, and the unit direction along which `u` grows.
    ///
    /// Where an edge is drawn together into a point, or derivatives vanish, it is the limit
    /// on the way to the middle of the patch: to first order, by second derivatives; failing
    /// that, as a little farther in. None if the patch is nowhere smooth on that way.
    pub(super) fn normal(points: &[[Vec3A; 4]; 4], uv: [f64; 2]) -> Option<(DVec3, DVec3)> {
        let size = points
            .as_flattened()
            .iter()
            .fold(0.0f64, |most, &p| most.max((p - points[0][0]).as_dvec3().abs().max_element()));
        let enough = size * size * 1e-12;
        for inwards in [0.0, 1e-4, 1e-2, 0.3, 1.0] {
            let uv = uv.map(|u| u + (0.5 - u) * inwards);
            let place = Self::new(points, uv);
            let normal = place.by_u.cross(place.by_v);
            if normal.length() > enough {
                return Some((normal.normalize(), place.tangent(normal)));
            }
            let [hu, hv] = uv.map(|u| 0.5 - u);
            let change_u = place.bends[0] * hu + place.by_uv * hv;
            let change_v = place.by_uv * hu + place.bends[1] * hv;
            let limit = change_u.cross(place.by_v) + place.by_u.cross(change_v);
            if limit.length() > enough {
                let normal = limit.normalize();
                return Some((normal, place.tangent(normal)));
            }
        }
        None
    }

    /// The direction of growing `u`, at a right angle to the normal.
    fn tangent(&self, normal: DVec3) -> DVec3 {
        self.by_u.try_normalize().unwrap_or_else(|| self.by_v.cross(normal).normalize_or_zero())
    }
}
