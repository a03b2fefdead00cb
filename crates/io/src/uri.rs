//! What other files are named by: names, and data URIs that are the file.

use crate::load::Source;

/// The bytes of a data URI; none if it is something else.
pub(crate) fn data(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let rest = uri.strip_prefix("data:")?;
    Some(match rest.split_once(',') {
        Some((head, data)) if head.ends_with(";base64") => decoded(data),
        Some((_, data)) => Ok(percent(data)),
        None => Err("is a data URI without data".into()),
    })
}

/// The bytes behind a URI: inside it, or of a file beside the one that is read.
pub(crate) fn fetch(uri: &str, source: &Source) -> Result<Vec<u8>, String> {
    if let Some(bytes) = data(uri) {
        return bytes;
    }
    let shown: String = uri.chars().take(100).flat_map(char::escape_debug).collect();
    if uri.contains("://") {
        return Err(format!("`{shown}` is not a file"));
    }
    let name = String::from_utf8(percent(uri)).map_err(|_| format!("`{shown}` is not a name"))?;
    source.companion_bytes(&source.companion(&name)).map_err(|error| error.to_string())
}

/// Undoes `%20` and the like; what is no such code stays.
fn percent(text: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let code = (first == b'%').then(|| after.get(..2)).flatten();
        let code = code.filter(|two| two.iter().all(u8::is_ascii_hexdigit));
        let code = code.and_then(|two| std::str::from_utf8(two).ok());
        match code.and_then(|two| u8::from_str_radix(two, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            None => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    bytes
}

/// Undoes base 64, with or without the padding at the end.
fn decoded(text: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let (mut bits, mut count) = (0u32, 0);
    for &letter in text.trim_end().trim_end_matches('=').as_bytes() {
        let six = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return Err("is not in base 64".into()),
        };
        bits = (bits << 6) | u32::from(six);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    Ok(bytes)
}

/// Bytes in base 64.
pub(crate) fn encoded(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |at: usize| u32::from(three.get(at).copied().unwrap_or(0));
        let bits = (byte(0) << 16) | (byte(1) << 8) | byte(2);
        for at in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * at)) as usize & 63];
            text.push(if at <= three.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base_64_goes_there_and_back_and_garbage_is_refused() {
        for (text, bytes) in
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYmE=", "fooba")]
        {
            assert_eq!(encoded(bytes.as_bytes()), text);
            assert_eq!(decoded(text).expect("sound"), bytes.as_bytes());
            assert_eq!(decoded(text.trim_end_matches('=')).expect("sound"), bytes.as_bytes());
        }
        assert!(decoded("Zg=x").is_err());
        assert_eq!(data("data:,a%20b"), Some(Ok(b"a b".to_vec())));
        assert_eq!(data("file.bin"), None);
    }

    #[test]
    fn percent_codes_are_undone() {
        assert_eq!(percent("a%20b%2"), b"a b%2");
        assert_eq!(percent("100%+1"), b"100%+1");
        assert_eq!(percent("%+1"), b"%+1");
    }
}
