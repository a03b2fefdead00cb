//! What steps and tests cost on this machine, as `nestray calibrate` found out.

use nestray::plan::prices::Prices;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Cache, read};
use crate::stats;

/// The prices, and what they are of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    /// The version of the program.
    nestray: String,
    /// The vector instructions in use.
    vector_level: String,
    processor: String,
    prices: Prices,
}

impl Cache {
    /// Those of this machine, or the usual ones if nobody calibrated here.
    pub(crate) fn prices(&self) -> Prices {
        let found = self.path_of_prices().and_then(|path| match read(&path) {
            Ok(None) => None,
            Ok(Some(text)) => match entry(&text, &Entry::of(Prices::usual())) {
                Ok(prices) => Some(prices),
                Err(why) => {
                    self.trouble(&format!("{}: {why}", path.display()));
                    None
                }
            },
            Err(error) => {
                self.trouble(&format!("{}: {error}", path.display()));
                None
            }
        });
        found.unwrap_or_else(|| Prices::usual().clone())
    }

    /// Keeps them for the next time.
    pub(crate) fn keep_prices(&self, prices: &Prices) {
        if let Some(path) = self.path_of_prices() {
            let text = serde_json::to_string_pretty(&Entry::of(prices));
            self.write(&path, &text.expect("an entry is plain data"));
        }
    }

    fn path_of_prices(&self) -> Option<std::path::PathBuf> {
        let name = format!("prices-{}.json", stats::level());
        self.folder.as_ref().map(|folder| folder.join(name))
    }
}

impl Entry {
    fn of(prices: &Prices) -> Self {
        Self {
            nestray: env!("CARGO_PKG_VERSION").into(),
            vector_level: stats::level(),
            processor: stats::processor(),
            prices: prices.clone(),
        }
    }
}

/// What a file holds, if it is of this machine and this program.
fn entry(text: &str, here: &Entry) -> Result<Prices, String> {
    let value: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
    let version = value["nestray"].as_str().unwrap_or("?");
    if version != here.nestray {
        return Err(format!("written by version {version}; nestray calibrate writes another"));
    }
    let entry: Entry = serde_json::from_value(value).map_err(|error| error.to_string())?;
    if (&entry.processor, &entry.vector_level) != (&here.processor, &here.vector_level) {
        return Err("it is of another processor; nestray calibrate writes another".into());
    }
    if !entry.prices.are_sound() {
        return Err("it has prices that are none".into());
    }
    Ok(entry.prices)
}

#[cfg(test)]
mod tests {
    use super::super::tests::cache;
    use super::*;

    fn some() -> Prices {
        let mut prices = Prices::usual().clone();
        prices.scattered.ray = 123.25;
        prices
    }

    #[test]
    fn what_was_calibrated_is_used_from_then_on() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path().join("not/there/yet"));
        assert_eq!(cache.prices(), *Prices::usual());
        cache.keep_prices(&some());
        assert_eq!(cache.prices(), some());
        assert!(!cache.troubled.get());
    }

    #[test]
    fn prices_that_are_wrong_in_any_way_are_not_used() {
        let folder = tempfile::tempdir().expect("a folder");
        let text = serde_json::to_string(&Entry::of(&some())).expect("plain data");
        for text in [
            "",
            &text[..text.len() / 2],
            &text.replace("123.25", "-123.25"),
            &text.replace(env!("CARGO_PKG_VERSION"), "0.0.0"),
            &text.replace("\"scattered\"", "\"shattered\""),
            &text.replacen("\"processor\":\"", "\"processor\":\"another ", 1),
            &"[".repeat(100_000),
        ] {
            let cache = cache(folder.path().into());
            let path = cache.path_of_prices().expect("there is a folder");
            std::fs::write(&path, text).expect("writable");
            assert_eq!(cache.prices(), *Prices::usual(), "{text}");
            assert!(cache.troubled.get(), "{text}");
        }
    }
}
