//! The head of a PLY file: what follows, in which order, of which types.

use crate::error::LoadError;
use crate::load::Source;
use crate::words::{Word, Words};

/// What a file says it holds.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Its length.
    pub(super) bytes: usize,
    /// Its lines.
    pub(super) lines: usize,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// Rows that are alike.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
    /// Where it is announced.
    pub(super) line: usize,
}

/// A number of a row, or a list of them.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// What the length of a list is written as.
    pub(super) length: Option<Kind>,
}

/// Types of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Header {
    pub(super) fn read(bytes: &[u8], source: &Source) -> Result<Self, LoadError> {
        let mut words = Words::new(bytes, source);
        let first = words.expect("`ply`")?;
        if first.bytes != b"ply" {
            return Err(words.unfit(&first, "`ply`"));
        }
        // Files of old systems end lines so; then a number may begin with a line feed.
        let lone_return = bytes[words.offset()..].starts_with(b"\r")
            && !bytes[words.offset()..].starts_with(b"\r\n");
        let (mut encoding, mut elements) = (None, Vec::<Element>::new());
        loop {
            words.end_line();
            let word = match words.on_line() {
                Some(word) => word,
                None if words.left() == 0 => words.expect("`end_header`")?,
                None => continue,
            };
            match word.bytes {
                b"comment" | b"obj_info" => {}
                b"format" => encoding = Some(Encoding::read(&mut words)?),
                b"element" => elements.push(Element::read(&mut words)?),
                b"property" => {
                    let property = Property::read(&mut words)?;
                    let element = elements
                        .last_mut()
                        .ok_or_else(|| words.spot(&word).error("a property before any element"))?;
                    element.properties.push(property);
                }
                b"end_header" => break,
                _ => return Err(words.unfit(&word, "a line of the head")),
            }
        }
        let encoding = encoding
            .ok_or_else(|| source.spot().error("does not say whether it is text or binary"))?;
        let blanks = bytes[words.offset()..].iter().take_while(|b| matches!(b, b' ' | b'\t'));
        let end = words.offset() + blanks.count();
        let ending: usize = match &bytes[end..] {
            [b'\r', b'\n', ..] if !lone_return => 2,
            [b'\r' | b'\n', ..] => 1,
            [] => 0,
            _ => return Err(words.here().error("`end_header` is not alone on its line")),
        };
        Ok(Self { encoding, elements, bytes: end + ending, lines: words.line() })
    }
}

impl Encoding {
    fn read(words: &mut Words<'_>) -> Result<Self, LoadError> {
        let word = on_line(words, "a format")?;
        match word.bytes {
            b"ascii" => Ok(Self::Ascii),
            b"binary_little_endian" => Ok(Self::Little),
            b"binary_big_endian" => Ok(Self::Big),
            _ => Err(words.unfit(&word, "a format of PLY")),
        }
    }
}

impl Element {
    fn read(words: &mut Words<'_>) -> Result<Self, LoadError> {
        let name = on_line(words, "a name")?;
        let word = on_line(words, "a count")?;
        let count = word.whole().and_then(|count| usize::try_from(count).ok());
        let count = count.ok_or_else(|| words.unfit(&word, "a count"))?;
        Ok(Self { name: text(&name), count, properties: Vec::new(), line: word.line })
    }

    /// Fewest bytes a row can take.
    pub(super) fn least_bytes(&self, encoding: Encoding) -> usize {
        let of = |property: &Property| match encoding {
            // A digit and a blank.
            Encoding::Ascii => 2,
            _ => property.length.unwrap_or(property.kind).bytes(),
        };
        self.properties.iter().map(of).sum()
    }

    /// Which property lists the corners of a face.
    pub(super) fn corners(&self) -> Option<usize> {
        let named = |p: &Property| p.name == "vertex_indices" || p.name == "vertex_index";
        self.properties.iter().position(|p| p.length.is_some() && named(p))
    }
}

impl Property {
    fn read(words: &mut Words<'_>) -> Result<Self, LoadError> {
        let mut kind = on_line(words, "a type")?;
        let mut length = None;
        if kind.bytes == b"list" {
            let word = on_line(words, "a type")?;
            let whole = Kind::read(words, &word)?;
            if !whole.is_whole() {
                return Err(words.unfit(&word, "a type of whole numbers"));
            }
            length = Some(whole);
            kind = on_line(words, "a type")?;
        }
        let kind = Kind::read(words, &kind)?;
        Ok(Self { name: text(&on_line(words, "a name")?), kind, length })
    }
}

impl Kind {
    fn read(words: &Words<'_>, word: &Word<'_>) -> Result<Self, LoadError> {
        Ok(match word.bytes {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return Err(words.unfit(word, "a type of PLY")),
        })
    }

    /// How many bytes one takes.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Whether it has no fractions.
    pub(super) fn is_whole(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

fn on_line<'a>(words: &mut Words<'a>, what: &str) -> Result<Word<'a>, LoadError> {
    words
        .on_line()
        .ok_or_else(|| words.here().error(format!("the line ends where {what} should be")))
}

fn text(word: &Word<'_>) -> String {
    String::from_utf8_lossy(word.bytes).into_owned()
}
