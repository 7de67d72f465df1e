//! Embree 4 or 3 as a reference. It is loaded at run time, so that neither building nor running this benchmark requires it.
#![allow(unsafe_code, reason = "Embree has a C interface")]

use std::cell::UnsafeCell;
use std::ffi::{OsString, c_char, c_int, c_uint, c_void};
use std::mem::{ManuallyDrop, offset_of};

use libloading::Library;
use sir::geom::{Line, Scene};

/// Environment variable with the path of the library.
const PATH: &str = "EMBREE_LIBRARY";

/// File names of the library, as in Debian's `libembree4-4` and `libembree3-3`, and in other distributions.
const NAMES: [&str; 4] = ["libembree4.so.4", "libembree4.so", "libembree3.so.3", "libembree3.so"];

const TRIANGLE: c_int = 0;
const INDEX_BUFFER: c_int = 0;
const VERTEX_BUFFER: c_int = 1;
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;
const INVALID: c_uint = u32::MAX;

type Handle = *mut c_void;

/// Build quality of an acceleration structure.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Quality {
    /// Without spatial splits: each triangle is reported at most once.
    Medium = 1,
    /// With spatial splits: best for closest hits.
    High = 2,
}

/// `RTCRayHit`.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(crate) struct RayHit {
    origin: [f32; 3],
    near: f32,
    direction: [f32; 3],
    time: f32,
    far: f32,
    mask: c_uint,
    id: c_uint,
    flags: c_uint,
    normal: [f32; 3],
    u: f32,
    v: f32,
    triangle: c_uint,
    geometry: c_uint,
    instance: c_uint,
    /// Only in version 4.
    instance_primitive: c_uint,
}

impl RayHit {
    /// Returns a ray that starts at the distance `near` from its origin.
    pub(crate) fn new(line: &Line, near: f32) -> Self {
        Self {
            origin: line.origin.as_vec3().to_array(),
            near,
            direction: line.direction.as_vec3().to_array(),
            time: 0.0,
            far: f32::INFINITY,
            mask: u32::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            u: 0.0,
            v: 0.0,
            triangle: INVALID,
            geometry: INVALID,
            instance: INVALID,
            instance_primitive: INVALID,
        }
    }

    /// Returns the triangle that was hit, if any.
    pub(crate) fn triangle(&self) -> Option<u32> {
        (self.geometry != INVALID).then_some(self.triangle)
    }
}

/// `RTCIntersectContext` of version 3.
#[repr(C)]
struct Context3 {
    flags: c_int,
    filter: Option<Filter>,
    instance: c_uint,
    /// Only some builds of Embree have and read this field.
    min_width: f32,
}

/// `RTCRayQueryContext` of version 4.
#[repr(C)]
struct Context4 {
    instance: c_uint,
    instance_primitive: c_uint,
}

/// `RTCIntersectArguments` of version 4.
#[repr(C)]
struct Arguments4 {
    flags: c_int,
    features: c_uint,
    context: *mut Context4,
    filter: Option<Filter>,
    intersect: *mut c_void,
    /// Only some builds of Embree have and read this field.
    min_width: f32,
}

/// Crossing recorded by the filter function, with the data needed to find the patch.
#[derive(Clone, Copy)]
pub(crate) struct Found {
    pub(crate) t: f32,
    pub(crate) triangle: u32,
    pub(crate) point: [f32; 2],
    pub(crate) front: bool,
}

/// `RTCFilterFunctionNArguments`.
#[repr(C)]
struct FilterArguments {
    valid: *mut c_int,
    user: *mut Vec<Found>,
    context: *mut c_void,
    ray: *const f32,
    hit: *const f32,
    n: c_uint,
}

type Filter = unsafe extern "C" fn(*const FilterArguments);

/// Records a hit and rejects it, so that traversal continues.
unsafe extern "C" fn note(arguments: *const FilterArguments) {
    // SAFETY: Embree calls this with N = 1 for `rtcIntersect1`, where ray and hit are laid out as in `RayHit`, and with
    // the user data of the geometry, which nothing else accesses during a search.
    unsafe {
        let arguments = &*arguments;
        let (ray, hit) = (arguments.ray, arguments.hit);
        let field = |offset: usize| offset / size_of::<f32>();
        let direction = ray.add(field(offset_of!(RayHit, direction)));
        let towards: f32 = (0..3).map(|k| *hit.add(k) * *direction.add(k)).sum();
        (*arguments.user).push(Found {
            t: *ray.add(field(offset_of!(RayHit, far))),
            triangle: (*hit.add(5)).to_bits(),
            point: [*hit.add(3), *hit.add(4)],
            front: towards < 0.0,
        });
        *arguments.valid = 0;
    }
}

