//! What happens to bad input: the right exit code, one line that says what is wrong and where,
//! and no file touched.

use std::fs;

use crate::program::{Folder, Ran, nestray, rays};

/// A small picture of a scene, over an old file that must stay if it fails.
struct Try {
    folder: Folder,
    out: String,
}

const OLD: &[u8] = b"an old picture";

impl Try {
    fn new() -> Self {
        let folder = Folder::new();
        let out = folder.write_bytes("out.png", OLD);
        Self { folder, out }
    }

    /// Renders with these options.
    fn render(&self, scene: &str, more: &[&str]) -> Ran {
        let mut args = vec!["render", scene, "-o", &self.out];
        args.extend(more);
        if !more.contains(&"--resolution") {
            args.extend(["--resolution", "24x16"]);
        }
        if !more.contains(&"--spp") {
            args.extend(["--spp", "1"]);
        }
        nestray(&args)
    }

    /// Renders a file of this name and content.
    fn file(&self, name: &str, bytes: &[u8]) -> Ran {
        let scene = self.folder.write_bytes(name, bytes);
        self.render(&scene, &[])
    }

    /// It fails as [`Ran::fails`] says, and leaves the old picture alone.
    fn refuses(&self, ran: Ran, code: i32, words: &[&str]) {
        ran.fails(code, words);
        assert_eq!(fs::read(&self.out).expect("there"), OLD, "the old file stays");
        assert!(!self.folder.names().iter().any(|name| name.contains("part")));
    }

    /// It goes on, and a new picture is there.
    fn goes_on(&self, ran: Ran) -> Ran {
        let ran = ran.succeeds();
        assert!(fs::read(&self.out).expect("there").starts_with(b"\x89PNG"));
        ran
    }
}

/// A native scene with these vertices and faces.
fn mesh(positions: &str, faces: &str) -> String {
    format!(
        r#"{{ "nestray_scene": 1, "geometries": [ {{ "mesh":
             {{ "positions": [{positions}], "faces": [{faces}] }} }} ] }}"#
    )
}

#[test]
fn coordinates_that_are_none_or_huge_are_passed_over() {
    let obj = |numbers: &str| {
        let text = format!("v {numbers} 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 2 3 4\n");
        let attempt = Try::new();
        attempt.goes_on(attempt.file("a.obj", text.as_bytes()));
    };
    for numbers in ["nan 0", "inf 0", "-inf 0", "1e30 0", "1e38 -1e38"] {
        obj(numbers);
    }
    let attempt = Try::new();
    let ran = attempt.file("a.json", mesh("[1e999, 0, 0]", "").as_bytes());
    attempt.refuses(ran, 3, &["a.json:", "out of range"]);
}

#[test]
fn flat_and_repeated_triangles_do_no_harm() {
    let attempt = Try::new();
    let positions = "[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]";
    let faces = "[0, 0, 0], [0, 1, 2], [0, 1, 3], [0, 1, 3], [0, 1, 3], [3, 1, 0]";
    let scene = attempt.folder.write("a.json", &mesh(positions, faces));
    for plan in ["auto", "list", "grid"] {
        attempt.goes_on(attempt.render(&scene, &["--plan", plan]));
    }
}

#[test]
fn an_empty_scene_is_a_picture_of_nothing() {
    let attempt = Try::new();
    attempt.goes_on(attempt.file("a.json", b"{ \"nestray_scene\": 1 }"));
}

