use super::*;

#[test]
fn words_know_their_places_on_lines_of_every_system() {
    let source = Source::new("a");
    let mut words = Words::new(b"one  two#no\r\nthree\rfour \n\n five", &source).with_comments();
    let mut seen = Vec::new();
    while let Some(word) = words.next() {
        seen.push((String::from_utf8_lossy(word.bytes).into_owned(), word.line, word.column));
    }
    let expected = [("one", 1, 1), ("two", 1, 6), ("three", 2, 1), ("four", 3, 1), ("five", 5, 2)];
    assert_eq!(seen, expected.map(|(word, line, column)| (word.to_owned(), line, column)));
}

#[test]
fn a_backslash_joins_lines_and_a_rest_keeps_its_blanks() {
    let source = Source::new("a");
    let text = b"f 1 \\\r\n 2\nname  a b#c # no\nlast";
    let mut words = Words::new(text, &source).with_comments().with_joined_lines();
    let mut line = Vec::new();
    while let Some(word) = words.on_line() {
        line.push(word.bytes);
    }
    assert_eq!(line, [&b"f"[..], b"1", b"2"]);
    assert!(words.end_line());
    assert_eq!(words.on_line().map(|word| word.line), Some(3));
    assert_eq!(words.rest(), "a b#c");
    assert!(words.end_line());
    assert_eq!(words.rest(), "last");
    assert!(!words.end_line());
}

#[test]
fn an_error_names_the_word() {
    let source = Source::new("a.b");
    let error = Words::new(b"1 x", &source);
    let mut words = error.clone();
    assert_eq!(words.number("a number"), Ok(1.0));
    let error = words.number("a radius").expect_err("no number");
    assert_eq!(error.to_string(), "a.b:1:3: expected a radius, found `x`");
    let error = words.number("a radius").expect_err("no word");
    assert_eq!(error.to_string(), "a.b:1:4: the file ends where a radius should be");
}
