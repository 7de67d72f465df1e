//! Embree 3 as a reference. It is loaded at run time, so that neither building nor running this benchmark requires it.
#![allow(unsafe_code, reason = "Embree has a C interface")]

use std::ffi::{c_char, c_int, c_uint, c_void};
use std::mem::{ManuallyDrop, offset_of};

use libloading::Library;
use sir::geom::{Line, Scene};

/// File names of the library, as in Debian's `libembree3-3` and in other distributions.
const NAMES: [&str; 2] = ["libembree3.so.3", "libembree3.so"];

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
        }
    }

    /// Returns the triangle that was hit, if any.
    pub(crate) fn triangle(&self) -> Option<u32> {
        (self.geometry != INVALID).then_some(self.triangle)
    }
}

/// `RTCIntersectContext`, followed by our own data.
#[repr(C)]
struct Context {
    flags: c_int,
    filter: Option<Filter>,
    instance: c_uint,
    /// Only some builds of Embree have and read this field.
    min_width: f32,
    found: Vec<Found>,
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
    user: *mut c_void,
    context: *mut Context,
    ray: *const f32,
    hit: *const f32,
    n: c_uint,
}

type Filter = unsafe extern "C" fn(*const FilterArguments);

/// Records a hit and rejects it, so that traversal continues.
unsafe extern "C" fn note(arguments: *const FilterArguments) {
    // SAFETY: Embree calls this with N = 1 for `rtcIntersect1`, where ray and hit are laid out as in `RayHit`, and with
    // the context that was passed to it.
    unsafe {
        let arguments = &*arguments;
        let (ray, hit) = (arguments.ray, arguments.hit);
        let field = |offset: usize| offset / size_of::<f32>();
        let direction = ray.add(field(offset_of!(RayHit, direction)));
        let towards: f32 = (0..3).map(|k| *hit.add(k) * *direction.add(k)).sum();
        (*arguments.context).found.push(Found {
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
    commit_geometry: unsafe extern "C" fn(Handle),
    attach_geometry: unsafe extern "C" fn(Handle, Handle) -> c_uint,
    release_geometry: unsafe extern "C" fn(Handle),
    commit_scene: unsafe extern "C" fn(Handle),
    intersect1: unsafe extern "C" fn(Handle, *mut Context, *mut RayHit),
    intersect1m: unsafe extern "C" fn(Handle, *mut Context, *mut RayHit, c_uint, usize),
    release_scene: unsafe extern "C" fn(Handle),
    release_device: unsafe extern "C" fn(Handle),
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
        for name in NAMES {
            // SAFETY: the initializers of Embree have no preconditions.
            match unsafe { Library::new(name) } {
                Ok(library) => return Self::from_library(library).map_err(|e| e.to_string()),
                Err(error) => reason = error.to_string(),
            }
        }
        Err(reason)
    }

    fn from_library(library: Library) -> Result<Self, libloading::Error> {
        // SAFETY: names and types are those of rtcore_*.h of version 3.13.
        unsafe {
            let functions = Functions {
                new_device: *library.get(b"rtcNewDevice")?,
                new_scene: *library.get(b"rtcNewScene")?,
                set_build_quality: *library.get(b"rtcSetSceneBuildQuality")?,
                new_geometry: *library.get(b"rtcNewGeometry")?,
                new_buffer: *library.get(b"rtcSetNewGeometryBuffer")?,
                set_filter: *library.get(b"rtcSetGeometryIntersectFilterFunction")?,
                commit_geometry: *library.get(b"rtcCommitGeometry")?,
                attach_geometry: *library.get(b"rtcAttachGeometry")?,
                release_geometry: *library.get(b"rtcReleaseGeometry")?,
                commit_scene: *library.get(b"rtcCommitScene")?,
                intersect1: *library.get(b"rtcIntersect1")?,
                intersect1m: *library.get(b"rtcIntersect1M")?,
                release_scene: *library.get(b"rtcReleaseScene")?,
                release_device: *library.get(b"rtcReleaseDevice")?,
            };
            let device = (functions.new_device)(c"threads=1,set_affinity=0".as_ptr());
            assert!(!device.is_null(), "Embree cannot create a device");
            Ok(Self { functions, device, _library: ManuallyDrop::new(library) })
        }
    }

    /// Builds an acceleration structure for a scene. If `all_hits` is set, a filter function records all hits.
    pub(crate) fn scene(&self, scene: &Scene, quality: Quality, all_hits: bool) -> Peer<'_> {
        let f = &self.functions;
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
            }
            (f.commit_geometry)(geometry);
            (f.attach_geometry)(handle, geometry);
            (f.release_geometry)(geometry);
            (f.commit_scene)(handle);
            handle
        };
        Peer { embree: self, handle }
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
}

impl Peer<'_> {
    fn context(coherent: bool) -> Context {
        Context {
            flags: c_int::from(coherent),
            filter: None,
            instance: INVALID,
            min_width: 0.0,
            found: Vec::new(),
        }
    }

    /// Finds closest hits, ray by ray.
    pub(crate) fn closest(&self, rays: &[RayHit], mut visit: impl FnMut(Option<u32>)) {
        let mut context = Self::context(false);
        for ray in rays {
            let mut ray = *ray;
            // SAFETY: the scene is committed; context and ray have the layout that Embree expects.
            unsafe { (self.embree.functions.intersect1)(self.handle, &raw mut context, &raw mut ray) };
            visit(ray.triangle());
        }
    }

    /// Finds closest hits of streams of coherent rays.
    pub(crate) fn closest_streams(&self, rays: &[RayHit], mut visit: impl FnMut(Option<u32>)) {
        let mut context = Self::context(true);
        let mut stream = Vec::new();
        for rays in rays.chunks(256) {
            stream.clear();
            stream.extend_from_slice(rays);
            let (count, stride) = (stream.len() as c_uint, size_of::<RayHit>());
            // SAFETY: as above; the stream has `count` rays.
            unsafe {
                let first = stream.as_mut_ptr();
                (self.embree.functions.intersect1m)(self.handle, &raw mut context, first, count, stride);
            }
            stream.iter().for_each(|ray| visit(ray.triangle()));
        }
    }

    /// Finds all hits in order along each line, line by line.
    pub(crate) fn all_hits(&self, lines: &[RayHit], mut visit: impl FnMut(&[Found])) {
        let mut context = Self::context(false);
        for line in lines {
            let mut line = *line;
            context.found.clear();
            // SAFETY: as above; the filter function writes to the context and to nothing else.
            unsafe { (self.embree.functions.intersect1)(self.handle, &raw mut context, &raw mut line) };
            context.found.sort_unstable_by(|a, b| a.t.total_cmp(&b.t));
            visit(&context.found);
        }
    }
}

impl Drop for Peer<'_> {
    fn drop(&mut self) {
        // SAFETY: the scene is ours.
        unsafe { (self.embree.functions.release_scene)(self.handle) }
    }
}
