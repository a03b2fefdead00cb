//! Embree 4 through its C interface, found at run time. Layouts and numbers are those of its
//! public headers (`rtcore_*.h`, versions 4.0 to 4.4).
#![allow(unsafe_code, reason = "a library in C")]

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::mem::ManuallyDrop;
use std::path::Path;
use std::ptr;
use std::rc::Rc;
use std::sync::atomic::{AtomicI64, Ordering};

use libloading::Library;

/// What an Embree call works on: a device, a scene or a geometry.
type Handle = *mut c_void;

/// `RTCRayHit` of one ray (`N` = 1) or of packets: rows of `N`.
///
/// Hits end with one word per instance level and, since 4.3, one per array of instances.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
pub(super) struct RayHit<const N: usize> {
    /// Origin, then `tnear`, then direction, then time.
    pub(super) origin: [[f32; N]; 3],
    pub(super) near: [f32; N],
    pub(super) dir: [[f32; N]; 3],
    pub(super) time: [f32; N],
    /// `tfar`: how far the ray goes; −∞ once an any-hit query found something.
    pub(super) far: [f32; N],
    pub(super) mask: [c_uint; N],
    id: [c_uint; N],
    flags: [c_uint; N],
    normal: [[f32; N]; 3],
    pub(super) u: [f32; N],
    pub(super) v: [f32; N],
    pub(super) primitive: [c_uint; N],
    pub(super) geometry: [c_uint; N],
    instance: [[c_uint; N]; 2],
}

/// `RTC_INVALID_GEOMETRY_ID`.
pub(super) const NOTHING: c_uint = c_uint::MAX;

impl<const N: usize> RayHit<N> {
    /// Rays that are about nothing yet.
    pub(super) const NEW: Self = Self {
        origin: [[0.0; N]; 3],
        near: [0.0; N],
        dir: [[0.0; N]; 3],
        time: [0.0; N],
        far: [0.0; N],
        mask: [c_uint::MAX; N],
        id: [0; N],
        flags: [0; N],
        normal: [[0.0; N]; 3],
        u: [0.0; N],
        v: [0.0; N],
        primitive: [NOTHING; N],
        geometry: [NOTHING; N],
        instance: [[NOTHING; N]; 2],
    };
}

/// `int valid[16]`: −1 where there is a ray.
#[repr(C, align(64))]
pub(super) struct Valid(pub(super) [c_int; 16]);

/// `RTCIntersectArguments` and `RTCOccludedArguments`, which are alike, with room to grow.
#[repr(C)]
pub(super) struct Arguments {
    flags: c_uint,
    features: c_uint,
    rest: [*mut c_void; 6],
}

impl Arguments {
    /// `RTC_RAY_QUERY_FLAG_COHERENT` or not; all features, nothing called back.
    pub(super) fn new(coherent: bool) -> Self {
        Self { flags: u32::from(coherent) << 16, features: c_uint::MAX, rest: [ptr::null_mut(); 6] }
    }
}

/// `RTC_DEVICE_PROPERTY_…`.
const VERSION: [c_int; 3] = [1, 2, 3];
const NATIVE_RAY16: c_int = 34;
/// `RTC_GEOMETRY_TYPE_…`.
const TRIANGLES: c_int = 0;
const INSTANCE: c_int = 121;
/// `RTC_BUFFER_TYPE_…`.
const INDICES: c_int = 0;
const VERTICES: c_int = 1;
/// `RTC_FORMAT_…`.
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;
const FLOAT3X4_COLUMNS: c_int = 0x9234;

/// Declares the functions that are used, and finds them by name.
macro_rules! functions {
    ($($name:ident: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        #[expect(non_snake_case, reason = "the names in the library")]
        struct Functions { $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)* }

        impl Functions {
            fn find(library: &Library) -> Result<Self, libloading::Error> {
                // SAFETY: the types are those of the headers.
                unsafe { Ok(Self { $($name: *library.get(stringify!($name))?,)* }) }
            }
        }
    };
}

