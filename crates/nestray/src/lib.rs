//! Ray tracing by nested acceleration techniques.
//!
//! Objects of any technique may stand in aggregates of any other, to any depth, and every
//! nest answers alike, bit for bit: which one is fastest is a matter of measuring.
//!
//! ```
//! use nestray::prelude::*;
//!
//! // A scene: two triangles for a floor, and a thousand balls above it.
//! let mut scene = Scene::new();
//! let corners = [[-50.0, 0.0, -50.0], [50.0, 0.0, -50.0], [50.0, 0.0, 50.0], [-50.0, 0.0, 50.0]];
//! let floor = Triangles::new(corners.to_vec(), vec![[2, 1, 0], [3, 2, 0]])?;
//! scene.add(Geometry::mesh("floor", 0, floor));
//! let balls = (0..1000).map(|i| {
//!     let center = Vec3A::new((i % 40) as f32 - 20.0, 1.0, (i / 40) as f32 - 12.0);
//!     Sphere { center, radius: 0.4 }.into()
//! });
//! scene.add(Geometry::shapes("balls", 0, balls.collect()));
//!
//! // A plan says what is nested in what: here balls in a grid, and all in a hierarchy of boxes.
//! let plan = Plan::from_json(
//!     r#"{ "version": 1, "root": { "nest": { "technique": "bvh", "children": [
//!          { "pick": "floor" },
//!          { "nest": { "technique": "grid", "children": [ { "pick": "balls" } ] } } ] } } }"#,
//! )?;
//! let world = build(&plan, &scene)?;
//!
//! // One ray, straight down onto a ball.
//! let ray = Ray::new(Vec3A::new(0.0, 10.0, 0.0), Vec3A::NEG_Y, RayKind::Camera);
//! let mut hit = Hit::none(ray.t_max());
//! assert!(world.closest_hit(&ray, &mut hit, &mut Scratch::new()));
//! assert_eq!((hit.geometry, hit.primitive), (1, 500));
//! let surface = world.surface(&ray, &hit).expect("it was hit");
//! assert!(surface.normal.y > 0.999);
//!
//! // Many rays, on all threads.
//! let rays: Vec<Ray> = (0..10_000)
//!     .map(|i| {
//!         let dir = Vec3A::new((i % 100) as f32 - 50.0, -60.0, (i / 100) as f32 - 50.0);
//!         Ray::new(Vec3A::new(0.0, 10.0, 0.0), dir, RayKind::Camera)
//!     })
//!     .collect();
//! let hits = closest_hits(&world, &rays);
//! assert!(hits.iter().all(Hit::is_some));
//!
//! // Every plan gives the same answers.
//! let list = build(&single("list", Default::default(), &scene)?, &scene)?;
//! assert_eq!(closest_hits(&list, &rays), hits);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod batch;

pub mod prelude;

pub use glam;
pub use nestray_core as core;
pub use nestray_io as io;
pub use nestray_plan as plan;
pub use nestray_registry as registry;
pub use nestray_render as render;
pub use nestray_scene as scene;
pub use nestray_shapes as shapes;
pub use nestray_techniques as techniques;

/// The code of the README compiles.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
