//! A sheet: pictures in rows, each with its name below.

use std::path::Path;

use image::RgbImage;

use crate::letters;

/// Space between pictures, and above and below names.
const GAP: usize = 4;
const PAPER: [u8; 3] = [28, 28, 30];
const INK: [u8; 3] = [225, 225, 225];

/// A picture and its name.
#[derive(Debug)]
pub(crate) struct Cell {
    pub(crate) name: String,
    /// Three bytes a pixel, row by row.
    pub(crate) bytes: Vec<u8>,
}

/// How a sheet is laid out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    pub(crate) columns: usize,
    /// Pixels of each picture, across and down.
    pub(crate) size: [usize; 2],
}

impl Layout {
    /// All cells on one sheet.
    pub(crate) fn compose(&self, cells: &[Cell]) -> RgbImage {
        let [width, height] = self.size;
        let [across, down] = [width + GAP, height + letters::HEIGHT + 3 * GAP];
        let rows = cells.len().div_ceil(self.columns);
        let size = [self.columns.min(cells.len()) * across + GAP, rows * down + GAP];
        let mut sheet = RgbImage::from_pixel(size[0] as u32, size[1] as u32, image::Rgb(PAPER));
        for (i, cell) in cells.iter().enumerate() {
            let [left, top] = [GAP + i % self.columns * across, GAP + i / self.columns * down];
            for (at, pixel) in cell.bytes.chunks_exact(3).enumerate() {
                let [x, y] = [left + at % width, top + at / width];
                let color = [pixel[0], pixel[1], pixel[2]];
                sheet.put_pixel(x as u32, y as u32, image::Rgb(color));
            }
            write(&mut sheet, &cell.name, [left, top + height + GAP], width);
        }
        sheet
    }

    /// The same, as a file.
    pub(crate) fn save(&self, cells: &[Cell], path: &Path) -> Result<(), String> {
        let fail = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let file = std::fs::File::create(path).map_err(|error| fail(&error))?;
        let best = image::codecs::png::PngEncoder::new_with_quality(
            std::io::BufWriter::new(file),
            image::codecs::png::CompressionType::Best,
            image::codecs::png::FilterType::Adaptive,
        );
        self.compose(cells).write_with_encoder(best).map_err(|error| fail(&error))
    }
}

/// Writes a name, as much of it as there is room for.
fn write(sheet: &mut RgbImage, name: &str, [left, top]: [usize; 2], room: usize) {
    for (i, letter) in name.chars().take(room / letters::WIDTH).enumerate() {
        for (row, bits) in letters::dots(letter).into_iter().enumerate() {
            for column in (0..5).filter(|column| bits >> (4 - column) & 1 == 1) {
                let x = left + i * letters::WIDTH + column;
                sheet.put_pixel(x as u32, (top + row) as u32, image::Rgb(INK));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_stand_in_rows_with_their_names_below() {
        let cell =
            |name: &str, grey: u8| Cell { name: name.into(), bytes: vec![grey; 3 * 20 * 10] };
        let layout = Layout { columns: 2, size: [20, 10] };
        let sheet = layout.compose(&[cell("I", 50), cell("", 100), cell("toolong", 150)]);
        assert_eq!(sheet.dimensions(), (52, 2 * 29 + 4));
        assert_eq!(sheet.get_pixel(4, 4).0, [50; 3]);
        assert_eq!(sheet.get_pixel(28, 13).0, [100; 3]);
        assert_eq!(sheet.get_pixel(4, 33).0, [150; 3]);
        assert_eq!((sheet.get_pixel(6, 18).0, sheet.get_pixel(4, 18).0), (INK, PAPER));
        assert_eq!(sheet.get_pixel(30, 50).0, PAPER);
    }
}
