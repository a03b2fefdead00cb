//! What the figures were measured on.

use std::fs;
use std::process::Command;

/// Processor, cores, memory, system and compiler; and how busy it was.
pub(crate) fn describe() -> Vec<[String; 2]> {
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    let mut facts = vec![
        ["processor".into(), format!("{}, {cores} of its threads", processor())],
        ["system".into(), said("uname", &["-srm"])],
        ["compiler".into(), said("rustc", &["--version"])],
        ["date".into(), said("date", &["-u", "+%Y-%m-%d"])],
    ];
    if let Some(load) = fs::read_to_string("/proc/loadavg").ok().as_deref().and_then(busy) {
        facts.push(["load when done".into(), load]);
    }
    facts.retain(|[_, fact]| !fact.is_empty());
    facts
}

/// What is being measured.
pub(crate) fn commit() -> String {
    said("git", &["describe", "--always", "--dirty"])
}

fn processor() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = info.lines().find(|line| line.starts_with("model name"));
    let name = line.and_then(|line| line.split(':').nth(1)).unwrap_or(std::env::consts::ARCH);
    let level = if info.contains("avx512vl") { " with AVX-512" } else { "" };
    format!("{}{level}", name.trim())
}

fn busy(load: &str) -> Option<String> {
    let mut words = load.split(' ');
    Some(format!("{} over a minute, {} over five", words.next()?, words.next()?))
}

/// What a program says; nothing if there is none.
fn said(program: &str, args: &[&str]) -> String {
    let output = Command::new(program).args(args).output();
    output.map_or(String::new(), |out| String::from_utf8_lossy(&out.stdout).trim().to_owned())
}
