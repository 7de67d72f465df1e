//! Numbers from accessors, buffer views and buffers.

use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, buffer};

use crate::load::error::LoadError;
use crate::load::gltf::data::{Data, lookup};

/// Maximum number of accessor elements without a buffer view, summed over all accessors each time they are read: such
/// zeros cost a file nothing.
const MAX_UNBACKED: usize = 1 << 16;

/// Extensions that compress accessors or buffer views.
const COMPRESSIONS: [&str; 4] = [
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "MESHOPT_compression",
];

/// Storage format of the components of an element.
#[derive(Clone, Copy)]
struct Layout {
    component: ComponentType,
    normalized: bool,
}

impl Data<'_> {
    /// Returns the bytes of a buffer view and its stride. `what` names the requester in error messages.
    pub(super) fn view(
        &self,
        index: Index<buffer::View>,
        what: &str,
    ) -> Result<(&[u8], Option<usize>), LoadError> {
        let view = lookup(self.path, self.root, index, &format!("{what}: buffer view"))?;
        let number = view.buffer.value();
        let (buffer, length) = match (self.buffers.get(number), self.root.buffers.get(number)) {
            (Some(bytes), Some(buffer)) if bytes.is_empty() && buffer.byte_length.0 > 0 => {
                let reason = match self.compression() {
                    Some(name) => format!("its views are compressed with {name}, which is not supported"),
                    None => "it has no uri, and there is no binary chunk for it".to_owned(),
                };
                return Err(self.invalid(format!("buffer {number} has no data: {reason}")));
            }
            (Some(bytes), Some(buffer)) => (&bytes[..], buffer.byte_length.0 as usize),
            _ => (&[][..], 0),
        };
        let buffer = &buffer[..length.min(buffer.len())];
        let start = usize::try_from(view.byte_offset.unwrap_or_default().0).ok();
        let end = start.and_then(|s| s.checked_add(usize::try_from(view.byte_length.0).ok()?));
        let bytes = start.zip(end).and_then(|(start, end)| buffer.get(start..end));
        let bytes = bytes.ok_or_else(|| {
            self.invalid(format!(
                "buffer view {} reaches beyond buffer {}, which has {} bytes",
                index.value(),
                number,
                buffer.len()
            ))
        })?;
        // A stride of zero is invalid, but some exporters write it for "none".
        Ok((bytes, view.byte_stride.map(|stride| stride.0).filter(|&stride| stride > 0)))
    }

    /// Returns all elements of an accessor, of `N` components each, as numbers.
    ///
    /// # Errors
    ///
    /// If the accessor has another type than `type_`, a component type that is not `allowed`, or missing data.
    pub(super) fn elements<const N: usize>(
        &self,
        index: Index<Accessor>,
        type_: Type,
        allowed: &[ComponentType],
        what: &str,
    ) -> Result<Vec<[f64; N]>, LoadError> {
        let accessor = lookup(self.path, self.root, index, &format!("{what}: accessor"))?;
        let name = format!("{what}: accessor {}", index.value());
        let layout = match &accessor.component_type {
            Checked::Valid(t)
                if allowed.contains(&t.0) && matches!(accessor.type_, Checked::Valid(t) if t == type_) =>
            {
                Layout { component: t.0, normalized: accessor.normalized }
            }
            _ => return Err(self.invalid(format!("{name} has a type that is not allowed here"))),
        };
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let mut elements = match accessor.buffer_view {
            Some(view) => {
                self.read_elements(view, accessor.byte_offset.unwrap_or_default().0, layout, count, &name)?
            }
            None => {
                if let (None, Some(compression)) = (&accessor.sparse, self.compression()) {
                    return Err(self.invalid(format!(
                        "{name} has no data that is not compressed with {compression}, which is not supported"
                    )));
                }
                let so_far = self.unbacked.get().saturating_add(count);
                if so_far > MAX_UNBACKED {
                    return Err(self.invalid(format!("{name} has {count} elements, but no data")));
                }
                self.unbacked.set(so_far);
                vec![[0.0; N]; count]
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let changes = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
            if changes > count {
                return Err(self
                    .invalid(format!("{name} has {count} elements, but its sparse part changes {changes}")));
            }
            let Checked::Valid(index_type) = &sparse.indices.component_type else {
                return Err(self.invalid(format!("{name} has sparse indices of an unknown type")));
            };
            let places = Layout { component: index_type.0, normalized: false };
            let at = (&sparse.indices.buffer_view, sparse.indices.byte_offset.0);
            let places: Vec<[f64; 1]> = self.read_elements(*at.0, at.1, places, changes, &name)?;
            let from = (&sparse.values.buffer_view, sparse.values.byte_offset.0);
            let values: Vec<[f64; N]> = self.read_elements(*from.0, from.1, layout, changes, &name)?;
            for ([place], value) in places.into_iter().zip(values) {
                *elements
                    .get_mut(place as usize)
                    .ok_or_else(|| self.invalid(format!("{name}: sparse index {place} is out of range")))? =
                    value;
            }
        }
        Ok(elements)
    }

    /// Returns the bytes of all elements of an accessor, and the number of bytes of an element.
    ///
    /// # Errors
    ///
    /// If the accessor has matrices, an unknown type, or missing data.
    pub(super) fn raw_elements(&self, index: Index<Accessor>) -> Result<(Vec<u8>, usize), LoadError> {
        let accessor = lookup(self.path, self.root, index, "accessor")?;
        let name = format!("accessor {}", index.value());
        let (Checked::Valid(component), Checked::Valid(type_)) = (&accessor.component_type, &accessor.type_)
        else {
            return Err(self.invalid(format!("{name} has an unknown type")));
        };
        if matches!(type_, Type::Mat2 | Type::Mat3 | Type::Mat4) {
            return Err(self.invalid(format!("{name} has matrices, which are not allowed here")));
        }
        let size = component.0.size() * type_.multiplicity();
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let mut bytes = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default().0;
                self.raw(view, offset, size, count, &name)?.flatten().copied().collect()
            }
            None if count <= MAX_UNBACKED => vec![0; size * count],
            None => return Err(self.invalid(format!("{name} has {count} elements, but no data"))),
        };
        if let Some(sparse) = &accessor.sparse {
            let changes = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
            let Checked::Valid(index_type) = &sparse.indices.component_type else {
                return Err(self.invalid(format!("{name} has sparse indices of an unknown type")));
            };
            let places = Layout { component: index_type.0, normalized: false };
            let at = (sparse.indices.buffer_view, sparse.indices.byte_offset.0);
            let places: Vec<[f64; 1]> = self.read_elements(at.0, at.1, places, changes, &name)?;
            let from = (sparse.values.buffer_view, sparse.values.byte_offset.0);
            for ([place], value) in places.into_iter().zip(self.raw(from.0, from.1, size, changes, &name)?) {
                let start = (place as usize).saturating_mul(size);
                bytes
                    .get_mut(start..start.saturating_add(size))
                    .ok_or_else(|| self.invalid(format!("{name}: sparse index {place} is out of range")))?
                    .copy_from_slice(value);
            }
        }
        Ok((bytes, size))
    }

    /// Returns the compression of geometry that the file uses, if any.
    fn compression(&self) -> Option<&'static str> {
        COMPRESSIONS.into_iter().find(|name| self.document.extensions.contains(*name))
    }

    /// Returns `count` elements that start at an offset of a buffer view.
    fn read_elements<const N: usize>(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        layout: Layout,
        count: usize,
        what: &str,
    ) -> Result<Vec<[f64; N]>, LoadError> {
        let size = layout.component.size();
        let numbers = |bytes: &[u8]| std::array::from_fn(|c| layout.number(&bytes[c * size..]));
        Ok(self.raw(view, offset, N * size, count, what)?.map(numbers).collect())
    }

    /// Returns the bytes of `count` elements of `size` bytes that start at an offset of a buffer view.
    fn raw(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        size: usize,
        count: usize,
        what: &str,
    ) -> Result<impl Iterator<Item = &[u8]>, LoadError> {
        let (bytes, stride) = self.view(view, what)?;
        let stride = stride.unwrap_or(size);
        let fits = || {
            let offset = usize::try_from(offset).ok()?;
            let end = stride.checked_mul(count.checked_sub(1)?)?.checked_add(size)?.checked_add(offset)?;
            bytes.get(offset..end)
        };
        let found = if count == 0 { Some(&[][..]) } else { fits() };
        let bytes = found.ok_or_else(|| {
            self.invalid(format!(
                "{what} has {count} elements, more than the {} bytes of buffer view {} hold",
                bytes.len(),
                view.value()
            ))
        })?;
        Ok((0..count).map(move |i| &bytes[i * stride..i * stride + size]))
    }
}

impl Layout {
    /// Converts the first bytes to a number (glTF 2.0 specification, section 3.6.2).
    fn number(self, bytes: &[u8]) -> f64 {
        let (value, largest) = match (self.component, bytes) {
            (ComponentType::I8, &[a, ..]) => (f64::from(a as i8), 127.0),
            (ComponentType::U8, &[a, ..]) => (f64::from(a), 255.0),
            (ComponentType::I16, &[a, b, ..]) => (f64::from(i16::from_le_bytes([a, b])), 32767.0),
            (ComponentType::U16, &[a, b, ..]) => (f64::from(u16::from_le_bytes([a, b])), 65535.0),
            (ComponentType::U32, &[a, b, c, d, ..]) => return f64::from(u32::from_le_bytes([a, b, c, d])),
            (ComponentType::F32, &[a, b, c, d, ..]) => return f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => return 0.0,
        };
        if self.normalized { (value / largest).max(-1.0) } else { value }
    }
}
