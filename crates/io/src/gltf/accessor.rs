//! Accessors: numbers in buffers, every promise checked before one is read.

use std::borrow::Cow;

use super::Reader;
use super::document::{Accessor, Sparse};

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

/// Elements of an accessor, all of them there.
#[derive(Debug)]
pub(super) struct Elements<'a> {
    bytes: Cow<'a, [u8]>,
    stride: usize,
    /// How many there are.
    pub(super) count: usize,
    component: Component,
    /// Numbers in each.
    pub(super) width: usize,
    normalized: bool,
}

impl Component {
    fn of(code: u32) -> Result<Self, String> {
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(format!("there is no componentType {code}")),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

impl Elements<'_> {
    /// A number of an element. Whole numbers that stand for fractions are such.
    ///
    /// # Panics
    /// If there is no such element or number.
    pub(super) fn float(&self, element: usize, at: usize) -> f32 {
        let at = element * self.stride + at * self.component.size();
        let b = &self.bytes[at..];
        let (value, largest) = match self.component {
            Component::I8 => (f32::from(b[0] as i8), 127.0),
            Component::U8 => (f32::from(b[0]), 255.0),
            Component::I16 => (f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            Component::U16 => (f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            Component::U32 => {
                (u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32, 4_294_967_295.0)
            }
            Component::F32 => return f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        };
        if self.normalized { (value / largest).max(-1.0) } else { value }
    }

    /// A whole number of an element; none if it is not stored as one, or negative.
    ///
    /// # Panics
    /// If there is no such element or number.
    pub(super) fn index(&self, element: usize, at: usize) -> Option<u32> {
        let at = element * self.stride + at * self.component.size();
        let b = &self.bytes[at..];
        match self.component {
            Component::U8 => Some(u32::from(b[0])),
            Component::U16 => Some(u32::from(u16::from_le_bytes([b[0], b[1]]))),
            Component::U32 => Some(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Component::I8 | Component::I16 | Component::F32 => None,
        }
    }

    /// Elements of `N` numbers.
    pub(super) fn array<const N: usize>(&self, element: usize) -> [f32; N] {
        std::array::from_fn(|at| self.float(element, at))
    }
}

impl<'a> Reader<'a> {
    /// The elements of an accessor, which must have one of `widths` numbers each.
    pub(super) fn elements(
        &mut self,
        number: usize,
        widths: &[usize],
    ) -> Result<Elements<'a>, String> {
        let accessor = self.document.accessors.get(number);
        let accessor = accessor.ok_or_else(|| format!("there is no accessors[{number}]"))?;
        self.spend(accessor.count)?;
        self.checked(accessor, widths).map_err(|why| format!("accessors[{number}]: {why}"))
    }

    fn checked(&self, accessor: &Accessor, widths: &[usize]) -> Result<Elements<'a>, String> {
        let component = Component::of(accessor.component_type)?;
        let width = match accessor.shape.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            // Smaller ones have gaps; nothing that is read uses them.
            "MAT4" => 16,
            other => return Err(format!("type `{}` is not read", other.escape_debug())),
        };
        if !widths.contains(&width) {
            return Err(format!("{} where something else should be", accessor.shape));
        }
        let size = width * component.size();
        let (bytes, stride) = match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = self.view(view)?;
                let stride = stride.filter(|&stride| stride > 0).unwrap_or(size);
                (
                    Cow::Borrowed(reach(
                        bytes,
                        accessor.byte_offset,
                        accessor.count,
                        stride,
                        size,
                    )?),
                    stride,
                )
            }
            None => {
                // Nothing but zeros: believed as far as other attributes may have as many.
                let length = accessor.count.checked_mul(size);
                let length = length.filter(|&length| length <= self.bytes.saturating_mul(4));
                let length = length.ok_or("has far too many elements for no bytes")?;
                (Cow::Owned(vec![0; length]), size)
            }
        };
        let normalized = accessor.normalized && component != Component::F32;
        let mut elements =
            Elements { bytes, stride, count: accessor.count, component, width, normalized };
        if let Some(sparse) = &accessor.sparse {
            self.replace(&mut elements, sparse).map_err(|why| format!("sparse: {why}"))?;
        }
        Ok(elements)
    }

    /// Puts the elements of a sparse accessor in their places.
    fn replace(&self, elements: &mut Elements<'a>, sparse: &Sparse) -> Result<(), String> {
        let component = Component::of(sparse.indices.component_type)?;
        let index_size = component.size();
        let size = elements.width * elements.component.size();
        let (bytes, _) = self.view(sparse.indices.buffer_view)?;
        let bytes = reach(bytes, sparse.indices.byte_offset, sparse.count, index_size, index_size)?;
        let indices = Elements {
            bytes: Cow::Borrowed(bytes),
            stride: index_size,
            count: sparse.count,
            component,
            width: 1,
            normalized: false,
        };
        let (values, _) = self.view(sparse.values.buffer_view)?;
        let values = reach(values, sparse.values.byte_offset, sparse.count, size, size)?;
        let stride = elements.stride;
        let owned = elements.bytes.to_mut();
        for (i, value) in values.chunks_exact(size).take(sparse.count).enumerate() {
            let place = indices.index(i, 0).map(|index| index as usize);
            let place = place.filter(|&place| place < elements.count);
            let place = place.ok_or("an index is out of range")?;
            owned[place * stride..][..size].copy_from_slice(value);
        }
        Ok(())
    }
}

/// The bytes from `offset` on, if there is room for so many elements.
fn reach(
    bytes: &[u8],
    offset: usize,
    count: usize,
    stride: usize,
    size: usize,
) -> Result<&[u8], String> {
    if stride < size {
        return Err(format!("elements of {size} bytes every {stride} bytes overlap"));
    }
    let length = match count.checked_sub(1) {
        Some(last) => last.checked_mul(stride).and_then(|bytes| bytes.checked_add(size)),
        None => Some(0),
    };
    let rest = bytes.get(offset..).filter(|rest| length.is_some_and(|length| rest.len() >= length));
    rest.ok_or_else(|| {
        let have = bytes.len();
        format!(
            "{count} elements every {stride} bytes from {offset} on, but there are {have} bytes"
        )
    })
}
