//! What searches and calibrations found, kept for the next time in the user's cache folder: a file for
//! each scene, integrator and vector level, and one of prices.
//!
//! Nothing depends on it. A cache that cannot be read or written is worked without, and that is said
//! once.

mod prices;

use std::cell::Cell;
use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

use etcetera::{BaseStrategy as _, HomeDirError};
use nestray::io::atomic::write_file;
use nestray::plan::check::check;
use nestray::plan::plan::Plan;
use nestray::prelude::Scene;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::progress::Progress;

/// Most bytes of a file.
const MOST: u64 = 1 << 26;

/// What a search is for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Key {
    /// The version of the program.
    pub(crate) nestray: String,
    /// The vector instructions in use.
    pub(crate) vector_level: String,
    /// How light is followed: that decides which rays there are.
    pub(crate) integrator: String,
    /// The fingerprint of the scene.
    pub(crate) scene: String,
}

/// What a plan takes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Taken {
    /// Seconds of one thread for one sample of a picture.
    pub(crate) sample: f64,
    /// Seconds to build it.
    pub(crate) build: f64,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Entry {
    /// What it is for.
    pub(crate) key: Key,
    /// How long was searched, in seconds.
    pub(crate) searched: f64,
    /// What the default takes.
    pub(crate) default: Taken,
    /// What the plan takes.
    pub(crate) best: Taken,
    /// The plan; it may be the default.
    pub(crate) plan: Plan,
}

/// The folder, and whether there was trouble.
#[derive(Debug)]
pub(crate) struct Cache {
    folder: Option<PathBuf>,
    progress: Progress,
    troubled: Cell<bool>,
}

impl Cache {
    /// The user's, or none if it is not wanted.
    pub(crate) fn open(is_wanted: bool, progress: Progress) -> Self {
        let cache = Self { folder: None, progress, troubled: Cell::new(false) };
        if !is_wanted {
            return cache;
        }
        match users() {
            Ok(folder) => Self { folder: Some(folder.join("nestray")), ..cache },
            Err(error) => {
                cache.trouble(&error.to_string());
                cache
            }
        }
    }

    /// What was found before; nothing if there is nothing of use.
    pub(crate) fn find(&self, key: &Key, scene: &Scene) -> Option<Entry> {
        let path = self.path(key)?;
        match read(&path) {
            Ok(None) => None,
            Err(error) => {
                self.trouble(&format!("{}: {error}", path.display()));
                None
            }
            Ok(Some(text)) => match entry(&text, key, scene) {
                Ok(entry) => Some(entry),
                Err(why) => {
                    self.trouble(&format!("{}: {why}", path.display()));
                    None
                }
            },
        }
    }

    /// Keeps what was found.
    pub(crate) fn keep(&self, entry: &Entry) {
        let Some(path) = self.path(&entry.key) else { return };
        self.write(&path, &serde_json::to_string(entry).expect("an entry is plain data"));
    }

    fn write(&self, path: &Path, text: &str) {
        let folder = path.parent().unwrap_or(path);
        let written = std::fs::create_dir_all(folder)
            .and_then(|()| write_file(path, |out| out.write_all(text.as_bytes())));
        if let Err(error) = written {
            self.trouble(&format!("{}: {error}", path.display()));
        }
    }

    /// The file: of older versions too, so that they do not pile up.
    fn path(&self, key: &Key) -> Option<PathBuf> {
        let Key { scene, integrator, vector_level, .. } = key;
        let name = format!("{scene}-{integrator}-{vector_level}.json");
        self.folder.as_ref().map(|folder| folder.join("plans").join(name))
    }

    /// Says what is wrong, but not more than one thing.
    fn trouble(&self, what: &str) {
        if !self.troubled.replace(true) {
            self.progress.note(&format!("the cache is not used: {what}"));
        }
    }
}

/// The folder for caches: where `XDG_CACHE_HOME` says, on every system, or the system's own.
fn users() -> Result<PathBuf, HomeDirError> {
    let said = std::env::var_os("XDG_CACHE_HOME").map(PathBuf::from);
    match said.filter(|path| path.is_absolute()) {
        Some(path) => Ok(path),
        None => Ok(etcetera::choose_base_strategy()?.cache_dir()),
    }
}

