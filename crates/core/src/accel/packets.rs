//! Neighbouring rays that go together.

use crate::accel::Accel;
use crate::accel::barrel::Answers;
use crate::accel::few::lanes;
use crate::children::Children;
use crate::mailbox::Stamp;
use crate::packet::{self, Packet};
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::simd::Simd;
use crate::technique::{Asks, Index, Leaf, Led, Step, Walk};
use crate::trail::Trail;

/// Most rays that are looked through for packets at once.
pub(super) const WINDOW: usize = 4096;
/// Which packets of a window of rays need nothing more.
#[derive(Clone, Copy, Debug)]
pub(super) struct Served([u64; WINDOW / packet::RAYS / 64]);

impl Served {
    pub(super) const NONE: Self = Self([0; WINDOW / packet::RAYS / 64]);

    fn add(&mut self, ray: usize) {
        let packet = ray / packet::RAYS;
        self.0[packet / 64] |= 1 << (packet % 64);
    }

    /// The first ray from `ray` on, or behind all, whose packet is not served.
    #[inline(always)]
    pub(super) fn skip(&self, mut ray: usize) -> usize {
        while ray < WINDOW && self.0[ray / packet::RAYS / 64] >> (ray / packet::RAYS % 64) & 1 == 1
        {
            ray = (ray / packet::RAYS + 1) * packet::RAYS;
        }
        ray
    }
}

/// How many packets are not tried because those before had to give up: where triangles are smaller
/// than pixels, neighbours do not stay together.
#[derive(Clone, Copy, Debug, Default)]
struct Patience {
    /// How many more are not tried.
    skips: u32,
    /// How many were not the last time.
    last: u32,
}

impl Patience {
    /// Most that are not tried in a row.
    const MOST: u32 = 16;

    /// Whether the next packet is tried.
    #[inline(always)]
    fn tries(&mut self) -> bool {
        let tries = self.skips == 0;
        self.skips = self.skips.saturating_sub(1);
        tries
    }

    /// What became of one.
    #[inline(always)]
    fn tell(&mut self, is_packet: bool, is_served: bool) {
        if is_packet {
            self.last = if is_served { 0 } else { (2 * self.last + 1).min(Self::MOST) };
            self.skips = self.last;
        }
    }
}

/// The rays of a packet, on their way.
struct Group<'a, Probes> {
    rays: &'a [Ray],
    answers: Answers<'a>,
    packet: &'a mut Packet,
    probes: &'a mut Probes,
    /// Who was shown what, where children may come again.
    seen: Option<Stamp>,
}

