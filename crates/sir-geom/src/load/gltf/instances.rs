//! Copies of the mesh of a node (`EXT_mesh_gpu_instancing`).

use ::gltf::json::Index;
use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use glam::{DAffine3, DQuat, DVec3};

use crate::load::error::LoadError;
use crate::load::gltf::data::{Data, lookup};
use crate::load::gltf::reader::Reader;

/// Instances of the mesh of a node.
pub(super) struct Instances {
    count: usize,
    translations: Option<Vec<[f64; 3]>>,
    rotations: Option<Vec<[f64; 4]>>,
    scales: Option<Vec<[f64; 3]>>,
}

impl Instances {
    /// The mesh itself.
    const SINGLE: Self = Self { count: 1, translations: None, rotations: None, scales: None };

    /// Returns the number of instances.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Returns the transform from instance `i` to the node.
    pub(super) fn to_node(&self, i: usize) -> DAffine3 {
        let vector = |list: &Option<Vec<[f64; 3]>>, default| {
            list.as_ref().map_or(default, |list| DVec3::from_array(list[i]))
        };
        let rotation = self.rotations.as_ref().map(|list| unit(DQuat::from_array(list[i])));
        DAffine3::from_scale_rotation_translation(
            vector(&self.scales, DVec3::ONE),
            rotation.unwrap_or(DQuat::IDENTITY),
            vector(&self.translations, DVec3::ZERO),
        )
    }
}

impl Reader<'_> {
    /// Returns the instances of the mesh of a node.
    pub(super) fn instances(&mut self, node: usize) -> Result<Instances, LoadError> {
        let extensions = self.data.document.nodes.get(&node);
        if extensions.is_some_and(|of| of.instances.keys().any(|name| name.contains("COLOR"))) {
            self.notes.count("nodes have instances with colors, which were ignored", 1);
        }
        self.data.instances(node)
    }
}

impl Data<'_> {
    /// Returns the instances of the mesh of a node. Without the extension, the mesh itself is the only one.
    pub(super) fn instances(&self, node: usize) -> Result<Instances, LoadError> {
        use ComponentType::{F32, I8, I16};
        let attributes = match self.document.nodes.get(&node) {
            Some(extensions) if !extensions.instances.is_empty() => &extensions.instances,
            _ => return Ok(Instances::SINGLE),
        };
        let what = format!("node {node}, instances");
        let mut counts = Vec::with_capacity(attributes.len());
        for &index in attributes.values() {
            let accessor: &Accessor =
                lookup(self.path, self.root, Index::new(index), &format!("{what}: accessor"))?;
            counts.push(usize::try_from(accessor.count.0).unwrap_or(usize::MAX));
        }
        let count = counts.iter().copied().min().unwrap_or_default();
        if let Some(most) = counts.into_iter().find(|&other| other != count) {
            return Err(self.invalid(format!("{what}: attributes have {count} and {most} elements")));
        }
        let attribute = |name: &str| attributes.get(name).map(|&index| Index::new(index));
        let vectors = |name| {
            attribute(name).map(|index| self.elements::<3>(index, Type::Vec3, &[F32], &what)).transpose()
        };
        let rotations = attribute("ROTATION")
            .map(|index| self.elements::<4>(index, Type::Vec4, &[F32, I8, I16], &what))
            .transpose()?;
        Ok(Instances { count, translations: vectors("TRANSLATION")?, rotations, scales: vectors("SCALE")? })
    }
}

/// Returns a rotation as a unit quaternion, because one in single precision has length one to seven digits only. Zero
/// is no rotation.
pub(super) fn unit(rotation: DQuat) -> DQuat {
    if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY }
}
