//! The faces of gears in triangles: two for each tooth, and a fan over what is within the teeth, or
//! pieces as large as can be.

use std::sync::Arc;

use nestray_scene::geometry::Content;
use nestray_scene::scene::Scene;
use nestray_shapes::any::AnyShape;
use nestray_shapes::polygon::Polygon;

/// How the polygon within the teeth is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// All triangles meet in one corner: long and thin.
    Fan,
    /// Every other corner is cut off, again and again.
    Corners,
}

/// Corners of a face: four for each of 36 teeth.
const CORNERS: usize = 144;

/// Cuts all faces of gears.
pub fn cut(scene: &mut Scene, how: Cut) {
    for geometry in &mut scene.geometries {
        if let Content::Shapes(shapes) = &geometry.content {
            let cut = shapes.iter().flat_map(|shape| match shape {
                AnyShape::Polygon(face) if face.vertices().len() == CORNERS => {
                    triangles(face.vertices(), how)
                }
                other => vec![other.clone()],
            });
            geometry.content = Content::Shapes(Arc::new(cut.collect()));
        }
    }
}

fn triangles(corners: &[[f32; 3]], how: Cut) -> Vec<AnyShape> {
    let triangle =
        |corner: [usize; 3]| Polygon::new(corner.map(|i| corners[i % CORNERS]).to_vec()).into();
    let start = first_of_tooth(corners);
    let (mut cut, mut within) = (Vec::new(), Vec::new());
    for tooth in (start..).step_by(4).take(CORNERS / 4) {
        let before = tooth + CORNERS - 1;
        cut.push([before, tooth, tooth + 1]);
        cut.push([before, tooth + 1, tooth + 2]);
        within.extend([tooth + 2, tooth + 3]);
    }
    match how {
        Cut::Fan => {
            cut.extend(within[1..].windows(2).map(|pair| [within[0], pair[0], pair[1]]));
        }
        Cut::Corners => {
            while within.len() > 2 {
                let count = within.len();
                let at = |i: usize| within[i % count];
                // If they are odd, the last is the first of the next round.
                let ears = (0..count - count % 2).step_by(2);
                cut.extend(ears.map(|i| [at(i), at(i + 1), at(i + 2)]));
                within = within.iter().copied().step_by(2).collect();
            }
        }
    }
    cut.into_iter().map(triangle).collect()
}

/// A corner on the outline of a gear after one that is not.
fn first_of_tooth(corners: &[[f32; 3]]) -> usize {
    let mean = |axis: usize| corners.iter().map(|c| c[axis]).sum::<f32>() / CORNERS as f32;
    let center = [mean(0), mean(1)];
    let reach = |i: usize| {
        let corner = corners[i % CORNERS];
        libm::hypotf(corner[0] - center[0], corner[1] - center[1])
    };
    let middle = (0..CORNERS).map(reach).sum::<f32>() / CORNERS as f32;
    let starts = |&i: &usize| reach(i) > middle && reach(i + CORNERS - 1) < middle;
    (0..CORNERS).find(starts).expect("there are teeth")
}
