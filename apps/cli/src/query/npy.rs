//! Arrays as `NumPy` stores them.

/// Rays as numbers, six or eight each.
#[derive(Debug)]
pub(super) struct Rays {
    width: usize,
    numbers: Vec<f64>,
}

impl Rays {
    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.numbers.len() / self.width
    }

    /// The numbers of one.
    pub(super) fn numbers(&self, ray: usize) -> &[f64] {
        &self.numbers[ray * self.width..][..self.width]
    }
}

/// What the header says.
#[derive(Debug, PartialEq)]
struct Header {
    kind: String,
    by_columns: bool,
    shape: Vec<usize>,
}

/// A file of rays. What its header claims is held against its bytes.
pub(super) fn rays(bytes: Vec<u8>) -> Result<Rays, String> {
    let (text, data) = split(&bytes)?;
    let header = header(text).ok_or("its header is damaged")?;
    let &[count, width @ (6 | 8)] = &header.shape[..] else {
        return Err(format!("is of shape {:?}; rays are (n, 6) or (n, 8)", header.shape));
    };
    let (size, read): (usize, fn(&[u8]) -> f64) = match header.kind.as_str() {
        "<f4" => (4, |b| f32::from_le_bytes(b.try_into().expect("4 bytes")).into()),
        ">f4" => (4, |b| f32::from_be_bytes(b.try_into().expect("4 bytes")).into()),
        "<f8" => (8, |b| f64::from_le_bytes(b.try_into().expect("8 bytes"))),
        ">f8" => (8, |b| f64::from_be_bytes(b.try_into().expect("8 bytes"))),
        kind => return Err(format!("has numbers of type {kind:?}; rays are f32 or f64")),
    };
    let claimed = count.checked_mul(width * size);
    if claimed != Some(data.len()) {
        let found = data.len();
        return Err(format!(
            "claims {count} rays of {width} numbers, but has {found} bytes of them"
        ));
    }
    let mut numbers: Vec<f64> = data.chunks_exact(size).map(read).collect();
    if header.by_columns {
        numbers = (0..count * width).map(|i| numbers[i % width * count + i / width]).collect();
    }
    Ok(Rays { width, numbers })
}

