//! The control points of Newell's teapot [Newell 75], with the bottom that Crow gave it,
//! from the few numbers they come from: turned parts, the handle, the spout.

use glam::DVec3;
use nestray_shapes::bezier::BezierPatch;
use nestray_shapes::triangle_mesh::Triangles;

use super::mesh::Mesh;

/// Newell's teapot, as its 32 patches, fronts outside: rim, body, handle, spout, lid and
/// bottom. It stands on the xy-plane, 3.15 high, its spout towards +x.
#[must_use]
pub fn newell_teapot() -> Vec<BezierPatch> {
    let patch = |net: Net| {
        let points = net.map(|row| row.map(|point| point.as_vec3a() + 0.0));
        BezierPatch { points }.turned()
    };
    nets().into_iter().map(patch).collect()
}

/// Newell's teapot as a smooth mesh, each patch cut into `cells × cells` pairs of triangles
/// less those that have no area.
///
/// # Panics
/// If that is more vertices than 32 bits can number.
#[must_use]
pub fn newell_mesh(cells: u32) -> Triangles {
    let mut mesh = Mesh::default();
    for net in nets() {
        let at = |i: u32| f64::from(i) / f64::from(cells);
        let first = mesh.corners(cells, |s, t| surface(&net, at(s), at(t)));
        for cell in 0..cells * cells {
            let (s, t) = (cell / cells, cell % cells);
            let corner = |s: u32, t: u32| first + s * (cells + 1) + t;
            let corners = [corner(s, t), corner(s, t + 1), corner(s + 1, t + 1), corner(s + 1, t)];
            for triangle in [[0, 1, 2], [2, 3, 0]] {
                mesh.face_with_area(triangle.map(|i: usize| corners[i]));
            }
        }
    }
    mesh.finish()
}

/// The point of a patch and its unit normal, which points outside.
pub(super) fn surface(net: &Net, s: f64, t: f64) -> (DVec3, DVec3) {
    let [place, down, along] = point(net, s, t);
    if is_pole(place) {
        // The middle of the lid or of the bottom: a whole row is one point there.
        return (place, DVec3::Z * (place.z - 1.5).signum());
    }
    (place, along.cross(down).normalize_or_zero())
}

/// Whether a point of the teapot is on its axis.
pub(super) fn is_pole(place: DVec3) -> bool {
    place.x.abs() < 1e-4 && place.y.abs() < 1e-4
}

/// The control points of a bicubic patch, row by row.
pub(super) type Net = [[DVec3; 4]; 4];

/// All 32 patches: rim, body, handle, spout, lid, bottom. It stands on the xy-plane, the
/// spout towards +x.
pub(super) fn nets() -> Vec<Net> {
    let mut nets = Vec::with_capacity(32);
    for profile in [RIM, BODY[0], BODY[1]] {
        nets.extend(turned(profile, -1.0));
    }
    for half in HANDLE.iter().chain(&SPOUT) {
        nets.extend([side(half, -1.0), side(half, 1.0)]);
    }
    for profile in LID {
        nets.extend(turned(profile, -1.0));
    }
    nets.extend(turned(BOTTOM, 1.0));
    nets
}

/// Distance from the axis and height, for each row.
type Profile = [[f64; 2]; 4];

const RIM: Profile = [[1.4, 2.4], [1.3375, 2.53125], [1.4375, 2.53125], [1.5, 2.4]];
const BODY: [Profile; 2] = [
    [[1.5, 2.4], [1.75, 1.875], [2.0, 1.35], [2.0, 0.9]],
    [[2.0, 0.9], [2.0, 0.45], [1.5, 0.225], [1.5, 0.15]],
];
const LID: [Profile; 2] = [
    [[0.0, 3.15], [0.8, 3.15], [0.0, 2.85], [0.2, 2.7]],
    [[0.2, 2.7], [0.4, 2.55], [1.3, 2.55], [1.3, 2.4]],
];
const BOTTOM: Profile = [[0.0, 0.0], [1.425, 0.0], [1.5, 0.075], [1.5, 0.15]];

