//! Traversal of the nodes of a scene.

use ::gltf::json::scene::Node;
use ::gltf::json::{Index, Root};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::load::error::LoadError;
use crate::load::gltf::camera;
use crate::load::gltf::data::lookup;
use crate::load::gltf::instances::unit;
use crate::load::gltf::primitive::Shared;
use crate::load::gltf::reader::{Reader, label};

/// Maximum number of mesh primitives after instances are expanded.
const MAX_PRIMITIVES: usize = 1 << 23;

impl Reader<'_> {
    /// Adds the contents of the default scene; without one, of the first scene; without scenes, of all nodes.
    pub(super) fn scene(mut self) -> Result<(), LoadError> {
        let scene = match self.data.root.scene {
            Some(index) => Some(lookup(self.data.path, self.data.root, index, "the default scene: scene")?),
            None => self.data.root.scenes.first(),
        };
        let roots = match scene {
            Some(scene) => scene.nodes.clone(),
            None => orphans(self.data.root),
        };
        // The stack is explicit, because the depth of a tree from a file has no limit. Children are pushed in reverse
        // order, so that they are visited in file order.
        let mut stack: Vec<_> =
            roots.into_iter().rev().map(|node| (node, DAffine3::IDENTITY, false)).collect();
        let mut visited = vec![false; self.data.root.nodes.len()];
        while let Some((index, parent, is_parent_hidden)) = stack.pop() {
            let node = lookup(self.data.path, self.data.root, index, "a scene or node: node")?;
            if std::mem::replace(&mut visited[index.value()], true) {
                let what = format!("node {} has two parents or is its own descendant", index.value());
                return Err(self.data.invalid(what));
            }
            let to_world = parent * local_transform(node);
            let is_hidden = is_parent_hidden || self.is_hidden(index.value(), node);
            self.camera(node, &to_world)?;
            if !is_hidden {
                self.light(node, &to_world)?;
                self.luminaire(index.value(), node, &to_world)?;
                self.mesh(index.value(), node, &to_world)?;
            }
            stack.extend(node.children.iter().flatten().rev().map(|&child| (child, to_world, is_hidden)));
        }
        Ok(())
    }

    /// Returns true if a node hides itself and its descendants (`KHR_node_visibility`), which is noted.
    fn is_hidden(&mut self, index: usize, node: &Node) -> bool {
        let is_hidden = self.data.document.nodes.get(&index).is_some_and(|extensions| extensions.is_hidden);
        if is_hidden {
            let name = label("node", index, node.name.as_deref().unwrap_or_default());
            self.notes.name("nodes are hidden; they and the meshes and lights below them were skipped", name);
        }
        is_hidden
    }

    /// Adds the camera of a node, if it has one. Hidden nodes keep their cameras.
    fn camera(&mut self, node: &Node, to_world: &DAffine3) -> Result<(), LoadError> {
        let Some(index) = node.camera else { return Ok(()) };
        let source = lookup(self.data.path, self.data.root, index, "a node: camera")?;
        let name = source.name.as_deref().or(node.name.as_deref()).unwrap_or_default();
        match camera::convert(source, name, to_world) {
            Some(camera) => self.builder.add_camera(camera),
            None => self.notes.name(
                "cameras have no valid projection or orientation and were ignored",
                label("camera", index.value(), name),
            ),
        }
        Ok(())
    }

    /// Adds all instances of the mesh of a node, if it has one.
    fn mesh(&mut self, number: usize, node: &Node, to_world: &DAffine3) -> Result<(), LoadError> {
        let Some(index) = node.mesh else { return Ok(()) };
        if node.skin.is_some() {
            self.notes.count("skinned meshes are read in the pose of their nodes", 1);
        }
        let mesh = lookup(self.data.path, self.data.root, index, "a node: mesh")?;
        self.builder.begin_group(node.name.as_deref().or(mesh.name.as_deref()).unwrap_or_default());
        let instances = self.instances(number)?;
        // Instances without triangles count, too: they take time, and a small file can ask for many.
        let primitives = instances.count().saturating_mul(mesh.primitives.len().max(1));
        self.primitives = self.primitives.saturating_add(primitives);
        self.check_limit("mesh primitives", self.primitives, MAX_PRIMITIVES)?;
        for instance in 0..instances.count() {
            let to_world = *to_world * instances.to_node(instance);
            self.builder.begin_mesh([number, instance, index.value()].map(|i| i as u32), to_world);
            let mut shared = Shared::default();
            for (i, primitive) in mesh.primitives.iter().enumerate() {
                let what = format!("mesh {}, primitive {i}", index.value());
                self.primitive(primitive, &to_world, &mut shared, &what)?;
            }
        }
        Ok(())
    }
}

/// Returns the nodes without a parent.
fn orphans(root: &Root) -> Vec<Index<Node>> {
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
        if let Some(flag) = is_child.get_mut(child.value()) {
            *flag = true;
        }
    }
    (0u32..).zip(is_child).filter(|(_, is_child)| !is_child).map(|(i, _)| Index::new(i)).collect()
}

/// Returns the transform from a node to its parent: a matrix, or translation × rotation × scale.
fn local_transform(node: &Node) -> DAffine3 {
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    if let Some(matrix) = node.matrix {
        let m = matrix.map(f64::from);
        let column = |i: usize| DVec3::new(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
        return DAffine3::from_mat3_translation(DMat3::from_cols(column(0), column(1), column(2)), column(3));
    }
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| unit(DQuat::from_array(q.0.map(f64::from))));
    DAffine3::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, vector),
        rotation,
        node.translation.map_or(DVec3::ZERO, vector),
    )
}
