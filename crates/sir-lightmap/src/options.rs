//! Options of lightmaps.

/// Options of a lightmap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightmapOptions {
    /// Width and maximum height of a page \[texels\].
    pub size: u32,
    /// Texels per meter of surface, or `None` for as many as fit `pages`. If given, there are as many pages as needed.
    pub texels_per_meter: Option<f64>,
    /// Number of pages if `texels_per_meter` is not given.
    pub pages: u32,
    /// Empty texels around each chart.
    pub padding: u32,
    /// Light on two-sided surfaces.
    pub sides: LightmapSides,
    /// True to give every instance of a mesh its own mesh with its own coordinates.
    pub expand: bool,
    /// True to fit the texels on both sides of edges of charts to each other.
    pub seams: bool,
    /// Number of threads.
    pub threads: usize,
}

impl Default for LightmapOptions {
    fn default() -> Self {
        Self {
            size: 1024,
            texels_per_meter: None,
            pages: 1,
            padding: 3,
            sides: LightmapSides::Split,
            expand: false,
            seams: true,
            threads: 1,
        }
    }
}

/// Light on surfaces of which both sides reflect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LightmapSides {
    /// Each side has its own texels. The surface becomes two one-sided ones in the lit glTF.
    #[default]
    Split,
    /// The texels have the light on the front.
    Front,
    /// The texels have the mean of both sides.
    Mean,
}
