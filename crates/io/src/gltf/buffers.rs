//! The bytes that accessors and images are in.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::Reader;
use super::document::Document;
use crate::load::Source;
use crate::uri::fetch;

/// The bytes of a buffer.
#[derive(Debug)]
pub(super) enum Bytes<'a> {
    /// Here they are.
    There(Cow<'a, [u8]>),
    /// They are those of an earlier buffer.
    Same(usize),
    /// There are none, and why.
    Missing(String),
}

/// All buffers of a document; the first may be the one a GLB file carries along. What cannot
/// be read is only an error if something needs it.
pub(super) fn load<'a>(
    document: &'a Document,
    inside: Option<&'a [u8]>,
    source: &Source,
) -> Vec<Bytes<'a>> {
    let mut first: BTreeMap<&str, usize> = BTreeMap::new();
    let mut buffers: Vec<Bytes<'a>> = Vec::new();
    for (number, buffer) in document.buffers.iter().enumerate() {
        buffers.push(match (&buffer.uri, inside) {
            (None, Some(inside)) if number == 0 => Bytes::There(Cow::Borrowed(inside)),
            (None, _) => Bytes::Missing("has no bytes".into()),
            (Some(uri), _) => match *first.entry(uri).or_insert(number) {
                earlier if earlier < number => Bytes::Same(earlier),
                _ => match fetch(uri, source) {
                    Ok(bytes) => Bytes::There(Cow::Owned(bytes)),
                    Err(why) => Bytes::Missing(why),
                },
            },
        });
    }
    buffers
}

impl<'a> Reader<'a> {
    /// The bytes of a view, and how far apart its elements are if it says so.
    pub(super) fn view(&self, view: usize) -> Result<(&'a [u8], Option<usize>), String> {
        let all = &self.document.buffer_views;
        let found = all.get(view).ok_or_else(|| format!("there is no bufferViews[{view}]"))?;
        let buffer = match self.buffers.get(found.buffer) {
            Some(Bytes::Same(earlier)) => self.buffers.get(*earlier),
            other => other,
        };
        let buffer = buffer
            .ok_or_else(|| format!("bufferViews[{view}]: there is no buffers[{}]", found.buffer))?;
        let packed = found.extensions.meshopt.is_some() || found.extensions.khr_meshopt.is_some();
        let bytes = match buffer {
            Bytes::There(bytes) => bytes,
            _ if packed => {
                let need = "needs EXT_meshopt_compression, which is not read";
                return Err(format!("bufferViews[{view}]: {need}"));
            }
            Bytes::Missing(why) => return Err(format!("buffers[{}]: {why}", found.buffer)),
            Bytes::Same(earlier) => return Err(format!("buffers[{earlier}] cannot be read")),
        };
        let end = found.byte_offset.checked_add(found.byte_length);
        let part = end.and_then(|end| bytes.get(found.byte_offset..end));
        let part = part.ok_or_else(|| {
            let (from, length, have) = (found.byte_offset, found.byte_length, bytes.len());
            format!("bufferViews[{view}]: {length} bytes from {from} on, but there are {have}")
        })?;
        Ok((part, found.byte_stride))
    }
}