/// Functions of Embree that are used.
struct Functions {
    new_device: unsafe extern "C" fn(*const c_char) -> Handle,
    new_scene: unsafe extern "C" fn(Handle) -> Handle,
    set_build_quality: unsafe extern "C" fn(Handle, c_int),
    new_geometry: unsafe extern "C" fn(Handle, c_int) -> Handle,
    new_buffer: unsafe extern "C" fn(Handle, c_int, c_uint, c_int, usize, usize) -> *mut c_void,
    set_filter: unsafe extern "C" fn(Handle, Filter),
    set_user_data: unsafe extern "C" fn(Handle, *mut Vec<Found>),
    commit_geometry: unsafe extern "C" fn(Handle),
    attach_geometry: unsafe extern "C" fn(Handle, Handle) -> c_uint,
    release_geometry: unsafe extern "C" fn(Handle),
    commit_scene: unsafe extern "C" fn(Handle),
    intersect: Intersect,
    release_scene: unsafe extern "C" fn(Handle),
    release_device: unsafe extern "C" fn(Handle),
}

/// Searches, which differ between the versions.
enum Intersect {
    Version3 {
        one: unsafe extern "C" fn(Handle, *mut Context3, *mut RayHit),
        many: unsafe extern "C" fn(Handle, *mut Context3, *mut RayHit, c_uint, usize),
    },
    Version4 {
        one: unsafe extern "C" fn(Handle, *mut RayHit, *mut Arguments4),
    },
}

/// Embree library, with a device that uses one thread.
pub(crate) struct Embree {
    functions: Functions,
    device: Handle,
    /// Library, which is never unloaded because its threads may outlive the device.
    _library: ManuallyDrop<Library>,
}

impl Embree {
    /// Loads the library, or returns the reason why it cannot be loaded.
    pub(crate) fn load() -> Result<Self, String> {
        let mut reason = String::new();
        let names = match std::env::var_os(PATH) {
            Some(path) => vec![path],
            None => NAMES.map(OsString::from).to_vec(),
        };
        for name in names {
            // SAFETY: the initializers of Embree have no preconditions.
            match unsafe { Library::new(name) } {
                Ok(library) => return Self::from_library(library).map_err(|e| e.to_string()),
                Err(error) => reason = error.to_string(),
            }
        }
        Err(reason)
    }

    fn from_library(library: Library) -> Result<Self, libloading::Error> {
        // SAFETY: names and types are those of rtcore_*.h of versions 3.13 and 4.4. Streams are only in version 3.
        unsafe {
            let intersect = match library.get(b"rtcIntersect1M") {
                Ok(many) => Intersect::Version3 { one: *library.get(b"rtcIntersect1")?, many: *many },
                Err(_) => Intersect::Version4 { one: *library.get(b"rtcIntersect1")? },
            };
            let functions = Functions {
                new_device: *library.get(b"rtcNewDevice")?,
                new_scene: *library.get(b"rtcNewScene")?,
                set_build_quality: *library.get(b"rtcSetSceneBuildQuality")?,
                new_geometry: *library.get(b"rtcNewGeometry")?,
                new_buffer: *library.get(b"rtcSetNewGeometryBuffer")?,
                set_filter: *library.get(b"rtcSetGeometryIntersectFilterFunction")?,
                set_user_data: *library.get(b"rtcSetGeometryUserData")?,
                commit_geometry: *library.get(b"rtcCommitGeometry")?,
                attach_geometry: *library.get(b"rtcAttachGeometry")?,
                release_geometry: *library.get(b"rtcReleaseGeometry")?,
                commit_scene: *library.get(b"rtcCommitScene")?,
                intersect,
                release_scene: *library.get(b"rtcReleaseScene")?,
                release_device: *library.get(b"rtcReleaseDevice")?,
            };
            let device = (functions.new_device)(c"threads=1,set_affinity=0".as_ptr());
            assert!(!device.is_null(), "Embree cannot create a device");
            Ok(Self { functions, device, _library: ManuallyDrop::new(library) })
        }
    }

    /// Returns the version of the library.
    pub(crate) fn version(&self) -> u32 {
        match self.functions.intersect {
            Intersect::Version3 { .. } => 3,
            Intersect::Version4 { .. } => 4,
        }
    }

