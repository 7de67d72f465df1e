//! Contents of a pipeline, with every default filled in. Each file declares the fields of a stage, or of a part of one.
//! The reader, the writer and the documentation follow from the declaration.

pub(crate) mod focus;
pub(crate) mod image;
pub(crate) mod light;
pub(crate) mod light_group;
pub(crate) mod lightmap;
pub(crate) mod lines;
pub(crate) mod load;
pub(crate) mod multipath;
mod order;
pub(crate) mod panel;
pub(crate) mod pipeline;
pub(crate) mod point;
mod points_file;
pub(crate) mod probes;
mod reference;
pub(crate) mod save;
pub(crate) mod scene_light;
pub(crate) mod sensors;
pub(crate) mod sky;
pub(crate) mod stage;
pub(crate) mod subdivide;

pub use focus::Focus;
pub use image::{Camera, CameraChoice, Image};
pub use light::{Distant, Lamp, Light};
pub use light_group::{FileLights, OTHER};
pub use lightmap::Lightmap;
pub use lines::{FirstShot, SecondShot, ShadowRays, Solve};
pub use load::Load;
pub use multipath::{DomainKind, Multipath, Replicas, Transport};
pub use panel::{Panel, PanelStrength};
pub use pipeline::Pipeline;
pub use point::{Lambertian, Point, PointStrength, Spot, Spread};
pub use points_file::PointsFile;
pub use probes::Probes;
pub use reference::field_tables;
pub use save::{Gltf, Output, Report, Save, Table};
pub use scene_light::SceneLight;
pub use sensors::{Grid, Place, Plane, Points, SensorPoint, Sensors};
pub use sky::{Cie, Environment, Sky, SkyModel};
pub use stage::{Action, Repeat, Stage, Until};
pub use subdivide::{Divided, Division, Subdivide};
