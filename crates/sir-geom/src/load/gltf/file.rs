//! A glTF file for programs that write it again with changes.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::mesh::Semantic;
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Value, deserialize};
use glam::DAffine3;

use crate::load::error::LoadError;
use crate::load::gltf::container;
use crate::load::gltf::data::{Data, lookup};
use crate::load::gltf::document::{self, Document};

/// A glTF file: its JSON document as it is written, with checked access to its geometry, buffers and images.
///
/// For programs that write a file again with changes. [`load`](crate::load) reads the scene of a file.
pub struct GltfFile {
    path: PathBuf,
    json: Value,
    document: Document,
    buffers: Vec<Rc<Vec<u8>>>,
}

/// Triangles of a primitive of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfPrimitive {
    /// Positions of its vertices in the space of the mesh.
    pub positions: Vec<[f64; 3]>,
    /// Vertex numbers of its triangles, counterclockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// Elements of an accessor as bytes, one after the other without gaps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RawElements {
    /// Bytes of all elements.
    pub bytes: Vec<u8>,
    /// Bytes of an element.
    pub size: usize,
}

impl GltfFile {
    /// Reads a file and its buffers.
    ///
    /// # Errors
    ///
    /// The same as those of [`load`](crate::load), as far as they concern the document and its buffers.
    pub fn open(path: &Path) -> Result<Self, LoadError> {
        let (text, binary) = container::read(path)?;
        let document = document::parse(path, &text)?;
        let json = deserialize::from_slice(&text).map_err(|error| LoadError::Gltf {
            path: path.to_owned(),
            what: format!("its text is not complete, valid JSON ({error})"),
        })?;
        let buffers = container::buffers(path, &document.root, binary)?;
        Ok(Self { path: path.to_owned(), json, document, buffers })
    }

    /// Returns the JSON document.
    #[must_use]
    pub fn json(&self) -> &Value {
        &self.json
    }

    /// Returns the bytes of the buffers. A buffer without data is empty.
    pub fn buffers(&self) -> impl ExactSizeIterator<Item = &[u8]> {
        self.buffers.iter().map(|buffer| &buffer[..])
    }

    /// Returns the triangles of a primitive; `None` for points, lines, and primitives without positions.
    ///
    /// # Errors
    ///
    /// If the primitive does not exist, or its data are missing or invalid.
    pub fn primitive(&self, mesh: usize, primitive: usize) -> Result<Option<GltfPrimitive>, LoadError> {
        let (data, what) = (self.data(), format!("mesh {mesh}, primitive {primitive}"));
        let source = self.lookup_primitive(mesh, primitive, &what)?;
        let positions = source.attributes.get(&Checked::Valid(Semantic::Positions));
        let Some(&accessor) = positions.filter(|_| data.has_triangles(source, &what).unwrap_or(false)) else {
            return Ok(None);
        };
        let positions = data.positions(accessor, &what)?;
        let triangles = data.triangles(source, positions.len(), &what)?;
        Ok(Some(GltfPrimitive { positions, triangles }))
    }

    /// Returns a set of texture coordinates of a primitive; `None` if it does not have that set.
    ///
    /// # Errors
    ///
    /// If the primitive does not exist, or its data are missing or invalid.
    pub fn coordinates(
        &self,
        mesh: usize,
        primitive: usize,
        set: u32,
    ) -> Result<Option<Vec<[f32; 2]>>, LoadError> {
        use ComponentType::{F32, I8, I16, U8, U16};
        let what = format!("mesh {mesh}, primitive {primitive}, texture coordinates");
        let source = self.lookup_primitive(mesh, primitive, &what)?;
        let Some(&accessor) = source.attributes.get(&Checked::Valid(Semantic::TexCoords(set))) else {
            return Ok(None);
        };
        let places = self.data().elements::<2>(accessor, Type::Vec2, &[F32, I8, U8, I16, U16], &what)?;
        Ok(Some(places.into_iter().map(|place| place.map(|x| x as f32)).collect()))
    }

    /// Returns the elements of an accessor of vertices as bytes.
    ///
    /// # Errors
    ///
    /// If the accessor does not exist, has matrices, or its data are missing or invalid.
    pub fn raw_elements(&self, accessor: usize) -> Result<RawElements, LoadError> {
        let (bytes, size) = self.data().raw_elements(Index::<Accessor>::new(accessor as u32))?;
        Ok(RawElements { bytes, size })
    }

    /// Returns the transforms of the instances of the mesh of a node (`EXT_mesh_gpu_instancing`) to the node; without the
    /// extension, that of the mesh itself.
    ///
    /// # Errors
    ///
    /// If their data are missing or invalid.
    pub fn instance_transforms(&self, node: usize) -> Result<Vec<DAffine3>, LoadError> {
        let instances = self.data().instances(node)?;
        Ok((0..instances.count()).map(|i| instances.to_node(i)).collect())
    }

    /// Returns the encoded bytes of an image.
    ///
    /// # Errors
    ///
    /// If the image does not exist or cannot be read; the text says why.
    pub fn image(&self, index: usize) -> Result<Vec<u8>, String> {
        let data = self.data();
        data.image(index, &data.pixels(index))
    }

    fn data(&self) -> Data<'_> {
        Data::new(&self.path, &self.document, &self.buffers)
    }

    fn lookup_primitive(
        &self,
        mesh: usize,
        primitive: usize,
        what: &str,
    ) -> Result<&::gltf::json::mesh::Primitive, LoadError> {
        let root = &self.document.root;
        let mesh: &::gltf::json::Mesh = lookup(&self.path, root, Index::new(mesh as u32), what)?;
        mesh.primitives.get(primitive).ok_or_else(|| self.data().invalid(format!("{what} does not exist")))
    }
}