    /// Builds an acceleration structure for a scene. If `all_hits` is set, a filter function records all hits.
    pub(crate) fn scene(&self, scene: &Scene, quality: Quality, all_hits: bool) -> Peer<'_> {
        let f = &self.functions;
        let found = Box::new(UnsafeCell::new(Vec::new()));
        let (vertices, triangles) = (scene.vertices(), scene.triangles());
        // SAFETY: buffers that Embree creates are at least as long as requested; all handles come from Embree.
        let handle = unsafe {
            let handle = (f.new_scene)(self.device);
            (f.set_build_quality)(handle, quality as c_int);
            let geometry = (f.new_geometry)(self.device, TRIANGLE);
            let places: *mut f32 =
                (f.new_buffer)(geometry, VERTEX_BUFFER, 0, FLOAT3, 12, vertices.len()).cast();
            for (i, vertex) in vertices.iter().enumerate() {
                places.cast::<[f32; 3]>().add(i).write(vertex.as_vec3().to_array());
            }
            let corners: *mut [u32; 3] =
                (f.new_buffer)(geometry, INDEX_BUFFER, 0, UINT3, 12, triangles.len()).cast();
            for (i, triangle) in triangles.iter().enumerate() {
                corners.add(i).write(triangle.vertices.map(|v| v.0));
            }
            if all_hits {
                (f.set_filter)(geometry, note);
                (f.set_user_data)(geometry, found.get());
            }
            (f.commit_geometry)(geometry);
            (f.attach_geometry)(handle, geometry);
            (f.release_geometry)(geometry);
            (f.commit_scene)(handle);
            handle
        };
        Peer { embree: self, handle, found }
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: the device is ours, and no scene outlives `self`.
        unsafe { (self.functions.release_device)(self.device) }
    }
}

/// Scene of Embree.
pub(crate) struct Peer<'e> {
    embree: &'e Embree,
    handle: Handle,
    /// Hits that the filter function records.
    found: Box<UnsafeCell<Vec<Found>>>,
}

impl Context3 {
    fn new(coherent: bool) -> Self {
        Self { flags: c_int::from(coherent), filter: None, instance: INVALID, min_width: 0.0 }
    }
}

impl Peer<'_> {
    /// Finds the closest hits of rays, one by one, or all hits if a filter function records them. `visit` gets each ray
    /// after its search.
    fn search(&self, rays: &[RayHit], mut visit: impl FnMut(RayHit)) {
        // SAFETY: the scene is committed; context, arguments and ray have the layouts that Embree expects.
        match self.embree.functions.intersect {
            Intersect::Version3 { one, .. } => {
                let mut context = Context3::new(false);
                for ray in rays {
                    let mut ray = *ray;
                    unsafe { one(self.handle, &raw mut context, &raw mut ray) };
                    visit(ray);
                }
            }
            Intersect::Version4 { one } => {
                let mut context = Context4 { instance: INVALID, instance_primitive: INVALID };
                let mut arguments = Arguments4 {
                    flags: 0,
                    features: u32::MAX,
                    context: &raw mut context,
                    filter: None,
                    intersect: std::ptr::null_mut(),
                    min_width: 0.0,
                };
                for ray in rays {
                    let mut ray = *ray;
                    unsafe { one(self.handle, &raw mut ray, &raw mut arguments) };
                    visit(ray);
                }
            }
        }
    }

    /// Finds closest hits, ray by ray.
    pub(crate) fn closest(&self, rays: &[RayHit], mut visit: impl FnMut(Option<u32>)) {
        self.search(rays, |ray| visit(ray.triangle()));
    }

    /// Finds closest hits of streams of coherent rays. Returns false if this version has no streams.
    pub(crate) fn closest_streams(&self, rays: &[RayHit], mut visit: impl FnMut(Option<u32>)) -> bool {
        let Intersect::Version3 { many, .. } = self.embree.functions.intersect else { return false };
        let mut context = Context3::new(true);
        let mut stream = Vec::new();
        for rays in rays.chunks(256) {
            stream.clear();
            stream.extend_from_slice(rays);
            let (count, stride) = (stream.len() as c_uint, size_of::<RayHit>());
            // SAFETY: as in `search`; the stream has `count` rays.
            unsafe { many(self.handle, &raw mut context, stream.as_mut_ptr(), count, stride) };
            stream.iter().for_each(|ray| visit(ray.triangle()));
        }
        true
    }

    /// Finds all hits in order along each line, line by line.
    pub(crate) fn all_hits(&self, lines: &[RayHit], mut visit: impl FnMut(&[Found])) {
        self.search(lines, |_| {
            // SAFETY: the filter function is the only other user of the hits, and no search runs now.
            let found = unsafe { &mut *self.found.get() };
            found.sort_unstable_by(|a, b| a.t.total_cmp(&b.t));
            visit(found);
            found.clear();
        });
    }
}

impl Drop for Peer<'_> {
    fn drop(&mut self) {
        // SAFETY: the scene is ours.
        unsafe { (self.embree.functions.release_scene)(self.handle) }
    }
}