impl<I: Index, C: Children> Accel<I, C> {
    /// Traces all `rays`, neighbours together; fills the hits, or whether something is hit if
    /// `ANY`.
    #[inline(always)]
    pub(super) fn batch<S: Simd, const ANY: bool>(
        &self,
        simd: S,
        index: &I,
        rays: &[Ray],
        (hits, blocked): Answers<'_>,
        scratch: &mut Scratch,
    ) {
        for first in (0..rays.len()).step_by(WINDOW) {
            let rays = &rays[first..rays.len().min(first + WINDOW)];
            let mut answers: Answers<'_> = if ANY {
                (&mut [], &mut blocked[first..][..rays.len()])
            } else {
                (&mut hits[first..][..rays.len()], &mut [])
            };
            let served = if I::LEADS {
                self.packets::<S, ANY>(simd, index, rays, &mut answers, scratch)
            } else {
                Served::NONE
            };
            self.barrel::<S, ANY>(simd, index, rays, &served, &mut answers, scratch);
        }
    }

    /// Leads what packets there are among at most [`WINDOW`] rays; says which are served.
    #[inline(always)]
    pub(super) fn packets<S: Simd, const ANY: bool>(
        &self,
        simd: S,
        index: &I,
        rays: &[Ray],
        (hits, blocked): &mut Answers<'_>,
        scratch: &mut Scratch,
    ) -> Served {
        let mut served = Served::NONE;
        let mut patience = Patience::default();
        let mut packet = Packet::EMPTY;
        let mut probes = C::Probes::default();
        let mut trail = Trail::new();
        for first in (0..rays.len().min(WINDOW)).step_by(packet::RAYS) {
            let some = &rays[first..rays.len().min(first + packet::RAYS)];
            let may_be = Packet::may_be(some) && index.leads(some[0].kind());
            if !may_be || !patience.tries() {
                continue;
            }
            let is_packet = if ANY {
                let blocked = &blocked[first..][..some.len()];
                let limit = |i: usize| if blocked[i] { f32::NEG_INFINITY } else { some[i].t_max() };
                packet.take(simd, some, limit)
            } else {
                let hits = &hits[first..][..some.len()];
                packet.take(simd, some, |i| hits[i].t)
            };
            let parts = (&mut packet, &mut probes, &mut trail);
            let is_served = is_packet
                && if ANY {
                    let answers = (&mut [][..], &mut blocked[first..][..some.len()]);
                    self.lead::<S, ANY>(simd, index, some, answers, parts, scratch)
                } else {
                    let answers = (&mut hits[first..][..some.len()], &mut [][..]);
                    self.lead::<S, ANY>(simd, index, some, answers, parts, scratch)
                };
            if is_served {
                served.add(first);
            }
            patience.tell(is_packet, is_served);
        }
        served
    }

    /// Leads one packet; false if its rays are to go alone after all.
    #[inline(always)]
    fn lead<S: Simd, const ANY: bool>(
        &self,
        simd: S,
        index: &I,
        rays: &[Ray],
        answers: Answers<'_>,
        (packet, probes, trail): (&mut Packet, &mut C::Probes, &mut Trail),
        scratch: &mut Scratch,
    ) -> bool {
        let Some(mut lead) = index.lead_in(simd, packet, trail) else { return false };
        lead.few = I::FEW;
        self.members.children.probe_all(simd, packet, rays, probes);
        let seen = index.leads_again().then_some(Stamp::NONE);
        let mut group = Group { rays, answers, packet, probes, seen };
        let end = loop {
            match index.lead_on(simd, group.packet, trail, &mut lead) {
                Led::Leaf(leaf, mask) => {
                    self.leaf::<S, ANY>(simd, (leaf, mask), &mut group, scratch);
                }
                Led::Alone(at, mask) => {
                    for lane in lanes(mask) {
                        self.alone::<S, ANY>(simd, index, (at, lane), &mut group, scratch);
                    }
                }
                end => break end,
            }
        };
        if !ANY {
            self.members.children.tell_hits(group.packet, group.probes, group.answers.0);
        }
        scratch.mailbox.close(group.seen.unwrap_or_default());
        end == Led::Done
    }

    /// Tests a leaf with some rays of a packet.
    #[inline(always)]
    fn leaf<S: Simd, const ANY: bool>(
        &self,
        simd: S,
        (leaf, mask): (Leaf, u32),
        group: &mut Group<'_, C::Probes>,
        scratch: &mut Scratch,
    ) {
        let Group { rays, answers: (hits, blocked), packet, probes, seen } = group;
        if ANY {
            let hit = if Self::PACKED {
                self.members.children.any_in_leaf_by(simd, leaf, mask, packet, probes)
            } else {
                self.any_of_members((leaf, mask), seen, rays, scratch)
            };
            for lane in lanes(hit) {
                blocked[lane] = true;
                packet.limit[lane] = f32::NEG_INFINITY;
            }
        } else if Self::PACKED {
            self.members.children.closest_in_leaf_by(simd, leaf, mask, packet, probes, hits);
        } else {
            self.closest_of_members((leaf, mask), seen, rays, hits, scratch);
            for lane in lanes(mask) {
                packet.limit[lane] = hits[lane].t;
            }
        }
    }

    /// One ray of a packet that goes on alone from where the packet is.
    #[inline(always)]
    fn alone<S: Simd, const ANY: bool>(
        &self,
        simd: S,
        index: &I,
        (mut at, lane): (Step, usize),
        group: &mut Group<'_, C::Probes>,
        scratch: &mut Scratch,
    ) {
        let mut trail = Trail::new();
        let mut cursor = index.part(group.packet, lane, &mut trail);
        let mut walk = Walk { ray: &group.rays[lane], trail: &mut trail, family: &self.members };
        loop {
            while at.is_onward() {
                let limit = group.packet.limit[lane];
                at = index.step::<S, Asks<ANY, false>>(simd, &mut walk, &mut cursor, at, limit);
            }
            if at.is_done() {
                return;
            }
            self.leaf::<S, ANY>(simd, (at.as_leaf(), 1 << lane), group, scratch);
            let limit = group.packet.limit[lane];
            if ANY && limit == f32::NEG_INFINITY {
                return;
            }
            at = index.resume::<S, Asks<ANY, false>>(simd, &mut walk, &mut cursor, limit);
        }
    }
}
