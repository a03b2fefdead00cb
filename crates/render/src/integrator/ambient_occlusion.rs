//! How open the surroundings of a point are: the share of directions, weighted by their
//! cosine, in which nothing is near.

use glam::Vec3A;
use nestray_core::ray::{Ray, RayKind};

use super::{Integrate, note};
use crate::directions::{Frame, cosine_weighted};
use crate::eye::{Seen, Start};
use crate::integrator::path::passes_by_chance;
use crate::look::Look;
use crate::sampler::Set;
use crate::tracer::{Tracer, source};

/// See [`Integrator::AmbientOcclusion`](crate::options::Integrator).
pub(crate) struct AmbientOcclusion {
    pub(crate) radius: f32,
}

impl Integrate for AmbientOcclusion {
    fn trace(&mut self, tracer: &mut Tracer<'_>, starts: &[Start], seen: &mut Vec<Seen>) {
        seen.clear();
        seen.resize(starts.len(), Seen { color: Vec3A::ONE, ..Seen::NOTHING });
        let mut rays: Vec<Ray> = starts.iter().map(|start| start.ray).collect();
        let mut hits = Vec::new();
        tracer.closest_solid(&mut rays, &mut hits, |i, tries, alpha| {
            passes_by_chance(&starts[i], 1, tries, alpha)
        });
        let (mut probes, mut which) = (Vec::new(), Vec::new());
        for (i, (ray, hit)) in rays.iter().zip(&hits).enumerate().filter(|(_, (_, h))| h.is_some())
        {
            let point = tracer.point(ray, hit);
            let look = Look::at(tracer.scene(), &point);
            note(&mut seen[i], &starts[i], ray, hit, &point, &look);
            let surface = &point.surface;
            // About the true normal: what is open is a matter of shape.
            let normal =
                if ray.dir().dot(surface.normal) > 0.0 { -surface.normal } else { surface.normal };
            let [u, v, ..] = starts[i].sampler.four(Set::Scatter(1));
            let dir = Frame::about(normal).world(cosine_weighted([u, v]));
            probes.push(
                Ray::new(surface.leave(dir), dir, RayKind::Diffuse)
                    .between(0.0, self.radius)
                    .at_time(ray.time())
                    .leaving(source(hit)),
            );
            which.push(i);
        }
        let mut passing = Vec::new();
        tracer.passing(&probes, &mut passing);
        for (i, open) in which.into_iter().zip(passing) {
            seen[i].color = Vec3A::splat(open);
        }
    }
}
