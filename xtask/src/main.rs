//! Chores of this repository: `cargo xtask test` before every change is handed in.
#![expect(clippy::print_stdout, reason = "a program for people at a terminal")]

mod bench;
mod peers;

use std::path::Path;
use std::process::{Command, ExitCode};

/// A chore: its name, what it does, and the commands it runs, each with its environment; or what
/// is done instead.
struct Chore {
    name: &'static str,
    about: &'static str,
    steps: &'static [Step],
    own: Option<Work>,
}

/// A chore that is no command: takes what follows its name.
type Work = fn(&[String]) -> Result<(), String>;

struct Step {
    env: &'static [(&'static str, &'static str)],
    args: &'static [&'static str],
    /// Whether it takes the nightly toolchain; left out where there is none.
    nightly: bool,
}

const fn cargo(args: &'static [&'static str]) -> Step {
    Step { env: &[], args, nightly: false }
}

/// What makes the standard library anew.
const MAKE_STD: &str = "-Zbuild-std";

/// Tests that `AddressSanitizer` watches.
macro_rules! guarded {
    ($($arg:literal),+) => {
        Step {
            env: &[
                ("RUSTFLAGS", "-Zsanitizer=address -Cunsafe-allow-abi-mismatch=sanitizer"),
                ("CARGO_TARGET_DIR", "target/address-sanitizer"),
            ],
            args: &["test", "--release", "--target", "host-tuple", $($arg),+],
            nightly: true,
        }
    };
}

/// Tests that `ThreadSanitizer` watches. The standard library is made anew: as it comes it has no marks,
/// and whatever it does to make threads wait for each other would not be seen.
macro_rules! watched {
    ($($arg:literal),+) => {
        Step {
            env: &[
                ("RUSTFLAGS", "-Zsanitizer=thread -Cunsafe-allow-abi-mismatch=sanitizer"),
                ("CARGO_TARGET_DIR", "target/thread-sanitizer"),
                ("NESTRAY_BUILDS", "5"),
            ],
            args: &["test", MAKE_STD, "--release", "--target", "host-tuple", $($arg),+],
            nightly: true,
        }
    };
}

/// A test across crates, with more of everything than usual, that says what it did.
macro_rules! long {
    ($test:literal, $name:literal = $value:literal) => {
        Step {
            env: &[($name, $value)],
            args: &[
                "test",
                "--release",
                "-p",
                "nestray-tests",
                "--test",
                $test,
                "--",
                "--nocapture",
            ],
            nightly: false,
        }
    };
}

/// Builds of tests are optimised: they compare millions of rays.
const CHORES: &[Chore] = &[
    Chore {
        name: "test",
        about: "formatting, lints, documentation, all tests: what continuous integration runs",
        steps: &[
            cargo(&["fmt", "--all", "--check"]),
            cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]),
            Step {
                env: &[("RUSTDOCFLAGS", "-D warnings")],
                args: &["doc", "--workspace", "--no-deps"],
                nightly: false,
            },
            cargo(&["test", "--workspace", "--release"]),
        ],
        own: None,
    },
    Chore {
        name: "conformance",
        about: "ten million rays through every technique: random nests, closed meshes, pictures, threads",
        steps: &[
            long!("nests", "NESTRAY_RAYS" = "10000000"),
            long!("conformance", "NESTRAY_RAYS" = "200000"),
            long!("watertight", "NESTRAY_RAYS" = "10000000"),
            long!("pictures", "NESTRAY_RAYS" = "100000"),
            long!("determinism", "NESTRAY_PICTURES" = "1000"),
            long!("lazy", "NESTRAY_BUILDS" = "2000"),
            long!("expected", "NESTRAY_LINES" = "200000"),
            long!("theorems", "NESTRAY_LINES" = "10000000"),
            long!("optimum", "NESTRAY_SEEDS" = "20"),
            long!("published", "NESTRAY_RAYS" = "40000"),
            Step {
                env: &[("RUSTFLAGS", "--cfg loom"), ("CARGO_TARGET_DIR", "target/loom")],
                args: &["test", "--release", "-p", "nestray-core", "--lib", "slot"],
                nightly: false,
            },
            // Where the unsafe code of the library is.
            guarded!(
                "-p",
                "nestray-core",
                "-p",
                "nestray-shapes",
                "-p",
                "nestray-techniques",
                "--lib"
            ),
            // Where threads share what is made while rays fly, and where they build and draw together.
            watched!("-p", "nestray-core", "-p", "nestray-techniques", "--lib"),
            watched!("-p", "nestray-plan", "-p", "nestray-render", "--lib"),
            watched!("-p", "nestray-tests", "--test", "lazy"),
        ],
        own: None,
    },
    Chore {
        name: "contact-sheet",
        about: "pictures of all shared scenes: SCENES docs/pictures [NAME...]",
        steps: &[cargo(&["run", "--release", "-p", "nestray-sheet", "--"])],
        own: None,
    },
    Chore {
        name: "bench",
        about: "other libraries over ten scenes: writes docs/performance.md",
        steps: &[],
        own: Some(bench::bench),
    },
    Chore {
        name: "peers",
        about: "installs the libraries that nestray bench --vs compares with",
        steps: &[],
        own: Some(peers::install),
    },
];

impl Step {
    fn command(&self) -> Command {
        if !self.nightly {
            return Command::new(env!("CARGO"));
        }
        let mut command = Command::new("rustup");
        command.args(["run", "nightly", "cargo"]);
        command
    }
}

fn has_nightly() -> bool {
    let mut asked = Command::new("rustup");
    asked
        .args(["run", "nightly", "cargo", "--version"])
        .output()
        .is_ok_and(|out| out.status.success())
}

/// Whether the source of the standard library is there.
fn has_source() -> bool {
    let mut asked = Command::new("rustup");
    asked.args(["run", "nightly", "rustc", "--print", "sysroot"]).output().is_ok_and(|out| {
        let root = String::from_utf8_lossy(&out.stdout);
        Path::new(root.trim()).join("lib/rustlib/src/rust/library").is_dir()
    })
}

fn main() -> ExitCode {
    let mut args = std::env::args().skip(1);
    let name = args.next().unwrap_or_default();
    // What follows the name of a chore is for its commands.
    let rest: Vec<String> = args.collect();
    let Some(chore) = CHORES.iter().find(|chore| chore.name == name) else {
        println!("cargo xtask CHORE, one of:");
        for chore in CHORES {
            println!("  {:12} {}", chore.name, chore.about);
        }
        return ExitCode::from(2);
    };
    if let Some(own) = chore.own {
        return match own(&rest) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                println!("{name}: {error}");
                ExitCode::FAILURE
            }
        };
    }
    for step in chore.steps {
        println!("\n> cargo {}", step.args.join(" "));
        if step.nightly && !has_nightly() {
            println!("skipped: there is no nightly toolchain (rustup toolchain install nightly)");
            continue;
        }
        if step.args.contains(&MAKE_STD) && !has_source() {
            println!("skipped: rustup component add rust-src --toolchain nightly");
            continue;
        }
        let mut command = step.command();
        match command.args(step.args).args(&rest).envs(step.env.iter().copied()).status() {
            Ok(status) if status.success() => {}
            Ok(status) => {
                println!("cargo {}: {status}", step.args.join(" "));
                return ExitCode::FAILURE;
            }
            Err(error) => {
                println!("cargo cannot be started: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}
