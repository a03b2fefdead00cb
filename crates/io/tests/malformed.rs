//! Files that are cut, changed or lie: an error or a scene, never a panic, a hang or much
//! memory.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use nestray_io::load::{LoadOptions, Source, load, read};

/// A small file of each format.
fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let obj = "mtllib gone.mtl\no a\nv 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0\nv .2 .5 0\nvt 0 0\n\
        vt 1 1\nvn 0 0 1\ng b\nusemtl c\nf 1/1/1 2/2/1 \\\n 3/1/1 4/2/1 5/1/1\nf -1 -2 -3\ns 1\nl 1 2\n";
    let ply = "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\n\
        property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n\
        property uchar blue\nelement face 2\nproperty list uchar int vertex_indices\n\
        element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0 255 0 0\n\
        1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 9 9 9\n4 0 1 2 3\n3 0 1 2\n5 0 1 2 -1 3\n";
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n\
        vertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    let off = "STCNOFF\n4 2 0\n0 0 0 0 0 1 255 0 0 0 0\n1 0 0 0 0 1 255 0 0 1 0\n\
        1 1 0 0 0 1 255 0 0 1 1\n0 1 0 0 0 1 255 0 0 0 1\n4 0 1 2 3\n3 0 1 2 1 0 0\n";
    let nff = "b 0 0 1\nv\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 30\nhither 1\nresolution 64 32\n\
        l 1 0 0\nl 0 1 0 1 1 1\nf 1 .5 0 .8 .2 10 0 1\ns 0 0 0 1\ns 0 0 0 -2\n\
        c 0 0 0 1 0 0 1 .5\np 4\n0 0 0\n1 0 0\n1 1 0\n.8 .2 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n\
        0 1 0 0 1 0\n";
    let mut samples: Vec<(&str, Vec<u8>)> = vec![
        ("a.obj", obj.into()),
        ("a.ply", ply.into()),
        ("a.stl", stl.into()),
        ("a.off", off.into()),
        ("a.nff", nff.into()),
    ];
    let mut binary = b"ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\n\
        property float y\nproperty float z\nelement face 2\n\
        property list uchar int vertex_indices\nend_header\n"
        .to_vec();
    let corners =
        [[0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.5, 0.0]];
    binary.extend(corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    for face in [&[0u32, 1, 2, 3, 4][..], &[2, 1, 0]] {
        binary.push(face.len() as u8);
        binary.extend(face.iter().flat_map(|i| i.to_le_bytes()));
    }
    samples.push(("b.ply", binary));
    let mut binary = vec![b' '; 80];
    binary.extend(2u32.to_le_bytes());
    for face in [[0, 1, 2], [2, 3, 0]] {
        binary.extend([0; 12]);
        binary.extend(face.iter().flat_map(|&i| corners[i].map(f32::to_le_bytes)).flatten());
        binary.extend([0; 2]);
    }
    samples.push(("b.stl", binary));
    samples
}

/// Reads it; errors and warnings must be one line each.
fn survives(name: &str, bytes: &[u8]) -> Result<u64, String> {
    let start = Instant::now();
    let result = catch_unwind(AssertUnwindSafe(|| read(bytes, &Source::new(name))));
    let took = start.elapsed();
    assert!(took < Duration::from_secs(10), "{name} took {took:?}");
    let outcome = result.map_err(|_| format!("{name} panicked"))?;
    match outcome {
        Ok(loaded) => {
            for warning in &loaded.warnings {
                assert!(!warning.to_string().contains('\n'), "{warning}");
            }
            assert!(loaded.warnings.len() < 500);
            Ok(loaded.scene.primitives())
        }
        Err(error) => {
            let error = error.to_string();
            assert!(error.starts_with(name) && !error.contains('\n'), "{error}");
            Ok(0)
        }
    }
}

#[test]
fn the_samples_are_sound() {
    for (name, bytes) in samples() {
        assert!(survives(name, &bytes).expect("no panic") > 0, "{name}");
    }
}

#[test]
fn files_cut_anywhere_do_no_harm() {
    for (name, bytes) in samples() {
        for end in 0..bytes.len() {
            survives(name, &bytes[..end]).unwrap_or_else(|error| panic!("{error}, cut at {end}"));
            // Without an extension to go by, too.
            let bare = name.split('.').next().unwrap_or(name);
            survives(bare, &bytes[..end]).unwrap_or_else(|error| panic!("{error}, cut at {end}"));
        }
    }
}