#[test]
fn indices_out_of_range_are_named() {
    let attempt = Try::new();
    let ran = attempt.file("a.json", mesh("[0, 0, 0]", "[0, 0, 7]").as_bytes());
    attempt.refuses(ran, 3, &["a.json", "vertex 7"]);
    let ran =
        attempt.file("b.json", br#"{ "nestray_scene": 1, "groups": [ { "geometries": [4] } ] }"#);
    attempt.refuses(ran, 3, &["b.json", "groups[0].geometries[0]", "no geometry 4"]);
    let ran = attempt.file("c.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n");
    attempt.refuses(ran, 3, &["c.off:6:"]);
}

#[test]
fn files_that_end_early_or_lie_are_refused_where_they_do() {
    let attempt = Try::new();
    attempt.refuses(attempt.file("a.json", b"{ \"nestray_scene\": 1,\n \"geo"), 3, &["a.json:2:"]);
    attempt.refuses(attempt.file("b.off", b"OFF\n900000000 1 0\n0 0 0\n"), 3, &["b.off"]);
    let mut stl = vec![b' '; 80];
    stl.extend(4_000_000_000u32.to_le_bytes());
    attempt.refuses(attempt.file("c.stl", &stl), 3, &["c.stl"]);
    let ply =
        b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n\
        property float y\nproperty float z\nend_header\n\0\0\0\0";
    attempt.refuses(attempt.file("d.ply", ply), 3, &["d.ply"]);
    attempt.refuses(attempt.file("e.glb", b"glTF\x02\0\0\0\xff\xff\xff\xff"), 3, &["e.glb"]);
    attempt.refuses(attempt.file("f.json", b""), 3, &["f.json"]);
    attempt.refuses(attempt.file("g.xyz", b"what"), 3, &["g.xyz", "no known format"]);
    attempt.refuses(attempt.render("nowhere.obj", &[]), 3, &["nowhere.obj"]);
    let folder = attempt.folder.path(".");
    attempt.refuses(attempt.render(&folder, &[]), 3, &[]);
}

#[test]
fn missing_textures_and_files_are_warned_of_by_name() {
    let attempt = Try::new();
    attempt.folder.write("a.mtl", "newmtl m\nKd 1 0 0\nmap_Kd wood.png\n");
    let obj = "mtllib a.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    let ran = attempt.goes_on(attempt.file("a.obj", obj.as_bytes()));
    assert!(ran.errors.contains("wood.png") && ran.errors.contains("gone.mtl"), "{}", ran.errors);
}

#[test]
fn instances_in_circles_or_too_deep_are_refused() {
    let attempt = Try::new();
    let circle = r#"{ "nestray_scene": 1, "groups": [ { "places": [ { "group": 1 } ] },
        { "places": [ { "group": 0 } ] } ] }"#;
    attempt.refuses(attempt.file("a.json", circle.as_bytes()), 3, &["stands in itself"]);
    let tower = |levels: usize, twice: bool| {
        let place = |i: usize| format!(r#"{{ "group": {} }}"#, i + 1);
        let group = |i: usize| match twice {
            true => format!(r#"{{ "places": [ {}, {} ] }}"#, place(i), place(i)),
            false => format!(r#"{{ "places": [ {} ] }}"#, place(i)),
        };
        let groups: Vec<String> = (0..levels).map(group).collect();
        format!(
            r#"{{ "nestray_scene": 1, "groups": [ {}, {{ "geometries": [0] }} ],
                "geometries": [ {{ "shapes":
                    [ {{ "sphere": {{ "center": [0, 0, 0], "radius": 1 }} }} ] }} ] }}"#,
            groups.join(", ")
        )
    };
    let ran = attempt.file("b.json", tower(65, false).as_bytes());
    attempt.refuses(ran, 3, &["more than 64 deep"]);
    attempt.refuses(attempt.file("c.json", tower(5000, false).as_bytes()), 3, &["64 deep"]);
    attempt.refuses(attempt.file("d.json", tower(40, true).as_bytes()), 3, &["4294967295"]);
    attempt.goes_on(attempt.file("e.json", tower(64, false).as_bytes()));
}

#[test]
fn flattened_instances_are_not_seen() {
    let attempt = Try::new();
    let scene = r#"{ "nestray_scene": 1, "groups": [
        { "places": [ { "group": 1, "motion": { "still": { "scale": [1, 0, 1] } } } ] },
        { "geometries": [0] } ], "geometries": [ { "shapes":
            [ { "sphere": { "center": [0, 0, 0], "radius": 1 } } ] } ] }"#;
    attempt.goes_on(attempt.file("a.json", scene.as_bytes()));
}

#[test]
fn pictures_of_no_or_too_many_pixels_are_refused() {
    let attempt = Try::new();
    let size = |size: &str| attempt.render("builtin:tetra@1", &["--resolution", size]);
    attempt.refuses(size("0x10"), 2, &["0 x 10"]);
    attempt.refuses(size("60000x60000"), 2, &["60000 x 60000"]);
    attempt.refuses(size("4294967295x1"), 2, &["4294967295"]);
    attempt.refuses(size("99999999999x1"), 2, &["--resolution"]);
    attempt.refuses(size("tall"), 2, &["--resolution"]);
    let option = |name: &str, value: &str| attempt.render("builtin:tetra@1", &[name, value]);
    attempt.refuses(option("--spp", "0"), 2, &["samples"]);
    attempt.refuses(option("--max-depth", "0"), 2, &["max_depth"]);
    attempt.refuses(option("--crop", "5,5,0,9"), 2, &["crop"]);
    attempt.refuses(option("--camera", "7"), 2, &["camera"]);
    attempt.refuses(option("--camera", "front"), 2, &["front"]);
    attempt.refuses(option("--frames", "5-1"), 2, &["--frames"]);
    attempt.refuses(option("--fps", "nan"), 2, &["--fps"]);
    attempt.refuses(option("--threads", "-3"), 2, &["-3"]);
}

#[test]
fn places_that_cannot_be_written_are_told_before_the_work() {
    let folder = Folder::new();
    let render = |out: &str| nestray(&["render", "builtin:scatter", "-o", out]);
    render(&folder.path("none/a.png")).fails(1, &["none", "cannot be written"]);
    render(&folder.path(".")).fails(2, &["unknown kind of file"]);
    fs::create_dir(folder.path("d.png")).expect("writable");
    render(&folder.path("d.png")).fails(1, &["d.png", "folder"]);
    render(&folder.path("a.gif")).fails(2, &["a.gif", ".png"]);
    let stats = folder.path("none/s.json");
    let out = folder.path("a.png");
    nestray(&["render", "builtin:scatter", "-o", &out, "--stats", &stats]).fails(1, &["s.json"]);
    nestray(&["generate", "balls", "-o", &folder.path("a.stl")]).fails(2, &["a.stl", ".json"]);
    assert_eq!(folder.names(), ["d.png"]);
}

