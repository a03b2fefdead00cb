//! Pictures are the same through every technique, byte for byte.

use nestray_scene::procedural::{Entry, SCENES};
use nestray_tests::pictures::Subject;
use nestray_tests::scene_files::{files, name, scene};

/// Rays from the eye for each picture; `NESTRAY_RAYS` asks for another number.
fn rays() -> usize {
    std::env::var("NESTRAY_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(3_000)
}

/// Primitives that lists may test with the rays from the eye of one picture.
fn tests() -> usize {
    rays() * 1_500
}

#[test]
fn standard_scenes_look_the_same_through_every_technique() {
    /// Stored primitives.
    const MOST: u64 = 3_000;
    for entry in SCENES {
        let size = largest(entry, MOST);
        let subject = Subject::new(format!("{} {size}", entry.name), &(entry.build)(size));
        eprintln!("{}", subject.assert_same_by_all(rays(), tests()));
    }
}

/// The largest size factor at which a scene stores no more than `most` primitives, or the
/// smallest there is.
fn largest(entry: &Entry, most: u64) -> u32 {
    let (mut low, mut high) = (*entry.sizes.start(), *entry.sizes.end());
    while low < high {
        let middle = low + (high - low).div_ceil(2);
        if (entry.primitives)(middle) <= most {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    low
}

#[test]
fn files_of_the_standard_format_look_the_same_through_every_technique() {
    // Unless more than usual is asked for, the small ones.
    let most = if rays() > 10_000 { u64::MAX } else { 400_000 };
    for path in files("nff", &["nff"], most) {
        let subject = Subject::new(name(&path), &scene(&path));
        eprintln!("{}", subject.assert_same_by_all(rays(), tests()));
    }
}
