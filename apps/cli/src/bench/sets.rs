//! The rays that libraries are compared on: those of a path tracer's picture, and lines from
//! everywhere. The same scene, number and seed give the same rays.

mod camera;
mod random;

use nestray::batch::closest_hits;
use nestray::core::surface::Surface;
use nestray::prelude::{DynObject, Object as _, Ray, RayKind, Scene, Surfaces, Vec3A};
use nestray_peers::rays::{Kind, RayRecord};

use self::random::Random;
use crate::errors::Failure;

/// Length of ambient occlusion rays over the diagonal of the scene.
pub(crate) const AO_LENGTH: f32 = 0.05;

/// How far from a surface rays start that leave it, over the diagonal: ours may start as near as
/// numbers allow, but others would meet the surface again, and be done sooner.
const CLEAR: f32 = 2e-5;
/// How far before the box around everything chords start, over the diagonal: others count what is
/// met right at the start, or do not.
const BEFORE: f32 = 0.01;

/// Rounding in a few steps, over the diagonal.
const ROUNDING: f32 = 1e-6;

/// Rays of one kind.
pub(crate) struct RaySet {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    /// Whether it only matters that something is hit.
    pub(crate) any: bool,
    pub(crate) rays: Vec<RayRecord>,
    /// What numbers of the size of the scene are rounded by: distances are no surer.
    pub(crate) rounding: f32,
}

/// Names of the sets, and what they are.
pub(crate) const ABOUT: [(&str, &str); 6] = [
    ("primary", "from the eye, jittered, in tiles of 16 × 16 pixels in Morton order"),
    ("bounce", "from what those hit, by Lambert's law, without end"),
    ("chords", "uniform random lines through the box around the scene"),
    ("shadow", "from what the primary rays hit to a light at a point; any hit"),
    (
        "ao",
        "from what the primary rays hit, by Lambert's law, a twentieth of the scene's diagonal \
        long; any hit",
    ),
    ("long", "the bounce rays again; any hit"),
];

/// The six sets, of about `count` rays each and no more.
pub(crate) fn sets(
    scene: &Scene,
    world: &DynObject,
    count: usize,
    seed: u64,
) -> Result<Vec<RaySet>, Failure> {
    let surfaces = Surfaces::new(scene).map_err(|e| Failure::new(Failure::UNREADABLE, e))?;
    let primary = camera::tiles(scene, count, seed);
    let hits = closest_hits(world, &primary);
    let points: Vec<Surface> = primary
        .iter()
        .zip(&hits)
        .filter(|(_, hit)| hit.is_some())
        .map(|(ray, hit)| facing(surfaces.at(ray, hit).surface, ray.dir()))
        .collect();
    let light = camera::light(scene, world.bounds());
    let size = world.bounds().size().length();
    let start = |at: &Surface| at.position + at.normal * (CLEAR * size);
    let mut random = Random::new(seed ^ 1);
    let bounce: Vec<RayRecord> = points
        .iter()
        .map(|at| record(start(at), lambert(at, &mut random), f32::INFINITY))
        .collect();
    let ao = points.iter().map(|at| record(start(at), lambert(at, &mut random), AO_LENGTH * size));
    let ao = ao.collect();
    let shadow = points.iter().map(|at| record(start(at), light - start(at), 0.999)).collect();
    let primary = primary.iter().map(|ray| record(ray.origin(), ray.dir(), ray.t_max())).collect();
    let chords = chords(world, count, seed);
    let [a, b, c, d, e, f] = ABOUT.map(|(name, _)| name);
    let rounding = size * ROUNDING;
    let set = |name, kind, any, rays| RaySet { name, kind, any, rays, rounding };
    let mut sets = vec![
        set(a, Kind::Primary, false, primary),
        set(b, Kind::Bounce, false, bounce.clone()),
        set(c, Kind::Chord, false, chords),
        set(d, Kind::Shadow, true, shadow),
        set(e, Kind::Bounce, true, ao),
        set(f, Kind::Bounce, true, bounce),
    ];
    sets.retain(|set| !set.rays.is_empty());
    Ok(sets)
}

/// The surface with its front to whom looks along `dir`.
fn facing(at: Surface, dir: Vec3A) -> Surface {
    let normal = if at.normal.dot(dir) > 0.0 { -at.normal } else { at.normal };
    Surface { normal, ..at }
}

fn record(origin: Vec3A, dir: Vec3A, t_max: f32) -> RayRecord {
    RayRecord { origin: origin.to_array(), t_min: 0.0, dir: dir.to_array(), t_max }
}

/// A direction from a surface by Lambert's law, of unit length.
fn lambert(at: &Surface, random: &mut Random) -> Vec3A {
    // Towards a point on the sphere that touches the surface.
    (at.normal * 1.0001 + random.on_sphere()).normalize()
}

/// Lines of which each crosses the box around everything with the same chance as any other: from
/// points of its faces inwards, by the cosine law.
fn chords(world: &DynObject, count: usize, seed: u64) -> Vec<RayRecord> {
    let bounds = world.bounds();
    if bounds.is_empty() || !bounds.is_bounded() {
        return Vec::new();
    }
    let (size, mut random) = (bounds.size(), Random::new(seed ^ 2));
    let areas = [size.y * size.z, size.z * size.x, size.x * size.y];
    let chord = |_| {
        let mut which = random.part() * areas.iter().sum::<f32>();
        let mut axis = 0;
        while axis < 2 && which >= areas[axis] {
            which -= areas[axis];
            axis += 1;
        }
        let at = Vec3A::new(random.part(), random.part(), random.part());
        let (mut at, mut inwards) = (bounds.min + size * at, Vec3A::ZERO);
        (at[axis], inwards[axis]) =
            if random.part() < 0.5 { (bounds.min[axis], 1.0) } else { (bounds.max[axis], -1.0) };
        let dir = (inwards * 1.0001 + random.on_sphere()).normalize();
        record(at - dir * (BEFORE * size.length()), dir, f32::INFINITY)
    };
    (0..count).map(chord).collect()
}

/// The same ray for our own objects.
#[inline]
pub(crate) fn ray(record: &RayRecord, kind: RayKind) -> Ray {
    Ray::new(record.origin.into(), record.dir.into(), kind).between(record.t_min, record.t_max)
}
