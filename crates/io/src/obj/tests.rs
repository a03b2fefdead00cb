use std::sync::Arc;

use nestray_scene::geometry::Content;
use nestray_scene::material::AlphaMode;
use nestray_shapes::triangle_mesh::Triangles;

use super::*;

fn load(text: &str) -> Loaded {
    read(text.as_bytes(), &Source::new("a.obj")).expect("it is sound")
}

fn error(text: &str) -> String {
    read(text.as_bytes(), &Source::new("a.obj")).expect_err("it is not sound").to_string()
}

fn mesh(loaded: &Loaded, geometry: usize) -> Arc<Triangles> {
    match &loaded.scene.geometries[geometry].content {
        Content::Mesh(triangles) => Arc::clone(triangles),
        _ => unreachable!("OBJ holds meshes"),
    }
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn corners_may_be_counted_from_either_end() {
    for face in ["f 1 2 3 4", "f -4 -3 -2 -1", "f 1 2 \\\n 3 4", "fo 1// 2// 3/ 4 # all"] {
        let loaded = load(&format!("{SQUARE}{face}"));
        assert_eq!(mesh(&loaded, 0).faces(), [[0, 1, 2], [0, 2, 3]], "{face}");
        assert!(loaded.warnings.is_empty());
    }
}

#[test]
fn corners_that_are_alike_are_one_vertex() {
    let text = format!(
        "{SQUARE}vt 0 0\nvt 1 0.25\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1\nf 1/1/1 3/1/1 4/2/1\nf 1/2/1 3/1/1 4/2/1"
    );
    let mesh = mesh(&load(&text), 0);
    assert_eq!(mesh.faces(), [[0, 1, 2], [0, 2, 3], [4, 2, 3]]);
    assert_eq!(mesh.positions().len(), 5);
    assert_eq!(mesh.uvs()[1], [1.0, 0.75]);
    assert_eq!(mesh.normals(), [[0.0, 0.0, 1.0]; 5]);
}

#[test]
fn faces_without_normals_among_others_are_flat() {
    let mesh = mesh(&load(&format!("{SQUARE}vn 1 0 0\nf 1//1 2//1 3//1\nf 1 3 4\nf 3 1 4")), 0);
    assert_eq!(mesh.normals()[mesh.faces()[0][0] as usize], [1.0, 0.0, 0.0]);
    assert_eq!(mesh.normals()[mesh.faces()[1][1] as usize], [0.0, 0.0, 1.0]);
    assert_eq!(mesh.normals()[mesh.faces()[2][1] as usize], [0.0, 0.0, -1.0]);
}

#[test]
fn each_material_of_each_object_is_a_geometry() {
    let text = format!(
        "{SQUARE}f 1 2 3\no a\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\nusemtl red\nf 1 2 4\n\
         g front\nf 1 2 3\no b\ng b\nf 1 2 3"
    );
    let loaded = load(&text);
    let scene = &loaded.scene;
    let seen: Vec<(&str, &str, u32)> = scene
        .geometries
        .iter()
        .map(|g| (g.name.as_str(), scene.materials[g.material].name.as_str(), g.primitives()))
        .collect();
    let expected =
        [("", "", 1), ("a", "red", 2), ("a", "blue", 1), ("a/front", "red", 1), ("b", "red", 1)];
    assert_eq!(seen, expected);
    let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        warnings,
        [
            "a.obj:7: there is no material `red`; grey is taken instead",
            "a.obj:9: there is no material `blue`; grey is taken instead"
        ]
    );
}

#[test]
fn errors_name_line_and_column() {
    let with = |line: &str| error(&format!("{SQUARE}{line}"));
    assert_eq!(with("f 1 2 5"), "a.obj:5:7: a face names vertex 5, but there are 4");
    assert_eq!(with("f 1 2 0"), "a.obj:5:7: a face names vertex 0, but there are 4");
    assert_eq!(with("f 1 2 -5"), "a.obj:5:7: a face names vertex -5, but there are 4");
    assert_eq!(
        with("f 1 2 -9223372036854775808"),
        "a.obj:5:7: a face names vertex -9223372036854775808, but there are 4"
    );
    assert_eq!(
        with("f 1 2 4294967295"),
        "a.obj:5:7: a face names vertex 4294967295, but there are 4"
    );
    assert_eq!(with("f 1 2 3/x"), "a.obj:5:7: expected a corner of a face, found `3/x`");
    assert_eq!(with("f 1 2 3/1/1/1"), "a.obj:5:7: expected a corner of a face, found `3/1/1/1`");
    assert_eq!(with("v 1 2"), "a.obj:5:6: the line ends where a coordinate should be");
    assert_eq!(with("v 1 2 3x"), "a.obj:5:7: expected a coordinate, found `3x`");
    assert_eq!(
        with("\u{1}\u{2}"),
        "a.obj:5:1: expected a statement of OBJ, found `\u{fffd}\u{fffd}`"
    );
}

