use nestray_peers::rays::{HitRecord, RayRecord};
use nestray_peers::world::Mesh;

use super::PEERS;

#[test]
fn every_library_finds_the_nearer_of_two_triangles() {
    let square = |z: f32| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
    let mut positions = Vec::new();
    // Some that are never hit: trees of one leaf are special to some.
    for (i, z) in (0..40).map(|i| (i, if i < 2 { 2.0 - i as f32 } else { 5.0 })) {
        let aside = if i < 2 { 0.0 } else { 3.0 * i as f32 };
        positions.extend(square(z).map(|[x, y, z]| [x + aside, y, z]));
    }
    let faces: Vec<[u32; 3]> = (0..40).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let ray = |z: f32, t_max: f32| RayRecord {
        origin: [0.25, 0.25, 0.0],
        t_min: 0.0,
        dir: [0.0, 0.0, z],
        t_max,
    };
    let rays = [ray(0.5, f32::INFINITY), ray(0.5, 1.9), ray(-0.5, f32::INFINITY)];
    for entry in PEERS {
        let mut peer = (entry.new)(Mesh { positions: positions.clone(), faces: faces.clone() });
        peer.build();
        assert!(peer.bytes() > 40 * 36, "{}", entry.name);
        let (mut hits, mut blocked) = ([HitRecord::MISS; 3], [true; 3]);
        peer.closest(&rays, &mut hits);
        peer.any(&rays, &mut blocked);
        assert_eq!(hits.map(|hit| hit.t), [2.0, f32::INFINITY, f32::INFINITY], "{}", entry.name);
        assert_eq!(blocked, [true, false, false], "{}", entry.name);
        assert!(entry.name.ends_with('\0') && entry.version.ends_with('\0'));
    }
}
