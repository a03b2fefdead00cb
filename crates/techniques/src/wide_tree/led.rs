//! Leading a packet of rays through the nodes.

use nestray_core::packet::{Packet, Pencil};
use nestray_core::simd::Simd;
use nestray_core::technique::{Lead, Led, Step};
use nestray_core::trail::{self, DONE, Trail};

use super::{Node, WideTree};

/// Nodes that a packet may come to before its rays do better apart.
const MOST: u32 = 128;

/// The lanes of a node, as they are put off.
#[inline(always)]
fn names(node: u32) -> [u32; 8] {
    let first = node << 3;
    [first, first + 1, first + 2, first + 3, first + 4, first + 5, first + 6, first + 7]
}

impl WideTree {
    #[inline(always)]
    pub(super) fn packet_in<S: Simd>(
        &self,
        simd: S,
        packet: &mut Packet,
        trail: &mut Trail,
    ) -> Option<Lead> {
        if packet.spread() > 0.05 * self.reach {
            return None;
        }
        packet.face(simd, self.reach, self.slack);
        let pencil = Pencil::new(&packet.beam, self.reach);
        let mut lead = Lead { pencil, top: trail.reset(), left: MOST, few: 0 };
        self.look_into(simd, 0, trail, &mut lead);
        Some(lead)
    }

    /// Puts off the lanes of a node that some ray may meet.
    #[inline(always)]
    fn look_into<S: Simd>(&self, simd: S, node: u32, trail: &mut Trail, lead: &mut Lead) {
        let rows = &self.nodes[node as usize].rows;
        let (mask, enter) = lead.pencil.meets(simd, rows);
        trail::put_off_all(simd, trail, &mut lead.top, mask, enter, &names(node));
    }

    #[inline(always)]
    pub(super) fn packet_on<S: Simd>(
        &self,
        simd: S,
        packet: &Packet,
        trail: &mut Trail,
        lead: &mut Lead,
    ) -> Led {
        loop {
            let name = trail::take_last(trail, &mut lead.top);
            if name == DONE {
                return Led::Done;
            }
            let (node, lane): (&Node, usize) = (&self.nodes[name as usize >> 3], name as usize & 7);
            let rays = packet.meet(simd, &node.rows, lane);
            if rays == 0 {
                continue;
            }
            let at = Step::from_word(node.words[lane]);
            if !at.is_onward() {
                return Led::Leaf(at.as_leaf(), rays);
            }
            if rays.count_ones() <= lead.few {
                return Led::Alone(at, rays);
            }
            if lead.left == 0 {
                return Led::Apart;
            }
            lead.left -= 1;
            self.look_into(simd, at.word(), trail, lead);
        }
    }
}
