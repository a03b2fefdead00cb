//! Interrupting the program.

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::program::Folder;

fn start(args: &[&str], folder: &Folder) -> Child {
    Command::new(assert_cmd::cargo::cargo_bin("nestray"))
        .args(args)
        .env("XDG_CACHE_HOME", folder.path("cache"))
        .stderr(Stdio::piped())
        .spawn()
        .expect("it runs")
}

fn interrupt(child: &Child) {
    let done = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(done.expect("there is a kill").success());
}

/// Interrupts it when it says that it is at some stage; the code it ends with.
fn stopped_in(mut child: Child, stage: &str) -> Option<i32> {
    // Its first line says that it is.
    let mut errors = std::io::BufReader::new(child.stderr.take().expect("piped"));
    let mut line = String::new();
    std::io::BufRead::read_line(&mut errors, &mut line).expect("it says something");
    assert!(line.contains(&format!("\"stage\":\"{stage}\"")), "{line}");
    interrupt(&child);
    let begun = Instant::now();
    let code = child.wait().expect("it ends").code();
    assert!(begun.elapsed() < Duration::from_secs(60));
    code
}

#[test]
fn an_interrupted_render_writes_what_is_done() {
    let folder = Folder::new();
    let (out, stats) = (folder.path("a.png"), folder.path("s.json"));
    let mut args = vec!["render", "builtin:balls@3", "-o", &out, "--stats", &stats];
    args.extend(["--spp", "100000", "--resolution", "320x240", "--progress", "json"]);
    args.extend(["--plan", "bvh"]);
    assert_eq!(stopped_in(start(&args, &folder), "render"), Some(130));
    let picture = std::fs::read(out).expect("it was written");
    assert!(picture.starts_with(b"\x89PNG"));
    let stats = std::fs::read_to_string(stats).expect("it was written");
    assert!(stats.contains("\"complete\": false"), "{stats}");
}

#[test]
fn an_interrupted_search_writes_nothing() {
    let folder = Folder::new();
    let out = folder.path("a.png");
    let mut args = vec!["render", "builtin:balls@3", "-o", &out, "--search", "1000m"];
    args.extend(["--progress", "json"]);
    assert_eq!(stopped_in(start(&args, &folder), "plan auto"), Some(130));
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}
