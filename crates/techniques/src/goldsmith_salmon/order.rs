//! In which order children are inserted.

use nestray_core::aabb::Aabb;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

/// In which order children are inserted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// As they are numbered: good if neighbours in number are neighbours in space, and bad if
    /// they are sorted along a line.
    Given,
    /// At random.
    Shuffled,
    /// Those with the largest boxes first, so that a floor comes before what stands on it.
    Largest,
}

impl Order {
    /// All children in this order.
    pub(super) fn of(self, boxes: &[Aabb], seed: u64) -> Vec<u32> {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let area = |child: u32| boxes[child as usize].surface_area();
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        match self {
            Self::Given => {}
            Self::Shuffled => order.shuffle(&mut random),
            Self::Largest => {
                // Equal ones must not come sorted.
                order.shuffle(&mut random);
                order.sort_by(|&a, &b| area(b).total_cmp(&area(a)));
            }
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3A;

    use super::*;

    #[test]
    fn every_order_holds_every_child_once_and_is_the_same_again() {
        let cube =
            |size: u16| Aabb { min: Vec3A::ZERO, max: Vec3A::splat(f32::from(size % 10 + 1)) };
        let boxes: Vec<Aabb> = (0..100).map(cube).collect();
        for order in [Order::Given, Order::Shuffled, Order::Largest] {
            let mut children = order.of(&boxes, 5);
            assert_eq!(children, order.of(&boxes, 5));
            if order == Order::Largest {
                let area = |&child: &u32| boxes[child as usize].surface_area();
                assert!(children.is_sorted_by(|a, b| area(a) >= area(b)));
            }
            children.sort_unstable();
            assert_eq!(children, (0..100).collect::<Vec<u32>>());
        }
        assert_ne!(Order::Shuffled.of(&boxes, 5), Order::Shuffled.of(&boxes, 6));
    }
}
