//! The C interface: names, types and meaning are those in `plugin` of `nestray-peers`.
#![allow(unsafe_code, reason = "called from another library")]

use std::ffi::c_char;
use std::slice;

use nestray_peers::rays::{HitRecord, RayRecord};
use nestray_peers::world::Mesh;

use crate::{PEERS, Peer};

/// What a handle points to.
struct Scene(Box<dyn Peer>);

#[unsafe(no_mangle)]
extern "C" fn nestray_peer_count() -> u32 {
    PEERS.len() as u32
}

#[unsafe(no_mangle)]
extern "C" fn nestray_peer_name(which: u32) -> *const c_char {
    PEERS[which as usize].name.as_ptr().cast()
}

#[unsafe(no_mangle)]
extern "C" fn nestray_peer_version(which: u32) -> *const c_char {
    PEERS[which as usize].version.as_ptr().cast()
}

/// # Safety
/// The lists are as long as said.
#[unsafe(no_mangle)]
unsafe extern "C" fn nestray_peer_new(
    which: u32,
    positions: *const [f32; 3],
    position_count: usize,
    faces: *const [u32; 3],
    face_count: usize,
) -> *mut Scene {
    // SAFETY: as above.
    let (positions, faces) = unsafe {
        (slice::from_raw_parts(positions, position_count), slice::from_raw_parts(faces, face_count))
    };
    let mesh = Mesh { positions: positions.to_vec(), faces: faces.to_vec() };
    Box::into_raw(Box::new(Scene((PEERS[which as usize].new)(mesh))))
}

/// # Safety
/// The scene is there, and nobody else has it.
#[unsafe(no_mangle)]
unsafe extern "C" fn nestray_peer_build(scene: *mut Scene) {
    // SAFETY: as above.
    unsafe { &mut *scene }.0.build();
}

/// # Safety
/// The scene is there.
#[unsafe(no_mangle)]
unsafe extern "C" fn nestray_peer_bytes(scene: *const Scene) -> u64 {
    // SAFETY: as above.
    unsafe { &*scene }.0.bytes()
}

/// # Safety
/// The scene is there, and the lists are as long as said.
#[unsafe(no_mangle)]
unsafe extern "C" fn nestray_peer_closest(
    scene: *const Scene,
    rays: *const RayRecord,
    hits: *mut HitRecord,
    count: usize,
) {
    // SAFETY: as above.
    unsafe {
        let (rays, hits) =
            (slice::from_raw_parts(rays, count), slice::from_raw_parts_mut(hits, count));
        (*scene).0.closest(rays, hits);
    }
}

/// # Safety
/// The scene is there, and the lists are as long as said.
#[unsafe(no_mangle)]
unsafe extern "C" fn nestray_peer_any(
    scene: *const Scene,
    rays: *const RayRecord,
    blocked: *mut bool,
    count: usize,
) {
    // SAFETY: as above.
    unsafe {
        let (rays, blocked) =
            (slice::from_raw_parts(rays, count), slice::from_raw_parts_mut(blocked, count));
        (*scene).0.any(rays, blocked);
    }
}

/// # Safety
/// The scene is there, and nobody uses it any more.
#[unsafe(no_mangle)]
unsafe extern "C" fn nestray_peer_free(scene: *mut Scene) {
    // SAFETY: as above.
    drop(unsafe { Box::from_raw(scene) });
}
