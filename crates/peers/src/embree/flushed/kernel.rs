//! The control word of the vector unit.
#![allow(unsafe_code, reason = "what a register holds is set")]

#[cfg(target_arch = "x86_64")]
use std::arch::asm;

/// While it lives, numbers too small to be normal count as 0 on this thread, as Embree wants it.
/// Nothing of ours may be worked out meanwhile; copying numbers is no work.
pub(in super::super) struct Flushed(u32);

#[cfg(target_arch = "x86_64")]
impl Flushed {
    pub(in super::super) fn new() -> Self {
        /// Flush to zero, denormals are zero.
        const FLAGS: u32 = 0x8040;
        let mut before = 0_u32;
        // SAFETY: stores the control word.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut before, options(nostack)) };
        let flags = before | FLAGS;
        // SAFETY: loads a control word with two more of its flags, see above.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const flags, options(nostack)) };
        Self(before)
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for Flushed {
    fn drop(&mut self) {
        // SAFETY: loads the control word that was there before.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const self.0, options(nostack)) };
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Flushed {
    /// Elsewhere Embree does without.
    pub(in super::super) fn new() -> Self {
        Self(0)
    }
}
