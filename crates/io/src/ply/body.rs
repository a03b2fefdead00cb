//! The numbers of a PLY file, however they are written.

use std::marker::PhantomData;

use crate::error::{LoadError, Spot};
use crate::load::Source;
use crate::ply::header::{Header, Kind};
use crate::words::Words;

/// Numbers one after another.
pub(super) trait Numbers {
    /// The next one.
    fn real(&mut self, kind: Kind) -> Result<f32, LoadError>;

    /// The next one, which has no fraction.
    fn whole(&mut self, kind: Kind) -> Result<i64, LoadError>;

    /// Passes one over.
    fn skip(&mut self, kind: Kind) -> Result<(), LoadError>;

    /// How many bytes are left.
    fn left(&self) -> usize;

    /// Where the reading is.
    fn here(&self) -> Spot;
}

impl<'a> Words<'a> {
    /// What follows the head.
    pub(super) fn from(bytes: &'a [u8], source: &'a Source, header: &Header) -> Self {
        Self::starting(bytes, source, header.bytes, header.lines + 1)
    }
}

impl Numbers for Words<'_> {
    #[inline]
    fn real(&mut self, _kind: Kind) -> Result<f32, LoadError> {
        self.number("a number")
    }

    #[inline]
    fn whole(&mut self, _kind: Kind) -> Result<i64, LoadError> {
        Words::whole(self, "a whole number")
    }

    fn skip(&mut self, _kind: Kind) -> Result<(), LoadError> {
        self.expect("a number").map(|_| ())
    }

    fn left(&self) -> usize {
        Words::left(self)
    }

    fn here(&self) -> Spot {
        Words::here(self)
    }
}

/// Which end of a number comes first.
pub(super) trait End {
    /// The bytes with the lowest first.
    fn little<const N: usize>(bytes: [u8; N]) -> [u8; N];
}

/// The lowest byte first.
#[derive(Debug)]
pub(super) struct Little;

/// The highest byte first.
#[derive(Debug)]
pub(super) struct Big;

impl End for Little {
    #[inline]
    fn little<const N: usize>(bytes: [u8; N]) -> [u8; N] {
        bytes
    }
}

impl End for Big {
    #[inline]
    fn little<const N: usize>(mut bytes: [u8; N]) -> [u8; N] {
        bytes.reverse();
        bytes
    }
}

/// Binary numbers.
#[derive(Debug)]
pub(super) struct Binary<'a, E> {
    bytes: &'a [u8],
    at: usize,
    source: &'a Source,
    end: PhantomData<E>,
}

impl<'a, E: End> Binary<'a, E> {
    pub(super) fn new(bytes: &'a [u8], at: usize, source: &'a Source) -> Self {
        Self { bytes, at, source, end: PhantomData }
    }

    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], LoadError> {
        let Some(&bytes) = self.bytes[self.at..].first_chunk() else {
            return Err(self.here().error("the file ends within its data"));
        };
        self.at += N;
        Ok(E::little(bytes))
    }
}

impl<E: End> Numbers for Binary<'_, E> {
    #[inline]
    fn real(&mut self, kind: Kind) -> Result<f32, LoadError> {
        match kind {
            Kind::F32 => Ok(f32::from_le_bytes(self.take()?)),
            Kind::F64 => Ok(f64::from_le_bytes(self.take()?) as f32),
            _ => Ok(self.whole(kind)? as f32),
        }
    }

    #[inline]
    fn whole(&mut self, kind: Kind) -> Result<i64, LoadError> {
        Ok(match kind {
            Kind::I8 => i8::from_le_bytes(self.take()?).into(),
            Kind::U8 => u8::from_le_bytes(self.take()?).into(),
            Kind::I16 => i16::from_le_bytes(self.take()?).into(),
            Kind::U16 => u16::from_le_bytes(self.take()?).into(),
            Kind::I32 => i32::from_le_bytes(self.take()?).into(),
            Kind::U32 => u32::from_le_bytes(self.take()?).into(),
            Kind::F32 | Kind::F64 => {
                let real = self.real(kind)?;
                if real.trunc() != real {
                    return Err(self.here().error(format!("{real} is no whole number")));
                }
                real as i64
            }
        })
    }

    fn skip(&mut self, kind: Kind) -> Result<(), LoadError> {
        if self.left() < kind.bytes() {
            return Err(self.here().error("the file ends within its data"));
        }
        self.at += kind.bytes();
        Ok(())
    }

    fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn here(&self) -> Spot {
        self.source.spot()
    }
}
