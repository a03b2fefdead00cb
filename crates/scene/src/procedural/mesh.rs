//! Meshes that grow piece by piece.

use glam::{DAffine3, DVec3};
use nestray_shapes::triangle_mesh::Triangles;

/// A mesh in the making: either all of its vertices have normals, or none.
#[derive(Debug, Default)]
pub(super) struct Mesh {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    colors: Vec<[f32; 4]>,
    faces: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds a vertex; returns its number.
    pub(super) fn vertex(&mut self, place: DVec3) -> u32 {
        self.positions.push(place.as_vec3().to_array());
        self.positions.len() as u32 - 1
    }

    /// Adds a vertex with a normal; returns its number.
    pub(super) fn smooth_vertex(&mut self, place: DVec3, normal: DVec3) -> u32 {
        self.normals.push(normal.as_vec3().to_array());
        self.vertex(place)
    }

    /// Gives every vertex a colour by its place and normal.
    pub(super) fn color_by(&mut self, color: impl Fn(DVec3, DVec3) -> [f64; 3]) {
        let vector = |v: &[f32; 3]| DVec3::from_array(v.map(f64::from));
        let vertices = self.positions.iter().zip(&self.normals);
        self.colors = vertices
            .map(|(place, normal)| {
                let [r, g, b] = color(vector(place), vector(normal)).map(|x| x as f32);
                [r, g, b, 1.0]
            })
            .collect();
    }

    /// A triangle between vertices that are there.
    pub(super) fn face(&mut self, corners: [u32; 3]) {
        self.faces.push(corners);
    }

    /// Two triangles between vertices that are there, in order around.
    pub(super) fn square(&mut self, [a, b, c, d]: [u32; 4]) {
        self.faces.extend([[a, b, c], [a, c, d]]);
    }

    /// A triangle with corners of its own.
    pub(super) fn triangle(&mut self, corners: [DVec3; 3]) {
        let corners = corners.map(|corner| self.vertex(corner));
        self.face(corners);
    }

    /// Two triangles with corners of their own, in order around.
    pub(super) fn quad(&mut self, corners: [DVec3; 4]) {
        let corners = corners.map(|corner| self.vertex(corner));
        self.square(corners);
    }

    /// The cube `[−½, ½]³`, moved: twelve triangles.
    pub(super) fn cuboid(&mut self, place: DAffine3) {
        let corner = |i: u32| {
            let end = |bit: u32| if i & bit == 0 { -0.5 } else { 0.5 };
            place.transform_point3(DVec3::new(end(1), end(2), end(4)))
        };
        let first = self.positions.len() as u32;
        (0..8).for_each(|i| {
            self.vertex(corner(i));
        });
        for side in
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        {
            self.square(side.map(|i| first + i));
        }
    }

    /// A grid of vertices with normals, `cells + 1` in each of as many rows; returns the
    /// number of the first.
    pub(super) fn corners(
        &mut self,
        cells: u32,
        vertex: impl Fn(u32, u32) -> (DVec3, DVec3),
    ) -> u32 {
        let first = self.positions.len() as u32;
        for row in 0..=cells {
            for column in 0..=cells {
                let (place, normal) = vertex(row, column);
                self.smooth_vertex(place, normal);
            }
        }
        first
    }

    /// Two triangles for each cell of a grid of vertices, `cells + 1` in each of as many rows.
    pub(super) fn cells(&mut self, cells: u32, first: u32) {
        let row = cells + 1;
        for cell in 0..cells * cells {
            let corner = first + cell / cells * row + cell % cells;
            self.square([corner, corner + 1, corner + row + 1, corner + row]);
        }
    }

    /// A triangle between vertices that are there, unless two of them are in one place.
    pub(super) fn face_with_area(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
        if a != b && b != c && c != a {
            self.face(corners);
        }
    }

    /// A round branch that thins out, open at both ends: `2 · sides` triangles.
    pub(super) fn tube(&mut self, ends: [DVec3; 2], radii: [f64; 2], sides: u32) {
        let [side, up] = across((ends[1] - ends[0]).normalize());
        let first = self.positions.len() as u32;
        for i in 0..sides {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(sides);
            let out = side * libm::cos(angle) + up * libm::sin(angle);
            for (end, radius) in ends.into_iter().zip(radii) {
                self.smooth_vertex(end + out * radius, out);
            }
        }
        for i in 0..sides {
            let (a, b) = (first + 2 * i, first + 2 * ((i + 1) % sides));
            self.square([a, b, b + 1, a + 1]);
        }
    }

    /// The mesh.
    pub(super) fn finish(self) -> Triangles {
        Triangles::new(self.positions, self.faces)
            .and_then(|mesh| mesh.with_normals(self.normals))
            .and_then(|mesh| mesh.with_colors(self.colors))
            .expect("faces name vertices that are there, all with the same attributes")
    }
}

/// Two unit vectors at right angles to a unit vector and to one another.
pub(super) fn across(dir: DVec3) -> [DVec3; 2] {
    let other = if dir.z.abs() < 0.9 { DVec3::Z } else { DVec3::X };
    let first = other.cross(dir).normalize();
    [first, dir.cross(first)]
}