/// What a file holds; none if there is no such file.
fn read(path: &Path) -> io::Result<Option<String>> {
    let mut text = String::new();
    match File::open(path).and_then(|file| file.take(MOST).read_to_string(&mut text)) {
        Ok(_) => Ok(Some(text)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// What a file holds, if it is for this scene and this program.
fn entry(text: &str, key: &Key, scene: &Scene) -> Result<Entry, String> {
    let value: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
    // Other versions may have other fields.
    let version = value["key"]["nestray"].as_str().unwrap_or("?");
    if version != key.nestray {
        return Err(format!("written by version {version}"));
    }
    let entry: Entry = serde_json::from_value(value).map_err(|error| error.to_string())?;
    if entry.key != *key {
        return Err("it is for something else".into());
    }
    let times = [entry.default.sample, entry.default.build, entry.best.sample, entry.best.build];
    if entry.searched < 0.0 || times.iter().any(|&time| time < 0.0) {
        return Err("it has negative times".into());
    }
    check(&entry.plan, scene).map_err(|error| error.to_string())?;
    Ok(entry)
}

#[cfg(test)]
mod tests {
    use nestray::plan::single::single;
    use nestray::scene::procedural::generate;

    use super::*;
    use crate::args::{ProgressMode, Talk};

    pub(super) fn cache(folder: PathBuf) -> Cache {
        let talk = Talk { quiet: true, verbose: false, progress: ProgressMode::None };
        let progress = Progress::new(&talk);
        Cache { folder: Some(folder), progress, troubled: Cell::new(false) }
    }

    fn some(scene: &Scene) -> Entry {
        let key = Key {
            nestray: "1.2.3".into(),
            vector_level: "scalar".into(),
            integrator: "path".into(),
            scene: "5ce4e".into(),
        };
        let (default, best) =
            (Taken { sample: 0.125, build: 0.5 }, Taken { sample: 0.0625, build: 2.5 });
        let plan = single("grid", Default::default(), scene).expect("there is one");
        Entry { key, searched: 3.125, default, best, plan }
    }

    #[test]
    fn what_is_kept_is_found_again_by_the_same_key_only() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path().join("not/there/yet"));
        let scene = generate("balls", Some(1)).expect("there is one");
        let entry = some(&scene);
        assert_eq!(cache.find(&entry.key, &scene), None);
        cache.keep(&entry);
        assert_eq!(cache.find(&entry.key, &scene), Some(entry.clone()));
        let other = Key { integrator: "ao".into(), ..entry.key.clone() };
        assert_eq!(cache.find(&other, &scene), None);
        assert!(!cache.troubled.get());
        let newer = Key { nestray: "1.2.4".into(), ..entry.key };
        assert_eq!(cache.find(&newer, &scene), None);
        assert!(cache.troubled.get());
    }

    #[test]
    fn a_file_that_is_wrong_in_any_way_is_not_used() {
        let folder = tempfile::tempdir().expect("a folder");
        let scene = generate("balls", Some(1)).expect("there is one");
        let entry = some(&scene);
        let text = serde_json::to_string(&entry).expect("plain data");
        let check = |text: &str| {
            let cache = cache(folder.path().into());
            let path = cache.path(&entry.key).expect("there is a folder");
            std::fs::create_dir_all(path.parent().expect("it has one")).expect("writable");
            std::fs::write(&path, text).expect("writable");
            assert_eq!(cache.find(&entry.key, &scene), None, "{text}");
            assert!(cache.troubled.get(), "{text}");
            // A new one takes its place.
            cache.keep(&entry);
            assert_eq!(cache.find(&entry.key, &scene), Some(entry.clone()));
        };
        check("");
        check(&text[..text.len() / 2]);
        check(&text.replace("3.125", "-3.125"));
        check(&text.replace("5ce4e", "07e5"));
        check(&text.replace("\"grid\"", "\"gird\""));
        check(&text.replace("\"searched\"", "\"sought\""));
        check(&"[".repeat(100_000));
    }

    #[test]
    fn a_folder_that_is_none_is_worked_without() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        std::fs::write(&file, "in the way").expect("writable");
        let cache = cache(file.clone());
        let entry = some(&generate("balls", Some(1)).expect("there is one"));
        cache.keep(&entry);
        assert!(cache.troubled.get());
        assert_eq!(std::fs::read(&file).expect("there"), b"in the way");
    }
}
