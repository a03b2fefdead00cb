//! Interrupting the program.

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::program::Folder;

fn start(args: &[&str]) -> Child {
    Command::new(assert_cmd::cargo::cargo_bin("nestray"))
        .args(args)
        .stderr(Stdio::piped())
        .spawn()
        .expect("it runs")
}

fn interrupt(child: &Child) {
    let done = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(done.expect("there is a kill").success());
}

#[test]
fn an_interrupted_render_writes_what_is_done() {
    let folder = Folder::new();
    let (out, stats) = (folder.path("a.png"), folder.path("s.json"));
    let mut args = vec!["render", "builtin:balls@3", "-o", &out, "--stats", &stats];
    args.extend(["--spp", "100000", "--resolution", "320x240", "--progress", "json"]);
    let mut child = start(&args);
    // Its first line says that it is rendering.
    let mut errors = std::io::BufReader::new(child.stderr.take().expect("piped"));
    let mut line = String::new();
    std::io::BufRead::read_line(&mut errors, &mut line).expect("it says something");
    assert!(line.contains("\"stage\":\"render\""), "{line}");
    interrupt(&child);
    let begun = Instant::now();
    let code = child.wait().expect("it ends").code();
    assert_eq!(code, Some(130));
    assert!(begun.elapsed() < Duration::from_secs(60));
    let picture = std::fs::read(out).expect("it was written");
    assert!(picture.starts_with(b"\x89PNG"));
    let stats = std::fs::read_to_string(stats).expect("it was written");
    assert!(stats.contains("\"complete\": false"), "{stats}");
}
