//! How far it has come, on the error stream.

use std::io::{IsTerminal as _, Write as _};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use nestray::render::watch::Watch;
use serde_json::json;

use crate::args::{ProgressMode, Talk};
use crate::stop;

/// What is said while it runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress {
    mode: Mode,
    quiet: bool,
    verbose: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Bar,
    Plain,
    Json,
    None,
}

impl Progress {
    pub(crate) fn new(talk: &Talk) -> Self {
        let mode = match talk.progress {
            _ if talk.quiet => Mode::None,
            ProgressMode::None => Mode::None,
            ProgressMode::Json => Mode::Json,
            ProgressMode::Auto if std::io::stderr().is_terminal() => Mode::Bar,
            ProgressMode::Auto | ProgressMode::Plain => Mode::Plain,
        };
        Self { mode, quiet: talk.quiet, verbose: talk.verbose }
    }

    /// Something worth knowing.
    pub(crate) fn note(self, text: &str) {
        if self.quiet {
            return;
        }
        if self.mode == Mode::Json {
            say(&json!({ "note": text }).to_string());
        } else {
            say(&format!("nestray: {text}"));
        }
    }

    /// Something for who wants to know more.
    pub(crate) fn detail(self, text: &str) {
        if self.verbose {
            self.note(text);
        }
    }

    /// Watches one stage of the work.
    pub(crate) fn watch(self, stage: &str) -> Watching {
        let bar = (self.mode == Mode::Bar).then(|| {
            let style =
                ProgressStyle::with_template("{prefix} [{bar:40}] {percent:>3} %  {msg}{eta} left");
            let bar = ProgressBar::new(0).with_prefix(stage.to_owned());
            bar.set_style(
                style.expect("it is written as indicatif wants it").progress_chars("=> "),
            );
            bar
        });
        let begun = Instant::now();
        Watching { stage: stage.into(), mode: self.mode, bar, begun, said: Mutex::new(begun) }
    }
}

/// A line on the error stream, which may be closed.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// One stage, watched. The bar goes away with it.
#[derive(Debug)]
pub(crate) struct Watching {
    stage: String,
    mode: Mode,
    bar: Option<ProgressBar>,
    begun: Instant,
    /// When something was last said.
    said: Mutex<Instant>,
}

impl Watch for Watching {
    fn advanced(&self, done: u64, total: u64, rays: u64) {
        let pause = match self.mode {
            Mode::None => return,
            Mode::Bar => Duration::from_millis(100),
            Mode::Json => Duration::from_millis(500),
            Mode::Plain => Duration::from_secs(2),
        };
        // Whoever comes while another speaks has nothing to add.
        let Ok(mut said) = self.said.try_lock() else { return };
        let finished = done == total && self.mode == Mode::Json;
        if said.elapsed() < pause && !finished {
            return;
        }
        *said = Instant::now();
        let seconds = self.begun.elapsed().as_secs_f64();
        let rate = if rays > 0 { format!("{}, ", rate(rays, seconds)) } else { String::new() };
        match (self.mode, &self.bar) {
            (Mode::Bar, Some(bar)) => {
                bar.set_length(total);
                bar.set_position(done);
                bar.set_message(rate);
            }
            (Mode::Json, _) => {
                let line = json!({ "stage": self.stage, "done": done, "total": total,
                    "rays": rays, "seconds": seconds });
                say(&line.to_string());
            }
            _ => {
                let part = done as f64 / total.max(1) as f64;
                let left = seconds / part.max(1e-9) * (1.0 - part);
                let percent = 100.0 * part;
                say(&format!("nestray: {} {percent:.0} %, {rate}{left:.0} s left", self.stage));
            }
        }
    }

    fn stop(&self) -> bool {
        stop::asked()
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Rays a second, for people.
pub(crate) fn rate(rays: u64, seconds: f64) -> String {
    let rate = rays as f64 / seconds.max(1e-9);
    if rate >= 1e6 {
        format!("{:.1} Mrays/s", rate / 1e6)
    } else {
        format!("{:.1} krays/s", rate / 1e3)
    }
}
