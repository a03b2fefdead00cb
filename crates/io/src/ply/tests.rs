use nestray_scene::geometry::Content;
use nestray_shapes::triangle_mesh::Triangles;

use super::*;

fn mesh(bytes: &[u8]) -> Triangles {
    let loaded = read(bytes, &Source::new("a.ply")).expect("it is sound");
    match &loaded.scene.geometries[0].content {
        Content::Mesh(triangles) => (**triangles).clone(),
        _ => unreachable!("PLY holds meshes"),
    }
}

fn error(bytes: &[u8]) -> String {
    read(bytes, &Source::new("a.ply")).expect_err("it is not sound").to_string()
}

const SQUARE: &str = "ply\nformat ascii 1.0\ncomment a b\nobj_info c\nelement vertex 4\n\
    property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
    property float nz\nproperty float s\nproperty float t\nproperty uchar red\n\
    property uchar green\nproperty uchar blue\nelement face 1\nproperty uchar flags\n\
    property list uchar int vertex_indices\nelement edge 1\nproperty int a\nend_header\n\
    0 0 0 0 0 1 0 0 255 0 0\n1 0 0 0 0 2 1 0 0 255 0\n1 1 0 0 0 1 1 1 0 0 255\n\
    0 1 0 0 0 1 0 1 255 255 255\n7 4 0 1 2 3\n5\n";

#[test]
fn all_attributes_of_vertices_are_read() {
    let mesh = mesh(SQUARE.as_bytes());
    assert_eq!(mesh.faces(), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions()[2], [1.0, 1.0, 0.0]);
    assert_eq!(mesh.normals(), [[0.0, 0.0, 1.0]; 4]);
    assert_eq!(mesh.uvs()[1], [1.0, 1.0]);
    assert_eq!(mesh.colors()[0], [1.0, 0.0, 0.0, 1.0]);
    let old = SQUARE.replace('\n', "\r");
    assert_eq!(self::mesh(old.as_bytes()), mesh);
    let dos = SQUARE.replace('\n', "\r\n");
    assert_eq!(self::mesh(dos.as_bytes()), mesh);
}

#[test]
fn both_ends_of_numbers_may_come_first() {
    for big in [false, true] {
        let name = if big { "big" } else { "little" };
        let mut file = format!(
            "ply\nformat binary_{name}_endian 1.0\nelement vertex 3\nproperty double x\n\
             property short y\nproperty float z\nelement face 1\n\
             property list ushort uint vertex_index\nend_header\n"
        )
        .into_bytes();
        let mut put = |bytes: &[u8]| {
            let mut bytes = bytes.to_vec();
            if big {
                bytes.reverse();
            }
            file.extend(bytes);
        };
        for [x, y, z] in [[0.5f32, 1.0, 2.0], [3.0, -4.0, 5.0], [6.0, 7.0, 1e9]] {
            put(&f64::from(x).to_le_bytes());
            put(&(y as i16).to_le_bytes());
            put(&z.to_le_bytes());
        }
        put(&3u16.to_le_bytes());
        for index in [2u32, 0, 1] {
            put(&index.to_le_bytes());
        }
        let mesh = mesh(&file);
        assert_eq!(mesh.positions(), [[0.5, 1.0, 2.0], [3.0, -4.0, 5.0], [6.0, 7.0, 1e9]]);
        assert_eq!(mesh.faces(), [[2, 0, 1]]);
        for end in 0..file.len() {
            assert!(read(&file[..end], &Source::new("a.ply")).is_err(), "cut at {end}");
        }
    }
}

#[test]
fn strips_turn_every_second_triangle() {
    let file = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n\
        property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 2 3 3 4\n";
    assert_eq!(mesh(file.as_bytes()).faces(), [[0, 1, 2], [2, 1, 3]]);
    let file = file.replace("9 0 1 2 3 -1 2 3 3 4", "5 0 1 2 3 4");
    assert_eq!(mesh(file.as_bytes()).faces(), [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
}

#[test]
fn points_without_faces_are_said_to_be_unseen() {
    let file = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
        property float z\nend_header\n1 2 3\n";
    let loaded = read(file.as_bytes(), &Source::new("a.ply")).expect("it is sound");
    assert!(loaded.scene.geometries.is_empty());
    assert_eq!(
        loaded.warnings[0].to_string(),
        "a.ply: holds 1 points without faces, which are not seen"
    );
}

#[test]
fn errors_name_the_line() {
    let change = |from: &str, to: &str| error(SQUARE.replace(from, to).as_bytes());
    assert_eq!(
        change("vertex 4", "vertex 4000000000"),
        "a.ply:5: 4000000000 elements `vertex` do not fit in the 114 bytes that are left"
    );
    assert_eq!(change("face 1\n", "face -1\n"), "a.ply:17:14: expected a count, found `-1`");
    assert_eq!(
        change("4 0 1 2 3", "4 0 1 2 4"),
        "a.ply:27:12: a face names vertex 4, but there are 4"
    );
    assert_eq!(
        change("4 0 1 2 3", "4 0 1 2 -3"),
        "a.ply:27:13: a face names vertex -3, but there are 4"
    );
    assert_eq!(
        change("7 4 0", "7 4000000000 0"),
        "a.ply:27:13: a list of 4000000000 in the 11 bytes that are left"
    );
    assert_eq!(
        change("1 1 0 0 0 1", "1 one 0 0 0 1"),
        "a.ply:25:3: expected a number, found `one`"
    );
    assert_eq!(change("float nx", "half nx"), "a.ply:9:10: expected a type of PLY, found `half`");
    assert_eq!(
        change("float x", "float xx"),
        "a.ply:5: vertices without properties `x`, `y` and `z`"
    );
    assert_eq!(change("ascii", "base64"), "a.ply:2:8: expected a format of PLY, found `base64`");
}

#[test]
fn faces_before_vertices_and_empty_rows_do_no_harm() {
    let file = "ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertex_indices\n\
        element vertex 4\nelement nothing 4000000000000\nend_header\n4 0 1 2 3\n";
    assert!(error(file.as_bytes()).ends_with("a face names vertex 0, but there are 0"));
    let file = "ply\nformat ascii 1.0\nelement nothing 4000000000000\nelement face 1\n\
        property list int int vertex_indices\nelement vertex 4\nproperty int x\nproperty int y\n\
        property int z\nend_header\n4 0 1 2 3\n0 0 0\n1 0 0\n1 1 0\n0 1 0";
    assert_eq!(mesh(file.as_bytes()).count(), 2);
}