/// Half of a part along y = 0: for each row its half-width and the x and z of its inner and
/// its outer edge.
type Half = [(f64, [f64; 2], [f64; 2]); 4];

const HANDLE: [Half; 2] = [
    [
        (0.3, [-1.6, 2.025], [-1.5, 2.25]),
        (0.3, [-2.3, 2.025], [-2.5, 2.25]),
        (0.3, [-2.7, 2.025], [-3.0, 2.25]),
        (0.3, [-2.7, 1.8], [-3.0, 1.8]),
    ],
    [
        (0.3, [-2.7, 1.8], [-3.0, 1.8]),
        (0.3, [-2.7, 1.575], [-3.0, 1.35]),
        (0.3, [-2.5, 1.125], [-2.65, 0.9375]),
        (0.3, [-2.0, 0.9], [-1.9, 0.6]),
    ],
];
const SPOUT: [Half; 2] = [
    [
        (0.66, [1.7, 1.425], [1.7, 0.6]),
        (0.66, [2.6, 1.425], [3.1, 0.825]),
        (0.25, [2.3, 2.1], [2.4, 2.025]),
        (0.25, [2.7, 2.4], [3.3, 2.4]),
    ],
    [
        (0.25, [2.7, 2.4], [3.3, 2.4]),
        (0.25, [2.8, 2.475], [3.525, 2.49375]),
        (0.15, [2.9, 2.475], [3.45, 2.5125]),
        (0.15, [2.8, 2.4], [3.2, 2.4]),
    ],
];

/// The four quarters of a part turned about the z-axis, the first from +x towards −y if
/// `way` is −1, towards +y if it is 1.
fn turned(profile: Profile, way: f64) -> [Net; 4] {
    std::array::from_fn(|quarter| {
        profile.map(|[radius, z]| {
            // The published table rounds one row.
            let bulge = if radius == 0.8 { 0.45 } else { 0.56 * radius };
            let arc = [(radius, 0.0), (radius, bulge), (bulge, radius), (0.0, radius)];
            arc.map(|(x, y)| {
                let (x, y) = (0..quarter).fold((x, y), |(x, y), _| (-y, x));
                DVec3::new(x, y * way, z)
            })
        })
    })
}

/// One side of a part: from its inner edge outwards at −y, back inwards at +y.
fn side(half: &Half, way: f64) -> Net {
    half.map(|(width, inner, outer)| {
        let point = |[x, z]: [f64; 2], y: f64| DVec3::new(x, y, z);
        let (first, last) = if way < 0.0 { (inner, outer) } else { (outer, inner) };
        let y = width * way;
        [point(first, 0.0), point(first, y), point(last, y), point(last, 0.0)]
    })
}

/// The point of a patch, and the derivatives down the rows and along them.
fn point(net: &Net, s: f64, t: f64) -> [DVec3; 3] {
    let (down, along) = (weights(s), weights(t));
    let sum = |down: [f64; 4], along: [f64; 4]| {
        let row = |r: usize| (0..4).map(|c| net[r][c] * along[c]).sum::<DVec3>() * down[r];
        (0..4).map(row).sum::<DVec3>()
    };
    [sum(down.0, along.0), sum(down.1, along.0), sum(down.0, along.1)]
}

/// Bernstein's cubic polynomials and their derivatives.
fn weights(x: f64) -> ([f64; 4], [f64; 4]) {
    let y = 1.0 - x;
    let value = [y * y * y, 3.0 * x * y * y, 3.0 * x * x * y, x * x * x];
    let slope = [-3.0 * y * y, 3.0 * y * y - 6.0 * x * y, 6.0 * x * y - 3.0 * x * x, 3.0 * x * x];
    (value, slope)
}