/// The next of a row of numbers that look random.
fn next(seed: &mut u64) -> u64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    *seed >> 33
}

#[test]
fn changed_files_do_no_harm() {
    /// For each sample.
    const MUTANTS: u64 = 10_000;
    let words = [
        "-1",
        "0",
        "4294967295",
        "4000000000",
        "nan",
        "inf",
        "-inf",
        "1e39",
        "99999999999999999999",
        "/",
        "\\",
        "\n",
        "#",
        "-0",
    ];
    for (name, bytes) in samples() {
        for mutant in 0..MUTANTS {
            let mut seed = mutant;
            let mut changed = bytes.clone();
            for _ in 0..=next(&mut seed) % 4 {
                let at = next(&mut seed) as usize % changed.len();
                match next(&mut seed) % 5 {
                    0 => changed[at] ^= 1 << (next(&mut seed) % 8),
                    1 => changed[at] = next(&mut seed) as u8,
                    2 => {
                        let other = next(&mut seed) as usize % changed.len();
                        let part = changed[at.min(other)..at.max(other)].to_vec();
                        changed.splice(at..at, part);
                    }
                    3 => {
                        // In place of a word.
                        let end = changed[at..].iter().position(u8::is_ascii_whitespace);
                        let word = words[next(&mut seed) as usize % words.len()];
                        changed.splice(at..at + end.unwrap_or(0), word.bytes());
                    }
                    _ => {
                        changed.truncate(at.max(1));
                    }
                }
            }
            survives(name, &changed).unwrap_or_else(|error| panic!("{error}, seed {mutant}"));
        }
    }
}

#[test]
fn garbage_is_no_scene() {
    let mut seed = 7;
    for round in 0..2000 {
        let length = next(&mut seed) as usize % 400;
        let bytes: Vec<u8> = (0..length).map(|_| next(&mut seed) as u8).collect();
        for name in ["a.obj", "a.ply", "a.stl", "a.off", "a.nff", "a"] {
            survives(name, &bytes).unwrap_or_else(|error| panic!("{error}, round {round}"));
        }
    }
}

#[test]
fn names_without_extension_are_told_by_content() {
    for (name, bytes) in samples() {
        let bare = name.split('.').next().unwrap_or(name);
        let by_content = survives(bare, &bytes).expect("no panic");
        assert_eq!(by_content, survives(name, &bytes).expect("no panic"), "{name}");
    }
    let error = read(b"hello world", &Source::new("a.xyz")).expect_err("no scene").to_string();
    assert!(error.starts_with("a.xyz: is of no known format (hint: known are "), "{error}");
    assert!(
        read(b"", &Source::new("a")).expect_err("no scene").to_string().starts_with("a: is empty")
    );
}

#[test]
fn what_unpacks_to_too_much_is_refused() {
    use std::io::Write;
    let packed = |bytes: &[u8]| {
        let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
        out.write_all(bytes).expect("memory");
        out.finish().expect("memory")
    };
    let (_, ply) = samples().remove(1);
    let good = packed(&ply);
    assert!(survives("a.ply.gz", &good).expect("no panic") > 0);
    for end in 2..good.len() {
        survives("a.ply.gz", &good[..end]).expect("no panic");
    }
    let bomb = packed(&vec![b' '; 100 << 20]);
    let error = read(&bomb, &Source::new("a.ply.gz")).expect_err("too much").to_string();
    assert_eq!(error, "a.ply.gz: unpacks to more than 67108864 bytes");
    let options = LoadOptions { max_bytes: 100, ..LoadOptions::default() };
    let source = Source { options, ..Source::new("a.ply.gz") };
    let error = read(&good, &source).expect_err("too much").to_string();
    assert_eq!(error, "a.ply.gz: unpacks to more than 100 bytes");
}

#[test]
fn files_that_are_none_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let error = |path: &std::path::Path, options: &LoadOptions| {
        load(path, options).expect_err("no scene").to_string()
    };
    let usual = LoadOptions::default();
    let gone = folder.path().join("gone.obj");
    assert!(error(&gone, &usual).starts_with(&format!("{}: ", gone.display())));
    assert!(error(folder.path(), &usual).starts_with(&format!("{}: ", folder.path().display())));
    let large = folder.path().join("large.obj");
    std::fs::write(&large, [b' '; 1000]).expect("it can be written");
    let small = LoadOptions { max_bytes: 999, ..usual };
    assert_eq!(error(&large, &small), format!("{}: has more than 999 bytes", large.display()));
}