/// The text of the header, and the data.
fn split(bytes: &[u8]) -> Result<(&str, &[u8]), String> {
    let rest = bytes.strip_prefix(b"\x93NUMPY").ok_or("is no .npy file")?;
    let cut = || "ends within its header".to_owned();
    let (length, rest) = match rest {
        [1, _, a, b, rest @ ..] => (usize::from(u16::from_le_bytes([*a, *b])), rest),
        [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
        [1..=3, ..] | [] => return Err(cut()),
        [version, ..] => return Err(format!("is of version {version}, which is not known")),
    };
    if length > rest.len() {
        return Err(cut());
    }
    let (text, data) = rest.split_at(length);
    Ok((std::str::from_utf8(text).map_err(|_| "its header is no text")?, data))
}

/// A header as `NumPy` writes it: a Python dictionary of three entries.
fn header(text: &str) -> Option<Header> {
    let mut rest = text.trim().strip_prefix('{')?.strip_suffix('}')?.trim();
    let (mut kind, mut by_columns, mut shape) = (None, None, None);
    while !rest.is_empty() {
        let (key, after) = quoted(rest)?;
        let value = after.trim_start().strip_prefix(':')?.trim_start();
        rest = match key {
            "descr" => {
                // Of structured types only that they are no numbers matters.
                let (text, after) = quoted(value).or_else(|| list(value))?;
                kind = Some(text.to_owned());
                after
            }
            "fortran_order" => {
                let word = value.split(|c: char| !c.is_alphabetic()).next()?;
                by_columns = Some(match word {
                    "True" => true,
                    "False" => false,
                    _ => return None,
                });
                &value[word.len()..]
            }
            "shape" => {
                let (inside, after) = value.strip_prefix('(')?.split_once(')')?;
                let parts = inside.split(',').map(str::trim).filter(|part| !part.is_empty());
                shape = Some(parts.map(|part| part.parse().ok()).collect::<Option<Vec<usize>>>()?);
                after
            }
            _ => return None,
        };
        rest = rest.trim_start();
        rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
    }
    Some(Header { kind: kind?, by_columns: by_columns?, shape: shape? })
}

/// What is between quotes at the beginning, and what follows.
fn quoted(text: &str) -> Option<(&str, &str)> {
    let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    text[1..].split_once(quote)
}

/// What is between brackets at the beginning, and what follows.
fn list(text: &str) -> Option<(&str, &str)> {
    text.strip_prefix('[')?.split_once(']')
}

/// A file of `count` records of a type.
pub(super) fn file(kind: &str, count: usize, data: &[u8]) -> Vec<u8> {
    let mut text = format!("{{'descr': {kind}, 'fortran_order': False, 'shape': ({count},), }}");
    // With the ten bytes before it, and a line end, it fills blocks of 64.
    let length = (10 + text.len() + 1).next_multiple_of(64) - 10;
    text.push_str(&" ".repeat(length - text.len() - 1));
    text.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.extend(data);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(kind: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        let bytes = file(&format!("'{kind}'"), 0, data);
        let text = String::from_utf8_lossy(&bytes[10..128.min(bytes.len())]).into_owned();
        let text = text.split('\n').next().expect("a line").trim().to_owned();
        let text = text.replace("False", order).replace("(0,)", shape) + "\n";
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((text.len() as u16).to_le_bytes());
        bytes.extend(text.as_bytes());
        bytes.extend(data);
        bytes
    }

    #[test]
    fn rays_of_both_sizes_orders_and_ends_are_read() {
        let numbers: Vec<f64> = (0..12).map(f64::from).collect();
        let bytes = |write: fn(f64) -> Vec<u8>| numbers.iter().flat_map(|&x| write(x)).collect();
        let check = |kind, order, write, expected: &[f64]| {
            let data: Vec<u8> = bytes(write);
            let rays = rays(array(kind, order, "(2, 6)", &data)).expect(kind);
            assert_eq!((rays.count(), rays.numbers(1)), (2, expected), "{kind} {order}");
        };
        let second = [6.0, 7.0, 8.0, 9.0, 10.0, 11.0];
        check("<f8", "False", |x| x.to_le_bytes().to_vec(), &second);
        check(">f8", "False", |x| x.to_be_bytes().to_vec(), &second);
        check("<f4", "False", |x| (x as f32).to_le_bytes().to_vec(), &second);
        check(">f4", "False", |x| (x as f32).to_be_bytes().to_vec(), &second);
        let columns = [1.0, 3.0, 5.0, 7.0, 9.0, 11.0];
        check("<f8", "True", |x| x.to_le_bytes().to_vec(), &columns);
        assert_eq!(rays(array("<f4", "False", "(0, 8)", &[])).expect("empty").count(), 0);
    }

    #[test]
    fn files_that_lie_are_refused() {
        let check = |bytes: Vec<u8>, expected: &str| {
            let error = rays(bytes).expect_err(expected);
            assert!(error.contains(expected), "{error}");
        };
        check(Vec::new(), "is no .npy file");
        check(b"\x93NUMPY".to_vec(), "ends within its header");
        check(b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(), "ends within its header");
        check(b"\x93NUMPY\x09\x00\x00\x00".to_vec(), "version 9");
        check(array("<f4", "False", "(9, 6)", &[0; 24]), "claims 9 rays of 6 numbers, but has 24");
        check(array("<f4", "False", "(4000000000000000000, 6)", &[0; 24]), "claims");
        check(array("<f4", "False", "(99999999999999999999, 6)", &[]), "damaged");
        check(array("<f4", "False", "(6,)", &[0; 24]), "of shape [6]");
        check(array("<f4", "False", "(1, 7)", &[0; 28]), "of shape [1, 7]");
        check(array("<i4", "False", "(1, 6)", &[0; 24]), "numbers of type \"<i4\"");
        check(array("<f4", "Maybe", "(1, 6)", &[0; 24]), "damaged");
        let nested = format!("'{}", "(".repeat(60_000));
        check(file(&nested, 0, &[]), "damaged");
    }

    #[test]
    fn what_is_written_is_aligned_and_read_again() {
        let bytes = file("[('t', '<f4'), ('ray', '<u8')]", 2, &[0; 24]);
        assert_eq!((bytes.len() - 24) % 64, 0);
        let (text, data) = split(&bytes).expect("sound");
        let header = header(text).expect("sound");
        assert_eq!((header.shape, data.len()), (vec![2], 24));
    }
}
