//! Primitives with vertices split at the edges of charts.

use serde_json::{Value, json};
use sir_geom::Side;

use crate::document::{Document, FLOAT};
use crate::error::LightmapError;
use crate::json::{list, object};
use crate::layout::{ABSENT, Sheet, Unfolded};
use crate::objects::Objects;

/// A primitive of a sheet before it has lightmap coordinates.
pub(crate) struct Base<'a> {
    pub(crate) sheet: &'a Sheet,
    pub(crate) unfolded: &'a Unfolded,
    pub(crate) json: Value,
    /// True if it is one side of a surface that has two.
    pub(crate) is_one_sided: bool,
}

/// Returns the primitives of all sheets of a mesh, with vertices split at the edges of charts.
pub(crate) fn base_primitives<'a>(
    document: &mut Document,
    objects: &Objects,
    number: usize,
    sheets: &[&'a Sheet],
    is_split: bool,
) -> Result<Vec<Base<'a>>, LightmapError> {
    let mesh = &objects.meshes[number];
    let source = list(&document.json["meshes"][mesh.index], "primitives").to_vec();
    let mut base = Vec::new();
    for (i, json) in source.iter().enumerate() {
        let is_one_sided = is_split && mesh.primitives[i].is_two_sided;
        for &sheet in sheets {
            let unfolded = &sheet.primitives[i];
            let mut json = json.clone();
            if unfolded.triangles.is_empty() {
                // Points and lines stay as they are.
                if sheet.side == Side::Front {
                    base.push(Base { sheet, unfolded, json, is_one_sided: false });
                }
                continue;
            }
            let is_back = sheet.side == Side::Back;
            split_vertices(document, &mut json, &unfolded.origin, is_back)?;
            let corners = |&[a, b, c]: &[u32; 3]| if is_back { [a, c, b] } else { [a, b, c] };
            let own = unfolded.triangles.iter().filter(|&&triangle| triangle != ABSENT);
            let indices = document.add_indices(own.flat_map(corners));
            let members = object(&mut json);
            members.insert("indices".into(), json!(indices));
            members.remove("mode");
            base.push(Base { sheet, unfolded, json, is_one_sided });
        }
    }
    Ok(base)
}

/// Replaces the attributes of a primitive by copies with these elements. For the back of a surface, normals are turned.
fn split_vertices(
    document: &mut Document,
    primitive: &mut Value,
    origin: &[u32],
    is_back: bool,
) -> Result<(), LightmapError> {
    let replace = |document: &mut Document, attributes: &mut Value| -> Result<(), LightmapError> {
        for (name, accessor) in object(attributes).iter_mut() {
            let Some(index) = accessor.as_u64().map(|index| index as usize) else { continue };
            let count = document.json["accessors"][index]["count"].as_u64().unwrap_or(0);
            let is_same =
                origin.len() as u64 == count && origin.iter().zip(0u32..).all(|(&origin, i)| origin == i);
            let is_turned = is_back && (name == "NORMAL" || name == "TANGENT");
            if is_same && !is_turned {
                continue;
            }
            let copy = document.add_selection(index, origin)?;
            if is_turned {
                document.negate(copy, if name == "NORMAL" { 0..3 } else { 3..4 });
            }
            *accessor = json!(copy);
        }
        Ok(())
    };
    replace(document, &mut primitive["attributes"])?;
    if let Some(targets) = primitive.get_mut("targets").and_then(Value::as_array_mut) {
        for target in targets {
            replace(document, target)?;
        }
    }
    Ok(())
}

impl Document {
    /// Changes the sign of some components of an accessor that was added and has a view of its own.
    fn negate(&mut self, accessor: usize, components: std::ops::Range<usize>) {
        let of = &self.json["accessors"][accessor];
        let (component, count) =
            (of["componentType"].as_u64().unwrap_or(0), of["count"].as_u64().unwrap_or(0));
        let Some(view) = of["bufferView"].as_u64() else { return };
        let bytes = self.view_mut(view as usize);
        let stride = bytes.len() / (count as usize).max(1);
        for element in bytes.chunks_exact_mut(stride.max(1)) {
            for c in components.clone() {
                match component {
                    x if x == u64::from(FLOAT) => {
                        if let Some(sign) = element.get_mut(4 * c + 3) {
                            *sign ^= 0x80;
                        }
                    }
                    5122 => {
                        if let Some([a, b]) = element.get_mut(2 * c..2 * c + 2) {
                            let negative = i16::from_le_bytes([*a, *b]).saturating_neg();
                            [*a, *b] = negative.to_le_bytes();
                        }
                    }
                    5120 => {
                        if let Some(byte) = element.get_mut(c) {
                            *byte = (*byte as i8).saturating_neg() as u8;
                        }
                    }
                    _ => {}
                }
            }
        }
    }
}
