use super::*;

/// Two triangles, one behind the other, and the near one again, far to the side.
fn world() -> World {
    let square = |z: f32| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
    let mesh = |z: &[f32]| Mesh {
        positions: z.iter().flat_map(|&z| square(z)).collect(),
        faces: (0..z.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    };
    let aside = glam::Affine3A::from_translation(glam::Vec3::new(10.0, 0.0, 0.0));
    World {
        fixed: mesh(&[2.0, 1.0]),
        meshes: vec![mesh(&[1.0])],
        places: vec![crate::world::Place { mesh: 0, world_from_mesh: aside }],
    }
}

#[test]
fn every_way_gives_the_same_answers() {
    let ray = |x: f32, t_max: f32| RayRecord {
        origin: [x, 0.25, 0.0],
        t_min: 0.0,
        dir: [0.0, 0.0, 0.5],
        t_max,
    };
    let mut rays = vec![ray(0.25, f32::INFINITY), ray(10.25, f32::INFINITY)];
    rays.extend((0..17).map(|i| ray(0.25, if i % 2 == 0 { 1.9 } else { 2.1 })));
    let all = match Embree::all(&world()) {
        Ok(all) => all,
        Err(missing) => {
            eprintln!("skipped: {missing}");
            return;
        }
    };
    for embree in all {
        assert!(embree.bytes() > 0);
        for &way in embree.ways() {
            let mut hits = vec![HitRecord::MISS; rays.len()];
            embree.closest(way, Kind::Primary, &rays, &mut hits);
            let mut blocked = vec![true; rays.len()];
            embree.any(way, Kind::Bounce, &rays, &mut blocked);
            assert_eq!((hits[0].t, hits[0].primitive), (2.0, 1), "{way:?}");
            assert_eq!((hits[1].t, hits[1].primitive), (2.0, 0), "{way:?}: in an instance");
            for (i, hit) in hits.iter().enumerate().skip(2) {
                assert_eq!(hit.t == 2.0, i % 2 == 1, "{way:?} {i}");
            }
            let hit: Vec<bool> = hits.iter().map(|hit| *hit != HitRecord::MISS).collect();
            assert_eq!(blocked, hit, "{way:?}");
        }
    }
}
