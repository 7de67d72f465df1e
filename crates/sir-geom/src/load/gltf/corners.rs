//! Texture coordinates and colors of vertices.

use std::collections::HashMap;
use std::rc::Rc;

use ::gltf::json::Index;
use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::mesh::{Primitive, Semantic};
use ::gltf::json::validation::Checked;
use glam::{DVec4, Vec2, Vec4};

use crate::load::error::LoadError;
use crate::load::gltf::known::{Alpha, Known};
use crate::load::gltf::reader::Reader;
use crate::load::texture::Placement;

/// Maximum number of coordinate sets of a material, which has two textures.
pub(super) const MAX_SETS: usize = 2;

/// Attribute values by accessor, because primitives often share them. Colors are as in the file.
#[derive(Default)]
pub(super) struct Attributes {
    places: HashMap<usize, Rc<[Vec2]>>,
    colors: HashMap<usize, Rc<[Vec4]>>,
}

/// Values that vary over the triangles of a primitive, per vertex.
pub(super) struct Values {
    /// Coordinate sets up to the first that is missing, each with its transform.
    pub(super) coordinates: Vec<(Rc<[Vec2]>, Placement)>,
    /// Colors; `None` if all are white.
    pub(super) colors: Option<Rc<[Vec4]>>,
}

impl Reader<'_> {
    /// Returns the vertex values of a primitive that has this material and number of vertices.
    pub(super) fn values(
        &mut self,
        primitive: &Primitive,
        material: &Known,
        vertices: usize,
        shared: &mut Attributes,
        what: &str,
    ) -> Result<Values, LoadError> {
        let mut coordinates = Vec::new();
        for set in material.sets.iter() {
            let attribute = Checked::Valid(Semantic::TexCoords(set.set));
            let Some(&accessor) = primitive.attributes.get(&attribute) else {
                self.notes.count(NO_COORDINATES_OF_PRIMITIVES, 1);
                break;
            };
            coordinates.push((self.places(accessor, vertices, shared, what)?, set.placement));
        }
        if primitive.attributes.contains_key(&Checked::Valid(Semantic::Colors(1))) {
            self.notes.count("mesh primitives have more than one set of colors; only the first is used", 1);
        }
        let colors = match primitive.attributes.get(&Checked::Valid(Semantic::Colors(0))) {
            Some(&accessor) => {
                let colors = self.colors(accessor, vertices, shared, what)?;
                self.tints(&colors, material.alpha)
            }
            None => None,
        };
        Ok(Values { coordinates, colors })
    }

    fn places(
        &mut self,
        accessor: Index<Accessor>,
        vertices: usize,
        shared: &mut Attributes,
        what: &str,
    ) -> Result<Rc<[Vec2]>, LoadError> {
        use ComponentType::{F32, I8, I16, U8, U16};
        let what = format!("{what}, texture coordinates");
        self.attribute(accessor, vertices, &mut shared.places, &what, |reader| {
            // `KHR_mesh_quantization` adds signed integers.
            let places = reader.data.elements::<2>(accessor, Type::Vec2, &[F32, I8, U8, I16, U16], &what)?;
            Ok(places.iter().map(|place| Vec2::from_array(place.map(|x| x as f32))).collect())
        })
    }

    fn colors(
        &mut self,
        accessor: Index<Accessor>,
        vertices: usize,
        shared: &mut Attributes,
        what: &str,
    ) -> Result<Rc<[Vec4]>, LoadError> {
        use ComponentType::{F32, U8, U16};
        let what = format!("{what}, colors");
        self.attribute(accessor, vertices, &mut shared.colors, &what, |reader| {
            let definition: Option<&Accessor> = reader.data.root.get(accessor);
            let has_alpha = definition.is_some_and(|a| matches!(a.type_, Checked::Valid(Type::Vec4)));
            if has_alpha {
                let colors = reader.data.elements::<4>(accessor, Type::Vec4, &[F32, U8, U16], &what)?;
                Ok(colors.into_iter().map(|c| DVec4::from_array(c).as_vec4()).collect())
            } else {
                let colors = reader.data.elements::<3>(accessor, Type::Vec3, &[F32, U8, U16], &what)?;
                Ok(colors.into_iter().map(|[r, g, b]| DVec4::new(r, g, b, 1.0).as_vec4()).collect())
            }
        })
    }

    /// Returns the values of an attribute, at least one per vertex. An attribute that primitives share is read once.
    fn attribute<T>(
        &mut self,
        accessor: Index<Accessor>,
        vertices: usize,
        known: &mut HashMap<usize, Rc<[T]>>,
        what: &str,
        read: impl FnOnce(&Self) -> Result<Rc<[T]>, LoadError>,
    ) -> Result<Rc<[T]>, LoadError> {
        let values = match known.get(&accessor.value()) {
            Some(values) => Rc::clone(values),
            None => {
                let values = read(self)?;
                self.coordinates += values.len();
                self.check_size("texture coordinates and colors", self.coordinates)?;
                Rc::clone(known.entry(accessor.value()).or_insert(values))
            }
        };
        if values.len() >= vertices {
            return Ok(values);
        }
        Err(self.data.invalid(format!("{what}: there are {} for {vertices} vertices", values.len())))
    }

    /// Returns the factors for the colors of the material; `None` if all are one.
    fn tints(&mut self, colors: &Rc<[Vec4]>, alpha: Alpha) -> Option<Rc<[Vec4]>> {
        let is_open = colors.iter().any(|color| color.w < 1.0);
        if alpha == Alpha::Mask && is_open {
            self.notes.count(
                "mesh primitives have colors with alpha, which is ignored because their material is a mask",
                1,
            );
        }
        let tints = match alpha {
            Alpha::Opaque | Alpha::Mask if is_open => colors.iter().map(|c| c.with_w(1.0)).collect(),
            _ => Rc::clone(colors),
        };
        tints.iter().any(|&tint| tint != Vec4::ONE).then_some(tints)
    }
}

/// Warning about primitives without the coordinates of a texture.
const NO_COORDINATES_OF_PRIMITIVES: &str =
    "mesh primitives lack coordinates for a texture and have its mean color";