functions! {
    rtcNewDevice: fn(*const c_char) -> Handle;
    rtcReleaseDevice: fn(Handle);
    rtcGetDeviceProperty: fn(Handle, c_int) -> isize;
    rtcGetDeviceError: fn(Handle) -> c_int;
    rtcSetDeviceMemoryMonitorFunction: fn(Handle, extern "C" fn(*mut c_void, isize, bool) -> bool, *mut c_void);
    rtcNewScene: fn(Handle) -> Handle;
    rtcReleaseScene: fn(Handle);
    rtcSetSceneBuildQuality: fn(Handle, c_int);
    rtcSetSceneFlags: fn(Handle, c_int);
    rtcCommitScene: fn(Handle);
    rtcNewGeometry: fn(Handle, c_int) -> Handle;
    rtcReleaseGeometry: fn(Handle);
    rtcCommitGeometry: fn(Handle);
    rtcAttachGeometry: fn(Handle, Handle) -> c_uint;
    rtcSetNewGeometryBuffer: fn(Handle, c_int, c_uint, c_int, usize, usize) -> *mut c_void;
    rtcSetGeometryInstancedScene: fn(Handle, Handle);
    rtcSetGeometryTransform: fn(Handle, c_uint, c_int, *const c_void);
    rtcIntersect1: fn(Handle, *mut RayHit<1>, *mut Arguments);
    rtcIntersect16: fn(*const Valid, Handle, *mut RayHit<16>, *mut Arguments);
    rtcOccluded1: fn(Handle, *mut RayHit<1>, *mut Arguments);
    rtcOccluded16: fn(*const Valid, Handle, *mut RayHit<16>, *mut Arguments);
}

/// The library and a device of its. Not `Send`: used where it was made.
pub(super) struct Device {
    functions: Functions,
    device: Handle,
    /// Bytes that it holds; it outlives the device.
    bytes: Box<AtomicI64>,
}

/// Adds up what a device takes and gives back.
extern "C" fn monitor(bytes: *mut c_void, change: isize, _done: bool) -> bool {
    // SAFETY: it is the counter that was handed over, which lives as long as the device.
    unsafe { &*bytes.cast::<AtomicI64>() }.fetch_add(change as i64, Ordering::Relaxed);
    true
}

impl Device {
    /// Loads the library at a path or of a name that the system's loader knows.
    pub(super) fn open(path: &Path, threads: usize) -> Result<Self, String> {
        // SAFETY: what an Embree library does when it is loaded is harmless; whoever names
        // another one answers for it.
        let library = unsafe { Library::new(path) }.map_err(|error| error.to_string())?;
        // Never unloaded: its worker threads outlive its devices.
        let library = ManuallyDrop::new(library);
        let functions = Functions::find(&library).map_err(|error| error.to_string())?;
        let config = format!("threads={threads},set_affinity=0");
        let config = CString::new(config).expect("no zeros in it");
        // SAFETY: a string with a zero at its end.
        let device = unsafe { (functions.rtcNewDevice)(config.as_ptr()) };
        if device.is_null() {
            return Err("no device can be made".into());
        }
        let bytes = Box::new(AtomicI64::new(0));
        let counter = ptr::from_ref(&*bytes).cast_mut().cast();
        // SAFETY: the device is there, and the counter stays where it is.
        unsafe { (functions.rtcSetDeviceMemoryMonitorFunction)(device, monitor, counter) };
        Ok(Self { functions, device, bytes })
    }

    fn property(&self, number: c_int) -> isize {
        // SAFETY: the device is there; numbers that it does not know give 0.
        unsafe { (self.functions.rtcGetDeviceProperty)(self.device, number) }
    }

    pub(super) fn version(&self) -> [isize; 3] {
        VERSION.map(|number| self.property(number))
    }

    /// Whether packets of 16 go through vectors of 16.
    pub(super) fn takes_16(&self) -> bool {
        self.property(NATIVE_RAY16) != 0
    }

    pub(super) fn bytes(&self) -> i64 {
        self.bytes.load(Ordering::Relaxed)
    }

    /// The number of the first thing that went wrong since last asked; 0 if nothing did.
    pub(super) fn error(&self) -> c_int {
        // SAFETY: the device is there.
        unsafe { (self.functions.rtcGetDeviceError)(self.device) }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: made in `open`, and released once.
        unsafe { (self.functions.rtcReleaseDevice)(self.device) };
    }
}

/// A scene and the device that it belongs to.
pub(super) struct Scene {
    scene: Handle,
    device: Rc<Device>,
}

