//! The few characters of legends, drawn by hand.

/// Columns a character takes, the gap counted.
pub(super) const WIDTH: usize = 6;
/// Rows.
pub(super) const HEIGHT: usize = 7;

/// The pixels of a character, row by row.
fn glyph(character: char) -> [&'static str; HEIGHT] {
    match character {
        '0' => [" ### ", "#   #", "#  ##", "# # #", "##  #", "#   #", " ### "],
        '1' => ["  #  ", " ##  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "],
        '2' => [" ### ", "#   #", "    #", "   # ", "  #  ", " #   ", "#####"],
        '3' => ["#####", "   # ", "  #  ", "   # ", "    #", "#   #", " ### "],
        '4' => ["   # ", "  ## ", " # # ", "#  # ", "#####", "   # ", "   # "],
        '5' => ["#####", "#    ", "#### ", "    #", "    #", "#   #", " ### "],
        '6' => ["  ## ", " #   ", "#    ", "#### ", "#   #", "#   #", " ### "],
        '7' => ["#####", "    #", "   # ", "  #  ", " #   ", " #   ", " #   "],
        '8' => [" ### ", "#   #", "#   #", " ### ", "#   #", "#   #", " ### "],
        '9' => [" ### ", "#   #", "#   #", " ####", "    #", "   # ", " ##  "],
        '.' => ["     ", "     ", "     ", "     ", "     ", " ##  ", " ##  "],
        '+' => ["     ", "  #  ", "  #  ", "#####", "  #  ", "  #  ", "     "],
        'k' => ["#    ", "#    ", "#  # ", "# #  ", "##   ", "# #  ", "#  # "],
        'M' => ["#   #", "## ##", "# # #", "# # #", "#   #", "#   #", "#   #"],
        _ => ["     "; HEIGHT],
    }
}

/// Pixels to write on.
pub(super) struct Canvas<'a> {
    pub(super) pixels: &'a mut [[f32; 3]],
    pub(super) width: usize,
    /// Pixels a side of one dot.
    pub(super) size: usize,
}

impl Canvas<'_> {
    /// Writes text whose upper left corner is given; what lies outside is left out.
    pub(super) fn write(&mut self, text: &str, left: usize, top: usize) {
        for (i, character) in text.chars().enumerate() {
            for (row, dots) in glyph(character).iter().enumerate() {
                for (column, _) in dots.bytes().enumerate().filter(|&(_, dot)| dot == b'#') {
                    let x = left + (i * WIDTH + column) * self.size;
                    self.dot(x, top + row * self.size);
                }
            }
        }
    }

    fn dot(&mut self, x: usize, y: usize) {
        for y in y..y + self.size {
            for x in (x..x + self.size).filter(|&x| x < self.width) {
                if let Some(pixel) = self.pixels.get_mut(y * self.width + x) {
                    *pixel = [0.8; 3];
                }
            }
        }
    }
}