#[test]
fn oddities_are_told_and_passed_over() {
    let text =
        format!("{SQUARE}vt 0 0\nl 1 2\nl 2 3\ncurv2 1\nf 1 2\nf 1/1 2/7 3\nv nan 0 0\nf 1 2 5");
    let loaded = load(&text);
    let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        warnings,
        [
            "a.obj:10:7: a face names texture coordinate 7, but there are 1; left out",
            "a.obj:8: `curv2` is not read; left out 1 times",
            "a.obj:9: `f of fewer than 3` is not read; left out 1 times",
            "a.obj:6: `l` is not read; left out 2 times",
            "a.obj: 1 triangles have corners out of range and are not seen"
        ]
    );
    let loaded = load(SQUARE);
    assert!(loaded.warnings[0].message.starts_with("holds 4 points"));
}

fn write_picture(path: &std::path::Path, pixels: &[[u8; 3]]) {
    let bytes: Vec<u8> = pixels.as_flattened().to_vec();
    let picture = ::image::RgbImage::from_raw(pixels.len() as u32, 1, bytes).expect("it fits");
    picture.save(path).expect("it can be written");
}

#[test]
fn materials_come_with_their_textures() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("tex")).expect("a folder");
    write_picture(&folder.path().join("tex/a b.png"), &[[255, 0, 0], [0, 255, 0]]);
    write_picture(&folder.path().join("tex/cut.png"), &[[255; 3], [0; 3]]);
    let mtl = "newmtl leaf\nKd 0 0 0\nKs 0.5 0.5 0.5\nNs 0\nmap_Kd -s 2 3 -o 0.5 tex\\a b.png\n\
        map_d tex\\cut.png\nbump -bm 2 tex/cut.png\nmap_Ks x.png\n\
        newmtl glass\nillum 7\nNi 1.33\nTf 0.5 1 1\nnewmtl lamp\nKe 3 2 1\nmap_Ke gone.png\n\
        newmtl pane\nTr 0.75\nnewmtl gold\nKd 1 0.8 0.2\nPm 1\nPr 0.3\nnewmtl chrome\nKd 0 0 0\nKs .9 .9 .9\nNs 998";
    std::fs::write(folder.path().join("m n.mtl"), mtl).expect("it can be written");
    let mut text = format!("mtllib m n.mtl\n{SQUARE}");
    for name in ["leaf", "glass", "lamp", "pane", "gold", "chrome"] {
        text += &format!("usemtl {name}\nf 1 2 3\n");
    }
    let source = Source::new(folder.path().join("a.obj"));
    let loaded = read(text.as_bytes(), &source).expect("it is sound");
    let [leaf, glass, lamp, pane, gold, chrome] = &loaded.scene.materials[..] else {
        panic!("{:?}", loaded.scene.materials)
    };
    let texture = &loaded.scene.textures[leaf.base_texture.expect("it has one")];
    assert_eq!((texture.scale, texture.offset), ([2.0, 3.0], [0.5, -2.0]));
    assert_eq!(texture.image.pixel(0, 0), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(texture.image.pixel(1, 0), [0.0, 1.0, 0.0, 0.0]);
    assert_eq!((leaf.base_color, leaf.alpha_mode), ([1.0; 3], AlphaMode::Mask(0.5)));
    assert_eq!((leaf.roughness, leaf.normal_texture), (1.0, None));
    assert_eq!((glass.transmission, glass.ior, glass.base_color), (1.0, 1.33, [0.5, 1.0, 1.0]));
    assert_eq!((lamp.emission, lamp.emission_texture), ([3.0, 2.0, 1.0], None));
    assert_eq!((pane.alpha, pane.alpha_mode), (0.25, AlphaMode::Blend));
    assert_eq!((gold.metallic, gold.roughness), (1.0, 0.3));
    assert_eq!((chrome.metallic, chrome.base_color), (1.0, [0.9; 3]));
    let told: Vec<String> = loaded
        .warnings
        .iter()
        .map(|w| format!("{}: {}", w.spot.line, w.message.split("; ").last().unwrap_or("")))
        .collect();
    assert_eq!(told, ["8: left out", "7: left out", "15: left out"]);
}

#[test]
fn a_missing_library_is_no_reason_to_stop() {
    let loaded = load(&format!("mtllib x.mtl\n{SQUARE}usemtl a\nf 1 2 3"));
    assert!(loaded.warnings[0].to_string().starts_with("a.obj:1: materials of `x.mtl`: "));
    assert_eq!(loaded.scene.primitives(), 1);
}

#[test]
fn pictures_of_another_machine_are_looked_for_next_to_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    write_picture(&folder.path().join("far.png"), &[[9; 3]]);
    let mtl = "newmtl a\nmap_Kd C:\\models\\far.png\n";
    std::fs::write(folder.path().join("a.mtl"), mtl).expect("it can be written");
    let text = format!("mtllib a.mtl\n{SQUARE}usemtl a\nf 1 2 3");
    let source = Source::new(folder.path().join("a.obj"));
    let loaded = read(text.as_bytes(), &source).expect("it is sound");
    assert_eq!((loaded.scene.textures.len(), loaded.warnings.len()), (1, 0));
}
