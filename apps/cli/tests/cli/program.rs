//! Running the program, and the files it is given.

use std::process::Output;

use assert_cmd::Command;

/// A folder that goes away.
#[derive(Debug)]
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    /// The path of a file in it.
    pub(crate) fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_string_lossy().into_owned()
    }

    pub(crate) fn write(&self, name: &str, text: &str) -> String {
        self.write_bytes(name, text.as_bytes())
    }

    pub(crate) fn write_bytes(&self, name: &str, bytes: &[u8]) -> String {
        let path = self.path(name);
        std::fs::write(&path, bytes).expect("writable");
        path
    }

    /// The names of all files in it, in order.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).expect("readable");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

/// What the program did.
#[derive(Debug)]
pub(crate) struct Ran {
    pub(crate) code: Option<i32>,
    pub(crate) output: String,
    pub(crate) errors: String,
}

/// Runs the program.
pub(crate) fn nestray(args: &[&str]) -> Ran {
    nestray_with(args, &[])
}

/// Runs the program in an environment with these values, too.
pub(crate) fn nestray_with(args: &[&str], values: &[(&str, &str)]) -> Ran {
    let mut command = Command::cargo_bin("nestray").expect("it was built");
    // The user's own cache is not for tests.
    let cache = Folder::new();
    command.env("XDG_CACHE_HOME", cache.0.path());
    command.envs(values.iter().copied());
    let Output { status, stdout, stderr } =
        command.args(args).timeout(std::time::Duration::from_secs(120)).output().expect("it runs");
    Ran {
        code: status.code(),
        output: String::from_utf8_lossy(&stdout).into_owned(),
        errors: String::from_utf8_lossy(&stderr).into_owned(),
    }
}

impl Ran {
    pub(crate) fn succeeds(self) -> Self {
        assert_eq!(self.code, Some(0), "{}", self.errors);
        self
    }

    /// It ends with this code, and one line that holds all these words.
    pub(crate) fn fails(self, code: i32, words: &[&str]) -> Self {
        assert_eq!(self.code, Some(code), "{}", self.errors);
        assert_eq!(self.errors.trim_end().lines().count(), 1, "{}", self.errors);
        assert!(self.errors.starts_with("nestray: "), "{}", self.errors);
        for word in words {
            assert!(self.errors.contains(word), "{word:?} is not in {}", self.errors);
        }
        assert_eq!(self.output, "");
        self
    }
}

/// A file of rays, six numbers each.
pub(crate) fn rays(list: &[[f64; 6]]) -> Vec<u8> {
    let shape = format!("({}, 6)", list.len());
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.extend(list.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    bytes
}
