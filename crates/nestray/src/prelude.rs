//! What most programs use, by one `use nestray::prelude::*`.

pub use glam::{Affine3A, Quat, Vec3, Vec3A};
pub use nestray_core::aabb::Aabb;
pub use nestray_core::by_kind::{ByKind, Case};
pub use nestray_core::hit::{Hit, InstancePath};
pub use nestray_core::instance::Instance;
pub use nestray_core::lazy::Lazy;
pub use nestray_core::moving::{Keys, Moving};
pub use nestray_core::object::{Aggregate, DynObject, Object};
pub use nestray_core::ray::{Ray, RayKind, Source};
pub use nestray_core::scratch::Scratch;
pub use nestray_core::surface::Surface;
pub use nestray_io::load::{LoadOptions, Loaded, load};
pub use nestray_plan::build::build;
pub use nestray_plan::check::check;
pub use nestray_plan::error::PlanError;
pub use nestray_plan::plan::Plan;
pub use nestray_plan::single::single;
pub use nestray_render::options::{Integrator, Options};
pub use nestray_render::render::{Rendered, render};
pub use nestray_render::watch::{Unwatched, Watch};
pub use nestray_scene::camera::Camera;
pub use nestray_scene::geometry::{Content, Geometry};
pub use nestray_scene::group::{Group, Motion, Place};
pub use nestray_scene::light::Light;
pub use nestray_scene::material::Material;
pub use nestray_scene::scene::Scene;
pub use nestray_scene::surfaces::Surfaces;
pub use nestray_shapes::any::AnyShape;
pub use nestray_shapes::shape::{Shape, Sides, Single};
pub use nestray_shapes::sphere::Sphere;
pub use nestray_shapes::triangle_mesh::{TriangleMesh, TriangleSoup, Triangles};

pub use crate::batch::{all_hits, any_hits, closest_hits};