impl Scene {
    pub(super) fn new(device: &Rc<Device>, quality: c_int, flags: c_int) -> Self {
        let of = &device.functions;
        // SAFETY: the device is there, and so is the scene that it makes.
        unsafe {
            let scene = (of.rtcNewScene)(device.device);
            (of.rtcSetSceneBuildQuality)(scene, quality);
            (of.rtcSetSceneFlags)(scene, flags);
            Self { scene, device: Rc::clone(device) }
        }
    }

    /// Puts triangles into it; does nothing if there is no memory, see [`Device::error`].
    pub(super) fn add_triangles(&self, positions: &[[f32; 3]], faces: &[[u32; 3]]) {
        assert!(faces.iter().flatten().all(|&corner| (corner as usize) < positions.len()));
        let of = &self.device.functions;
        // SAFETY: the device is there; the buffers are of the sizes asked for; all corners exist.
        unsafe {
            let geometry = (of.rtcNewGeometry)(self.device.device, TRIANGLES);
            let vertices = (VERTICES, FLOAT3, size_of::<[f32; 3]>(), positions.len());
            let indices = (INDICES, UINT3, size_of::<[u32; 3]>(), faces.len());
            let [vertices, indices] = [vertices, indices].map(|(kind, format, stride, count)| {
                (of.rtcSetNewGeometryBuffer)(geometry, kind, 0, format, stride, count)
            });
            if !vertices.is_null() && !indices.is_null() {
                ptr::copy_nonoverlapping(positions.as_ptr(), vertices.cast(), positions.len());
                ptr::copy_nonoverlapping(faces.as_ptr(), indices.cast(), faces.len());
                (of.rtcCommitGeometry)(geometry);
                (of.rtcAttachGeometry)(self.scene, geometry);
            }
            (of.rtcReleaseGeometry)(geometry);
        }
    }

    /// Puts another scene of the same device into it, which has been committed.
    pub(super) fn add_instance(&self, inner: &Self, columns: &[f32; 12]) {
        assert!(Rc::ptr_eq(&self.device, &inner.device), "scenes of one device");
        let of = &self.device.functions;
        // SAFETY: device and scenes are there; the scene is kept as long as the instance is.
        unsafe {
            let geometry = (of.rtcNewGeometry)(self.device.device, INSTANCE);
            (of.rtcSetGeometryInstancedScene)(geometry, inner.scene);
            let columns = columns.as_ptr().cast();
            (of.rtcSetGeometryTransform)(geometry, 0, FLOAT3X4_COLUMNS, columns);
            (of.rtcCommitGeometry)(geometry);
            (of.rtcAttachGeometry)(self.scene, geometry);
            (of.rtcReleaseGeometry)(geometry);
        }
    }

    /// Puts what is in it in order; only then it may be asked.
    pub(super) fn commit(&self) {
        // SAFETY: the scene is there.
        unsafe { (self.device.functions.rtcCommitScene)(self.scene) };
    }

    #[inline]
    pub(super) fn closest(&self, ray: &mut RayHit<1>, arguments: &mut Arguments) {
        // SAFETY: the scene is there, and both structs are as long as Embree's or longer.
        unsafe { (self.device.functions.rtcIntersect1)(self.scene, ray, arguments) };
    }

    #[inline]
    pub(super) fn any(&self, ray: &mut RayHit<1>, arguments: &mut Arguments) {
        // SAFETY: as for `closest`.
        unsafe { (self.device.functions.rtcOccluded1)(self.scene, ray, arguments) };
    }

    #[inline]
    pub(super) fn closest_16(&self, on: &Valid, rays: &mut RayHit<16>, with: &mut Arguments) {
        // SAFETY: as for `closest`; rays and `on` are aligned to 64 bytes.
        unsafe { (self.device.functions.rtcIntersect16)(on, self.scene, rays, with) };
    }

    #[inline]
    pub(super) fn any_16(&self, on: &Valid, rays: &mut RayHit<16>, with: &mut Arguments) {
        // SAFETY: as for `closest_16`.
        unsafe { (self.device.functions.rtcOccluded16)(on, self.scene, rays, with) };
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: made in `new`, and released once.
        unsafe { (self.device.functions.rtcReleaseScene)(self.scene) };
    }
}