#[test]
fn unknown_scenes_techniques_and_verbs_come_with_a_hint() {
    let attempt = Try::new();
    attempt.refuses(attempt.render("builtin:bals", &[]), 2, &["bals", "balls"]);
    attempt.refuses(attempt.render("builtin:balls@99", &[]), 2, &["99", "from 0 to 6"]);
    let ran = attempt.render("builtin:tetra@1", &["--plan", "gird"]);
    attempt.refuses(ran, 2, &["gird", "did you mean \"grid\"?"]);
    let ran = attempt.render("builtin:tetra@1", &["--plan", "lazy-bhv"]);
    attempt.refuses(ran, 2, &["preset", "did you mean \"lazy-bvh\"?"]);
    let ran = attempt.render("builtin:tetra@1", &["--plan", "xyzzy"]);
    attempt.refuses(ran, 2, &["--list techniques", "--list presets"]);
    nestray(&["rendre", "a.obj"]).fails(2, &["rendre", "render"]);
    nestray(&["render"]).fails(2, &["<SCENE>", "--help"]);
    nestray(&["generate", "bals", "-o", "a.json"]).fails(2, &["bals", "balls"]);
}

#[test]
fn plans_are_refused_by_place_and_with_the_nearest_name() {
    let attempt = Try::new();
    let with = |text: &str, words: &[&str]| {
        let plan = attempt.folder.write("plan.json", text);
        let ran = attempt.render("builtin:mount@1", &["--plan", &plan]);
        attempt.refuses(ran, 3, words);
    };
    with("{ \"version\": 1,\n  \"roof\": 3 }", &["plan.json:2:", "roof"]);
    with(
        r#"{ "version": 1, "root": { "nest": { "technique": "gird", "children": [] } } }"#,
        &["plan.json: root/nest/technique", "gird", "did you mean \"grid\"?"],
    );
    with(
        r#"{ "version": 1, "root": { "nest": { "technique": "grid",
             "params": { "densty": 1 }, "children": [ { "pick": "*" } ] } } }"#,
        &["root/nest/params/densty", "did you mean \"density\"?"],
    );
    with(
        r#"{ "version": 1, "root": { "nest": { "technique": "grid",
             "params": { "density": -1 }, "children": [ { "pick": "*" } ] } } }"#,
        &["root/nest/params/density", "must be"],
    );
    with(
        r#"{ "version": 1, "root": { "nest": { "technique": "bvh",
             "children": [ { "pick": 0 }, { "pick": "*" } ] } } }"#,
        &["root/nest/children/1/pick", "held twice"],
    );
    with(r#"{ "version": 1, "root": { "pick": 0 } }"#, &["root", "is not held by anything"]);
    with(&"[".repeat(100_000), &["plan.json:1:", "192 levels"]);
    let ran = attempt.render("builtin:mount@1", &["--plan", "gone/plan.json"]);
    attempt.refuses(ran, 3, &["plan.json"]);
    let plan = attempt.folder.write_bytes("plan.json", b"\xff\xfe");
    attempt.refuses(attempt.render("builtin:mount@1", &["--plan", &plan]), 3, &["UTF-8"]);
}

#[test]
fn rays_that_are_none_miss_and_files_that_are_none_are_refused() {
    let folder = Folder::new();
    let out = folder.write_bytes("hits.npy", OLD);
    let query = |bytes: &[u8]| {
        let rays = folder.write_bytes("rays.npy", bytes);
        nestray(&["query", "builtin:tetra@2", "--rays", &rays, "-o", &out])
    };
    query(b"").fails(3, &["rays.npy", "is no .npy file"]);
    query(b"\x93NUMPY\x01\x00\xff\xff{").fails(3, &["rays.npy", "header"]);
    let mut cut = rays(&[[1.0; 6]; 4]);
    cut.truncate(cut.len() - 5);
    query(&cut).fails(3, &["rays.npy", "claims 4 rays"]);
    nestray(&["query", "builtin:tetra@2", "--rays", "gone.npy", "-o", &out])
        .fails(3, &["gone.npy"]);
    assert_eq!(fs::read(&out).expect("there"), OLD);
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, 0.0];
    let list: Vec<[f64; 6]> = bad
        .iter()
        .flat_map(|&x| (0..6).map(move |i| std::array::from_fn(|j| if i == j { x } else { 0.0 })))
        .collect();
    query(&rays(&list)).succeeds();
    let bytes = fs::read(&out).expect("written");
    let hits = &bytes[bytes.len() - 24 * list.len()..];
    assert!(hits.chunks_exact(24).all(|hit| hit[12..] == [255; 12]), "all of them miss");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let folder = Folder::new();
    let rays = folder.write_bytes("rays.npy", &rays(&[[0.0, 0.0, 9.0, 0.0, 0.0, -1.0]; 9000]));
    let query = ["query", "builtin:tetra@2", "--rays", &rays, "-o", "/dev/full"];
    nestray(&query).fails(1, &["/dev/full", "No space left"]);
}
