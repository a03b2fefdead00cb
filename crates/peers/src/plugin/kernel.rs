//! The interface of peers in shared libraries of our own.
#![allow(unsafe_code, reason = "functions of another library")]

use std::ffi::{CStr, c_char, c_void};
use std::mem::ManuallyDrop;
use std::path::Path;
use std::rc::Rc;

use libloading::Library;

use crate::rays::{HitRecord, RayRecord};
use crate::world::Mesh;

/// What a library keeps of a scene.
type Handle = *mut c_void;

/// The functions that every such library has, by these names.
struct Functions {
    count: unsafe extern "C" fn() -> u32,
    name: unsafe extern "C" fn(u32) -> *const c_char,
    version: unsafe extern "C" fn(u32) -> *const c_char,
    new: unsafe extern "C" fn(u32, *const [f32; 3], usize, *const [u32; 3], usize) -> Handle,
    build: unsafe extern "C" fn(Handle),
    bytes: unsafe extern "C" fn(Handle) -> u64,
    closest: unsafe extern "C" fn(Handle, *const RayRecord, *mut HitRecord, usize),
    any: unsafe extern "C" fn(Handle, *const RayRecord, *mut bool, usize),
    free: unsafe extern "C" fn(Handle),
}

/// A shared library with peers in it, numbered from 0.
pub(super) struct Plugin(Functions);

impl Plugin {
    pub(super) fn open(path: &Path) -> Result<Self, String> {
        let text = |error: libloading::Error| error.to_string();
        // SAFETY: libraries in the folders of peers are those that `cargo xtask peers` made.
        let library = unsafe { Library::new(path) }.map_err(text)?;
        // Never unloaded: it may have threads.
        let library = ManuallyDrop::new(library);
        // SAFETY: the types are those that both kinds of library declare.
        let functions = unsafe {
            Functions {
                count: *library.get("nestray_peer_count").map_err(text)?,
                name: *library.get("nestray_peer_name").map_err(text)?,
                version: *library.get("nestray_peer_version").map_err(text)?,
                new: *library.get("nestray_peer_new").map_err(text)?,
                build: *library.get("nestray_peer_build").map_err(text)?,
                bytes: *library.get("nestray_peer_bytes").map_err(text)?,
                closest: *library.get("nestray_peer_closest").map_err(text)?,
                any: *library.get("nestray_peer_any").map_err(text)?,
                free: *library.get("nestray_peer_free").map_err(text)?,
            }
        };
        Ok(Self(functions))
    }

    pub(super) fn count(&self) -> u32 {
        // SAFETY: it takes nothing.
        unsafe { (self.0.count)() }
    }

    /// Name and version of a peer.
    pub(super) fn names(&self, which: u32) -> [String; 2] {
        assert!(which < self.count());
        // SAFETY: there is such a peer; its words are constants with a zero at their ends.
        unsafe {
            [(self.0.name)(which), (self.0.version)(which)]
                .map(|text| CStr::from_ptr(text).to_string_lossy().into_owned())
        }
    }
}

/// A scene in one of the peers.
pub(super) struct Scene {
    plugin: Rc<Plugin>,
    handle: Handle,
}

impl Scene {
    /// Hands triangles over.
    pub(super) fn new(plugin: &Rc<Plugin>, which: u32, mesh: &Mesh) -> Self {
        let Mesh { positions, faces } = mesh;
        assert!(which < plugin.count());
        assert!(faces.iter().flatten().all(|&corner| (corner as usize) < positions.len()));
        let (corners, count) = (positions.as_ptr(), faces.len());
        // SAFETY: there is such a peer, both lists are so long, and all corners are there.
        let handle =
            unsafe { (plugin.0.new)(which, corners, positions.len(), faces.as_ptr(), count) };
        Self { plugin: Rc::clone(plugin), handle }
    }

    /// Puts them in order; to be done once, before anything else.
    pub(super) fn build(&mut self) {
        // SAFETY: the handle is there, and nobody else has it.
        unsafe { (self.plugin.0.build)(self.handle) };
    }

    pub(super) fn bytes(&self) -> u64 {
        // SAFETY: the handle is there.
        unsafe { (self.plugin.0.bytes)(self.handle) }
    }

    pub(super) fn closest(&self, rays: &[RayRecord], hits: &mut [HitRecord]) {
        assert_eq!(rays.len(), hits.len());
        let (rays, count) = (rays.as_ptr(), rays.len());
        // SAFETY: the handle is there; both lists are so long.
        unsafe { (self.plugin.0.closest)(self.handle, rays, hits.as_mut_ptr(), count) };
    }

    pub(super) fn any(&self, rays: &[RayRecord], blocked: &mut [bool]) {
        assert_eq!(rays.len(), blocked.len());
        let (rays, count) = (rays.as_ptr(), rays.len());
        // SAFETY: the handle is there; both lists are so long; what is written is 0 or 1.
        unsafe { (self.plugin.0.any)(self.handle, rays, blocked.as_mut_ptr(), count) };
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: made in `new`, and freed once.
        unsafe { (self.plugin.0.free)(self.handle) };
    }
}
